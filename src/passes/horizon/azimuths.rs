//! The azimuths of a sweep: even ones, ones along grid vectors, and those across a sun's disc or a key light.

mod aimed;
mod drawn;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::scene::Sun;
use crate::{Error, Result};

pub(crate) use aimed::slope;
pub use aimed::{Shape, across_key};
pub use drawn::towards_light;

pub use crate::graph::CELL;

/// Slope of a vertical direction; safe to square in f32.
pub(crate) const STEEPEST: f32 = 1e9;

pub(crate) const MARCHES_ROWS: u32 = 1;
/// Bit of an azimuth that marches against its axis.
pub const FLIPS_MARCH: u32 = 2;
/// Bit of an azimuth whose lanes are in reverse order.
pub const FLIPS_LANES: u32 = 4;

/// One azimuth with its weights. Four texels in the order of `Azimuth` and `azimuth_at` in `conventions.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Azimuth {
    /// cos φ of the swept direction: the wedge's centre, except for exact azimuths.
    pub cos_phi: f32,
    /// sin φ of the swept direction.
    pub sin_phi: f32,
    /// ∫ cos φ over the wedge.
    pub wedge_cos: f32,
    /// ∫ sin φ over the wedge.
    pub wedge_sin: f32,
    /// Width of the wedge, radians.
    pub wedge_rad: f32,
    /// World length of one march step.
    pub step_m: f32,
    /// Lane advance of a march step in 1/32768 of a cell, [0..32768].
    pub shear: i32,
    /// First layer of its result in the lattice; set by the plan.
    pub layer: u32,
    /// Which axis is marched, and which axes are flipped.
    pub flags: u32,
    /// Azimuth of the wedge's centre, radians, (-π..π].
    pub centre_rad: f32,
    /// Sun or key light: slope of the lower end of the disc's chord, or of the light.
    pub low_slope: f32,
    /// Sun or key light: slope of the upper end.
    pub high_slope: f32,
    /// Sun: radiance of the disc (times the chord's width) for irradiance 1. Key light: 1.
    pub weight: f32,
    /// Exact azimuths only: march component of the grid vector.
    pub vector_march: i32,
    /// Exact azimuths only: lane component of the grid vector.
    pub vector_lane: i32,
    /// The layer of `horizon_angles` that this azimuth writes: its index in its list before the sort by octant.
    pub horizon_layer: u32,
}

impl Azimuth {
    /// Whether its lines march along rows (towards increasing or decreasing row).
    pub fn marches_rows(&self) -> bool {
        self.flags & MARCHES_ROWS != 0
    }

    /// Which of eight octants it lies in; 0..4 march along columns, 4..8 along rows. Of each four, the first two
    /// [follow the diagonals](Self::follows_diagonals).
    pub(crate) fn octant(&self) -> usize {
        let flips = (self.flags & (FLIPS_MARCH | FLIPS_LANES)) as usize >> 1;
        [0, 2, 3, 1][flips] + if self.marches_rows() { 4 } else { 0 }
    }

    /// Whether the diagonals of the cells lie between its march axis and its lane axis.
    pub(crate) fn follows_diagonals(&self) -> bool {
        (self.flags & FLIPS_MARCH != 0) == (self.flags & FLIPS_LANES != 0)
    }

    /// The azimuth that its lines follow, radians: within 1.6e-5 of the requested one.
    pub fn swept_rad(&self, cell_m: [f64; 2]) -> f64 {
        let lane = if self.vector_march > 0 {
            f64::from(self.vector_lane) / f64::from(self.vector_march)
        } else {
            f64::from(self.shear) / f64::from(CELL)
        };
        let march = if self.flags & FLIPS_MARCH != 0 { 1.0 } else { -1.0 };
        let lane = if self.flags & FLIPS_LANES != 0 { lane } else { -lane };
        let (dcol, drow) = if self.marches_rows() { (lane, march) } else { (march, lane) };
        (-drow * cell_m[1]).atan2(dcol * cell_m[0])
    }
}

/// The sweep geometry of a direction (dcol, drow) on the grid, towards the horizon.
fn swept(dcol: f64, drow: f64, cell_m: [f64; 2]) -> Azimuth {
    let rows = drow.abs() > dcol.abs();
    let (march, lane) = if rows { (drow, dcol) } else { (dcol, drow) };
    let shear = (lane / march).abs();
    // Marching goes away from the horizon: positions count up with the horizon behind.
    let flips_march = march > 0.0;
    let flips_lanes = lane > 0.0;
    let (march_cell, lane_cell) =
        if rows { (cell_m[1], cell_m[0]) } else { (cell_m[0], cell_m[1]) };
    let shear_steps = (shear * f64::from(CELL)).round();
    let lane_step = shear_steps / f64::from(CELL) * lane_cell;
    Azimuth {
        step_m: march_cell.hypot(lane_step) as f32,
        shear: shear_steps as i32,
        flags: if rows { MARCHES_ROWS } else { 0 }
            | if flips_march { FLIPS_MARCH } else { 0 }
            | if flips_lanes { FLIPS_LANES } else { 0 },
        ..Azimuth::default()
    }
}

/// (dcol, drow) of a world azimuth. A component below 1e-15 becomes 0, so that φ = π is exactly west.
fn grid_direction(phi_rad: f64, cell_m: [f64; 2]) -> (f64, f64) {
    let tidy = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
    (tidy(phi_rad.cos()) / cell_m[0], -tidy(phi_rad.sin()) / cell_m[1])
}

fn with_wedge(azimuth: Azimuth, phi_rad: f64, wedge: [f64; 2]) -> Azimuth {
    let mut centre = (0.5 * (wedge[0] + wedge[1])).rem_euclid(TAU);
    if centre > PI {
        centre -= TAU;
    }
    Azimuth {
        cos_phi: phi_rad.cos() as f32,
        sin_phi: phi_rad.sin() as f32,
        wedge_cos: (wedge[1].sin() - wedge[0].sin()) as f32,
        wedge_sin: (wedge[0].cos() - wedge[1].cos()) as f32,
        wedge_rad: (wedge[1] - wedge[0]) as f32,
        centre_rad: centre as f32,
        ..azimuth
    }
}

/// `count` azimuths φ_k = 2πk/count, each with the wedge around it.
pub fn even(count: u32, cell_m: [f64; 2]) -> Vec<Azimuth> {
    let width = TAU / f64::from(count);
    (0..count)
        .map(|k| {
            let phi = width * f64::from(k);
            let (dcol, drow) = grid_direction(phi, cell_m);
            with_wedge(swept(dcol, drow, cell_m), phi, [phi - width / 2.0, phi + width / 2.0])
        })
        .collect()
}

/// `count` even wedges from `turn_rad` on, each with its direction and no sweep: one for each column of an environment that is
/// rotated by as much, from east counter-clockwise.
pub(crate) fn even_wedges(count: u32, turn_rad: f64) -> Vec<Azimuth> {
    let width = TAU / f64::from(count);
    let of = |k| {
        let first = turn_rad + width * f64::from(k);
        with_wedge(Azimuth::default(), first + 0.5 * width, [first, first + width])
    };
    (0..count).map(of).collect()
}

/// The integer grid vectors that replace `count` even azimuths in exact mode.
///
/// Each even azimuth becomes the vector with the smallest components whose world direction is within a quarter
/// of its wedge. Wedges then end midway between neighbours.
///
/// # Errors
/// The cells' width and height differ so much that a vector would be longer than 4096 cells.
pub fn along_grid_vectors(count: u32, cell_m: [f64; 2]) -> Result<Vec<Azimuth>> {
    let width = TAU / f64::from(count);
    let vectors: Vec<(Azimuth, f64)> = (0..count)
        .map(|k| {
            let phi = width * f64::from(k);
            let (dcol, drow) = simplest_vector(phi, width / 4.0, cell_m)?;
            let mut azimuth = swept(f64::from(dcol), f64::from(drow), cell_m);
            let (march, lane) = if azimuth.marches_rows() { (drow, dcol) } else { (dcol, drow) };
            azimuth.vector_march = march.abs();
            azimuth.vector_lane = lane.abs();
            let (march_cell, lane_cell) = if azimuth.marches_rows() {
                (cell_m[1], cell_m[0])
            } else {
                (cell_m[0], cell_m[1])
            };
            let ratio = f64::from(lane.abs()) / f64::from(march.abs());
            azimuth.step_m = march_cell.hypot(ratio * lane_cell) as f32;
            let exact = (f64::from(-drow) * cell_m[1]).atan2(f64::from(dcol) * cell_m[0]);
            // In the same revolution as φ_k.
            Ok((azimuth, exact + TAU * ((phi - exact) / TAU).round()))
        })
        .collect::<Result<_>>()?;
    let all = (0..vectors.len())
        .map(|i| {
            let (azimuth, phi) = vectors[i];
            let before = if i == 0 { vectors[vectors.len() - 1].1 - TAU } else { vectors[i - 1].1 };
            let after = if i + 1 == vectors.len() { vectors[0].1 + TAU } else { vectors[i + 1].1 };
            with_wedge(azimuth, phi, [(before + phi) / 2.0, (phi + after) / 2.0])
        })
        .collect();
    Ok(all)
}

/// Longest component of an exact azimuth's vector: the limit of the shader's i32 lane positions and its margin
/// around the field's edge.
const LONGEST_VECTOR: i32 = 4096;

/// The vector (dcol, drow) with the smallest larger component whose world direction is within `tolerance_rad`
/// of `phi_rad`. Among several, the nearest.
fn simplest_vector(phi_rad: f64, tolerance_rad: f64, cell_m: [f64; 2]) -> Result<(i32, i32)> {
    let (gx, gy) = grid_direction(phi_rad, cell_m);
    let larger = gx.abs().max(gy.abs());
    for size in 1..=LONGEST_VECTOR {
        let near = |g: f64| (g / larger * f64::from(size)).round() as i32;
        let (nx, ny) = (near(gx), near(gy));
        let best = [(nx, ny), (nx + 1, ny), (nx - 1, ny), (nx, ny + 1), (nx, ny - 1)]
            .into_iter()
            .filter(|v| *v != (0, 0) && v.0.abs().max(v.1.abs()) <= size)
            .map(|(x, y)| {
                let phi = (f64::from(-y) * cell_m[1]).atan2(f64::from(x) * cell_m[0]);
                let offset = (phi - phi_rad + PI).rem_euclid(TAU) - PI;
                (offset.abs(), (x, y))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((offset, vector)) = best
            && offset <= tolerance_rad
        {
            return Ok(vector);
        }
    }
    Err(Error::Limit {
        what: format!("`lines exact` on cells of {} × {}", cell_m[0], cell_m[1]),
        needs: format!("a grid vector near {:.2}°", phi_rad.to_degrees()),
        limit: format!("{LONGEST_VECTOR} cells"),
    })
}

/// The azimuths across a sun's disc: `count` even slices, or one for a point.
///
/// Each slice holds the disc's chord at its middle. The weights give irradiance 1 to a surface that faces the
/// unoccluded sun, for any number of slices.
pub fn across_sun(sun: &Sun, count: u32, cell_m: [f64; 2]) -> Vec<Azimuth> {
    let slope = |elevation: f64| (elevation.tan().min(f64::from(STEEPEST))) as f32;
    let slope = |elevation: f64| if elevation >= FRAC_PI_2 { STEEPEST } else { slope(elevation) };
    let at = |phi: f64, wedge: [f64; 2], low: f64, high: f64| {
        let (dcol, drow) = grid_direction(phi, cell_m);
        let low =
            if low <= -FRAC_PI_2 { -STEEPEST } else { low.tan().max(-f64::from(STEEPEST)) as f32 };
        Azimuth {
            low_slope: low.min(STEEPEST),
            high_slope: slope(high),
            ..with_wedge(swept(dcol, drow, cell_m), phi, wedge)
        }
    };
    let sun = &sun.clamped();
    let radius = sun.diameter_rad / 2.0;
    let (azimuth, elevation) = (sun.azimuth_rad, sun.elevation_rad);
    if sun.is_point() {
        return vec![Azimuth { weight: 1.0, ..at(azimuth, [azimuth; 2], elevation, elevation) }];
    }
    // A disc that contains the zenith covers all azimuths; another those within asin(sin r / cos e).
    let reach =
        if elevation + radius >= FRAC_PI_2 { PI } else { (radius.sin() / elevation.cos()).asin() };
    let width = 2.0 * reach / f64::from(count);
    let mut slices = Vec::new();
    let mut facing = 0.0;
    for k in 0..count {
        let offset = -reach + width * (f64::from(k) + 0.5);
        let phi = azimuth + offset;
        // cos of the angle to the centre = sin e sin ω + cos e cos offset cos ω = r cos(ω - ψ).
        let (s, c) = (elevation.sin(), elevation.cos() * offset.cos());
        let psi = s.atan2(c);
        // sin² of half the chord, from sin² of the radius, so that narrow discs keep their precision.
        let beside = (elevation.cos() * offset.sin()).powi(2);
        let sin2_radius = radius.sin().powi(2);
        let sin2_half = (sin2_radius - beside) / (1.0 - beside);
        // A slice that only touches the disc by rounding does not cross it.
        if sin2_half <= 1e-12 * sin2_radius {
            continue;
        }
        let half = sin2_half.sqrt().min(1.0).asin();
        let low = (psi - half).max(-FRAC_PI_2);
        let high = (psi + half).min(FRAC_PI_2);
        if low >= high {
            continue;
        }
        // ∫ cos(angle to centre) cos ω dω over the chord: the irradiance of a surface that faces the sun.
        let cos2 = |w: f64| w / 2.0 + (2.0 * w).sin() / 4.0;
        let cossin = |w: f64| w.sin().powi(2) / 2.0;
        facing += width * (c * (cos2(high) - cos2(low)) + s * (cossin(high) - cossin(low)));
        slices.push(at(phi, [phi - width / 2.0, phi + width / 2.0], low, high));
    }
    // A disc that touches the zenith has no chord at a right angle to its centre.
    if slices.is_empty() {
        return across_sun(sun, 2 * count, cell_m);
    }
    for slice in &mut slices {
        slice.weight = (width / facing) as f32;
    }
    slices
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wedges_of_even_azimuths_make_a_circle() {
        for count in [4, 7, 64, 360] {
            let all = even(count, [30.0, 90.0]);
            let sum: f64 = all.iter().map(|a| f64::from(a.wedge_rad)).sum();
            // One f32 rounding a wedge.
            assert!((sum - TAU).abs() < f64::from(count) * 1e-7 * TAU, "{count}: {sum}");
            let east: f64 = all.iter().map(|a| f64::from(a.wedge_cos)).sum();
            assert!(east.abs() < f64::from(count) * 1e-7);
        }
    }

    #[test]
    fn a_sweep_follows_its_azimuth() {
        for cell in [[1.0, 1.0], [66.0, 92.6], [3.0, 1.0]] {
            for (k, a) in even(97, cell).iter().enumerate() {
                let requested = TAU * k as f64 / 97.0;
                let offset = (a.swept_rad(cell) - requested + PI).rem_euclid(TAU) - PI;
                // Half a unit of shear, where the cell's sides differ.
                let bound = 0.5 / f64::from(CELL) * (cell[0] / cell[1]).max(cell[1] / cell[0]);
                assert!(offset.abs() <= bound, "{k}: {offset}");
            }
        }
    }

    #[test]
    fn grid_vectors_stay_in_their_wedges_and_cover_the_circle() {
        for cell in [[1.0, 1.0], [66.0, 92.6]] {
            for count in [4, 8, 16, 64, 100] {
                let all = along_grid_vectors(count, cell).unwrap();
                let sum: f64 = all.iter().map(|a| f64::from(a.wedge_rad)).sum();
                assert!((sum - TAU).abs() < f64::from(count) * 1e-6);
                for (k, a) in all.iter().enumerate() {
                    let requested = TAU * k as f64 / f64::from(count);
                    let offset = (a.swept_rad(cell) - requested + PI).rem_euclid(TAU) - PI;
                    assert!(offset.abs() <= TAU / f64::from(count) / 4.0 + 1e-9);
                    assert!(a.vector_lane <= a.vector_march && a.vector_march <= 4096);
                }
            }
        }
    }

    #[test]
    fn a_disc_of_many_slices_has_the_discs_irradiance_on_the_ground() {
        // E sin(elevation) on a horizontal surface, for a disc wholly above the horizon: the irradiance vector
        // points to the disc's centre.
        for (elevation, diameter) in [(30.0_f64, 0.53_f64), (89.9, 1.0), (60.0, 20.0), (90.0, 10.0)]
        {
            let sun = Sun {
                azimuth_rad: 1.0,
                elevation_rad: elevation.to_radians(),
                diameter_rad: diameter.to_radians(),
                irradiance: [1.0; 3],
            };
            let ground: f64 = across_sun(&sun, 256, [1.0, 1.0])
                .iter()
                .map(|a| {
                    let sin2 = |s: f32| {
                        let s = f64::from(s);
                        s * s / (1.0 + s * s)
                    };
                    f64::from(a.weight) * (sin2(a.high_slope) - sin2(a.low_slope)) / 2.0
                })
                .sum();
            let expected = elevation.to_radians().sin();
            // Midpoint rule over 256 chords of a disc: (1/256)^1.5 relative, at most.
            assert!(
                (ground / expected - 1.0).abs() < 2.5e-4,
                "{elevation}° {diameter}°: {ground} {expected}"
            );
        }
    }

    #[test]
    fn a_low_sun_keeps_its_lower_limb_below_the_horizon() {
        let sun =
            Sun { azimuth_rad: 0.0, elevation_rad: 0.0, diameter_rad: 0.01, irradiance: [1.0; 3] };
        let slices = across_sun(&sun, 5, [1.0, 1.0]);
        assert!(
            slices.iter().all(|a| (a.low_slope + a.high_slope).abs() < 1e-6 && a.high_slope > 0.0)
        );
    }

    #[test]
    fn every_sun_has_a_slice() {
        let elevations = [0.0, 1e-9, 10.0, 30.0, 85.0, 89.999_999, 90.0_f64];
        let diameters = [0.0, 1e-12, 1e-6, 1e-3, 0.01, 0.53, 10.0, 90.0_f64];
        for (elevation, diameter) in elevations.into_iter().flat_map(|e| diameters.map(|d| (e, d)))
        {
            for count in [1, 2, 3, 8] {
                let sun = Sun {
                    azimuth_rad: 2.0,
                    elevation_rad: elevation.to_radians(),
                    diameter_rad: diameter.to_radians(),
                    irradiance: [1.0; 3],
                };
                let slices = across_sun(&sun, count, [30.0, 90.0]);
                assert!(!slices.is_empty(), "{elevation}° {diameter}° {count}");
                assert!(
                    slices.iter().all(|a| a.weight.is_finite() && a.weight > 0.0),
                    "{elevation}° {diameter}° {count}"
                );
            }
        }
    }

    #[test]
    fn cells_too_unlike_for_grid_vectors_are_refused() {
        for cell in [[1.0, 1e4], [1e-9, 1.0], [1e9, 1.0]] {
            let error = along_grid_vectors(64, cell).expect_err("no vector is near");
            assert!(error.to_string().contains("cells of"), "{error}");
        }
        assert!(along_grid_vectors(64, [1.0, 20.0]).is_ok());
    }
}
