//! The passes that throw light from ground to ground.

use ridgelight::cpu::bounce_gather::BounceGather;
use ridgelight::cpu::bounce_march::bounce_march as march_twin;
use ridgelight::cpu::bounce_walk::bounce_walk as walk_twin;
use ridgelight::cpu::oracle::Oracle;
use ridgelight::cpu::pyramid_march::Stored;
use ridgelight::cpu::{shade_expand as expand_twin, shade_reduce as reduce_twin};
use ridgelight::gpu::shaders::offsets;
use ridgelight::measure::tolerance::{twin_gathered, twin_level, twin_spline, twin_thrown};
use ridgelight::plan::Pass;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::Fuse;

use super::light::rgb;
use super::{Pair, Run, constant, pushed};

impl Run<'_> {
    /// The pyramid of exit radiance.
    pub(super) fn shade(&self) -> Pyramid {
        let bounces = self.quality.bounces;
        let heights = Pyramid::new(&self.quality, self.plan.size, self.border());
        Pyramid { level_step: bounces.level_step, level_offset: bounces.level_offset, ..heights }
    }

    /// What every sample throws.
    pub(super) fn exit(&mut self, pass: &Pass) -> Vec<[f64; 3]> {
        let texels = self.floats(pass, "exit_radiance").expect("bound");
        let samples = self.scene.field.heights_m().len();
        match texels.len() / samples {
            1 => texels.iter().map(|v| [(*v).into(); 3]).collect(),
            _ => colours(&texels),
        }
    }
}

pub(super) fn colours(texels: &[f32]) -> Vec<[f64; 3]> {
    texels.chunks_exact(4).map(|t| [0, 1, 2].map(|c| t[c].into())).collect()
}

pub(super) fn brightest(exit: &[[f64; 3]]) -> f64 {
    exit.as_flattened().iter().fold(0.0, |m, v| v.max(m))
}

/// Colours beside a twin's, from a first one on.
fn paired(
    got: &[[f64; 3]],
    want: &[[f64; 3]],
    tolerance: f64,
    (number, cols): (usize, usize),
) -> Vec<Pair> {
    let all = got.iter().zip(want).enumerate();
    all.flat_map(|(i, (got, want))| {
        let at = [number, i / cols, i % cols];
        [0, 1, 2].map(|c| Pair { got: got[c], want: want[c], tolerance, at })
    })
    .collect()
}

/// Every stretch along every azimuth, in one dispatch.
pub(super) fn bounce_march(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    use offsets::bounce_march_push::{AZIMUTHS, FIRST_AZIMUTH, LAST_AZIMUTH};
    let azimuths = pushed(pass, AZIMUTHS);
    assert_eq!([pushed(pass, FIRST_AZIMUTH), pushed(pass, LAST_AZIMUTH)], [0, azimuths]);
    let exit = run.exit(pass);
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let oracle = Oracle::new(&run.scene.field, run.border());
    let [cols, _] = run.size();
    let of = |i: usize| march_twin(&oracle, &exit, azimuths, i / cols, i % cols);
    let want: Vec<[f64; 3]> = (0..got.len()).map(of).collect();
    let ([_, relief], [x, y]) = (run.relief(), run.scene.field.cell_m());
    // No more than there are cells' edges on the way.
    let stretches = 3 * (run.size()[0] + run.size()[1]);
    let tolerance = twin_thrown(relief, 0.5 * x.min(y), stretches, brightest(&exit));
    paired(&got, &want, tolerance, (0, cols))
}

/// A level, and what the table says of it.
pub(super) fn shade_reduce(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let shade = run.shade();
    let number = pushed(pass, offsets::shade_reduce_push::LEVEL);
    let level = shade.level(number);
    let exit = run.exit(pass);
    let texels = colours(&run.floats(pass, "shade_levels").expect("written"));
    let table = run.words(pass, "shade_table").expect("written");
    let want = reduce_twin::shade_reduce(&exit, &shade, number, &texels);
    let tolerance = twin_level(brightest(&exit));
    let at = (number as usize, level.size[0] as usize);
    let mut pairs = paired(&texels[level.first as usize..], &want, tolerance, at);
    let [x, y] = level.per_sample.map(f32::to_bits);
    let want = [level.first as u32, level.size[0] | level.size[1] << 16, x, y];
    let row = &table[4 * (number as usize - 1)..];
    pairs.extend(want.iter().zip(row).enumerate().map(|(i, (want, got))| Pair {
        got: (*got).into(),
        want: (*want).into(),
        tolerance: 0.0,
        at: [number as usize, 0, i],
    }));
    pairs
}

pub(super) fn shade_expand(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let shade = run.shade();
    let texels = colours(&run.floats(pass, "shade_levels").expect("written"));
    let stack = run.floats(pass, "shade_stack").expect("written");
    let [cols, rows] = run.size();
    let samples = cols * rows;
    let layers = shade.levels() as usize;
    let stack = match stack.len() / (samples * layers) {
        1 => stack.iter().map(|v| [(*v).into(); 3]).collect(),
        _ => colours(&stack),
    };
    let tolerance = twin_spline(brightest(&texels));
    let of = |number: u32| {
        let want = expand_twin::shade_expand(&shade, &texels, number);
        let layer = &stack[(number as usize - 1) * samples..];
        paired(layer, &want, tolerance, (number as usize, cols))
    };
    (1..=shade.levels()).flat_map(of).collect()
}

/// What is thrown, from the levels that the device made, in one dispatch.
pub(super) fn bounce_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    use offsets::bounce_gather_push::{AZIMUTHS, FIRST_AZIMUTH, LAST_AZIMUTH};
    let azimuths = pushed(pass, AZIMUTHS);
    assert_eq!([pushed(pass, FIRST_AZIMUTH), pushed(pass, LAST_AZIMUTH)], [0, azimuths]);
    let (shade, receiver) = (run.shade(), run.quality.receiver);
    let pyramid = Pyramid::new(&run.quality, run.plan.size, run.border());
    let exit = run.exit(pass);
    let texels = match run.floats(pass, "shade_levels") {
        Some(texels) => colours(&texels),
        // The device reads what `shade_expand` made of them.
        None => reduce_twin::shade_levels(&exit, &shade),
    };
    let stack = run.floats(pass, "height_stack");
    let levels = run.floats(pass, "height_levels").unwrap_or_default();
    let stored = stack.as_ref().map_or(Stored::Levels(&levels), |s| Stored::Stack(s));
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let field = &run.scene.field;
    let twin = BounceGather {
        field,
        heights: run.heights(),
        pyramid: &pyramid,
        stored,
        shade: &shade,
        shade_texels: &texels,
        exit: &exit,
        receiver,
        azimuths,
    };
    let [cols, _] = run.size();
    let want: Vec<[f64; 3]> = (0..got.len()).map(|i| twin.light(i / cols, i % cols)).collect();
    let ([largest, relief], [x, y]) = (run.relief(), field.cell_m());
    let tolerance = twin_gathered(largest, relief, x.min(y), pyramid.samples(), brightest(&exit));
    paired(&got, &want, tolerance, (0, cols))
}

/// The sum so far; what is thrown, once the last azimuths are there.
pub(super) fn bounce_walk(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    use offsets::bounce_walk_push::{AZIMUTH_COUNT, CLEARS, FIRST_AZIMUTH, IS_LAST};
    let word = |offset| pushed(pass, offset) as usize;
    let first = word(FIRST_AZIMUTH);
    if word(CLEARS) == 1 {
        run.light_begins = first;
    }
    let range = run.light_begins..first + word(AZIMUTH_COUNT);
    let exit: Vec<[f32; 3]> = match run.floats(pass, "exit_grey") {
        Some(grey) => grey.iter().map(|v| [*v; 3]).collect(),
        None => {
            let texels = run.floats(pass, "exit_radiance").expect("one of both");
            texels.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
        }
    };
    let got = run.floats(pass, "bounce_sum").expect("written");
    let brightest = exit.as_flattened().iter().fold(0.0_f64, |m, v| m.max((*v).into()));
    let is_last = word(IS_LAST) == 1;
    let ([_, relief], [x, y]) = (run.relief(), run.scene.field.cell_m());
    let [cols, _] = run.size();
    let settings = (Some(Fuse::AimedNearest), constant(pass, 0));
    let walked = run.swept(range.clone(), settings, |swept| {
        swept.per_sample(|col, row| walk_twin(swept, &exit, col, row))
    });
    let mut pairs = Vec::new();
    for (i, (got, want)) in got.chunks_exact(4).zip(&walked).enumerate() {
        let at = [range.len(), i / cols, i % cols];
        let seen = (want.stretches as usize).div_ceil(range.len()) + 1;
        // Of a part of the circle, weights: a whole hemisphere's is π.
        let whole = if is_last { 1.0 } else { std::f64::consts::PI };
        let tolerance = whole * twin_thrown(relief, 0.5 * x.min(y), seen, brightest);
        let want = if is_last { want.radiance().into() } else { want.light };
        pairs.extend((0..3).map(|c| Pair { got: rgb(got)[c], want: want[c], tolerance, at }));
    }
    pairs
}
