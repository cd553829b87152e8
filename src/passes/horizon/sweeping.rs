use std::f64::consts::TAU;

use crate::graph::{Axis, bytes_text};
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::azimuths;
use crate::passes::azimuths::Azimuth;
use crate::passes::batch;
use crate::passes::batch::Batch;
use crate::passes::nodes::Nodes;
use crate::passes::pyramid_march;
use crate::passes::sweep::{HullStorage, LineSweep, Sweep};
use crate::scene::{Border, HeightField, Lines, Method, Quality};
use crate::{Error, Result, passes};

/// What all sweeps of a plan share.
pub(crate) struct Sweeping {
    pub sweep: Sweep,
    heights: ResourceId,
    pub azimuths: ResourceId,
    /// Heights by lanes, of each axis that is marched: columns, rows.
    lane_heights: [Option<ResourceId>; 2],
    /// Whether the sweep also reads its heights there, four lanes at a time.
    quads: bool,
    /// Levels of a height pyramid, where any are read.
    pub levels: Option<pyramid_march::Images>,
    /// Nodes at which marches store a value.
    pub nodes: Nodes,
    /// The lattice of each batch; several batches may use one in turn.
    lattices: Vec<Lattice>,
}

/// Output of sweeps.
#[derive(Clone, Copy)]
struct Lattice {
    occluders: Option<ResourceId>,
    slopes: Option<ResourceId>,
    lost_lines: Option<ResourceId>,
}

impl Sweeping {
    /// Heights by lanes along a batch's axis.
    pub(crate) fn lane_heights(&self, batch: &Batch) -> ResourceId {
        self.lane_heights[usize::from(batch.axis.marches_rows)].expect("made for every axis used")
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

    /// Passes that update heights by lanes and lattices after an edit, and mark the texels that change.
    pub(crate) fn plan_edit<'a>(
        &self,
        builder: &mut Builder,
        border: Border,
        batches: impl Iterator<Item = &'a Batch> + Clone,
        [dirty, list]: [ResourceId; 2],
    ) {
        for (marches_rows, lanes) in [false, true].into_iter().zip(self.lane_heights) {
            let axis = batches.clone().map(|b| b.axis).find(|a| a.marches_rows == marches_rows);
            if let (Some(axis), Some(lanes)) = (axis, lanes) {
                passes::height_transpose::plan(builder, axis, border, self.heights, lanes);
            }
        }
        let Some(sweep) = self.sweep.editable(border) else { return };
        for batch in batches {
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

    pub(crate) fn plan(&self, builder: &mut Builder, batch: &Batch, part: &str) {
        let lattice = self.lattice_of(batch);
        match &self.sweep {
            Sweep::Lines(lines) => {
                let images = passes::horizon_sweep::Images {
                    heights: self.heights,
                    lane_heights: self.quads.then(|| self.lane_heights(batch)),
                    azimuths: self.azimuths,
                    occluders: lattice.occluders,
                    slopes: lattice.slopes,
                    lost_lines: lattice.lost_lines,
                };
                passes::horizon_sweep::plan(builder, lines, batch, part, &images);
            }
            Sweep::Crossings => {}
            Sweep::Pyramid(pyramid) => {
                let ids = [self.heights, self.azimuths, self.written(batch)];
                let levels = self.levels.as_ref();
                pyramid_march::plan(builder, (pyramid, self.nodes), batch, part, ids, levels);
            }
            Sweep::Surface { hull_depth, distances } => {
                let ids = [self.heights, self.azimuths, self.written(batch)];
                passes::surface_sweep::plan(builder, batch, part, *hull_depth, *distances, ids);
            }
            Sweep::March { distances } => {
                let ids = [self.heights, self.azimuths, self.written(batch)];
                let wanted = (*distances, self.nodes);
                passes::horizon_march::plan(builder, batch, part, wanted, ids);
            }
        }
    }
}

/// Azimuth lists, one per light, in the order of the buffer; and their batches.
#[derive(Default)]
pub(crate) struct Lists {
    pub lists: Vec<Vec<Azimuth>>,
    pub batches: Vec<Vec<Batch>>,
}

/// Layers that a sweep writes: formats, width and height. Their number follows from the batches.
#[derive(Clone, Copy, PartialEq)]
struct LatticeShape {
    occluders: Option<Format>,
    slopes: Option<Format>,
    width: u32,
    height: u32,
}

impl LatticeShape {
    fn of(sweep: &Sweep, axis: Axis, nodes: Nodes) -> Self {
        let [lanes, steps] = nodes.size([axis.lanes, axis.steps]);
        match sweep {
            Sweep::Lines(lines) => Self {
                occluders: lines.writes_occluders.then_some(Format::Rg32Uint),
                slopes: match lines.slope_format {
                    1 => Some(Format::Rgba32Uint),
                    2 => Some(Format::Rg32Uint),
                    _ => None,
                },
                width: 8,
                height: axis.steps + axis.warm_up,
            },
            Sweep::Crossings => Self { occluders: None, slopes: None, width: 1, height: 1 },
            Sweep::Surface { .. } | Sweep::March { .. } | Sweep::Pyramid(_) => {
                Self { occluders: None, slopes: Some(Format::R32Uint), width: lanes, height: steps }
            }
        }
    }

    fn layer_bytes(&self) -> u64 {
        let texels = u64::from(self.width) * u64::from(self.height);
        [self.occluders, self.slopes].iter().flatten().map(|f| f.bytes() * texels).sum()
    }
}

/// Makes the sweep's images within the remaining budget, and cuts the lists into batches. Lists from
/// `kept_from` on have a lattice of their own; the others use lattices in turn.
pub(crate) fn prepare(
    builder: &mut Builder,
    field: &HeightField,
    border: Border,
    sweep: Sweep,
    heights: ResourceId,
    mut lists: Vec<Vec<Azimuth>>,
    (limits, kept_from, nodes): (&Limits, Option<usize>, Nodes),
) -> Result<(Sweeping, Lists)> {
    let size = [field.cols() as u32, field.rows() as u32];
    let count: usize = lists.iter().map(Vec::len).sum();
    let azimuths = builder.buffer("azimuths", (count * size_of::<Azimuth>()) as u64, true);
    let axes = [false, true].map(|marches_rows| {
        let used = lists.iter().flatten().any(|a| a.marches_rows() == marches_rows);
        used.then(|| Axis::of(marches_rows, size, border))
    });
    let lane_heights = axes.map(|axis| axis.map(|axis| lane_image(builder, axis)));
    let levels = match &sweep {
        Sweep::Pyramid(pyramid) => pyramid.images(builder),
        _ => None,
    };
    let shapes = shapes(&lists, &axes, &sweep, nodes);
    let batches = cut_lists(&mut lists, builder.bytes(), &axes, &shapes, &sweep, limits)?;
    let shape_of =
        |axis: Axis| shapes[usize::from(axis.marches_rows)].expect("a shape for every axis used");
    let can_lose =
        matches!(&sweep, Sweep::Lines(l) if !l.holds_line && l.hull != HullStorage::Occluders);
    let mut make = |axis: Axis, layers: u32, suffix: &str| {
        let shape = shape_of(axis);
        let extent = [shape.width, shape.height, layers];
        let mut image = |name: &str, format: Option<Format>| {
            format
                .map(|f| builder.image(format!("{name}{suffix}"), Owner::Internal, f, extent, true))
        };
        let (occluders, slopes) =
            (image("lattice_occluders", shape.occluders), image("lattice_slopes", shape.slopes));
        let bytes = u64::from(layers) * 32;
        let lost_lines =
            can_lose.then(|| builder.buffer(&format!("lost_lines{suffix}"), bytes, false));
        Lattice { occluders, slopes, lost_lines }
    };
    let is_kept = |list: usize| kept_from.is_some_and(|first| list >= first);
    let in_turn: Vec<Batch> = batches
        .iter()
        .enumerate()
        .filter(|(list, _)| !is_kept(*list))
        .flat_map(|(_, batches)| batches.iter().copied())
        .collect();
    let mut shared: Vec<(LatticeShape, Lattice)> = Vec::new();
    let mut lattices = Vec::new();
    for (list, batch) in batches.iter().enumerate().flat_map(|(l, b)| b.iter().map(move |b| (l, b)))
    {
        let shape = shape_of(batch.axis);
        if is_kept(list) {
            lattices.push(make(batch.axis, batch.layers, &format!("_{}", batch.number)));
        } else if let Some((_, known)) = shared.iter().find(|(of, _)| *of == shape) {
            lattices.push(*known);
        } else {
            let alike = in_turn.iter().filter(|b| shape_of(b.axis) == shape);
            let layers = alike.map(|b| b.layers).max().unwrap_or(1);
            let suffix = if shared.is_empty() { "" } else { "_across" };
            let made = make(batch.axis, layers, suffix);
            shared.push((shape, made));
            lattices.push(made);
        }
    }
    for (axis, lanes) in axes.iter().zip(lane_heights) {
        if let (Some(axis), Some(lanes)) = (axis, lanes) {
            passes::height_transpose::plan(builder, *axis, border, heights, lanes);
        }
    }
    if let (Sweep::Pyramid(pyramid), Some(images)) = (&sweep, &levels) {
        pyramid.plan(builder, heights, images);
    }
    // Lines one cell apart pass four neighbouring lanes alike.
    let quads = matches!(sweep, Sweep::Lines(LineSweep { line_shift: 15, .. }))
        && border != Border::Periodic;
    let sweeping =
        Sweeping { sweep, heights, azimuths, lane_heights, quads, levels, nodes, lattices };
    Ok((sweeping, Lists { lists, batches }))
}

/// The image of heights by lanes along an axis.
fn lane_image(builder: &mut Builder, axis: Axis) -> ResourceId {
    let extent = [axis.lanes.div_ceil(4), axis.steps, 1];
    let name = format!("lane_heights_{}", axis.name());
    builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false)
}

/// Bytes of the lattice of one azimuth: the largest along each axis.
fn least_bytes(
    lists: &[Vec<Azimuth>],
    axes: &[Option<Axis>; 2],
    sweep: &Sweep,
    layer_bytes: [u64; 2],
) -> [u64; 2] {
    let mut least = [0_u64; 2];
    for azimuth in lists.iter().flatten() {
        let along = usize::from(azimuth.marches_rows());
        let axis = axes[along].expect("an axis for every azimuth");
        let bytes = u64::from(sweep.layers(azimuth, axis)) * layer_bytes[along];
        least[along] = least[along].max(bytes);
    }
    least
}

/// Shapes of the lattices along each axis: one shape for both, used in turn, where that takes no more than one
/// for each.
fn shapes(
    lists: &[Vec<Azimuth>],
    axes: &[Option<Axis>; 2],
    sweep: &Sweep,
    nodes: Nodes,
) -> [Option<LatticeShape>; 2] {
    let own = axes.map(|axis| axis.map(|axis| LatticeShape::of(sweep, axis, nodes)));
    let [Some(a), Some(b)] = own else { return own };
    let both = LatticeShape { width: a.width.max(b.width), height: a.height.max(b.height), ..a };
    let bytes = |shapes: [LatticeShape; 2]| {
        least_bytes(lists, axes, sweep, shapes.map(|s| s.layer_bytes()))
    };
    let (in_turn, apart) = (bytes([both; 2]), bytes([a, b]));
    if in_turn[0].max(in_turn[1]) <= apart[0] + apart[1] { [Some(both); 2] } else { own }
}

/// Sorts every list and cuts it into batches. `fixed_bytes` are taken in any case.
fn cut_lists(
    lists: &mut [Vec<Azimuth>],
    fixed_bytes: u64,
    axes: &[Option<Axis>; 2],
    shapes: &[Option<LatticeShape>; 2],
    sweep: &Sweep,
    limits: &Limits,
) -> Result<Vec<Vec<Batch>>> {
    let layer_bytes = shapes.map(|shape| shape.map_or(0, |s| s.layer_bytes()));
    // Axes of one shape use one lattice in turn; others divide the remaining budget by need.
    let least = least_bytes(lists, axes, sweep, layer_bytes);
    let differ = matches!(shapes, [Some(a), Some(b)] if a != b);
    let all = if differ { least[0] + least[1] } else { least[0].max(least[1]) };
    if fixed_bytes + all > limits.memory_budget {
        let [cols, rows] = axes.iter().flatten().next().map_or([0, 0], |axis| axis.size());
        return Err(Error::Limit {
            what: format!("horizons of one azimuth of a {cols} × {rows} field"),
            needs: format!("{} in total", bytes_text(fixed_bytes + all)),
            limit: format!("{} of `memory_budget`", bytes_text(limits.memory_budget)),
        });
    }
    let budget = u128::from(limits.memory_budget - fixed_bytes);
    let share =
        |need: u64| if differ { budget * u128::from(need) / u128::from(all) } else { budget };
    let lattice_bytes = least.map(|need| share(need) as u64);
    let room = batch::Room { lattice_bytes, layer_bytes };
    let mut all: Vec<Vec<Batch>> = Vec::new();
    let mut first = 0;
    for list in lists {
        batch::sort(list);
        let mut batches = batch::cut(list, first, axes, sweep, limits, &room)?;
        let before = all.iter().map(Vec::len).sum::<usize>() as u32;
        batches.iter_mut().for_each(|b| b.number += before);
        all.push(batches);
        first += list.len() as u32;
    }
    Ok(all)
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
pub(crate) fn settings(
    quality: &Quality,
    sweep: Option<&Sweep>,
    border: Border,
) -> Vec<(String, String)> {
    let mut all = vec![("border".to_owned(), format!("{border:?}").to_lowercase())];
    let mut add = |name: &str, value: String| all.push((name.to_owned(), value));
    let Some(sweep) = sweep else { return all };
    match sweep {
        Sweep::Lines(lines) => {
            add("method", "sweep".into());
            add("lines", lines.spacing().name().into());
            add("fuse", quality.fuse.name().into());
            add("hull", lines.hull.name().into());
            add("hull_depth", lines.hull_depth.to_string());
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
