//! A map's notes and its entries in the manifest.

use ridgelight_io::Component;
use serde_json::{Value as Json, json};

use super::whole::Waiting;
use super::{Format, MapFiles, request};

impl MapFiles<'_> {
    /// The map's notes, with one about values outside their range.
    pub fn notes(&self) -> Vec<String> {
        let mut all = self.remarks.clone();
        let (count, most) = self.beyond;
        if count == 0 {
            return all;
        }
        let (kind, component) = (self.wanted.kind.name, self.wanted.encoding.component);
        let ends = match component.is_normalised() {
            true if self.has(Format::Ktx2) || self.has(Format::Png) => {
                "; .ktx2 and .png clamp them"
            }
            _ => "",
        };
        let cause = match request::is_light(self.wanted.kind) {
            true if component == Component::F16 && self.has(Format::Ktx2) => {
                format!(".ktx2 stores f16; use --encoding {kind}=f32")
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
    pub(super) fn entry(&mut self, files: Vec<Json>, decoder: &str) -> Json {
        let values =
            self.map.values.iter().map(
                |v| json!({ "name": v.name, "about": v.about, "unit": v.unit, "range": v.range }),
            );
        let values: Vec<Json> = values.collect();
        let mut entry = json!({
            "kind": self.wanted.kind.name, "about": self.wanted.kind.about, "values": values,
            "planes": self.map.planes, "encoding": self.wanted.encoding.name, "decoder": decoder, "files": files,
        });
        if self.beyond.0 > 0 {
            let (count, most) = self.beyond;
            entry["beyond_range"] = json!({ "values": count, "at_most": most });
        }
        if !self.map.axes.is_empty() {
            let axes =
                self.map.axes.iter().map(|(name, count)| json!({ "axis": name, "count": count }));
            entry["axes"] = axes.collect();
        }
        for (name, what) in std::mem::take(&mut self.entries) {
            entry[name] = what;
        }
        entry
    }

    /// The entry of one file.
    pub(super) fn file_entry(&self, waiting: &Waiting, bytes: u64) -> Json {
        let Waiting { format, path, holds, scale, .. } = waiting;
        let (format, is_scaled) = (*format, *format == Format::Png && self.is_scaled());
        let encoding = self.wanted.encoding;
        let is_coded = matches!(format, Format::Ktx2 | Format::Png);
        let decoding = match format {
            Format::Exr | Format::Npy => "the values themselves".to_owned(),
            _ if is_scaled => format!("{}, each times scale", encoding.decoding),
            Format::Png if encoding.component.is_signed() => {
                format!("{}, with 2v - 1 in place of a pixel value v (0 to 1)", encoding.decoding)
            }
            _ => encoding.decoding.to_owned(),
        };
        let component = if is_scaled { Component::Unorm16 } else { encoding.component };
        let coded = encoding.bounds.iter().map(|b| {
            let [most, share] = [scale * b.absolute(component), b.relative(component)];
            json!({ "of": b.of, "unit": b.unit, "at_most": most, "and_of_the_value": share })
        });
        let bounds: Vec<Json> = if is_coded {
            coded.collect()
        } else {
            // Rounding from f64 to f32.
            vec![
                json!({ "of": "value", "unit": "", "at_most": 0.0, "and_of_the_value": 1.0 / f64::from(1 << 24) }),
            ]
        };
        let mut entry = json!({
            "file": path.file_name().map(|n| n.to_string_lossy()), "format": format.name(), "bytes": bytes,
            "texels": holds, "decoding": decoding, "error": bounds,
        });
        if is_scaled {
            entry["scale"] = json!(scale);
        }
        if format == Format::Ktx2 && component.is_normalised() && component.bytes() == 2 {
            entry["sampled"] = format!(
                "check VkFormatProperties of VK_FORMAT_{holds}: Vulkan does not require it"
            )
            .into();
        }
        if self.voids().is_some() {
            entry["voids"] = match format {
                Format::Exr | Format::Npy => "NaN",
                Format::Png => "transparent: alpha is the last channel",
                Format::Ktx2 if self.wanted.texels().count > encoding.components => {
                    "values of the ground filled in from around; a is 0 there, else 1"
                }
                Format::Ktx2 => "values of the ground filled in from around",
            }
            .into();
        }
        entry
    }
}
