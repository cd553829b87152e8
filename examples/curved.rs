//! A flat field's data on curved bases (Heidrich et al. 2000, §5), beside real geometry.
//!
//! `cargo run --release --example curved -- [-o PICTURE.svg]`
//!
//! Three grooves of 16 by 8 cells, walls of 45°, are bent across their length into a cylinder, outwards and inwards, as a mesh
//! whose triangles rays are shot at. Beside it what samples see on the flat field, as it is and adapted to the curvature.
//! Shadows: 200 lights of each sample's own hemisphere. Scattered light: walls that face east shine, all scatter it, once and up to
//! three times.

#[path = "curved/light.rs"]
mod light;
#[path = "curved/mesh.rs"]
mod mesh;
#[path = "soft/plot.rs"]
mod plot;
#[path = "shared/seen.rs"]
mod seen;

use std::path::PathBuf;

use glam::DVec3;
use light::{ALBEDO, BOUNCES, Looks, RAYS};
use mesh::Mesh;
use plot::{Curve, Panel};
use ridgelight::bake::CurvedEllipses;
use ridgelight::basis::triangles::Triangles;
use ridgelight::cpu::ellipse_fit::{Ellipse, fit, seen_bent};
use ridgelight::cpu::fan_weigh::weight;
use ridgelight::cpu::points_bend::{Draped, Fans};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, Changed, Curvature, Directions, HeightField, Lights, Scatter, Scene, Surface,
    VisiblePoint, VisiblePoints,
};
use ridgelight::{Error, Result};

const LIGHTS: usize = 200;
const DIRECTIONS: usize = 1024;
/// Of the device's light that has been scattered several times.
const PATHS: u32 = 1024;
const PERIOD: usize = 16;
const GROOVES: usize = 3;
const ROWS: usize = 33;
/// Rows whose samples are compared: what lies across the grooves is the same in all, but for the ends.
const COMPARED: [usize; 3] = [8, 16, 24];
const RADII: [f64; 9] = [100.0, 70.0, 50.0, 35.0, 25.0, 18.0, 12.0, 8.0, 5.0];
/// What four of five ellipses are fitted at, outwards and inwards, 1/m.
const STEPS: [f64; 2] = [1.0 / 25.0, 1.0 / 100.0];
/// Nothing within a groove lies beyond its end; what does is the field's edge.
const BORDER: Border = Border::Open;

/// Shares of something wrong, percent, on a base.
struct Row {
    curvature: f64,
    /// Share of lights that arrive.
    lit: f64,
    /// By directions as they are and adapted; by flat ellipses, between five, and fitted here.
    shadows: [f64; 5],
    /// Of light scattered once and several times.
    light: [Scattered; 2],
    /// Off the device several times, RMSE; of bases that it does not refuse.
    device: Option<f64>,
    /// What [`Curvature::check`] finds.
    changed: Changed,
    refused: Option<String>,
}

struct Scattered {
    /// On the base, by rays, of each compared sample; and turned and weighed.
    truth: Vec<f64>,
    weighed: Vec<f64>,
    /// Their sum over that on the flat base.
    over_flat: f64,
    /// RMSE by directions as they are, turned, and turned and weighed.
    off: [f64; 3],
}

fn grooves() -> Result<HeightField> {
    let cols = GROOVES * PERIOD + 1;
    let half = PERIOD as f64 / 2.0;
    let height = |i: usize| (((i % cols) % PERIOD) as f64 - half).abs();
    let heights: Vec<f64> = (0..ROWS * cols).map(height).collect();
    HeightField::new(ROWS, cols, &heights, [1.0; 2], None)
}

/// Samples that are compared, in the order of everything below.
fn compared(field: &HeightField) -> impl Iterator<Item = usize> + use<> {
    let cols = field.cols();
    COMPARED.into_iter().flat_map(move |row| row * cols..(row + 1) * cols)
}

fn percent(wrong: usize, of: usize) -> f64 {
    100.0 * wrong as f64 / of as f64
}

/// Which lights arrive at compared samples, by rays at the mesh.
fn lit(mesh: &Mesh, samples: &[usize], lights: &Directions) -> Vec<Vec<bool>> {
    let of = |sample: &usize| {
        let arrives =
            |l: &DVec3| mesh.met(mesh.over(*sample), mesh.frames[*sample].out(*l)).is_none();
        lights.vectors().iter().map(arrives).collect()
    };
    samples.iter().map(of).collect()
}

/// Five ellipses of each sample.
fn five(
    gpu: &mut Headless,
    field: &HeightField,
    directions: &Directions,
    steps: [f64; 2],
) -> Result<Vec<[Ellipse; 5]>> {
    let plan = plan::curved_ellipses(field, BORDER, directions, steps, &gpu.report().limits)?;
    gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let images = (0..10).map(|i| Ok(gpu.pixels(frame, i)?.values));
        let images = images.collect::<Result<Vec<_>>>()?;
        let texel = |image: usize, at: usize| {
            <[f32; 4]>::try_from(&images[image][4 * at..4 * at + 4]).expect("4")
        };
        let ellipse = |k: usize, at: usize| {
            let [along, across, ..] = texel(2 * k + 1, at);
            Ellipse::of_texels(texel(2 * k, at), [along, across])
        };
        let five = |at| [0, 1, 2, 3, 4].map(|k| ellipse(k, at));
        Ok((0..field.heights_m().len()).map(five).collect())
    })
}

/// Light scattered up to so many times, off the device; once by each direction in turn, without chance.
fn off_device(
    gpu: &mut Headless,
    flat: &Flat,
    scene: &Scene,
    (curvature, bounces): (Curvature, usize),
) -> Result<Vec<f64>> {
    let directions = flat.points.directions();
    let paths = if bounces == 1 { DIRECTIONS as u32 } else { PATHS };
    let scatter =
        Scatter { bounces: bounces as u32, paths, curvature, cutoff: 0.0, ..Scatter::default() };
    let plan = plan::scatter(scene, directions, &scatter, &gpu.report().limits)?;
    let direct: Vec<[f32; 3]> = flat.own.iter().map(|own| [*own as f32; 3]).collect();
    let inputs = plan::scatter_inputs(&plan, scene, &flat.points, &direct)?;
    let inputs: Vec<&[f32]> = inputs.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &inputs, |gpu, frame| {
        gpu.draw(frame)?;
        Ok(gpu.pixels(frame, 0)?.values.chunks_exact(4).map(|t| f64::from(t[0])).collect())
    })
}

/// Percent of the mean.
fn rmse(found: &[f64], truth: &[f64]) -> f64 {
    let squares: f64 = found.iter().zip(truth).map(|(f, t)| (f - t).powi(2)).sum();
    let count = truth.len() as f64;
    100.0 * (squares / count).sqrt() / (truth.iter().sum::<f64>() / count)
}

/// What the flat field tells, whatever the base.
struct Flat {
    field: HeightField,
    points: VisiblePoints,
    fans: Fans,
    net: Triangles,
    lights: Directions,
    five: Vec<[Ellipse; 5]>,
    /// What each sample shines by.
    own: Vec<f64>,
    /// Scattered light by rays, its sum.
    scattered: [f64; 2],
}

impl Flat {
    /// Share of lights wrong of a test, percent; it is asked of the number of a compared sample.
    fn wrong(&self, lit: &[Vec<bool>], holds: impl Fn(usize, DVec3) -> bool) -> f64 {
        let lights = self.lights.vectors();
        let of = |(n, lit): (usize, &Vec<bool>)| {
            lights.iter().zip(lit).filter(|(light, lit)| holds(n, **light) != **lit).count()
        };
        let wrong: usize = lit.iter().enumerate().map(of).sum();
        percent(wrong, lit.len() * lights.len())
    }

    /// By the triangles of directions that stand so, cut at a half; the nearest direction where none holds a light.
    fn by_directions(&self, draped: &Draped, bent: &[DVec3], at: usize, light: DVec3) -> bool {
        let share = draped.lit_share(&self.net, bent, at, light).unwrap_or_else(|| {
            let near = |i: &usize| bent[*i].dot(light);
            let nearest = (0..DIRECTIONS)
                .filter(|i| bent[*i].z > 0.0)
                .max_by(|a, b| near(a).total_cmp(&near(b)));
            let sees_sky = nearest.is_some_and(|i| self.points.seen(i, at) == VisiblePoint::Sky);
            f64::from(u8::from(sees_sky))
        });
        share >= 0.5
    }
}

fn row(gpu: &mut Headless, flat: &Flat, scene: &Scene, per_m: f64) -> Result<Row> {
    let field = &flat.field;
    let curvature = Curvature { per_m: [per_m, 0.0] };
    let refused = curvature.check(field, BORDER).err().map(|error| error.to_string());
    let mesh = Mesh::bent(field, per_m);
    let all: Vec<usize> = compared(field).collect();
    let lit = lit(&mesh, &all, &flat.lights);
    let light = light::truth(&mesh, field, &all)?;
    let draped = |curvature| Draped {
        field,
        border: BORDER,
        points: &flat.points,
        fans: &flat.fans,
        curvature,
    };
    let (as_is, adapted) = (draped(Curvature::FLAT), draped(curvature));
    let samples = 0..field.heights_m().len();
    let vectors = flat.points.directions().vectors();
    let bent: Vec<Vec<DVec3>> = samples.map(|at| adapted.bent(at)).collect();
    let here = |at: &usize| fit(&seen_bent(&flat.points, &bent[*at], *at)).0;
    let fitted: Vec<Ellipse> = all.iter().map(here).collect();
    let between: Vec<CurvedEllipses> =
        all.iter().map(|at| CurvedEllipses::of(&flat.five[*at], STEPS)).collect();
    let shadows = [
        flat.wrong(&lit, |n, l| flat.by_directions(&as_is, vectors, all[n], l)),
        flat.wrong(&lit, |n, l| flat.by_directions(&adapted, &bent[all[n]], all[n], l)),
        flat.wrong(&lit, |n, l| flat.five[all[n]][0].holds(l)),
        flat.wrong(&lit, |n, l| between[n].holds(curvature, l)),
        flat.wrong(&lit, |n, l| fitted[n].holds(l)),
    ];
    // The twin, which refuses nothing; the device beside it where it may.
    let weigh = |bent: &Vec<DVec3>| (0..DIRECTIONS).map(|i| weight(&flat.fans, bent, i)).collect();
    let weights = bent.iter().map(weigh).collect();
    let as_is = Looks { bent: vec![vectors.to_vec(); bent.len()], weights: None };
    let turned = Looks { bent, weights: None };
    let twin = |curvature: Curvature, looks: &Looks| {
        let found = light::scattered(scene, &flat.points, curvature, looks, &flat.own);
        found.map(|light| all.iter().map(|at| light[*at]).collect::<Vec<f64>>())
    };
    let kinds = [twin(Curvature::FLAT, &as_is), twin(curvature, &turned)];
    let weighed = twin(curvature, &Looks { weights: Some(weights), ..turned });
    let truth = |k: usize| light.iter().map(|light| light[k]).collect::<Vec<f64>>();
    let mut device = None;
    if refused.is_none() {
        for (k, bounces) in BOUNCES.into_iter().enumerate() {
            let found = off_device(gpu, flat, scene, (curvature, bounces))?;
            let found: Vec<f64> = all.iter().map(|at| found[*at]).collect();
            let off = rmse(&found, &weighed[k]);
            assert!(bounces > 1 || off < 0.1, "the device scatters {off} % off its twin");
            device = Some(rmse(&found, &truth(k)));
        }
    }
    let scattered = |k: usize| Scattered {
        truth: truth(k),
        weighed: weighed[k].clone(),
        over_flat: truth(k).iter().sum::<f64>() / flat.scattered[k],
        off: [&kinds[0], &kinds[1], &weighed].map(|found| rmse(&found[k], &truth(k))),
    };
    let count = lit.iter().flatten().filter(|lit| **lit).count();
    Ok(Row {
        curvature: per_m,
        lit: percent(count, all.len() * LIGHTS),
        shadows,
        light: [0, 1].map(scattered),
        device,
        changed: curvature.changed(field, BORDER),
        refused,
    })
}

/// RMSE of light between that of three bases, those that ellipses are fitted at, as a base that bends on along an object has it.
fn between(rows: &[Row], row: &Row, k: usize) -> f64 {
    let end = if row.curvature < 0.0 { -STEPS[1] } else { STEPS[0] };
    let of = |curvature: f64| {
        let at = rows.iter().find(|r| r.curvature == curvature).expect("a row of each");
        &at.light[k].weighed
    };
    let share = row.curvature / end;
    let mixed =
        of(0.0).iter().zip(of(end)).map(|(flat, end)| (flat + share * (end - flat)).max(0.0));
    rmse(&mixed.collect::<Vec<_>>(), &row.light[k].truth)
}

fn table(rows: &[Row]) {
    let radius = |row: &Row| match row.curvature {
        0.0 => "flat".to_owned(),
        k => format!("{:+.0}", 1.0 / k),
    };
    let told = |row: &Row| if row.refused.is_some() { "refused" } else { "" };
    println!(
        "| radius, cells | lit, % | wrong by flat directions, % | adapted | said, of lights | by flat ellipses | between five | fitted here | |\n\
         |---|---|---|---|---|---|---|---|---|"
    );
    for row in rows {
        let [by_flat, adapted, ellipses @ ..] = row.shadows.map(|v| format!("{v:.2}"));
        println!(
            "| {} | {:.1} | {by_flat} | {adapted} | {:.2} | {} | {} |",
            radius(row),
            row.lit,
            100.0 * row.changed.shadows,
            ellipses.join(" | "),
            told(row)
        );
    }
    println!(
        "\n| radius, cells | scattered once, over flat | off by flat directions, % | turned | turned and weighed | between three | said, of light | \
         up to {} times, over flat | off by flat directions, % | turned | turned and weighed | between three | device | |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
        BOUNCES[1]
    );
    for row in rows {
        let [once, more] = [0, 1].map(|k| {
            let Scattered { over_flat, off, .. } = &row.light[k];
            let off = off.map(|v| format!("{v:.2}")).join(" | ");
            format!("{over_flat:.3} | {off} | {:.2}", between(rows, row, k))
        });
        let device = row.device.map_or(String::new(), |off| format!("{off:.2}"));
        println!(
            "| {} | {once} | {:.2} | {more} | {device} | {} |",
            radius(row),
            100.0 * row.changed.light,
            told(row)
        );
    }
}

/// What is wrong over curvature, outwards and inwards.
fn picture(rows: &[Row]) -> String {
    let panel = |title: &str, is_out: bool, is_light: bool| {
        let own: Vec<&Row> =
            rows.iter().filter(|r| r.curvature != 0.0 && (r.curvature > 0.0) == is_out).collect();
        let curve = |name: &str, colour: usize, is_floor: bool, of: &dyn Fn(&Row) -> f64| Curve {
            name: name.into(),
            points: own.iter().map(|r| [1.0 / r.curvature.abs(), of(r)]).collect(),
            colour,
            is_floor,
        };
        let curves = if is_light {
            vec![
                curve("directions of the flat field", 0, true, &|r| r.light[0].off[0]),
                curve("turned", 1, false, &|r| r.light[0].off[1]),
                curve("turned and weighed", 2, false, &|r| r.light[0].off[2]),
                curve("up to 3 times, flat directions", 3, true, &|r| r.light[1].off[0]),
                curve("up to 3 times, turned and weighed", 3, false, &|r| r.light[1].off[2]),
            ]
        } else {
            vec![
                curve("directions of the flat field", 0, true, &|r| r.shadows[0]),
                curve("adapted directions", 0, false, &|r| r.shadows[1]),
                curve("the flat field's ellipse", 3, true, &|r| r.shadows[2]),
                curve("between five ellipses", 3, false, &|r| r.shadows[3]),
            ]
        };
        let y = if is_light { "scattered light, RMSE, %" } else { "lights wrong, %" };
        let told = own.iter().filter(|r| r.refused.is_none()).map(|r| 1.0 / r.curvature.abs());
        let title = format!("{title}; refused below {:.0}", told.fold(f64::MAX, f64::min));
        Panel { title, x: "radius of the base, cells", y, curves }
    };
    plot::svg(&[
        panel("Shadows, bent outwards", true, false),
        panel("Shadows, bent inwards", false, false),
        panel("Scattered, outwards", true, true),
        panel("Scattered, inwards", false, true),
    ])
}

fn run() -> Result<()> {
    let mut args = std::env::args().skip(1);
    let mut output = None::<PathBuf>;
    while let Some(arg) = args.next() {
        match (arg.as_str(), args.next()) {
            ("-o", Some(path)) => output = Some(path.into()),
            _ => return Err(Error::setting("argument", arg, "-o PICTURE.svg")),
        }
    }
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    let field = grooves()?;
    let directions = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let (points, _) = seen::points(&mut gpu, &field, BORDER, &directions)?;
    let net = directions.triangles()?;
    let fans = Fans::of(&net, directions.vectors());
    let lights = Directions::fibonacci(LIGHTS, 0.0, 7)?;
    let five = five(&mut gpu, &field, &directions, STEPS)?;
    let all: Vec<usize> = compared(&field).collect();
    let level = light::truth(&Mesh::bent(&field, 0.0), &field, &all)?;
    let scattered = [0, 1].map(|k| level.iter().map(|light| light[k]).sum());
    let own =
        (0..field.heights_m().len()).map(|at| light::shines(at % field.cols(), PERIOD)).collect();
    let surface =
        Surface { border: BORDER, albedo: Albedo::Constant([ALBEDO as f32; 3]), phong: None };
    let scene = Scene { field: field.clone(), surface, lights: Lights::default() };
    let flat = Flat { field, points, fans, net, lights, five, own, scattered };
    println!(
        "{GROOVES} grooves of {PERIOD} by {} cells, {ROWS} long; {DIRECTIONS} directions over the sphere, {LIGHTS} lights over each sample's \
         hemisphere, {RAYS} rays. A radius above 0: valleys widen. Said: shares of a hemisphere's lights and light that the base hides or \
         lays open, of light at most {} % (`Curvature::changed`); beyond, the rows are the twin's, as the renderer refuses. Five: fitted at radii of {} outwards and {} inwards. \
         Off: RMSE over the mean; between three: light of these and the flat base, as straight as ellipses; device: {PATHS} paths.\n",
        PERIOD / 2,
        100.0 * Curvature::MOST_CHANGED,
        1.0 / STEPS[0],
        1.0 / STEPS[1]
    );
    let mut rows = Vec::new();
    let outwards = RADII.iter().rev().map(|r| 1.0 / r);
    let inwards = RADII.iter().map(|r| -1.0 / r);
    for curvature in outwards.chain([0.0]).chain(inwards) {
        rows.push(row(&mut gpu, &flat, &scene, curvature)?);
    }
    table(&rows);
    println!();
    for row in rows.iter().filter(|r| r.refused.is_some()) {
        println!(
            "radius {:+.0}: {}",
            1.0 / row.curvature,
            row.refused.as_deref().unwrap_or_default()
        );
    }
    match output {
        Some(path) => ridgelight::files::write_text(&path, &picture(&rows)),
        None => Ok(()),
    }
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}
