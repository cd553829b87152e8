//! The part of a pass that an edited rectangle needs.

use super::{Pass, shaders};

/// One cell across the march, in the units of `Azimuth::shear`.
pub const CELL: i32 = 1 << 15;

/// A field along one of its axes: lanes side by side, steps along the march.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// Whether marches go from row to row; else from column to column.
    pub marches_rows: bool,
    /// Texels across the march.
    pub lanes: u32,
    /// Texels along the march.
    pub steps: u32,
    /// Steps before the first stored one: whole periods of a periodic field.
    pub warm_up: u32,
}

impl Axis {
    /// Texels of the field.
    pub(crate) fn texels(self) -> u64 {
        u64::from(self.lanes) * u64::from(self.steps)
    }

    /// Columns and rows.
    pub(crate) fn size(self) -> [u32; 2] {
        if self.marches_rows { [self.lanes, self.steps] } else { [self.steps, self.lanes] }
    }

    /// Name in labels.
    pub(crate) fn name(self) -> &'static str {
        if self.marches_rows { "rows" } else { "cols" }
    }
}

/// A rectangle of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// The first column.
    pub col: u32,
    /// The first row.
    pub row: u32,
    /// How many columns, 1 or more.
    pub cols: u32,
    /// How many rows, 1 or more.
    pub rows: u32,
}

impl Rectangle {
    /// The whole field of `cols` × `rows`.
    pub(crate) fn whole([cols, rows]: [u32; 2]) -> Self {
        Self { col: 0, row: 0, cols, rows }
    }

    /// The words that shaders read: first column and row, last column and row.
    pub(crate) fn words(self) -> [i32; 4] {
        let Self { col, row, cols, rows } = self;
        [col, row, col + cols - 1, row + rows - 1].map(|v| v as i32)
    }

    /// With this many grid points more on every side, within a field of `cols` × `rows`.
    fn grown(self, [by_cols, by_rows]: [u32; 2], [cols, rows]: [u32; 2]) -> Self {
        let along = |by: u32, first: u32, count: u32, all: u32| {
            let start = first.saturating_sub(by);
            (start, (first + count + by).min(all) - start)
        };
        let (col, cols) = along(by_cols, self.col, self.cols, cols);
        let (row, rows) = along(by_rows, self.row, self.rows, rows);
        Self { col, row, cols, rows }
    }

    /// First lane, lanes, march positions.
    fn along(self, axis: Axis) -> [u32; 3] {
        if axis.marches_rows {
            [self.col, self.cols, self.rows]
        } else {
            [self.row, self.rows, self.cols]
        }
    }
}

/// The part of a pass that an edited rectangle needs. The last four words of its push constants hold the rectangle:
/// first column and row, last column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// All its workgroups.
    Whole,
    /// Workgroups with texels of the rectangle, 8 × 8 times four lanes each.
    Quads {
        /// Of the lanes.
        axis: Axis,
        /// Lanes added to both sides of the rectangle.
        margin: u32,
    },
    /// Workgroups with lines, 32 each and 2^line_shift / 32768 cells apart, for texels from which the rectangle is visible.
    Lines {
        /// Of the march.
        axis: Axis,
        /// Of the spacing.
        line_shift: u32,
        /// Grid points added to every side of the rectangle.
        margin: u32,
    },
}

/// Lines that a workgroup sweeps again after an edit.
pub(crate) const GROUP_LINES: u32 = 32;

impl Pass {
    /// Workgroups and push constants after an edit of `rectangle` only.
    pub(crate) fn for_edit(&self, rectangle: Rectangle) -> ([u32; 3], Vec<u8>) {
        let mut push = self.push.clone();
        let Some(reach) = self.reach else { return (self.groups, push) };
        let rectangle = match reach {
            Reach::Lines { axis, margin, .. } => rectangle.grown([margin; 2], axis.size()),
            Reach::Quads { axis, margin } => {
                let by = if axis.marches_rows { [margin, 0] } else { [0, margin] };
                rectangle.grown(by, axis.size())
            }
            Reach::Whole => rectangle,
        };
        let at = push.len() - size_of::<[i32; 4]>();
        push[at..].copy_from_slice(bytemuck::bytes_of(&rectangle.words()));
        let [x, y, z] = self.groups;
        let groups = match reach {
            Reach::Whole => self.groups,
            Reach::Quads { axis, .. } => {
                let [lane, lanes, marches] = rectangle.along(axis);
                let quads = (lane + lanes - 1) / 4 - lane / 4 + 1;
                shaders::HEIGHT_TRANSPOSE.groups([quads, marches, z])
            }
            Reach::Lines { axis, line_shift, .. } => {
                let [_, lanes, marches] = rectangle.along(axis).map(u64::from);
                // Adds the line spacing, a lane on each side and the steepest shear; the first group begins at a multiple of its
                // lines.
                let cells = (lanes + 1 + marches - 1) * CELL as u64;
                let lines = (cells >> line_shift) + 3;
                [x.min(lines.div_ceil(u64::from(GROUP_LINES)) as u32 + 1), y, z]
            }
        };
        (groups, push)
    }
}
