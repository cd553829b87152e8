use super::visible_points::{check_field, texels};
use crate::graph::bytes_text;
use crate::graph::{Builder, Format, Limits, Owner};
use crate::passes::blocks::Blocks;
use crate::passes::facet_mask as pass;
use crate::passes::facet_mask::DIRECTIONS_A_WORD;
use crate::plan::Plan;
use crate::scene::{Border, Directions, HeightField};
use crate::{Error, Result};

/// Approximate number of rays per dispatch, as for visible points.
const BAND_RAYS: u64 = 1 << 24;

/// Passes that find which flat triangles of a field, two per cell, are visible from each direction: `Facets`.
///
/// Input: "heights". Output: "facet_mask", one u32 per cell for every fifteen directions.
///
/// # Errors
/// A field of unknown heights or without cells; more directions than one image holds; a scene beyond the limits.
pub fn facet_mask(
    field: &HeightField,
    border: Border,
    directions: &Directions,
    limits: &Limits,
) -> Result<Plan> {
    let size = limits.check_size(field.rows(), field.cols())?;
    check_field(field)?;
    if border != Border::Periodic && size.contains(&1) {
        let found = format!("a field of {} × {}", size[0], size[1]);
        return Err(Error::setting("triangles", found, "2 × 2 grid points or more"));
    }
    let mut builder = Builder::new(limits);
    let heights =
        builder.image("heights", Owner::Input, Format::R32Float, [size[0], size[1], 1], false);
    let blocks = Blocks::make(&mut builder, size, border, true);
    let [cells_x, cells_y] = blocks.levels.cells;
    let count = directions.count();
    let layers = count.div_ceil(DIRECTIONS_A_WORD) as u32;
    let layer_bytes = 4 * u64::from(cells_x) * u64::from(cells_y);
    let bytes = layer_bytes * u64::from(layers);
    if layers > limits.image_layers || bytes > limits.allocation_bytes {
        return Err(Error::Limit {
            what: format!("visible triangles from {count} directions"),
            needs: format!("one image of {layers} layers, {}", bytes_text(bytes)),
            limit: format!(
                "{} layers and {} in one allocation; fewer directions or a smaller field fit",
                limits.image_layers,
                bytes_text(limits.allocation_bytes)
            ),
        });
    }
    let extent = [cells_x, cells_y, layers];
    let image = builder.image("facet_mask", Owner::Output, Format::R32Uint, extent, true);
    blocks.plan(&mut builder, field, heights, None);
    let (buffer, first) = builder.constants(&texels(directions));
    let layer_rays = layer_bytes / 2 * DIRECTIONS_A_WORD as u64;
    let at_once = (BAND_RAYS / layer_rays).clamp(1, layers.into()) as u32;
    for low in (0..layers).step_by(at_once as usize) {
        let band = low..layers.min(low + at_once);
        let texels = first..first + count;
        pass::plan(&mut builder, (field, border), &blocks, (band, texels), [buffer, image]);
    }
    let settings = [
        ("method", "visible triangles".to_owned()),
        ("border", format!("{border:?}").to_lowercase()),
        ("directions", count.to_string()),
        ("facet_mask", bytes_text(bytes)),
    ];
    let settings = settings.map(|(name, value)| (name.to_owned(), value)).to_vec();
    Plan::finish(builder, size, Vec::new(), Vec::new(), settings, limits)
}
