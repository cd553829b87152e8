//! Sphere lights: times and errors over a fractal field, by their number and radius (`lights`); and by
//! SH on the scene of cones of the thesis on local lights, its figures 6.1 and 6.2 with errors
//! (`cones`).

use ridgelight::Result;
use ridgelight::scene::{
    Basis, Border, HeightField, LightBasis, Lights, Method, Quality, Receiver, Scene, SphereLight,
    Wedges, fractal,
};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;

use crate::common::args::Args;
use crate::common::frames::{device, drawn, error_of};
use crate::common::plot::{self, Texels};
use crate::common::{Outcome, head, inputs};

const COUNTS: [usize; 3] = [1, 8, 64];
const RADII_M: [f64; 2] = [0.25, 4.0];
/// The lights' height over the ground, in cells of 1 m.
const ABOVE_M: f64 = 12.0;
/// Runs after the first.
const RUNS: usize = 5;
/// Grid points compared with the oracle.
const PLACES: usize = 60;

fn sphere(position_m: [f64; 3], radius_m: f64) -> SphereLight {
    SphereLight { position_m, radius_m, radiance: [1.0; 3] }
}

fn scene(field: &HeightField, sphere_lights: Vec<SphereLight>) -> Scene {
    inputs::lit_by(field.clone(), Lights { sphere_lights, ..Lights::default() })
}

/// Lights on a square lattice.
fn lattice(field: &HeightField, count: usize, radius_m: f64) -> Vec<SphereLight> {
    let (across, side) = ((count as f64).sqrt().ceil() as usize, field.cols());
    let light = |i: usize| {
        let place = |k: usize| ((2 * k + 1) * side / (2 * across)).min(side - 1);
        let (col, up) = (place(i % across), place(i / across));
        let height = f64::from(field.heights_m()[(side - 1 - up) * side + col]);
        sphere([col as f64, up as f64, field.base_m() + height + ABOVE_M], radius_m)
    };
    (0..count).map(light).collect()
}

pub fn run(mut args: Args) -> Outcome {
    let side = args.word().map_or(Ok(512), |text| text.parse())?;
    let mut gpu = args.open()?;
    let field = fractal(side, 1)?;
    println!("{}: {side}², {ABOVE_M} m above a fractal in cells of 1 m\n", device(&gpu));
    head("| lights | radius m | frame ms | ms per light | RMSE % |");
    for (radius_m, count) in RADII_M.into_iter().flat_map(|r| COUNTS.map(|c| (r, c))) {
        let scene = scene(&field, lattice(&field, count, radius_m));
        let found = drawn(&mut gpu, &scene, &Quality::default(), RUNS)?;
        let lit = Lit::of(&scene);
        let places: Vec<usize> = (1..=PLACES).map(|k| inputs::spread(k, side * side)).collect();
        let exact: Vec<f64> = places.iter().map(|i| lit.at(i / side, i % side)[0]).collect();
        let ours: Vec<f64> = places.iter().map(|i| found.light[*i][0]).collect();
        let (ms, error) = (found.ms(), error_of(&ours, &exact)?);
        println!("| {count} | {radius_m} | {ms:.1} | {:.1} | {error:.3} |", ms / count as f64);
    }
    Ok(())
}

/// Of the scene of cones: grid points a side, in cells of 1 m.
const SIDE: usize = 256;
const CONES: usize = 12;
/// First column and row of the detail in the picture, and its side: one cone and its shadow.
const DETAIL: [usize; 2] = [178, 62];
const DETAIL_SIDE: usize = 56;
const CONE_PLACES: usize = 1000;

/// Of different sizes on a circle, as wide as high.
fn cone_field() -> Result<HeightField> {
    let middle = SIDE as f64 / 2.0;
    inputs::field(SIDE, SIDE, |row, col| {
        let [x, y] = [col as f64 - middle, middle - row as f64];
        let cone = |k: usize| {
            let angle = std::f64::consts::TAU * (k as f64 + 0.3) / CONES as f64;
            let (radius, apart) = (6.0 + 1.2 * k as f64, 75.0);
            2.0 * (radius - (x - apart * angle.cos()).hypot(y - apart * angle.sin())).max(0.0)
        };
        (0..CONES).map(cone).fold(0.0, f64::max)
    })
}

/// As in the thesis: a pyramid with levels four octaves finer than the default, wedges of all azimuths
/// from a table, a clamped cosine.
fn thesis(azimuths: u32, level_step: u32) -> Quality {
    Quality {
        method: Method::Pyramid,
        level_step,
        level_offset: 4,
        light_basis: LightBasis::Sh,
        basis: Basis::Sh,
        wedges: Wedges::Table,
        receiver: Receiver::Cosine,
        sun_azimuths: azimuths,
        azimuths: 32,
        ..Quality::default()
    }
}

/// Across the light alone, and with the grid point's own plane.
fn across(azimuths: u32, level_step: u32) -> Quality {
    Quality { wedges: Wedges::Slices, receiver: Receiver::Plane, ..thesis(azimuths, level_step) }
}

/// Figure, form and settings of each row.
fn forms() -> Vec<(&'static str, String, Quality)> {
    type Form = (&'static str, fn(u32, u32) -> Quality);
    const FORMS: [Form; 2] = [("table of all around", thesis), ("across", across)];
    let mut all = Vec::new();
    let mut add = |figure: &'static str, settings: &[(u32, u32)]| {
        for (name, form) in FORMS {
            for (azimuths, step) in settings {
                let quality = form(*azimuths, *step);
                let method = if figure.is_empty() { Method::Auto } else { quality.method };
                all.push((figure, name.to_owned(), Quality { method, ..quality }));
            }
        }
    };
    add("6.1", &[(4, 4), (8, 4), (32, 4)]);
    add("6.2", &[(32, 1), (32, 2), (32, 3), (32, 4)]);
    [4, 8, 32].into_iter().for_each(|azimuths| add("", &[(azimuths, 4)]));
    for sh_order in [2, 3, 5, 6] {
        let quality = Quality { sh_order, method: Method::Auto, ..across(32, 4) };
        all.push(("", format!("across, order {sh_order}"), quality));
    }
    all
}

/// Light at the detail's grid points.
fn detail(light: impl Fn(usize) -> f64) -> Vec<f64> {
    let at = |k: usize| (DETAIL[1] + k / DETAIL_SIDE) * SIDE + DETAIL[0] + k % DETAIL_SIDE;
    (0..DETAIL_SIDE * DETAIL_SIDE).map(|k| light(at(k))).collect()
}

pub fn cones(mut args: Args) -> Outcome {
    let output = args.path("-o")?;
    let (mut gpu, field) = (args.open()?, cone_field()?);
    println!(
        "{}\n{SIDE}²: {CONES} cones on a circle, a light of radius 5 m 12 m above the ground, cells of 1 m\n",
        device(&gpu)
    );
    let scene = scene(&field, vec![sphere([128.0, 128.0, 12.0], 5.0)]);
    let (oracle, light) = (Oracle::new(&field, Border::Plane), scene.lights.sphere_lights[0]);
    let oracle_at = |i: usize| sphere_of(&oracle, i / SIDE, i % SIDE, &light, 64);
    let places: Vec<usize> = (1..=CONE_PLACES).map(|k| inputs::spread(k, SIDE * SIDE)).collect();
    let right: Vec<f64> = places.iter().map(|i| oracle_at(*i)).collect();
    let right_detail = detail(oracle_at);
    head("| figure | horizons | form | azimuths | level step | ms | RMSE % | in the detail |");
    let mut of = |name: &str, quality: &Quality| -> Result<Vec<f64>> {
        let found = drawn(&mut gpu, &scene, quality, RUNS)?;
        let at: Vec<f64> = places.iter().map(|i| found.light[*i][0]).collect();
        let own = detail(|i| found.light[i][0]);
        println!(
            "| {name} | {:.1} | {:.2} | {:.2} |",
            found.ms(),
            error_of(&at, &right)?,
            error_of(&own, &right_detail)?
        );
        Ok(own)
    };
    let exact_detail = of("| surface | exact slices | 8 | ", &Quality::default())?;
    // The rows of the picture: figure 6.1 between the oracle and the exact form, and figure 6.2.
    let mut rows = [vec![right_detail.clone()], Vec::new()];
    for (figure, form, quality) in forms() {
        let (horizons, step) = match quality.method {
            Method::Pyramid => ("pyramid", quality.level_step.to_string()),
            _ => ("surface", String::new()),
        };
        let name = format!("{figure} | {horizons} | {form} | {} | {step}", quality.sun_azimuths);
        let own = of(&name, &quality)?;
        match figure {
            "6.1" => rows[0].push(own),
            "6.2" => rows[1].push(own),
            _ => {}
        }
    }
    rows[0].push(exact_detail);
    let Some(path) = output else { return Ok(()) };
    // Each detail above its difference to the oracle: red where there is too much light, blue too little.
    let white = right_detail.iter().copied().fold(0.0, f64::max);
    let grey = |values: &Vec<f64>| -> Texels {
        values.iter().map(|v| [(v / white).clamp(0.0, 1.0) as f32; 3]).collect()
    };
    let difference = |values: &Vec<f64>| -> Texels {
        // Half of the brightest is the full colour, as in the thesis.
        let share = |v: &f64, right: &f64| ((v - right) / (0.5 * white)).clamp(-1.0, 1.0) as f32;
        let colour = |s: f32| if s > 0.0 { [s, 0.0, 0.0] } else { [0.0, -0.4 * s, -s] };
        values.iter().zip(&right_detail).map(|(v, right)| colour(share(v, right))).collect()
    };
    let both = |row: &Vec<Vec<f64>>| {
        [row.iter().map(grey).collect(), row.iter().map(difference).collect()]
    };
    let picture: Vec<Vec<Texels>> = rows.iter().flat_map(both).collect();
    Ok(plot::png(&path, &picture, DETAIL_SIDE, 2, 1.0)?)
}
