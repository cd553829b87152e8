use crate::graph::bytes_text;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::visible_points as pass;
use crate::plan::Plan;
use crate::scene::{Border, Directions, HeightField, REACH_CELLS, VisiblePoints};
use crate::{Error, Result};
use std::ops::Range;

/// Approximate number of rays per dispatch: tenths of a second on a slow device, below its watchdog.
const BAND_RAYS: u64 = 1 << 24;

/// Passes that find the visible point of every texel in each direction: [`VisiblePoints`].
///
/// Input: "heights". Outputs: "visible_points", one u32 per texel and layer. The device's limits on layers and allocations
/// may split it into "visible_points.0", "visible_points.1", …, each of whole layers in order. Their words in sequence are
/// those of [`VisiblePoints::new`].
///
/// A ray ends where it hits the surface, leaves the field, or has risen above all of it. Under `periodic` a ray with a
/// slope of s per cell ends within relief / s cells. Rays flatter than relief / 16384 per cell stop after that distance
/// and then count as sky or, if level or falling, as black ground; a note states how many directions these are.
///
/// # Errors
/// A field of unknown heights, or too large for 16 bits per coordinate; a scene beyond the limits.
pub fn visible_points(
    field: &HeightField,
    border: Border,
    directions: &Directions,
    limits: &Limits,
) -> Result<Plan> {
    let size = limits.check_size(field.rows(), field.cols())?;
    check_field(field)?;
    let mut builder = Builder::new(limits);
    let heights =
        builder.image("heights", Owner::Input, Format::R32Float, [size[0], size[1], 1], false);
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    let images = images(&mut builder, size, directions.count(), Owner::Output, limits)?;
    let blocks = Blocks::make(&mut builder, size, border, true);
    blocks.plan(&mut builder, field, heights, None);
    let (buffer, first) = builder.constants(&texels(directions));
    for (image, layers) in images {
        plan_batch(
            &mut builder,
            (field, border),
            &blocks,
            (buffer, first),
            directions,
            (image, layers),
        );
    }
    let bytes = size.iter().map(|n| u64::from(*n)).product::<u64>()
        * 4
        * VisiblePoints::layers(directions.count(), is_small) as u64;
    let settings = vec![
        ("method".to_owned(), "visible points".to_owned()),
        ("border".to_owned(), format!("{border:?}").to_lowercase()),
        ("directions".to_owned(), directions.count().to_string()),
        ("lowest_direction_z".to_owned(), directions.lowest_z().to_string()),
        ("bytes_of_a_point".to_owned(), if is_small { "2" } else { "4" }.to_owned()),
        ("visible_points".to_owned(), bytes_text(bytes)),
    ];
    let mut notes = Vec::new();
    let flat = cut_short(field, border, directions);
    if flat > 0 {
        let of = directions.count();
        notes.push(format!(
            "{flat} of {of} directions are so flat that their rays are given up after {REACH_CELLS} cells"
        ));
    }
    Plan::finish(builder, size, Vec::new(), notes, settings, limits)
}

/// # Errors
/// Unknown heights, as rays end above the highest; a side whose numbers could equal a mark.
pub(super) fn check_field(field: &HeightField) -> Result<()> {
    field.check_known("field of visible points", "heights: rays end above the highest")?;
    let longest = field.rows().max(field.cols());
    if longest <= VisiblePoints::LARGEST_SIDE {
        return Ok(());
    }
    Err(Error::Limit {
        what: format!("visible points of a field of {} × {}", field.cols(), field.rows()),
        needs: format!("{longest} grid points a side"),
        limit: format!("{} in 16 bits", VisiblePoints::LARGEST_SIDE),
    })
}

/// Images for all layers, each with its range of layers.
///
/// # Errors
/// One layer larger than an allocation of the device.
pub(super) fn images(
    builder: &mut Builder,
    size: [u32; 2],
    directions: usize,
    owner: Owner,
    limits: &Limits,
) -> Result<Vec<(ResourceId, Range<u32>)>> {
    let is_small = VisiblePoints::is_small(size[1] as usize, size[0] as usize);
    let layers = VisiblePoints::layers(directions, is_small) as u32;
    let layer_bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
    let most = (limits.allocation_bytes / layer_bytes).min(limits.image_layers.into()) as u32;
    if most == 0 {
        return Err(Error::Limit {
            what: "visible points of one direction".into(),
            needs: bytes_text(layer_bytes),
            limit: format!(
                "{} in one allocation on this device",
                bytes_text(limits.allocation_bytes)
            ),
        });
    }
    // Even numbers, so that in every image pairs of directions begin with an even one.
    let each = if most >= layers { layers } else { (most / 2 * 2).max(1) };
    let all = (0..layers).step_by(each as usize).enumerate().map(|(k, first)| {
        let band = first..layers.min(first + each);
        let name = match layers > each {
            true => format!("visible_points.{k}"),
            false => "visible_points".to_owned(),
        };
        let extent = [size[0], size[1], band.end - band.start];
        (builder.image(name, owner, Format::R32Uint, extent, true), band)
    });
    Ok(all.collect())
}

/// The image of all directions, for passes that read them together.
///
/// # Errors
/// Several images.
pub(super) fn one_image(
    field: &HeightField,
    directions: &Directions,
    all: &[(ResourceId, Range<u32>)],
    limits: &Limits,
) -> Result<ResourceId> {
    if let [(points, _)] = all {
        return Ok(*points);
    }
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    let (count, grid_points) = (directions.count(), (field.rows() * field.cols()) as u64);
    let layers = VisiblePoints::layers(count, is_small) as u64;
    Err(Error::Limit {
        what: format!("visible points in {count} directions together"),
        needs: format!("one image of {layers} layers, {}", bytes_text(4 * grid_points * layers)),
        limit: format!(
            "{} layers and {} in one allocation; fewer directions or a smaller field fit",
            limits.image_layers,
            bytes_text(limits.allocation_bytes)
        ),
    })
}

/// One texel per direction: east, north, up.
pub(super) fn texels(directions: &Directions) -> Vec<f32> {
    let vectors = directions.vectors().iter();
    vectors.flat_map(|v| [v.x as f32, v.y as f32, v.z as f32, 0.0]).collect()
}

/// The dispatches that fill an image; the texels of its directions begin at `first` in the buffer.
pub(super) fn plan_batch(
    builder: &mut Builder,
    (field, border): (&HeightField, Border),
    blocks: &Blocks,
    (buffer, first): (ResourceId, usize),
    directions: &Directions,
    (image, layers): (ResourceId, Range<u32>),
) {
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    let of_layer = if is_small { 2 } else { 1 };
    let count = directions.count();
    let start = of_layer * layers.start as usize;
    let end = count.min(of_layer * layers.end as usize);
    let layer_rays = (field.rows() * field.cols() * of_layer) as u64;
    let at_once = (BAND_RAYS / layer_rays).clamp(1, u64::from(layers.end - layers.start)) as u32;
    let own = layers.end - layers.start;
    for low in (0..own).step_by(at_once as usize) {
        let high = own.min(low + at_once);
        let [from, to] = [low, high].map(|layer| count.min(start + of_layer * layer as usize));
        let part = format!("directions {from}..{to}");
        pass::plan(
            builder,
            (field, border),
            blocks,
            (low..high, first + start..first + end, is_small),
            &part,
            [buffer, image],
        );
    }
}

/// Number of directions whose rays over repetitions end early: those that rise or fall by less than the relief over the
/// largest traced distance.
fn cut_short(field: &HeightField, border: Border, directions: &Directions) -> usize {
    if border != Border::Periodic {
        return 0;
    }
    let heights = field.heights_m().iter();
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(l, h), z| (l.min(*z), h.max(*z)));
    let relief = f64::from(high) - f64::from(low);
    let [x, y] = field.cell_m();
    // Rays count cells along their faster axis.
    let of_cell = |v: &glam::DVec3| v.z.abs() / (v.x.abs() / x).max(v.y.abs() / y).max(1e-9);
    let flat = |v: &&glam::DVec3| of_cell(v) * f64::from(REACH_CELLS) < relief;
    directions.vectors().iter().filter(flat).count()
}
