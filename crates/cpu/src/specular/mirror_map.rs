//! Light of all azimuths, weighted by a Phong lobe about each direction of the sphere.

use crate::specular_tables::{Slices, Tabulated};
use crate::tolerance::{ARC_TANGENT, EPSILON};
use glam::{DVec2, DVec3};
use ridgelight::plan::Azimuth;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Tables of the device, and what their azimuths weigh.
#[derive(Clone, Copy, Debug)]
pub struct Tables<'a> {
    /// Geometry.
    pub slices: Slices,
    /// `[azimuth][node][peak]`; of one azimuth where all share it.
    pub texels: &'a [DVec3],
}

impl Tables<'_> {
    fn is_shared(&self) -> bool {
        self.texels.len() == self.slices.nodes * self.slices.peaks
    }

    fn at(&self, azimuth: usize, node: usize, peak: usize) -> DVec3 {
        let layer = if self.is_shared() { 0 } else { azimuth };
        self.texels[(layer * self.slices.nodes + node) * self.slices.peaks + peak]
    }

    /// Light of azimuth `k` up to `node`, a place among the nodes, in the lobe about `mirror`. `off` is the error of the direction
    /// and of the place.
    ///
    /// aⁿ: ln(1 - p²) changes by 2 p / (1 - p²) a p, and errs by its series' 1e-7 and 12 roundings; the exponential by (3 + 2 |x|) ulp.
    /// Where a is no larger than its error, aⁿ is at most (a + error)ⁿ.
    /// The peak's angle turns by the direction's error over a, an arc tangent and 4 ε π. Across the place's error, values change
    /// no faster than between any of the nodes and peaks there.
    pub fn light(
        &self,
        (k, azimuth): (usize, &Azimuth),
        mirror: DVec3,
        node: f64,
        [off_rad, off_node]: [f64; 2],
    ) -> Tabulated {
        let Slices { exponent: n, peaks, first_rad, nodes, .. } = self.slices;
        let (cos, sin) = (f64::from(azimuth.cos_phi), f64::from(azimuth.sin_phi));
        let along = mirror.x * cos + mirror.y * sin;
        let across = mirror.x * sin - mirror.y * cos;
        // The azimuth's sine and cosine are rounded, so the two forms of a² differ. This uses the same one as the shader.
        let p2 = across * across;
        let short2 =
            if p2 > 0.5 { along * along + mirror.z * mirror.z } else { 1.0 - p2 }.max(1e-30);
        let logarithm = -short2.ln();
        let wedge = if self.is_shared() { f64::from(azimuth.wedge_rad) } else { 1.0 };
        let weight = wedge * (-0.5 * n * logarithm).exp();
        let off_a = off_rad + 4.0 * EPSILON;
        let by_error = if short2.sqrt() < off_a { wedge * (2.0 * off_a).powf(n) } else { 0.0 };
        let x = 0.5 * n * logarithm;
        let power_off = (n * across.abs() * off_rad / short2
            + x * (1e-7 + 12.0 * EPSILON)
            + (3.0 + 2.0 * x) * 2.0 * EPSILON)
            .min(1.0);
        let per_rad = (peaks - 1) as f64 / (PI - first_rad);
        let place = (mirror.z.atan2(along) - first_rad) * per_rad;
        let turned = off_rad / short2.sqrt() + ARC_TANGENT + 4.0 * EPSILON * PI;
        let off_peak = (turned * per_rad).min(1.0) + 4.0 * EPSILON * peaks as f64;
        if place < -off_peak {
            return Tabulated::default();
        }
        let cell = |place: f64, count: usize| (place.max(0.0) as usize).min(count.max(2) - 2);
        let (peak, below) = (cell(place, peaks), cell(node, nodes));
        let (s, t) = ((place - peak as f64).clamp(0.0, 1.0), (node - below as f64).clamp(0.0, 1.0));
        let top = |i: usize| (below + i).min(nodes - 1);
        let row = |node: usize| self.at(k, node, peak).lerp(self.at(k, node, peak + 1), s);
        let light = row(top(0)).lerp(row(top(1)), t);
        // The cells that the place may lie in.
        let peaks_near = cell(place - off_peak, peaks)..=cell(place + off_peak, peaks);
        let nodes_near = cell(node - off_node, nodes)..=cell(node + off_node, nodes);
        let mut change = [DVec3::ZERO; 2];
        for (i, j) in peaks_near.flat_map(|i| nodes_near.clone().map(move |j| (i, j))) {
            let up = |j: usize| j.min(nodes - 1);
            for e in 0..2 {
                let across = (self.at(k, up(j + e), i + 1) - self.at(k, up(j + e), i)).abs();
                let along = (self.at(k, up(j + 1), i + e) - self.at(k, up(j), i + e)).abs();
                change = [change[0].max(across), change[1].max(along)];
            }
        }
        let moved = off_peak * change[0] + off_node * change[1];
        // Behind and below on one of them.
        let either = if place.abs() <= off_peak && first_rad > -PI { light } else { DVec3::ZERO };
        let tolerance =
            weight * (moved + light * (power_off + 10.0 * EPSILON) + either) + by_error * light;
        Tabulated { light: weight * light, tolerance }
    }
}

/// Direction of a texel of a map with `columns` in a turn and `height` rows.
pub fn direction(x: usize, y: usize, [columns, height]: [usize; 2]) -> DVec3 {
    let flat = DVec2::from_angle(TAU * x as f64 / columns as f64);
    let elevation = PI * (y as f64 / (height - 1) as f64 - 0.5);
    (flat * elevation.cos()).extend(elevation.sin())
}

/// Where a lobe is less than this share of its peak, the device may leave it out.
const LEAST_SHARE: f64 = 1e-7;

/// Texels of `mirror_map`: the first `width` of `columns` columns in a turn, row-major from straight down.
///
/// Directions err by 6 ε. Sums round once an azimuth. The light of a slice may be missing where it can be all of
/// a lobe below the least share: (n + 1) / 2π ∫ L cos ω dω of that slice, which is at most the sum of its lobes over all peaks, as these are
/// less than a lobe's width apart.
pub fn mirror_map(
    tables: &Tables,
    azimuths: &[Azimuth],
    (width, [columns, height]): (usize, [usize; 2]),
    texels: impl Iterator<Item = usize>,
) -> Vec<Tabulated> {
    let Slices { nodes, peaks, .. } = tables.slices;
    let whole = |k: usize| (0..peaks).map(|peak| tables.at(k, nodes - 1, peak)).sum::<DVec3>();
    let may_miss: Vec<DVec3> = azimuths
        .iter()
        .enumerate()
        .map(|(k, azimuth)| {
            let wedge = if tables.is_shared() { f64::from(azimuth.wedge_rad) } else { 1.0 };
            LEAST_SHARE * wedge * whole(k)
        })
        .collect();
    let at = |i: usize| {
        let mirror = direction(i % width, i / width, [columns, height]);
        let mut sum = Tabulated::default();
        for (k, azimuth) in azimuths.iter().enumerate() {
            let Tabulated { light, tolerance } =
                tables.light((k, azimuth), mirror, (nodes - 1) as f64, [6.0 * EPSILON, 0.0]);
            sum.light += light;
            let may_miss = if light.cmple(may_miss[k]).all() { light } else { DVec3::ZERO };
            sum.tolerance += tolerance + may_miss;
        }
        sum.tolerance += azimuths.len() as f64 * EPSILON * sum.light;
        sum
    };
    texels.map(at).collect()
}

/// The mirror direction of a view about a normal.
pub fn mirrored(normal: DVec3, view: DVec3) -> DVec3 {
    2.0 * normal.dot(view) * normal - view
}

/// Light that a grid point's horizon hides in one azimuth, from the lowest elevation to the slope `lowest`.
///
/// The mirror direction errs by `off_rad`, the slope by `off_slope`. Where the lobe is below `least_cosine` on everything that
/// is hidden, to within an error, the device may leave it out.
pub fn blocked(
    tables: &Tables,
    (k, azimuth): (usize, &Azimuth),
    (mirror, lowest): (DVec3, f64),
    least_cosine: f64,
    [off_rad, off_slope]: [f64; 2],
) -> Tabulated {
    let Slices { nodes, bottom_rad, .. } = tables.slices;
    let per_rad = (nodes - 1) as f64 / (FRAC_PI_2 - bottom_rad);
    let angle = lowest.atan();
    let node = (angle - bottom_rad) * per_rad;
    let off_node = (off_slope + ARC_TANGENT + 10.0 * EPSILON) * per_rad;
    let mut found = tables.light((k, azimuth), mirror, node, [off_rad, off_node]);
    let along = mirror.x * f64::from(azimuth.cos_phi) + mirror.y * f64::from(azimuth.sin_phi);
    let short = along.hypot(mirror.z);
    let peak = mirror.z.atan2(along);
    let near = |w: f64| short * (w - peak).cos();
    let is_within = bottom_rad <= peak && peak <= angle;
    let largest = if is_within { short } else { near(bottom_rad).max(near(angle)) };
    if largest <= least_cosine + off_rad + off_slope + 10.0 * EPSILON {
        found.tolerance += found.light;
    }
    found
}
