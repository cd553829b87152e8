//! Passes, one file per shader: bindings, size, reason and cost of each dispatch. A folder per technique, whose `mod.rs`
//! lists its passes. Elsewhere they have their own names without the folder: `passes::sky_shade`.
//! This file fills the push constants that several passes share.

pub(crate) mod bake;
pub(crate) mod bounce;
pub(crate) mod device;
pub(crate) mod direct;
pub(crate) mod edit;
pub(crate) mod horizon;
#[cfg(test)]
mod numbers;
pub(crate) mod rays;
pub(crate) mod reference;
pub(crate) mod sh;
pub(crate) mod specular;
pub(crate) mod view;

pub use bake::*;
pub(crate) use bounce::*;
pub(crate) use device::*;
pub(crate) use direct::*;
pub(crate) use edit::*;
pub use horizon::*;
pub(crate) use rays::*;
pub(crate) use reference::*;
pub use sh::*;
pub(crate) use specular::*;
pub use view::*;

use crate::graph::{ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::blocks::BlockLevels;
use crate::scene::{HeightField, PhongSpecular};

/// Phong specular: constant, or a map.
#[derive(Clone, Copy)]
pub(crate) struct PhongSource {
    /// Used where there is no map.
    pub constant: PhongSpecular,
    pub map: Option<ResourceId>,
}

/// Of the passes that add light through a batch's horizons.
impl shaders::ShadePush {
    pub(crate) fn of(batch: &Batch, cell_m: [f64; 2]) -> Self {
        let [cols, rows] = batch.axis.size();
        Self {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            warm_up: batch.axis.warm_up as i32,
            first_azimuth: batch.first,
            azimuth_count: batch.count,
            along_count: batch.along,
            clears: u32::from(batch.is_first),
            ..bytemuck::Zeroable::zeroed()
        }
    }
}

/// Of the passes that march over the field's own heights, cell by cell.
impl shaders::MarchPush {
    pub(crate) fn of(batch: &Batch) -> Self {
        let axis = batch.axis;
        Self {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            first: 0,
        }
    }
}

/// The first ones of the passes whose rays traverse blocks of cells: what `walk.glsl` reads.
impl shaders::LandPush {
    pub(crate) fn of(field: &HeightField, blocks: &BlockLevels) -> Self {
        let [cell_x, cell_y] = field.cell_m();
        Self {
            cols: field.cols() as i32,
            rows: field.rows() as i32,
            cells_x: blocks.cells[0] as i32,
            cells_y: blocks.cells[1] as i32,
            padded_rows: blocks.padded_rows as i32,
            top_level: blocks.top_level as i32,
            cell_x_m: cell_x as f32,
            cell_y_m: cell_y as f32,
        }
    }
}
