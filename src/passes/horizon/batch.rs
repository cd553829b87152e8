use crate::graph::Limits;
use crate::graph::{Axis, bytes_text};
use crate::passes::azimuths::Azimuth;
use crate::passes::sweep;
use crate::passes::sweep::Sweep;
use crate::scene::Border;
use crate::{Error, Result};

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
    /// Lines of the azimuth with the most lines.
    pub most_lines: u32,
    /// Points on all lines.
    pub line_texels: u64,
    /// Layers of the lattice.
    pub layers: u32,
    /// Whether it is the light's first: its sum begins here.
    pub is_first: bool,
}

impl Batch {
    /// Their indices in the buffer "azimuths".
    pub(crate) fn azimuths(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.count
    }
}

/// Sorts azimuths by octant, axis by axis, so that directions with shared neighbours are together. Returns the
/// order as indices into the given list.
pub(crate) fn sort(azimuths: &mut Vec<Azimuth>) -> Vec<u32> {
    let mut order: Vec<u32> = (0..azimuths.len() as u32).collect();
    order.sort_by_key(|&k| azimuths[k as usize].octant());
    *azimuths = order.iter().map(|&k| azimuths[k as usize]).collect();
    order
}

/// Memory for lattices, by axis: marching columns, rows.
pub(crate) struct Room {
    /// In total; enough for one azimuth.
    pub lattice_bytes: [u64; 2],
    /// Per layer.
    pub layer_bytes: [u64; 2],
}

/// Cuts sorted azimuths, from index `first` of the buffer, into batches whose lattices fit, and assigns each
/// azimuth its layer.
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
) -> Result<Vec<Batch>> {
    let mut batches: Vec<Batch> = Vec::new();
    for (i, azimuth) in azimuths.iter_mut().enumerate() {
        let marches_rows = usize::from(azimuth.marches_rows());
        let axis = axes[marches_rows].expect("an axis for every azimuth");
        let layer_bytes = room.layer_bytes[marches_rows];
        let bytes = room.lattice_bytes[marches_rows].min(limits.allocation_bytes);
        let most_layers = u64::from(limits.image_layers).min(bytes / layer_bytes.max(1)) as u32;
        let layers = sweep.layers(azimuth, axis);
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
        let fits =
            batches.last().is_some_and(|b| b.axis == axis && b.layers + layers <= most_layers);
        if !fits {
            batches.push(Batch {
                axis,
                number: batches.len() as u32,
                first: first + i as u32,
                count: 0,
                most_lines: 0,
                line_texels: 0,
                layers: 0,
                is_first: i == 0,
            });
        }
        let batch = batches.last_mut().expect("one was pushed if there was none");
        azimuth.layer = batch.layers;
        batch.layers += layers;
        batch.count += 1;
        batch.most_lines = batch.most_lines.max(sweep.lines(azimuth, axis));
        batch.line_texels += sweep.line_texels(azimuth, axis);
    }
    Ok(batches)
}
