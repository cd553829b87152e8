//! What is baked of a field by looking at it along directions, on a device of our own.

use std::ops::Range;

use glam::DVec3;

use super::{Frame, Headless, Timing};
use crate::Result;
use crate::bake::{Facets, Leaving};
use crate::plan::{self, Limits};
use crate::scene::{Border, Directions, HeightField, Lights, Scatter, Scene, Sun, VisiblePoints};

/// A point of a sky, of irradiance 1 facing it.
fn sun(towards: DVec3) -> Sun {
    Sun {
        azimuth_rad: towards.y.atan2(towards.x),
        elevation_rad: towards.z.atan2(towards.truncate().length()),
        diameter_rad: 0.0,
        irradiance: [1.0; 3],
    }
}

impl Headless {
    /// What each sample sees in each of some directions.
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

    /// A field's triangles, `times` finer, and which of them are seen from each of some directions above horizontal.
    ///
    /// # Errors
    /// As [`plan::facet_mask`] and [`Facets::of`].
    pub fn facets(
        &mut self,
        scene: &Scene,
        times: usize,
        directions: &Directions,
        limits: &Limits,
    ) -> Result<Facets> {
        let border = scene.surface.border;
        let finer = scene.field.finer(border, times)?;
        let plan = plan::facet_mask(&finer, border, directions, limits)?;
        let words = self.words_of_all(plan, &finer)?;
        Facets::of(scene, times, directions.clone(), words)
    }

    fn words_of_all(&mut self, plan: plan::Plan, field: &HeightField) -> Result<Vec<u32>> {
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
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        self.with_frame(plan, &contents, |gpu, frame| {
            gpu.draw_counted(frame)?;
            gpu.colours(frame)
        })
    }

    /// The same towards each of some views in turn ([`plan::scatter_views`]): `take` is given their numbers.
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
            let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
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

    /// Runs a frame once, waits, and counts its times for [`take_timings`](Self::take_timings), as everything that is looked
    /// at along directions does: a light at a time, that is hundreds of frames.
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

    /// What was counted since this was last asked, in the order of the first runs: of every pass the sum over its runs,
    /// whose number is the label's part.
    pub fn take_timings(&mut self) -> Vec<Timing> {
        let all = std::mem::take(&mut self.counted).into_iter();
        all.map(|(name, runs, ns)| Timing { label: format!("{name} {runs} runs"), ns }).collect()
    }

    /// Layer after layer.
    fn colours(&mut self, frame: &Frame) -> Result<Vec<[f32; 3]>> {
        let pixels = self.pixels(frame, 0)?;
        Ok(pixels.values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect())
    }

    /// Radiance of all triangles under a light of irradiance 1 facing it from each of some of their directions in turn, with
    /// what the field scatters of it (`points` are of directions all around) where that is asked for: direct light of triangles, its mean at samples, from there by
    /// the method of dependent tests, and linear between samples.
    ///
    /// Lobes scatter otherwise towards each view: towards those that `views` has of a light, by its number. Samples mirror the
    /// light where their own middle sees it, by normals between those of their triangles.
    ///
    /// # Errors
    /// As [`plan::scatter_views`]; the first of `take`, which is given each light's number.
    pub fn lit_from(
        &mut self,
        scene: &Scene,
        (facets, lights, views): (&Facets, Range<usize>, &dyn Fn(usize) -> Range<usize>),
        scatter: Option<(&VisiblePoints, &Scatter)>,
        limits: &Limits,
        take: &mut dyn FnMut(usize, Leaving) -> Result<()>,
    ) -> Result<()> {
        let mut direct_alone =
            || lights.clone().try_for_each(|light| take(light, facets.lit_from(light)));
        let Some((points, scatter)) = scatter else { return direct_alone() };
        if facets.has_lobes() {
            let of = (facets, lights, views);
            return self.lit_by_lobes(scene, of, (points, scatter), limits, take);
        }
        let plan = plan::scatter(scene, points.directions(), scatter, limits)?;
        // Level or black ground scatters nothing, and its plan asks for nothing.
        let Some(direct) = plan.inputs().position(|(_, r)| r.name == "direct") else {
            return direct_alone();
        };
        let none = vec![[0.0; 3]; scene.field.heights_m().len()];
        let contents = plan::scatter_inputs(&plan, scene, points, &none)?;
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        self.with_frame(plan, &contents, |gpu, frame| {
            for light in lights {
                let mut radiance = facets.lit_from(light);
                let samples = facets.to_samples(radiance.alike());
                let texels: Vec<f32> =
                    samples.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
                gpu.refill(frame, direct, &texels)?;
                gpu.draw_counted(frame)?;
                facets.add_samples(&gpu.colours(frame)?, &mut radiance);
                take(light, radiance)?;
            }
            Ok(())
        })
    }

    fn lit_by_lobes(
        &mut self,
        scene: &Scene,
        (facets, lights, views): (&Facets, Range<usize>, &dyn Fn(usize) -> Range<usize>),
        (points, scatter): (&VisiblePoints, &Scatter),
        limits: &Limits,
        take: &mut dyn FnMut(usize, Leaving) -> Result<()>,
    ) -> Result<()> {
        let directions = facets.directions().vectors();
        let samples = scene.field.heights_m().len();
        let none = vec![[0.0; 3]; samples];
        let mut lit = Scene { lights: Lights::default(), ..scene.clone() };
        // The frame of as many views is the same under all lights.
        let mut kept: Option<(usize, Frame)> = None;
        let mut one = |gpu: &mut Self, light: usize| {
            lit.lights.suns = vec![sun(directions[light])];
            let mut radiance = facets.lit_from(light);
            let direct = facets.to_samples(radiance.alike());
            let wanted = views(light);
            let at_once = plan::views_at_once(&scene.field, wanted.len(), limits);
            let mut towards = Vec::with_capacity(wanted.len());
            for first in wanted.clone().step_by(at_once) {
                let some = &directions[first..wanted.end.min(first + at_once)];
                let around = points.directions();
                let plan = plan::scatter_views(&lit, around, scatter, some, limits)?;
                // Level or black ground scatters nothing, and its plan asks for nothing.
                let Some(place) = plan.inputs().position(|(_, r)| r.name == "direct") else {
                    return take(light, radiance);
                };
                if let Some((_, old)) = kept.take_if(|(count, _)| *count != some.len()) {
                    gpu.end(old);
                }
                let frame = match &mut kept {
                    Some((_, frame)) => {
                        gpu.replace_plan(frame, plan)?;
                        frame
                    }
                    None => {
                        let contents = plan::scatter_inputs(&plan, &lit, points, &none)?;
                        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
                        &mut kept.insert((some.len(), gpu.frame(plan, &contents)?)).1
                    }
                };
                let texels: Vec<f32> =
                    direct.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
                gpu.refill(frame, place, &texels)?;
                gpu.draw_counted(frame)?;
                let light = gpu.colours(frame)?;
                towards.extend(light.chunks_exact(samples).map(<[_]>::to_vec));
            }
            radiance = radiance.scattering(wanted.start, towards);
            take(light, radiance)
        };
        let done = lights.into_iter().try_for_each(|light| one(self, light));
        if let Some((_, frame)) = kept {
            self.end(frame);
        }
        done
    }
}
