use crate::graph::{Axis, Format, Limits, bytes_text};
use crate::passes::azimuths::Azimuth;
use crate::passes::nodes::Nodes;
use crate::passes::sweep;
use crate::passes::sweep::Sweep;
use crate::scene::Border;
use crate::{Error, Result};
use std::ops::Range;

impl Axis {
    /// The axis of an azimuth in a field of `cols` × `rows`.
    pub fn of(marches_rows: bool, [cols, rows]: [u32; 2], border: Border) -> Self {
        let (lanes, steps) = if marches_rows { (cols, rows) } else { (rows, cols) };
        let warm_up = if border == Border::Periodic { sweep::warm_up(steps) } else { 0 };
        Self { marches_rows, lanes, steps, warm_up }
    }
}

/// Azimuths that are swept together: one axis, consecutive in the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    /// The axis of all of them.
    pub axis: Axis,
    /// Index among the plan's batches, in the order of the lists.
    pub number: u32,
    /// Index of the first one in the buffer "azimuths".
    pub first: u32,
    /// Number of azimuths.
    pub count: u32,
    /// Of these, how many follow the diagonals of the cells: the first ones.
    pub along: u32,
    /// Lines of the azimuth with the most lines.
    pub most_lines: u32,
    /// Points on all lines.
    pub line_texels: u64,
    /// Layers of the lattice.
    pub layers: u32,
    /// A layer holds 2^layer_shift lines.
    pub layer_shift: u32,
    /// Whether it is the light's first: its sum begins here.
    pub is_first: bool,
}

impl Batch {
    /// Their indices in the buffer "azimuths".
    pub(crate) fn azimuths(&self) -> Range<u32> {
        self.first..self.first + self.count
    }
}

/// Layers hold 2^LAYER_SHIFT lines unless a device allows too few layers.
const LAYER_SHIFT: u32 = 5;
/// The widest layers: 1024 lines, 256 texels.
const MOST_LAYER_SHIFT: u32 = 10;
/// A plan takes at most 1/LATTICE_DIVISOR of the memory budget where more is optional: for a batch with wider layers, beyond its
/// first azimuth; and for separate lattices, with everything allocated before them and the images of bounces.
pub(crate) const LATTICE_DIVISOR: u64 = 8;

/// Memory for lattices, by axis: marching columns, rows.
pub(crate) struct Room {
    /// In total; enough for one azimuth.
    pub lattice_bytes: [u64; 2],
    /// Per layer.
    pub layer_bytes: [u64; 2],
    pub layer_shift: u32,
}

/// Cuts sorted azimuths, from index `first` of the buffer, into as few batches as fit, and assigns each azimuth its layer. The batches
/// along an axis are of equal size where that takes no more of them: a last batch of one azimuth would hardly use a GPU, and the
/// largest batch decides how much memory a lattice takes that all share.
///
/// Also returns whether layers alone ended a batch early: with more lines in each, it would have been longer.
///
/// # Errors
/// A single azimuth does not fit on the device.
pub(crate) fn cut(
    azimuths: &mut [Azimuth],
    first: u32,
    axes: &[Option<Axis>; 2],
    sweep: &Sweep,
    limits: &Limits,
    room: &Room,
) -> Result<(Vec<Batch>, bool)> {
    let mut cut = |most| cut_at(azimuths, first, axes, sweep, limits, (room, most));
    let all = [sweep.azimuths_together(); 2];
    let (fewest, lacks_layers) = cut(all)?;
    let most = [false, true].map(|marches_rows| {
        let along = fewest.iter().filter(|b| b.axis.marches_rows == marches_rows);
        let (count, batches) = along.fold((0, 0), |(n, k), b| (n + b.count, k + 1));
        if batches > 1 { u32::div_ceil(count, batches) } else { all[0] }
    });
    let (even, _) = cut(most)?;
    if even.len() == fewest.len() {
        return Ok((even, lacks_layers));
    }
    cut(all)
}

/// The same with at most so many azimuths in a batch, along columns and along rows.
fn cut_at(
    azimuths: &mut [Azimuth],
    first: u32,
    axes: &[Option<Axis>; 2],
    sweep: &Sweep,
    limits: &Limits,
    (room, most): (&Room, [u32; 2]),
) -> Result<(Vec<Batch>, bool)> {
    let mut batches: Vec<Batch> = Vec::new();
    let mut lacks_layers = false;
    for (i, azimuth) in azimuths.iter_mut().enumerate() {
        let marches_rows = usize::from(azimuth.marches_rows());
        let axis = axes[marches_rows].expect("an axis for every azimuth");
        let layer_bytes = room.layer_bytes[marches_rows];
        let most_bytes = room.lattice_bytes[marches_rows].min(limits.allocation_bytes);
        let most_layers = most_bytes / layer_bytes.max(1);
        let most_layers = u64::from(limits.image_layers).min(most_layers) as u32;
        let layers = sweep.layers(azimuth, axis, room.layer_shift);
        if layers > most_layers {
            let [cols, rows] = axis.size();
            let what = format!("horizons of one azimuth of a {cols} × {rows} field");
            let bytes = u64::from(layers) * layer_bytes;
            let (needs, limit) = if layers > limits.image_layers {
                (
                    format!("an image of {layers} layers"),
                    format!("{} on this device", limits.image_layers),
                )
            } else {
                let limit = bytes_text(limits.allocation_bytes);
                (bytes_text(bytes), format!("{limit} in one allocation on this device"))
            };
            return Err(Error::Limit { what, needs, limit });
        }
        let fits = batches.last().is_some_and(|b| {
            let together = b.axis == axis && b.count < most[marches_rows];
            // What layers of 32 lines hold always fits; more than that only in this share of the memory budget.
            let bytes = u64::from(b.layers + layers) * layer_bytes;
            let is_small = bytes <= limits.memory_budget / LATTICE_DIVISOR;
            let fits = b.layers + layers <= most_layers;
            lacks_layers |= together && !fits && is_small && bytes <= most_bytes;
            let narrow = u64::from(b.layers + layers) << (room.layer_shift - LAYER_SHIFT);
            together && fits && (is_small || narrow <= u64::from(limits.image_layers))
        });
        if !fits {
            batches.push(Batch {
                axis,
                number: batches.len() as u32,
                first: first + i as u32,
                count: 0,
                along: 0,
                most_lines: 0,
                line_texels: 0,
                layers: 0,
                layer_shift: room.layer_shift,
                is_first: i == 0,
            });
        }
        let batch = batches.last_mut().expect("one was pushed if there was none");
        azimuth.layer = batch.layers;
        batch.layers += layers;
        batch.count += 1;
        batch.along += u32::from(azimuth.follows_diagonals());
        batch.most_lines = batch.most_lines.max(sweep.lines(azimuth, axis));
        batch.line_texels += sweep.line_texels(azimuth, axis);
    }
    Ok((batches, lacks_layers))
}

/// Layers that a sweep writes: formats, width and height. Their number follows from the batches.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct LatticeShape {
    pub occluders: Option<Format>,
    pub slopes: Option<Format>,
    pub width: u32,
    pub height: u32,
}

impl LatticeShape {
    pub(crate) fn of(sweep: &Sweep, axis: Axis, nodes: Nodes, layer_shift: u32) -> Self {
        let [lanes, steps] = nodes.size([axis.lanes, axis.steps]);
        match sweep {
            Sweep::Lines(lines) => Self {
                occluders: lines.writes_occluders.then_some(Format::Rgba16Uint),
                slopes: match lines.slope_format {
                    1 => Some(Format::Rgba32Uint),
                    2 => Some(Format::Rgba16Uint),
                    _ => None,
                },
                width: 1 << layer_shift >> 2,
                height: axis.steps + axis.warm_up,
            },
            Sweep::Crossings => Self { occluders: None, slopes: None, width: 1, height: 1 },
            Sweep::Surface { .. } | Sweep::March { .. } | Sweep::Pyramid(_) => {
                Self { occluders: None, slopes: Some(Format::R32Uint), width: lanes, height: steps }
            }
        }
    }

    /// Of a layer's lost lines: a word for each four lines.
    pub(crate) fn lost_bytes(&self) -> u64 {
        4 * u64::from(self.width)
    }

    pub(crate) fn layer_bytes(&self) -> u64 {
        let texels = u64::from(self.width) * u64::from(self.height);
        [self.occluders, self.slopes].iter().flatten().map(|f| f.bytes() * texels).sum()
    }
}

/// Lists with lattices of one kind.
pub(crate) struct Group<'a> {
    members: Vec<usize>,
    sweep: &'a Sweep,
    /// Shapes of the lattices along each axis: one shape for both, used in turn, where that takes no more than one for each.
    pub shapes: [Option<LatticeShape>; 2],
    /// Bytes of the lattice of one azimuth: the largest along each axis.
    least: [u64; 2],
    /// Layers of one azimuth: the most.
    most_layers: u32,
    /// Bytes of the lattices of all azimuths, along each axis.
    all: [u64; 2],
    /// Whether each axis has a lattice of its own.
    pub is_apart: bool,
    layer_shift: u32,
}

impl<'a> Group<'a> {
    pub(crate) fn of(
        lists: &[Vec<Azimuth>],
        sweep: &'a Sweep,
        axes: &[Option<Axis>; 2],
        (nodes, layer_shift): (Nodes, u32),
        is_member: impl Fn(usize) -> bool,
    ) -> Self {
        let members: Vec<usize> = (0..lists.len()).filter(|l| is_member(*l)).collect();
        let own =
            axes.map(|axis| axis.map(|axis| LatticeShape::of(sweep, axis, nodes, layer_shift)));
        let mut group = Self {
            members,
            sweep,
            shapes: own,
            least: [0; 2],
            most_layers: 0,
            all: [0; 2],
            is_apart: false,
            layer_shift,
        };
        group.measure(lists, axes);
        let [Some(a), Some(b)] = own else { return group };
        let apart = group.least;
        let both =
            LatticeShape { width: a.width.max(b.width), height: a.height.max(b.height), ..a };
        group.shapes = [Some(both); 2];
        group.measure(lists, axes);
        if group.least[0].max(group.least[1]) > apart[0] + apart[1] {
            group.shapes = own;
            group.is_apart = a != b;
            group.measure(lists, axes);
        }
        group
    }

    fn layer_bytes(&self) -> [u64; 2] {
        self.shapes.map(|shape| shape.map_or(0, |s| s.layer_bytes()))
    }

    fn measure(&mut self, lists: &[Vec<Azimuth>], axes: &[Option<Axis>; 2]) {
        let layer_bytes = self.layer_bytes();
        (self.least, self.all, self.most_layers) = ([0; 2], [0; 2], 0);
        for azimuth in self.members.iter().flat_map(|m| &lists[*m]) {
            let along = usize::from(azimuth.marches_rows());
            let axis = axes[along].expect("an axis for every azimuth");
            let bytes =
                u64::from(self.sweep.layers(azimuth, axis, self.layer_shift)) * layer_bytes[along];
            self.least[along] = self.least[along].max(bytes);
            self.all[along] += bytes;
        }
    }

    /// Bytes of `budget` for the lattice along each axis: all of it for one that both use in turn, else what one azimuth needs, and
    /// the rest by what the others need.
    fn shares(&self, budget: u64) -> [u64; 2] {
        if !self.is_apart {
            return [budget; 2];
        }
        let rest = u128::from(budget - self.least_bytes().min(budget));
        let others = [0, 1].map(|i| u128::from(self.all[i] - self.least[i]));
        let all_others = (others[0] + others[1]).max(1);
        [0, 1].map(|i| self.least[i] + (rest * others[i] / all_others) as u64)
    }

    /// Bytes of the lattices of all azimuths.
    pub(crate) fn all_bytes(&self) -> u64 {
        self.all[0] + self.all[1]
    }

    /// Bytes of the lattices with one azimuth each.
    fn least_bytes(&self) -> u64 {
        let [a, b] = self.least;
        if self.is_apart { a + b } else { a.max(b) }
    }
}

/// Groups of lists, and the batches of each list.
pub(crate) type Cut<'a> = ([Group<'a>; 2], Vec<Vec<Batch>>);

/// Numbers the azimuths of each list (`horizon_layer`), sorts them by octant, axis by axis, then groups the lists and cuts them into batches. A layer holds 32 lines. It holds more if one azimuth needs more
/// layers than an image allows and, on a GPU, if layers alone would end a batch early: at 8192² on an H100 a sweep took 3 ms with
/// one azimuth and 4 ms with seven. `fixed_bytes` are taken in any case.
pub(crate) fn cut_groups<'a>(
    lists: &mut [Vec<Azimuth>],
    fixed_bytes: u64,
    axes: &[Option<Axis>; 2],
    grouped: impl Fn(&[Vec<Azimuth>], u32) -> [Group<'a>; 2],
    limits: &Limits,
) -> Result<Cut<'a>> {
    for list in lists.iter_mut() {
        for (layer, azimuth) in (0..).zip(list.iter_mut()) {
            azimuth.horizon_layer = layer;
        }
        // Azimuths of one octant share neighbours, so they go next to each other. Of an axis, those along the cells' diagonals come first:
        // shading has a loop for them.
        list.sort_by_key(Azimuth::octant);
    }
    // The cut so far with the fewest batches, and its lists.
    let mut best: Option<(Cut, Vec<Vec<Azimuth>>)> = None;
    for layer_shift in LAYER_SHIFT..=MOST_LAYER_SHIFT {
        let groups = grouped(lists, layer_shift);
        let is_widest = layer_shift == MOST_LAYER_SHIFT;
        if groups.iter().any(|g| g.most_layers > limits.image_layers) && !is_widest {
            continue;
        }
        let (batches, lacks_layers) = match cut_all(lists, fixed_bytes, axes, &groups, limits) {
            Ok(cut) => cut,
            Err(error) if best.is_none() => return Err(error),
            Err(_) => break,
        };
        let count = |batches: &[Vec<Batch>]| batches.iter().flatten().count();
        if best.as_ref().is_some_and(|((_, fewest), _)| count(fewest) <= count(&batches)) {
            break;
        }
        best = Some(((groups, batches), lists.to_vec()));
        if limits.is_cpu || !lacks_layers {
            break;
        }
    }
    let (cut, cut_lists) = best.expect("the widest layers are cut or fail");
    lists.clone_from_slice(&cut_lists);
    Ok(cut)
}

fn cut_all(
    lists: &mut [Vec<Azimuth>],
    fixed_bytes: u64,
    axes: &[Option<Axis>; 2],
    groups: &[Group<'_>; 2],
    limits: &Limits,
) -> Result<(Vec<Vec<Batch>>, bool)> {
    let [least, of_suns] = [0, 1].map(|g: usize| groups[g].least_bytes());
    let all = least + of_suns;
    if fixed_bytes + all > limits.memory_budget {
        let [cols, rows] = axes.iter().flatten().next().map_or([0, 0], |axis| axis.size());
        return Err(Error::Limit {
            what: format!("horizons of one azimuth of a {cols} × {rows} field"),
            needs: format!("{} in total", bytes_text(fixed_bytes + all)),
            limit: format!("{} of `memory_budget`", bytes_text(limits.memory_budget)),
        });
    }
    let budget = limits.memory_budget - fixed_bytes;
    // Suns take what all of them need, at most their share of it.
    let share = u128::from(budget) * u128::from(of_suns) / u128::from(all.max(1));
    let for_suns = (share as u64).min(groups[1].all_bytes().max(of_suns));
    let budgets = [budget - for_suns, for_suns];
    let mut batches: Vec<Vec<Batch>> = vec![Vec::new(); lists.len()];
    let mut firsts = Vec::new();
    let mut lacks_layers = false;
    for list in lists.iter() {
        firsts.push(firsts.last().copied().unwrap_or(0) + list.len() as u32);
    }
    for (group, budget) in groups.iter().zip(budgets) {
        let lattice_bytes = group.shares(budget);
        let layer_shift = group.layer_shift;
        let room = Room { lattice_bytes, layer_bytes: group.layer_bytes(), layer_shift };
        for &l in &group.members {
            let first = firsts[l] - lists[l].len() as u32;
            let (cut, lacks) = cut(&mut lists[l], first, axes, group.sweep, limits, &room)?;
            batches[l] = cut;
            lacks_layers |= lacks;
        }
    }
    for (number, batch) in batches.iter_mut().flatten().enumerate() {
        batch.number = number as u32;
    }
    Ok((batches, lacks_layers))
}
