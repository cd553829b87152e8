//! What kinds that are light have in common: the direct light of samples, and triangles seen from afar.

use std::ops::Range;

use ridgelight::bake::{Angles, Component, DIRECTIONS_A_WORD, Encoding, Facets};
use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Picture, Plan};
use ridgelight::scene::{Border, Bounces, Directions, HeightField, Quality};
use ridgelight::{Error, Result, plan};
use serde_json::json;

use super::super::map::MapFiles;
use super::{Lit, Say, Value, number};

/// The most that the components hold.
pub fn largest(encoding: &Encoding) -> f64 {
    if encoding.component == Component::F16 { 65_504.0 } else { f64::from(f32::MAX) }
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
pub fn texel(about: &'static str, unit: &'static str, encoding: &Encoding) -> Vec<Value> {
    let range = [0.0, largest(encoding)];
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

/// Direct light of all samples.
pub fn direct_plan(lit: &Lit, limits: &Limits) -> Result<Plan> {
    let bounces = Bounces { count: 0, ..lit.quality.bounces };
    let quality = Quality { bounces, ..*lit.quality };
    let still = Picture { still: true, ..Picture::default() };
    plan::picture(lit.scene, &quality, limits, still)
}

pub fn direct(gpu: &mut Headless, lit: &Lit) -> Result<Vec<[f32; 3]>> {
    let plan = direct_plan(lit, &lit.limits)?;
    let contents = plan::picture_inputs(lit.scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw_counted(frame)?;
        let pixels = gpu.pixels(frame, 0)?;
        crate::render::check_finite(&pixels, &lit.scene.field)?;
        Ok(crate::render::rgb(&pixels))
    })
}

/// Of triangles seen from so many directions, and samples.
pub fn bytes(lit: &Lit, directions: usize) -> u64 {
    let samples = lit.scene.field.heights_m().len();
    let facets = 2 * samples * times(&lit.scene.field).pow(2);
    let words = 2 * directions.div_ceil(DIRECTIONS_A_WORD) * 4;
    // Slopes, albedo, words and as they come, two radiances; a view's texels of all at once, what samples see.
    let of_facets = facets * (16 + 24 + words + 48);
    let of_samples = samples * (200 + 36 * directions + 8 * lit.around.count());
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

pub fn plans(lit: &Lit, limits: &Limits) -> Result<Vec<Plan>> {
    let (field, border) = (&lit.scene.field, lit.scene.surface.border);
    let finer = finer(field, border)?;
    let mut all = vec![plan::facet_mask(&finer, border, &lit.angles.directions()?, limits)?];
    if let Some(scatter) = &lit.scatter {
        all.push(plan::visible_points(field, border, lit.around, limits)?);
        all.push(plan::scatter(lit.scene, lit.around, scatter, limits)?);
    }
    Ok(all)
}

pub fn facets(gpu: &mut Headless, lit: &Lit, directions: &Directions, say: Say) -> Result<Facets> {
    say(format!("what is seen of triangles from {} directions", directions.count()));
    gpu.facets(lit.scene, times(&lit.scene.field), directions, &lit.limits)
}

/// All triangles' radiance under a light of irradiance 1 from each of some of their directions.
pub fn each_light(
    gpu: &mut Headless,
    lit: &Lit,
    facets: &Facets,
    lights: Range<usize>,
    take: &mut dyn FnMut(usize, Vec<[f64; 3]>) -> Result<()>,
) -> Result<()> {
    let Some(scatter) = &lit.scatter else {
        return gpu.lit_from(lit.scene, (facets, lights), None, &lit.limits, take);
    };
    let border = lit.scene.surface.border;
    let points = gpu.visible_points((&lit.scene.field, border), lit.around, &lit.limits)?;
    gpu.lit_from(lit.scene, (facets, lights), Some((&points, scatter)), &lit.limits, take)
}

/// The angles, and how well triangles fill the views.
pub fn tell(files: &mut MapFiles, lit: &Lit, facets: &Facets) -> Result<()> {
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
    let scatter = match lit.scatter {
        Some(s) => {
            let plan = plan::scatter(lit.scene, lit.around, &s, &lit.limits)?;
            let [bounces, paths] = ["bounces", "paths"].map(|name| number(&plan, name));
            json!({ "bounces": bounces, "paths": paths, "seed": s.seed, "directions": lit.around.count() })
        }
        None => serde_json::Value::Null,
    };
    files.tell("scattered", scatter);
    Ok(())
}
