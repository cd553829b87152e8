//! Kinds from visibility along directions: ellipses of visible sky, and visible points.

use ridgelight::scene::{Curvature, Directions, VisiblePoint, VisiblePoints};
use ridgelight::{Error, Result, plan};
use ridgelight_bake::{CurvedEllipses, Ellipse};
use ridgelight_cpu::ellipse_fit::{FIRST_STEP, MOST_STEPS};

use super::{Job, Map, MapFiles, OfDirections, Value, Wanted, plane, take};

pub const ELLIPSE: OfDirections = OfDirections {
    needs_sphere: false,
    plan: |job, limits| plan::ellipses(job.field(), job.border(), job.around, limits),
    bytes: |_| 2 * 16 + 6 * 4,
    probe: None,
    take: |_, outputs, files| {
        take(files, outputs[0].as_chunks::<4>().0)?;
        let [along, across] = [0, 1].map(|part| plane(outputs[1].as_chunks::<4>().0, part));
        files.take(&[&along, &across])
    },
};

/// How far the search's steps can move a point.
const FAR: f64 = MOST_STEPS as f64 * FIRST_STEP;

pub fn ellipse(_: &Job, _: &Wanted) -> Result<Map> {
    let value = |name, about, range| Value { name, about, unit: "", range };
    let centre = "of the ellipse's centre, where a direction is (x, y) without its z; (4, 0) \
        where everything is shadowed";
    let axis = "of the unit axis";
    let radius = "one over the radius; 0 where everything is lit";
    let largest = (*Directions::COUNT.end() as f64 / 2.0).sqrt();
    // A centre begins inside the disc and moves to one side.
    let far = 1.0 + FAR;
    let values = [
        value("centre_x", centre, [-far, far]),
        value("centre_y", centre, [-far, far]),
        value("axis_x", axis, [0.0, 1.0]),
        value("axis_y", axis, [-1.0, 1.0]),
        value("inverse_along", radius, [0.0, largest]),
        value("inverse_across", radius, [0.0, largest]),
    ];
    let planes = values.iter().map(|v| format!("ellipse.{}", v.name)).collect();
    Ok(Map { planes, values: values.into(), is_array: true, ..Map::default() })
}

pub const CURVED_ELLIPSE: OfDirections = OfDirections {
    needs_sphere: true,
    plan: |job, limits| {
        let curvature = job.curvature.expect("its map checks it");
        plan::curved_ellipses(job.field(), job.border(), job.around, curvature, limits)
    },
    bytes: |_| 10 * 16 + 5 * 40 + 25 * 4,
    probe: Some(probe_curved),
    take: take_curved,
};

const BASES: [&str; 5] =
    ["flat", "east_outwards", "east_inwards", "north_outwards", "north_inwards"];

pub fn curved_ellipse(job: &Job, _: &Wanted) -> Result<Map> {
    let Some([outwards, inwards]) = job.curvature else {
        let expected = "OUT[,IN], the curvatures at which ellipses are fitted, 1/m";
        return Err(Error::setting("--curvature", "none with --what curved-ellipse", expected));
    };
    // The largest radius that the search's steps can reach from inside the disc.
    let far = 2.0 + FAR;
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
    let xy = value("xy", matrix, -far);
    let bases = BASES.iter().flat_map(|base| four.map(|value| (base, value)));
    let all = bases.chain(BASES.iter().map(|base| (base, xy)));
    let named = all.map(|(base, value)| (format!("curved_ellipse.{base}.{}", value.name), value));
    let (planes, values) = named.unzip();
    let constants = vec![
        format!("const float CURVATURE_OUTWARDS = {outwards:?};"),
        format!("const float CURVATURE_INWARDS = {inwards:?};"),
    ];
    Ok(Map { planes, values, is_array: true, constants, ..Map::default() })
}

fn probe_curved(job: &Job, files: &mut MapFiles) {
    let [outwards, inwards] = job.curvature.expect("its map checks it");
    let bent = [[outwards, 0.0], [-inwards, 0.0], [0.0, outwards], [0.0, -inwards]];
    for (per_m, base) in bent.into_iter().zip(&BASES[1..]) {
        let changed = Curvature { per_m }.occlusion_change(job.field(), job.border());
        files.remark(format!("base surface curved {}: {changed}", base.replace('_', " ")));
    }
}

fn take_curved(job: &Job, outputs: &[Vec<f32>], files: &mut MapFiles) -> Result<()> {
    let steps = job.curvature.expect("its map checks it");
    let texel = |image: usize, at: usize| outputs[image].as_chunks::<4>().0[at];
    let of = |at: usize| {
        let five = [0, 1, 2, 3, 4].map(|k| {
            let [along, across, ..] = texel(2 * k + 1, at);
            Ellipse::of_texels(texel(2 * k, at), [along, across])
        });
        CurvedEllipses::of(&five, steps).numbers
    };
    let all: Vec<[[f64; 5]; 5]> = (0..job.grid_points()).map(of).collect();
    for base in 0..5 {
        let four: Vec<[f64; 4]> =
            all.iter().map(|five| [0, 1, 2, 3].map(|n| five[base][n])).collect();
        take(files, &four)?;
    }
    let mixed: Vec<[f64; 5]> = all.iter().map(|five| five.map(|base| base[4])).collect();
    let mixed = [0, 1, 2, 3, 4].map(|base| plane(&mixed, base));
    files.take(&[0, 1, 2, 3].map(|base| mixed[base].as_slice()))?;
    files.take(&[&mixed[4]])
}

pub const VISIBLE_POINTS: OfDirections = OfDirections {
    needs_sphere: true,
    plan: |job, limits| plan::visible_points(job.field(), job.border(), job.around, limits),
    // Words, and the points decoded from them.
    bytes: |job| 8 * job.around.count() as u64,
    probe: None,
    take: take_points,
};

pub fn visible_points(job: &Job, _: &Wanted) -> Result<Map> {
    let value = |name| Value {
        name,
        about: "of the grid point nearest to the hit, from the north-west; -1 for the sky, -2 \
            for the ground beyond; layer k is directions[k] of this manifest",
        unit: "grid points",
        // 16 bits; two of their values are marks.
        range: [-2.0, f64::from(u16::MAX) - 3.0],
    };
    let name = |k: usize| ["row", "column"].map(|part| format!("visible_points.{k:04}.{part}"));
    Ok(Map {
        planes: (0..job.around.count()).flat_map(name).collect(),
        values: ["row", "column"].map(value).into(),
        is_array: true,
        ..Map::default()
    })
}

fn take_points(job: &Job, outputs: &[Vec<f32>], files: &mut MapFiles) -> Result<()> {
    let (field, directions) = (job.field(), job.around);
    let words = outputs.iter().flatten().map(|v| v.to_bits()).collect();
    let points = VisiblePoints::new(field, job.border(), directions.clone(), words)?;
    let cols = field.cols();
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
        take(files, &(0..job.grid_points()).map(place).collect::<Vec<_>>())?;
    }
    Ok(())
}
