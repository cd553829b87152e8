//! What both passes of sphere lights share: where a light is shaded, and in which slices.

use std::ops::Range;

use crate::graph::{Rectangle, ResourceId};
use crate::passes::PhongSource;
use crate::passes::bounced_specular::BouncedSpecular;
use crate::scene::{HeightField, SphereLight};

/// How and where a sphere light is shaded.
pub(crate) struct SphereShading {
    /// What the plan prints.
    pub why: &'static str,
    /// Slices across the light.
    pub slices: u32,
    /// Grid points that it may reach, and their largest distance.
    pub rectangle: Rectangle,
    pub reach_m: f32,
    /// Whether the sum begins with it.
    pub begins: bool,
    pub specular: Option<SphereSpecular>,
}

/// Phong specular of a sphere light.
#[derive(Clone, Copy)]
pub(crate) struct SphereSpecular {
    pub phong: PhongSource,
    /// Least number of slices around a texel within the sphere, from the narrowest lobe.
    pub slices_around: u32,
    /// The eye over the field's base; the last number is 0 for a view from straight above.
    pub eye_m: [f32; 4],
    pub specular_sum: ResourceId,
    /// Whether the sum begins with it.
    pub begins: bool,
    /// Where another bounce follows: its light also arrives as a series.
    pub outgoing: Option<BouncedSpecular>,
}

impl SphereShading {
    /// Slices where the sphere is narrow from a texel, and where it surrounds the texel.
    pub(crate) fn counts(&self, light: &SphereLight, field: &HeightField) -> [u32; 2] {
        let [narrow, around] = light.slices(self.slices, field.cell_m());
        [narrow, self.specular.map_or(around, |specular| around.max(specular.slices_around))]
    }
}

/// A rectangle south of the field, where shaders write nothing. It keeps a pass that has no work.
pub(crate) fn beyond([_, rows]: [u32; 2]) -> Rectangle {
    Rectangle { col: 0, row: rows, cols: 1, rows: 1 }
}

/// Some rows of a rectangle. They count from its first row, so that a part is whole workgroups. Counted from the field's first
/// row, a workgroup could reach into the next part, and light there would be added twice.
pub(crate) fn rows_of(lit: Rectangle, rows: &Range<u32>) -> Option<Rectangle> {
    let end = rows.end.min(lit.rows);
    (rows.start < end).then(|| Rectangle {
        row: lit.row + rows.start,
        rows: end - rows.start,
        ..lit
    })
}

/// The light's centre: whole cells east of the first column and south of the first row, and the rest of a cell.
pub(crate) fn place_of(field: &HeightField, light: &SphereLight) -> ([i32; 2], [f32; 2]) {
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, _] = light.position_m;
    let place = [x / cell_x, (field.rows() - 1) as f64 - y / cell_y];
    // Beyond this a whole cell is less than a rounding of the distance.
    let base = place.map(|p| p.floor().clamp(-1e9, 1e9));
    (base.map(|b| b as i32), [0, 1].map(|i| (place[i] - base[i]) as f32))
}

/// The grid points within `reach` of a sphere light's centre in plan, if any.
pub(crate) fn texels_within(
    field: &HeightField,
    light: &SphereLight,
    reach: f64,
) -> Option<Rectangle> {
    let within = |place: f64, reach: f64, count: usize| {
        let last = count as f64 - 1.0;
        let [low, high] = [(place - reach).ceil().max(0.0), (place + reach).floor().min(last)];
        (low <= high).then_some((low as u32, (high - low) as u32 + 1))
    };
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, _] = light.position_m;
    let (col, cols) = within(x / cell_x, reach / cell_x, field.cols())?;
    let from_north = (field.rows() - 1) as f64 - y / cell_y;
    let (row, rows) = within(from_north, reach / cell_y, field.rows())?;
    Some(Rectangle { col, row, cols, rows })
}
