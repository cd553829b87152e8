//! A map's notes, its entries in the manifest, and the move of its files to their names.

use std::path::Path;

use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Block, Component, Layer, Written};
use serde_json::{Value as Json, json};

use super::{Format, MapFiles, Open, Waiting};

impl MapFiles<'_> {
    /// Finishes all files under temporary names. Formats that can, store `metadata`.
    pub fn complete(&mut self, metadata: &[(String, String)]) -> Result<()> {
        // In the order of the formats.
        let mut pictures = Some(std::mem::take(&mut self.waiting));
        for (open, format) in
            std::mem::take(&mut self.open).into_iter().zip(self.wanted.formats.clone())
        {
            let path = self.folder.join(self.wanted.file(&self.map, format, 0));
            let file = match open {
                Open::Exr(planes) => self.exr(&path, &planes, metadata)?,
                Open::Npy(writer) => writer.close()?,
                Open::Ktx2(writer) => writer.close()?,
                Open::Dds(writer) => writer.close()?,
                Open::Tif(writer) => writer.close(&[metadata, &self.texts[..1]].concat())?,
                Open::Png => {
                    self.waiting.extend(pictures.take().into_iter().flatten());
                    continue;
                }
            };
            let planes = 0..self.map.planes.len();
            self.waiting.push(Waiting { file, path, format, scale: 1.0, planes });
        }
        Ok(())
    }

    fn exr(
        &self,
        path: &Path,
        planes: &[Vec<f32>],
        metadata: &[(String, String)],
    ) -> Result<Written> {
        let layers = planes.iter().zip(&self.map.planes);
        let layers: Vec<_> = layers.map(|(plane, name)| Layer::scalar(name, plane)).collect();
        // Stores f32 values; the encoding's entry does not apply. The field's hash is in the
        // metadata.
        let all = [metadata, &self.texts[..1]].concat();
        let [cols, rows] = self.size();
        files::write_exr_aside(path, rows, cols, &layers, &all)
    }

    /// The map's notes, with those about compression and about values outside their range.
    pub fn notes(&self) -> Vec<String> {
        let mut all = self.remarks.clone();
        if let Some(block) = self.wanted.block {
            let each = self.wanted.encoding.bounds.iter().zip(self.measured.worst_and_rms());
            let each = each.map(|(bound, [worst, rms])| {
                let unit = if bound.unit.is_empty() { "" } else { " " };
                format!(
                    "{} at most {worst:.2e}{unit}{1}, RMS {rms:.2e}{unit}{1}",
                    bound.of, bound.unit
                )
            });
            let name = block.vulkan().1.trim_end_matches("_BLOCK");
            all.push(format!("error of {name}: {}", each.collect::<Vec<_>>().join("; ")));
            let [cols, rows] = self.size();
            if self.has(Format::Dds) && [cols, rows].iter().any(|side| !side.is_multiple_of(4)) {
                all.push(format!(
                    "Direct3D loads a .dds of blocks only if its sides are multiples of 4, and these are {cols} x {rows}; \
                     cut the field with --bbox, or omit --compress"
                ));
            }
        }
        let (count, most) = self.beyond;
        if count == 0 {
            return all;
        }
        let (kind, component) = (self.wanted.kind, self.wanted.encoding.component);
        let has_codes = self.has_textures() || self.has(Format::Png);
        let is_clamped = component.is_normalised() && has_codes;
        let ends = if is_clamped { "; textures and .png clamp them" } else { "" };
        let cause = match kind.is_light() {
            true if component == Component::F16 && self.has_textures() => {
                format!("textures store f16; use --encoding {}=f32", kind.name)
            }
            true => "they exceed f32".to_owned(),
            false => "too few azimuths for such slopes".to_owned(),
        };
        all.push(format!(
            "{count} values lie beyond their range, by up to {most:.2e}{ends}: {cause}"
        ));
        all
    }

    /// The map's entry.
    fn entry(&mut self, files: Vec<Json>, decoder: &str) -> Json {
        let values = self.map.values.iter();
        let values = values
            .map(|v| json!({ "name": v.name, "about": v.about, "unit": v.unit, "range": v.range }));
        let order = self.map.order(self.wanted.kind);
        let planes: Vec<_> = order.iter().map(|plane| &self.map.planes[*plane]).collect();
        let mut entry = json!({
            "kind": self.wanted.kind.name, "about": self.wanted.kind.about,
            "values": values.collect::<Vec<_>>(), "planes": planes,
            "encoding": self.wanted.encoding.name, "decoder": decoder, "files": files,
        });
        if self.beyond.0 > 0 {
            let (count, most) = self.beyond;
            entry["beyond_range"] = json!({ "values": count, "at_most": most });
        }
        if let Some(normals) = self.map.normals {
            entry["normals"] = normals.describe();
        }
        if !self.map.axes.is_empty() {
            let axes = self.map.axes.iter();
            entry["axes"] =
                axes.map(|(name, count)| json!({ "axis": name, "count": count })).collect();
        }
        for (name, what) in std::mem::take(&mut self.entries) {
            entry[name] = what;
        }
        entry
    }

    /// The entry of one file.
    fn file_entry(&self, waiting: &Waiting, bytes: u64) -> Json {
        let Waiting { format, ref path, scale, ref planes, .. } = *waiting;
        let (encoding, texels) = (self.wanted.encoding, self.wanted.texels());
        let is_scaled = format == Format::Png && self.is_scaled();
        let holds = match format {
            Format::Exr | Format::Npy | Format::Tif => "f32".to_owned(),
            Format::Ktx2 | Format::Dds => {
                self.wanted.stored().vulkan().map_or("", |(_, name)| name).to_owned()
            }
            Format::Png => {
                let (channels, bits) = self.picture_form();
                format!("{} of {bits} bits", ["Y", "YA", "RGB", "RGBA"][channels - 1])
            }
        };
        let decoding = match format {
            Format::Exr | Format::Npy | Format::Tif => "the values themselves".to_owned(),
            _ if is_scaled => format!("{}, each times scale", encoding.decoding),
            Format::Png if encoding.component.is_signed() => {
                format!("{}, with 2v - 1 in place of a pixel value v (0 to 1)", encoding.decoding)
            }
            _ => encoding.decoding.to_owned(),
        };
        let component = if is_scaled { Component::Unorm16 } else { encoding.component };
        let bound = |of: &str, unit: &str, most: f64, share: f64| json!({ "of": of, "unit": unit, "at_most": most, "and_of_the_value": share });
        let bounds: Vec<Json> = match format {
            // Rounding from f64 to f32.
            Format::Exr | Format::Npy | Format::Tif => {
                vec![bound("value", "", 0.0, 1.0 / f64::from(1 << 24))]
            }
            Format::Ktx2 | Format::Dds if self.wanted.block.is_some() => {
                let all = encoding.bounds.iter().zip(self.measured.worst_and_rms());
                let of = |(b, [worst, rms]): (&ridgelight_bake::Bound, [f64; 2])| {
                    let mut entry = bound(b.of, b.unit, worst, 0.0);
                    entry["rms"] = json!(rms);
                    entry["is"] = "measured over the first mip level of this file".into();
                    entry
                };
                all.map(of).collect()
            }
            Format::Ktx2 | Format::Dds | Format::Png => {
                let of = |b: &ridgelight_bake::Bound| {
                    bound(b.of, b.unit, scale * b.absolute(component), b.relative(component))
                };
                encoding.bounds.iter().map(of).collect()
            }
        };
        let mut entry = json!({
            "file": path.file_name().map(|n| n.to_string_lossy()), "format": format.name(), "bytes": bytes,
            "texels": holds, "decoding": decoding, "error": bounds,
        });
        if is_scaled {
            entry["scale"] = json!(scale);
        }
        if self.wanted.names_planes(format) {
            entry["planes"] = json!(self.map.planes[planes.clone()]);
        }
        if format.is_texture() {
            entry["mip_levels"] = self.wanted.level_sizes(self.size()).len().into();
        }
        if format == Format::Ktx2 && component.is_normalised() && component.bytes() == 2 {
            entry["sampled"] = format!(
                "check VkFormatProperties of VK_FORMAT_{holds}: Vulkan does not require it"
            )
            .into();
        }
        if self.voids().is_some() {
            entry["voids"] = match format {
                Format::Exr | Format::Npy | Format::Tif => "NaN",
                Format::Png => "transparent: alpha is the last channel",
                Format::Ktx2 | Format::Dds
                    if texels.count > encoding.components
                        && self.wanted.block != Some(Block::Bc6h) =>
                {
                    "values of the ground filled in from around; a is 0 there, else 1"
                }
                Format::Ktx2 | Format::Dds => "values of the ground filled in from around",
            }
            .into();
        }
        entry
    }

    /// Moves all finished files to their names. Returns the map's manifest entry.
    pub fn place(mut self) -> Result<Json> {
        let mut files = Vec::new();
        for waiting in std::mem::take(&mut self.waiting) {
            let about = std::fs::metadata(waiting.file.path());
            let bytes = about.map_err(|e| Error::io(&waiting.path, e))?.len();
            files.push(self.file_entry(&waiting, bytes));
            waiting.file.place()?;
        }
        let decoder = format!("{}.glsl", self.wanted.kind.stem());
        let text = self.wanted.decoder(&self.map);
        files::write_text(&self.folder.join(&decoder), &text)?;
        Ok(self.entry(files, &decoder))
    }
}
