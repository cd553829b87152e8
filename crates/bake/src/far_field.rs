//! Far-field reflection of a field of triangles.

use std::ops::Range;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Limits};
use ridgelight::scene::{Directions, Lights, Scatter, Scene, Sun, VisiblePoints};

use crate::{ExitRadiance, Facets};

/// A point light at infinity, of irradiance 1 facing it.
fn sun(towards: DVec3) -> Sun {
    Sun {
        azimuth_rad: towards.y.atan2(towards.x),
        elevation_rad: towards.z.atan2(towards.truncate().length()),
        diameter_rad: 0.0,
        irradiance: [1.0; 3],
    }
}

/// The triangles of a field refined `times`, and their visibility from directions above horizontal.
///
/// # Errors
/// As [`plan::facet_mask`](ridgelight::plan::facet_mask) and [`Facets::of`].
pub fn facets(
    gpu: &mut Headless,
    scene: &Scene,
    times: usize,
    directions: &Directions,
    limits: &Limits,
) -> Result<Facets> {
    let border = scene.surface.border;
    let finer = scene.field.finer(border, times)?;
    let plan = plan::facet_mask(&finer, border, directions, limits)?;
    let words = gpu.words_of_all(plan, &finer)?;
    Facets::of(scene, times, directions.clone(), words)
}

/// Radiance of all triangles under a light of irradiance 1 facing each of `lights` in turn.
///
/// With `scatter` it includes indirect light: the triangles' direct light is averaged at grid
/// points, scattered there by the method of dependent tests, and interpolated linearly. `points`
/// cover directions all around.
///
/// With Phong specular indirect light depends on the view. It is computed for the views that
/// `views` returns for a light's index. Grid points reflect the light where it is visible from the
/// grid point itself, with normals interpolated between their triangles.
///
/// # Errors
/// As [`plan::scatter_views`]; the first error of `take`, which receives each light's index.
pub fn lit_from(
    gpu: &mut Headless,
    scene: &Scene,
    (facets, lights, views): (&Facets, Range<usize>, &dyn Fn(usize) -> Range<usize>),
    scatter: Option<(&VisiblePoints, &Scatter)>,
    limits: &Limits,
    take: &mut dyn FnMut(usize, ExitRadiance) -> Result<()>,
) -> Result<()> {
    let mut direct_alone =
        || lights.clone().try_for_each(|light| take(light, facets.lit_from(light)));
    let Some((points, scatter)) = scatter else { return direct_alone() };
    if facets.has_specular() {
        let of = (facets, lights, views);
        return lit_with_specular(gpu, scene, of, (points, scatter), limits, take);
    }
    let plan = plan::scatter(scene, points.directions(), scatter, limits)?;
    // Level or black ground has no indirect light, and its plan has no inputs.
    let Some(direct) = plan.inputs().position(|(_, r)| r.name == "direct") else {
        return direct_alone();
    };
    let none = vec![[0.0; 3]; scene.field.heights_m().len()];
    let contents = plan::scatter_inputs(&plan, scene, points, &none)?;
    gpu.with_frame(plan, &contents, |gpu, frame| {
        for light in lights {
            let mut radiance = facets.lit_from(light);
            let grid = facets.to_grid_points(radiance.alike());
            let texels: Vec<f32> = grid.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
            gpu.refill(frame, direct, &texels)?;
            gpu.draw_counted(frame)?;
            facets.add_grid_points(&gpu.colours(frame)?, &mut radiance);
            take(light, radiance)?;
        }
        Ok(())
    })
}

fn lit_with_specular(
    gpu: &mut Headless,
    scene: &Scene,
    (facets, lights, views): (&Facets, Range<usize>, &dyn Fn(usize) -> Range<usize>),
    (points, scatter): (&VisiblePoints, &Scatter),
    limits: &Limits,
    take: &mut dyn FnMut(usize, ExitRadiance) -> Result<()>,
) -> Result<()> {
    let directions = facets.directions().vectors();
    let count = scene.field.heights_m().len();
    let none = vec![[0.0; 3]; count];
    let mut lit = Scene { lights: Lights::default(), ..scene.clone() };
    // Lights with the same number of views share a frame.
    let mut kept: Option<(usize, Frame)> = None;
    let mut one = |gpu: &mut Headless, light: usize| {
        lit.lights.suns = vec![sun(directions[light])];
        let mut radiance = facets.lit_from(light);
        let direct = facets.to_grid_points(radiance.alike());
        let wanted = views(light);
        let at_once = plan::views_at_once(&scene.field, wanted.len(), limits);
        let mut towards = Vec::with_capacity(wanted.len());
        for first in wanted.clone().step_by(at_once) {
            let some = &directions[first..wanted.end.min(first + at_once)];
            let around = points.directions();
            let plan = plan::scatter_views(&lit, around, scatter, some, limits)?;
            // Level or black ground has no indirect light, and its plan has no inputs.
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
                    &mut kept.insert((some.len(), gpu.frame(plan, &contents)?)).1
                }
            };
            let texels: Vec<f32> = direct.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
            gpu.refill(frame, place, &texels)?;
            gpu.draw_counted(frame)?;
            let light = gpu.colours(frame)?;
            towards.extend(light.chunks_exact(count).map(<[_]>::to_vec));
        }
        radiance = radiance.scattering(wanted.start, towards);
        take(light, radiance)
    };
    let done = lights.into_iter().try_for_each(|light| one(gpu, light));
    if let Some((_, frame)) = kept {
        gpu.end(frame);
    }
    done
}
