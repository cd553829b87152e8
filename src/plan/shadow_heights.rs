use super::Plan;
use crate::graph::{Builder, Format, Limits, Owner};
use crate::passes::shadow_height::{self, GROUP_LINES, Outer};
use crate::scene::{HeightField, Lights, Sun};
use crate::{Error, Result};

/// Plans the shadow heights of a sun over a field, for distant terrain and for objects at any height above it.
///
/// Outputs, all R32F. Heights are in metres over the field's base.
/// - "lit_above": the height from which the whole sun is visible.
/// - "penumbra": the distance from "lit_above" down to the height at which the occluder that determines it hides the whole sun. At a height z in
///   between, it hides
///   (lit_above - z) / penumbra of the disc's height.
/// - "sun_share": the visible share of the sun's disc at the ground, [0..1], without the cosine.
///
/// Lines are one cell apart and follow the azimuth of the sun's centre. Each grid point interpolates the lines on either side.
/// Heights are evaluated only at march steps, so a ridge between two steps is lowered. Beyond the edge towards the sun, the ground is
/// level at the height of the edge.
///
/// Inputs: "heights". With `outer`, a coarser field that contains this one, also its "outer_lit_above" and "outer_penumbra" for the
/// same sun. The two numbers are the column and row, in the grid of the outer field, of this field's first grid point. Record the
/// coarsest field first.
///
/// The plan has `parts` passes. Each covers some of the field's lines, so
/// [`record_passes`](crate::gpu::Renderer::record_passes) can spread them over frames, in order. A plan of another sun, or of another place
/// in the outer field, can replace this one.
///
/// # Errors
/// The sun is out of range, `outer` does not contain the field, `parts` exceeds its maximum (one per 63 grid points of the shorter side,
/// rounded up), or the field exceeds the limits.
pub fn shadow_heights(
    field: &HeightField,
    sun: &Sun,
    outer: Option<(&HeightField, [f64; 2])>,
    parts: u32,
    limits: &Limits,
) -> Result<Plan> {
    let size = limits.check_size(field.rows(), field.cols())?;
    Lights { suns: vec![*sun], ..Lights::default() }.check()?;
    let [cols, rows] = size;
    let most = cols.min(rows).div_ceil(GROUP_LINES);
    if !(1..=most).contains(&parts) {
        return Err(Error::setting(
            "parts",
            parts.to_string(),
            format!("1 to {most} for {cols} × {rows}"),
        ));
    }
    if let Some((around, place)) = outer {
        limits.check_size(around.rows(), around.cols())?;
        let points = [around.cols(), around.rows()];
        let contains = |i: usize| {
            let cells = f64::from(size[i] - 1) * field.cell_m()[i] / around.cell_m()[i];
            // Tolerates rounding of the quotient where both fields end at the same edge.
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
            ["outer_lit_above", "outer_penumbra"].map(|name| image(name, Owner::Input, size));
        Outer { field, place, images }
    });
    let written =
        ["lit_above", "penumbra", "sun_share"].map(|name| image(name, Owner::Output, size));
    shadow_height::plan(
        &mut builder,
        (field, &sun.clamped()),
        outer.as_ref(),
        (parts, limits),
        heights,
        written,
    );
    let used = vec![("parts".to_owned(), parts.to_string())];
    Plan::finish(builder, size, Vec::new(), Vec::new(), used, limits)
}
