use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::blocks::{BlockLevels, Source};

/// What a level is made from: heights, cells, or the blocks of the level below.
pub(crate) const FROM_HEIGHTS: u32 = 0;
pub(crate) const FROM_CELLS: u32 = 1;
pub(crate) const FROM_BLOCKS: u32 = 2;

/// The maximum height of each block of 4^level by 4^level cells.
pub(crate) fn plan(
    builder: &mut Builder,
    levels: &BlockLevels,
    (part, level): (&str, u32),
    source: Source,
    maxima: ResourceId,
) {
    let [cells_x, cells_y] = levels.cells;
    let [across, down] = levels.cells.map(|n| n.div_ceil(1 << (2 * level)));
    let blocks = u64::from(across) * u64::from(down);
    let mut bound = vec![("maxima", maxima)];
    let (kind, read) = match source {
        _ if level > 1 => (FROM_BLOCKS, 4 * 16),
        Source::Heights { heights, .. } => {
            bound.push(("heights", heights));
            (FROM_HEIGHTS, 4 * 25)
        }
        Source::Cells(cells) => {
            bound.push(("cells", cells));
            (FROM_CELLS, 16 * 16)
        }
    };
    builder.pass(
        shaders::HeightBounds { source: kind },
        format!("{part} level {level}").trim(),
        "so that rays above a block skip it",
        shaders::HEIGHT_BOUNDS.groups([across, down, 1]),
        &shaders::HeightBoundsPush {
            cells_x: cells_x as i32,
            cells_y: cells_y as i32,
            padded_rows: levels.padded_rows as i32,
            level: level as i32,
            tilt: match source {
                Source::Heights { tilt, .. } => tilt,
                Source::Cells(_) => [0.0; 2],
            },
        },
        &bound,
        blocks * (4 + read),
        blocks,
    );
}
