//! Indirect light at a grid point: the visible intervals of its own lines, nearest first, found through the occluders
//! of a sweep and weighted in closed form.
//!
//! The occluders of a swept line form its hull tree (Timonen 2012): everything between a grid point and its occluder
//! lies below the straight line between the two. For a receiver farther along, if something nearer hides both ends,
//! it hides everything between; where the far end rises above it, the points between are visited.

use crate::Rgb;
use crate::shared::bounced::{Along, Cast, NEARLY_RAD, light_and_weight};
use crate::shared::field::{field_slope, normal_of};
use crate::shared::fuse::{nearest_texel, split_crossing, surface_on_line};
use crate::shared::gather::{Swept, elevation_moments};
use crate::shared::sweep::{CELL_SHIFT, March, NO_SLOPE, PER_CELL, wrapped};
use glam::{DVec2, DVec3};
use ridgelight::plan::azimuths::{Azimuth, CELL};

/// Indirect light at a grid point, and the work to find it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Walked {
    /// Radiance times weight.
    pub light: DVec3,
    /// Weight of all directions above the grid point's own plane.
    pub whole: f64,
    /// Points of the hull tree visited.
    pub turns: u32,
    /// Visible intervals.
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

/// Its visible intervals, azimuth by azimuth, distances in march steps; and the count of points visited.
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
    march: March<'a>,
    swept: &'a Swept<'a>,
    exit: &'a [[f32; 3]],
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
            march,
            swept,
            exit,
            lane,
            step,
            own: swept.heights.at(col, row),
            normal: normal_of(gradient),
            plane: gradient.dot(direction) as f32,
        }
    }

    /// Lane position and step, that many steps ahead.
    fn place(&self, back: i32) -> (i32, i32) {
        (self.lane * CELL - back * self.march.azimuth.shear, self.step - back)
    }

    fn slope_at(&self, back: i32) -> f32 {
        let (y, step) = self.place(back);
        surface_on_line(&self.march, y, step)
            .map_or(NO_SLOPE, |h| (h - self.own) / (back as f32 * self.march.azimuth.step_m))
    }

    fn leaving(&self, lane: i32, step: i32) -> DVec3 {
        let [col, row] = self.march.grid_point(lane, step);
        let texel = self.exit[row as usize * self.march.heights.cols + col as usize];
        DVec3::from_array(texel.map(f64::from))
    }

    fn light_at(&self, back: i32) -> DVec3 {
        let (y, step) = self.place(back);
        let t = f64::from((y & (CELL - 1)) as f32 * PER_CELL);
        let cell = y >> CELL_SHIFT;
        self.leaving(cell, step).lerp(self.leaving(cell + 1, step), t)
    }

    /// Steps from there to the occluder of the nearest swept line; 0 for none.
    fn occluder_at(&self, back: i32) -> i32 {
        let (mut y, mut step) = self.place(back);
        if self.march.periodic() {
            (y, step) = (wrapped(y, self.march.lanes * CELL), wrapped(step, self.march.steps));
        }
        nearest_texel(self.swept, &self.march, y, step).map_or(0, |texel| {
            i32::from(self.swept.lattices.of(&self.march.azimuth).occluders[texel])
        })
    }

    fn walked(&self) -> Progress {
        let azimuth = &self.march.azimuth;
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

        let mut reach = self.step + self.swept.warm_up(azimuth);
        if !self.march.periodic() && azimuth.shear > 0 {
            reach = reach.min(self.lane * CELL / azimuth.shear);
        }
        // Nothing rises behind the point where the nearest line has no occluder.
        let limit = self.occluder_at(0).max(1).min(reach);
        if limit < 1 {
            return progress;
        }
        // The triangle of the grid point: the first surface is met at once.
        let next = Place { steps: 1.0, slope: self.slope_at(1), light: self.light_at(1) };
        let own = self.leaving(self.lane, self.step);
        match split_crossing(&self.march, (self.lane, self.step), self.own) {
            None => progress.add(next.slope, 1.0, [own, DVec3::ZERO]),
            Some(split) => {
                progress.add(split.slope, split.steps, [own, DVec3::ZERO]);
                let side = self.leaving(self.lane - 1, self.step);
                let light = side.lerp(self.leaving(self.lane, self.step - 1), split.steps.into());
                progress
                    .add_interval(Place { steps: split.steps, slope: split.slope, light }, next);
            }
        }
        let (mut at, mut near) = (1, next);
        while at < limit {
            progress.turns += 1;
            let back = self.occluder_at(at);
            if back == 0 {
                break;
            }
            let mut to = (at + back).min(limit);
            let mut slope = self.slope_at(to);
            if slope > progress.reached && to > at + 1 {
                to = at + 1;
                slope = self.slope_at(to);
            }
            let far = Place { steps: to as f32, slope, light: self.light_at(to) };
            progress.add_interval(near, far);
            (at, near) = (to, far);
        }
        progress
    }
}
