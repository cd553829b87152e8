//! Tiles of a band: cut, predicted, compressed; and the smaller copies of the band.

use flate2::{Compression, write::ZlibEncoder};
use std::io::Write;
use std::num::NonZero;

/// The side of a tile of a large image.
pub(super) const TILE: usize = 512;
/// zlib's fastest. Measured on the eight bands of a render of 1201 x 1201: level 6, its default, is 3 %
/// smaller and takes 3.5 times as long (0.46 s and 1.59 s on two cores).
const LEVEL: u32 = 1;

/// Columns and rows of an image or a tile.
pub(super) type Size = [usize; 2];

/// Tiles of 512 x 512; smaller images have one tile, whose sides TIFF requires to be multiples of 16.
pub(super) fn tile_size(image: Size) -> Size {
    image.map(|side| side.next_multiple_of(16).min(TILE))
}

/// Number of tiles along columns and rows.
pub(super) fn tile_counts(image: Size) -> Size {
    let tile = tile_size(image);
    [0, 1].map(|axis| image[axis].div_ceil(tile[axis]))
}

/// Sizes of the image and of its overviews: each half of the one before, until one fits a tile.
pub(super) fn levels(image: Size) -> Vec<Size> {
    let mut all = vec![image];
    let mut size = image;
    while size.iter().any(|side| *side > TILE) {
        size = size.map(|side| side.div_ceil(2));
        all.push(size);
    }
    all
}

/// The next overview: the mean of each 2 x 2 pixels that are no NaN, NaN where all four are.
pub(super) fn halved(values: &[f32], [cols, rows]: Size) -> Vec<f32> {
    let [half_cols, half_rows] = [cols, rows].map(|side| side.div_ceil(2));
    let mut half = Vec::with_capacity(half_cols * half_rows);
    for row in 0..half_rows {
        for col in 0..half_cols {
            let (mut sum, mut count) = (0.0_f64, 0.0_f64);
            for y in 2 * row..(2 * row + 2).min(rows) {
                for x in 2 * col..(2 * col + 2).min(cols) {
                    let value = values[y * cols + x];
                    if !value.is_nan() {
                        sum += f64::from(value);
                        count += 1.0;
                    }
                }
            }
            half.push(if count > 0.0 { (sum / count) as f32 } else { f32::NAN });
        }
    }
    half
}

/// All tiles of a band, row by row, compressed on all cores. The order and the bytes do not depend on
/// the number of cores.
pub(super) fn compressed(values: &[f32], image: Size) -> std::io::Result<Vec<Vec<u8>>> {
    let count: usize = tile_counts(image).iter().product();
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get).min(count);
    let mut tiles = vec![Vec::new(); count];
    let share = count.div_ceil(cores);
    std::thread::scope(|scope| {
        let of = |(at, part): (usize, &mut [Vec<u8>])| -> std::io::Result<()> {
            for (i, tile) in part.iter_mut().enumerate() {
                *tile = encoded(values, image, at * share + i)?;
            }
            Ok(())
        };
        let parts: Vec<_> =
            tiles.chunks_mut(share).enumerate().map(|part| scope.spawn(move || of(part))).collect();
        parts.into_iter().try_for_each(|part| match part.join() {
            Ok(done) => done,
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })?;
    Ok(tiles)
}

/// One tile, deflated, with the floating-point predictor (Adobe, TIFF Technical Note 3): in each
/// row first the highest bytes of all values, and each byte minus the one before.
fn encoded(values: &[f32], image: Size, index: usize) -> std::io::Result<Vec<u8>> {
    let [cols, rows] = image;
    let [width, height] = tile_size(image);
    let across = tile_counts(image)[0];
    let [left, top] = [index % across * width, index / across * height];
    let inside = cols.min(left + width) - left;
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
    let mut bytes = vec![0; 4 * width];
    for row in top..top + height {
        // Pixels beyond the image are zeros; readers ignore them.
        bytes.fill(0);
        if row < rows {
            let start = row * cols + left;
            for (i, value) in values[start..start + inside].iter().enumerate() {
                let value = if value.is_nan() { f32::NAN } else { *value };
                for (plane, byte) in value.to_be_bytes().into_iter().enumerate() {
                    bytes[plane * width + i] = byte;
                }
            }
            for i in (1..bytes.len()).rev() {
                bytes[i] = bytes[i].wrapping_sub(bytes[i - 1]);
            }
        }
        encoder.write_all(&bytes)?;
    }
    encoder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overviews_end_where_one_fits_a_tile() {
        assert_eq!(levels([512, 512]), [[512, 512]]);
        assert_eq!(levels([513, 1]), [[513, 1], [257, 1]]);
        assert_eq!(levels([1201, 2049]), [[1201, 2049], [601, 1025], [301, 513], [151, 257]]);
        assert_eq!(tile_size([1, 1]), [16, 16]);
        assert_eq!(tile_size([17, 4000]), [32, 512]);
        assert_eq!(tile_counts([513, 512]), [2, 1]);
    }

    #[test]
    fn an_overview_is_the_mean_of_what_is_known() {
        let nan = f32::NAN;
        let values = [1.0, 3.0, 8.0, 5.0, nan, nan, nan, nan, 6.0];
        // Columns 0-1, then 2; rows 0-1, then 2.
        let half = halved(&values, [3, 3]);
        assert_eq!((half[0], half[1], half[3]), (3.0, 8.0, 6.0));
        assert!(half[2].is_nan());
    }
}
