//! Expected horizons of a pyramid on uneven ground, where its levels are means of heights: those of its CPU reference,
//! in f32, from the same heights.

use std::f64::consts::FRAC_PI_2;

use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::{Axis, Azimuth};
use ridgelight::scene::{Border, Levels, Quality, Scene};
use ridgelight_cpu::height_expand::height_expand;
use ridgelight_cpu::height_reduce::height_levels;
use ridgelight_cpu::pyramid_march::{PyramidMarch, Stored};
use ridgelight_cpu::shared::levels::LevelTexels;
use ridgelight_cpu::shared::sweep::{Heights, LOWEST_MET, March};
use ridgelight_cpu::tolerance::device_pyramid_angle;

use super::{largest, relief};

/// A scene's levels, and the settings of their march.
pub struct CpuReference<'a> {
    heights: Heights<'a>,
    pyramid: Pyramid,
    levels: Vec<f32>,
    /// Of all levels, where a stack is stored.
    stack: Vec<f32>,
    /// The largest |height above the base|.
    largest_m: f64,
    /// Highest less lowest.
    relief_m: f64,
}

impl<'a> CpuReference<'a> {
    pub fn new(scene: &'a Scene, quality: &Quality) -> Self {
        let (field, border) = (&scene.field, scene.surface.border);
        let heights = Heights::of(field, border);
        let pyramid = Pyramid::new(quality, [field.cols() as u32, field.rows() as u32], border);
        let levels = height_levels(&heights, &pyramid);
        let texels = LevelTexels { pyramid: &pyramid, texels: &levels };
        let numbers = if quality.levels == Levels::Stack { pyramid.levels() } else { 0 };
        let stack = (1..=numbers).flat_map(|n| height_expand(&texels, n)).collect();
        Self { heights, pyramid, levels, stack, largest_m: largest(field), relief_m: relief(field) }
    }

    /// Elevation of a texel's horizon, and the bound of the device's error, radians.
    pub fn elevation(&self, azimuth: &Azimuth, row: usize, col: usize) -> (f64, f64) {
        let border = self.heights.border;
        let march = PyramidMarch {
            march: March::new(self.heights, azimuth),
            pyramid: &self.pyramid,
            stored: match self.pyramid.stored {
                Levels::Stack => Stored::Stack(&self.stack),
                Levels::Pyramid => Stored::Levels(&self.levels),
            },
        };
        let warm_up = Axis::of(azimuth.marches_rows(), self.pyramid.size, border).warm_up as i32;
        let (lane, step) = march.march.of_grid_point(col as i32, row as i32);
        let slope = march.slope(lane, step, warm_up);
        let angle = if slope <= LOWEST_MET { -FRAC_PI_2 } else { f64::from(slope).atan() };
        let elevation = if border == Border::Open { angle } else { angle.max(0.0) };
        let step = f64::from(azimuth.step_m);
        let error = device_pyramid_angle(self.largest_m, self.relief_m, step);
        (elevation, error)
    }
}
