use super::Plan;
use crate::graph::{Builder, Format, Limits, Owner};
use crate::passes::shadow_height::{self, GROUP_LINES, Outer};
use crate::scene::{HeightField, Lights, Sun};
use crate::{Error, Result};

/// Passes that write up to which height the ground shades each grid point of a field from a sun: for objects at any height over a
/// terrain, and for terrain in the distance.
///
/// Outputs, all R32F: "lit_above" (a point over the grid point sees the whole sun from this height on), "dark_below" (below it none of
/// the sun), both in metres over the field's base, and "sun_share" (the share of the disc that the ground there sees, [0..1], not
/// weighted by the cosine). Between the two heights the hidden part of the disc's height is (lit_above - z) / (lit_above - dark_below).
///
/// One line a cell apart passes on each side of a grid point; ridges between the lines' steps count by their height at the steps.
/// All lines follow the azimuth of the sun's centre. Before the field the ground goes on at the height of its edge.
///
/// Inputs: "heights"; with `outer`, a coarser field around this one and the column and row of its grid at this field's first grid
/// point, also its "outer_lit_above" and "outer_dark_below" under the same sun. Record fields from the coarsest to the finest.
///
/// The plan has `slices` passes, each for some of the lines: [`record_passes`](crate::gpu::Renderer::record_passes) spreads them over
/// frames. A plan of another sun, or of an outer field elsewhere, can replace this one.
///
/// # Errors
/// A sun out of range; an outer field that does not contain this one; more slices than groups of lines; a field beyond the limits.
pub fn shadow_heights(
    field: &HeightField,
    sun: &Sun,
    outer: Option<(&HeightField, [f64; 2])>,
    slices: u32,
    limits: &Limits,
) -> Result<Plan> {
    let size = limits.check_size(field.rows(), field.cols())?;
    Lights { suns: vec![*sun], ..Lights::default() }.check()?;
    let [cols, rows] = size;
    let most = cols.min(rows).div_ceil(GROUP_LINES);
    if !(1..=most).contains(&slices) {
        return Err(Error::setting(
            "slices",
            slices.to_string(),
            format!("1 to {most} for {cols} × {rows}"),
        ));
    }
    if let Some((around, place)) = outer {
        let points = [around.cols(), around.rows()];
        let contains = |i: usize| {
            let cells = f64::from(size[i] - 1) * field.cell_m()[i] / around.cell_m()[i];
            // Rounding of a quotient must not push a field of the same edge out.
            let last = (points[i] - 1) as f64 + 1e-6;
            place[i] >= 0.0 && place[i] + cells <= last
        };
        if !(contains(0) && contains(1)) {
            return Err(Error::setting(
                "outer field",
                format!("{} × {} with this field at {place:?}", points[0], points[1]),
                "a field that contains this one",
            ));
        }
    }
    let mut builder = Builder::new(limits);
    let mut image = |name: &str, owner, [cols, rows]: [u32; 2]| {
        builder.image(name, owner, Format::R32Float, [cols, rows, 1], false)
    };
    let heights = image("heights", Owner::Input, size);
    let outer = outer.map(|(field, place)| {
        let size = [field.cols() as u32, field.rows() as u32];
        let images =
            ["outer_lit_above", "outer_dark_below"].map(|name| image(name, Owner::Input, size));
        Outer { field, place, images }
    });
    let written =
        ["lit_above", "dark_below", "sun_share"].map(|name| image(name, Owner::Output, size));
    shadow_height::plan(&mut builder, (field, sun), outer.as_ref(), slices, heights, written);
    let used = vec![("slices".to_owned(), slices.to_string())];
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), used, limits)
}
