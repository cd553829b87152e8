//! Finishes a map's files and moves them to their names.

use std::path::{Path, PathBuf};

use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Channels, Layer, Written};
use serde_json::Value as Json;

use super::{Format, MapFiles, Open, stem};

/// A finished file under a temporary name.
pub(super) struct Waiting {
    file: Written,
    pub path: PathBuf,
    pub format: Format,
    /// Texel or pixel type, in words.
    pub holds: String,
    /// Scale of a picture's values.
    pub scale: f64,
}

impl<'a> MapFiles<'a> {
    /// Finishes all files under temporary names. Formats that can, store `metadata`.
    pub fn complete(mut self, metadata: &[(String, String)]) -> Result<Whole<'a>> {
        let of_texels = self.wanted.texels().vulkan().map_or("", |(_, name)| name);
        let mut waiting = Vec::new();
        let mut wait = |format, path, file, holds: &str, scale| {
            waiting.push(Waiting { file, path, format, holds: holds.to_owned(), scale });
        };
        for open in std::mem::take(&mut self.open) {
            match open {
                Open::Exr(path, planes) => {
                    let file = self.exr(&path, &planes, metadata)?;
                    wait(Format::Exr, path, file, "f32", 1.0);
                }
                Open::Npy(path, writer) => wait(Format::Npy, path, writer.close()?, "f32", 1.0),
                Open::Ktx2(path, writer) => {
                    wait(Format::Ktx2, path, writer.close()?, of_texels, 1.0);
                }
                Open::Png(pictures) => {
                    let (channels, bits) = self.picture_form();
                    let holds =
                        format!("{} of {bits} bits", ["Y", "YA", "RGB", "RGBA"][channels - 1]);
                    for (path, file, scale) in pictures {
                        wait(Format::Png, path, file, &holds, scale);
                    }
                }
            }
        }
        Ok(Whole { map: self, waiting })
    }

    fn exr(
        &self,
        path: &Path,
        planes: &[Vec<f32>],
        metadata: &[(String, String)],
    ) -> Result<Written> {
        let layers = planes.iter().zip(&self.map.planes).map(|(plane, name)| Layer {
            name: String::new(),
            channels: Channels::Scalar(name, plane),
        });
        let layers: Vec<Layer> = layers.collect();
        let mut all = metadata.to_vec();
        // Stores f32 values; the encoding's entry does not apply. The field's hash is in the
        // metadata.
        all.push(("ridgelight.kind".into(), self.wanted.kind.name.into()));
        let [cols, rows] = self.size();
        files::write_exr_aside(path, rows, cols, &layers, &all)
    }
}

/// A map with all files finished.
pub struct Whole<'a> {
    map: MapFiles<'a>,
    waiting: Vec<Waiting>,
}

impl Whole<'_> {
    /// Moves all files to their names. Returns the map's manifest entry.
    pub fn place(mut self) -> Result<Json> {
        let mut files = Vec::new();
        for waiting in self.waiting {
            let path = waiting.path.clone();
            let about = std::fs::metadata(waiting.file.path());
            let bytes = about.map_err(|source| Error::Io { path, source })?.len();
            files.push(self.map.file_entry(&waiting, bytes));
            waiting.file.place()?;
        }
        let decoder = format!("{}.glsl", stem(self.map.wanted.kind));
        let text = self.map.wanted.decoder(&self.map.map);
        files::write_text(&self.map.folder.join(&decoder), &text)?;
        Ok(self.map.entry(files, &decoder))
    }
}
