//! Bake passes on a device of our own: visible points, and light scattered between them.

use glam::DVec3;

use crate::Result;
use crate::gpu::{Frame, Headless, Timing};
use crate::graph::Limits;
use crate::plan;
use crate::scene::{Border, Directions, HeightField, Scatter, Scene, VisiblePoints};

impl Headless {
    /// The visible point of each grid point in each of some directions.
    ///
    /// # Errors
    /// As [`plan::visible_points`] and [`VisiblePoints::new`].
    pub fn visible_points(
        &mut self,
        (field, border): (&HeightField, Border),
        directions: &Directions,
        limits: &Limits,
    ) -> Result<VisiblePoints> {
        let plan = plan::visible_points(field, border, directions, limits)?;
        let words = self.words_of_all(plan, field)?;
        VisiblePoints::new(field, border, directions.clone(), words)
    }

    /// The words of all outputs of a plan, one after the other; `field` is its one input.
    ///
    /// # Errors
    /// As [`with_frame`](Self::with_frame).
    pub fn words_of_all(&mut self, plan: plan::Plan, field: &HeightField) -> Result<Vec<u32>> {
        let outputs = plan.outputs().count();
        self.with_frame(plan, &[field.heights_m()], |gpu, frame| {
            gpu.draw_counted(frame)?;
            let mut words = Vec::new();
            for output in 0..outputs {
                let pixels = gpu.pixels(frame, output)?;
                words.extend(pixels.values.iter().map(|v| v.to_bits()));
            }
            Ok(words)
        })
    }

    /// Light that a field scatters by the method of dependent tests: [`plan::scatter`].
    ///
    /// # Errors
    /// As there.
    pub fn scattered(
        &mut self,
        scene: &Scene,
        points: &VisiblePoints,
        direct: &[[f32; 3]],
        scatter: &Scatter,
        limits: &Limits,
    ) -> Result<Vec<[f32; 3]>> {
        let plan = plan::scatter(scene, points.directions(), scatter, limits)?;
        let contents = plan::scatter_inputs(&plan, scene, points, direct)?;
        self.with_frame(plan, &contents, |gpu, frame| {
            gpu.draw_counted(frame)?;
            gpu.colours(frame)
        })
    }

    /// The same towards each of some views in turn ([`plan::scatter_views`]): `take` gets their light.
    ///
    /// # Errors
    /// As there; the first of `take`.
    pub fn scattered_towards(
        &mut self,
        (scene, points, direct): (&Scene, &VisiblePoints, &[[f32; 3]]),
        scatter: &Scatter,
        views: &[DVec3],
        limits: &Limits,
        take: &mut dyn FnMut(usize, Vec<[f32; 3]>) -> Result<()>,
    ) -> Result<()> {
        let at_once = plan::views_at_once(&scene.field, views.len(), limits);
        for (first, views) in views.chunks(at_once).enumerate() {
            let plan = plan::scatter_views(scene, points.directions(), scatter, views, limits)?;
            let contents = plan::scatter_inputs(&plan, scene, points, direct)?;
            let light = self.with_frame(plan, &contents, |gpu, frame| {
                gpu.draw_counted(frame)?;
                gpu.colours(frame)
            })?;
            for (view, light) in light.chunks_exact(direct.len()).enumerate() {
                take(first * at_once + view, light.to_vec())?;
            }
        }
        Ok(())
    }

    /// Runs a frame once, waits, and adds its times to [`take_timings`](Self::take_timings). Baking one light
    /// at a time takes hundreds of frames.
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub fn draw_counted(&mut self, frame: &mut Frame) -> Result<()> {
        for Timing { label, ns } in self.draw(frame)? {
            let name = label.split(' ').next().unwrap_or_default();
            match self.counted.iter_mut().find(|(known, ..)| known == name) {
                Some((_, runs, sum)) => (*runs, *sum) = (*runs + 1, *sum + ns),
                None => self.counted.push((name.to_owned(), 1, ns)),
            }
        }
        Ok(())
    }

    /// GPU times since the last call, in the order of the first runs: for every pass the sum over its runs,
    /// with their number as the label's part.
    pub fn take_timings(&mut self) -> Vec<Timing> {
        let all = std::mem::take(&mut self.counted).into_iter();
        all.map(|(name, runs, ns)| Timing { label: format!("{name} {runs} runs"), ns }).collect()
    }

    /// Colours of the first output, layer after layer.
    ///
    /// # Errors
    /// A lost device.
    pub fn colours(&mut self, frame: &Frame) -> Result<Vec<[f32; 3]>> {
        let pixels = self.pixels(frame, 0)?;
        Ok(pixels.values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect())
    }
}
