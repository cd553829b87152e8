use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Border, HeightField};

/// The ground of each grid point and, for rays, heights by cell. Clears the sums of `paths`, where there are any.
pub(crate) fn plan(
    builder: &mut Builder,
    (field, border): (&HeightField, Border),
    [heights, ground]: [ResourceId; 2],
    cells: Option<ResourceId>,
    paths: Option<[ResourceId; 2]>,
) {
    let mut bound = vec![("heights", heights), ("ground", ground)];
    bound.extend(cells.map(|cells| ("cells", cells)));
    if let Some([batch_mean, lost_rays]) = paths {
        bound.extend([("batch_mean", batch_mean), ("lost_rays", lost_rays)]);
    }
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let grid_points = u64::from(cols) * u64::from(rows);
    let written = 1 + u64::from(cells.is_some()) + u64::from(paths.is_some());
    builder.pass(
        shaders::HeightCells {
            periodic: border == Border::Periodic,
            begins_paths: paths.is_some(),
            writes_cells: cells.is_some(),
        },
        "",
        match cells {
            Some(_) => "so that one fetch reads a cell; shading reads the normals of texels",
            None => "shading reads the normals of texels",
        },
        shaders::HEIGHT_CELLS.groups([cols, rows, 1]),
        &shaders::HeightCellsPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: field.cell_m()[0] as f32,
            cell_y_m: field.cell_m()[1] as f32,
        },
        &bound,
        grid_points * (4 + written * 16),
        grid_points,
    );
}
