//! Irradiance from an azimuth's wedge of the environment above each elevation (TW10 eq. 7), split into the three
//! components of the normal. It is linear in them, so no normal angle is tabulated.

use glam::DVec3;
use ridgelight::scene::Border;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// `env_tables` as `[azimuth][moment][node]`, divided by π.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvTables {
    /// Elevations, from `bottom_rad` to the zenith: 2 or more.
    pub nodes: usize,
    /// Elevation of node 0.
    pub bottom_rad: f64,
    /// The tables.
    pub texels: Vec<DVec3>,
}

impl EnvTables {
    /// One moment (cos, sin, vertical) of one azimuth above one node.
    pub fn at(&self, azimuth: usize, moment: usize, node: usize) -> DVec3 {
        self.texels[(azimuth * 3 + moment) * self.nodes + node]
    }

    /// Exit radiance of albedo 1 from one azimuth's wedge, above the direction of slope `lowest`.
    pub fn light(&self, azimuth: usize, lowest: f64, normal: DVec3) -> DVec3 {
        let [[x, _], [y, _], [z, _]] = self.looked_up(azimuth, lowest, 0.0);
        normal.x * x + normal.y * y + normal.z * z
    }

    /// Three moments above the direction of slope `lowest`; and for each its largest change between two nodes, for an
    /// elevation error of `off_rad`.
    pub fn looked_up(&self, azimuth: usize, lowest: f64, off_rad: f64) -> [[DVec3; 2]; 3] {
        let (nodes, bottom) = (self.nodes, self.bottom_rad);
        let place = |elevation: f64| {
            let place = (elevation - bottom) / (FRAC_PI_2 - bottom) * (nodes - 1) as f64;
            place.clamp(0.0, (nodes - 1) as f64)
        };
        let angle = lowest.atan();
        let node = |place: f64| (place as usize).min(nodes - 2);
        let [first, last] = [angle - off_rad, angle + off_rad].map(|a| node(place(a)));
        let here = node(place(angle));
        let t = place(angle) - here as f64;
        [0, 1, 2].map(|moment| {
            let at = |node| self.at(azimuth, moment, node);
            let step = |i| (at(i + 1) - at(i)).abs();
            let steepest = (first..=last).map(step).fold(DVec3::ZERO, DVec3::max);
            [at(here).lerp(at(here + 1), t), steepest]
        })
    }
}

/// Elevation of node 0 under a border: -π/2 where light may come from below horizontal.
pub fn bottom_rad(border: Border) -> f64 {
    if border == Border::Open { -FRAC_PI_2 } else { 0.0 }
}

/// Integral from an elevation to the zenith: of cos² for the horizontal moments, of sin cos for the
/// vertical one.
fn moment_above(elevation: f64, vertical: bool) -> f64 {
    let (s, c) = elevation.sin_cos();
    if vertical { 0.5 * c * c } else { FRAC_PI_4 - 0.5 * elevation - 0.5 * s * c }
}

/// Tables from [`crate::env_wedges::env_wedges`], for each of `azimuths` wedges, of an environment of
/// `height` rows.
///
/// # Panics
/// When `nodes` is below 2 or there is no azimuth.
pub fn env_tables(
    wedge_rows: &[[DVec3; 3]],
    (height, azimuths): (usize, usize),
    nodes: usize,
    bottom_rad: f64,
) -> EnvTables {
    assert!(nodes >= 2, "{nodes} nodes");
    let rows = wedge_rows.len() / azimuths;
    let mut texels = vec![DVec3::ZERO; azimuths * 3 * nodes];
    for k in 0..azimuths {
        for moment in 0..3 {
            let vertical = moment == 2;
            let (mut sum, mut row) = (DVec3::ZERO, 0);
            let (mut upper, mut above_upper) = (FRAC_PI_2, 0.0);
            for node in (0..nodes).rev() {
                let elevation =
                    bottom_rad + (FRAC_PI_2 - bottom_rad) * node as f64 / (nodes - 1) as f64;
                // Whole rows above the node, then the part of the row that contains it.
                while upper > elevation {
                    let row_bottom = FRAC_PI_2 - PI * (row + 1) as f64 / height as f64;
                    let lower = row_bottom.max(elevation);
                    let above_lower = moment_above(lower, vertical);
                    let radiance = wedge_rows[k * rows + row.min(rows - 1)][moment];
                    sum += radiance * (above_lower - above_upper);
                    upper = lower;
                    above_upper = above_lower;
                    row += usize::from(row_bottom >= elevation);
                }
                texels[(k * 3 + moment) * nodes + node] = sum / PI;
            }
        }
    }
    EnvTables { nodes, bottom_rad, texels }
}
