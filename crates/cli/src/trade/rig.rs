//! The device, the scene and the remaining time.

use std::time::Instant;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{HeightField, Method, Quality, Scene};

use crate::bench::verify;
use crate::setup;

/// The end of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// Wall-clock seconds for the whole command.
    Seconds(f64),
    /// A number of measured settings, independent of the machine's speed.
    Evaluations(usize),
}

pub struct Rig<'a> {
    pub gpu: Headless,
    pub limits: Limits,
    pub scene: &'a Scene,
    begun: Instant,
    pub budget: Budget,
}

impl<'a> Rig<'a> {
    pub fn new(gpu: Headless, limits: Limits, scene: &'a Scene, budget: Budget) -> Self {
        // Two frames exist at a time: the baseline's and the measured one.
        let limits = Limits { memory_budget: limits.memory_budget / 2, ..limits };
        Self { gpu, limits, scene, begun: Instant::now(), budget }
    }

    /// Seconds since the start.
    pub fn spent(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Seconds left of the budget: negative when overdrawn, infinite where evaluations are counted.
    pub fn left(&self) -> f64 {
        self.share(1.0) - self.spent()
    }

    /// A fraction of the budget in seconds, infinite where evaluations are counted.
    pub fn share(&self, fraction: f64) -> f64 {
        match self.budget {
            Budget::Seconds(all) => fraction * all,
            Budget::Evaluations(_) => f64::INFINITY,
        }
    }

    /// Whether the search ends after `measured` settings, with a fraction of the seconds reserved.
    pub fn is_spent(&self, measured: usize, kept: f64) -> bool {
        match self.budget {
            Budget::Seconds(_) => self.left() <= self.share(kept),
            Budget::Evaluations(most) => measured >= most,
        }
    }

    pub fn plan(&self, scene: &Scene, quality: &Quality) -> Result<Plan> {
        plan::picture(scene, quality, &self.limits, Picture::default())
    }

    pub fn frame(&mut self, quality: &Quality) -> Result<Frame> {
        self.gpu.frame(self.plan(self.scene, quality)?, &plan::picture_inputs(self.scene))
    }

    /// Makes a frame, passes it to `work` and frees it, also after an error.
    pub fn with_frame<T>(
        &mut self,
        quality: &Quality,
        work: impl FnOnce(&mut Self, &mut Frame) -> Result<T>,
    ) -> Result<T> {
        let mut frame = self.frame(quality)?;
        let done = work(self, &mut frame);
        self.gpu.end(frame);
        done
    }

    /// Nanoseconds of all passes of a frame, drawn once.
    pub fn draw_ns(&self, frame: &mut Frame) -> Result<f64> {
        Ok(setup::total_ns(&self.gpu.draw(frame)?))
    }

    /// A frame's radiance: one plane where all is grey, else three; voids are NaN.
    ///
    /// # Errors
    /// Radiance that is not finite.
    pub fn radiance(&mut self, frame: &Frame) -> Result<Vec<Vec<f32>>> {
        let pixels = self.gpu.pixels(frame, 0)?;
        crate::render::check_finite(&pixels, &self.scene.field)?;
        Ok(setup::planes(&pixels, &self.scene.field))
    }

    /// The radiance of another scene of the same field, drawn once.
    pub fn draw_once(&mut self, scene: &Scene, quality: &Quality) -> Result<Vec<Vec<f32>>> {
        let plan = self.plan(scene, quality)?;
        let mut frame = self.gpu.frame(plan, &plan::picture_inputs(scene))?;
        let drawn = self.gpu.draw(&mut frame).and_then(|_| self.radiance(&frame));
        self.gpu.end(frame);
        drawn
    }

    /// Estimated seconds per azimuth of the whole field, from a piece of its middle: proportional
    /// to the texels, and for brute force to the rays' length.
    pub fn seconds_per_azimuth(&mut self, scene: &Scene, quality: &Quality) -> Result<f64> {
        let piece = verify::piece(scene)?;
        let few = Quality { azimuths: 8, sun_azimuths: 2, ..*quality };
        let plan = self.plan(&piece, &few)?;
        let azimuths = plan.azimuths.len() as f64;
        let seconds = self.gpu.with_frame(plan, &plan::picture_inputs(&piece), |gpu, frame| {
            // The first draw compiles.
            gpu.draw(frame)?;
            let begun = Instant::now();
            gpu.draw(frame)?;
            Ok(begun.elapsed().as_secs_f64())
        })?;
        let grid_points = |f: &HeightField| (f.rows() * f.cols()) as f64;
        let side = |f: &HeightField| f.rows().max(f.cols()) as f64;
        let (whole, part) = (&self.scene.field, &piece.field);
        let longer = match quality.method {
            Method::BruteForce => side(whole) / side(part),
            _ => 1.0,
        };
        Ok(seconds / azimuths * longer * grid_points(whole) / grid_points(part))
    }
}
