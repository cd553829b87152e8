//! A requested map: its file names and sizes.

use clap::ValueEnum;
use ridgelight_bake::Encoding;
use ridgelight_io::TexelFormat;

use crate::bake::kinds::{Kind, Map};
use crate::bake::request;

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

    /// Whether it can hold the encoded kind.
    pub fn takes(self, kind: &Kind, encoding: &Encoding) -> bool {
        let is_picture = encoding.component.is_normalised() && encoding.components < 4;
        self != Format::Png || is_picture || request::is_scaled(kind)
    }
}

/// The stem of a kind's file names.
pub fn stem(kind: &Kind) -> String {
    kind.name.replace('-', "_")
}

/// A requested kind, its encoding and its formats.
pub struct Wanted {
    pub kind: &'static Kind,
    pub encoding: &'static Encoding,
    pub formats: Vec<Format>,
}

impl Wanted {
    pub fn layers(&self, map: &Map) -> usize {
        map.planes.len().div_ceil(self.encoding.values)
    }

    pub(super) fn texels(&self) -> TexelFormat {
        // Three components become four: devices need not sample three-component textures.
        let count = self.encoding.components;
        TexelFormat {
            component: self.encoding.component,
            count: if count == 3 { 4 } else { count },
        }
    }

    /// The file name of a layer's picture.
    pub(super) fn picture(&self, map: &Map, layer: usize) -> String {
        let stem = stem(self.kind);
        if map.is_array { format!("{stem}_{layer:04}.png") } else { format!("{stem}.png") }
    }

    /// Every file and an upper bound of its bytes.
    pub fn files(&self, map: &Map, grid_points: usize) -> Vec<(String, u64)> {
        let (stem, planes) = (stem(self.kind), map.planes.len() as u64);
        let grid_points = map.texels(grid_points) as u64;
        let mut all = Vec::new();
        for format in &self.formats {
            let name = format!("{stem}.{}", format.name());
            let texels = self.texels().bytes() as u64;
            match format {
                // ZIP adds little to incompressible data.
                Format::Exr => all.push((name, 4 * planes * grid_points / 100 * 101 + 65_536)),
                Format::Npy => all.push((name, 4 * planes * grid_points + 256)),
                Format::Ktx2 => {
                    all.push((name, texels * self.layers(map) as u64 * grid_points + 1024));
                }
                Format::Png => {
                    let most = (texels + 2) * grid_points / 100 * 101 + 65_536;
                    all.extend((0..self.layers(map)).map(|k| (self.picture(map, k), most)));
                }
            }
        }
        all.push((format!("{stem}.glsl"), self.decoder(map).len() as u64));
        all
    }

    /// Bytes that the files hold before they are written; formats that stream hold one layer.
    pub fn held_bytes(&self, map: &Map, grid_points: usize) -> u64 {
        let grid_points = map.texels(grid_points) as u64;
        let of = |format: &Format| match format {
            Format::Exr => 4 * map.planes.len() as u64 * grid_points,
            // Pixels, and the compressed copy.
            Format::Png => 2 * (self.texels().bytes() + 2) as u64 * grid_points,
            Format::Npy | Format::Ktx2 => self.texels().bytes() as u64 * grid_points,
        };
        self.formats.iter().map(of).sum()
    }

    /// GLSL: the constants, then the decoder.
    pub fn decoder(&self, map: &Map) -> String {
        let constants: String = map.constants.iter().map(|line| format!("{line}\n")).collect();
        constants + self.kind.decoder
    }
}
