//! Irradiance from an azimuth's wedge of the environment above each elevation (TW10 eq. 7), split into the three
//! components of the normal. It is linear in them, so no normal angle is tabulated.

use glam::DVec3;
use ridgelight::plan::Azimuth;
use ridgelight::scene::Border;
use std::f64::consts::{FRAC_PI_2, PI};

/// `env_tables`, at nodes that are even in the sine of the elevation.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvTables {
    /// Elevations, from that of `bottom_sine` to the zenith: 2 or more.
    pub nodes: usize,
    /// Sine of the elevation of node 0.
    pub bottom_sine: f64,
    /// Light above a node as `[azimuth][moment][node]`, divided by π.
    pub moments: Vec<DVec3>,
    /// Mean radiance from a node to the next as `[azimuth][node]`.
    pub radiances: Vec<DVec3>,
    /// Integrals over each azimuth's wedge of cos, sin and 1.
    pub wedges: Vec<DVec3>,
}

impl EnvTables {
    /// One moment (cos, sin, vertical) of one azimuth above one node.
    pub fn at(&self, azimuth: usize, moment: usize, node: usize) -> DVec3 {
        self.moments[(azimuth * 3 + moment) * self.nodes + node]
    }

    /// From a node to the next, in the sine.
    pub fn step(&self) -> f64 {
        (1.0 - self.bottom_sine) / (self.nodes - 1) as f64
    }

    /// Exit radiance of albedo 1 from one azimuth's wedge, above the direction of slope `lowest`.
    pub fn light(&self, azimuth: usize, lowest: f64, normal: DVec3) -> DVec3 {
        let [x, y, z] = self.looked_up(azimuth, lowest / lowest.hypot(1.0));
        normal.x * x + normal.y * y + normal.z * z
    }

    /// Three moments above an elevation of this sine: those of the node below, less the part up to it.
    pub fn looked_up(&self, azimuth: usize, sine: f64) -> [DVec3; 3] {
        let step = self.step();
        let node = ((sine - self.bottom_sine) / step).max(0.0) as usize;
        let node = node.min(self.nodes - 2);
        let node_sine = self.bottom_sine + step * node as f64;
        let width = (sine - node_sine).clamp(0.0, step);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let most = (8.0 / 9.0 * step).sqrt();
        let middle = cosine + (0.5 * sine / cosine.max(1e-9) * width).clamp(-most, most);
        let integrals = [middle, middle, node_sine + 0.5 * width].map(|mean| mean * width / PI);
        let (wedge, radiance) = (self.wedges[azimuth], self.radiances[azimuth * self.nodes + node]);
        [0, 1, 2].map(|m| self.at(azimuth, m, node) - radiance * wedge[m] * integrals[m])
    }

    /// The largest change of [`looked_up`](Self::looked_up) for a sine that errs by `off`.
    pub fn change(&self, azimuth: usize, sine: f64, off: f64) -> [DVec3; 3] {
        let here = self.looked_up(azimuth, sine);
        let ends = [sine - off, sine + off].map(|s| self.looked_up(azimuth, s.clamp(-1.0, 1.0)));
        [0, 1, 2].map(|m| (ends[0][m] - here[m]).abs().max((ends[1][m] - here[m]).abs()))
    }
}

/// Sine of node 0 under a border: -1 where light may come from below horizontal.
pub fn bottom_sine(border: Border) -> f64 {
    if border == Border::Open { -1.0 } else { 0.0 }
}

/// Integrals over an azimuth's wedge of cos, sin and 1.
pub fn wedge_of(azimuth: &Azimuth) -> DVec3 {
    DVec3::new(azimuth.wedge_cos.into(), azimuth.wedge_sin.into(), azimuth.wedge_rad.into())
}

/// Integral from an elevation to the zenith: of cos² for the horizontal moments, of sin cos for the
/// vertical one.
fn moment_above(elevation: f64, vertical: bool) -> f64 {
    let (s, c) = elevation.sin_cos();
    if vertical { 0.5 * c * c } else { 0.5 * (FRAC_PI_2 - elevation - s * c) }
}

/// Tables from [`crate::env_wedges::env_wedges`], for each wedge, of an environment of `height` rows.
///
/// # Panics
/// When `nodes` is below 2 or there is no azimuth.
pub fn env_tables(
    wedge_rows: &[[DVec3; 3]],
    (height, azimuths): (usize, &[Azimuth]),
    nodes: usize,
    bottom_sine: f64,
) -> EnvTables {
    assert!(nodes >= 2, "{nodes} nodes");
    let count = azimuths.len();
    let rows = wedge_rows.len() / count;
    let mut tables = EnvTables {
        nodes,
        bottom_sine,
        moments: vec![DVec3::ZERO; count * 3 * nodes],
        radiances: vec![DVec3::ZERO; count * nodes],
        wedges: azimuths.iter().map(wedge_of).collect(),
    };
    let step = tables.step();
    for k in 0..count {
        let (mut sums, mut row) = ([DVec3::ZERO; 3], 0);
        let mut upper = FRAC_PI_2;
        for node in (0..nodes).rev() {
            let node_sine = bottom_sine + step * node as f64;
            let elevation = node_sine.min(1.0).asin();
            let mut radiance = DVec3::ZERO;
            // Whole rows above the node, then the part of the row that contains it.
            while upper > elevation {
                let row_bottom = FRAC_PI_2 - PI * (row + 1) as f64 / height as f64;
                let lower = row_bottom.max(elevation);
                let of_row = wedge_rows[k * rows + row.min(rows - 1)];
                for (moment, sum) in sums.iter_mut().enumerate() {
                    let vertical = moment == 2;
                    *sum += of_row[moment]
                        * (moment_above(lower, vertical) - moment_above(upper, vertical));
                }
                radiance += of_row[2] * (upper.sin() - lower.sin());
                upper = lower;
                row += usize::from(row_bottom >= elevation);
            }
            for (moment, sum) in sums.into_iter().enumerate() {
                tables.moments[(k * 3 + moment) * nodes + node] = sum / PI;
            }
            let wedge_rad = tables.wedges[k].z;
            if wedge_rad > 0.0 {
                tables.radiances[k * nodes + node] = radiance / (step * wedge_rad);
            }
        }
    }
    tables
}
