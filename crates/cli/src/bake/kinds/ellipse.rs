use ridgelight::scene::Directions;
use ridgelight::{Result, plan};
use ridgelight_bake as bake;
use ridgelight_cpu::ellipse_fit::{FIRST_STEP, MOST_STEPS};

use super::super::map::{Format, MapFiles};
use super::{DirectionsJob, Kind, Making, Map, OfDirections, Request, Source, Value};

pub static KIND: Kind = Kind {
    name: "ellipse",
    about: "six numbers for a shadow test: the ellipse in the hemisphere's plan view that holds \
        the visible sky, fitted to --directions",
    encodings: &bake::ELLIPSE,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/ellipse.glsl"),
    begin,
};

fn begin(_: &Request) -> Result<Making> {
    let value = |name, about, range| Value { name, about, unit: "", range };
    let centre = "of the ellipse's centre, where a direction is (x, y) without its z; (4, 0) \
        where everything is shadowed";
    let axis = "of the unit axis";
    let radius = "one over the radius; 0 where everything is lit";
    let largest = (*Directions::COUNT.end() as f64 / 2.0).sqrt();
    // The farthest that the search's steps can move a centre from inside the disc to one side.
    let far = 1.0 + MOST_STEPS as f64 * FIRST_STEP;
    let numbers = [
        value("centre_x", centre, [-far, far]),
        value("centre_y", centre, [-far, far]),
        value("axis_x", axis, [0.0, 1.0]),
        value("axis_y", axis, [-1.0, 1.0]),
        value("inverse_along", radius, [0.0, largest]),
        value("inverse_across", radius, [0.0, largest]),
    ];
    let map = Map {
        planes: numbers.iter().map(|v| format!("ellipse.{}", v.name)).collect(),
        values: numbers.into(),
        is_array: true,
        constants: Vec::new(),
        ..Map::default()
    };
    let plan: super::PlanOf =
        |field, border, directions, _, limits| plan::ellipses(field, border, directions, limits);
    let of = OfDirections { plan, bytes: |_| 2 * 16 + 6 * 4, take };
    Ok(Making { map, source: Source::Directions(of) })
}

fn take(traced: &DirectionsJob, files: &mut MapFiles) -> Result<()> {
    let plane = |image: &[f32], part: usize| -> Vec<f32> {
        image.chunks_exact(4).map(|texel| texel[part]).collect()
    };
    let axes = [0, 1, 2, 3].map(|part| plane(&traced.outputs[0], part));
    files.take(&axes.each_ref().map(Vec::as_slice))?;
    let radii = [0, 1].map(|part| plane(&traced.outputs[1], part));
    files.take(&radii.each_ref().map(Vec::as_slice))
}
