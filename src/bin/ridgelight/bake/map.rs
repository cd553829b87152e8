//! A map's files: values go to all of them as they come, layer by layer.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use ridgelight::bake::{Component, Encoding};
use ridgelight::files::{self, Channels, Ktx2Writer, Layer, NpyWriter, TexelFormat, Written};
use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use serde_json::{Value as Json, json};

use super::asked;
use super::kinds::{Kind, Map};

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Exr,
    Png,
    Npy,
    Ktx2,
}

impl Format {
    pub fn name(self) -> &'static str {
        match self {
            Format::Exr => "exr",
            Format::Png => "png",
            Format::Npy => "npy",
            Format::Ktx2 => "ktx2",
        }
    }

    /// Whether it can hold what the encoding makes of a kind.
    pub fn takes(self, kind: &Kind, encoding: &Encoding) -> bool {
        let is_picture = encoding.component.is_normalised() && encoding.components < 4;
        self != Format::Png || is_picture || asked::is_scaled(kind)
    }
}

/// What a kind's files are called, before the dot.
pub fn stem(kind: &Kind) -> String {
    kind.name.replace('-', "_")
}

/// What is written of a kind, and how.
pub struct Wanted {
    pub kind: &'static Kind,
    pub encoding: &'static Encoding,
    pub formats: Vec<Format>,
}

impl Wanted {
    pub fn layers(&self, map: &Map) -> usize {
        map.planes.len().div_ceil(self.encoding.values)
    }

    fn texels(&self) -> TexelFormat {
        // Three components have a fourth beside them, as no device must sample textures of three.
        let count = self.encoding.components;
        TexelFormat {
            component: self.encoding.component,
            count: if count == 3 { 4 } else { count },
        }
    }

    /// Of a layer's picture.
    fn picture(&self, map: &Map, layer: usize) -> String {
        let stem = stem(self.kind);
        if map.is_array { format!("{stem}_{layer:04}.png") } else { format!("{stem}.png") }
    }

    /// Every file, and the most bytes that it may take.
    pub fn files(&self, map: &Map, samples: usize) -> Vec<(String, u64)> {
        let (stem, planes) = (stem(self.kind), map.planes.len() as u64);
        let samples = map.texels(samples) as u64;
        let mut all = Vec::new();
        for format in &self.formats {
            let name = format!("{stem}.{}", format.name());
            let texels = self.texels().bytes() as u64;
            match format {
                // ZIP adds little to what it cannot make smaller.
                Format::Exr => all.push((name, 4 * planes * samples / 100 * 101 + 65_536)),
                Format::Npy => all.push((name, 4 * planes * samples + 256)),
                Format::Ktx2 => {
                    all.push((name, texels * self.layers(map) as u64 * samples + 1024));
                }
                Format::Png => {
                    let most = (texels + 2) * samples / 100 * 101 + 65_536;
                    all.extend((0..self.layers(map)).map(|k| (self.picture(map, k), most)));
                }
            }
        }
        all.push((format!("{stem}.glsl"), self.decoder(map).len() as u64));
        all
    }

    /// Bytes that its files hold until they are written: the others a layer, on its way.
    pub fn held_bytes(&self, map: &Map, samples: usize) -> u64 {
        let samples = map.texels(samples) as u64;
        let of = |format: &Format| match format {
            Format::Exr => 4 * map.planes.len() as u64 * samples,
            // Its samples, and what is packed of them.
            Format::Png => 2 * (self.texels().bytes() + 2) as u64 * samples,
            Format::Npy | Format::Ktx2 => self.texels().bytes() as u64 * samples,
        };
        self.formats.iter().map(of).sum()
    }

    /// GLSL: constants, then what reads the map by them.
    pub fn decoder(&self, map: &Map) -> String {
        let constants: String = map.constants.iter().map(|line| format!("{line}\n")).collect();
        constants + self.kind.decoder
    }
}

enum Open {
    Exr(PathBuf, Vec<Vec<f32>>),
    Npy(PathBuf, NpyWriter),
    Ktx2(PathBuf, Ktx2Writer),
    /// One a layer, each with what its samples are times.
    Png(Vec<(PathBuf, Written, f64)>),
}

/// A file that waits for its place, and what it is.
struct Waiting {
    file: Written,
    path: PathBuf,
    format: Format,
    /// Texels or samples, in words.
    holds: String,
    /// Of samples of pictures.
    scale: f64,
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
        self.remarks.push(format!("note: {}: {what}", self.wanted.kind.name));
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

    /// Whether its pictures are of floats: 16 bits, 1 at the largest of each.
    fn is_scaled(&self) -> bool {
        self.has(Format::Png) && !self.wanted.encoding.component.is_normalised()
    }

    /// What holds a component in its pictures.
    fn picture_component(&self) -> Component {
        if self.is_scaled() { Component::Unorm16 } else { self.wanted.encoding.component }
    }

    /// Channels and bits of its pictures.
    fn picture_form(&self) -> (usize, u32) {
        (self.channels(), 8 * self.picture_component().bytes() as u32)
    }

    /// What its pictures say of themselves.
    fn picture_texts(&self, scale: f64) -> Vec<(String, String)> {
        let mut texts = self.texts.clone();
        if self.is_scaled() {
            texts.retain(|(name, _)| name != "ridgelight.encoding");
            texts.push(("ridgelight.encoding".into(), "unorm16, times ridgelight.scale".into()));
            texts.push(("ridgelight.scale".into(), scale.to_string()));
        }
        texts
    }

    /// The largest number of a layer that is no void's, 1 of none.
    fn largest(&self, planes: &[&[f32]]) -> f64 {
        let voids = self.voids();
        let own = |plane: &&[f32]| {
            let all = plane.iter().enumerate().filter(|(i, _)| !voids.is_some_and(|v| v[*i]));
            all.map(|(_, v)| *v).filter(|v| v.is_finite()).fold(0.0, f32::max)
        };
        let largest = planes.iter().map(own).fold(0.0, f32::max);
        if largest > 0.0 { largest.into() } else { 1.0 }
    }

    /// A layer's texels, and its picture's samples: of signed components (v + 1)/2, over `scale`, 16 bits big-endian.
    fn coded(&self, planes: &[&[f32]], scale: f64) -> (Vec<u8>, Vec<u8>) {
        let (encoding, voids) = (self.wanted.encoding, self.voids());
        let (component, format) = (encoding.component, self.wanted.texels());
        let of_picture = self.picture_component();
        let samples = self.size().iter().product::<usize>();
        let (has_texels, has_picture) = (self.has(Format::Ktx2), self.has(Format::Png));
        let reserve = |is_wanted: bool, each: usize| {
            Vec::with_capacity(if is_wanted { each * samples } else { 0 })
        };
        let mut texels = reserve(has_texels, format.bytes());
        let mut picture = reserve(has_picture, self.channels() * of_picture.bytes());
        if !has_texels && !has_picture {
            return (texels, picture);
        }
        let (mut values, mut parts) = ([0.0; 4], [0.0; 4]);
        let (values, parts) = (&mut values[..encoding.values], &mut parts[..encoding.components]);
        for at in 0..samples {
            for (value, plane) in values.iter_mut().zip(planes) {
                *value = f64::from(plane[at]);
            }
            (encoding.encode)(values, parts);
            let is_void = voids.is_some_and(|v| v[at]);
            if has_texels {
                parts.iter().for_each(|part| component.put(*part, &mut texels));
                if parts.len() < format.count {
                    component.put(if is_void { 0.0 } else { 1.0 }, &mut texels);
                }
            }
            if has_picture {
                for part in parts.iter() {
                    let part = part / scale;
                    let part = if of_picture.is_signed() { 0.5 + 0.5 * part } else { part };
                    sample(&mut picture, of_picture, if is_void { 0.0 } else { part });
                }
                if voids.is_some() {
                    sample(&mut picture, of_picture, if is_void { 0.0 } else { 1.0 });
                }
            }
        }
        (texels, picture)
    }

    /// Lines on what was remarked, and on values beyond their range.
    pub fn notes(&self) -> Vec<String> {
        let mut all = self.remarks.clone();
        let (count, most) = self.beyond;
        if count == 0 {
            return all;
        }
        let (kind, component) = (self.wanted.kind.name, self.wanted.encoding.component);
        let ends = match component.is_normalised() {
            true if self.has(Format::Ktx2) || self.has(Format::Png) => {
                ", whose end is in .ktx2 and .png"
            }
            _ => "",
        };
        let cause = match asked::is_light(self.wanted.kind) {
            true if component == Component::F16 => {
                format!("f16 of .ktx2 holds no more, --encoding {kind}=f32 does")
            }
            true => "more than f32 holds".to_owned(),
            false => "few azimuths for such slopes".to_owned(),
        };
        all.push(format!(
            "note: {kind}: {count} values lie beyond their range{ends}, by up to {most:.2e}: {cause}"
        ));
        all
    }

    /// Ends all files, which wait beside their places; `metadata` is for those that keep it.
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
        // It holds the values themselves, and the field's hash is of the metadata.
        all.push(("ridgelight.kind".into(), self.wanted.kind.name.into()));
        let [cols, rows] = self.size();
        files::write_exr_aside(path, rows, cols, &layers, &all)
    }

    /// What is told of the whole of it.
    fn told(&mut self, files: Vec<Json>, decoder: &str) -> Json {
        let values =
            self.map.values.iter().map(
                |v| json!({ "name": v.name, "about": v.about, "unit": v.unit, "range": v.range }),
            );
        let values: Vec<Json> = values.collect();
        let mut sheet = json!({
            "kind": self.wanted.kind.name, "about": self.wanted.kind.about, "values": values,
            "planes": self.map.planes, "encoding": self.wanted.encoding.name, "decoder": decoder, "files": files,
        });
        if self.beyond.0 > 0 {
            let (count, most) = self.beyond;
            sheet["beyond_range"] = json!({ "values": count, "at_most": most });
        }
        if !self.map.axes.is_empty() {
            let axes =
                self.map.axes.iter().map(|(name, count)| json!({ "axis": name, "count": count }));
            sheet["axes"] = axes.collect();
        }
        for (name, what) in std::mem::take(&mut self.told) {
            sheet[name] = what;
        }
        sheet
    }

    /// What one file is, of so many bytes.
    fn sheet(&self, waiting: &Waiting, bytes: u64) -> Json {
        let Waiting { format, path, holds, scale, .. } = waiting;
        let (format, is_scaled) = (*format, *format == Format::Png && self.is_scaled());
        let encoding = self.wanted.encoding;
        let is_coded = matches!(format, Format::Ktx2 | Format::Png);
        let decoding = match format {
            Format::Exr | Format::Npy => "the values themselves".to_owned(),
            _ if is_scaled => format!("{}, each times scale", encoding.decoding),
            Format::Png if encoding.component.is_signed() => {
                format!("{}, where a sample v (0 to 1) stands for 2v - 1", encoding.decoding)
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
            // Of f64 to f32.
            vec![
                json!({ "of": "value", "unit": "", "at_most": 0.0, "and_of_the_value": 1.0 / f64::from(1 << 24) }),
            ]
        };
        let mut sheet = json!({
            "file": path.file_name().map(|n| n.to_string_lossy()), "format": format.name(), "bytes": bytes,
            "texels": holds, "decoding": decoding, "error": bounds,
        });
        if is_scaled {
            sheet["scale"] = json!(scale);
        }
        if format == Format::Ktx2 && component.is_normalised() && component.bytes() == 2 {
            sheet["sampled"] = format!(
                "by devices that say so of VK_FORMAT_{holds} (VkFormatProperties): Vulkan asks it of none"
            )
            .into();
        }
        if self.voids().is_some() {
            sheet["voids"] = match format {
                Format::Exr | Format::Npy => "NaN",
                Format::Png => "transparent: opacity is the last channel",
                Format::Ktx2 if self.wanted.texels().count > encoding.components => {
                    "what the ground has there once it is filled from around; a is 0 there, else 1"
                }
                Format::Ktx2 => "what the ground has there once it is filled from around",
            }
            .into();
        }
        sheet
    }
}

/// A map whose files are all made and wait.
pub struct Whole<'a> {
    map: MapFiles<'a>,
    waiting: Vec<Waiting>,
}

impl Whole<'_> {
    /// Puts all files at their places, and says what they are.
    pub fn place(mut self) -> Result<Json> {
        let mut sheets = Vec::new();
        for waiting in self.waiting {
            let path = waiting.path.clone();
            let about = std::fs::metadata(waiting.file.path());
            let bytes = about.map_err(|source| Error::Io { path, source })?.len();
            sheets.push(self.map.sheet(&waiting, bytes));
            waiting.file.place()?;
        }
        let decoder = format!("{}.glsl", stem(self.map.wanted.kind));
        let text = self.map.wanted.decoder(&self.map.map);
        files::write_text(&self.map.folder.join(&decoder), &text)?;
        Ok(self.map.told(sheets, &decoder))
    }
}

/// A sample of a picture, of as many bits as the component.
fn sample(picture: &mut Vec<u8>, component: Component, value: f64) {
    match component.bytes() {
        1 => Component::Unorm8.put(value, picture),
        _ => {
            Component::Unorm16.put(value, picture);
            let end = picture.len();
            picture.swap(end - 2, end - 1);
        }
    }
}
