//! Chooses how horizons are found: the form of the sweep, its storage and its cost.

use crate::graph::{Axis, Builder, Limits, ResourceId, SweepForm};
use crate::passes::azimuths::{Azimuth, CELL};
use crate::passes::pyramid::Pyramid;
use crate::scene::{Border, Fuse, HeightField, Hull, Lines, Method, Precision, Quality};
use crate::{Error, Result};

/// Where a line's hull is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HullStorage {
    /// Private memory of the invocation.
    Private = 0,
    /// Shared memory of the workgroup.
    Shared = 1,
    /// The list of stored occluders.
    Occluders = 2,
}

impl HullStorage {
    /// As the command line spells it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            HullStorage::Private => "private",
            HullStorage::Shared => "shared",
            HullStorage::Occluders => "occluder-list",
        }
    }
}

/// A hull sweep along lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineSweep {
    /// Where the hull is stored.
    pub hull: HullStorage,
    /// Entries per line there; a power of two.
    pub hull_depth: u32,
    /// Entries per line in private memory if an invocation sweeps one line: all of them, or those beyond shared memory; else 0.
    pub private_depth: u32,
    /// Whether the storage holds every point of the longest line.
    pub holds_line: bool,
    /// Whether entries are packed as f16 height and u16 distance.
    pub packed: bool,
    /// Factor that scales heights to [-1..1] for packed entries.
    pub height_scale: f32,
    /// Lines are 2^shift / 32768 cells apart.
    pub line_shift: u32,
    /// Invocations per workgroup.
    pub group_size: u32,
    /// Lines that an invocation sweeps: four, or one.
    pub lines_each: u32,
    /// Stored slopes: 0 none, 1 f32, 2 f16.
    pub slope_format: u32,
    /// Whether occluders are stored.
    pub writes_occluders: bool,
    /// How results of lines come back to grid points.
    pub fuse: Fuse,
    /// Azimuths that are swept together at most.
    pub azimuths: u32,
    /// Whether the lattice has room for the azimuth with the most lines, so that a light that turns keeps its size.
    pub any_azimuth: bool,
}

impl LineSweep {
    /// Lines of a workgroup.
    pub(crate) fn group_lines(&self) -> u32 {
        self.lines_each * self.group_size
    }

    /// The line spacing in use; a periodic field may not allow the requested one.
    pub(crate) fn spacing(&self) -> Lines {
        let all = [Lines::QuarterCell, Lines::HalfCell, Lines::TwoCells, Lines::FourCells];
        all.into_iter().find(|l| l.shift() == Some(self.line_shift)).unwrap_or(Lines::Cell)
    }

    /// The precision in use, which may be higher than requested.
    pub(crate) fn precision(&self) -> Precision {
        match (self.packed, self.slope_format) {
            (true, _) => Precision::Packed,
            (false, 2) => Precision::F16,
            (false, _) => Precision::F32,
        }
    }
}

/// The hull of exact sweeps: every crossing of every line, in private memory where that is large enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceHull {
    /// Entries per line.
    pub depth: u32,
    /// Lines whose entries fit a buffer; set if the hull is there.
    pub lines_at_once: Option<u32>,
}

impl SurfaceHull {
    /// Of lines with so many steps, each with up to four crossings.
    pub(crate) fn of(steps: u32, limits: &Limits) -> Self {
        let depth = 4 * steps;
        let bytes = HULL_BYTES.min(limits.buffer_bytes).min(limits.memory_budget / 16);
        let fit = (bytes / (VERTEX_BYTES * u64::from(depth))) as u32;
        let fit = (fit / SURFACE_GROUP_SIZE * SURFACE_GROUP_SIZE).max(SURFACE_GROUP_SIZE);
        let is_private = limits.is_cpu || depth <= GPU_PRIVATE_ENTRIES;
        Self { depth, lines_at_once: (!is_private).then_some(fit) }
    }

    /// Makes its buffer, if it has one.
    pub(crate) fn buffer(self, builder: &mut Builder) -> Option<ResourceId> {
        let bytes = VERTEX_BYTES * u64::from(self.depth) * u64::from(self.lines_at_once?);
        Some(builder.buffer("hull_buffer", bytes, false))
    }
}

/// How horizons are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sweep {
    /// Hull sweeps along lines of even azimuths.
    Lines(LineSweep),
    /// Exact hull sweeps along grid vectors.
    Surface {
        hull: SurfaceHull,
        /// Whether distances are stored beside slopes.
        distances: bool,
    },
    /// No sweep: on a concave field the horizon is the first crossing of a grid point's own line.
    Crossings,
    /// Brute force: all crossings.
    March {
        /// Whether distances are stored beside slopes.
        distances: bool,
    },
    /// Marches over a height pyramid.
    Pyramid(Pyramid),
}

/// Columns or rows of a periodic field that are marched before the period whose horizons are kept. Whole
/// periods: two or more, and as many as make 512.
///
/// Farther ground is not found: the error is at most atan(relief / their length).
pub fn warm_up(steps: u32) -> u32 {
    LEAST_WARM_UP.div_ceil(steps).max(2) * steps
}

/// A tile of 16 cells that is as high as it is wide is missed only where it would rise by a slope of 16/512 at
/// most: sin² of that angle, 0.1 % of the sky's light on level ground. Two periods alone would miss a slope of
/// 1/2.
const LEAST_WARM_UP: u32 = 512;

// Half as many entries of private memory for each of four lines.
const GPU_PRIVATE_DEPTH: u32 = 32;
/// Invocations of a workgroup of exact sweeps, each of one line.
pub(crate) const SURFACE_GROUP_SIZE: u32 = 8;
/// A vertex: height, whole step and fraction, f32 each.
const VERTEX_BYTES: u64 = 12;
/// Largest hull buffer; a sixteenth of the memory budget and the largest buffer also limit it.
const HULL_BYTES: u64 = 1 << 30;
/// Vertices in private memory on a GPU: pipeline creation fails on an NVIDIA H200 (driver 580) with 2,048.
const GPU_PRIVATE_ENTRIES: u32 = 1024;
// A step has up to four crossings; llvmpipe ends any loop after 65,535 iterations.
const SURFACE_STEPS_LIMIT: u32 = 4096;
const MARCH_STEPS_LIMIT: u32 = 65_000;

/// Whether a quality leaves the choice of exact shadows to the planner. They do not depend on the fuse.
pub(crate) fn has_sweep_defaults(quality: &Quality) -> bool {
    let of = |q: &Quality| (q.method, q.lines, q.precision);
    of(quality) == of(&Quality::default())
}

/// Whether the heights of a field fit a buffer, from which an invocation sweeps one line.
pub(crate) fn fit_buffer(sides: [u32; 2], limits: &Limits) -> bool {
    let [width, height] = sides.map(|side| u64::from(side.next_multiple_of(4)));
    4 * width * height <= limits.buffer_bytes
}

/// Whether an invocation of shadow_sweep marches one line instead of four.
pub(crate) fn shadows_by_one_line(sides: [u32; 2], limits: &Limits) -> bool {
    !limits.is_cpu && fit_buffer(sides, limits)
}

/// Invocations of a workgroup that sweep four lines each, or one line of shadow heights.
pub(crate) fn group_size(limits: &Limits) -> u32 {
    if limits.is_cpu { 8 } else { 32 }
}

/// Invocations that keep a GPU busy: an NVIDIA H200 holds twice as many. See "Changes to suns" in benches/results/nvidia_h200.md, as for
/// the next two.
const BUSY_INVOCATIONS: u32 = 1 << 17;
/// With 32 segments the sweeps of 1024² took 0.164 ms, with 16 0.153 ms.
const MOST_SEGMENTS: u32 = 16;
/// Of so many lines segments are of no use: at 4096² one and eight took the same time.
const ENOUGH_LINES: u32 = 1 << 15;

/// Segments per line of shadow heights, a power of two. More than one only where the lines do not fill a GPU, because a cut line is
/// marched twice. `lines`: lines per dispatch, at most. `group_lines`: lines per workgroup. `segment_bytes`: shared memory of one segment of
/// those lines.
pub(crate) fn line_segments(
    lines: u32,
    group_lines: u32,
    segment_bytes: u32,
    limits: &Limits,
) -> u32 {
    if limits.is_cpu || lines >= ENOUGH_LINES {
        return 1;
    }
    // Half of the shared memory, so that two workgroups fit.
    let fit = limits.shared_bytes / 2 / segment_bytes;
    let most = fit.min(limits.group_invocations / group_lines).min(MOST_SEGMENTS);
    1 << (BUSY_INVOCATIONS / lines).clamp(1, most.max(1)).ilog2()
}

/// Where hulls are stored, and the form of a sweep along lines: the device's, or the nearest one that the settings allow.
fn form_of(
    quality: &Quality,
    sides: [u32; 2],
    stores_slopes: bool,
    limits: &Limits,
) -> (HullStorage, SweepForm) {
    let device = match quality.hull {
        Hull::Auto => limits.sweep,
        _ => limits.untuned_sweep,
    };
    let packed = quality.precision == Precision::Packed;
    // One line per invocation reads heights from a buffer and stores occluders alone.
    let is_one = device.lines_each == 1
        && quality.hull != Hull::OccluderList
        && !stores_slopes
        && !packed
        && fit_buffer(sides, limits);
    let is_four = device.lines_each == 4;
    let place = match quality.hull {
        // With four lines, few workgroups fit shared memory. CPU devices cache private arrays (lavapipe).
        Hull::Auto if device.shares_hull && (is_one || is_four) => HullStorage::Shared,
        Hull::Auto | Hull::Private => HullStorage::Private,
        Hull::Shared => HullStorage::Shared,
        Hull::OccluderList => HullStorage::Occluders,
    };
    let mut form = device;
    if !is_one && !is_four {
        (form.lines_each, form.group_size) = (4, group_size(limits));
        if limits.is_cpu {
            form.hull_depth = SweepForm::of_device(true, false).hull_depth;
        }
    }
    let of_form = [HullStorage::Private, HullStorage::Shared][usize::from(form.shares_hull)];
    let own = place == of_form && form.lines_each == device.lines_each;
    let bytes = form.lines_each * form.group_size * if packed { 4 } else { 8 };
    let entries_in = |shared_bytes: u32| 1 << (shared_bytes / bytes).max(1).ilog2();
    form.hull_depth = match place {
        HullStorage::Private if own => form.hull_depth,
        HullStorage::Private if limits.is_cpu || is_one => form.hull_depth.max(form.private_depth),
        HullStorage::Private => GPU_PRIVATE_DEPTH,
        // Beside the results of four steps of one line per invocation.
        HullStorage::Shared if own => {
            let written = 32 * (1 + form.group_size);
            form.hull_depth.min(entries_in(limits.shared_bytes.saturating_sub(written)))
        }
        // Half of the shared memory, so that two workgroups fit.
        HullStorage::Shared => entries_in(limits.shared_bytes / 2),
        HullStorage::Occluders => 1,
    };
    (place, form)
}

impl Sweep {
    /// Values of the shaders' LATTICE: occluders, and slopes as f32 and as f16. Those of slopes are SLOPE_FORMAT, too.
    pub(crate) const CONTENTS: [u32; 3] = [0, 1, 2];

    /// The shaders' FUSE of lines.
    pub(crate) fn fuse_word(fuse: Fuse) -> u32 {
        1 + fuse as u32
    }

    /// The form for a quality and a device.
    ///
    /// # Errors
    /// Settings that exclude each other, with the reason.
    pub(crate) fn choose(
        field: &HeightField,
        border: Border,
        quality: &Quality,
        limits: &Limits,
        distances: bool,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        let sides = [field.cols() as u32, field.rows() as u32];
        let marched =
            |steps| if border == Border::Periodic { steps + warm_up(steps) } else { steps };
        let total = sides.map(marched).into_iter().max().unwrap_or(1);
        if border == Border::Periodic {
            let [cols, rows] = sides.map(warm_up);
            notes.push(format!(
                "border periodic: no ground is found beyond {cols} columns and {rows} rows; at distance d it would \
                 raise a horizon by atan(relief / d) at most"
            ));
        }
        // Lane positions and steps times shears are integers of 32 bits.
        let marches = matches!(quality.method, Method::Pyramid | Method::BruteForce);
        if marches && total > MARCH_STEPS_LIMIT {
            return Err(Error::Limit {
                what: format!("`method {}`", quality.method),
                needs: format!("{total} steps per grid point"),
                limit: format!("{MARCH_STEPS_LIMIT} steps"),
            });
        }
        if quality.method == Method::Pyramid {
            if distances {
                return Err(Error::setting(
                    "distances to the horizon",
                    "`method pyramid`",
                    "a method that stores occluders: sweep or brute-force",
                ));
            }
            return Ok(Sweep::Pyramid(Pyramid::new(quality, sides, border)));
        }
        if quality.method == Method::BruteForce {
            return Ok(Sweep::March { distances });
        }
        let Some(shift) = quality.lines.shift() else {
            if total > SURFACE_STEPS_LIMIT {
                return Err(Error::Limit {
                    what: "`lines exact`".into(),
                    needs: format!(
                        "{total} steps per line (a periodic field is marched three times at least)"
                    ),
                    limit: format!("{SURFACE_STEPS_LIMIT} steps"),
                });
            }
            let hull = SurfaceHull::of(total, limits);
            return Ok(Sweep::Surface { hull, distances });
        };
        let stores_slopes = matches!(quality.fuse, Fuse::Nearest | Fuse::Slopes);
        let slope_format = match (stores_slopes, quality.precision) {
            (false, Precision::F16) => {
                notes.push(
                    "f16 changes nothing here: this fuse stores u16 steps, not slopes".into(),
                );
                Sweep::CONTENTS[0]
            }
            (false, _) => Sweep::CONTENTS[0],
            (true, Precision::F16) => Sweep::CONTENTS[2],
            (true, _) => Sweep::CONTENTS[1],
        };
        let packed = quality.precision == Precision::Packed;
        if packed {
            field.check_known("`precision packed`", "heights: their largest sets the scale")?;
        }
        let periodic = border == Border::Periodic;
        limits.sweep.check("limits.sweep")?;
        limits.untuned_sweep.check("limits.untuned_sweep")?;
        let (place, form) = form_of(quality, sides, slope_format > 0, limits);
        let wanted = total.next_power_of_two();
        let hull_depth = match place {
            HullStorage::Private | HullStorage::Shared => wanted.min(form.hull_depth),
            HullStorage::Occluders => 1,
        };
        let private_depth = match (place, form.lines_each) {
            (HullStorage::Shared, 1) => wanted.min(form.private_depth),
            (HullStorage::Private, 1) => hull_depth,
            _ => 0,
        };
        if quality.hull == Hull::Auto && limits.sweep != limits.untuned_sweep {
            notes.push(format!(
                "tuned sweep: {} per invocation, {} invocations in a workgroup, {hull_depth} hull entries in {} memory",
                if form.lines_each == 1 { "one line" } else { "four lines" },
                form.group_size,
                place.name(),
            ));
        }
        let kept = match place {
            HullStorage::Private => hull_depth,
            HullStorage::Shared => hull_depth + private_depth,
            HullStorage::Occluders => 0,
        };
        let holds_line = kept >= total;
        if total > limits.image_side {
            return Err(Error::Limit {
                what: "`border periodic`".into(),
                needs: format!("{total} steps per line (three periods at least)"),
                limit: format!("{} on this device", limits.image_side),
            });
        }
        let spacing = 1_i64 << shift;
        let side = sides.into_iter().max().unwrap_or(1);
        // The farthest lane position from line 0, and half a spacing to round it.
        let farthest = (2 * i64::from(side) - 1) * i64::from(CELL) + spacing / 2 - 1;
        if farthest > i64::from(i32::MAX) {
            return Err(Error::Limit {
                what: format!("`lines {}`", quality.lines),
                needs: format!("lane positions of {side} rows or columns beyond 32 bits"),
                limit: format!("{} rows and columns", side - 1),
            });
        }
        let divides = |side: usize| (side as i64 * i64::from(CELL)) % spacing == 0;
        let line_shift = if periodic && !(divides(field.cols()) && divides(field.rows())) {
            notes.push("lines a cell apart: wider ones do not divide this periodic field".into());
            15
        } else {
            shift
        };
        // Other precisions do not depend on the highest height, so that edits may change it.
        let heights = field.heights_m().iter().filter(|_| packed);
        let highest = heights.fold(0.0_f32, |m, h| m.max(h.abs()));
        Ok(Sweep::Lines(LineSweep {
            hull: place,
            hull_depth,
            private_depth,
            holds_line,
            packed,
            height_scale: if highest > 0.0 { 1.0 / highest } else { 1.0 },
            line_shift,
            group_size: form.group_size,
            lines_each: form.lines_each,
            slope_format,
            writes_occluders: !stores_slopes || !holds_line,
            fuse: quality.fuse,
            azimuths: form.azimuths,
            any_azimuth: false,
        }))
    }

    /// Azimuths that are swept together at most.
    pub(crate) fn azimuths_together(&self) -> u32 {
        if let Sweep::Lines(lines) = self { lines.azimuths } else { u32::MAX }
    }

    /// A lattice of one word for each step of lines a cell apart, by shadow_sweep.
    pub(crate) fn of_words(sides: [u32; 2], limits: &Limits) -> Self {
        Sweep::Lines(LineSweep {
            hull: HullStorage::Private,
            hull_depth: 1,
            private_depth: 0,
            holds_line: true,
            packed: false,
            height_scale: 1.0,
            line_shift: 15,
            group_size: group_size(limits),
            lines_each: if shadows_by_one_line(sides, limits) { 1 } else { 4 },
            slope_format: 1,
            writes_occluders: false,
            fuse: Fuse::Nearest,
            azimuths: u32::MAX,
            any_azimuth: true,
        })
    }

    /// Has a sweep along lines store its occluders, for walks over it.
    ///
    /// # Errors
    /// The sweep has no occluders.
    pub(crate) fn keep_occluders(&mut self) -> Result<()> {
        if let Some(way) = self.why_no_lines() {
            return Err(Error::setting(
                "`bounce_engine sweep`",
                format!("`{way}`"),
                "a sweep along lines, or `bounce_engine brute-force`, which needs none",
            ));
        }
        if let Sweep::Lines(lines) = self {
            lines.writes_occluders = true;
        }
        Ok(())
    }

    /// The setting that selects a method which does not sweep along lines.
    pub(crate) fn why_no_lines(&self) -> Option<&'static str> {
        match self {
            Sweep::Lines(_) | Sweep::Crossings => None,
            Sweep::Surface { .. } => Some("lines exact"),
            Sweep::Pyramid(_) => Some("method pyramid"),
            Sweep::March { .. } => Some("method brute-force"),
        }
    }

    /// The sweep, where an edit can continue from its occluders: they are stored, and lines begin at an edge.
    pub(crate) fn editable(&self, border: Border) -> Option<&LineSweep> {
        match self {
            Sweep::Lines(l) if l.slope_format == 0 && border != Border::Periodic => Some(l),
            _ => None,
        }
    }

    /// Whether the first crossings of a grid point's own line are among its candidates.
    pub(crate) fn sees_own_crossings(&self) -> bool {
        matches!(self, Sweep::Lines(l) if matches!(l.fuse, Fuse::Aimed | Fuse::AimedNearest | Fuse::AimedAround))
    }

    /// The shaders' FUSE.
    pub(crate) fn fuse_mode(&self) -> u32 {
        match self {
            Sweep::Lines(lines) => Self::fuse_word(lines.fuse),
            Sweep::Crossings => 7,
            _ => 0,
        }
    }

    /// The shaders' LATTICE: 0 occluders, 1 f32 slopes, 2 f16 slopes.
    pub(crate) fn lattice_content(&self) -> u32 {
        match self {
            Sweep::Lines(lines) => lines.slope_format,
            Sweep::Crossings => Self::CONTENTS[0],
            _ => Self::CONTENTS[1],
        }
    }

    /// Which of the shaders' two lattice bindings is used: halves of words, or words.
    pub(crate) fn lattice_binding(&self) -> &'static str {
        if self.lattice_content() == 1 { "lattice_words" } else { "lattice" }
    }

    /// Bytes that a grid point reads from the lattice and from the field around the proposed occluders.
    pub(crate) fn lattice_bytes(&self) -> u64 {
        match self {
            Sweep::Lines(lines) => match lines.fuse {
                Fuse::Nearest => 4,
                Fuse::Slopes => 8,
                Fuse::AimedNearest => 2 + 8,
                Fuse::Own | Fuse::Aimed => 4 + 16,
                // As `Aimed`, and six heights of each of three segments.
                Fuse::AimedAround => 4 + 16 + 3 * 24,
            },
            Sweep::Crossings => 0,
            _ => 4,
        }
    }

    pub(crate) fn lattice_has_distances(&self) -> bool {
        match self {
            Sweep::Lines(_) | Sweep::Crossings | Sweep::Pyramid(_) => false,
            Sweep::Surface { distances, .. } | Sweep::March { distances } => *distances,
        }
    }

    /// The shaders' LINE_SHIFT.
    pub(crate) fn line_shift(&self) -> u32 {
        match self {
            Sweep::Lines(lines) => lines.line_shift,
            _ => 15,
        }
    }

    /// Lines of one azimuth.
    pub(crate) fn lines(&self, azimuth: &Azimuth, axis: Axis) -> u32 {
        let periodic = axis.warm_up > 0;
        let total = u64::from(axis.steps + axis.warm_up);
        let (unit, shear) = match self {
            Sweep::Lines(lines) => (1_u64 << lines.line_shift, azimuth.shear as u64),
            Sweep::Surface { .. } => (1, azimuth.vector_lane as u64),
            Sweep::March { .. } | Sweep::Pyramid(_) | Sweep::Crossings => return axis.lanes,
        };
        let cell = match self {
            Sweep::Lines(_) => CELL as u64,
            _ => azimuth.vector_march as u64,
        };
        let lanes = u64::from(axis.lanes);
        let lines = if periodic {
            lanes * cell / unit
        } else {
            (lanes - 1) * cell / unit + 1 + ((total - 1) * shear).div_ceil(unit)
        };
        lines as u32
    }

    /// Points of the field on the lines of one azimuth.
    pub(crate) fn line_texels(&self, azimuth: &Azimuth, axis: Axis) -> u64 {
        match self {
            Sweep::Lines(lines) => {
                ((axis.texels() << 15) >> lines.line_shift)
                    * u64::from(1 + axis.warm_up / axis.steps)
            }
            Sweep::Surface { .. } => axis.texels() * azimuth.vector_march as u64,
            Sweep::March { .. } | Sweep::Pyramid(_) => axis.texels(),
            Sweep::Crossings => 0,
        }
    }

    /// Layers of the lattice for one azimuth, of 2^layer_shift lines each where it holds lines.
    pub(crate) fn layers(&self, azimuth: &Azimuth, axis: Axis, layer_shift: u32) -> u32 {
        match self {
            // Whole workgroups: those of a line beyond the last are swept too.
            Sweep::Lines(lines) => {
                let widest = Azimuth { shear: CELL, ..*azimuth };
                let azimuth = if lines.any_azimuth { &widest } else { azimuth };
                let lines = self.lines(azimuth, axis).next_multiple_of(lines.group_lines());
                lines.div_ceil(1 << layer_shift)
            }
            Sweep::Crossings => 0,
            _ => 1 + u32::from(self.lattice_has_distances()),
        }
    }
}
