//! Bounces that are found at nodes.

use std::f64::consts::TAU;
use std::ops::Range;

use ridgelight::cpu::bounce_shade::bounce_shade as shade_twin;
use ridgelight::cpu::bounce_walk::walked_along;
use ridgelight::cpu::cast_gather::{Cast, cast_gather as gather_twin};
use ridgelight::cpu::shared::thrown::thrown;
use ridgelight::gpu::shaders::offsets;
use ridgelight::measure::tolerance::{EPSILON, Slices, ThrownError, twin_bounce_shade, walk_error};
use ridgelight::plan::{Nodes, Pass};
use ridgelight::scene::{Border, Fuse};

use super::bounce::{brightest, colours};
use super::{Pair, Run, constant, pushed};

/// Row and column of every node's sample.
pub(super) fn places(run: &Run, nodes: Nodes) -> Vec<[usize; 2]> {
    let [cols, rows] = run.plan.size;
    let [across, along] = nodes.size(run.plan.size);
    let place = |i: u32| [nodes.place(i / across, rows), nodes.place(i % across, cols)];
    (0..across * along).map(|i| place(i).map(|n| n as usize)).collect()
}

/// The casting sets that a walk has left of some azimuths, if it leaves any: they throw ground of radiance 1 as the walk
/// does, and that of radiances that are columns and rows, which lie as their mean does, within a sample: it stands half a
/// step away, and across it as much again.
pub(super) fn casts(
    run: &mut Run,
    pass: &Pass,
    azimuths: Range<usize>,
    places: &[[usize; 2]],
) -> Vec<Pair> {
    let begin = pushed(pass, offsets::bounce_walk_push::BEGIN) as usize;
    let Some(sets) = casting_sets(run, pass, constant(pass, 5) as usize) else {
        return Vec::new();
    };
    let [cols, rows] = run.size();
    let ramp = |i: usize| [1.0, (i % cols) as f32, (i / cols) as f32];
    let exit: Vec<[f32; 3]> = (0..cols * rows).map(ramp).collect();
    let exit64: Vec<[f64; 3]> = exit.iter().map(|c| c.map(f64::from)).collect();
    let settings = (Some(Fuse::AimedNearest), constant(pass, 0));
    let far = cols.max(rows) as f64;
    let wedge = TAU / f64::from(run.quality.bounces.azimuths);
    let slices: Vec<Slices> = places.iter().map(|place| run.slices(*place, wedge, 1.0)).collect();
    let is_ramp = run.border() != Border::Periodic;
    let mut pairs = Vec::new();
    for azimuth in azimuths {
        run.swept(azimuth..azimuth + 1, settings, |swept| {
            for (([row, col], set), slices) in
                places.iter().zip(&sets[azimuth - begin]).zip(&slices)
            {
                let at = [azimuth, *row, *col];
                let along = walked_along(swept, &exit, *col as i32, *row as i32).0;
                let want = thrown(&along).0;
                let off = ThrownError::of(&along, |_, cast| walk_error(wedge, cast), slices).sum;
                let got = gather_twin(set, &exit64);
                pairs.push(Pair { got: got[0], want: want[0], tolerance: off[0], at });
                let tolerance = want[0] + far * off[0];
                let pair = |c: usize| Pair { got: got[c], want: want[c], tolerance, at };
                pairs.extend([1, 2].into_iter().filter(|_| is_ramp).map(pair));
            }
        });
    }
    pairs
}

/// Casting sets of all nodes, azimuth by azimuth, if the pass binds any.
fn casting_sets(run: &mut Run, pass: &Pass, slots: usize) -> Option<Vec<Vec<Vec<Cast>>>> {
    let words = run.words(pass, "casting_sets")?;
    let count = run.extent(pass, "casting_sets").iter().product::<usize>();
    let [cols, _] = run.size();
    let cast = |layer: usize, node: usize| {
        let [place, weight] = [0, 1].map(|k| words[2 * (layer * count + node) + k]);
        let sample = (place >> 16) as usize * cols + (place & 0xffff) as usize;
        (place != u32::MAX).then(|| Cast { sample, weight: f32::from_bits(weight).into() })
    };
    let set = |azimuth: usize, node: usize| {
        (0..slots).map_while(|slot| cast(azimuth * slots + slot, node)).collect()
    };
    let azimuths = words.len() / 2 / count / slots;
    Some((0..azimuths).map(|k| (0..count).map(|node| set(k, node)).collect()).collect())
}

/// From the device's own casting sets: a product and a sum for each.
pub(super) fn cast_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let slots = constant(pass, 1) as usize;
    let sets = casting_sets(run, pass, slots).expect("bound");
    assert_eq!(sets.len(), constant(pass, 0) as usize);
    let exit = match run.floats(pass, "exit_grey") {
        Some(grey) => grey.iter().map(|v| [f64::from(*v); 3]).collect(),
        None => run.exit(pass),
    };
    let texels = run.floats(pass, "bounce_sum").expect("written");
    let places = places(run, Nodes { stride: run.quality.subsample });
    let mut pairs = Vec::new();
    for (node, ([row, col], got)) in places.iter().zip(texels.chunks_exact(4)).enumerate() {
        let seen: Vec<&Cast> = sets.iter().flat_map(|set| &set[node]).collect();
        let whole = f64::from(got[3]);
        let want = gather_twin(seen.iter().copied(), &exit).map(|v| v / whole);
        let weights: f64 = seen.iter().map(|c| c.weight).sum();
        let terms = (seen.len() + 8) as f64;
        let tolerance = terms * EPSILON * brightest(&exit) * weights / whole;
        let at = [0, *row, *col];
        pairs.extend((0..3).map(|c| Pair { got: got[c].into(), want: want[c], tolerance, at }));
    }
    pairs
}

/// From the device's own light at nodes and shares.
pub(super) fn bounce_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let nodes = Nodes { stride: constant(pass, 0) };
    let light = colours(&run.floats(pass, "node_sum").expect("bound"));
    let share: Vec<f64> =
        run.floats(pass, "sky_share").expect("bound").into_iter().map(f64::from).collect();
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let (heights, [cols, _]) = (run.heights(), run.size());
    let relative = twin_bounce_shade(&run.sample_error());
    let mut pairs = Vec::new();
    for (i, got) in got.iter().enumerate() {
        let place = [i % cols, i / cols].map(|n| n as i32);
        let want = shade_twin(&heights, nodes, (&light, &share), place);
        pairs.extend((0..3).map(|c| Pair {
            got: got[c],
            want: want[c],
            tolerance: relative * want[c],
            at: [0, i / cols, i % cols],
        }));
    }
    pairs
}
