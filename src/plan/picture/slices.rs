//! Specular of sky and environment by slices of a Phong lobe.

use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::azimuths::{self, Azimuth};
use crate::passes::mirror_map::{self, MirrorMap};
use crate::passes::sky_shade;
use crate::passes::specular_light::Hidden;
use crate::passes::specular_tables::{
    self, LEVEL_TEXELS, MapImages, MapLevels, SWEPT_EVERY, SpecularTables,
};
use crate::scene::{Border, Environment, Quality, Specular};

/// Tables of a Phong lobe of one exponent.
pub(super) struct SpecularLevel {
    /// Table and mirror map of the swept azimuths, only at every [`SWEPT_EVERY`]th level.
    pub swept: Option<(SpecularTables, MirrorMap)>,
    /// Table of whole slices, of the fine azimuths, and its mirror map.
    pub fine: (SpecularTables, MirrorMap),
}

/// Specular of sky and environment by tables of a Phong lobe.
pub(super) struct SpecularSlices {
    /// One, or several for a specular map.
    pub levels: Vec<SpecularLevel>,
    /// The fine azimuths, in the buffer "constants", and their rows of the environment.
    pub fine_azimuths: ResourceId,
    pub fine_count: u32,
    pub fine_rows: Option<ResourceId>,
    /// Direction of the first fine azimuth.
    pub fine_first_rad: f64,
    pub hidden: Hidden,
}

impl SpecularLevel {
    /// Three texels: see levels.glsl. The first is used only by specular maps. A constant exponent is only a push constant, so a new
    /// exponent leaves `constants` unchanged.
    fn texels(&self, is_map: bool) -> [f32; 4 * LEVEL_TEXELS] {
        let tables = self.swept.filter(|_| is_map).map_or([0.0; 4], |(tables, _)| {
            let [first, last] = [tables.first_peak, tables.peaks - 1].map(|n| n as f32);
            [tables.exponent, sky_shade::least_cosine(&tables), first, last]
        });
        let of = |map: &MirrorMap| [map.first_row, map.height, map.columns, 0].map(|n| n as f32);
        let swept = self.swept.as_ref().map_or([0.0; 4], |(_, map)| of(map));
        let texels: [_; LEVEL_TEXELS] = [tables, of(&self.fine.1), swept];
        std::array::from_fn(|i| texels[i / 4][i % 4])
    }
}

impl SpecularSlices {
    /// Of the first level, which is always swept.
    pub(super) fn first_swept(&self) -> &(SpecularTables, MirrorMap) {
        self.levels[0].swept.as_ref().expect("the first level is swept")
    }

    /// For a field of `size`.
    pub(super) fn make(
        builder: &mut Builder,
        size: [u32; 2],
        (environment, border): (Option<&Environment>, Border),
        (quality, limits): (&Quality, &Limits),
        (specular, phong_map, circle): (&Specular, Option<ResourceId>, &[Azimuth]),
    ) -> Self {
        // An azimuth for each column of the environment: a bright spot stays in its place.
        let fits = environment
            .map_or(u64::MAX, |e| limits.buffer_bytes / (48 * e.rows_above_ground(border) as u64));
        let fine_count = environment
            .map_or(512, |e| (e.width() as u32).clamp(512, 2048))
            .min(limits.image_layers)
            .min(fits.min(2048) as u32);
        let turn_rad = environment.map_or(0.0, Environment::rotation_rad);
        let fine: Vec<Azimuth> = azimuths::even_wedges(fine_count, turn_rad);
        let (fine_azimuths, first) = builder.constants(bytemuck::cast_slice(&fine));
        assert_eq!(first, 0, "azimuths are read from the first constant");
        let fine_rows = environment.map(|e| {
            let rows = e.rows_above_ground(border) as u64;
            builder.buffer("fine_rows", u64::from(fine_count) * rows * 48, false)
        });
        let exponents = specular_tables::levels(specular);
        let every: Vec<f32> = exponents.iter().copied().step_by(SWEPT_EVERY).collect();
        // A sky alone is the same in every azimuth.
        let (is_even, beside) = match environment {
            Some(_) => (false, [1, 1]),
            None => (true, [fine_count, mirror_map::repeats(circle)]),
        };
        let mut tables_and_maps =
            |names: [&str; 2], levels: &[f32], nodes: u32, count: u32, repeats: u32| {
                let layers = if is_even { 1 } else { count };
                // Azimuths placed by the light can be four times as far apart as evenly spaced ones.
                let farthest = if layers > 1 { 4.0 } else { 1.0 };
                let gap_rad = farthest * std::f32::consts::PI / count as f32;
                let of = (levels, gap_rad);
                let tables = SpecularTables::make(builder, names[0], of, border, [nodes, layers]);
                tables.into_iter().zip(MirrorMap::make(builder, names[1], levels, repeats))
            };
        let nodes = if border == Border::Open { 256 } else { 128 };
        let names = ["specular_tables", "swept_map"];
        let mut swept = tables_and_maps(names, &every, nodes, quality.azimuths, beside[1]);
        let names = ["fine_specular_tables", "unoccluded_map"];
        let fine = tables_and_maps(names, &exponents, 1, fine_count, beside[0]);
        let levels: Vec<SpecularLevel> = fine
            .enumerate()
            .map(|(i, fine)| {
                let swept = i.is_multiple_of(SWEPT_EVERY).then(|| swept.next()).flatten();
                SpecularLevel { swept, fine }
            })
            .collect();
        let mut image = |name: &str| {
            let extent = [size[0], size[1], 1];
            builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false)
        };
        let blocked_sum = image("blocked_sum");
        let map_images = phong_map
            .map(|phong_map| MapImages { phong_map, blocked_above: image("blocked_above") });
        let texels: Vec<f32> =
            levels.iter().flat_map(|level| level.texels(map_images.is_some())).collect();
        let (constants, first_texel) = builder.constants(&texels);
        let count = exponents.len() as u32;
        let per_log = specular_tables::levels_per_log(&exponents);
        let levels_of = MapLevels { constants, first_texel, count, per_log, map_images };
        Self {
            levels,
            fine_azimuths,
            fine_count,
            fine_rows,
            fine_first_rad: turn_rad + std::f64::consts::PI / f64::from(fine_count),
            hidden: Hidden { blocked_sum, levels: levels_of },
        }
    }
}
