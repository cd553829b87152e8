//! Result of a sweep: one value per line and march step.

use crate::shared::fuse::Found;
use crate::shared::sweep::{CELL_SHIFT, March, NO_SLOPE, wrapped};
use ridgelight::plan::azimuths::{Azimuth, CELL};
use ridgelight::scene::Border;

/// The lattice of one march axis: `[layer][march position][slot]`, where slot is the line's lane
/// position in line spacings, flipped as its azimuth flips lanes.
///
/// The shaders store the same values by line and step, where a line's writes are contiguous (`lattice.glsl`):
/// [`line_number`] gives the line. Passes that find one value per grid point store it by lane and step.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Azimuths.
    pub layers: usize,
    /// Slots: line positions across the march.
    pub width: usize,
    /// March positions.
    pub height: usize,
    /// March steps back to the occluder, 0 for none.
    pub occluders: Vec<u16>,
    /// Slope of the occluder, [`NO_SLOPE`] for none.
    pub slopes: Vec<f32>,
    /// March steps to the occluder, of passes that find it between steps; the shaders store them in every second
    /// layer of `slopes`.
    pub distances: Vec<f32>,
}

/// Slots that lines 2^line_shift / 32768 cells apart need over `lanes` lanes.
///
/// Periodic fields need a whole number of spacings in a period: `lanes` even for 2^16.
pub fn slots(lanes: usize, line_shift: u32, border: Border) -> usize {
    match border {
        Border::Periodic => (lanes << CELL_SHIFT) >> line_shift,
        Border::Plane | Border::Open => (((lanes - 1) << CELL_SHIFT) >> line_shift) + 1,
    }
}

impl Lattice {
    /// An empty lattice for a march over `lanes` × `steps` grid points.
    pub fn new(layers: usize, width: usize, steps: usize) -> Self {
        let words = layers * width * steps;
        Self {
            layers,
            width,
            height: steps,
            occluders: vec![0; words],
            slopes: vec![NO_SLOPE; words],
            distances: vec![0.0; words],
        }
    }

    /// Slopes and distances of every grid point of a march, one slot a lane; `of` takes a lane and a step.
    pub fn fill(&mut self, march: &March, of: impl Fn(i32, i32) -> Found) {
        for (step, lane) in (0..march.steps).flat_map(|s| (0..march.lanes).map(move |l| (s, l))) {
            let texel = self.texel(lane, march.march_position(step), march.azimuth.layer);
            let found = of(lane, step);
            (self.slopes[texel], self.distances[texel]) = (found.slope, found.steps);
        }
    }

    /// Where a texel lies in the vectors.
    pub fn texel(&self, slot: i32, march: i32, layer: u32) -> usize {
        let (slot, march, layer) = (slot as usize, march as usize, layer as usize);
        assert!(
            slot < self.width && march < self.height && layer < self.layers,
            "texel ({slot}, {march}, {layer}) of {} × {} × {}",
            self.width,
            self.height,
            self.layers
        );
        (layer * self.height + march) * self.width + slot
    }
}

/// The lattices of both march axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattices {
    /// Of azimuths that march along columns.
    pub cols: Lattice,
    /// Of azimuths that march along rows.
    pub rows: Lattice,
}

impl Lattices {
    /// Empty lattices for azimuths whose layers are numbered by [`number_layers`], lines 2^line_shift
    /// / 32768 cells apart.
    pub fn new(
        azimuths: &[Azimuth],
        [cols, rows]: [usize; 2],
        line_shift: u32,
        border: Border,
    ) -> Self {
        let by_row = azimuths.iter().filter(|a| a.marches_rows()).count();
        Self {
            cols: Lattice::new(azimuths.len() - by_row, slots(rows, line_shift, border), cols),
            rows: Lattice::new(by_row, slots(cols, line_shift, border), rows),
        }
    }

    /// The lattice that an azimuth's lines are in.
    pub fn of(&self, azimuth: &Azimuth) -> &Lattice {
        if azimuth.marches_rows() { &self.rows } else { &self.cols }
    }

    /// The same, to write to.
    pub fn of_mut(&mut self, azimuth: &Azimuth) -> &mut Lattice {
        if azimuth.marches_rows() { &mut self.rows } else { &mut self.cols }
    }
}

/// Numbers the layers of each march axis in the order of the azimuths.
pub fn number_layers(azimuths: &mut [Azimuth]) {
    let mut next = [0; 2];
    for azimuth in azimuths {
        let axis = usize::from(azimuth.marches_rows());
        azimuth.layer = next[axis];
        next[axis] += 1;
    }
}

/// The lane position of the line in `slot` at a step counted from the first of the march.
pub fn line_position(slot: i32, step: i32, shear: i32, line_shift: u32) -> i32 {
    let spacing = 1 << line_shift;
    slot * spacing + ((step * shear) & (spacing - 1))
}

/// The shaders' number of the line that is in `slot` at a step counted from the first of the march, of `total` steps.
/// `slots` as [`slots`] gives it.
pub fn line_number(
    (slot, slots): (i32, i32),
    (step, total): (i32, i32),
    shear: i32,
    line_shift: u32,
    border: Border,
) -> i32 {
    let advanced = (step * shear) >> line_shift;
    match border {
        Border::Periodic => wrapped(slot - advanced, slots),
        Border::Plane | Border::Open => {
            slot - advanced + (((total - 1) * shear + (1 << line_shift) - 1) >> line_shift)
        }
    }
}

const _: () = assert!(CELL == 1 << CELL_SHIFT);
