use ridgelight::gpu::Headless;
use ridgelight::{Error, Result};
use ridgelight_bake as bake;
use ridgelight_bake::BrdfHarmonics;

use super::super::map::{Format, MapFiles};
use super::{Kind, Lit, Making, Map, OfLight, Request, Say, Source, Value, brdf, far_field};

pub static KIND: Kind = Kind {
    name: "brdf-harmonics",
    about: "brdf, smooth between all directions: weights of the products of SH of --sh-order of \
        light and view; the manifest states its error",
    encodings: &bake::HARMONIC_WEIGHTS,
    formats: &[Format::Ktx2, Format::Npy],
    decoder: include_str!("../../../../../shaders_glsl/decode/brdf_harmonics.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let (angles, order) = (request.angles, request.quality.sh_order as usize);
    brdf::check(request, KIND.name)?;
    let terms = order * order;
    if angles.count() < terms {
        let found = format!("{}x{} with --sh-order {order}", angles.zeniths, angles.azimuths);
        return Err(Error::setting("--angles", found, format!("{terms} angles or more")));
    }
    let largest = far_field::largest(request);
    let value = |name| Value {
        name,
        about: "the table is the sum over texels (j, i) of their values times Y_i of the light \
            and Y_j of the view; real, orthonormal, x east, y north, z up, no Condon-Shortley \
            phase, index l(l+1) + m; only above horizontal",
        unit: "1/sr",
        range: [-largest, largest],
    };
    let map = Map {
        planes: ["R", "G", "B"].map(|c| format!("brdf_harmonics.{c}")).into(),
        values: ["red", "green", "blue"].map(value).into(),
        constants: vec![
            format!("const int BRDF_ORDER = {order};"),
            format!("const int BRDF_TERMS = {terms};"),
        ],
        size: Some([terms, terms]),
        axes: vec![("channel", 3), ("light", terms), ("view", terms)],
        ..Map::default()
    };
    let of = OfLight { plans: far_field::plans, bytes: brdf::bytes, make };
    Ok(Making { map, source: Source::Light(of) })
}

fn make(gpu: &mut Headless, lit: &Lit, files: &mut MapFiles, say: Say) -> Result<()> {
    let table = brdf::table(gpu, lit, say)?;
    say("harmonics".into());
    let (order, has_specular) = (lit.quality.sh_order as usize, table.facets.has_specular());
    let harmonics = BrdfHarmonics::of(&table.brdf, lit.angles, order, has_specular)?;
    let texels = harmonics.coefficients();
    let planes = [0, 1, 2].map(|c| -> Vec<f32> { texels.iter().map(|t| t[c] as f32).collect() });
    files.take(&planes.each_ref().map(Vec::as_slice))?;
    let rows = harmonics.rows(table.brdf.directions());
    brdf::tell_in_short(lit, table, rows, (&|l, v| harmonics.at(l, v), false), files)
}
