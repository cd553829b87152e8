use ridgelight::scene::{Directions, VisiblePoint, VisiblePoints};
use ridgelight::{Result, plan};
use ridgelight_bake as bake;

use super::super::map::{Format, MapFiles};
use super::{DirectionsJob, Kind, Making, Map, OfDirections, Request, Source, Value};

pub static KIND: Kind = Kind {
    name: "visible-points",
    about: "row and column of the grid point visible from each grid point in each of \
        --directions: a layer each",
    encodings: &bake::POINTS,
    formats: &[Format::Ktx2],
    decoder: include_str!("../../../../../shaders_glsl/decode/visible_points.glsl"),
    begin,
};

fn begin(request: &Request) -> Result<Making> {
    let count = request.directions.count();
    let value = |name| Value {
        name,
        about: "of the grid point nearest to the hit, from the north-west; -1 for the sky, -2 \
            for the ground beyond; layer k is directions[k] of this manifest",
        unit: "grid points",
        range: [-2.0, VisiblePoints::LARGEST_SIDE as f64 - 1.0],
    };
    let name = |k: usize| ["row", "column"].map(|part| format!("visible_points.{k:04}.{part}"));
    let map = Map {
        planes: (0..count).flat_map(name).collect(),
        values: vec![value("row"), value("column")],
        is_array: true,
        constants: Vec::new(),
        ..Map::default()
    };
    // Words, and the points decoded from them.
    let bytes = |directions: &Directions| 8 * directions.count() as u64;
    let plan: super::PlanOf = |field, border, directions, _, limits| {
        plan::visible_points(field, border, directions, limits)
    };
    let of = OfDirections { plan, bytes, take };
    Ok(Making { map, source: Source::Directions(of) })
}

fn take(traced: &DirectionsJob, files: &mut MapFiles) -> Result<()> {
    let DirectionsJob { field, border, directions, outputs, .. } = traced;
    let words = outputs.iter().flatten().map(|v| v.to_bits()).collect();
    let points = VisiblePoints::new(field, *border, (*directions).clone(), words)?;
    let (grid_points, cols) = (field.rows() * field.cols(), field.cols());
    // The triangulation of the directions, which the decoder's `visible_share` needs. Too few
    // directions have none.
    if let Ok(net) = directions.triangles() {
        files.add_entry("triangles", serde_json::json!(net.corners()));
    }
    for direction in 0..directions.count() {
        let place = |texel| match points.point(direction, texel) {
            VisiblePoint::GridPoint(at) => [at / cols, at % cols].map(|n| n as f32),
            VisiblePoint::Sky => [-1.0; 2],
            VisiblePoint::Ground => [-2.0; 2],
        };
        let [rows, columns] = [0, 1]
            .map(|part| -> Vec<f32> { (0..grid_points).map(|texel| place(texel)[part]).collect() });
        files.take(&[&rows, &columns])?;
    }
    Ok(())
}
