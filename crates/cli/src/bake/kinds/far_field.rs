//! What kinds that are light have in common: the direct light of samples, and triangles seen from afar.

use std::f64::consts::PI;
use std::ops::Range;

use ridgelight::gpu::Headless;
use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::plan::{Limits, Picture, Plan};
use ridgelight::scene::{
    Border, Bounces, Directions, HeightField, Lights, Lobe, Phong, Quality, Scatter, Scene, Sun,
    Surface,
};
use ridgelight::{Error, Result, plan};
use ridgelight_bake::{Angles, ExitRadiance, Facets};
use ridgelight_io::Component;
use serde_json::json;

use super::super::map::MapFiles;
use super::{Lit, Request, Say, Value, brdf, light_field, number};

/// The most that the files hold: f32 all but a .ktx2, whose components may be less.
pub fn largest(asked: &Request) -> f64 {
    let is_half = asked.encoding.component == Component::F16 && asked.has_texels;
    if is_half { 65_504.0 } else { f64::from(f32::MAX) }
}

/// Triangles that a small field is cut into: their middles decide for them what is hidden.
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

/// A texel of a picture that a view sees.
pub fn texel(about: &'static str, unit: &'static str, asked: &Request) -> Vec<Value> {
    let range = [0.0, largest(asked)];
    let colour = |name| Value { name, about, unit, range };
    let share = Value {
        name: "share",
        about: "of the view over the texel's own cell, slope, foreshortening and masking counted: cos θ in the mean where the \
                field repeats; where it ends, of a whole cell, of which it has half at an edge and a third or a sixth at a corner",
        unit: "",
        range,
    };
    vec![colour("red"), colour("green"), colour("blue"), share]
}

/// Of all lobes the largest exponent and share, where they reflect anything.
pub fn lobe(lit: &Lit) -> Option<Phong> {
    let largest = lit.scene.surface.phong.as_ref().map(|lobe| lobe.largest());
    largest.filter(|phong| phong.scale > 0.0)
}

/// What of the ground is diffuse, under the same lights.
pub fn diffuse(lit: &Lit) -> Scene {
    let surface = Surface { phong: None, ..lit.scene.surface.clone() };
    Scene { surface, ..lit.scene.clone() }
}

/// Direct light of all samples, of lobes that towards straight above.
pub fn direct_plan(lit: &Lit, scene: &Scene, limits: &Limits) -> Result<Plan> {
    let bounces = Bounces { count: 0, ..lit.quality.bounces };
    let quality = Quality { bounces, ..*lit.quality };
    let still = Picture { still: true, ..Picture::default() };
    plan::picture(scene, &quality, limits, still)
}

pub fn direct(gpu: &mut Headless, lit: &Lit, scene: &Scene) -> Result<Vec<[f32; 3]>> {
    let plan = direct_plan(lit, scene, &lit.limits)?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw_counted(frame)?;
        let pixels = gpu.pixels(frame, 0)?;
        crate::render::check_finite(&pixels, &scene.field)?;
        Ok(crate::render::rgb(&pixels))
    })
}

/// Of triangles seen from so many directions, and samples.
pub fn bytes(lit: &Lit, directions: usize) -> u64 {
    let samples = lit.scene.field.heights_m().len();
    let facets = 2 * samples * times(&lit.scene.field).pow(2);
    let words = 2 * directions.div_ceil(DIRECTIONS_A_WORD) * 4;
    // Slopes, albedo, lobes, words and as they come, two radiances; a view's texels of all at once, what samples see.
    let of_facets = facets * (16 + 24 + 16 + words + 48);
    // And what lobes scatter towards each view, as it comes and as it is kept.
    let towards = if lobe(lit).is_some() && lit.scatter.is_some() { 28 } else { 0 };
    let of_samples = samples * (200 + (36 + towards) * directions + 8 * lit.around.count());
    (of_facets + of_samples) as u64
}

/// The field as its triangles are cut, whose own size and cells are told where it cannot be.
fn finer(field: &HeightField, border: Border) -> Result<HeightField> {
    let (times, [cols, rows]) = (times(field), [field.cols(), field.rows()]);
    if border != Border::Periodic && cols.min(rows) < 2 {
        let found = format!("a field of {cols} × {rows}");
        return Err(Error::setting("triangles", found, "2 × 2 samples or more"));
    }
    field.finer(border, times).map_err(|error| match error {
        Error::Setting { name, expected, .. } if name == "cell size" => {
            let [east, north] = field.cell_m();
            let found = format!("{east:?} × {north:?}");
            Error::setting(name, found, format!("{expected}, {times} times finer, too"))
        }
        other => other,
    })
}

/// Of what is scattered of one light, and towards as many views as go side by side where it is another towards each.
fn scatter_plan(lit: &Lit, scatter: &Scatter, limits: &Limits) -> Result<Plan> {
    if lobe(lit).is_none() {
        return plan::scatter(lit.scene, lit.around, scatter, limits);
    }
    // The scene's own lights have no part in it; whichever sun, it is as much.
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: 1.0, diameter_rad: 0.0, irradiance: [1.0; 3] };
    let lights = Lights { suns: vec![sun], ..Lights::default() };
    let scene = Scene { lights, ..lit.scene.clone() };
    let views = lit.angles.directions()?;
    let at_once = plan::views_at_once(&scene.field, views.count(), limits);
    plan::scatter_views(&scene, lit.around, scatter, &views.vectors()[..at_once], limits)
}

/// Of which triangles are seen.
pub fn mask_plan(lit: &Lit, limits: &Limits) -> Result<Plan> {
    let (field, border) = (&lit.scene.field, lit.scene.surface.border);
    plan::facet_mask(&finer(field, border)?, border, &lit.angles.directions()?, limits)
}

pub fn plans(lit: &Lit, limits: &Limits) -> Result<Vec<Plan>> {
    let (field, border) = (&lit.scene.field, lit.scene.surface.border);
    let mut all = vec![mask_plan(lit, limits)?];
    if let Some(scatter) = &lit.scatter {
        all.push(plan::visible_points(field, border, lit.around, limits)?);
        all.push(scatter_plan(lit, scatter, limits)?);
    }
    Ok(all)
}

/// Look-ups of what samples see along paths, at most, where lobes scatter towards each view otherwise, and what they are for.
pub fn looks(lit: &Lit, name: &str, limits: &Limits) -> Option<(u128, String)> {
    lobe(lit)?;
    let views = lit.angles.count();
    let (scatter, lights, pairs) = match name {
        "brdf" | "brdf-factors" | "brdf-harmonics" => (lit.scatter?, views, brdf::PAIRS),
        "btf" => (lit.scatter?, views, 0),
        "light-field" => (light_field::paths(lit), 1, 0),
        _ => return None,
    };
    let field = &lit.scene.field;
    // For views that do not go side by side with the others paths are walked again.
    let walks = views.div_ceil(plan::views_at_once(field, views, limits));
    let (paths, steps) = (scatter.paths, scatter.bounces);
    let a_path = u128::from(steps) * walks as u128 + views as u128;
    let of_pairs = pairs as u128 * u128::from(steps + 1);
    let samples = field.heights_m().len() as u128;
    let looks = samples * u128::from(paths) * (lights as u128 * a_path + of_pairs);
    let of_lights = if lights == 1 { String::new() } else { format!("of {lights} lights each ") };
    let again = if walks == 1 { String::new() } else { format!(", walked {walks} times") };
    let of_pairs = match pairs {
        0 => String::new(),
        _ => format!("; of {pairs} pairs between each {paths} of {} steps", steps + 1),
    };
    Some((
        looks,
        format!(
            "look-ups of {name}: {of_lights}{paths} paths of {steps} steps{again}, and one more towards each of {views} \
             views{of_pairs}"
        ),
    ))
}

pub fn facets(gpu: &mut Headless, lit: &Lit, directions: &Directions, say: Say) -> Result<Facets> {
    say(format!("what is seen of triangles from {} directions", directions.count()));
    ridgelight_bake::facets(gpu, lit.scene, times(&lit.scene.field), directions, &lit.limits)
}

/// All triangles' radiance under a light of irradiance 1 from each of some of their directions; what lobes scatter goes towards
/// those views that there are of a light.
pub fn each_light(
    gpu: &mut Headless,
    lit: &Lit,
    facets: &Facets,
    (lights, views): (Range<usize>, &dyn Fn(usize) -> Range<usize>),
    take: &mut dyn FnMut(usize, ExitRadiance) -> Result<()>,
) -> Result<()> {
    let of = (facets, lights, views);
    let Some(scatter) = &lit.scatter else {
        return ridgelight_bake::lit_from(gpu, lit.scene, of, None, &lit.limits, take);
    };
    let border = lit.scene.surface.border;
    let points = gpu.visible_points((&lit.scene.field, border), lit.around, &lit.limits)?;
    ridgelight_bake::lit_from(gpu, lit.scene, of, Some((&points, scatter)), &lit.limits, take)
}

/// Paths that were walked.
pub struct Walked {
    pub plan: Plan,
    /// Whether lobes mirror the sky along them.
    pub mirrors_sky: bool,
}

/// Those of lights that face the field from one direction each.
pub fn walked(lit: &Lit) -> Result<Option<Walked>> {
    let Some(scatter) = &lit.scatter else { return Ok(None) };
    let plan = scatter_plan(lit, scatter, &lit.limits)?;
    Ok(Some(Walked { plan, mirrors_sky: false }))
}

/// The angles, and how well triangles fill the views; of what is kept whether it is linear between the angles.
pub fn tell(
    files: &mut MapFiles,
    lit: &Lit,
    facets: &Facets,
    walked: Option<&Walked>,
    is_linear: bool,
) -> Result<()> {
    let angles = lit.angles;
    let directions = facets.directions().vectors().iter().map(|e| json!([e.x, e.y, e.z]));
    let thetas = (0..angles.zeniths).map(|k| facets.directions().vectors()[k * angles.azimuths].z);
    let phis = (0..angles.azimuths).map(|j| 360.0 * j as f64 / angles.azimuths as f64);
    files.tell(
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
            "{} of {count} directions of --angles see nothing of the field's front: views from there hold 0, lights from there \
             bring nothing",
            blind.len()
        ));
        files.tell("blind", json!(blind));
    }
    let closures = shown.into_iter().map(|i| facets.closure(i));
    let worst = closures.map(|c| (c - 1.0).abs()).fold(0.0, f64::max);
    let (worst, are) = match lit.scene.surface.border {
        Border::Periodic => (
            Some(worst),
            "flat, seen or hidden as their middles are; worst_closure is how far what they fill of a view was off what \
             the plane does, before it was scaled to that, of directions that see any; the others' numbers are blind's",
        ),
        _ => (
            None,
            "flat, seen or hidden as their middles are; worst_closure is null, as a field that ends is no plane from afar: \
             irradiance and shares are their own, and nothing is scaled",
        ),
    };
    let (finer, count) = (facets.times(), facets.count());
    files.tell(
        "triangles",
        json!({ "finer": finer, "count": count, "worst_closure": worst, "are": are }),
    );
    let scattered = walked.map(|Walked { plan, .. }| {
        let [bounces, paths, seed] = ["bounces", "paths", "seed"].map(|name| number(plan, name));
        json!({ "bounces": bounces, "paths": paths, "seed": seed, "directions": lit.around.count() })
    });
    files.tell("scattered", scattered.into());
    tell_lobe(files, lit, facets, walked, is_linear);
    Ok(())
}

/// Of all that mirrors anything the sharpest: of triangles, which have means of their corners, and of samples, whose light paths
/// find.
fn sharpest(lit: &Lit, facets: &Facets) -> Option<Phong> {
    let samples = match &lit.scene.surface.phong {
        Some(Lobe::Constant(phong)) => std::slice::from_ref(phong),
        Some(Lobe::Map(map)) => map,
        None => &[],
    };
    let all = facets.sharpest().into_iter().chain(samples.iter().copied());
    let of = all.filter(|phong| phong.scale > 0.0);
    of.max_by(|a, b| a.exponent.total_cmp(&b.exponent).then(a.scale.total_cmp(&b.scale)))
}

/// How far beside its middle a lobe is half as bright, degrees: cosⁿ = ½.
fn half_width_deg(phong: &Phong) -> f64 {
    0.5_f64.powf(1.0 / f64::from(phong.exponent).max(1e-3)).acos().to_degrees()
}

/// How far apart directions of the angles are, at most.
fn apart_deg(angles: &Angles) -> f64 {
    f64::max(90.0 / angles.zeniths as f64, 360.0 / angles.azimuths as f64)
}

/// Whether the angles are farther apart than the sharpest lobe is half as bright: sums over them are then no integrals.
pub fn is_coarse(lit: &Lit, facets: &Facets) -> bool {
    sharpest(lit, facets).is_some_and(|phong| apart_deg(&lit.angles) > half_width_deg(&phong))
}

/// Where the sharpest lobe is half as bright as in its middle, and how far apart what looks at it is.
fn tell_lobe(
    files: &mut MapFiles,
    lit: &Lit,
    facets: &Facets,
    walked: Option<&Walked>,
    is_linear: bool,
) {
    let Some(phong) = sharpest(lit, facets) else { return };
    let (half, angles) = (half_width_deg(&phong), apart_deg(&lit.angles));
    // Each of N directions stands for 4π/N.
    let around = (4.0 * PI / lit.around.count() as f64).sqrt().to_degrees();
    let mirrored = walked.and_then(|Walked { plan, mirrors_sky }| {
        let scatters = number(plan, "paths") > 0 && number(plan, "bounces") > 0;
        match (scatters, *mirrors_sky) {
            (true, true) => Some("of scattered light and of the sky"),
            (true, false) => Some("of scattered light"),
            (false, true) => Some("of the sky"),
            (false, false) => None,
        }
    });
    // Of cosⁿ the second derivative at its peak is n = 2 ln 2 / half_width²; what is linear over h errs by h²/8 of it.
    let between = if is_linear {
        "what is linear between them errs by about 0.17 (angles_deg / half_width_deg)² of the peak of a lobe that level ground has, \
         for each angle that it is linear in, four of light and view together, while that is small"
    } else {
        "harmonics are fitted to what these angles show of it"
    };
    files.tell(
        "lobe",
        json!({
            "exponent": phong.exponent, "scale": phong.scale, "half_width_deg": half, "angles_deg": angles,
            "directions_deg": mirrored.map(|_| around),
            "is": format!(
                "of the sharpest lobe of any triangle or sample that mirrors anything: half as bright half_width_deg beside its \
                 middle; angles are up to angles_deg apart, and {between}; what lobes mirror along paths, scattered light and a \
                 light-field's sky, they see along directions directions_deg apart, null where they mirror nothing there; not the \
                 same with light and view exchanged"
            ),
        }),
    );
    if angles > half {
        let Angles { zeniths, azimuths } = lit.angles;
        files.remark(format!(
            "lobes are half as bright {half:.1}° beside their middle, --angles {zeniths}x{azimuths} are up to {angles:.1}° apart: too \
             coarse to hold them, but where slopes spread them wider"
        ));
    }
    if let Some(what) = mirrored.filter(|_| around > half) {
        let count = lit.around.count();
        files.remark(format!(
            "lobes are half as bright {half:.1}° beside their middle, --directions {count} are {around:.1}° apart: what lobes mirror \
             {what} is rough"
        ));
    }
}
