//! The passes of indirect diffuse light.

use ridgelight::gpu::shaders::offset;
use std::collections::HashSet;

use ridgelight::plan::azimuths::CELL;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::{Nodes, Pass};
use ridgelight::scene::{Fuse, Levels};
use ridgelight_cpu::bounce_gather::BounceGather;
use ridgelight_cpu::bounce_ground::bounce_ground as ground_reference;
use ridgelight_cpu::bounce_march::{visible_intervals_along, visible_series_along};
use ridgelight_cpu::bounce_walk::walked_along;
use ridgelight_cpu::line_blocks::{Ground, MOST_LEVEL};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shared::bounced::{Along, Cast, light_and_weight, radiance};
use ridgelight_cpu::shared::sweep::March;
use ridgelight_cpu::specular_gather::arriving;
use ridgelight_cpu::tolerance::{
    BounceError, CastError, EPSILON, Gathered, Land, Slices, block_error, device_arriving,
    device_level, device_spline, march_error, place_error, walk_error,
};
use ridgelight_cpu::{shade_expand as expand_reference, shade_reduce as reduce_reference};

use super::nodes::{casts, kept_nodes, places};
use crate::cpu_reference::{Pair, Run, constant, pushed};
use crate::horizon::cpu_reference::pyramid::{numbers, table_pairs};
use crate::specular::cpu_reference::bounced::{magnitude, paired as paired_series};

impl Run<'_> {
    /// The pyramid of exit radiance.
    pub(crate) fn shade(&self) -> Pyramid {
        let bounces = self.quality.bounces;
        let heights = Pyramid::new(&self.quality, self.plan.size, self.border());
        Pyramid { level_step: bounces.level_step, level_offset: bounces.level_offset, ..heights }
    }

    /// The exit radiance of every texel.
    pub(crate) fn exit(&mut self, pass: &Pass) -> Vec<[f64; 3]> {
        let texels = self.floats(pass, "exit_radiance").expect("bound");
        let grid_points = self.scene.field.heights_m().len();
        match texels.len() / grid_points {
            1 => texels.iter().map(|v| [(*v).into(); 3]).collect(),
            _ => colours(&texels),
        }
    }

    /// The exit radiance of every texel, as a walk reads it.
    fn walked_exit(&mut self, pass: &Pass) -> Vec<[f32; 3]> {
        match self.floats(pass, "grey_ground") {
            Some(grey) => grey.chunks_exact(2).map(|g| [g[0]; 3]).collect(),
            None => {
                let texels = self.floats(pass, "bounce_ground").expect("one of both");
                texels.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
            }
        }
    }

    pub(crate) fn land(&self) -> Land {
        Land::of(&self.scene.field, self.border())
    }

    pub(crate) fn slices(&self, place: [usize; 2], wedge: f64, brightest: f64) -> Slices {
        let normal = Land::normal_at(&self.scene.field, self.border(), place);
        Slices { normal, wedge, brightest }
    }
}

pub(crate) fn colours(texels: &[f32]) -> Vec<[f64; 3]> {
    texels.chunks_exact(4).map(|t| [0, 1, 2].map(|c| t[c].into())).collect()
}

pub(crate) fn brightest(exit: &[[f64; 3]]) -> f64 {
    exit.as_flattened().iter().fold(0.0, |m, v| v.max(m))
}

/// Colours paired with the CPU reference's, each with its own tolerance.
fn each(got: &[[f64; 3]], of: impl Fn(usize) -> ([f64; 3], [f64; 3]), at: [usize; 2]) -> Vec<Pair> {
    let [number, cols] = at;
    let pairs = |(i, got): (usize, &[f64; 3])| {
        let (want, off) = of(i);
        let at = [number, i / cols, i % cols];
        [0, 1, 2].map(|c| Pair { got: got[c], want: want[c], tolerance: off[c], at })
    };
    got.iter().enumerate().flat_map(pairs).collect()
}

/// The same with one tolerance for all.
fn paired(got: &[[f64; 3]], want: &[[f64; 3]], tolerance: f64, at: [usize; 2]) -> Vec<Pair> {
    each(&got[..want.len()], |i| (want[i], [tolerance; 3]), at)
}

/// All visible intervals along every azimuth, after the last dispatch; with specular also what arrives as a series.
pub(crate) fn bounce_march(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTHS: usize = offset("BounceMarchPush", "azimuths");
    const LAST_AZIMUTH: usize = offset("BounceMarchPush", "last_azimuth");
    let azimuths = pushed(pass, AZIMUTHS);
    if pushed(pass, LAST_AZIMUTH) < azimuths {
        return Vec::new();
    }
    let (order, has_vectors) = (constant(pass, "order") as usize, constant(pass, "vectors") == 1);
    let vectors = has_vectors.then(|| run.all_series(pass, "exit_vectors", order));
    let exit = if has_vectors { Vec::new() } else { run.exit(pass) };
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let oracle = Oracle::new(&run.scene.field, run.border());
    let nodes = Nodes { stride: constant(pass, "node_stride") };
    let [across, _] = nodes.size(run.plan.size).map(|n| n as usize);
    let places = places(run, nodes);
    let brightest = match &vectors {
        Some(exit) => exit.iter().map(magnitude).fold(0.0, f64::max),
        None => brightest(&exit),
    };
    let cell_m = run.scene.field.cell_m();
    let along = |i: usize| match &vectors {
        Some(exit) => visible_series_along(&oracle, (order, exit), azimuths, places[i]),
        None => visible_intervals_along(&oracle, &exit, azimuths, places[i]),
    };
    // Radiance by direction changes by n a radian, and its sum errs by 100 ε.
    let error = |of: &Along, cast: &Cast| {
        let here = march_error(cell_m, of, cast);
        let turned =
            if has_vectors { order as f64 * here.elevation_rad + 100.0 * EPSILON } else { 0.0 };
        CastError { radiance: here.radiance + turned * brightest, ..here }
    };
    let of = |i: usize| {
        let all = along(i);
        (radiance(&all), BounceError::of(&all, error, &run.slices(places[i], 1.0, brightest)).light)
    };
    let mut pairs = each(&got, of, [0, across]);
    if order > 0 {
        for (i, got) in run.all_series(pass, "arriving", order).iter().enumerate() {
            let (all, slices) = (along(i), run.slices(places[i], 1.0, brightest));
            let error = |of: &Along, cast: &Cast| march_error(cell_m, of, cast);
            let off = device_arriving(&all, error, order, &slices);
            let want = arriving(order, &all).series;
            pairs.extend(paired_series((got, &want), |_| off, places[i]));
        }
    }
    pairs
}

/// The levels of an octave, and their entries in the table.
pub(crate) fn shade_reduce(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    numbers(pass).flat_map(|number| shade_level(run, pass, number)).collect()
}

fn shade_level(run: &mut Run, pass: &Pass, number: u32) -> Vec<Pair> {
    let shade = run.shade();
    let level = shade.level(number);
    let exit = run.exit(pass);
    let texels = colours(&run.floats(pass, "shade_levels").expect("written"));
    let table = run.words(pass, "shade_table").expect("written");
    let want = reduce_reference::shade_reduce(&exit, &shade, number, &texels);
    let tolerance = device_level(brightest(&exit));
    let at = [number as usize, level.size[0] as usize];
    let mut pairs = paired(&texels[level.first as usize..], &want, tolerance, at);
    pairs.extend(table_pairs(&level, number, &table));
    pairs
}

pub(crate) fn shade_expand(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let shade = run.shade();
    let texels = colours(&run.floats(pass, "shade_levels").expect("written"));
    let grey = run.floats(pass, "shade_stack_grey");
    let stack = grey.or_else(|| run.floats(pass, "shade_stack")).expect("written");
    let [cols, rows] = run.size();
    let grid_points = cols * rows;
    let layers = shade.levels() as usize;
    let stack = match stack.len() / (grid_points * layers) {
        1 => stack.iter().map(|v| [(*v).into(); 3]).collect(),
        _ => colours(&stack),
    };
    let tolerance = device_spline(brightest(&texels));
    let of = |number: u32| {
        let want = expand_reference::shade_expand(&shade, &texels, number);
        let layer = &stack[(number as usize - 1) * grid_points..];
        paired(layer, &want, tolerance, [number as usize, cols])
    };
    (1..=shade.levels()).flat_map(of).collect()
}

/// The bounced light, from the device's own levels, in one dispatch.
pub(crate) fn bounce_gather(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTHS: usize = offset("GatherPush", "azimuths");
    const FIRST_AZIMUTH: usize = offset("GatherPush", "first_azimuth");
    const LAST_AZIMUTH: usize = offset("GatherPush", "last_azimuth");
    let azimuths = pushed(pass, AZIMUTHS);
    assert_eq!([pushed(pass, FIRST_AZIMUTH), pushed(pass, LAST_AZIMUTH)], [0, azimuths]);
    let (shade, receiver) = (run.shade(), run.quality.receiver);
    let pyramid = Pyramid::new(&run.quality, run.plan.size, run.border());
    let exit = run.exit(pass);
    let texels = match run.floats(pass, "shade_levels") {
        Some(texels) => colours(&texels),
        // The device reads the output of `shade_expand`.
        None => reduce_reference::shade_levels(&exit, &shade),
    };
    let stack = run.floats(pass, "height_stack");
    let levels = run.floats(pass, "height_levels").unwrap_or_default();
    let stored = stack.as_ref().map_or(Stored::Levels(&levels), |s| Stored::Stack(s));
    let got = colours(&run.floats(pass, "bounce_sum").expect("written"));
    let field = &run.scene.field;
    let reference = BounceGather {
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
    let nodes = Nodes { stride: constant(pass, "node_stride") };
    let [across, _] = nodes.size(run.plan.size).map(|n| n as usize);
    let places = places(run, nodes);
    let [x, y] = field.cell_m();
    let (land, brightest) = (run.land(), brightest(&exit));
    let gathered = Gathered {
        land,
        step_m: x.min(y),
        is_stack: pyramid.stored == Levels::Stack,
        own_levels: false,
        receiver,
        brightest,
        spread: brightest - exit.as_flattened().iter().fold(brightest, |m, v| v.min(m)),
    };
    let of = |i: usize| {
        let all = reference.casts_along(places[i]);
        let slices = run.slices(places[i], 1.0, brightest);
        let off = BounceError::of(&all, |_, cast| gathered.error(cast), &slices);
        (radiance(&all), off.light)
    };
    each(&got, of, [0, across])
}

/// Copies, to the last bit.
pub(crate) fn bounce_ground(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let is_grey = constant(pass, "grey") == 1;
    let exit: Vec<[f64; 3]> = match is_grey {
        true => run
            .floats(pass, "exit_grey")
            .expect("bound")
            .iter()
            .map(|v| [f64::from(*v); 3])
            .collect(),
        false => run.exit(pass),
    };
    let (name, width) = if is_grey { ("grey_ground", 2) } else { ("bounce_ground", 4) };
    let got = run.floats(pass, name).expect("written");
    let all = ground_reference(&exit, run.scene.field.heights_m());
    let mut pairs = Vec::new();
    for (i, (got, [r, g, b, height])) in got.chunks_exact(width).zip(all).enumerate() {
        let want = if is_grey { vec![r, height] } else { vec![r, g, b, height] };
        let pair = |(got, want): (&f32, f64)| Pair {
            got: f64::from(*got),
            want,
            tolerance: 0.0,
            at: [0, 0, i],
        };
        pairs.extend(got.iter().zip(want).map(pair));
    }
    pairs
}

/// Every block that a walk may read: of every line that is on the field where it ends, or less than a spacing beside it.
/// Heights and places are the same to the last bit.
pub(crate) fn line_blocks(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let (name, words) =
        if constant(pass, "grey") == 1 { ("grey_blocks", 2) } else { ("line_blocks", 4) };
    let texels = run.words(pass, name).expect("written");
    let [width, height] = run.extent(pass, name);
    let exit = run.walked_exit(pass);
    let shift: u32 = constant(pass, "line_shift");
    let mut pairs = Vec::new();
    let layers = pushed(pass, const { offset("LineBlocksPush", "block_layers") }) as usize;
    for k in pass.azimuths.clone() {
        let azimuth = run.plan.azimuths[k as usize];
        let march = March::new(run.heights(), &azimuth);
        let warm_up = run.warm_up(azimuth.marches_rows());
        let total = march.steps + warm_up;
        let spacing = 1_i32 << shift;
        let lead = match march.periodic() {
            true => 0,
            false => ((total - 1) * azimuth.shear + spacing - 1) >> shift,
        };
        let last = (march.lanes - 1) * CELL;
        let lines = match march.periodic() {
            true => (march.lanes * CELL) >> shift,
            false => (last >> shift) + 1 + lead,
        };
        let ground = Ground { march, exit: &exit };
        for (line, level) in (0..lines).flat_map(|line| (1..=MOST_LEVEL).map(move |l| (line, l))) {
            for end in (1 << level..total).step_by(1 << level) {
                let y = (line - lead) * spacing + end * azimuth.shear;
                if !march.periodic() && !(1 - spacing..last + spacing).contains(&y) {
                    continue;
                }
                let row = end as usize - (1 << (level - 1));
                let among = match march.periodic() {
                    true => line,
                    false => line - lead + 1 + ((end * azimuth.shear) >> shift),
                } as usize;
                let layer = (k - pass.azimuths.start) as usize * layers + (among >> 5);
                let at = words * ((layer * height + row) * width + (among & 31));
                let of = |i: usize| if i < words { texels[at + i] } else { 0 };
                let [top, first, green, blue] = [0, 1, 2, 3].map(of);
                let want = ground.line_block((y, end - warm_up), level);
                let place = [k as usize, line as usize, row];
                let exact = |got: f64, want: f64| Pair { got, want, tolerance: 0.0, at: place };
                pairs.push(exact(f32::from_bits(top).into(), want.top_m.into()));
                pairs.push(exact(f64::from(first & 255) + 1.0, want.top_steps.into()));
                let light = [first & !255, green, blue].map(f32::from_bits);
                let brightest = want.brightest.iter().fold(0.0, |m: f64, v| m.max(*v));
                let mean = block_error(brightest, want.spread.max_element());
                let tolerance = [mean + place_error(brightest), mean, mean];
                let channels = words - 1;
                pairs.extend((0..channels).map(|c| Pair {
                    got: light[c].into(),
                    want: want.light[c],
                    tolerance: tolerance[c],
                    at: place,
                }));
            }
        }
    }
    pairs
}

/// The sum so far; after the last azimuths, the bounced light. The weight of whole hemispheres. The share of the sky where a walk
/// finds it: 1 minus the bounce of white ground.
pub(crate) fn bounce_walk(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const AZIMUTH_COUNT: usize = offset("BounceWalkPush", "azimuth_count");
    const CLEARS: usize = offset("BounceWalkPush", "clears");
    const FIRST_AZIMUTH: usize = offset("BounceWalkPush", "first_azimuth");
    const IS_LAST: usize = offset("BounceWalkPush", "is_last");
    let word = |offset| pushed(pass, offset) as usize;
    let first = word(FIRST_AZIMUTH);
    let begin = run.begin_of_light(first, word(CLEARS) == 1);
    let range = begin..first + word(AZIMUTH_COUNT);
    let exit = run.walked_exit(pass);
    let sums = run.floats(pass, "bounce_sum").expect("written");
    let got = colours(&sums);
    let brightest = exit.as_flattened().iter().fold(0.0_f64, |m, v| m.max((*v).into()));
    let is_last = word(IS_LAST) == 1;
    let nodes = Nodes { stride: constant(pass, "node_stride") };
    let [across, _] = nodes.size(run.plan.size).map(|n| n as usize);
    let kept = self::places(run, kept_nodes(pass));
    let places = places(run, nodes);
    let from = constant(pass, "from");
    // 0: all nodes; 1: those that fill the visibility cache; 2: the others of their lanes; 3: those of the other lanes.
    let across_of =
        |[row, col]: [usize; 2]| if constant(pass, "marches_rows") == 1 { col } else { row };
    let lanes: HashSet<usize> = kept.iter().map(|place| across_of(*place)).collect();
    let kept: HashSet<[usize; 2]> = kept.into_iter().collect();
    let is_walked = |i: usize| match from {
        0 => true,
        1 => kept.contains(&places[i]),
        2 => lanes.contains(&across_of(places[i])) && !kept.contains(&places[i]),
        _ => !lanes.contains(&across_of(places[i])),
    };
    let wedge = std::f64::consts::TAU / f64::from(run.quality.bounces.azimuths);
    let settings = (Some(Fuse::AimedNearest), constant(pass, "line_shift"));
    let share = match constant(pass, "finds_share") {
        0 => None,
        _ => Some(run.floats(pass, "sky_share").expect("written")),
    };
    let walked = |exit: &[[f32; 3]]| -> Vec<_> {
        run.swept(range.clone(), settings, |swept| {
            let of =
                |[row, col]: &[usize; 2]| walked_along(swept, exit, *col as i32, *row as i32).0;
            places.iter().map(of).collect()
        })
    };
    let bounced = walked(&exit);
    let white = share.is_some().then(|| walked(&vec![[1.0; 3]; exit.len()]));
    let of = |along: &[Along], place: [usize; 2], brightest: f64| {
        let slices = run.slices(place, wedge, brightest);
        let off = BounceError::of(along, |_, cast| walk_error(wedge, cast), &slices);
        let (light, weight) = light_and_weight(along);
        let whole = [weight, off.whole];
        match is_last {
            true => (radiance(along), off.light, whole),
            false => (light, off.sum, whole),
        }
    };
    let at = [range.len(), across];
    let of_light = |i: usize| {
        let (want, off, _) = of(&bounced[i], places[i], brightest);
        (want, off)
    };
    let mut pairs = each(&got, of_light, at);
    let of_whole = |i: usize| {
        let (_, _, [whole, whole_off]) = of(&bounced[i], places[i], brightest);
        ([whole; 3], [whole_off; 3])
    };
    let wholes: Vec<[f64; 3]> = sums.chunks_exact(4).map(|t| [f64::from(t[3]); 3]).collect();
    pairs.extend(each(&wholes, of_whole, at));
    if let (Some(share), Some(white)) = (share, white) {
        let of_share = |i: usize| {
            let (ground, off, whole) = of(&white[i], places[i], 1.0);
            let unit = if is_last { whole[0] } else { 1.0 };
            let [whole, whole_off] = whole.map(|v| v / unit);
            (ground.map(|ground| whole - ground), off.map(|off| off + whole_off))
        };
        let got: Vec<[f64; 3]> = share.iter().map(|v| [f64::from(*v); 3]).collect();
        pairs.extend(each(&got, of_share, at));
    }
    let walked: HashSet<[usize; 2]> =
        (0..places.len()).filter(|i| is_walked(*i)).map(|i| [i / across, i % across]).collect();
    pairs.retain(|pair| walked.contains(&[pair.at[1], pair.at[2]]));
    pairs.extend(casts(run, pass, first..range.end));
    pairs
}
