//! The thesis' scene of cones on a circle under lights in its middle: figures 6.1 and 6.2 with errors, and tables 6.1
//! to 6.4 as ratios.

use std::path::Path;

use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::Tone;
use ridgelight::scene::{
    Basis, Border, HeightField, LightBasis, Lights, Method, Quality, Receiver, Scene, SphereLight,
    Surface, Wedges,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;
use ridgelight_io as files;

use super::typical_ms;

/// Samples a side, in cells of 1 m.
const SIDE: usize = 256;
const CONES: usize = 12;
/// First column and row of the detail that is drawn, and its grid points a side: one cone and its shadow.
const DETAIL: [usize; 2] = [178, 62];
const DETAIL_SIDE: usize = 56;
/// Samples held against the oracle.
const PLACES: usize = 1000;
/// Pixels a sample, and white ones between pictures.
const ZOOM: usize = 2;
const GAP: usize = 4;

/// Of different sizes on a circle, as wide as high.
fn cones() -> Result<HeightField> {
    let middle = SIDE as f64 / 2.0;
    let height = |i: usize| {
        let [x, y] = [(i % SIDE) as f64 - middle, middle - (i / SIDE) as f64];
        let cone = |k: usize| {
            let angle = std::f64::consts::TAU * (k as f64 + 0.3) / CONES as f64;
            let (radius, apart) = (6.0 + 1.2 * k as f64, 75.0);
            2.0 * (radius - (x - apart * angle.cos()).hypot(y - apart * angle.sin())).max(0.0)
        };
        (0..CONES).map(cone).fold(0.0, f64::max)
    };
    let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
    HeightField::new(SIDE, SIDE, &heights, [1.0; 2], None)
}

/// Slightly above the ground; the first in the middle.
fn scene(field: &HeightField, lights: usize) -> Scene {
    let at = |[x, y]: [f64; 2]| SphereLight {
        position_m: [x, y, 12.0],
        radius_m: 5.0,
        radiance: [1.0; 3],
    };
    let spheres =
        [[128.0, 128.0], [90.0, 150.0], [150.0, 95.0]].into_iter().take(lights).map(at).collect();
    let lights = Lights { sphere_lights: spheres, ..Lights::default() };
    Scene { field: field.clone(), surface: Surface::default(), lights }
}

/// A way to light the cones.
struct Form {
    name: String,
    quality: Quality,
}

fn form(name: impl Into<String>, quality: Quality) -> Form {
    Form { name: name.into(), quality }
}

/// As the thesis has it: a pyramid with levels four octaves finer than asked for, wedges of all around from a table,
/// a clamped cosine.
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

/// Across the light alone, and with the sample's own plane.
fn across(azimuths: u32, level_step: u32) -> Quality {
    Quality { wedges: Wedges::Slices, receiver: Receiver::Plane, ..thesis(azimuths, level_step) }
}

fn on_surface(quality: Quality) -> Quality {
    Quality { method: Method::Auto, ..quality }
}

/// Light of every sample, and milliseconds of a typical frame.
fn drawn(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<(Vec<f32>, f64)> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        let ms = typical_ms(gpu, frame)?;
        Ok((gpu.pixels(frame, 0)?.values, ms))
    })
}

/// RMSE over the mean of what is right, at some samples, %.
fn off(found: impl Fn(usize) -> f64, right: &[(usize, f64)]) -> f64 {
    let squares: f64 = right.iter().map(|(i, r)| (found(*i) - r).powi(2)).sum();
    let sum: f64 = right.iter().map(|(_, r)| r).sum();
    100.0 * (squares * right.len() as f64).sqrt() / sum
}

/// Figures 6.1 and 6.2: errors, and the sheet of details.
fn figures(gpu: &mut Headless, field: &HeightField, output: Option<&Path>) -> Result<()> {
    let scene = scene(field, 1);
    let (oracle, light) = (Oracle::new(field, Border::Plane), scene.lights.sphere_lights[0]);
    let truth = |i: usize| sphere_of(&oracle, i / SIDE, i % SIDE, &light, 64);
    // Multiples of the golden ratio's share of the field: no two near each other.
    let place =
        |k: usize| ((k as f64 * 0.618_033_988_749_895).fract() * (SIDE * SIDE) as f64) as usize;
    let right: Vec<(usize, f64)> = (1..=PLACES).map(|k| (place(k), truth(place(k)))).collect();
    let (exact, exact_ms) = drawn(gpu, &scene, &Quality::default())?;
    let detail = |values: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let at = |k: usize| (DETAIL[1] + k / DETAIL_SIDE) * SIDE + DETAIL[0] + k % DETAIL_SIDE;
        (0..DETAIL_SIDE * DETAIL_SIDE).map(|k| values(at(k))).collect()
    };
    let true_detail = detail(&truth);
    let mut sheet = vec![vec![true_detail.clone()], Vec::new()];
    println!(
        "| figure | horizons | form | azimuths | level step | ms | RMSE % | in the detail | beside the exact form |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let exact_off = off(|i| exact[i].into(), &right);
    let shown: Vec<(usize, f64)> = true_detail.iter().copied().enumerate().collect();
    let exact_detail = detail(&|i| exact[i].into());
    let in_detail = off(|k| exact_detail[k], &shown);
    println!(
        "| | surface | exact slices | 8 | | {exact_ms:.1} | {exact_off:.2} | {in_detail:.2} | 0 |"
    );
    let same: Vec<(usize, f64)> = right.iter().map(|(i, _)| (*i, exact[*i].into())).collect();
    let row = |gpu: &mut Headless, sheet: &mut Vec<f64>, figure: &str, form: &Form| -> Result<()> {
        let Quality { method, sun_azimuths, level_step, .. } = form.quality;
        let (values, ms) = drawn(gpu, &scene, &form.quality)?;
        let found = |i: usize| f64::from(values[i]);
        let (horizons, step) = match method {
            Method::Pyramid => ("pyramid", level_step.to_string()),
            _ => ("surface", String::new()),
        };
        let errors = [&right, &same].map(|right| off(found, right));
        *sheet = detail(&found);
        let in_detail = off(|k| sheet[k], &shown);
        println!(
            "| {figure} | {horizons} | {} | {sun_azimuths} | {step} | {ms:.1} | {:.2} | {in_detail:.2} | {:.2} |",
            form.name, errors[0], errors[1]
        );
        Ok(())
    };
    for (make, name) in
        [(thesis as fn(u32, u32) -> Quality, "table of all around"), (across, "across")]
    {
        for azimuths in [4, 8, 32] {
            sheet[0].push(Vec::new());
            let last = sheet[0].last_mut().expect("pushed");
            row(gpu, last, "6.1", &form(name, make(azimuths, 4)))?;
        }
    }
    sheet[0].push(exact_detail);
    for (make, name) in
        [(thesis as fn(u32, u32) -> Quality, "table of all around"), (across, "across")]
    {
        for level_step in 1..=4 {
            sheet[1].push(Vec::new());
            let last = sheet[1].last_mut().expect("pushed");
            row(gpu, last, "6.2", &form(name, make(32, level_step)))?;
        }
    }
    let mut none = Vec::new();
    for azimuths in [4, 8, 32] {
        for (make, name) in
            [(thesis as fn(u32, u32) -> Quality, "table of all around"), (across, "across")]
        {
            row(gpu, &mut none, "", &form(name, on_surface(make(azimuths, 4))))?;
        }
    }
    for order in [2, 3, 5, 6] {
        let quality = Quality { sh_order: order, ..on_surface(across(32, 4)) };
        row(gpu, &mut none, "", &form(format!("across, order {order}"), quality))?;
    }
    println!();
    output.map_or(Ok(()), |path| write(path, &sheet, &true_detail))
}

/// Rows of details, each above its difference to the truth: red where there is too much light, blue too little.
fn write(path: &Path, sheet: &[Vec<Vec<f64>>], truth: &[f64]) -> Result<()> {
    let white = truth.iter().copied().fold(0.0, f64::max);
    let grey = |v: f64, _: f64| [(v / white).clamp(0.0, 1.0) as f32; 3];
    let difference = |v: f64, right: f64| {
        // Half of the brightest is the full colour, as in the thesis.
        let share = ((v - right) / (0.5 * white)).clamp(-1.0, 1.0) as f32;
        if share > 0.0 { [share, 0.0, 0.0] } else { [0.0, -0.4 * share, -share] }
    };
    let cell = DETAIL_SIDE * ZOOM + GAP;
    let columns = sheet.iter().map(Vec::len).max().unwrap_or(0);
    let [width, height] = [columns * cell - GAP, 2 * sheet.len() * cell - GAP];
    let mut texels = vec![[1.0_f32; 3]; width * height];
    let kinds: [&dyn Fn(f64, f64) -> [f32; 3]; 2] = [&grey, &difference];
    for (at, kind) in (0..2 * sheet.len()).zip(kinds.into_iter().cycle()) {
        for (column, values) in sheet[at / 2].iter().enumerate() {
            for k in 0..(cell - GAP) * (cell - GAP) {
                let [y, x] = [k / (cell - GAP), k % (cell - GAP)];
                let i = y / ZOOM * DETAIL_SIDE + x / ZOOM;
                texels[(at * cell + y) * width + column * cell + x] = kind(values[i], truth[i]);
            }
        }
    }
    files::write_png(path, height, width, &texels, None, Tone { exposure: 1.0 }, &[])
}

/// Tables 6.1 to 6.4: milliseconds over those of the thesis' largest setting, and the thesis' own ratios.
fn tables(gpu: &mut Headless, field: &HeightField) -> Result<()> {
    let scene_of = |lights| scene(field, lights);
    let one = scene_of(1);
    let mut times =
        |scene: &Scene, quality: &Quality| Ok::<f64, Error>(drawn(gpu, scene, quality)?.1);
    println!("| table | | ms | ratio | the thesis' |");
    println!("|---|---|---|---|---|");
    let ratios = |table: &str, what: &str, rows: &[(u32, f64)], all: &[f64]| {
        let (last, last_fps) = (all[all.len() - 1], rows[rows.len() - 1].1);
        for ((setting, fps), ms) in rows.iter().zip(all) {
            let (ratio, published) = (ms / last, last_fps / fps);
            println!("| {table} | {what} {setting} | {ms:.1} | {ratio:.2} | {published:.2} |");
        }
    };
    let steps = [(1, 80.0), (2, 62.0), (3, 47.0), (4, 34.0)];
    let all =
        steps.iter().map(|(k, _)| times(&one, &thesis(32, *k))).collect::<Result<Vec<_>>>()?;
    ratios("6.1", "level step", &steps, &all);
    let counts = [(8, 94.0), (12, 85.0), (16, 75.0), (24, 62.0), (32, 34.0)];
    let all =
        counts.iter().map(|(m, _)| times(&one, &thesis(*m, 4))).collect::<Result<Vec<_>>>()?;
    ratios("6.2", "azimuths", &counts, &all);
    println!();
    let environment = files::read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
    println!(
        "| lights, environment | the thesis' form ms | across, pyramid | across, surface | exact | over one light | the thesis' |"
    );
    println!("|---|---|---|---|---|---|---|");
    // Cones v1: frames a second with one, two and three lights (tables 6.3 and 6.4).
    let published = [
        [None, Some(41.0), Some(28.0), Some(23.0)],
        [Some(112.0), Some(33.0), Some(22.0), Some(17.0)],
    ];
    for (is_lit, fps) in [false, true].into_iter().zip(published) {
        let mut of_one = f64::NAN;
        let mut rows = Vec::new();
        for (lights, fps_there) in fps.iter().enumerate().filter_map(|(n, f)| Some((n, (*f)?))) {
            let mut scene = scene_of(lights);
            scene.lights.environment = is_lit.then(|| environment.clone());
            let exact = Quality { light_basis: LightBasis::Exact, ..on_surface(across(8, 4)) };
            let forms = [thesis(32, 4), across(8, 4), on_surface(across(8, 4)), exact];
            let ms = forms.iter().map(|q| times(&scene, q)).collect::<Result<Vec<_>>>()?;
            of_one = if lights == 1 { ms[0] } else { of_one };
            rows.push((lights, ms, fps_there));
        }
        for (lights, ms, fps_there) in rows {
            let lit = if is_lit { ", environment" } else { "" };
            let published = fps[1].unwrap_or(f64::NAN) / fps_there;
            println!(
                "| {lights}{lit} | {:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {published:.2} |",
                ms[0],
                ms[1],
                ms[2],
                ms[3],
                ms[0] / of_one
            );
        }
    }
    Ok(())
}

/// All of them; the sheet of details to a PNG.
pub fn run(gpu: &mut Headless, output: Option<&Path>) -> Result<()> {
    let field = cones()?;
    println!(
        "{SIDE}²: {CONES} cones on a circle, lights of radius 5 m 12 m above the ground, cells of 1 m"
    );
    println!();
    figures(gpu, &field, output)?;
    tables(gpu, &field)
}
