//! Visible points of a field as a NumPy archive, which `numpy.load` opens.
//!
//! `visible_points` [N, rows, cols, 2]: row and column of the visible grid point, u2, or u1 for
//! fields of at most 255 by 255. Both are the type's largest number for the sky; the largest and
//! one less for the level ground beyond the field. No field has a row of that number. `directions`
//! [N, 3] f8: east, north, up. `lowest_direction_z` f8. `field_hash` [8] u1, little-endian: hash of
//! the source field.

use super::npy::{self, Array};
use super::npz;
use crate::atomic::Temporary;
use crate::open;
use glam::DVec3;
use ridgelight::scene::{Border, Directions, HeightField, VisiblePoint, VisiblePoints};
use ridgelight::{Error, Result};
use std::io::Write;
use std::path::Path;
use zip::write::{SimpleFileOptions, ZipWriter};

const MEMBERS: [&str; 4] = ["visible_points", "directions", "lowest_direction_z", "field_hash"];

/// Bytes of a row or a column: one holds those of 255 grid points and a mark.
fn bytes_each(rows: usize, cols: usize) -> usize {
    if rows.max(cols) <= 255 { 1 } else { 2 }
}

/// Writes visible points as `.npz`, stored without compression.
///
/// # Errors
/// A destination that cannot be written.
pub fn write_visible_points(path: &Path, points: &VisiblePoints) -> Result<()> {
    let directions = points.directions();
    let [rows, cols] = points.size();
    let bytes_each = bytes_each(rows, cols);
    let vectors: Vec<u8> =
        directions.vectors().iter().flat_map(|v| v.to_array()).flat_map(f64::to_le_bytes).collect();
    let mut file = Temporary::create(path)?;
    let mut archive = ZipWriter::new(file.stream());
    // Archives and members may be larger than 4 GiB.
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .large_file(true);
    let io = |e: std::io::Error| Error::io(path, e);
    let begin = |archive: &mut ZipWriter<_>, member: usize, descr: &str, shape: &[usize]| {
        let name = format!("{}.npy", MEMBERS[member]);
        archive.start_file(name, options).map_err(|e| io(std::io::Error::other(e)))?;
        archive.write_all(&npy::header(descr, shape)?).map_err(io)
    };
    let shape = [directions.count(), rows, cols, 2];
    begin(&mut archive, 0, if bytes_each == 1 { "|u1" } else { "<u2" }, &shape)?;
    let mut row_bytes = Vec::with_capacity(4 * cols);
    for direction in 0..directions.count() {
        for row in 0..rows {
            row_bytes.clear();
            for col in 0..cols {
                let pair = match points.point(direction, row * cols + col) {
                    VisiblePoint::GridPoint(at) => [at / cols, at % cols].map(|n| n as u16),
                    VisiblePoint::Sky => [u16::MAX; 2],
                    VisiblePoint::Ground => [u16::MAX, u16::MAX - 1],
                };
                for number in pair {
                    let bytes = number.to_le_bytes();
                    row_bytes.extend(&bytes[..bytes_each]);
                }
            }
            archive.write_all(&row_bytes).map_err(io)?;
        }
    }
    begin(&mut archive, 1, "<f8", &[directions.count(), 3])?;
    archive.write_all(&vectors).map_err(io)?;
    begin(&mut archive, 2, "<f8", &[])?;
    archive.write_all(&directions.lowest_z().to_le_bytes()).map_err(io)?;
    begin(&mut archive, 3, "|u1", &[8])?;
    archive.write_all(&points.field_hash().to_le_bytes()).map_err(io)?;
    archive.finish().map_err(|e| io(std::io::Error::other(e)))?;
    file.finish()
}

/// Reads visible points of `field`, which must be their source.
///
/// # Errors
/// Another archive, arrays of other types or shapes, a point outside the field, points of another
/// field.
pub fn read_visible_points(
    path: &Path,
    field: &HeightField,
    border: Border,
) -> Result<VisiblePoints> {
    let bytes = open::read(path)?;
    let mut archive = npz::archive(path, &bytes)?;
    let mut member = |i: usize| {
        let name = format!("{}.npy", MEMBERS[i]);
        Ok::<_, Error>((npz::member(path, &mut archive, bytes.len(), &name)?, format!("{name}: ")))
    };
    let (kept, inside) = member(3)?;
    let hash = Array::parse(path, &inside, &kept)?;
    expect_shape(path, &inside, &hash, &[8])?;
    let hash = hash.values().enumerate().fold(0, |hash, (i, byte)| hash | (byte as u64) << (8 * i));
    let own = field.hash(border);
    if hash != own {
        return Err(Error::file(
            path,
            "field_hash",
            format!("points of a field with the hash {hash:016x}"),
            format!(
                "{own:016x}, that of this field: its heights, cells and border must be the same"
            ),
        ));
    }
    let (kept, inside) = member(2)?;
    let lowest = Array::parse(path, &inside, &kept)?;
    expect_shape(path, &inside, &lowest, &[])?;
    let lowest_z = lowest.values().next().unwrap_or(f64::NAN);
    let (kept, inside) = member(1)?;
    let vectors = Array::parse(path, &inside, &kept)?;
    let count = vectors.shape.first().copied().unwrap_or(0);
    expect_shape(path, &inside, &vectors, &[count, 3])?;
    let numbers: Vec<f64> = vectors.values().collect();
    let vectors = numbers.as_chunks::<3>().0.iter().map(|v| DVec3::from_array(*v)).collect();
    let refused = |error: Error| match error {
        Error::Setting { name, found, expected } => Error::file(path, name, found, expected),
        other => other,
    };
    let directions = Directions::from_vectors(vectors, lowest_z).map_err(refused)?;
    let (kept, inside) = member(0)?;
    let array = Array::parse(path, &inside, &kept)?;
    let (rows, cols) = (field.rows(), field.cols());
    expect_shape(path, &inside, &array, &[count, rows, cols, 2])?;
    let bytes_each = bytes_each(rows, cols);
    if array.unsigned() != Some(bytes_each) {
        let expected = format!("unsigned integers of {bytes_each} bytes for {cols} × {rows}");
        return Err(Error::file(path, format!("{inside}descr"), "another type", expected));
    }
    let largest = 256_f64.powi(bytes_each as i32) - 1.0;
    let mut values = array.values();
    let wanted = count * rows * cols;
    let mut points = Vec::new();
    if points.try_reserve_exact(wanted).is_err() {
        let found = format!("{wanted} points");
        return Err(Error::file(path, inside, found, "as many as memory holds"));
    }
    while let (Some(row), Some(col)) = (values.next(), values.next()) {
        points.push(match [row, col] {
            [r, c] if r == largest && c == largest => VisiblePoint::Sky,
            [r, c] if r == largest && c == largest - 1.0 => VisiblePoint::Ground,
            [r, c] if r < rows as f64 && c < cols as f64 => {
                VisiblePoint::GridPoint(r as usize * cols + c as usize)
            }
            [r, c] => {
                let place = format!("{inside}point {}", points.len());
                let expected = format!(
                    "a grid point of {cols} × {rows}, or the row {largest} with the column {largest} or one less"
                );
                return Err(Error::file(path, place, format!("row {r}, column {c}"), expected));
            }
        });
    }
    VisiblePoints::from_points(field, border, directions, &points).map_err(refused)
}

fn expect_shape(path: &Path, inside: &str, array: &Array, shape: &[usize]) -> Result<()> {
    if array.shape == shape {
        return Ok(());
    }
    let found = format!("{:?}", array.shape);
    Err(Error::file(path, format!("{inside}header: shape"), found, format!("{shape:?}")))
}
