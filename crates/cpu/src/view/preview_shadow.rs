//! Shadow heights of a sun along lines over the fine grid of a preview.

use crate::shadow_sweep::lines_of;
use crate::shared::sweep::{CELL_SHIFT, March};
use ridgelight::plan::azimuths::CELL;

/// The height of a shadow where no ground is ahead, as in the shader.
pub const NOTHING: f64 = -1e30;

/// Heights from which the whole sun is visible, and below which none of it is, metres over the field's base. They are row-major,
/// at each grid point those of the line that passes through it or of the last line before it. `rise_m` is the rise of a march step to the
/// sun's lower and upper edge.
pub fn preview_shadow(march: &March, rise_m: [f64; 2]) -> Vec<[f64; 2]> {
    let cols = march.heights.cols;
    let mut all = vec![[NOTHING; 2]; cols * march.heights.rows];
    let (lines, first) = lines_of(march, march.steps);
    let begin = if march.periodic() { -march.steps } else { 0 };
    for line in 0..lines {
        let mut top: Option<[f64; 2]> = None;
        for step in begin..march.steps {
            let at = first + line * CELL + step * march.azimuth.shear;
            let is_near = -CELL < at && at <= (march.lanes - 1) * CELL;
            if !march.periodic() && !is_near {
                continue;
            }
            let [below, above] =
                [0, 1].map(|on| f64::from(march.height_at((at >> CELL_SHIFT) + on, step)));
            let here = below + (above - below) * f64::from(at & (CELL - 1)) / f64::from(CELL);
            let shade = top.map(|top| [0, 1].map(|i| top[i] - rise_m[i]));
            if step >= 0 {
                let [col, row] = march.grid_point((at + CELL - 1) >> CELL_SHIFT, step);
                all[row as usize * cols + col as usize] = shade.unwrap_or([NOTHING; 2]);
            }
            top = Some(shade.map_or([here; 2], |shade| shade.map(|height| height.max(here))));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::sweep::Heights;
    use ridgelight::plan::azimuths::across_sun;
    use ridgelight::scene::{Border, HeightField, Sun};

    /// Behind a wall 6 m high across the sun's azimuth, shadow heights fall by the rise of a step per step. In front of it, on level
    /// ground, there is no shadow, except in a periodic field, where the wall repeats.
    #[test]
    fn a_wall_shades_the_ground_behind_it() {
        let cols = 6;
        let heights: Vec<f64> =
            (0..3 * cols).map(|i| if i % cols == 1 { 6.0 } else { 0.0 }).collect();
        let field = HeightField::new(3, cols, &heights, [2.0, 2.0], None).unwrap();
        // In the west.
        let sun = Sun {
            azimuth_rad: std::f64::consts::PI,
            elevation_rad: 0.5,
            diameter_rad: 0.0,
            irradiance: [1.0; 3],
        };
        let azimuth = across_sun(&sun, 1, field.cell_m())[0];
        assert_eq!(azimuth.step_m, 2.0);
        let base = field.base_m();
        let row_of = |border: Border| -> Vec<[f64; 2]> {
            let march = March::new(Heights::of(&field, border), &azimuth);
            let all = preview_shadow(&march, [1.0, 1.5]);
            (0..cols).map(|col| all[cols + col].map(|height| height + base)).collect()
        };
        let plain = row_of(Border::Plane);
        assert!(plain[0].iter().all(|height| *height < -1e29));
        assert_eq!(plain[1], [-1.0, -1.5]);
        assert_eq!(plain[2..], [[5.0, 4.5], [4.0, 3.0], [3.0, 1.5], [2.0, 0.0]]);
        let periodic = row_of(Border::Periodic);
        assert_eq!(periodic[0], [1.0, -1.5]);
        assert_eq!(periodic[2..], plain[2..]);
    }
}
