//! A map's open files. Values go to all of them layer by layer.

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
    /// One per layer, each with its scale.
    Png(Vec<(PathBuf, Written, f64)>),
}

/// A map's files, invisible under their final names until [`Whole::place`].
pub struct MapFiles<'a> {
    wanted: Wanted,
    map: Map,
    field: &'a HeightField,
    folder: PathBuf,
    texts: Vec<(String, String)>,
    open: Vec<Open>,
    taken: usize,
    /// Count of values outside their stated range, and the largest excess.
    beyond: (u64, f64),
    entries: Vec<(&'static str, Json)>,
    remarks: Vec<String>,
}

impl<'a> MapFiles<'a> {
    /// Opens all files.
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
        let (entries, remarks) = (Vec::new(), Vec::new());
        let (taken, beyond) = (0, (0, 0.0));
        Ok(Self { wanted, map, field, folder, texts, open, taken, beyond, entries, remarks })
    }

    /// Its name for `--what`.
    pub fn kind(&self) -> &'static str {
        self.wanted.kind.name
    }

    /// Adds an entry to the kind's part of the manifest.
    pub fn add_entry(&mut self, name: &'static str, what: Json) {
        self.entries.push((name, what));
    }

    /// Adds a note for the terminal.
    pub fn remark(&mut self, what: String) {
        self.remarks.push(what);
    }

    /// The field's voids, if the map has its size.
    fn voids(&self) -> Option<&'a [bool]> {
        self.field.voids().filter(|_| self.map.size.is_none())
    }

    /// Columns and rows.
    fn size(&self) -> [usize; 2] {
        self.map.size.unwrap_or([self.field.cols(), self.field.rows()])
    }

    /// Planes that one layer encodes.
    pub fn planes_at_once(&self) -> usize {
        self.wanted.encoding.values
    }

    /// Takes a layer: [`planes_at_once`](Self::planes_at_once) planes, fewer in the last.
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

    /// Counts values outside their range.
    fn count_beyond(&mut self, planes: &[&[f32]]) {
        let (values, voids) = (&self.map.values, self.voids());
        let first = self.taken * self.wanted.encoding.values;
        for (at, plane) in planes.iter().enumerate() {
            let [low, high] = values[(first + at) % values.len()].range;
            // Allows f32 rounding, where π/2 is above the real one, and the device's function
            // errors.
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

    /// Channels of a picture: components, and alpha where there are voids.
    fn channels(&self) -> usize {
        self.wanted.encoding.components + usize::from(self.voids().is_some())
    }
}
