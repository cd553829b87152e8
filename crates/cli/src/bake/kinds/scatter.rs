use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::Scatter;
use ridgelight::{Error, Result, plan};
use ridgelight_bake as bake;
use serde_json::json;

use super::super::map::{Format, MapFiles};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source, Value, far_field, number};

pub static KIND: Kind = Kind {
    name: "scatter",
    about: "exit radiance under the scene's lights with indirect light by --bounces and --paths, \
        and its standard error",
    encodings: &bake::RADIANCE,
    formats: &[Format::Ktx2, Format::Exr],
    decoder: include_str!("../../../../../shaders_glsl/decode/scatter.glsl"),
    begin,
};

/// Parts of the paths, each with its own order of directions. Their spread gives the Monte Carlo
/// noise.
const PARTS: u32 = 8;

fn begin(request: &Request) -> Result<Making> {
    let range = [0.0, far_field::largest(request)];
    let value = |name, about| Value { name, about, unit: "radiance", range };
    let light = match request.has_specular {
        false => "radiance that leaves diffuse ground: direct light and all bounces",
        true => {
            "radiance that leaves straight up, diffuse and specular: direct light as render \
                computes it, and all bounces"
        }
    };
    let error = "one standard error from the paths alone, from eight parts of them; similar \
        texels have similar errors";
    let map = Map {
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
    };
    let of = OfLight { plans, bytes: |lit| lit.scene.field.heights_m().len() as u64 * 212, make };
    Ok(Making { map, source: Source::Light(of) })
}

/// Paths that are traced by all parts: slightly more than requested; fewer where a part runs out of
/// directions; 0 where nothing is scattered.
pub fn paths(lit: &Lit, limits: &Limits) -> Result<u32> {
    let of_part = plan::scatter(lit.scene, lit.around, &part(lit, 0)?, limits)?;
    Ok(PARTS * number(&of_part, "paths"))
}

/// An equal number of paths for each part, in total as many as requested or slightly more.
fn part(lit: &Lit, k: u32) -> Result<Scatter> {
    let Some(scatter) = lit.scatter else {
        return Err(Error::setting("--bounces", "0 with --what scatter", "1 to 64"));
    };
    let seed = scatter.seed.wrapping_mul(PARTS).wrapping_add(k);
    Ok(Scatter { paths: scatter.paths.div_ceil(PARTS), seed, ..scatter })
}

fn plans(lit: &Lit, limits: &Limits) -> Result<Vec<Plan>> {
    let (field, border) = (&lit.scene.field, lit.scene.surface.border);
    Ok(vec![
        plan::scatter(lit.scene, lit.around, &part(lit, 0)?, limits)?,
        plan::visible_points(field, border, lit.around, limits)?,
        far_field::direct_plan(lit, lit.scene, limits)?,
    ])
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    say("direct light".into());
    let direct = far_field::direct(gpu, lit, lit.scene)?;
    // With specular, bounces start from the diffuse light only: specular depends on the receiver.
    let diffuse = match far_field::specular(lit) {
        Some(_) => far_field::direct(gpu, lit, &far_field::diffuse(lit))?,
        None => direct.clone(),
    };
    say(format!("visible points in {} directions", lit.around.count()));
    let border = lit.scene.surface.border;
    let points = gpu.visible_points((&lit.scene.field, border), lit.around, &lit.limits)?;
    let mut sums = vec![[[0.0_f64; 2]; 3]; direct.len()];
    for k in 0..PARTS {
        say(format!("scattered light, part {} of {PARTS}", k + 1));
        let light = gpu.scattered(lit.scene, &points, &diffuse, &part(lit, k)?, &lit.limits)?;
        for (sum, light) in sums.iter_mut().zip(&light) {
            for (sum, v) in sum.iter_mut().zip(light) {
                let v = f64::from(*v);
                *sum = [sum[0] + v, sum[1] + v * v];
            }
        }
    }
    let n = f64::from(PARTS);
    let of = |[sum, squares]: [f64; 2]| {
        let mean = sum / n;
        [mean, ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt()]
    };
    let found: Vec<[[f64; 2]; 3]> = sums.iter().map(|s| s.map(of)).collect();
    let plane = |c: usize, what: usize| -> Vec<f32> {
        let own = |i: usize| if what == 0 { f64::from(direct[i][c]) } else { 0.0 };
        found.iter().enumerate().map(|(i, f)| (own(i) + f[c][what]) as f32).collect()
    };
    let planes = [0, 1].map(|what| [0, 1, 2].map(|c| plane(c, what)));
    for layer in &planes {
        files.take(&layer.each_ref().map(Vec::as_slice))?;
    }
    let values = || found.iter().flatten();
    let count = values().count() as f64;
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| values().map(of).sum::<f64>() / count;
    let light = planes[0].iter().flatten().map(|v| f64::from(*v)).sum::<f64>() / count;
    let paths = paths(lit, &lit.limits)?;
    files.add_entry(
        "monte_carlo_noise",
        json!({
            "paths": paths, "directions": lit.around.count(), "mean_radiance": light,
            "mean_scattered": mean(&|v| v[0]),
            "rms_standard_error": mean(&|v| v[1] * v[1]).sqrt(),
            "worst_standard_error": values().map(|v| v[1]).fold(0.0, f64::max),
            "is": "standard error of paths; excludes the error of the finite directions and of nearest \
                grid points at hits",
        }),
    );
    Ok(())
}
