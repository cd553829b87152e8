use super::preview::Grid;
use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::passes::azimuths::{Azimuth, across_sun, slope};
use crate::scene::{Border, Sun};

/// Lines of a workgroup.
const GROUP_LINES: u32 = 16;

/// The lines along which a sun shades a grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SunLines {
    pub(super) azimuth: Azimuth,
    /// Slopes of rays to the sun's lower and upper edge.
    pub(super) edges: [f32; 2],
    pub(super) is_periodic: bool,
}

impl SunLines {
    pub(crate) fn new(sun: &Sun, cell_m: [f64; 2], border: Border) -> Self {
        let sun = sun.clamped();
        let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..sun }, 1, cell_m)[0];
        let diameter_rad = if sun.is_point() { 0.0 } else { sun.diameter_rad };
        let edges = [-0.5, 0.5].map(|half| slope(sun.elevation_rad + half * diameter_rad));
        Self { azimuth, edges, is_periodic: border == Border::Periodic }
    }
}

/// Marches away from the sun over the fine grid.
pub(crate) fn plan(builder: &mut Builder, fine: Grid, of: SunLines, bound: &[(&str, ResourceId)]) {
    let SunLines { azimuth, edges, is_periodic } = of;
    let axis = Axis::of(azimuth.marches_rows(), fine.size, Border::Plane);
    // The shear moves a line by a cell or less in a step.
    let lines = axis.lanes + if is_periodic { 0 } else { axis.steps };
    builder.pass(
        shaders::PreviewShadow { periodic: is_periodic },
        "",
        "shadow heights of the sun on the fine grid",
        [lines.div_ceil(GROUP_LINES), 1, 1],
        &shaders::PreviewShadowPush {
            rise_m: edges.map(|edge| edge * azimuth.step_m),
            cols: fine.size[0] as i32,
            rows: fine.size[1] as i32,
            shear: azimuth.shear,
            flags: azimuth.flags,
        },
        bound,
        fine.texels() * 16,
        fine.texels(),
    );
}
