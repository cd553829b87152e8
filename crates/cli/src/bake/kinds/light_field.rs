use ridgelight::gpu::Headless;
use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::Scatter;
use ridgelight::{Result, plan};
use ridgelight_bake as bake;

use super::super::map::{Format, MapFiles};
use super::far_field::{self, Walked, texel};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source};

pub static KIND: Kind = Kind {
    name: "light-field",
    about: "an image in the field's own texels for each of --angles views under the scene's \
        lights: radiance, and the share of the view that each texel fills; specular reflects \
        suns as points and the sky along --directions",
    encodings: &bake::TEXELS,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/light_field.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let count = request.angles.count();
    let map = Map {
        planes: (0..count)
            .flat_map(|view| ["R", "G", "B", "share"].map(|c| format!("light_field.{view:04}.{c}")))
            .collect(),
        values: texel(
            "radiance that leaves the texel; 0 where it is not visible",
            "radiance",
            request,
        ),
        is_array: true,
        constants: far_field::constants("LIGHT_FIELD", request.angles),
        ..Map::default()
    };
    let of = OfLight { plans, bytes: |lit| far_field::bytes(lit, lit.angles.count()), make };
    Ok(Making { map, source: Source::Light(of) })
}

fn plans(lit: &Lit, limits: &Limits) -> Result<Vec<Plan>> {
    let field = &lit.scene.field;
    let mut all = vec![far_field::direct_plan(lit, &far_field::diffuse(lit), limits)?];
    if far_field::specular(lit).is_some() {
        all.extend(walked(lit, limits)?);
        all.push(plan::visible_points(field, lit.scene.surface.border, lit.around, limits)?);
        all.push(far_field::mask_plan(lit, limits)?);
        return Ok(all);
    }
    all.extend(far_field::plans(lit, limits)?);
    all.extend(walked(lit, limits)?);
    Ok(all)
}

/// Path bounces, towards as many views as are traced together where specular depends on the view.
fn walked(lit: &Lit, limits: &Limits) -> Result<Option<Plan>> {
    if far_field::specular(lit).is_none() {
        let of = |scatter: &Scatter| plan::scatter(lit.scene, lit.around, scatter, limits);
        return lit.scatter.as_ref().map(of).transpose();
    }
    let views = lit.angles.directions()?;
    let views = &views.vectors()[..plan::views_at_once(&lit.scene.field, views.count(), limits)];
    plan::scatter_views(lit.scene, lit.around, &paths(lit), views, limits).map(Some)
}

/// Scatter settings with Phong specular, whose direct light is part of the result. Without bounces
/// only that, with one path along each direction.
pub fn paths(lit: &Lit) -> Scatter {
    let alone = Scatter { bounces: 0, paths: lit.around.count() as u32, ..Scatter::default() };
    Scatter { direct_specular: true, ..lit.scatter.unwrap_or(alone) }
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    say("direct light".into());
    let mut light = far_field::direct(gpu, lit, &far_field::diffuse(lit))?;
    let has_specular = far_field::specular(lit).is_some();
    if let Some(scatter) = lit.scatter.as_ref().filter(|_| !has_specular) {
        say(format!("visible points in {} directions", lit.around.count()));
        let border = lit.scene.surface.border;
        let points = gpu.visible_points((&lit.scene.field, border), lit.around, &lit.limits)?;
        say("scattered light".into());
        let more = gpu.scattered(lit.scene, &points, &light, scatter, &lit.limits)?;
        for (own, more) in light.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
            *own += more;
        }
    }
    say("triangle visibility".into());
    let directions = lit.angles.directions()?;
    let facets = ridgelight_bake::facets(
        gpu,
        lit.scene,
        far_field::times(&lit.scene.field),
        &directions,
        &lit.limits,
    )?;
    let none = vec![[0.0; 3]; facets.count()].into();
    let mut take = |view: usize, light: &[[f32; 3]]| {
        say(format!("view {} of {}", view + 1, directions.count()));
        let shares: Vec<f32> =
            facets.texels_from(view, &none).iter().map(|t| t[3] as f32).collect();
        let plane = |c: usize| -> Vec<f32> {
            let texels = light.iter().zip(&shares);
            texels.map(|(l, share)| if *share > 0.0 { l[c] } else { 0.0 }).collect()
        };
        let colours = [0, 1, 2].map(plane);
        files.take(&[&colours[0], &colours[1], &colours[2], &shares])
    };
    if has_specular {
        say(format!("visible points in {} directions", lit.around.count()));
        let border = lit.scene.surface.border;
        let points = gpu.visible_points((&lit.scene.field, border), lit.around, &lit.limits)?;
        let of = (lit.scene, &points, light.as_slice());
        let views = directions.vectors();
        say("scattered light".into());
        gpu.scattered_towards(of, &paths(lit), views, &lit.limits, &mut |view, more| {
            let all =
                light.iter().zip(&more).map(|(own, more)| [0, 1, 2].map(|c| own[c] + more[c]));
            take(view, &all.collect::<Vec<_>>())
        })?;
    } else {
        (0..directions.count()).try_for_each(|view| take(view, &light))?;
    }
    let lights = &lit.scene.lights;
    let has_sky = lights.environment.is_some() || lights.sky.is_some_and(|sky| sky != [0.0; 3]);
    let walked = walked(lit, &lit.limits)?;
    let walked = walked.map(|plan| Walked { plan, mirrors_sky: has_specular && has_sky });
    far_field::add_entries(files, lit, &facets, walked.as_ref(), true)
}
