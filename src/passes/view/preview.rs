//! Light of a coarse grid on a finer one.

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Albedo, Sun};

/// A grid: columns and rows, and the sides of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub size: [u32; 2],
    pub cell_m: [f64; 2],
}

impl Grid {
    fn groups(self) -> [u32; 3] {
        [self.size[0].div_ceil(8), self.size[1].div_ceil(8), 1]
    }

    fn texels(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Direction to the sun: east, north, up.
fn direction(sun: Option<&Sun>) -> [f32; 4] {
    let Some(sun) = sun else { return [0.0, 0.0, 1.0, 0.0] };
    let across = sun.elevation_rad.cos();
    [across * sun.azimuth_rad.cos(), across * sun.azimuth_rad.sin(), sun.elevation_rad.sin(), 0.0]
        .map(|v| v as f32)
}

/// Radiance of a white texel that faces the sun.
fn most(sun: Option<&Sun>) -> [f32; 4] {
    let most = sun.map_or([0.0; 3], |sun| sun.irradiance.map(|e| e / std::f32::consts::PI));
    [most[0], most[1], most[2], 1.0]
}

/// A constant albedo; 1 where it is a map.
fn colour(albedo: &Albedo) -> [f32; 4] {
    match albedo {
        Albedo::Constant([r, g, b]) => [*r, *g, *b, 1.0],
        Albedo::Map(_) => [1.0; 4],
    }
}

/// Takes the slopes out of the coarse grid's light.
pub(crate) fn plan_gather(
    builder: &mut Builder,
    coarse: Grid,
    sun: Option<&Sun>,
    (albedo, grey): (&Albedo, bool),
    bound: &[(&str, ResourceId)],
) {
    builder.pass(
        shaders::PreviewGather {
            grey,
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
        },
        "",
        "light without slopes, on the coarse grid",
        coarse.groups(),
        &shaders::PreviewGatherPush {
            sun: direction(sun),
            most: most(sun),
            colour: colour(albedo),
            cell_m: coarse.cell_m.map(|c| c as f32),
            cols: coarse.size[0] as i32,
            rows: coarse.size[1] as i32,
        },
        bound,
        coarse.texels() * 68,
        coarse.texels(),
    );
}

/// Lights the fine grid's slopes.
pub(crate) fn plan_shade(
    builder: &mut Builder,
    [fine, coarse]: [Grid; 2],
    sun: Option<&Sun>,
    albedo: &Albedo,
    bound: &[(&str, ResourceId)],
) {
    builder.pass(
        shaders::PreviewShade {
            has_sun: sun.is_some(),
            albedo_is_map: matches!(albedo, Albedo::Map(_)),
        },
        "",
        "light of the coarse grid on the slopes of the fine one",
        fine.groups(),
        &shaders::PreviewShadePush {
            sun: direction(sun),
            most: most(sun),
            colour: colour(albedo),
            cell_m: fine.cell_m.map(|c| c as f32),
            cols: fine.size[0] as i32,
            rows: fine.size[1] as i32,
            coarse_cols: coarse.size[0] as i32,
            coarse_rows: coarse.size[1] as i32,
            ratio: (fine.cell_m[0] / coarse.cell_m[0]) as f32,
        },
        bound,
        fine.texels() * 36,
        fine.texels(),
    );
}
