//! Kinds that the scene's lights illuminate: `scatter` and `light-field`.

use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::Scatter;
use ridgelight::{Error, Result, plan};
use serde_json::json;

use super::far_field::{self, Walked, direct, direct_plan, mask_plan, points_stage};
use super::{Job, Making, Map, MapFiles, OfLight, Stage, Value, Wanted, number, stage, take};

pub const SCATTER: OfLight = OfLight {
    is_lit: true,
    plans: |job, limits| {
        Ok(vec![
            plan::scatter(job.scene, job.around, &part(job, 0)?, limits)?,
            job.points_plan(limits)?,
            direct_plan(job, job.scene, limits)?,
        ])
    },
    bytes: |job| job.grid_points() as u64 * 212,
    stages: scatter_stages,
    make: make_scatter,
};

/// Parts of the paths, each with its own order of directions. Their spread gives the Monte Carlo
/// noise.
const PARTS: u32 = 8;

pub fn scatter(job: &Job, wanted: &Wanted) -> Result<Map> {
    let range = [0.0, far_field::largest(wanted)];
    let value = |name, about| Value { name, about, unit: "radiance", range };
    let light = match far_field::specular(job) {
        None => "radiance that leaves diffuse ground: direct light and all bounces",
        Some(_) => {
            "radiance that leaves straight up, diffuse and specular: direct light as render \
                computes it, and all bounces"
        }
    };
    let error = "one standard error from the paths alone, from eight parts of them; similar \
        texels have similar errors";
    Ok(Map {
        planes: ["R", "G", "B", "standard_error.R", "standard_error.G", "standard_error.B"]
            .map(|name| format!("scatter.{name}"))
            .into(),
        values: vec![
            value("red", light),
            value("green", light),
            value("blue", light),
            value("red_error", error),
            value("green_error", error),
            value("blue_error", error),
        ],
        is_array: true,
        ..Map::default()
    })
}

/// Paths that are traced by all parts: slightly more than requested; fewer where a part runs out of
/// directions; 0 where nothing is scattered.
pub fn paths(job: &Job, limits: &Limits) -> Result<u32> {
    let of_part = plan::scatter(job.scene, job.around, &part(job, 0)?, limits)?;
    Ok(PARTS * number(&of_part, "paths"))
}

/// An equal number of paths for each part, in total as many as requested or slightly more.
fn part(job: &Job, k: u32) -> Result<Scatter> {
    let Some(scatter) = job.scatter else {
        return Err(Error::setting("--bounces", "0 with --what scatter", "1 to 64"));
    };
    let seed = scatter.seed.wrapping_mul(PARTS).wrapping_add(k);
    Ok(Scatter { paths: scatter.paths.div_ceil(PARTS), seed, ..scatter })
}

fn scatter_stages(job: &Job, _: bool) -> Result<Vec<Stage>> {
    let bounces = job.scatter.map_or(0, |scatter| scatter.bounces);
    let steps = f64::from(paths(job, &job.limits)?) * f64::from(bounces);
    let texels = job.grid_points() as f64;
    Ok(vec![direct_stage(job), points_stage(job, 1), scattered_stage(texels * steps)])
}

fn direct_stage(job: &Job) -> Stage {
    let azimuths = far_field::direct_quality(job, job.scene).azimuths;
    let work = job.grid_points() as f64 * f64::from(azimuths);
    Stage::new(stage::DIRECT, work, "texels x azimuths")
}

fn scattered_stage(steps: f64) -> Stage {
    Stage::new(stage::SCATTERED, steps, "texels x path steps")
}

fn make_scatter(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (gpu, job, stages) = (&mut *making.gpu, making.job, making.stages);
    stages.begin(stage::DIRECT);
    let lit = direct(gpu, job, job.scene)?;
    // With specular, bounces start from the diffuse light only: specular depends on the receiver.
    let diffuse = match far_field::specular(job) {
        Some(_) => direct(gpu, job, &far_field::diffuse(job))?,
        None => lit.clone(),
    };
    stages.begin(stage::POINTS);
    let points = job.points(gpu)?;
    stages.begin(stage::SCATTERED);
    let mut sums = vec![[[0.0_f64; 2]; 3]; lit.len()];
    for k in 0..PARTS {
        stages.show(&format!("part {} of {PARTS}", k + 1));
        let light = gpu.scattered(job.scene, &points, &diffuse, &part(job, k)?, &job.limits)?;
        for (sum, v) in sums.as_flattened_mut().iter_mut().zip(light.as_flattened()) {
            let v = f64::from(*v);
            *sum = [sum[0] + v, sum[1] + v * v];
        }
    }
    let n = f64::from(PARTS);
    let of = |[sum, squares]: [f64; 2]| {
        let mean = sum / n;
        [mean, ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt()]
    };
    let found: Vec<[[f64; 2]; 3]> = sums.iter().map(|s| s.map(of)).collect();
    let all = found.iter().zip(&lit);
    let light: Vec<[f32; 3]> = all
        .map(|(scattered, own)| [0, 1, 2].map(|c| (f64::from(own[c]) + scattered[c][0]) as f32))
        .collect();
    take(files, &light)?;
    take(files, &found.iter().map(|f| f.map(|v| v[1])).collect::<Vec<_>>())?;
    let values = || found.as_flattened().iter();
    let count = values().count() as f64;
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| values().map(of).sum::<f64>() / count;
    // Plane by plane, as the files hold them.
    let light = (0..3).flat_map(|c| light.iter().map(move |texel| f64::from(texel[c])));
    let light = light.sum::<f64>() / count;
    let paths = paths(job, &job.limits)?;
    files.add_entry(
        "monte_carlo_noise",
        json!({
            "paths": paths, "directions": job.around.count(), "mean_radiance": light,
            "mean_scattered": mean(&|v| v[0]),
            "rms_standard_error": mean(&|v| v[1] * v[1]).sqrt(),
            "worst_standard_error": values().map(|v| v[1]).fold(0.0, f64::max),
            "is": "standard error of paths; excludes the error of the finite directions and of nearest \
                grid points at hits",
        }),
    );
    Ok(())
}

pub const LIGHT_FIELD: OfLight = OfLight {
    is_lit: true,
    plans: |job, limits| {
        let mut all = vec![direct_plan(job, &far_field::diffuse(job), limits)?];
        if far_field::specular(job).is_some() {
            all.extend(walked(job, limits)?);
            all.extend([job.points_plan(limits)?, mask_plan(job, limits)?]);
        } else {
            all.extend(far_field::plans(job, limits)?);
            all.extend(walked(job, limits)?);
        }
        Ok(all)
    },
    bytes: far_field::bytes_of_views,
    stages: light_field_stages,
    make: make_light_field,
};

pub fn light_field(job: &Job, wanted: &Wanted) -> Result<Map> {
    let names = (0..job.angles.count()).map(|view| format!("light_field.{view:04}"));
    let about = "radiance that leaves the texel; 0 where it is not visible";
    Ok(far_field::views(job, wanted, names, about, "radiance"))
}

/// Path bounces, towards as many views as are traced together where specular depends on the view.
fn walked(job: &Job, limits: &Limits) -> Result<Option<Plan>> {
    let has_specular = far_field::specular(job).is_some();
    let scatter = if has_specular { Some(view_paths(job)) } else { job.scatter };
    scatter.map(|scatter| far_field::scatter_plan(job, job.scene, &scatter, limits)).transpose()
}

/// Scatter settings with Phong specular, whose direct light is part of the result. Without bounces
/// only that, with one path along each direction.
pub fn view_paths(job: &Job) -> Scatter {
    let alone = Scatter { bounces: 0, paths: job.around.count() as u32, ..Scatter::default() };
    Scatter { direct_specular: true, ..job.scatter.unwrap_or(alone) }
}

/// The stage that sums triangles towards each view.
const VIEWS: &str = "views";

fn light_field_stages(job: &Job, _: bool) -> Result<Vec<Stage>> {
    let (views, texels) = (job.angles.count(), job.grid_points() as f64);
    let steps = walked(job, &job.limits)?.map(|plan| {
        let [bounces, paths] = ["bounces", "paths"].map(|name| f64::from(number(&plan, name)));
        texels * paths * bounces
    });
    let mut all = vec![direct_stage(job)];
    let has_specular = far_field::specular(job).is_some();
    if let Some(steps) = steps.filter(|_| !has_specular) {
        all.extend([points_stage(job, 1), scattered_stage(steps)]);
    }
    all.push(far_field::triangles_stage(job, views));
    if has_specular {
        let last = texels * f64::from(view_paths(job).paths) * views as f64;
        all.extend([points_stage(job, 1), scattered_stage(steps.unwrap_or(0.0) + last)]);
    } else {
        let work = far_field::triangles(job) * views as f64;
        all.push(Stage::new(VIEWS, work, "triangles x views"));
    }
    Ok(all)
}

fn make_light_field(making: &mut Making, files: &mut MapFiles) -> Result<()> {
    let (gpu, job, stages) = (&mut *making.gpu, making.job, making.stages);
    stages.begin(stage::DIRECT);
    let mut light = direct(gpu, job, &far_field::diffuse(job))?;
    let has_specular = far_field::specular(job).is_some();
    if let Some(scatter) = job.scatter.as_ref().filter(|_| !has_specular) {
        stages.begin(stage::POINTS);
        let points = job.points(gpu)?;
        stages.begin(stage::SCATTERED);
        let more = gpu.scattered(job.scene, &points, &light, scatter, &job.limits)?;
        for (own, more) in light.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
            *own += more;
        }
    }
    let directions = job.angles.directions()?;
    stages.begin(stage::TRIANGLES);
    let facets = far_field::facets(gpu, job, &directions)?;
    let none = vec![[0.0; 3]; facets.count()].into();
    let mut take_view = |view: usize, light: &[[f32; 3]]| {
        stages.show(&format!("view {} of {}", view + 1, directions.count()));
        let texels = facets.texels_from(view, &none).into_iter().zip(light);
        let texels = texels.map(|([.., share], light)| match share as f32 {
            share if share > 0.0 => [light[0], light[1], light[2], share],
            share => [0.0, 0.0, 0.0, share],
        });
        take(files, &texels.collect::<Vec<_>>())
    };
    if has_specular {
        stages.begin(stage::POINTS);
        let points = job.points(gpu)?;
        let of = (job.scene, &points, light.as_slice());
        stages.begin(stage::SCATTERED);
        let (paths, views) = (view_paths(job), directions.vectors());
        gpu.scattered_towards(of, &paths, views, &job.limits, &mut |view, more| {
            let all = light.iter().zip(&more);
            let all = all.map(|(own, more)| [0, 1, 2].map(|c| own[c] + more[c]));
            take_view(view, &all.collect::<Vec<_>>())
        })?;
    } else {
        stages.begin(VIEWS);
        (0..directions.count()).try_for_each(|view| take_view(view, &light))?;
    }
    let lights = &job.scene.lights;
    let has_sky = lights.environment.is_some() || lights.sky.is_some_and(|sky| sky != [0.0; 3]);
    let walked = walked(job, &job.limits)?;
    let walked = walked.map(|plan| Walked { plan, mirrors_sky: has_specular && has_sky });
    far_field::add_entries(files, job, &facets, walked.as_ref(), true)
}
