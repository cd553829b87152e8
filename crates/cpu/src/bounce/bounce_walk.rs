//! Indirect light at a grid point: the visible ground along its own lines step by step, and farther away in the blocks
//! of the nearest swept line, each part weighted in closed form.
//!
//! Blocks are cut at the horizon, which the last one reaches: the share of ground is that below the horizon. The horizon is
//! the slope of the own line where the nearest line has its occluder, or at the edge of the field if it leaves that
//! before.

use crate::Rgb;
use crate::line_blocks::{Ground, level_at, near_steps};
use crate::shared::bounced::{Along, Cast, NEARLY_RAD, light_and_weight};
use crate::shared::field::{field_slope, normal_of};
use crate::shared::fuse::{nearest_line, split_crossing, surface_on_line};
use crate::shared::gather::{Swept, elevation_moments};
use crate::shared::sweep::{March, NO_SLOPE};
use glam::{DVec2, DVec3};
use ridgelight::plan::azimuths::{Azimuth, CELL};

/// Indirect light at a grid point, and the work to find it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Walked {
    /// Radiance times weight.
    pub light: DVec3,
    /// Weight of all directions above the grid point's own plane.
    pub whole: f64,
    /// Steps and blocks visited.
    pub turns: u32,
    /// Visible parts.
    pub visible_intervals: u32,
}

impl Walked {
    /// Exit radiance for albedo 1. Weights of a whole hemisphere sum to 1: uniform incident radiance is preserved.
    pub fn radiance(&self) -> Rgb {
        (self.light / self.whole).to_array()
    }
}

/// One grid point, from the exit radiance of all.
pub fn bounce_walk(swept: &Swept, exit: &[[f32; 3]], col: i32, row: i32) -> Walked {
    let (all, turns) = walked_along(swept, exit, col, row);
    let (light, whole) = light_and_weight(&all);
    let is_visible = |cast: &&Cast| cast.high_rad > cast.low_rad;
    let visible_intervals =
        all.iter().map(|along| along.casts.iter().filter(is_visible).count() as u32).sum();
    Walked { light: DVec3::from_array(light), whole, turns, visible_intervals }
}

/// Its visible parts, azimuth by azimuth, distances in march steps; and the count of steps and blocks visited.
pub fn walked_along(swept: &Swept, exit: &[[f32; 3]], col: i32, row: i32) -> (Vec<Along>, u32) {
    let mut turns = 0;
    let along = |azimuth| {
        let walked = Walk::new(swept, exit, azimuth, col, row).walked();
        turns += walked.turns;
        walked.along
    };
    let all = swept.azimuths.iter().map(along).collect();
    (all, turns)
}

/// A grid point's own line in one azimuth.
struct Walk<'a> {
    ground: Ground<'a>,
    swept: &'a Swept<'a>,
    lane: i32,
    step: i32,
    own: f32,
    normal: DVec3,
    /// Rise of the grid point's own plane along the azimuth.
    plane: f32,
}

/// Progress of a walk: the surface is visible up to `reached`, the slope of its last point that rose.
struct Progress {
    along: Along,
    turns: u32,
    /// Weights of the two moments.
    faces: [f64; 2],
    passed: [f64; 2],
    reached: f32,
}

/// A point of the line: distance in steps, slope, radiance.
#[derive(Clone, Copy)]
struct Place {
    steps: f32,
    slope: f32,
    light: DVec3,
}

impl Progress {
    /// The piece between two points, of which the far one may be visible: from where it rises above what is before
    /// it. Radiance is linear in the distance.
    fn add_interval(&mut self, near: Place, far: Place) {
        let under = (self.reached - near.slope).max(0.0) * near.steps;
        let over = (far.slope - self.reached) * far.steps;
        let begins = near.light.lerp(far.light, f64::from(under / (under + over)));
        let mean = if over > 0.0 { 0.5 * (begins + far.light) } else { far.light };
        self.add(far.slope, far.steps, [mean, far.light - near.light]);
    }

    /// Adds surface up to a slope, at a distance in steps; nothing where it is hidden.
    fn add(&mut self, slope: f32, steps: f32, [light, spread]: [DVec3; 2]) {
        let low_rad = f64::from(self.reached).atan();
        let high_rad = f64::from(slope).atan().max(low_rad);
        if f64::from(slope).atan() <= low_rad - NEARLY_RAD {
            return;
        }
        let reached = slope.max(self.reached);
        let here = elevation_moments(f64::from(reached));
        let weight =
            self.faces[0] * (self.passed[0] - here[0]) + self.faces[1] * (self.passed[1] - here[1]);
        let (sin, cos) = high_rad.sin_cos();
        self.along.casts.push(Cast {
            low_rad,
            high_rad,
            weight,
            facing: (self.faces[0] * cos + self.faces[1] * sin).abs() * cos,
            radiance: light.to_array(),
            spread: spread.abs().to_array(),
            distance: f64::from(steps),
            ..Cast::default()
        });
        (self.passed, self.reached) = (here, reached);
    }
}

impl<'a> Walk<'a> {
    fn new(swept: &'a Swept, exit: &'a [[f32; 3]], azimuth: &Azimuth, col: i32, row: i32) -> Self {
        let march = March::new(swept.heights, azimuth);
        let (lane, step) = march.of_grid_point(col, row);
        let gradient = field_slope(&swept.heights, col, row);
        let direction = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
        Self {
            ground: Ground { march, exit },
            swept,
            lane,
            step,
            own: swept.heights.at(col, row),
            normal: normal_of(gradient),
            plane: gradient.dot(direction) as f32,
        }
    }

    /// Lane position and step, that many steps ahead.
    fn place(&self, back: i32) -> (i32, i32) {
        (self.lane * CELL - back * self.ground.march.azimuth.shear, self.step - back)
    }

    fn slope_of(&self, height: f32, back: i32) -> f32 {
        (height - self.own) / (back as f32 * self.ground.march.azimuth.step_m)
    }

    /// A point of the own line.
    fn at(&self, back: i32) -> Place {
        let (y, step) = self.place(back);
        let height = surface_on_line(&self.ground.march, y, step);
        Place {
            steps: back as f32,
            slope: height.map_or(NO_SLOPE, |h| self.slope_of(h, back)),
            light: self.ground.light_at(y, step),
        }
    }

    fn walked(&self) -> Progress {
        let march = &self.ground.march;
        let azimuth = &march.azimuth;
        let flat = DVec2::new(azimuth.wedge_cos.into(), azimuth.wedge_sin.into());
        let faces =
            [self.normal.truncate().dot(flat), self.normal.z * f64::from(azimuth.wedge_rad)];
        let passed = elevation_moments(f64::from(self.plane));
        let whole = faces[0] * passed[0] + faces[1] * passed[1];
        let along = Along {
            azimuth_rad: f64::from(azimuth.sin_phi).atan2(azimuth.cos_phi.into()),
            low_rad: f64::from(self.plane).atan(),
            whole,
            casts: Vec::new(),
        };
        let mut progress = Progress { along, turns: 0, faces, passed, reached: self.plane };

        let on = self.step + self.swept.warm_up(azimuth);
        let mut reach = on;
        if !march.periodic() && azimuth.shear > 0 {
            reach = reach.min(self.lane * CELL / azimuth.shear);
        }
        // Nothing rises behind the occluder.
        let nearest = nearest_line(self.swept, march, self.place(0));
        let occluder = nearest
            .map_or(0, |(_, texel)| i32::from(self.swept.lattices.of(azimuth).occluders[texel]));
        let limit = occluder.max(1).min(reach);
        if limit < 1 {
            return progress;
        }
        // The triangle of the grid point: the first surface is met at once.
        let next = self.at(1);
        progress.turns += 1;
        let own = self.ground.leaving(self.lane, self.step);
        match split_crossing(march, (self.lane, self.step), self.own) {
            None => progress.add(next.slope, 1.0, [own, DVec3::ZERO]),
            Some(split) => {
                progress.add(split.slope, split.steps, [own, DVec3::ZERO]);
                let side = self.ground.leaving(self.lane - 1, self.step);
                let ahead = self.ground.leaving(self.lane, self.step - 1);
                let light = side.lerp(ahead, split.steps.into());
                progress
                    .add_interval(Place { steps: split.steps, slope: split.slope, light }, next);
            }
        }
        // Step by step, up to where the first block ends.
        let near_limit = limit.min(near_steps(self.swept.line_shift) + (on & 1));
        let mut near = next;
        for back in 2..=near_limit {
            progress.turns += 1;
            let far = self.at(back);
            progress.add_interval(near, far);
            near = far;
        }
        // Block by block, up to the horizon.
        let horizon = self.at(limit).slope;
        let (mut at, line) = (near_limit, nearest.map_or(0, |(y, _)| y));
        while at < limit {
            progress.turns += 1;
            let level = level_at(at, on - at, limit);
            let end = (line - at * azimuth.shear, self.step - at);
            let block = self.ground.line_block(end, level);
            let to = at + (1 << level);
            let top = self.slope_of(block.top_m, at + block.top_steps);
            let slope = if to >= limit { horizon } else { top.min(horizon) };
            let middle = (at + to) as f32 / 2.0;
            let before = progress.along.casts.len();
            progress.add(slope, middle, [block.light, block.spread]);
            progress.along.casts[before..].iter_mut().for_each(|cast| cast.is_block = true);
            at = to;
        }
        progress
    }
}
