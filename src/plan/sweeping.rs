use super::azimuths::{self, Azimuth};
use super::batch::{self, Axis, Batch};
use super::sweep::{HullPlace, LineSweep, Sweep};
use super::{Builder, Format, Limits, Owner, ResourceId};
use crate::scene::{Border, HeightField, Lines, Method, Quality};
use crate::{Result, passes};

/// What every sweep of a plan shares.
pub(super) struct Sweeping {
    pub sweep: Sweep,
    heights: ResourceId,
    pub azimuths: ResourceId,
    /// Heights by lanes of each axis that is marched: columns', rows'.
    lane_heights: [Option<ResourceId>; 2],
    /// Whether the sweep reads its heights from them too, four lanes at a time.
    quads: bool,
    pub lattice: ResourceId,
    /// Where both are stored, the one that is not the lattice.
    occluders: Option<ResourceId>,
    slopes: Option<ResourceId>,
    lost_lines: Option<ResourceId>,
}

impl Sweeping {
    /// Heights by lanes of a batch's axis.
    pub fn lane_heights(&self, batch: &Batch) -> ResourceId {
        self.lane_heights[usize::from(batch.axis.marches_rows)].expect("made for every axis used")
    }

    pub fn record(&self, builder: &mut Builder, batch: &Batch, part: &str) {
        match &self.sweep {
            Sweep::Lines(lines) => {
                let images = passes::horizon_sweep::Images {
                    heights: self.heights,
                    lane_heights: self.quads.then(|| self.lane_heights(batch)),
                    azimuths: self.azimuths,
                    occluders: self.occluders,
                    slopes: self.slopes,
                    lost_lines: self.lost_lines,
                };
                passes::horizon_sweep::plan(builder, lines, batch, part, &images);
            }
            Sweep::Surface { hull_depth, distances } => {
                let ids = [self.heights, self.azimuths, self.lattice];
                passes::surface_sweep::plan(builder, batch, part, *hull_depth, *distances, ids);
            }
            Sweep::March { distances } => {
                let ids = [self.heights, self.azimuths, self.lattice];
                passes::horizon_march::plan(builder, batch, part, *distances, ids);
            }
        }
    }
}

/// Azimuth lists, one a light, in the order of the buffer; and how they are cut.
pub(super) struct Lists {
    pub lists: Vec<Vec<Azimuth>>,
    pub batches: Vec<Vec<Batch>>,
}

/// Layers that a sweep writes: their formats, width and height; their number is the batches'.
struct LatticeShape {
    occluders: Option<Format>,
    slopes: Option<Format>,
    width: u32,
    height: u32,
}

impl LatticeShape {
    fn of(sweep: &Sweep, axes: &[Option<Axis>; 2]) -> Self {
        let used = || axes.iter().flatten();
        match sweep {
            Sweep::Lines(lines) => Self {
                occluders: lines.writes_occluders.then_some(Format::Rg32Uint),
                slopes: match lines.slope_format {
                    1 => Some(Format::Rgba32Uint),
                    2 => Some(Format::Rg32Uint),
                    _ => None,
                },
                width: 8,
                height: used().map(|a| a.steps + a.warm_up).max().unwrap_or(1),
            },
            Sweep::Surface { .. } | Sweep::March { .. } => Self {
                occluders: None,
                slopes: Some(Format::R32Uint),
                width: used().map(|a| a.lanes).max().unwrap_or(1),
                height: used().map(|a| a.steps).max().unwrap_or(1),
            },
        }
    }

    fn layer_bytes(&self) -> u64 {
        let texels = u64::from(self.width) * u64::from(self.height);
        [self.occluders, self.slopes].iter().flatten().map(|f| f.bytes() * texels).sum()
    }
}

/// Makes the sweep's own images, within what the budget leaves, and cuts the lists into batches.
pub(super) fn prepare(
    builder: &mut Builder,
    field: &HeightField,
    border: Border,
    sweep: Sweep,
    heights: ResourceId,
    mut lists: Vec<Vec<Azimuth>>,
    limits: &Limits,
) -> Result<(Sweeping, Lists)> {
    let size = [field.cols() as u32, field.rows() as u32];
    let count: usize = lists.iter().map(Vec::len).sum();
    let azimuths = builder.buffer("azimuths", (count * size_of::<Azimuth>()) as u64, true);
    let axes = [false, true].map(|marches_rows| {
        let used = lists.iter().flatten().any(|a| a.marches_rows() == marches_rows);
        used.then(|| Axis::of(marches_rows, size, border))
    });
    let lane_heights = axes.map(|axis| axis.map(|axis| lane_image(builder, axis)));
    let shape = LatticeShape::of(&sweep, &axes);
    let batches = cut_lists(&mut lists, builder.bytes(), &shape, size, border, &sweep, limits)?;
    let layers = batches.iter().flatten().map(|b| b.layers).max().unwrap_or(1);
    let extent = [shape.width, shape.height, layers];
    let mut make = |name: &str, format: Option<Format>| {
        format.map(|f| builder.image(name, Owner::Internal, f, extent, true))
    };
    let occluders = make("lattice_occluders", shape.occluders);
    let slopes = make("lattice_slopes", shape.slopes);
    let lattice = slopes.or(occluders).expect("a sweep stores something");
    let can_lose =
        matches!(&sweep, Sweep::Lines(l) if !l.holds_line && l.hull != HullPlace::Occluders);
    let lost_lines = can_lose.then(|| builder.buffer("lost_lines", u64::from(layers) * 32, false));
    for (axis, lanes) in axes.iter().zip(lane_heights) {
        if let (Some(axis), Some(lanes)) = (axis, lanes) {
            passes::height_transpose::plan(builder, *axis, border, heights, lanes);
        }
    }
    // Lines a cell apart pass four neighbouring lanes alike.
    let quads = matches!(sweep, Sweep::Lines(LineSweep { line_shift: 15, .. }))
        && border != Border::Periodic;
    let sweeping = Sweeping {
        sweep,
        heights,
        azimuths,
        lane_heights,
        quads,
        lattice,
        occluders,
        slopes,
        lost_lines,
    };
    Ok((sweeping, Lists { lists, batches }))
}

/// The image of heights by lanes of an axis.
fn lane_image(builder: &mut Builder, axis: Axis) -> ResourceId {
    let extent = [axis.lanes.div_ceil(4), axis.steps, 1];
    let name = format!("lane_heights_{}", axis.name());
    builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false)
}

/// Sorts every list and cuts it into batches; `fixed_bytes` are taken whatever the cut.
fn cut_lists(
    lists: &mut [Vec<Azimuth>],
    fixed_bytes: u64,
    shape: &LatticeShape,
    size: [u32; 2],
    border: Border,
    sweep: &Sweep,
    limits: &Limits,
) -> Result<Vec<Vec<Batch>>> {
    let bytes = (fixed_bytes, shape.layer_bytes());
    let mut batches = Vec::new();
    let mut first = 0;
    for list in lists {
        batch::sort(list);
        batches.push(batch::cut(list, first, size, border, sweep, limits, bytes)?);
        first += list.len() as u32;
    }
    Ok(batches)
}

/// The part of a pass for one of the batches of a light.
pub(super) fn part(light: &str, batch: &Batch, batches: &[Batch]) -> String {
    match batches {
        [_] => light.to_owned(),
        _ => format!("{light} {}+{}", batch.first, batch.count).trim().to_owned(),
    }
}

/// Even azimuths, or the grid vectors near them.
pub(super) fn circle(quality: &Quality, sweep: &Sweep, cell_m: [f64; 2]) -> Vec<Azimuth> {
    match sweep {
        Sweep::Surface { .. } => azimuths::along_grid_vectors(quality.azimuths, cell_m),
        _ => azimuths::even(quality.azimuths, cell_m),
    }
}

/// The azimuths that [`horizons`](super::horizons()) sweeps for a quality, radians counter-clockwise
/// from east: 2πk/M, or in exact mode the grid vectors' own.
pub fn circle_rad(quality: &Quality, cell_m: [f64; 2]) -> Vec<f64> {
    let count = quality.azimuths;
    match (quality.method, quality.lines) {
        (Method::Auto | Method::Sweep, Lines::Exact) => azimuths::along_grid_vectors(count, cell_m)
            .iter()
            .map(|a| a.swept_rad(cell_m).rem_euclid(std::f64::consts::TAU))
            .collect(),
        _ => (0..count).map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(count)).collect(),
    }
}

/// The settings really used, for metadata and messages.
pub(super) fn settings(quality: &Quality, sweep: &Sweep, border: Border) -> Vec<(String, String)> {
    let mut all = vec![("border".to_owned(), format!("{border:?}").to_lowercase())];
    let mut add = |name: &str, value: String| all.push((name.to_owned(), value));
    match sweep {
        Sweep::Lines(lines) => {
            add("method", "sweep".into());
            add("lines", Lines::name(quality.lines).into());
            add("fuse", quality.fuse.name().into());
            add("hull", format!("{:?}", lines.hull).to_lowercase());
            add("hull_depth", lines.hull_depth.to_string());
            add("precision", quality.precision.name().into());
        }
        Sweep::Surface { .. } => {
            add("method", "sweep".into());
            add("lines", "exact".into());
        }
        Sweep::March { .. } => add("method", "brute".into()),
    }
    all
}
