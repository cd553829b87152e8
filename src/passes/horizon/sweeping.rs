use std::f64::consts::TAU;

use crate::graph::Axis;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::azimuths;
use crate::passes::azimuths::Azimuth;
use crate::passes::batch::{Batch, Group, LATTICE_DIVISOR, LatticeShape, cut_groups};
use crate::passes::nodes::Nodes;
use crate::passes::pyramid_march;
use crate::passes::sweep::{HullStorage, LineSweep, Sweep, shadows_by_one_line};
use crate::scene::{Border, Fuse, HeightField, Lines, Method, Quality};
use crate::{Result, passes};

/// What all sweeps of a plan share.
pub(crate) struct Sweeping {
    pub sweep: Sweep,
    heights: ResourceId,
    pub azimuths: ResourceId,
    /// Heights by lanes, of each axis that is marched: columns, rows.
    lanes: [Option<Lanes>; 2],
    /// Whether the sweep also reads its heights there, four lanes at a time.
    quads: bool,
    /// Levels of a height pyramid, where any are read.
    pub levels: Option<pyramid_march::Images>,
    /// The hull of exact lines, if it is in a buffer.
    hull_buffer: Option<ResourceId>,
    /// Nodes at which marches store a value.
    pub nodes: Nodes,
    /// The lattice of each batch; several batches may use one in turn.
    lattices: Vec<Lattice>,
    /// Whether each batch of a circle has its own lattice.
    pub has_own_lattices: bool,
    /// Numbers of the batches of lights by shadow heights.
    shadows: Vec<u32>,
}

/// Heights by lanes along one axis.
#[derive(Clone, Copy)]
pub(crate) struct Lanes {
    /// Four lanes per texel.
    pub heights: ResourceId,
    /// The same as a buffer, set if an invocation of a sweep along this axis sweeps one line.
    pub buffer: Option<ResourceId>,
    /// Four lanes from each lane on, set where fuse `aimed-around` or brute force reads them.
    pub windows: Option<ResourceId>,
}

impl Lanes {
    /// What shaders with READS_LANE_WINDOWS read as `lane_heights`.
    pub(crate) fn read(&self) -> ResourceId {
        self.windows.unwrap_or(self.heights)
    }
}

/// Floats of a buffer of heights by lanes before the first height and after the last: LANE_BUFFER_PAD of sweep.glsl.
pub(crate) const LANE_BUFFER_PAD: u32 = 4;

/// Output of sweeps.
#[derive(Clone, Copy)]
struct Lattice {
    occluders: Option<ResourceId>,
    slopes: Option<ResourceId>,
    lost_lines: Option<ResourceId>,
}

impl Sweeping {
    /// Heights by lanes along a batch's axis.
    pub(crate) fn lanes(&self, batch: &Batch) -> Lanes {
        self.lanes[usize::from(batch.axis.marches_rows)].expect("made for every axis used")
    }

    /// The same, four lanes per texel.
    pub(crate) fn lane_heights(&self, batch: &Batch) -> ResourceId {
        self.lanes(batch).heights
    }

    fn lattice_of(&self, batch: &Batch) -> Lattice {
        self.lattices[batch.number as usize]
    }

    /// The output of a batch's sweep for shading: slopes where stored, else occluders.
    pub(crate) fn lattice(&self, batch: &Batch) -> Option<ResourceId> {
        let lattice = self.lattice_of(batch);
        lattice.slopes.or(lattice.occluders)
    }

    /// The occluders of a batch's sweep along lines.
    pub(crate) fn occluders(&self, batch: &Batch) -> Option<ResourceId> {
        self.lattice_of(batch).occluders
    }

    /// The same, of a sweep that stores something.
    pub(crate) fn written(&self, batch: &Batch) -> ResourceId {
        self.lattice(batch).expect("a sweep stores something")
    }

    /// The field's heights.
    pub(crate) fn heights(&self) -> ResourceId {
        self.heights
    }

    /// Whether a batch is of a light by shadow heights, whose sweep is not planned here.
    pub(crate) fn is_shadow(&self, batch: &Batch) -> bool {
        self.shadows.contains(&batch.number)
    }

    /// Passes that update heights by lanes and lattices after an edit, and mark the texels that change.
    pub(crate) fn plan_edit<'a>(
        &self,
        builder: &mut Builder,
        border: Border,
        batches: impl Iterator<Item = &'a Batch> + Clone,
        [dirty, list]: [ResourceId; 2],
    ) {
        for (marches_rows, lanes) in [false, true].into_iter().zip(self.lanes) {
            let axis = batches.clone().map(|b| b.axis).find(|a| a.marches_rows == marches_rows);
            if let (Some(axis), Some(lanes)) = (axis, lanes) {
                passes::height_transpose::plan(builder, axis, border, self.heights, lanes);
            }
        }
        let Some(sweep) = self.sweep.editable(border) else { return };
        for batch in batches.filter(|batch| !self.is_shadow(batch)) {
            let images = passes::horizon_resweep::Images {
                heights: self.heights,
                azimuths: self.azimuths,
                occluders: self.lattice_of(batch).occluders.expect("edits go on from occluders"),
                dirty,
                list,
            };
            let part = format!("{}+{}", batch.first, batch.count);
            passes::horizon_resweep::plan(builder, sweep, batch, &part, &images);
        }
    }

    /// The passes that sweep some batches. Those with lattices of their own can run side by side.
    pub(crate) fn plan_all(&self, builder: &mut Builder, batches: &[(Batch, String)]) {
        for (batch, part) in batches {
            self.plan(builder, batch, part);
        }
        let Sweep::Lines(lines) = &self.sweep else { return };
        for (batch, part) in batches {
            let images = self.images(batch);
            passes::horizon_sweep::plan_again(builder, lines, batch, part, &images);
        }
    }

    fn images(&self, batch: &Batch) -> passes::horizon_sweep::Images {
        let lattice = self.lattice_of(batch);
        passes::horizon_sweep::Images {
            heights: self.heights,
            lane_heights: self.quads.then(|| self.lane_heights(batch)),
            lane_buffer: self.lanes(batch).buffer,
            azimuths: self.azimuths,
            occluders: lattice.occluders,
            slopes: lattice.slopes,
            lost_lines: lattice.lost_lines,
        }
    }

    fn plan(&self, builder: &mut Builder, batch: &Batch, part: &str) {
        match &self.sweep {
            Sweep::Lines(lines) => {
                passes::horizon_sweep::plan(builder, lines, batch, part, &self.images(batch));
            }
            Sweep::Crossings => {}
            Sweep::Pyramid(pyramid) => {
                let ids = [self.heights, self.azimuths, self.written(batch)];
                let levels = self.levels.as_ref();
                pyramid_march::plan(builder, (pyramid, self.nodes), batch, part, ids, levels);
            }
            Sweep::Surface { hull, distances } => {
                let ids = [self.lane_heights(batch), self.azimuths, self.written(batch)];
                let hull = (*hull, self.hull_buffer);
                passes::surface_sweep::plan(builder, batch, part, hull, *distances, ids);
            }
            Sweep::March { distances } => {
                let (lanes, ids) = (self.lanes(batch), [self.azimuths, self.written(batch)]);
                let wanted = (*distances, self.nodes);
                passes::horizon_march::plan(builder, batch, part, wanted, lanes, ids);
            }
        }
    }
}

/// Key of a shared lattice: batches with equal keys use the same one, one after the other.
#[derive(Clone, Copy, PartialEq)]
struct Turn {
    is_shadow: bool,
    shape: LatticeShape,
    /// `marches_rows`; set only if each axis has its own lattice.
    own_axis: Option<bool>,
}

/// Azimuth lists, one per light, in the order of the buffer; and their batches.
#[derive(Default)]
pub(crate) struct Lists {
    pub lists: Vec<Vec<Azimuth>>,
    pub batches: Vec<Vec<Batch>>,
}

/// How lists of azimuths are swept.
pub(crate) struct Held<'a> {
    pub limits: &'a Limits,
    /// Lists from here on have a lattice of their own; the others use lattices in turn.
    pub kept_from: Option<usize>,
    pub nodes: Nodes,
    /// The lists of lights by shadow heights.
    pub shadows: Vec<usize>,
    /// Bytes that lattices leave free for images made after those of the sweep.
    pub later_bytes: u64,
}

/// Makes the sweep's images within the remaining budget, and cuts the lists into batches.
pub(crate) fn prepare(
    builder: &mut Builder,
    field: &HeightField,
    border: Border,
    sweep: Sweep,
    heights: ResourceId,
    mut lists: Vec<Vec<Azimuth>>,
    held: &Held,
) -> Result<(Sweeping, Lists)> {
    let Held { limits, kept_from, nodes, shadows, later_bytes } = held;
    let nodes = *nodes;
    let size = [field.cols() as u32, field.rows() as u32];
    let count: usize = lists.iter().map(Vec::len).sum();
    let azimuths = builder.buffer("azimuths", (count * size_of::<Azimuth>()) as u64, true);
    let axes = [false, true].map(|marches_rows| {
        let used = lists.iter().flatten().any(|a| a.marches_rows() == marches_rows);
        used.then(|| Axis::of(marches_rows, size, border))
    });
    // One line per invocation reads heights from a buffer.
    let lines_alone = matches!(&sweep, Sweep::Lines(l) if l.lines_each == 1);
    let has_windows = reads_windows(&sweep, axes, limits);
    let lanes = axes.map(|axis| {
        let axis = axis?;
        let shadows_alone = shadows_by_one_line(size, limits);
        let reads = |l: usize| if shadows.contains(&l) { shadows_alone } else { lines_alone };
        let along = |a: &Azimuth| a.marches_rows() == axis.marches_rows;
        let is_along = |(_, list): &(usize, &Vec<Azimuth>)| list.iter().any(along);
        let of_axis = || lists.iter().enumerate().filter(is_along);
        let [heights, windows] = [("heights", axis.lanes.div_ceil(4)), ("windows", axis.lanes + 3)]
            .map(|(name, width)| (format!("lane_{name}_{}", axis.name()), [width, axis.steps, 1]));
        let mut image = |(name, extent)| {
            builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false)
        };
        let heights = image(heights);
        let is_fused = has_windows && of_axis().any(|(l, _)| !shadows.contains(&l));
        let windows = is_fused.then(|| image(windows));
        let buffer = of_axis().any(|(l, _)| reads(l)).then(|| {
            let texels = u64::from(axis.lanes.next_multiple_of(4)) * u64::from(axis.steps);
            let bytes = 4 * (texels + 2 * u64::from(LANE_BUFFER_PAD));
            builder.buffer(&format!("lane_buffer_{}", axis.name()), bytes, false)
        });
        Some(Lanes { heights, buffer, windows })
    });
    let levels = match &sweep {
        Sweep::Pyramid(pyramid) => pyramid.images(builder),
        _ => None,
    };
    let hull_buffer = match &sweep {
        Sweep::Surface { hull, .. } => hull.buffer(builder),
        _ => None,
    };
    let shadow_lattice = Sweep::of_words(size, limits);
    let before_lattices = builder.bytes() + later_bytes;
    let grouped = |lists: &[Vec<Azimuth>], layer_shift| {
        let each = (nodes, layer_shift);
        let of_light = Group::of(lists, &sweep, &axes, each, |l| !shadows.contains(&l));
        let mut of_shadow =
            Group::of(lists, &shadow_lattice, &axes, each, |l| shadows.contains(&l));
        // With one along each axis their sweeps can run side by side: those of one sun do not fill a GPU.
        let fits =
            before_lattices + of_shadow.all_bytes() <= limits.memory_budget / LATTICE_DIVISOR;
        of_shadow.is_apart |= !limits.is_cpu && fits && axes.iter().all(Option::is_some);
        [of_light, of_shadow]
    };
    let (groups, batches) = cut_groups(&mut lists, before_lattices, &axes, grouped, limits)?;
    let shape_of = |list: usize, axis: Axis| {
        let shapes = &groups[usize::from(shadows.contains(&list))].shapes;
        shapes[usize::from(axis.marches_rows)].expect("a shape for every axis used")
    };
    let can_lose =
        matches!(&sweep, Sweep::Lines(l) if !l.holds_line && l.hull != HullStorage::Occluders);
    let so_far = builder.bytes() + later_bytes;
    let mut make = |list: usize, axis: Axis, layers: u32, suffix: &str| {
        let shape = shape_of(list, axis);
        let is_shadow = shadows.contains(&list);
        let extent = [shape.width, shape.height, layers];
        let mut image = |name: &str, format: Option<Format>| {
            format
                .map(|f| builder.image(format!("{name}{suffix}"), Owner::Internal, f, extent, true))
        };
        let words = if is_shadow { "lattice_shadows" } else { "lattice_slopes" };
        let (occluders, slopes) =
            (image("lattice_occluders", shape.occluders), image(words, shape.slopes));
        let bytes = u64::from(layers) * shape.lost_bytes();
        let lost_lines = (can_lose && !is_shadow)
            .then(|| builder.buffer(&format!("lost_lines{suffix}"), bytes, false));
        Lattice { occluders, slopes, lost_lines }
    };
    let is_kept = |list: usize| kept_from.is_some_and(|first| list >= first);
    let all = || batches.iter().enumerate().flat_map(|(l, b)| b.iter().map(move |b| (l, *b)));
    let turn = |list: usize, batch: &Batch| {
        let is_shadow = shadows.contains(&list);
        let own_axis = groups[usize::from(is_shadow)].is_apart.then_some(batch.axis.marches_rows);
        Turn { is_shadow, shape: shape_of(list, batch.axis), own_axis }
    };
    // One batch alone does not fill a GPU. Those of suns share lattices: with one each, a sun that moves would change their sizes more
    // often, and a plan of other sizes needs another renderer.
    let circles: Vec<bool> =
        lists.iter().map(|list| list.iter().map(|a| a.wedge_rad).sum::<f32>() > 6.0).collect();
    let of_circles = all()
        .filter(|(list, _)| circles[*list])
        .map(|(list, b)| (b, shape_of(list, b.axis)))
        .map(|(b, shape)| u64::from(b.layers) * (shape.layer_bytes() + shape.lost_bytes()));
    let has_own_lattices = !limits.is_cpu
        && so_far + of_circles.sum::<u64>() <= limits.memory_budget / LATTICE_DIVISOR;
    let is_own = |list: usize| is_kept(list) || has_own_lattices && circles[list];
    let mut shared: Vec<(Turn, Lattice)> = Vec::new();
    let mut lattices = Vec::new();
    for (list, batch) in all() {
        let of = turn(list, &batch);
        if is_own(list) {
            lattices.push(make(list, batch.axis, batch.layers, &format!("_{}", batch.number)));
        } else if let Some((_, known)) = shared.iter().find(|(known, _)| *known == of) {
            lattices.push(*known);
        } else {
            let alike = all().filter(|(l, b)| !is_own(*l) && turn(*l, b) == of);
            let layers = alike.map(|(_, b)| b.layers).max().unwrap_or(1);
            let is_first = shared.iter().all(|(known, _)| known.is_shadow != of.is_shadow);
            let suffix = if is_first { "" } else { "_across" };
            let made = make(list, batch.axis, layers, suffix);
            shared.push((of, made));
            lattices.push(made);
        }
    }
    for (axis, lanes) in axes.into_iter().zip(lanes).filter_map(|(a, l)| a.zip(l)) {
        passes::height_transpose::plan(builder, axis, border, heights, lanes);
    }
    let of_shadows = shadows.iter().flat_map(|l| batches[*l].iter().map(|b| b.number)).collect();
    if let (Sweep::Pyramid(pyramid), Some(images)) = (&sweep, &levels) {
        pyramid.plan(builder, heights, images);
    }
    // Lines one cell apart pass four neighbouring lanes alike.
    let quads = matches!(sweep, Sweep::Lines(LineSweep { line_shift: 15, .. }))
        && border != Border::Periodic;
    let sweeping = Sweeping {
        sweep,
        heights,
        azimuths,
        lanes,
        quads,
        levels,
        hull_buffer,
        nodes,
        lattices,
        has_own_lattices,
        shadows: of_shadows,
    };
    Ok((sweeping, Lists { lists, batches }))
}

/// Windows on heights by lanes may take this part of the memory budget.
const WINDOWS_DIVISOR: u64 = 16;

/// Whether passes read windows of four lanes, in half as many loads. They take four times the memory of heights. Not where sweeps
/// read buffers of heights, as on GPUs: those are read from any lane on.
fn reads_windows(sweep: &Sweep, axes: [Option<Axis>; 2], limits: &Limits) -> bool {
    let reads = match sweep {
        Sweep::Lines(lines) => lines.fuse == Fuse::AimedAround && lines.lines_each == 4,
        Sweep::March { .. } => true,
        _ => false,
    };
    let texels = |axis: Axis| u64::from(axis.lanes + 3) * u64::from(axis.steps);
    let bytes: u64 = axes.into_iter().flatten().map(|axis| 16 * texels(axis)).sum();
    reads
        && limits.is_cpu
        && axes.into_iter().flatten().all(|axis| axis.lanes + 3 <= limits.image_side)
        && bytes <= limits.memory_budget / WINDOWS_DIVISOR
}

/// The part in a pass's label for one of the batches of a light.
pub(crate) fn part(light: &str, batch: &Batch, batches: &[Batch]) -> String {
    match batches {
        [_] => light.to_owned(),
        _ => format!("{light} {}+{}", batch.first, batch.count).trim().to_owned(),
    }
}

/// Even azimuths, or the grid vectors near them.
pub(crate) fn circle(quality: &Quality, sweep: &Sweep, cell_m: [f64; 2]) -> Result<Vec<Azimuth>> {
    match sweep {
        Sweep::Surface { .. } => azimuths::along_grid_vectors(quality.azimuths, cell_m),
        _ => Ok(azimuths::even(quality.azimuths, cell_m)),
    }
}

/// The azimuths that [`horizons`](crate::plan::horizons()) sweeps for a quality, radians counter-clockwise from
/// east: 2πk/M, or the directions of the grid vectors in exact mode.
///
/// # Errors
/// The cells' width and height differ too much for exact azimuths.
pub fn circle_rad(quality: &Quality, cell_m: [f64; 2]) -> Result<Vec<f64>> {
    let count = quality.azimuths;
    let all = match (quality.method, quality.lines) {
        (Method::Auto | Method::Sweep, Lines::Exact) => {
            azimuths::along_grid_vectors(count, cell_m)?
                .iter()
                .map(|a| a.swept_rad(cell_m).rem_euclid(TAU))
                .collect()
        }
        _ => (0..count).map(|k| TAU * f64::from(k) / f64::from(count)).collect(),
    };
    Ok(all)
}

/// The settings in use, for metadata and messages.
pub(crate) fn settings(sweep: Option<&Sweep>, border: Border) -> Vec<(String, String)> {
    let mut all = vec![("border".to_owned(), format!("{border:?}").to_lowercase())];
    let mut add = |name: &str, value: String| all.push((name.to_owned(), value));
    let Some(sweep) = sweep else { return all };
    match sweep {
        Sweep::Lines(lines) => {
            add("method", "sweep".into());
            add("lines", lines.spacing().name().into());
            add("fuse", lines.fuse.name().into());
            add("hull", lines.hull.name().into());
            add("hull_depth", lines.hull_depth.to_string());
            if lines.private_depth > 0 && lines.hull == HullStorage::Shared {
                add("hull_private_depth", lines.private_depth.to_string());
            }
            add("precision", lines.precision().name().into());
        }
        Sweep::Surface { .. } => {
            add("method", "sweep".into());
            add("lines", "exact".into());
        }
        Sweep::Crossings => add("method", "first crossings".into()),
        Sweep::March { .. } => add("method", "brute-force".into()),
        Sweep::Pyramid(pyramid) => {
            add("method", "pyramid".into());
            add("level_step", pyramid.level_step.to_string());
            add("level_offset", pyramid.level_offset.to_string());
            add("levels", pyramid.stored.name().into());
            add("level_count", (1 + pyramid.levels()).to_string());
        }
    }
    all
}
