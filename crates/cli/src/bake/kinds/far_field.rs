//! Shared by the kinds that are light: direct light of texels, and triangles in the far field.

use std::f64::consts::PI;
use std::ops::Range;

use ridgelight::gpu::Headless;
use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::plan::{Limits, Picture, Plan};
use ridgelight::scene::{
    Border, Bounces, Directions, HeightField, Lights, PhongSpecular, Quality, Scatter, Scene,
    Specular, Sun, Surface,
};
use ridgelight::{Error, Result, plan};
use ridgelight_bake::{Angles, ExitRadiance, Facets};
use ridgelight_io::Component;
use serde_json::json;

use super::{Job, Kind, Making, Map, MapFiles, Stage, Value, Wanted, brdf, light, number, stage};

/// The largest value that the files hold: of f32, or less in a .ktx2.
pub fn largest(wanted: &Wanted) -> f64 {
    let has_texels = wanted.formats.iter().any(|format| format.is_texture());
    let is_half = wanted.encoding.component == Component::F16 && has_texels;
    if is_half { 65_504.0 } else { f64::from(f32::MAX) }
}

/// Triangles that a small field is cut into. A triangle is visible where its middle is.
const FACETS: usize = 1 << 17;
const MOST_TIMES: usize = 8;

/// How many times finer.
pub fn times(field: &HeightField) -> usize {
    let fits = |times: &usize| 2 * times * times * field.heights_m().len() <= FACETS;
    (1..=MOST_TIMES).rev().find(fits).unwrap_or(1)
}

/// The angles, for a decoder.
pub fn constants(prefix: &str, angles: Angles) -> Vec<String> {
    vec![
        format!("const int {prefix}_THETAS = {};", angles.zeniths),
        format!("const int {prefix}_PHIS = {};", angles.azimuths),
    ]
}

/// Pictures of views, each under a name.
pub fn views(
    job: &Job,
    wanted: &Wanted,
    names: impl Iterator<Item = String>,
    about: &'static str,
    unit: &'static str,
) -> Map {
    let range = [0.0, largest(wanted)];
    let colour = |name| Value { name, about, unit, range };
    let share = Value {
        name: "share",
        about: "share of the view over the texel's own cell, with slope, foreshortening and \
            masking; its mean is cos θ where the field is periodic; elsewhere relative to a \
            whole cell, of which an edge has half and a corner a third or a sixth",
        unit: "",
        range,
    };
    Map {
        planes: names
            .flat_map(|name| ["R", "G", "B", "share"].map(|c| format!("{name}.{c}")))
            .collect(),
        values: vec![colour("red"), colour("green"), colour("blue"), share],
        is_array: true,
        constants: constants(&wanted.kind.stem().to_uppercase(), job.angles),
        ..Map::default()
    }
}

/// The largest exponent and the largest scale of all Phong specular that reflects anything.
pub fn specular(job: &Job) -> Option<PhongSpecular> {
    let largest = job.scene.surface.specular.as_ref().map(|specular| specular.largest());
    largest.filter(|phong| phong.scale > 0.0)
}

/// The same scene without Phong specular.
pub fn diffuse(job: &Job) -> Scene {
    let surface = Surface { specular: None, ..job.scene.surface.clone() };
    Scene { surface, ..job.scene.clone() }
}

/// Settings of direct light.
pub fn direct_quality<'a>(job: &'a Job, scene: &Scene) -> &'a Quality {
    if scene.surface.specular.is_some() { &job.specular_quality } else { job.quality }
}

/// Direct light of all texels; specular towards straight above.
pub fn direct_plan(job: &Job, scene: &Scene, limits: &Limits) -> Result<Plan> {
    let quality = direct_quality(job, scene);
    let bounces = Bounces { count: 0, ..quality.bounces };
    let quality = Quality { bounces, ..*quality };
    let still = Picture { still: true, ..Picture::default() };
    plan::picture(scene, &quality, limits, still)
}

pub fn direct(gpu: &mut Headless, job: &Job, scene: &Scene) -> Result<Vec<[f32; 3]>> {
    let plan = direct_plan(job, scene, &job.limits)?;
    gpu.with_frame(plan, &plan::picture_inputs(scene), |gpu, frame| {
        gpu.draw_counted(frame)?;
        let pixels = gpu.pixels(frame, 0)?;
        crate::render::check_finite(&pixels, &scene.field)?;
        Ok(crate::render::rgb(&pixels))
    })
}

/// Bytes for triangles and texels in so many directions.
pub fn bytes(job: &Job, directions: usize) -> u64 {
    let grid_points = job.grid_points();
    let facets = 2 * grid_points * times(job.field()).pow(2);
    let words = 2 * directions.div_ceil(DIRECTIONS_A_WORD) * 4;
    // Slopes, albedo, specular, words before and after unpacking, two radiances; all texels of one
    // view, visible points.
    let of_facets = facets * (16 + 24 + 16 + words + 48);
    // Specular light scattered towards each view, as read back and as kept.
    let towards = if specular(job).is_some() && job.scatter.is_some() { 28 } else { 0 };
    let of_grid_points = grid_points * (200 + (36 + towards) * directions + 8 * job.around.count());
    (of_facets + of_grid_points) as u64
}

/// [`bytes`] for all views.
pub fn bytes_of_views(job: &Job) -> u64 {
    bytes(job, job.angles.count())
}

/// The refined field of triangles. Errors state the original size and cell.
fn finer(field: &HeightField, border: Border) -> Result<HeightField> {
    let (times, [cols, rows]) = (times(field), [field.cols(), field.rows()]);
    if border != Border::Periodic && cols.min(rows) < 2 {
        let found = format!("a field of {cols} × {rows}");
        return Err(Error::setting("triangles", found, "2 × 2 grid points or more"));
    }
    field.finer(border, times).map_err(|error| match error {
        Error::Setting { name, expected, .. } if name == "cell size" => {
            let [east, north] = field.cell_m();
            let found = format!("{east:?} × {north:?}");
            Error::setting(name, found, format!("{expected}, also {times} times finer"))
        }
        other => other,
    })
}

/// Scattered light, towards as many views as are traced together where specular depends on the
/// view.
pub fn scatter_plan(job: &Job, scene: &Scene, scatter: &Scatter, limits: &Limits) -> Result<Plan> {
    if specular(job).is_none() {
        return plan::scatter(scene, job.around, scatter, limits);
    }
    let views = job.angles.directions()?;
    let at_once = plan::views_at_once(&scene.field, views.count(), limits);
    plan::scatter_views(scene, job.around, scatter, &views.vectors()[..at_once], limits)
}

/// [`scatter_plan`] for one light. Without specular, the scene's lights take the same work.
fn scatter_plan_of_one(job: &Job, scatter: &Scatter, limits: &Limits) -> Result<Plan> {
    if specular(job).is_none() {
        return scatter_plan(job, job.scene, scatter, limits);
    }
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: 1.0, diameter_rad: 0.0, irradiance: [1.0; 3] };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    scatter_plan(job, &Scene { lights, ..job.scene.clone() }, scatter, limits)
}

/// Visibility of triangles.
pub fn mask_plan(job: &Job, limits: &Limits) -> Result<Plan> {
    let (field, border) = (job.field(), job.border());
    plan::facet_mask(&finer(field, border)?, border, &job.angles.directions()?, limits)
}

pub fn plans(job: &Job, limits: &Limits) -> Result<Vec<Plan>> {
    let mut all = vec![mask_plan(job, limits)?];
    if let Some(scatter) = &job.scatter {
        all.push(job.points_plan(limits)?);
        all.push(scatter_plan_of_one(job, scatter, limits)?);
    }
    Ok(all)
}

/// Upper bound of visibility rays along paths, where specular scatters differently towards each
/// view, and a description.
pub fn rays(job: &Job, kind: &Kind, limits: &Limits) -> Option<(u128, String)> {
    specular(job)?;
    let (views, name) = (job.angles.count(), kind.name);
    let (scatter, lights, pairs) = match name {
        "light-field" => (light::view_paths(job), 1, 0),
        "btf" => (job.scatter?, views, 0),
        _ if kind.is_table() => (job.scatter?, views, brdf::PAIRS),
        _ => return None,
    };
    let field = job.field();
    // Views that do not fit into one batch walk the paths again.
    let walks = views.div_ceil(plan::views_at_once(field, views, limits));
    let (paths, steps) = (scatter.paths, scatter.bounces);
    let a_path = u128::from(steps) * walks as u128 + views as u128;
    let of_pairs = pairs as u128 * u128::from(steps + 1);
    let grid_points = field.heights_m().len() as u128;
    let rays = grid_points * u128::from(paths) * (lights as u128 * a_path + of_pairs);
    let of_lights = if lights == 1 { String::new() } else { format!("of {lights} lights each ") };
    let again = if walks == 1 { String::new() } else { format!(", walked {walks} times") };
    let of_pairs = match pairs {
        0 => String::new(),
        _ => format!("; of {pairs} pairs between each {paths} of {} steps", steps + 1),
    };
    Some((
        rays,
        format!(
            "rays of {name}: {of_lights}{paths} paths of {steps} steps{again}, and one more \
                towards each of {views} views{of_pairs}"
        ),
    ))
}

/// The number of triangles.
pub fn triangles(job: &Job) -> f64 {
    let [cols, rows] = [job.field().cols(), job.field().rows()];
    (2 * cols * rows * times(job.field()).pow(2)) as f64
}

/// Visibility of all triangles from `directions` of them.
pub fn triangles_stage(job: &Job, directions: usize) -> Stage {
    Stage::new(stage::TRIANGLES, triangles(job) * directions as f64, "triangles x directions")
}

/// Visible points, found so many times.
pub fn points_stage(job: &Job, times: usize) -> Stage {
    let work = (times * job.grid_points() * job.around.count()) as f64;
    Stage::new(stage::POINTS, work, "texels x directions")
}

/// Work of one light towards so many views: sums over triangles, and steps of paths. With specular
/// each path takes its last step towards every view.
pub fn light_work(job: &Job, views: usize) -> Result<f64> {
    let Some(Walked { plan, .. }) = walked(job)? else { return Ok(triangles(job) * views as f64) };
    let [bounces, paths] = ["bounces", "paths"].map(|name| f64::from(number(&plan, name)));
    let last = if specular(job).is_some() { views as f64 } else { 0.0 };
    Ok(triangles(job) * views as f64 + job.grid_points() as f64 * paths * (bounces + last))
}

/// What [`light_work`] counts.
pub const LIGHT_UNIT: &str = "lights x (triangles x views + texels x path steps)";

pub fn facets(gpu: &mut Headless, job: &Job, directions: &Directions) -> Result<Facets> {
    ridgelight_bake::facets(gpu, job.scene, times(job.field()), directions, &job.limits)
}

/// Radiance of all triangles under a light of irradiance 1 from each given direction. Specular goes
/// towards those views that the light has. `name` is the stage after that of visible points.
pub fn each_light(
    Making { gpu, job, stages }: &mut Making,
    facets: &Facets,
    (lights, views): (Range<usize>, &dyn Fn(usize) -> Range<usize>),
    name: &str,
    take: &mut dyn FnMut(usize, ExitRadiance) -> Result<()>,
) -> Result<()> {
    let points = match job.scatter {
        Some(_) => {
            stages.begin(stage::POINTS);
            Some(job.points(gpu)?)
        }
        None => None,
    };
    stages.begin(name);
    let of = (facets, lights, views);
    let scatter = points.as_ref().zip(job.scatter.as_ref());
    ridgelight_bake::lit_from(gpu, job.scene, of, scatter, &job.limits, take)
}

/// Paths that were walked.
pub struct Walked {
    pub plan: Plan,
    /// Whether Phong specular reflects the sky along them.
    pub mirrors_sky: bool,
}

/// Paths of lights that face the field from one direction each.
pub fn walked(job: &Job) -> Result<Option<Walked>> {
    let Some(scatter) = &job.scatter else { return Ok(None) };
    let plan = scatter_plan_of_one(job, scatter, &job.limits)?;
    Ok(Some(Walked { plan, mirrors_sky: false }))
}

/// Adds the angles and how well triangles fill the views; for a stored table also whether it is
/// linear between the angles.
pub fn add_entries(
    files: &mut MapFiles,
    job: &Job,
    facets: &Facets,
    walked: Option<&Walked>,
    is_linear: bool,
) -> Result<()> {
    let angles = job.angles;
    let directions = facets.directions().vectors().iter().map(|e| json!([e.x, e.y, e.z]));
    let thetas = (0..angles.zeniths).map(|k| facets.directions().vectors()[k * angles.azimuths].z);
    let phis = (0..angles.azimuths).map(|j| 360.0 * j as f64 / angles.azimuths as f64);
    files.add_entry(
        "angles",
        json!({
            "thetas_deg": thetas.map(|z| z.acos().to_degrees()).collect::<Vec<_>>(),
            "phis_deg": phis.collect::<Vec<_>>(),
            "directions": directions.collect::<Vec<_>>(),
            "are": "θ from straight above, φ counter-clockwise from east; direction k · phis + j, east, north, up, is of θ k and φ j",
        }),
    );
    let count = facets.directions().count();
    let (shown, blind): (Vec<usize>, Vec<usize>) = (0..count).partition(|i| facets.shows(*i));
    if !blind.is_empty() {
        files.remark(format!(
            "{} of {count} directions of --angles do not face the field's front: their views \
                hold 0, their lights add nothing",
            blind.len()
        ));
        files.add_entry("blind", json!(blind));
    }
    let closures = shown.into_iter().map(|i| facets.closure(i));
    let worst = closures.map(|c| (c - 1.0).abs()).fold(0.0, f64::max);
    let (worst, are) = match job.border() {
        Border::Periodic => (
            Some(worst),
            "flat, visible or hidden as their middles are; worst_closure is the error of the \
                share of a view that they fill against a plane's, before normalisation to it, \
                over directions that face any; blind counts the others",
        ),
        _ => (
            None,
            "flat, visible or hidden as their middles are; worst_closure is null, because a \
                finite field is no far-field plane: irradiance and shares are not normalised",
        ),
    };
    let (finer, count) = (facets.times(), facets.count());
    files.add_entry(
        "triangles",
        json!({ "finer": finer, "count": count, "worst_closure": worst, "are": are }),
    );
    let scattered = walked.map(|Walked { plan, .. }| {
        let [bounces, paths, seed] = ["bounces", "paths", "seed"].map(|name| number(plan, name));
        json!({ "bounces": bounces, "paths": paths, "seed": seed, "directions": job.around.count() })
    });
    files.add_entry("scattered", scattered.into());
    report_specular(files, job, facets, walked, is_linear);
    Ok(())
}

/// The sharpest specular of all triangles (means of their corners) and texels (which light paths
/// hit).
fn sharpest(job: &Job, facets: &Facets) -> Option<PhongSpecular> {
    let grid_points = match &job.scene.surface.specular {
        Some(Specular::Constant(phong)) => std::slice::from_ref(phong),
        Some(Specular::Map(map)) => map,
        None => &[],
    };
    let all = facets.sharpest().into_iter().chain(grid_points.iter().copied());
    let of = all.filter(|phong| phong.scale > 0.0);
    of.max_by(|a, b| a.exponent.total_cmp(&b.exponent).then(a.scale.total_cmp(&b.scale)))
}

/// Angle from the centre of a Phong lobe to half its peak, degrees: cosⁿ = ½.
fn half_width_deg(phong: &PhongSpecular) -> f64 {
    0.5_f64.powf(1.0 / f64::from(phong.exponent).max(1e-3)).acos().to_degrees()
}

/// Largest spacing of the angles, degrees.
fn apart_deg(angles: &Angles) -> f64 {
    f64::max(90.0 / angles.zeniths as f64, 360.0 / angles.azimuths as f64)
}

/// Whether the angles' spacing exceeds the sharpest lobe's half width, so that sums over them are
/// no integrals.
pub fn is_coarse(job: &Job, facets: &Facets) -> bool {
    sharpest(job, facets).is_some_and(|phong| apart_deg(&job.angles) > half_width_deg(&phong))
}

/// Half width of the sharpest Phong lobe, and the spacing of the directions within it.
fn report_specular(
    files: &mut MapFiles,
    job: &Job,
    facets: &Facets,
    walked: Option<&Walked>,
    is_linear: bool,
) {
    let Some(phong) = sharpest(job, facets) else { return };
    let (half, angles) = (half_width_deg(&phong), apart_deg(&job.angles));
    // Each of N directions stands for 4π/N.
    let around = (4.0 * PI / job.around.count() as f64).sqrt().to_degrees();
    let mirrored = walked.and_then(|Walked { plan, mirrors_sky }| {
        let scatters = number(plan, "paths") > 0 && number(plan, "bounces") > 0;
        match (scatters, *mirrors_sky) {
            (true, true) => Some("of scattered light and of the sky"),
            (true, false) => Some("of scattered light"),
            (false, true) => Some("of the sky"),
            (false, false) => None,
        }
    });
    // The second derivative of cosⁿ at its peak is n = 2 ln 2 / half_width²; linear interpolation
    // over h has an error of h²/8 times that.
    let between = if is_linear {
        "linear interpolation has an error of about 0.17 (angles_deg / half_width_deg)² of the \
            peak on level ground, for each of the four angles of light and view, while that is \
            small"
    } else {
        "harmonics are fitted to values at these angles"
    };
    files.add_entry(
        "specular",
        json!({
            "exponent": phong.exponent, "scale": phong.scale, "half_width_deg": half, "angles_deg": angles,
            "directions_deg": mirrored.map(|_| around),
            "is": format!(
                "the sharpest Phong lobe of any triangle or texel falls to half its peak \
                    half_width_deg from its centre; angles are up to angles_deg apart, and \
                    {between}; along paths, specular reflects scattered light and a \
                    light-field's sky from directions directions_deg apart, null where it \
                    reflects neither; specular is not reciprocal"
            ),
        }),
    );
    if angles > half {
        let Angles { zeniths, azimuths } = job.angles;
        files.remark(format!(
            "specular lobes fall to half at {half:.1}°, but --angles {zeniths}x{azimuths} are up \
                to {angles:.1}° apart: too coarse, unless slopes widen the highlights"
        ));
    }
    if let Some(what) = mirrored.filter(|_| around > half) {
        let count = job.around.count();
        files.remark(format!(
            "specular lobes fall to half at {half:.1}°, but --directions {count} are \
                {around:.1}° apart: specular {what} is rough"
        ));
    }
}
