//! The passes that follow an edit up to its horizons. `edits` compares the light after them with that of all passes,
//! bit by bit.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::{Azimuth, Pass, Reach, Rectangle};
use ridgelight_cpu::dirty_list as list_reference;
use ridgelight_cpu::dirty_mark as mark_reference;
use ridgelight_cpu::horizon_resweep as resweep_reference;
use ridgelight_cpu::horizon_sweep as sweep_reference;
use ridgelight_cpu::horizon_sweep::SweepOptions;
use ridgelight_cpu::lattice::{Lattice, line_number, line_position, slots};
use ridgelight_cpu::shared::sweep::{Heights, March, on_field};

use crate::cpu_reference::{Pair, Reference, Run, constant, pushed};
use crate::horizon::cpu_reference::sweep::{Stored, stored};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] =
    &[("dirty_list", dirty_list), ("dirty_mark", dirty_mark), ("horizon_resweep", horizon_resweep)];

/// An edit that is drawn.
pub(crate) struct Edit {
    rectangle: Rectangle,
    /// Heights before it.
    before: Vec<f32>,
    /// What the CPU reference has marked so far.
    dirty: Vec<u32>,
}

/// Draws the field with other heights in a rectangle, then the edit to those of the scene.
pub(crate) fn draw(run: &mut Run) -> Edit {
    let [cols, rows] = run.size().map(|n| n as u32);
    let rectangle =
        Rectangle { col: cols / 3, row: rows / 4, cols: cols / 4 + 1, rows: rows / 3 + 1 };
    let texels = run.heights().heights_m;
    let mut before = texels.to_vec();
    for row in rectangle.row..rectangle.row + rectangle.rows {
        let first = (row * cols + rectangle.col) as usize;
        before[first..first + rectangle.cols as usize].iter_mut().for_each(|h| *h -= 3.0);
    }
    run.gpu.refill(&run.frame, 0, &before).expect("refilled");
    run.gpu.draw(&mut run.frame).expect("drawn");
    run.gpu.refill(&run.frame, 0, texels).expect("refilled");
    run.gpu.draw_edit(&mut run.frame, rectangle).expect("drawn");
    Edit { rectangle, before, dirty: Vec::new() }
}

/// Marks of the rectangle itself are among all marks.
pub(crate) fn dirty_mark(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let got = run.words(pass, "dirty_texels").expect("written");
    let size = run.size();
    let edit = run.edit.as_mut().expect("drawn");
    edit.dirty = mark_reference::dirty_mark(size, edit.rectangle);
    let words = got.iter().zip(&edit.dirty).enumerate();
    let pair = |(i, (got, want)): (usize, (&u32, &u32))| Pair {
        got: (got & want).into(),
        want: (*want).into(),
        tolerance: 0.0,
        at: [0, 0, i],
    };
    words.map(pair).collect()
}

/// Occluders are those of the CPU reference, which marks the texels that it reaches.
pub(crate) fn horizon_resweep(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let occluders = stored(run, pass, "occluders", 2).expect("written");
    let first = pushed(pass, const { offset("HorizonResweepPush", "first_azimuth") }) as usize;
    let options =
        SweepOptions { line_shift: constant(pass, "line_shift"), ..SweepOptions::default() };
    let mut pairs = Vec::new();
    for k in first..first + pass.groups[2] as usize {
        let azimuth = run.plan.azimuths[k];
        let around = match pass.reach {
            Some(Reach::Lines { margin, .. }) => margin,
            _ => 0,
        };
        pairs.extend(lines_of(run, (k, &azimuth), (options, around), &occluders));
    }
    pairs
}

fn lines_of(
    run: &mut Run,
    (k, azimuth): (usize, &Azimuth),
    (options, around): (SweepOptions, u32),
    occluders: &Stored,
) -> Vec<Pair> {
    let size = run.size();
    let (heights, shift, border) = (run.heights(), options.line_shift, run.border());
    let alone = Azimuth { layer: 0, ..*azimuth };
    let march = March::new(heights, &alone);
    let slots = slots(march.lanes as usize, shift, border);
    let mut reference = Lattice::new(1, slots, march.steps as usize);
    let edit = run.edit.as_mut().expect("drawn");
    let before = Heights { heights_m: &edit.before, ..heights };
    sweep_reference::horizon_sweep(before, &alone, &options, &mut reference);
    let (rectangle, dirty) =
        (resweep_reference::grown(edit.rectangle, around, size), &mut edit.dirty);
    resweep_reference::horizon_resweep(heights, &alone, &options, rectangle, &mut reference, dirty);
    let all = (0..march.steps).flat_map(|s| (0..slots as i32).map(move |t| (s, t)));
    let shear = azimuth.shear;
    let on_field =
        |&(step, slot): &(i32, i32)| on_field(line_position(slot, step, shear, shift), march.lanes);
    let pair = |(step, slot): (i32, i32)| {
        let line = line_number((slot, slots as i32), (step, march.steps), shear, shift, border);
        Pair {
            got: occluders.bits(azimuth.layer, line, step).into(),
            want: reference.occluders[reference.texel(slot, march.march_position(step), 0)].into(),
            tolerance: 0.0,
            at: [k, step as usize, slot as usize],
        }
    };
    all.filter(on_field).map(pair).collect()
}

/// All marks, after the CPU reference has made its own; and the list of their words, in any order, with
/// just enough workgroups.
pub(crate) fn dirty_list(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let got = run.words(pass, "dirty_texels").expect("written");
    let want = run.edit.as_ref().expect("drawn").dirty.clone();
    let words = run.words(pass, "edit_list").expect("written");
    let at = |offset: usize| words[offset / 4] as usize;
    let mut listed = words[const { offset("EditList", "dirty_words") } / 4..]
        [..at(const { offset("EditList", "word_count") })]
        .to_vec();
    listed.sort_unstable();
    let listed_by_reference = list_reference::dirty_list(&want);
    let groups = |a: usize| [at(a), at(a + 4), at(a + 8)];
    // Sixteen words a group that lights, two a group that resolves; fewer groups than a row holds.
    for (at, words) in [
        (const { offset("EditList", "light_groups") }, 16),
        (const { offset("EditList", "resolve_groups") }, 2),
    ] {
        assert_eq!(groups(at), [listed_by_reference.len().div_ceil(words), 1, 1]);
    }
    assert_eq!(listed.len(), listed_by_reference.len(), "words that mark anything");
    let pairs = |got: Vec<u32>, want: Vec<u32>, of: usize| {
        let words = got.into_iter().zip(want).enumerate();
        let pair = move |(i, (got, want)): (usize, (u32, u32))| Pair {
            got: got.into(),
            want: want.into(),
            tolerance: 0.0,
            at: [of, 0, i],
        };
        words.map(pair)
    };
    pairs(got, want, 0).chain(pairs(listed, listed_by_reference, 1)).collect()
}
