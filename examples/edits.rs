//! Measures what an edit of a square brush costs against a whole recompute, and that both leave the
//! same bits: a uniform sky in 32 azimuths over a fractal field.
//!
//! `cargo run --release --example edits -- [SIDE [BRUSH [EDITS [SEED]]]]`: grid points a side of the field
//! (4096), of the brush (64), how many edits at random places (10), and the generator's seed (1).

use ridgelight::gpu::shaders::offset;
use ridgelight::gpu::{Frame, Headless, HeadlessOptions, Timing};
use ridgelight::plan::{self, Limits, Picture, Rectangle};
use ridgelight::scene::fractal;
use ridgelight::scene::{Lights, Quality, Scene, Surface};
use ridgelight::{Error, Result};

const AZIMUTHS: u32 = 32;
/// Lattices of 32 azimuths of 4096² texels take 1.6 GiB.
const MEMORY_BUDGET: u64 = 4 << 30;

fn ms(times: &[Timing], name: &str) -> f64 {
    let named = times.iter().filter(|t| t.label.starts_with(name));
    named.map(|t| t.ns).sum::<f64>() / 1e6
}

/// Words of a buffer of the plan's.
fn words(gpu: &mut Headless, frame: &Frame, name: &str) -> Result<Vec<u32>> {
    let id = frame.plan().find(name).expect("a plan with edits has it");
    gpu.read(frame, id)
}

fn pixels(gpu: &mut Headless, frame: &Frame) -> Result<Vec<u32>> {
    Ok(gpu.pixels(frame, 0)?.values.into_iter().map(f32::to_bits).collect())
}

/// A round hill of half the brush's height, or a pit.
fn brush(heights: &mut [f32], side: usize, at: Rectangle, sign: f32) {
    let middle = (at.cols as f32 - 1.0) / 2.0;
    for r in 0..at.rows {
        for c in 0..at.cols {
            let (x, y) = (c as f32 - middle, r as f32 - middle);
            let rise = (1.0 - (x * x + y * y) / (middle * middle + 1.0)).max(0.0);
            let i = (at.row + r) as usize * side + (at.col + c) as usize;
            heights[i] += sign * 0.5 * at.cols as f32 * rise * rise;
        }
    }
}

struct Request {
    side: usize,
    brush: usize,
    edits: usize,
    seed: u64,
}

fn asked() -> Result<Request> {
    let mut values = [4096, 64, 10, 1];
    for (value, text) in values.iter_mut().zip(std::env::args().skip(1)) {
        *value = text.parse().map_err(|_| Error::setting("edits", &text, "a whole number"))?;
    }
    let [side, brush, edits, seed] = values;
    if brush == 0 || brush > side || edits == 0 {
        let found = format!("a brush of {brush}, {edits} edits");
        return Err(Error::setting("edits", found, format!("1 to {side}, 1 or more")));
    }
    Ok(Request { side, brush, edits, seed: seed as u64 })
}

fn main() -> Result<()> {
    let asked = asked()?;
    let Request { side, brush: width, seed, .. } = asked;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field: fractal(side, seed)?, surface: Surface::default(), lights };
    let quality = Quality { azimuths: AZIMUTHS, ..Quality::default() };
    let limits = Limits { memory_budget: MEMORY_BUDGET, ..gpu.report().limits };
    // An edit recomputes what it changes: the plan keeps its horizons.
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(&scene, &quality, &limits, wanted)?;
    println!("{}: {side}², {width}² brush, {AZIMUTHS} azimuths", gpu.report().name);
    println!("memory: {:.1} MiB", plan.bytes() as f64 / 1_048_576.0);
    gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        edit_all(gpu, frame, &scene, &asked)
    })
}

/// Draws a frame, then edits it again and again, and holds each edit against drawing it all.
fn edit_all(gpu: &mut Headless, frame: &mut Frame, scene: &Scene, asked: &Request) -> Result<()> {
    let Request { side, brush: width, edits, seed } = *asked;
    let all = f64::from(AZIMUTHS) * (side * side) as f64;
    gpu.draw(frame)?;
    // Drivers compile when a pass first runs: an edit of nothing new.
    gpu.draw_edit(frame, Rectangle { col: 0, row: 0, cols: 1, rows: 1 })?;
    let mut heights = scene.field.heights_m().to_vec();
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut place = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 11) as usize % (side - width + 1)) as u32
    };
    println!("edit (row, column): points swept, of all; texels lit; ms: sweep, light; whole");
    let mut costs = Vec::new();
    for i in 0..edits {
        let n = width as u32;
        let at = Rectangle { col: place(), row: place(), cols: n, rows: n };
        brush(&mut heights, side, at, if i % 2 == 0 { 1.0 } else { -1.0 });
        gpu.refill(frame, 0, &heights)?;
        let times = gpu.draw_edit(frame, at)?;
        let swept = 4.0
            * f64::from(
                words(gpu, frame, "edit_list")?[const { offset("EditList", "swept_steps") } / 4],
            );
        let marks = words(gpu, frame, "dirty_texels")?;
        let marked: f64 = marks.iter().map(|w| f64::from(w.count_ones())).sum();
        let lit = marked / (side * side) as f64;
        let edited = pixels(gpu, frame)?;
        let whole = gpu.draw(frame)?;
        let ratio = ms(&whole, "") / ms(&times, "");
        if pixels(gpu, frame)? != edited {
            return Err(Error::setting("an edit", format!("{at:?}"), "the bits of all"));
        }
        println!(
            "({}, {}): {swept:.0}, 1/{:.0}; {:.2} %; {:.2}, {:.2}, all {:.2}; {:.1}: {:.1} ×",
            at.row,
            at.col,
            all / swept,
            100.0 * lit,
            ms(&times, "horizon_resweep"),
            ms(&times, "sky_shade"),
            ms(&times, ""),
            ms(&whole, ""),
            ratio,
        );
        costs.push([swept / all, lit, ratio]);
    }
    println!("\n{}", summary(asked, &costs));
    Ok(())
}

/// What docs/embedding.md says: shares of all points that were swept and of texels that were lit, and the ratio of times, of each edit.
fn summary(asked: &Request, costs: &[[f64; 3]]) -> String {
    let Request { side, brush, edits, .. } = asked;
    let [swept, lit, ratio] = [0, 1, 2].map(|i| {
        let mut all: Vec<f64> = costs.iter().map(|c| c[i]).collect();
        all.sort_by(f64::total_cmp);
        all
    });
    let (least, most) = (|all: &[f64]| all[0], |all: &[f64]| all[all.len() - 1]);
    let mean = swept.iter().sum::<f64>() / swept.len() as f64;
    format!(
        "A {brush}² brush at {edits} random places of a {side}² fractal, {AZIMUTHS} azimuths. An edit sweeps 1/{:.0} to 1/{:.0} of \
         the points on all lines (mean 1/{:.0}) and shades {:.2} to {:.2} % of the texels again. It is {:.0} to {:.0} times \
         faster than a whole frame, and the bits are the same.",
        1.0 / most(&swept),
        1.0 / least(&swept),
        1.0 / mean,
        100.0 * least(&lit),
        100.0 * most(&lit),
        least(&ratio),
        most(&ratio),
    )
}
