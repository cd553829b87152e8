use ridgelight::scene::Curvature;
use ridgelight::{Error, Result, plan};
use ridgelight_bake as bake;
use ridgelight_bake::{CurvedEllipses, Ellipse};
use ridgelight_cpu::ellipse_fit::{FIRST_STEP, MOST_STEPS};

use super::super::map::{Format, MapFiles};
use super::{DirectionsJob, Kind, Making, Map, OfDirections, Request, Source, Value};

pub static KIND: Kind = Kind {
    name: "curved-ellipse",
    about: "ellipses of visible sky for any small curvature of the base surface, for shadows and \
        view visibility: five per texel, fitted to --directions on a flat base and at \
        --curvature along both axes, with linear interpolation between",
    encodings: &bake::CURVED_ELLIPSE,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/curved_ellipse.glsl"),
    begin,
};

const BASES: [&str; 5] =
    ["flat", "east_outwards", "east_inwards", "north_outwards", "north_inwards"];

fn begin(request: &Request) -> Result<Making> {
    let Some([outwards, inwards]) = request.curvature else {
        let expected = "OUT[,IN], the curvatures at which ellipses are fitted, 1/m";
        return Err(Error::setting("--curvature", "none with --what curved-ellipse", expected));
    };
    // The largest radius that the search's steps can reach from inside the disc.
    let far = 2.0 + MOST_STEPS as f64 * FIRST_STEP;
    let value = |name, about, low| Value { name, about, unit: "", range: [low, far] };
    let centre = "of the ellipse's centre, where a direction is (x, y) without its z";
    let matrix = "of the symmetric matrix that maps the unit disc to the ellipse; 0 where \
        everything is shadowed";
    let four = [
        value("centre_x", centre, -far),
        value("centre_y", centre, -far),
        value("xx", matrix, 0.0),
        value("yy", matrix, 0.0),
    ];
    let name = |base: &str, value: &str| format!("curved_ellipse.{base}.{value}");
    let mut planes: Vec<String> =
        BASES.iter().flat_map(|base| four.iter().map(|v| name(base, v.name))).collect();
    planes.extend(BASES.map(|base| name(base, "xy")));
    let mut values: Vec<Value> = BASES
        .iter()
        .flat_map(|_| {
            four.iter().map(|v| Value { name: v.name, about: v.about, unit: "", range: v.range })
        })
        .collect();
    values.extend(BASES.map(|_| value("xy", matrix, -far)));
    let map = Map {
        planes,
        values,
        is_array: true,
        constants: vec![
            format!("const float CURVATURE_OUTWARDS = {outwards:?};"),
            format!("const float CURVATURE_INWARDS = {inwards:?};"),
        ],
        ..Map::default()
    };
    let plan: super::PlanOf = |field, border, directions, curvature, limits| {
        let curvature = curvature.expect("checked by begin");
        plan::curved_ellipses(field, border, directions, curvature, limits)
    };
    let of = OfDirections { plan, bytes: |_| 10 * 16 + 5 * 40 + 25 * 4, take };
    Ok(Making { map, source: Source::Directions(of) })
}

fn take(traced: &DirectionsJob, files: &mut MapFiles) -> Result<()> {
    let steps = traced.curvature.expect("checked by begin");
    let [outwards, inwards] = steps;
    let bent = [[outwards, 0.0], [-inwards, 0.0], [0.0, outwards], [0.0, -inwards]];
    for (per_m, base) in bent.into_iter().zip(&BASES[1..]) {
        let changed = Curvature { per_m }.occlusion_change(traced.field, traced.border);
        files.remark(format!("base surface curved {}: {changed}", base.replace('_', " ")));
    }
    let texel = |image: usize, at: usize| {
        <[f32; 4]>::try_from(&traced.outputs[image][4 * at..4 * at + 4]).expect("four")
    };
    let of = |at: usize| {
        let five = [0, 1, 2, 3, 4].map(|k| {
            let [along, across, ..] = texel(2 * k + 1, at);
            Ellipse::of_texels(texel(2 * k, at), [along, across])
        });
        CurvedEllipses::of(&five, steps).numbers
    };
    let all: Vec<[[f64; 5]; 5]> = (0..traced.field.heights_m().len()).map(of).collect();
    let plane = |base: usize, number: usize| -> Vec<f32> {
        all.iter().map(|five| five[base][number] as f32).collect()
    };
    for base in 0..5 {
        let four = [0, 1, 2, 3].map(|number| plane(base, number));
        files.take(&four.each_ref().map(Vec::as_slice))?;
    }
    let mixed = [0, 1, 2, 3, 4].map(|base| plane(base, 4));
    files.take(&[0, 1, 2, 3].map(|base| mixed[base].as_slice()))?;
    files.take(&[&mixed[4]])
}
