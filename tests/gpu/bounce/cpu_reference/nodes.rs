//! Bounces at nodes.

use ridgelight::gpu::shaders::offset;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::ops::Range;

use ridgelight::plan::{Nodes, Pass};
use ridgelight::scene::{Border, Fuse};
use ridgelight_cpu::bounce_shade::bounce_shade as shade_reference;
use ridgelight_cpu::bounce_walk::walked_along;
use ridgelight_cpu::cache_gather::{
    Cast, RING_ENDS, cache_gather as gather_reference, cast_of, cast_part,
};
use ridgelight_cpu::shared::bounced::light_and_weight;
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::tolerance::{BounceError, EPSILON, Slices, device_bounce_shade, walk_error};

use super::indirect::{brightest, colours};
use crate::cpu_reference::{Pair, Run, constant, pushed};

/// Row and column of every node's texel.
pub(crate) fn places(run: &Run, nodes: Nodes) -> Vec<[usize; 2]> {
    let [cols, rows] = run.plan.size;
    let [across, along] = nodes.size(run.plan.size);
    let place = |i: u32| [nodes.place(i / across, rows), nodes.place(i % across, cols)];
    (0..across * along).map(|i| place(i).map(|n| n as usize)).collect()
}

/// The nodes of which a walk keeps visibility caches.
pub(crate) fn kept_nodes(pass: &Pass) -> Nodes {
    Nodes { stride: constant(pass, "kept_each") * constant(pass, "node_stride") }
}

/// The visibility caches that a walk keeps of some azimuths, if any: from ground of radiance 1 they bounce as much as
/// the walk, but for half a part of each ring's weight, and likewise for radiances equal to columns and rows, which
/// lie where their mean does, within a texel: it stands half a step away, and across it as much again.
pub(crate) fn casts(run: &mut Run, pass: &Pass, azimuths: Range<usize>) -> Vec<Pair> {
    let places = &places(run, kept_nodes(pass));
    let begin = pushed(pass, const { offset("BounceWalkPush", "begin") }) as usize;
    let Some(sets) = visibility_caches(run, pass, begin, places) else {
        return Vec::new();
    };
    let [cols, rows] = run.size();
    let ramp = |i: usize| [1.0, (i % cols) as f32, (i / cols) as f32];
    let exit: Vec<[f32; 3]> = (0..cols * rows).map(ramp).collect();
    let exit64: Vec<[f64; 3]> = exit.iter().map(|c| c.map(f64::from)).collect();
    let settings = (Some(Fuse::AimedNearest), constant(pass, "line_shift"));
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
                let want = light_and_weight(&along).0;
                let walked = BounceError::of(&along, |_, cast| walk_error(wedge, cast), slices).sum;
                let off = walked[0] + 2.0 * cast_part(wedge);
                let got = gather_reference(set, &exit64);
                pairs.push(Pair { got: got[0], want: want[0], tolerance: off, at });
                let pair = |c: usize| {
                    // The mean of a block may lie anywhere on it, the ring's in its middle.
                    let in_blocks: f64 = (along.iter().flat_map(|along| &along.casts))
                        .filter(|cast| cast.is_block)
                        .map(|cast| cast.weight * cast.spread[c])
                        .sum();
                    let tolerance = want[0] + far * off + in_blocks;
                    Pair { got: got[c], want: want[c], tolerance, at }
                };
                pairs.extend([1, 2].into_iter().filter(|_| is_ramp).map(pair));
            }
        });
    }
    pairs
}

/// Visibility caches of all nodes, azimuth by azimuth from the first one kept, if the pass binds any. Every ring's mean lies
/// within the ring, rounded to a step.
fn visibility_caches(
    run: &mut Run,
    pass: &Pass,
    begin: usize,
    places: &[[usize; 2]],
) -> Option<Vec<Vec<[Cast; 4]>>> {
    let words = run.words(pass, "visibility_cache")?;
    let heights = run.heights();
    let set = |march: &March, words: &[u32], [row, col]: [usize; 2]| {
        [0, 1, 2, 3].map(|ring| {
            let cast = cast_of(march, words[ring], [col as i32, row as i32]);
            let least = ring.checked_sub(1).map_or(0, |r| RING_ENDS[r]);
            let most = RING_ENDS.get(ring).copied().unwrap_or(i32::MAX);
            let lies = (least..=most).contains(&cast.steps);
            assert!(cast.weight == 0.0 || lies, "ring {ring}: {cast:?}");
            cast
        })
    };
    let of = |(k, layer): (usize, &[u32])| {
        let march = March::new(heights, &run.plan.azimuths[begin + k]);
        let sets = layer.chunks_exact(4).zip(places);
        sets.map(|(words, place)| set(&march, words, *place)).collect()
    };
    Some(words.chunks_exact(4 * places.len()).enumerate().map(of).collect())
}

/// From the device's own visibility caches: a product and a sum for each, with weights that are products themselves.
pub(crate) fn cache_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const BEGIN: usize = offset("CacheGatherPush", "begin");
    const COUNT: usize = offset("CacheGatherPush", "count");
    let places = places(run, Nodes { stride: constant(pass, "node_stride") });
    let begin = pushed(pass, BEGIN) as usize;
    let sets = visibility_caches(run, pass, begin, &places).expect("bound");
    assert_eq!(sets.len(), pushed(pass, COUNT) as usize);
    let exit = match run.floats(pass, "exit_grey") {
        Some(grey) => grey.iter().map(|v| [f64::from(*v); 3]).collect(),
        None => run.exit(pass),
    };
    let texels = run.floats(pass, "bounce_sum").expect("written");
    let before = Nodes { stride: constant(pass, "sum_stride") };
    let sums = run.floats(pass, "node_sum").expect("bound");
    let wholes: HashMap<[usize; 2], f64> = self::places(run, before)
        .into_iter()
        .zip(sums.chunks_exact(4).map(|texel| f64::from(texel[3])))
        .collect();
    let mut pairs = Vec::new();
    for (node, ([row, col], got)) in places.iter().zip(texels.chunks_exact(4)).enumerate() {
        let visible: Vec<&Cast> = sets.iter().flat_map(|set| &set[node]).collect();
        let whole = wholes[&[*row, *col]];
        let want = gather_reference(visible.iter().copied(), &exit).map(|v| v / whole);
        let weights: f64 = visible.iter().map(|c| c.weight).sum();
        let terms = (visible.len() + 10) as f64;
        let tolerance = terms * EPSILON * brightest(&exit) * weights / whole;
        let at = [0, *row, *col];
        pairs.extend((0..3).map(|c| Pair { got: got[c].into(), want: want[c], tolerance, at }));
        // The next bounce divides by it.
        pairs.push(Pair { got: got[3].into(), want: whole, tolerance: 0.0, at });
    }
    pairs
}

/// From the device's own light at nodes and shares.
pub(crate) fn bounce_shade(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let nodes = Nodes { stride: constant(pass, "node_stride") };
    let light = colours(&run.floats(pass, "node_sum").expect("bound"));
    let share: Vec<f64> =
        run.floats(pass, "sky_share").expect("bound").into_iter().map(f64::from).collect();
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let (heights, [cols, _]) = (run.heights(), run.size());
    let relative = device_bounce_shade(&run.texel_error());
    let mut pairs = Vec::new();
    for (i, got) in got.iter().enumerate() {
        let place = [i % cols, i / cols].map(|n| n as i32);
        let want = shade_reference(&heights, nodes, (&light, &share), place);
        pairs.extend((0..3).map(|c| Pair {
            got: got[c],
            want: want[c],
            tolerance: relative * want[c],
            at: [0, i / cols, i % cols],
        }));
    }
    pairs
}
