use std::f64::consts::FRAC_PI_2;

use crate::graph::{Axis, Builder, CELL, ResourceId, shaders};
use crate::passes::azimuths::{across_sun, slope};
use crate::scene::{Border, HeightField, Sun};

/// Lines of a workgroup whose grid points it writes. It also sweeps the first line of the next workgroup.
pub(crate) const GROUP_LINES: u32 = 63;

/// A coarser field, the column and row of its grid at the first grid point of the finer one, and its shadow heights.
pub(crate) struct Outer<'a> {
    pub field: &'a HeightField,
    pub place: [f64; 2],
    pub images: [ResourceId; 2],
}

/// Shadow heights of a whole field, in `parts` dispatches. Each covers some of its lines.
pub(crate) fn plan(
    builder: &mut Builder,
    (field, sun): (&HeightField, &Sun),
    outer: Option<&Outer>,
    parts: u32,
    heights: ResourceId,
    written: [ResourceId; 3],
) {
    let size = [field.cols() as u32, field.rows() as u32];
    let cell_m = field.cell_m();
    let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..*sun }, 1, cell_m)[0];
    let axis = Axis::of(azimuth.marches_rows(), size, Border::Plane);
    let radius = if sun.is_point() { 0.0 } else { sun.diameter_rad / 2.0 };
    let edges = [sun.elevation_rad - radius, (sun.elevation_rad + radius).min(FRAC_PI_2)];
    let push = shaders::ShadowHeightPush {
        size: size.map(|n| n as i32),
        outer_size: outer.map_or([0; 2], |o| [o.field.cols() as i32, o.field.rows() as i32]),
        outer_origin: outer.map_or([0.0; 2], |o| o.place.map(|p| p as f32)),
        outer_step: outer
            .map_or([0.0; 2], |o| [0, 1].map(|i| (cell_m[i] / o.field.cell_m()[i]) as f32)),
        rise: edges.map(|edge| slope(edge) * azimuth.step_m),
        outer_base: outer.map_or(0.0, |o| (o.field.base_m() - field.base_m()) as f32),
        shear: azimuth.shear,
        flags: azimuth.flags,
        first_group: 0,
    };
    let shear_cells = (u64::from(axis.steps) - 1) * azimuth.shear as u64;
    let lines = axis.lanes + shear_cells.div_ceil(CELL as u64) as u32;
    let groups = lines.div_ceil(GROUP_LINES);
    let texels = axis.texels() / u64::from(parts);
    for number in 0..parts {
        let [first, next] = [number, number + 1]
            .map(|s| (u64::from(groups) * u64::from(s) / u64::from(parts)) as u32);
        let part = if parts == 1 { String::new() } else { format!("part {}", number + 1) };
        let mut bound = vec![("heights", heights)];
        if let Some(outer) = outer {
            let [lit_above, dark_below] = outer.images;
            bound.extend([("outer_lit_above", lit_above), ("outer_dark_below", dark_below)]);
        }
        bound.extend(["lit_above", "dark_below", "sun_share"].into_iter().zip(written));
        builder.pass(
            shaders::ShadowHeight { has_outer: outer.is_some() },
            &part,
            "shadow heights of the sun at each grid point",
            [next - first, 1, 1],
            &shaders::ShadowHeightPush { first_group: first as i32, ..push },
            &bound,
            texels * (2 * 4 + 3 * 4),
            texels,
        );
    }
}
