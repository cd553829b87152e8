//! Sphere lights: times and errors over a fractal field, by their number and radius; and by SH beside the exact
//! form on the scene of cones of the thesis on local lights, its figures 6.1 and 6.2 with errors.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{
    Basis, Border, HeightField, LightBasis, Lights, Method, Quality, Receiver, Scene, SphereLight,
    Surface, Wedges, fractal,
};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;

use crate::common::args::Args;
use crate::common::frames::{device, drawn, error_of, open};
use crate::common::panels::{self, Panel};
use crate::common::{Outcome, head, inputs};

const COUNTS: [usize; 3] = [1, 8, 64];
/// In cells of 1 m.
const RADII_M: [f64; 2] = [0.25, 4.0];
/// The lights' height over the ground.
const ABOVE_M: f64 = 12.0;
/// Draws after the first.
const DRAWS: usize = 5;
/// Grid points compared with the oracle.
const PLACES: usize = 60;

fn sphere(position_m: [f64; 3], radius_m: f64) -> SphereLight {
    SphereLight { position_m, radius_m, radiance: [1.0; 3] }
}

fn scene(field: &HeightField, sphere_lights: Vec<SphereLight>) -> Scene {
    let lights = Lights { sphere_lights, ..Lights::default() };
    Scene { field: field.clone(), surface: Surface::default(), lights }
}

/// On a lattice.
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
    args.end()?;
    let mut gpu = open()?;
    let field = fractal(side, 1)?;
    println!("{}: {side}², {ABOVE_M} m above a fractal in cells of 1 m\n", device(&gpu));
    head("| lights | radius m | frame ms | ms a light | RMSE % |");
    for (radius_m, count) in RADII_M.into_iter().flat_map(|r| COUNTS.map(|c| (r, c))) {
        let scene = scene(&field, lattice(&field, count, radius_m));
        let found = drawn(&mut gpu, &scene, &Quality::default(), DRAWS)?;
        let lit = Lit::of(&scene);
        let places = || (1..=PLACES).map(|k| inputs::spread(k, side * side));
        let truth: Vec<f64> = places().map(|i| lit.at(i / side, i % side)[0]).collect();
        let ours: Vec<f64> = places().map(|i| found.light[i][0]).collect();
        let (ms, error) = (found.ms(), error_of(&ours, &truth));
        println!("| {count} | {radius_m} | {ms:.1} | {:.1} | {error:.3} |", ms / count as f64);
    }
    Ok(())
}

/// Of the scene of cones: grid points a side, in cells of 1 m.
const SIDE: usize = 256;
const CONES: usize = 12;
/// First column and row of the detail that is drawn, and its grid points a side: one cone and its shadow.
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

/// As in the thesis: a pyramid with levels four octaves finer than the default, wedges of all around from a
/// table, a clamped cosine.
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

fn on_surface(quality: Quality) -> Quality {
    Quality { method: Method::Auto, ..quality }
}

/// Figure, form and settings of each row.
fn forms() -> Vec<(&'static str, String, Quality)> {
    type Form = (&'static str, fn(u32, u32) -> Quality);
    const FORMS: [Form; 2] = [("table of all around", thesis), ("across", across)];
    let of = |azimuths: &'static [u32], steps: &'static [u32]| {
        let settings = move || azimuths.iter().flat_map(|m| steps.iter().map(move |k| (*m, *k)));
        FORMS.iter().flat_map(move |form| settings().map(move |(m, k)| (form.0, form.1(m, k))))
    };
    let mut all = Vec::new();
    let mut add = |figure, name: &str, quality| all.push((figure, name.to_owned(), quality));
    of(&[4, 8, 32], &[4]).for_each(|(name, quality)| add("6.1", name, quality));
    of(&[32], &[1, 2, 3, 4]).for_each(|(name, quality)| add("6.2", name, quality));
    for azimuths in [&[4], &[8], &[32]] {
        of(azimuths, &[4]).for_each(|(name, quality)| add("", name, on_surface(quality)));
    }
    for sh_order in [2, 3, 5, 6] {
        let quality = Quality { sh_order, ..on_surface(across(32, 4)) };
        add("", &format!("across, order {sh_order}"), quality);
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
    args.end()?;
    let (mut gpu, field) = (open()?, cone_field()?);
    println!(
        "{}\n{SIDE}²: {CONES} cones on a circle, a light of radius 5 m 12 m above the ground, cells of 1 m\n",
        device(&gpu)
    );
    let scene = scene(&field, vec![sphere([128.0, 128.0, 12.0], 5.0)]);
    let (oracle, light) = (Oracle::new(&field, Border::Plane), scene.lights.sphere_lights[0]);
    let truth = |i: usize| sphere_of(&oracle, i / SIDE, i % SIDE, &light, 64);
    let places: Vec<usize> = (1..=CONE_PLACES).map(|k| inputs::spread(k, SIDE * SIDE)).collect();
    let right: Vec<f64> = places.iter().map(|i| truth(*i)).collect();
    let true_detail = detail(truth);
    head(
        "| figure | horizons | form | azimuths | level step | ms | RMSE % | in the detail | beside the exact form |",
    );
    type Found = ([f64; 2], Vec<f64>, Vec<f64>);
    let of = |gpu: &mut Headless, quality: &Quality| -> Result<Found> {
        let found = drawn(gpu, &scene, quality, DRAWS)?;
        let at: Vec<f64> = places.iter().map(|i| found.light[*i][0]).collect();
        let own = detail(|i| found.light[i][0]);
        Ok(([found.ms(), error_of(&at, &right)], at, own))
    };
    let ([ms, error], exact, exact_detail) = of(&mut gpu, &Quality::default())?;
    let in_detail = error_of(&exact_detail, &true_detail);
    println!("| | surface | exact slices | 8 | | {ms:.1} | {error:.2} | {in_detail:.2} | 0 |");
    // The rows of the picture: figure 6.1 between the ground truth and the exact form, and figure 6.2.
    let mut rows = [vec![true_detail.clone()], Vec::new()];
    for (figure, form, quality) in forms() {
        let ([ms, error], at, own) = of(&mut gpu, &quality)?;
        let (horizons, step) = match quality.method {
            Method::Pyramid => ("pyramid", quality.level_step.to_string()),
            _ => ("surface", String::new()),
        };
        println!(
            "| {figure} | {horizons} | {form} | {} | {step} | {ms:.1} | {error:.2} | {:.2} | {:.2} |",
            quality.sun_azimuths,
            error_of(&own, &true_detail),
            error_of(&at, &exact)
        );
        match figure {
            "6.1" => rows[0].push(own),
            "6.2" => rows[1].push(own),
            _ => {}
        }
    }
    rows[0].push(exact_detail);
    let Some(path) = output else { return Ok(()) };
    // Each detail above its difference to the ground truth: red where there is too much light, blue too little.
    let white = true_detail.iter().copied().fold(0.0, f64::max);
    let grey = |values: &Vec<f64>| -> Panel {
        values.iter().map(|v| [(v / white).clamp(0.0, 1.0) as f32; 3]).collect()
    };
    let difference = |values: &Vec<f64>| -> Panel {
        // Half of the brightest is the full colour, as in the thesis.
        let share =
            |(v, right): (&f64, &f64)| ((v - right) / (0.5 * white)).clamp(-1.0, 1.0) as f32;
        let colour = |s: f32| if s > 0.0 { [s, 0.0, 0.0] } else { [0.0, -0.4 * s, -s] };
        values.iter().zip(&true_detail).map(|pair| colour(share(pair))).collect()
    };
    let picture: Vec<Vec<Panel>> = rows
        .iter()
        .flat_map(|row| [row.iter().map(grey).collect(), row.iter().map(difference).collect()])
        .collect();
    Ok(panels::write(&path, &picture, DETAIL_SIDE, 2, 1.0)?)
}
