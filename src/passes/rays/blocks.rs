use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::{height_bounds, height_cells};
use crate::scene::{Border, HeightField, REACH_CELLS};

/// Blocks of 4 by 4 cells, of 4 by 4 such blocks and so on, over a field.
#[derive(Clone, Copy)]
pub(crate) struct BlockLevels {
    /// Columns and rows of cells.
    pub cells: [u32; 2],
    /// Rows from which the places of the levels in their image follow.
    pub padded_rows: u32,
    /// The level whose one block holds all cells.
    pub top_level: u32,
    border: Border,
}

/// The ground, and the images that passes with rays read.
pub(crate) struct Blocks {
    pub levels: BlockLevels,
    /// Height and slopes of each grid point.
    pub ground: ResourceId,
    /// Cells and maxima. Rays skip blocks by their maximum height; all levels are in one image. None if no pass traces rays.
    of_rays: Option<[ResourceId; 2]>,
}

impl BlockLevels {
    /// Levels up to one block that holds all. A field without cells has one cell that is never read.
    pub(crate) fn of(size: [u32; 2], border: Border) -> Self {
        let cells = size.map(|n| match border {
            Border::Periodic => n,
            Border::Plane | Border::Open => (n - 1).max(1),
        });
        let longest = cells[0].max(cells[1]);
        let top_level = (1..).find(|l| 4_u32.pow(*l) >= longest).expect("up to 4^15");
        let padded_rows = cells[1].next_multiple_of(4_u32.pow(top_level));
        Self { cells, padded_rows, top_level, border }
    }

    /// Width and height of the image of all levels' maxima.
    pub(crate) fn maxima_size(&self) -> [u32; 2] {
        [self.cells[0].div_ceil(4), self.padded_rows / 2]
    }

    /// The image of all levels' maxima.
    pub(crate) fn maxima(&self, builder: &mut Builder, name: &str) -> ResourceId {
        let [width, height] = self.maxima_size();
        builder.image(name, Owner::Internal, Format::R32Float, [width, height, 1], false)
    }

    /// The passes that fill it.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        part: &str,
        source: Source,
        maxima: ResourceId,
    ) {
        for level in 1..=self.top_level {
            height_bounds::plan(builder, self, (part, level), source, maxima);
        }
    }

    /// An upper bound of a ray's steps. Over the field's longest side, or as far as a ray is followed over
    /// repetitions: two cells per cell along it, half as many changes of level, and those of the last block.
    pub(crate) fn most_steps(&self) -> u32 {
        let [x, y] = self.cells;
        3 * if self.border == Border::Periodic { REACH_CELLS } else { x.max(y) } + 64
    }

    /// A bound of the mean steps of the slowest of eight neighbouring rays: twice the steps measured on
    /// fractals of 9² to 257², 6 to 13 with two levels, 13 to 50 with three and 25 to 50 with four. To find it
    /// again: the number of lights with which llvmpipe loses rays of 64 paths in one dispatch, 65,535 / 64 over
    /// it.
    pub(crate) fn usual_steps(&self) -> u32 {
        24 * self.top_level
    }

    /// Lookups of a ray of [`usual_steps`](Self::usual_steps): a cell and the top of a block at each step.
    pub(crate) fn lookups(&self) -> u64 {
        2 * u64::from(self.usual_steps())
    }
}

impl Blocks {
    /// `has_rays`: whether any pass traces rays.
    pub(crate) fn make(
        builder: &mut Builder,
        size: [u32; 2],
        border: Border,
        has_rays: bool,
    ) -> Self {
        let levels = BlockLevels::of(size, border);
        let [width, height] = size;
        let mut image = |name: &str| {
            let extent = [width, height, 1];
            builder.image(name, Owner::Internal, Format::Rgba32Float, extent, false)
        };
        let cells = has_rays.then(|| image("cells"));
        let ground = image("ground");
        let of_rays = cells.map(|cells| [cells, levels.maxima(builder, "maxima")]);
        Self { levels, ground, of_rays }
    }

    /// Cells and maxima, for passes that trace rays.
    pub(crate) fn of_rays(&self) -> [ResourceId; 2] {
        self.of_rays.expect("made for rays")
    }

    /// The passes that fill the images. `paths` are the sums that a path tracer starts from.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        field: &HeightField,
        heights: ResourceId,
        paths: Option<[ResourceId; 2]>,
    ) {
        let (of, cells) = ((field, self.levels.border), self.of_rays.map(|[cells, _]| cells));
        height_cells::plan(builder, of, [heights, self.ground], cells, paths);
        if let Some([cells, maxima]) = self.of_rays {
            self.levels.plan(builder, "", Source::Cells(cells), maxima);
        }
    }

    /// Whether the field is one grid point wide along rows, along columns: only rays along such a line hit it.
    pub(crate) fn thin(&self, field: &HeightField) -> [bool; 2] {
        [field.rows(), field.cols()].map(|n| self.levels.border != Border::Periodic && n == 1)
    }
}

/// What the lowest level is made from.
#[derive(Clone, Copy)]
pub(crate) enum Source {
    Cells(ResourceId),
    Heights {
        heights: ResourceId,
        /// Added to the heights for each column and each row.
        tilt: [f32; 2],
    },
}
