//! What the passes of a preview share: grids, and what their slopes are lit by.

use crate::scene::{Albedo, Sun};

/// A grid: columns and rows, and the sides of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub size: [u32; 2],
    pub cell_m: [f64; 2],
}

impl Grid {
    pub(super) fn groups(self) -> [u32; 3] {
        [self.size[0].div_ceil(8), self.size[1].div_ceil(8), 1]
    }

    pub(super) fn texels(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Direction to the sun: east, north, up.
pub(super) fn direction(sun: Option<&Sun>) -> [f32; 4] {
    let Some(sun) = sun else { return [0.0, 0.0, 1.0, 0.0] };
    let across = sun.elevation_rad.cos();
    [across * sun.azimuth_rad.cos(), across * sun.azimuth_rad.sin(), sun.elevation_rad.sin(), 0.0]
        .map(|v| v as f32)
}

/// Radiance of a white texel that faces the sun.
pub(super) fn most(sun: Option<&Sun>) -> [f32; 4] {
    let most = sun.map_or([0.0; 3], |sun| sun.irradiance.map(|e| e / std::f32::consts::PI));
    [most[0], most[1], most[2], 1.0]
}

/// A constant albedo; 1 where it is a map.
pub(super) fn colour(albedo: &Albedo) -> [f32; 4] {
    match albedo {
        Albedo::Constant([r, g, b]) => [*r, *g, *b, 1.0],
        Albedo::Map(_) => [1.0; 4],
    }
}
