//! Visibility of triangles.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::DIRECTIONS_A_WORD;
use ridgelight::plan::Pass;
use ridgelight_cpu::facet_mask::{cells, sky_is_visible};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{Land, facet_elevation};

use crate::cpu_reference::{Pair, Run, pushed};

/// The CPU reference's answer, or the other one where the error of a ray's elevation decides.
pub(crate) fn facet_mask(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (field, border) = (&run.scene.field, run.border());
    let directions = run.directions();
    let first = pushed(pass, const { offset("FacetMaskPush", "first_layer") }) as usize;
    let layers = pass.groups[2] as usize;
    let words = run.words(pass, "facet_mask").expect("written");
    let finer = field.finer(border, 3).expect("a finer field");
    let oracle = Oracle::new(&finer, border);
    let elevation = facet_elevation(&Land::of(&finer, border));
    let [cells_x, cells_y] = cells(field, border);
    let own =
        first * DIRECTIONS_A_WORD..((first + layers) * DIRECTIONS_A_WORD).min(directions.count());
    let mut pairs = Vec::new();
    for i in own {
        for facet in 0..2 * cells_x * cells_y {
            let e = directions.vectors()[i];
            let [want, is_unsure] = sky_is_visible(&oracle, (facet, cells_x), e, elevation);
            // Two bits a cell and direction, first the triangle north-east of the diagonal; the rest of a word's directions next.
            let word = words[i / DIRECTIONS_A_WORD * cells_x * cells_y + facet / 2];
            let got = word >> (2 * (i % DIRECTIONS_A_WORD) + facet % 2) & 1 == 1;
            let want = if is_unsure { got } else { want };
            let [got, want] = [got, want].map(|is_visible| f64::from(u8::from(is_visible)));
            pairs.push(Pair { got, want, tolerance: 0.0, at: [i, facet / 2, facet % 2] });
        }
    }
    pairs
}
