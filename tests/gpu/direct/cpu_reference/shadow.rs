//! Suns by shadow heights.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use ridgelight::gpu::shaders::offset;
use ridgelight::plan::Pass;
use ridgelight::plan::azimuths::{Azimuth, CELL, Shape};
use ridgelight_cpu::shadow_settle::settled;
use ridgelight_cpu::shadow_shade::sees_all;
use ridgelight_cpu::shadow_sweep::{height_of, lines_of, shadow_line};
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::sun_shade::weights;
use ridgelight_cpu::tolerance::{ShadeError, device_march_slope, shadow_ground, shadow_stored};

use crate::cpu_reference::{Pair, Run, constant, pushed};

/// Words of the lattice, by azimuth, line and step.
struct Words {
    words: Vec<u32>,
    /// Texels of a step, each of four lines, and steps of a layer.
    size: [usize; 2],
}

impl Words {
    fn of(run: &mut Run, pass: &Pass) -> Self {
        let size = run.extent(pass, "shadows");
        Self { words: run.words(pass, "shadows").expect("bound"), size }
    }

    fn at(&self, azimuth: &Azimuth, line: i32, step: i32) -> u32 {
        let (line, step) = (line as usize, step as usize);
        let [width, height] = self.size;
        let layer = azimuth.layer as usize + line / (4 * width);
        self.words[(layer * height + step) * 4 * width + line % (4 * width)]
    }
}

/// Heights of shadows, and the steps whose ground casts them. A shadow is never too low.
pub(crate) fn shadow_sweep(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let words = Words::of(run, pass);
    let [largest, _] = run.relief();
    let mut pairs = Vec::new();
    for k in pass.azimuths.clone() {
        let azimuth = run.plan.azimuths[k as usize];
        let march = March::new(run.heights(), &azimuth);
        let warm_up = run.warm_up(azimuth.marches_rows());
        let total = warm_up + march.steps;
        let plane = f64::from(azimuth.low_slope) * f64::from(azimuth.step_m) * f64::from(total);
        let rounded = shadow_ground(largest, plane);
        let (lines, first) = lines_of(&march, total);
        for line in 0..lines {
            let steps = shadow_line(&march, first + line * CELL, (total, warm_up));
            for (step, at_step) in steps.iter().enumerate() {
                let Some(at_step) = at_step else { continue };
                let word = words.at(&azimuth, line, step as i32);
                let (got, back) = (height_of(word), (word & 0xffff) as usize);
                let at = [k as usize, line as usize, step];
                let Some(top) = at_step.top else {
                    pairs.push(Pair { got: back as f64, want: 0.0, tolerance: 0.0, at });
                    assert!(got < -1e20, "{at:?}: {got} without ground ahead");
                    continue;
                };
                let want = top - at_step.over_plane;
                let tolerance = shadow_stored(want, rounded);
                pairs.push(Pair { got, want, tolerance, at });
                pairs.push(Pair { got: (want - got).max(0.0), want: 0.0, tolerance: 0.0, at });
                let cast = steps[step - back].expect("on the line").raised;
                pairs.push(Pair { got: cast, want: top, tolerance: rounded, at });
            }
        }
    }
    pairs
}

/// Azimuths of the light so far, and what errs at a texel.
fn so_far(run: &mut Run, (first, count, clears): (u32, u32, u32)) -> (Range<usize>, ShadeError) {
    let begin = run.begin_of_light(first as usize, clears == 1);
    let range = begin..(first + count) as usize;
    let [_, relief] = run.relief();
    let steps = run.plan.azimuths[range.clone()].iter().map(|a| f64::from(a.step_m));
    let slope = device_march_slope(relief, steps.fold(f64::MAX, f64::min));
    let [x, y] = run.scene.field.cell_m();
    (range.clone(), ShadeError::new(slope, relief, x.min(y), range.len()))
}

/// Light by exact horizons, at every texel; none where a point sun grazes the ground.
fn exact(
    run: &Run,
    range: Range<usize>,
    shape: Shape,
    error: &ShadeError,
) -> Vec<Option<(f64, DVec3)>> {
    let warm_up = [run.warm_up(false), run.warm_up(true)];
    let azimuths = &run.plan.azimuths[range];
    settled(run.heights(), azimuths, warm_up, (shape, error.lowest_slope()))
}

/// Light vectors, if there are any, of `places`.
fn vector_pairs(
    run: &mut Run,
    pass: &Pass,
    want: &[Option<(f64, DVec3)>],
    (tolerance, number): (f64, usize),
    is_compared: impl Fn(usize) -> bool,
) -> Vec<Pair> {
    let Some(got) = run.vectors(pass) else { return Vec::new() };
    let [cols, _] = run.size();
    // Of the same sum, but for the product with the normal and the division by π.
    let places = got.iter().zip(want).enumerate().filter(|(i, _)| is_compared(*i));
    let pairs = places.filter_map(|(i, (got, want))| {
        let (_, want) = (*want)?;
        let at = [number, i / cols, i % cols];
        let tolerance = PI * tolerance;
        Some([0, 1, 2].map(|c| Pair { got: got[c], want: want[c], tolerance, at }))
    });
    pairs.flatten().collect()
}

fn shape_of(pass: &Pass) -> Shape {
    [Shape::Disc, Shape::Point, Shape::Patch][constant(pass, "shape") as usize]
}

/// Whether each texel is marked, where it is certain; and the light of those that are not, by exact horizons.
pub(crate) fn shadow_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadowShadePush", "azimuth_count");
    const CLEARS: usize = offset("ShadowShadePush", "clears");
    const FIRST_AZIMUTH: usize = offset("ShadowShadePush", "first_azimuth");
    let [first, count, clears] = [FIRST_AZIMUTH, AZIMUTH_COUNT, CLEARS].map(|o| pushed(pass, o));
    let (range, error) = so_far(run, (first, count, clears));
    let shape = shape_of(pass);
    let words = Words::of(run, pass);
    let marks = run.words(pass, "doubtful").expect("written");
    let [fours, _] = run.extent(pass, "doubtful");
    let got = run.floats(pass, "sun_sum").expect("written");
    let want = exact(run, range.clone(), shape, &error);
    let tolerance = error.sun(weights(&run.plan.azimuths[range.clone()], shape));
    let [cols, _] = run.size();
    let mut pairs = Vec::new();
    let mut decided = 0;
    let mut marked = vec![false; got.len()];
    for i in 0..got.len() {
        let (col, row) = (i % cols, i / cols);
        let by_row = run.plan.azimuths[first as usize].marches_rows();
        let (lane, march) = if by_row { (col, row) } else { (row, col) };
        let is_marked = marks[march * fours + lane / 4] >> (lane % 4) & 1 == 1;
        let at = [range.len(), row, col];
        let batch = first as usize..(first + count) as usize;
        let proofs = run.plan.azimuths[batch].iter().map(|azimuth| {
            let march = March::new(run.heights(), azimuth);
            let warm_up = run.warm_up(azimuth.marches_rows());
            let word = |line: i32, step: i32| words.at(azimuth, line, step);
            let [largest, _] = run.relief();
            let errors = (error.lowest_slope(), largest);
            sees_all(&march, warm_up, word, [col as i32, row as i32], errors)
        });
        let proofs: Option<Vec<bool>> = proofs.collect();
        if let Some(proofs) = proofs {
            let wanted = f64::from(u8::from(proofs.contains(&false)));
            let got = f64::from(u8::from(is_marked));
            pairs.push(Pair { got, want: wanted, tolerance: 0.0, at });
            decided += 1;
        }
        marked[i] = is_marked;
        if let Some((want, _)) = want[i].filter(|_| !is_marked) {
            pairs.push(Pair { got: got[i].into(), want, tolerance, at });
        }
    }
    assert!(decided * 10 >= got.len() * 9, "{decided} of {} decided", got.len());
    pairs.extend(vector_pairs(run, pass, &want, (tolerance, range.len()), |i| !marked[i]));
    pairs
}

/// The light of all texels, by exact horizons.
pub(crate) fn shadow_settle(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("ShadowSettlePush", "azimuth_count");
    const CLEARS: usize = offset("ShadowSettlePush", "clears");
    const FIRST_AZIMUTH: usize = offset("ShadowSettlePush", "first_azimuth");
    let [first, count, clears] = [FIRST_AZIMUTH, AZIMUTH_COUNT, CLEARS].map(|o| pushed(pass, o));
    let (range, error) = so_far(run, (first, count, clears));
    let shape = shape_of(pass);
    let got = run.floats(pass, "sun_sum").expect("written");
    let want = exact(run, range.clone(), shape, &error);
    let tolerance = error.sun(weights(&run.plan.azimuths[range.clone()], shape));
    let [cols, _] = run.size();
    let mut pairs: Vec<Pair> = got
        .iter()
        .zip(&want)
        .enumerate()
        .filter_map(|(i, (got, want))| {
            let at = [range.len(), i / cols, i % cols];
            want.map(|(want, _)| Pair { got: (*got).into(), want, tolerance, at })
        })
        .collect();
    assert!(pairs.len() * 50 >= got.len() * 49, "{} of {} decided", pairs.len(), got.len());
    pairs.extend(vector_pairs(run, pass, &want, (tolerance, range.len()), |_| true));
    pairs
}
