//! The bound of shadow heights: nothing between two lines of a sweep is above the interpolation of their raised ground.

use ridgelight::plan::azimuths::{Azimuth, CELL, across_sun};
use ridgelight::scene::{Border, HeightField, Sun};
use ridgelight_cpu::shadow_sweep::{ShadowStep, lines_of, shadow_line};
use ridgelight_cpu::shared::sweep::{Heights, March};

use crate::field;

/// Directions in all octants, along axes and diagonals too.
fn azimuths(cell_m: [f64; 2]) -> Vec<Azimuth> {
    let degrees =
        [0.0, 7.0, 20.0, 45.0, 61.0, 90.0, 118.0, 135.0, 170.0, 200.0, 251.0, 290.0, 315.0, 339.0];
    let at = |degrees: f64| Sun {
        azimuth_rad: degrees.to_radians(),
        elevation_rad: 0.3,
        diameter_rad: 0.0,
        irradiance: [1.0; 3],
    };
    degrees.into_iter().flat_map(|d| across_sun(&at(d), 1, cell_m)).collect()
}

/// White noise; a spike, a pit and a wall on level ground; a ramp.
fn fields() -> Vec<HeightField> {
    let noise = |r: usize, c: usize| ((r * 7919 + c * 104_729 + r * c * 31) % 97) as f64 / 20.0;
    let spots = |r: usize, c: usize| match (r, c) {
        (4, 5) => 9.0,
        (8, 3) => -7.0,
        (_, 9) => 5.0,
        _ => 0.0,
    };
    vec![
        field(13, 12, [1.0, 1.0], noise),
        field(12, 13, [2.0, 3.0], spots),
        field(9, 14, [1.0, 1.0], |r, c| 0.7 * r as f64 - 0.3 * c as f64),
    ]
}

/// The largest height of the surface over an interpolation between lines, at many places of rays between them; `bound` is a
/// line's bound from one step to the next. In terms of the relief, which rounding is relative to.
fn worst(
    field: &HeightField,
    border: Border,
    bound: fn(Option<ShadowStep>, ShadowStep) -> f64,
) -> f64 {
    let mut worst = f64::MIN;
    let all = field.heights_m().iter();
    let relief = f64::from(all.fold(0.0_f32, |m, h| m.max(h.abs())).max(1e-9));
    for azimuth in azimuths(field.cell_m()) {
        let march = March::new(Heights::of(field, border), &azimuth);
        let warm_up = if march.periodic() { march.steps } else { 0 };
        let total = warm_up + march.steps;
        let (count, first) = lines_of(&march, total);
        let lines: Vec<_> =
            (0..count).map(|l| shadow_line(&march, first + l * CELL, (total, warm_up))).collect();
        let rise = f64::from(azimuth.low_slope) * f64::from(azimuth.step_m);
        let pairs = (0..count as usize - 1).map(|l| (l, l + 1));
        for ((before, after), step) in pairs.flat_map(|p| (1..total as usize).map(move |s| (p, s)))
        {
            let both = [before, after].map(|l| Some(bound(lines[l][step - 1], lines[l][step]?)));
            let [a, b] = both;
            for (i, j) in (0..=16).flat_map(|i| (0..=16).map(move |j| (i, j))) {
                let (t, u) = (f64::from(i) / 16.0, f64::from(j) / 16.0);
                let shear = f64::from(azimuth.shear) / f64::from(CELL);
                let line = f64::from(first) / f64::from(CELL) + before as f64;
                let y = line + t + (step as f64 - 1.0 + u) * shear;
                if !march.periodic() && !(0.0..=f64::from(march.lanes - 1)).contains(&y) {
                    continue;
                }
                // A line that leaves the field is not beside any ray that goes on.
                // A ray on one of the lines does not need the other.
                let (a, b) = (a.or((t == 1.0).then_some(0.0)), b.or((t == 0.0).then_some(0.0)));
                let Some((a, b)) = a.zip(b) else {
                    let after_at = line + 1.0 + step as f64 * shear;
                    assert!(after_at >= f64::from(march.lanes), "no bound at {y}, step {step}");
                    continue;
                };
                let row = step as i32 - 1 - warm_up;
                let over = surface(&march, y, row, u) + (step as f64 - 1.0 + u) * rise;
                worst = worst.max((over - (1.0 - t) * a - t * b) / relief);
            }
        }
    }
    worst
}

/// The surface at lane position `y`, `u` of the way from one row to the next.
fn surface(march: &March, y: f64, row: i32, u: f64) -> f64 {
    let cell = y.floor();
    let f = y - cell;
    let [h00, h10, h01, h11] = march.cell_heights(cell as i32, row).map(f64::from);
    if march.split_along() {
        if f <= u {
            h00 + u * (h10 - h00) + f * (h11 - h10)
        } else {
            h00 + f * (h01 - h00) + u * (h11 - h01)
        }
    } else if u + f <= 1.0 {
        h00 + u * (h10 - h00) + f * (h01 - h00)
    } else {
        h11 + (1.0 - u) * (h01 - h11) + (1.0 - f) * (h10 - h11)
    }
}

/// f64 sums of a few terms: 1e-13 of the relief and of the plane, which is a few reliefs high.
#[test]
fn nothing_between_two_lines_is_above_their_raised_ground() {
    for field in fields() {
        for border in [Border::Plane, Border::Periodic] {
            let found = worst(&field, border, |_, to| to.raised);
            assert!(found <= 1e-12, "{border:?}: {found} of the relief above the bound");
        }
    }
}

/// The higher of a line's own two heights is no bound on rough ground: the comparison finds that.
#[test]
fn without_the_raise_rough_ground_is_above() {
    for field in &fields()[..2] {
        let found = worst(field, Border::Plane, |from, to| {
            from.map_or(to.over_plane, |from| from.over_plane.max(to.over_plane))
        });
        assert!(found > 0.05, "{found}");
    }
}
