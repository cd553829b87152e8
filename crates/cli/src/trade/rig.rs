//! The device, the scene and the time that is left.

use std::time::Instant;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{HeightField, Method, Quality, Scene};

use crate::bench::verify;
use crate::setup;

/// What ends a trade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// Wall-clock seconds for the whole trade.
    Seconds(f64),
    /// A number of measured settings. Takes as long as it takes, and measures as many on a slow machine as on a fast one.
    Evaluations(usize),
}

pub struct Rig<'a> {
    pub gpu: Headless,
    pub limits: Limits,
    pub scene: &'a Scene,
    contents: Vec<Vec<f32>>,
    begun: Instant,
    pub budget: Budget,
}

impl<'a> Rig<'a> {
    pub fn new(gpu: Headless, limits: Limits, scene: &'a Scene, budget: Budget) -> Self {
        // The baseline's frame stays beside the one that is measured.
        let limits = Limits { memory_budget: limits.memory_budget / 2, ..limits };
        let contents = plan::picture_inputs(scene);
        Self { gpu, limits, scene, contents, begun: Instant::now(), budget }
    }

    /// Seconds since the start.
    pub fn spent(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Seconds of the budget that are left: below 0 when it is overdrawn, infinite where evaluations are counted.
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

    /// Whether the search ends after `measured` settings, with a fraction of the seconds kept back.
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
        let plan = self.plan(self.scene, quality)?;
        let contents: Vec<&[f32]> = self.contents.iter().map(Vec::as_slice).collect();
        self.gpu.frame(plan, &contents)
    }

    /// The radiance that a frame holds, as one plane where all is grey, else three; voids are NaN.
    ///
    /// # Errors
    /// Light that is no number.
    pub fn radiance(&mut self, frame: &Frame) -> Result<Vec<Vec<f32>>> {
        let pixels = self.gpu.pixels(frame, 0)?;
        crate::render::check_finite(&pixels, &self.scene.field)?;
        let stride = pixels.channels;
        let mut planes: Vec<Vec<f32>> = (0..stride.min(3))
            .map(|c| pixels.values.iter().skip(c).step_by(stride).copied().collect())
            .collect();
        planes.iter_mut().for_each(|plane| setup::mask_voids(&self.scene.field, plane, 1));
        Ok(planes)
    }

    /// The radiance of another scene of the same field, drawn once.
    pub fn draw_once(&mut self, scene: &Scene, quality: &Quality) -> Result<Vec<Vec<f32>>> {
        let plan = self.plan(scene, quality)?;
        let contents = plan::picture_inputs(scene);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let mut frame = self.gpu.frame(plan, &contents)?;
        let drawn = self.gpu.draw(&mut frame).and_then(|_| self.radiance(&frame));
        self.gpu.end(frame);
        drawn
    }

    /// Seconds that an azimuth of the whole field will take, from drawing a piece of its middle: in
    /// proportion to the samples, and by brute force to the length of the rays.
    pub fn seconds_per_azimuth(&mut self, scene: &Scene, quality: &Quality) -> Result<f64> {
        let piece = verify::piece(scene)?;
        let few = Quality { azimuths: 8, sun_azimuths: 2, ..*quality };
        let plan = self.plan(&piece, &few)?;
        let azimuths = plan.azimuths.len() as f64;
        let contents = plan::picture_inputs(&piece);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let mut frame = self.gpu.frame(plan, &contents)?;
        // The first compiles.
        let first = self.gpu.draw(&mut frame);
        let begun = Instant::now();
        let second = first.and_then(|_| self.gpu.draw(&mut frame));
        let seconds = begun.elapsed().as_secs_f64();
        self.gpu.end(frame);
        second?;
        let samples = |f: &HeightField| (f.rows() * f.cols()) as f64;
        let side = |f: &HeightField| f.rows().max(f.cols()) as f64;
        let (whole, part) = (&self.scene.field, &piece.field);
        let longer = match quality.method {
            Method::Brute => side(whole) / side(part),
            _ => 1.0,
        };
        Ok(seconds / azimuths * longer * samples(whole) / samples(part))
    }
}
