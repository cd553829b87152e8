//! Where ellipses hold and where they fail.

use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::scene::Tone;
use ridgelight_cpu::ellipse_fit::Ellipse;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_io as files;

use crate::Land;

const PANEL: usize = 150;
const GAP: usize = 6;
const AZIMUTHS: usize = 720;

const LIT: [f32; 3] = [0.9, 0.8, 0.45];
const SHADOWED: [f32; 3] = [0.03, 0.04, 0.08];
const LOST: [f32; 3] = [0.75, 0.05, 0.03];
const ADDED: [f32; 3] = [0.05, 0.2, 0.9];
const GROUND: [f32; 3] = [1.0; 3];

/// Slope of the horizon by azimuth.
fn horizons(land: &Land, sample: usize) -> Vec<f64> {
    let oracle = Oracle::new(&land.field, land.border);
    let (row, col) = (sample / land.field.cols(), sample % land.field.cols());
    let of = |k: usize| oracle.horizon(row, col, TAU * k as f64 / AZIMUTHS as f64);
    (0..AZIMUTHS).map(|k| of(k).map_or(0.0, |h| h.slope.max(0.0))).collect()
}

fn is_lit(horizons: &[f64], e: DVec3) -> bool {
    let turn = (e.y.atan2(e.x) / TAU).rem_euclid(1.0) * AZIMUTHS as f64;
    e.z > horizons[turn as usize % AZIMUTHS] * e.x.hypot(e.y)
}

/// The hemisphere's plan, north up: sky right and wrong.
fn panel(horizons: &[f64], ellipse: &Ellipse) -> (Vec<[f32; 3]>, f64) {
    let (mut pixels, mut wrong) = (Vec::new(), 0.0);
    for i in 0..PANEL * PANEL {
        let to = |n: usize| (2 * n + 1) as f64 / PANEL as f64 - 1.0;
        let (x, y) = (to(i % PANEL), -to(i / PANEL));
        let level = 1.0 - x * x - y * y;
        if level <= 0.0 {
            pixels.push(GROUND);
            continue;
        }
        let e = DVec3::new(x, y, level.sqrt());
        let colour = match (is_lit(horizons, e), ellipse.holds(e)) {
            (true, true) => LIT,
            (false, false) => SHADOWED,
            (true, false) => LOST,
            (false, true) => ADDED,
        };
        if colour == LOST || colour == ADDED {
            // Of the sphere a pixel covers 1/z of the plan.
            wrong += (2.0 / PANEL as f64).powi(2) / (TAU * e.z);
        }
        pixels.push(colour);
    }
    (pixels, wrong)
}

/// The middle of the pit, the middle of a groove's wall, and the worst of every fourth sample of the other fields.
pub fn write(path: &Path, drawn: &[(Land, Vec<Ellipse>)]) -> Result<()> {
    let mut panels = Vec::new();
    for (land, ellipses) in drawn {
        let cols = land.field.cols();
        let of = |sample: usize| panel(&horizons(land, sample), &ellipses[sample]);
        let (sample, (pixels, wrong)) = match land.name {
            "pit" => (16 * cols + 16, of(16 * cols + 16)),
            "grooves" => (16 * cols + 12, of(16 * cols + 12)),
            _ => {
                let all = (0..ellipses.len()).filter(|at| at / cols % 4 == 0 && at % 4 == 0);
                let all = all.map(|at| (at, of(at)));
                all.max_by(|a, b| a.1.1.total_cmp(&b.1.1)).expect("samples")
            }
        };
        println!("{}: sample {sample}, {:.1} % of the sky wrong", land.name, 100.0 * wrong);
        panels.push(pixels);
    }
    let width = panels.len() * (PANEL + GAP) - GAP;
    let mut picture = vec![GROUND; width * PANEL];
    for (k, pixels) in panels.iter().enumerate() {
        for (row, own) in pixels.chunks_exact(PANEL).enumerate() {
            let first = row * width + k * (PANEL + GAP);
            picture[first..first + PANEL].copy_from_slice(own);
        }
    }
    files::write_png(path, PANEL, width, &picture, None, Tone::default(), &[])
}
