use super::batch::bytes_text;
use super::blocks::Blocks;
use super::visible_points::{check_field, images, record, texels};
use super::{Builder, Format, Limits, Owner, Plan};
use crate::passes::ellipse_fit as pass;
use crate::scene::{Border, Directions, HeightField, VisiblePoints};
use crate::{Error, Result};

/// Directions that one dispatch looks at, about, in some dozens of steps with sixteen ellipses each: tenths of a second on
/// a slow device.
const BAND_LOOKS: u64 = 1 << 26;

/// Passes that find of each sample the ellipse that holds the directions in which it sees the sky
/// ([`Ellipse`](crate::cpu::ellipse_fit::Ellipse)): six numbers for a shadow test (Heidrich et al. 2000, §4).
///
/// Input: "heights". Outputs: "ellipse_axes", centre (east, north) and axis of length 1 (east, north); "ellipse_radii", one
/// over the radius along the axis and across it, the lit less the shadowed directions within, and the search's last step, 0
/// of the whole disc and of nothing.
///
/// Of `directions` those above horizontal count, as one each: `lowest_z` 0 spends none below.
///
/// # Errors
/// A field too large for 16 bits a coordinate; no direction above horizontal; more of what samples see than one image
/// holds; beyond the limits.
pub fn ellipses(
    field: &HeightField,
    border: Border,
    directions: &Directions,
    limits: &Limits,
) -> Result<Plan> {
    let size = limits.check_size(field.rows(), field.cols())?;
    check_field(field)?;
    if directions.vectors().iter().all(|e| e.z <= 0.0) {
        return Err(Error::setting("directions", "none above horizontal", "one or more"));
    }
    let mut builder = Builder::new();
    let mut image = |name: &str, owner: Owner, format: Format| {
        builder.image(name, owner, format, [size[0], size[1], 1], false)
    };
    let heights = image("heights", Owner::Input, Format::R32Float);
    let [axes, radii] =
        ["ellipse_axes", "ellipse_radii"].map(|n| image(n, Owner::Output, Format::Rgba32Float));
    let count = directions.count();
    let all = images(&mut builder, size, count, Owner::Internal, limits)?;
    let [(points, layers)] = all.as_slice() else {
        let is_small = VisiblePoints::is_small(field.rows(), field.cols());
        let samples = u64::from(size[0]) * u64::from(size[1]);
        let layers = VisiblePoints::layers(count, is_small) as u64;
        return Err(Error::Limit {
            what: format!("what samples see in {count} directions, for ellipses"),
            needs: format!("one image of {layers} layers, {}", bytes_text(4 * samples * layers)),
            limit: format!(
                "{} layers and {} in one allocation; fewer directions or a smaller field fit",
                limits.image_layers,
                bytes_text(limits.allocation_bytes)
            ),
        });
    };
    let blocks = Blocks::make(&mut builder, size, border);
    blocks.record(&mut builder, field, heights, None);
    let (buffer, first) = builder.constants(&texels(directions));
    let seen = (*points, layers.clone());
    record(&mut builder, (field, border), &blocks, (buffer, first), directions, seen);
    let bound = [
        ("visible_points", *points),
        ("directions", buffer),
        ("ellipse_axes", axes),
        ("ellipse_radii", radii),
    ];
    let band = BAND_LOOKS / (u64::from(size[0]) * count as u64);
    let band = (band as u32 / 8 * 8).clamp(8, size[1].next_multiple_of(8));
    for row in (0..size[1]).step_by(band as usize) {
        let rows = row..size[1].min(row + band);
        pass::plan(&mut builder, field, (directions, first), rows, &bound);
    }
    let settings = [
        ("method", "ellipses of visible sky".to_owned()),
        ("border", format!("{border:?}").to_lowercase()),
        ("directions", count.to_string()),
        ("lowest_direction_z", directions.lowest_z().to_string()),
    ];
    let settings = settings.map(|(name, value)| (name.to_owned(), value)).to_vec();
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), settings, limits)
}
