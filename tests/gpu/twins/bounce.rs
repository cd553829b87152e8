//! The passes that throw light from ground to ground.

use ridgelight::cpu::bounce_walk::bounce_walk as walk_twin;
use ridgelight::gpu::shaders::offsets;
use ridgelight::measure::tolerance::twin_thrown;
use ridgelight::plan::Pass;
use ridgelight::scene::Fuse;

use super::light::rgb;
use super::{Pair, Run, constant, pushed};

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
