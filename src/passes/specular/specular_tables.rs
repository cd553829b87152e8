use std::f32::consts::{FRAC_PI_2, PI};

use crate::graph::{Builder, Format, Owner, ResourceId, shaders};
use crate::scene::{Border, Environment, Specular};

/// Where a lobe is less than this share of its peak, it counts as dark.
pub(super) const LEAST_SHARE: f32 = 1e-7;

/// What horizons hide is summed at every second level of exponents: see levels.glsl.
pub(crate) const SWEPT_EVERY: usize = 2;

/// Texels of a level in the constants: see levels.glsl.
pub(crate) const LEVEL_TEXELS: usize = 3;

/// Exponents that a surface needs tables for: its single one, or the exponent levels of a specular map, evenly spaced in ln(n + 1) and at
/// most ln 2 / 2 apart. The lowest is 0, because a map on the device may hold smaller exponents than the planned one.
pub(crate) fn levels(specular: &Specular) -> Vec<f32> {
    let most = specular.largest().exponent;
    match specular {
        Specular::Constant(_) => vec![most],
        Specular::Map(_) => {
            let octaves = f64::from(most + 1.0).log2();
            let count = SWEPT_EVERY * octaves.ceil() as usize;
            let at = |i: usize| (octaves * i as f64 / count.max(1) as f64).exp2() - 1.0;
            (0..=count).map(|i| at(i) as f32).collect()
        }
    }
}

/// Levels per unit of ln(n + 1).
pub(crate) fn levels_per_log(levels: &[f32]) -> f32 {
    match levels {
        [_, .., most] => (levels.len() - 1) as f32 / (most + 1.0).ln(),
        _ => 0.0,
    }
}

/// Exponents with tables of their own, as three texels of constants each: see levels.glsl.
#[derive(Clone, Copy)]
pub(crate) struct MapLevels {
    pub constants: ResourceId,
    pub first_texel: usize,
    pub count: u32,
    /// Levels per unit of ln(n + 1).
    pub per_log: f32,
    /// None where all texels have one exponent.
    pub map_images: Option<MapImages>,
}

/// Additional images for a specular map.
#[derive(Clone, Copy)]
pub(crate) struct MapImages {
    pub phong_map: ResourceId,
    /// `blocked_sum` of the level above each texel's exponent.
    pub blocked_above: ResourceId,
}

impl MapImages {
    pub(crate) fn bound(&self) -> [(&'static str, ResourceId); 2] {
        [("phong_map", self.phong_map), ("blocked_above", self.blocked_above)]
    }
}

/// Tables of light below each elevation, weighted by a Phong lobe.
#[derive(Clone, Copy)]
pub(crate) struct SpecularTables {
    pub exponent: f32,
    /// Share of its peak that a lobe may have in the nearest azimuth: it may point between two.
    pub nearest_share: f32,
    /// Elevations of the lobe's peak, from `first_rad` to π.
    pub(crate) peaks: u32,
    /// Column of the first peak within the image.
    pub(crate) first_peak: u32,
    /// Elevations up to which light is hidden, from the lowest to the zenith; 1 for the zenith alone.
    pub(super) nodes: u32,
    /// One for each azimuth; one for all of them under a sky alone.
    layers: u32,
    border: Border,
    pub tables: ResourceId,
}

impl SpecularTables {
    /// Makes a table for each exponent. Neighbouring azimuths are at most 2 `gap_rad` apart. `nodes`: see the field. The tables lie side
    /// by side in one image. Tables of whole slices reuse the same columns, because [`MirrorMap`](super::mirror_map::MirrorMap) reads
    /// each before the next is filled.
    ///
    /// Peaks lie a quarter of the lobe's deviation apart, 1/√n radians; at least 192 of them resolve the edges of an
    /// environment's brightest spots, whatever the lobe is. There are at most 1024: from n = 2,950 on they lie farther apart.
    /// Those of whole slices lie a sixteenth apart. The unoccluded reflection is linear between two, which errs by up to h²/8 of the
    /// lobe's peak, h apart in deviations: 1/2,048 instead of 1/128. There are at most 2,048: from n = 738 on, 415 with an open
    /// border, they lie farther apart.
    pub(crate) fn make(
        builder: &mut Builder,
        name: &str,
        (levels, gap_rad): (&[f32], f32),
        border: Border,
        [nodes, layers]: [u32; 2],
    ) -> Vec<Self> {
        let is_whole = nodes == 1;
        let mut width = 0;
        let mut of = |exponent: f32| {
            let nearest_share = gap_rad.min(1.5).cos().powf(exponent).max(1e-30);
            let peaks = peaks(exponent, border, is_whole);
            let first_peak = if is_whole { 0 } else { width };
            width = width.max(first_peak + peaks);
            let tables = ResourceId(0);
            Self { exponent, nearest_share, peaks, first_peak, nodes, layers, border, tables }
        };
        let mut all: Vec<Self> = levels.iter().map(|exponent| of(*exponent)).collect();
        let extent = [width, nodes, layers];
        let tables = builder.image(name, Owner::Internal, Format::Rgba32Float, extent, true);
        all.iter_mut().for_each(|it| it.tables = tables);
        all
    }

    /// Where light may come from below horizontal, a lobe may peak anywhere in a slice.
    pub(super) fn first_rad(&self) -> f32 {
        first_rad(self.border)
    }

    /// Whether light may come from below horizontal.
    pub(super) fn is_open(&self) -> bool {
        self.border == Border::Open
    }

    pub(super) fn range_rad(&self) -> f32 {
        PI - self.first_rad()
    }

    pub(crate) fn is_shared(&self) -> bool {
        self.layers == 1
    }

    /// Fills the tables from a sky's radiance and an environment's `wedge_rows`.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        part: &str,
        sky: Option<[f32; 3]>,
        rows: Option<(&Environment, ResourceId)>,
        (azimuths, is_swept): (ResourceId, bool),
    ) {
        let is_open = self.is_open();
        let [r, g, b] = sky.unwrap_or_default();
        // A sky is even: one row above horizontal, and one below.
        let [height, kept] = match rows {
            Some((environment, _)) => {
                [environment.height() as u32, environment.rows_above_ground(self.border) as u32]
            }
            None => [2, if is_open { 2 } else { 1 }],
        };
        let mut bound = vec![("specular_tables", self.tables), ("azimuths", azimuths)];
        bound.extend(rows.map(|(_, rows)| ("wedge_rows", rows)));
        let values = u64::from(self.layers) * u64::from(self.peaks) * u64::from(self.nodes);
        let read = u64::from(self.layers) * u64::from(kept) * 16;
        let pass = builder.pass(
            shaders::SpecularTables { has_environment: rows.is_some() },
            part,
            format!(
                "light below each of {} elevations in a lobe of exponent {}",
                self.nodes, self.exponent
            ),
            shaders::SPECULAR_TABLES.groups([self.peaks.div_ceil(4), self.layers, 1]),
            &shaders::SpecularTablesPush {
                height: height as i32,
                rows: kept as i32,
                peaks: self.peaks as i32,
                first_peak: self.first_peak as i32,
                nodes: self.nodes as i32,
                layers: self.layers as i32,
                bottom_rad: if is_open { -FRAC_PI_2 } else { 0.0 },
                first_rad: self.first_rad(),
                step_rad: self.range_rad() / (self.peaks - 1) as f32,
                exponent: self.exponent,
                wedge_rad: if self.is_shared() { 1.0 } else { 0.0 },
                reach_rad: 1e-4 + LEAST_SHARE.powf(1.0 / self.exponent.max(1e-3)).acos(),
                sky: [r, g, b, 0.0],
            },
            &bound,
            values * 16 + read,
            values,
        );
        // One for all under a sky, or the fine ones, which are constants.
        if is_swept {
            pass.azimuths = 0..self.layers;
        }
    }
}

fn first_rad(border: Border) -> f32 {
    if border == Border::Open { -PI } else { -FRAC_PI_2 }
}

/// Number of peaks of a table; `is_whole`: of whole slices, which have one node, so that more peaks cost little.
fn peaks(exponent: f32, border: Border, is_whole: bool) -> u32 {
    let [per_deviation, most] = if is_whole { [16.0, 2048.0] } else { [4.0, 1024.0] };
    let range_rad = PI - first_rad(border);
    let wanted = (per_deviation * exponent.sqrt() * range_rad).min(most).ceil() as u32;
    let widened = if border == Border::Open { 256 } else { 192 };
    wanted.max(widened).next_multiple_of(4) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PhongSpecular;

    /// A map's levels begin at 0, end at its largest exponent, and n + 1 grows by the same factor, √2 at most; every second one is
    /// swept, with the first and the last.
    #[test]
    fn levels_of_a_map_span_its_exponents() {
        let of = |exponent| PhongSpecular { exponent, scale: 0.5 };
        assert_eq!(levels(&Specular::Constant(of(20.0))), [20.0]);
        for most in [0.0, 0.5, 1.0, 3.0, 20.0, 300.0, 1e4_f32] {
            let all = levels(&Specular::Map(vec![of(most), of(0.0)]));
            assert_eq!((all[0], all[all.len() - 1]), (0.0, most), "{all:?}");
            assert_eq!((all.len() - 1) % SWEPT_EVERY, 0);
            let step = (most + 1.0).ln() / (all.len() - 1).max(1) as f32;
            assert!(step <= 0.5 * std::f32::consts::LN_2 + 1e-6, "{most}: {step}");
            for (i, n) in all.iter().enumerate() {
                assert!(((n + 1.0).ln() - step * i as f32).abs() < 1e-5, "{all:?}");
                let place = (n + 1.0).ln() * levels_per_log(&all);
                assert!(most == 0.0 || (place - i as f32).abs() < 1e-4, "{n}: {place}");
            }
        }
        assert_eq!(levels(&Specular::unknown(4, 0.5)).len(), 29);
    }
}
