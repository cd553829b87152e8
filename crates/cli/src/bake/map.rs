//! A map's files: values go to all of them as they come, layer by layer.

mod coded;
mod notes;
mod wanted;
mod whole;

use std::path::{Path, PathBuf};

use ridgelight::Result;
use ridgelight::scene::HeightField;
use ridgelight_io as files;
use ridgelight_io::{Ktx2Writer, NpyWriter, Written};
use serde_json::Value as Json;

use super::kinds::Map;
use super::request;
pub use wanted::{Format, Wanted, stem};
pub use whole::Whole;

enum Open {
    Exr(PathBuf, Vec<Vec<f32>>),
    Npy(PathBuf, NpyWriter),
    Ktx2(PathBuf, Ktx2Writer),
    /// One a layer, each with what its samples are times.
    Png(Vec<(PathBuf, Written, f64)>),
}

/// A map's files, until [`Whole::place`] nowhere to be seen.
pub struct MapFiles<'a> {
    wanted: Wanted,
    map: Map,
    field: &'a HeightField,
    folder: PathBuf,
    texts: Vec<(String, String)>,
    open: Vec<Open>,
    taken: usize,
    /// Values beyond their stated range, and the most that one was.
    beyond: (u64, f64),
    told: Vec<(&'static str, Json)>,
    remarks: Vec<String>,
}

impl<'a> MapFiles<'a> {
    /// Begins all of them.
    pub fn create(
        folder: &Path,
        wanted: Wanted,
        map: Map,
        field: &'a HeightField,
        hash: &str,
    ) -> Result<Self> {
        let size = map.size.unwrap_or([field.cols(), field.rows()]);
        let texts: Vec<(String, String)> = [
            ("ridgelight.kind", wanted.kind.name),
            ("ridgelight.encoding", wanted.encoding.name),
            ("ridgelight.decoding", wanted.encoding.decoding),
            ("ridgelight.field_hash", hash),
        ]
        .map(|(name, text)| (name.to_owned(), text.to_owned()))
        .into();
        let path = |format: Format| folder.join(format!("{}.{}", stem(wanted.kind), format.name()));
        let layers = map.is_array.then(|| wanted.layers(&map));
        let open = wanted.formats.iter().map(|format| {
            Ok(match format {
                Format::Exr => Open::Exr(path(*format), Vec::new()),
                Format::Npy => {
                    let mut shape = vec![map.planes.len(), size[1], size[0]];
                    if map.planes.len() == 1 && !map.is_array {
                        shape.remove(0);
                    }
                    if !map.axes.is_empty() {
                        shape = map.axes.iter().map(|axis| axis.1).collect();
                    }
                    Open::Npy(path(*format), NpyWriter::create(&path(*format), &shape)?)
                }
                Format::Ktx2 => {
                    let path = path(*format);
                    let texels = wanted.texels();
                    let writer = Ktx2Writer::create(&path, texels, size, layers, &texts)?;
                    Open::Ktx2(path, writer)
                }
                Format::Png => Open::Png(Vec::new()),
            })
        });
        let open = open.collect::<Result<_>>()?;
        let folder = folder.to_owned();
        let (told, remarks) = (Vec::new(), Vec::new());
        let (taken, beyond) = (0, (0, 0.0));
        Ok(Self { wanted, map, field, folder, texts, open, taken, beyond, told, remarks })
    }

    /// As `--what` calls it.
    pub fn kind(&self) -> &'static str {
        self.wanted.kind.name
    }

    /// Says something more of the kind in the sheet.
    pub fn tell(&mut self, name: &'static str, what: Json) {
        self.told.push((name, what));
    }

    /// Says something more of the kind to who waits.
    pub fn remark(&mut self, what: String) {
        self.remarks.push(what);
    }

    /// The field's, of a map with a texel a sample.
    fn voids(&self) -> Option<&'a [bool]> {
        self.field.voids().filter(|_| self.map.size.is_none())
    }

    /// Columns and rows.
    fn size(&self) -> [usize; 2] {
        self.map.size.unwrap_or([self.field.cols(), self.field.rows()])
    }

    /// As many planes as a layer's texels stand for.
    pub fn planes_at_once(&self) -> usize {
        self.wanted.encoding.values
    }

    /// Takes a layer: as many planes as [`planes_at_once`](Self::planes_at_once), fewer in the last.
    pub fn take(&mut self, planes: &[&[f32]]) -> Result<()> {
        self.count_beyond(planes);
        let scale = if self.is_scaled() { self.largest(planes) } else { 1.0 };
        let (texels, picture) = self.coded(planes, scale);
        let (voids, field) = (self.voids(), self.field);
        let masked = |plane: &[f32]| {
            let mut plane = plane.to_vec();
            if voids.is_some() {
                crate::setup::mask_voids(field, &mut plane, 1);
            }
            plane
        };
        let (size, form, texts) = (self.size(), self.picture_form(), self.picture_texts(scale));
        for open in &mut self.open {
            match open {
                Open::Exr(_, kept) => kept.extend(planes.iter().map(|plane| masked(plane))),
                Open::Npy(_, writer) => {
                    for plane in planes {
                        match voids {
                            None => writer.write(plane)?,
                            Some(_) => writer.write(&masked(plane))?,
                        }
                    }
                }
                Open::Ktx2(_, writer) => writer.write(&texels)?,
                Open::Png(kept) => {
                    let path = self.folder.join(self.wanted.picture(&self.map, self.taken));
                    let file = files::write_codes_aside(&path, size, form, &picture, &texts)?;
                    kept.push((path, file, scale));
                }
            }
        }
        self.taken += 1;
        Ok(())
    }

    /// Counts values that are no part of their range, whatever holds them.
    fn count_beyond(&mut self, planes: &[&[f32]]) {
        let (values, voids) = (&self.map.values, self.voids());
        let first = self.taken * self.wanted.encoding.values;
        for (at, plane) in planes.iter().enumerate() {
            let [low, high] = values[(first + at) % values.len()].range;
            // Roundings of f32, in which a right angle is more than one, and of the device's functions.
            let rounding = 8.0 * f64::from(f32::EPSILON) * low.abs().max(high.abs());
            for (i, value) in plane.iter().enumerate() {
                let beyond = (f64::from(*value) - high).max(low - f64::from(*value));
                if beyond > rounding && !voids.is_some_and(|v| v[i]) {
                    self.beyond = (self.beyond.0 + 1, self.beyond.1.max(beyond));
                }
            }
        }
    }

    fn has(&self, format: Format) -> bool {
        self.wanted.formats.contains(&format)
    }

    /// Channels of a picture: components, and opacity where there are voids.
    fn channels(&self) -> usize {
        self.wanted.encoding.components + usize::from(self.voids().is_some())
    }
}
