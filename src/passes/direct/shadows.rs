//! Suns by shadow heights: a texel that these prove to see all of a sun is lit at once, the others by their exact horizons.

use crate::graph::{Axis, Builder, Format, Limits, Owner, ResourceId};
use crate::passes::azimuths::Azimuth;
use crate::passes::batch::Batch;
use crate::passes::blocks::{BlockLevels, Source};
use crate::passes::shadow_sweep;
use crate::passes::sweep::{Sweep, has_sweep_defaults, shadows_by_one_line};
use crate::passes::sweeping::Sweeping;
use crate::scene::{Border, HeightField, KeyLight, Method, Quality};

/// What the passes of suns share, besides the lattices.
pub(crate) struct Shadows {
    /// Marks of the texels whose light the shadow heights leave open, along columns and along rows.
    doubtful: [Option<ResourceId>; 2],
    /// Whether an invocation of the sweep marches one line instead of four.
    one_line: bool,
    /// Slices of a light.
    slices: u32,
    pub limits: Limits,
    pub levels: BlockLevels,
    /// For each of the lights, the maxima of blocks over a plane that rises with its light; none for others.
    maxima: Vec<Option<ResourceId>>,
}

/// Bytes per texel that suns need at least: marks along both axes, the maxima of blocks, the lattice of one azimuth; and, where an
/// invocation marches one line, the heights along both axes in buffers.
const TEXEL_BYTES: u64 = 2 + 1 + 8;
const BUFFERS_BYTES: u64 = 8;

impl Shadows {
    /// Whether suns may use shadow heights; otherwise the reason, with `method auto`.
    pub(crate) fn suit(
        quality: &Quality,
        sweep: &Sweep,
        field: &HeightField,
        border: Border,
        (limits, used_bytes): (&Limits, u64),
    ) -> Result<(), Option<String>> {
        let size = [field.cols() as u32, field.rows() as u32];
        if quality.method != Method::Auto || !matches!(sweep, Sweep::Lines(_)) || size.contains(&1)
        {
            return Err(None);
        }
        if !has_sweep_defaults(quality) {
            let reason = "exact shadows need the defaults of `lines` and `precision`";
            return Err(Some(reason.into()));
        }
        let maxima = BlockLevels::of(size, border).maxima_size();
        if maxima.iter().any(|n| *n > limits.image_side) {
            return Err(Some("an image of the field's blocks exceeds the device's limit".into()));
        }
        let buffers = if shadows_by_one_line(size, limits) { BUFFERS_BYTES } else { 0 };
        let bytes = (TEXEL_BYTES + buffers) * u64::from(size[0]) * u64::from(size[1]);
        if used_bytes + bytes > limits.memory_budget / 2 {
            return Err(Some(format!(
                "exact shadows would take {} more memory",
                crate::graph::bytes_text(bytes)
            )));
        }
        Ok(())
    }

    /// Whether a key light is narrow enough: of a tall one most texels see a part, and each of them walks.
    pub(crate) fn suits(key: &KeyLight) -> bool {
        let [low, high] = key.elevations_rad;
        high - low <= TALLEST.to_radians()
    }

    /// Makes the images for these of `lights` suns and key lights, along the axes of `azimuths`.
    pub(crate) fn make<'a>(
        builder: &mut Builder,
        azimuths: impl Iterator<Item = &'a Azimuth> + Clone,
        (size, border): ([u32; 2], Border),
        (which, lights): (&[usize], usize),
        (slices, limits): (u32, &Limits),
    ) -> Self {
        let doubtful = [false, true].map(|marches_rows| {
            azimuths.clone().any(|a| a.marches_rows() == marches_rows).then(|| {
                let axis = Axis::of(marches_rows, size, border);
                let extent = [axis.lanes.div_ceil(4), axis.steps, 1];
                let name = format!("doubtful_{}", axis.name());
                builder.image(name, Owner::Internal, Format::R32Uint, extent, false)
            })
        });
        let levels = BlockLevels::of(size, border);
        let mut made = |i| levels.maxima(builder, &format!("shadow_maxima_{i}"));
        let maxima = (0..lights).map(|i| which.contains(&i).then(|| made(i))).collect();
        Self {
            doubtful,
            one_line: shadows_by_one_line(size, limits),
            slices,
            limits: *limits,
            levels,
            maxima,
        }
    }

    /// Marks along an axis.
    pub(crate) fn doubtful(&self, axis: Axis) -> ResourceId {
        self.doubtful[usize::from(axis.marches_rows)].expect("made for every axis of a sun")
    }

    /// The sweep of a batch.
    pub(crate) fn plan_sweep(
        &self,
        builder: &mut Builder,
        sweeping: &Sweeping,
        batch: &Batch,
        part: &str,
    ) {
        let lane_buffer = sweeping.lanes(batch).buffer.filter(|_| self.one_line);
        let heights = match lane_buffer {
            Some(buffer) => ("lane_buffer", buffer),
            None => ("lane_heights", sweeping.lane_heights(batch)),
        };
        let ids = [sweeping.azimuths, sweeping.written(batch)];
        shadow_sweep::plan(builder, batch, part, (self.slices, &self.limits), heights, ids);
    }

    /// The maxima of blocks for walks towards the light at `index`, which skip most of the ground under its light: over a plane
    /// that rises with its lower edge.
    pub(crate) fn plan_maxima(
        &self,
        builder: &mut Builder,
        (part, index): (&str, usize),
        (aim, cell_m): (Aim, [f64; 2]),
        heights: ResourceId,
    ) -> Walked {
        let slope = aim.low_rad.tan().clamp(-1.0, MOST_TILT);
        let (sin, cos) = aim.azimuth_rad.sin_cos();
        let tilt = [-slope * cos * cell_m[0], slope * sin * cell_m[1]].map(|t| t as f32);
        let maxima = self.maxima[index].expect("made for every light by shadow heights");
        self.levels.plan(builder, part, Source::Heights { heights, tilt }, maxima);
        Walked { maxima, tilt }
    }
}

/// Where a sun or a key light is.
#[derive(Clone, Copy)]
pub(crate) struct Aim {
    /// Of its middle, counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of its lower edge.
    pub low_rad: f64,
}

/// Blocks of cells that walks towards one sun skip.
#[derive(Clone, Copy)]
pub(crate) struct Walked {
    pub maxima: ResourceId,
    pub tilt: [f32; 2],
}

/// Degrees of elevation that a key light may span.
const TALLEST: f64 = 5.0;

/// Above it the plane has fewer digits left for the heights.
const MOST_TILT: f64 = 10.0;
