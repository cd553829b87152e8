use ridgelight::gpu::Headless;
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::Factors;

use super::super::map::{Format, MapFiles};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source, Value, brdf, far_field};

pub static KIND: Kind = Kind {
    name: "brdf-factors",
    about: "brdf in short: eight functions g of one direction, as layers over --angles, with \
        brdf = Σ g(light) g(view); with --specular Σ g(light) h(view), which adds eight layers; \
        the manifest states its error",
    encodings: &bake::REFLECTED,
    formats: &[Format::Ktx2, Format::Npy],
    decoder: include_str!("../../../../../shaders_glsl/decode/brdf_factors.glsl"),
    begin,
};

/// More factors would remove less error than the table's own angular steps leave
/// (`cargo measure brdf`).
const COUNT: usize = 8;

fn begin(request: &Request) -> Result<Making> {
    let angles = request.angles;
    brdf::check(request, KIND.name)?;
    if angles.count() < COUNT {
        let found = format!("{}x{}", angles.zeniths, angles.azimuths);
        return Err(Error::setting(
            "--angles",
            found,
            format!("{COUNT} angles or more, one per factor"),
        ));
    }
    let largest = far_field::largest(request);
    let value = |name| Value {
        name,
        about: "a function of one direction: the table is the sum over k of layer k for the \
            light times layer views + k for the view; views is 0 without --specular, else 8; \
            texel (j, k) is θ = (k + ½) π/2 / thetas, φ = 2π j / phis counter-clockwise from east",
        unit: "1/√sr",
        range: [-largest, largest],
    };
    let mut constants = far_field::constants("BRDF", angles);
    constants.push(format!("const int BRDF_FACTORS = {COUNT};"));
    // Specular is not symmetric in light and view.
    let views = if request.has_specular { COUNT } else { 0 };
    constants.push(format!("const int BRDF_VIEWS = {views};"));
    let map = Map {
        planes: (0..COUNT + views)
            .flat_map(|k| ["R", "G", "B"].map(|c| format!("brdf_factors.{k}.{c}")))
            .collect(),
        values: ["red", "green", "blue"].map(value).into(),
        is_array: true,
        constants,
        size: Some([angles.azimuths, angles.zeniths]),
        axes: vec![
            ("factor", COUNT + views),
            ("channel", 3),
            ("theta", angles.zeniths),
            ("phi", angles.azimuths),
        ],
    };
    let of = OfLight { plans: far_field::plans, bytes: brdf::bytes, make };
    Ok(Making { map, source: Source::Light(of) })
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    let table = brdf::table(gpu, lit, say)?;
    say("factors".into());
    let factors = Factors::of(&table.brdf, lit.angles, COUNT, table.facets.has_specular())?;
    for of_k in factors.values().iter().chain(factors.of_views().unwrap_or_default()) {
        let planes = [0, 1, 2].map(|c| -> Vec<f32> { of_k.iter().map(|v| v[c] as f32).collect() });
        files.take(&planes.each_ref().map(Vec::as_slice))?;
    }
    brdf::tell_in_short(lit, table, factors.rows(), (&|l, v| factors.at(l, v), true), files)
}
