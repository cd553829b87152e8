use super::bend::Bends;
use super::visible_points::{check_field, images, one_image, plan_batch, texels};
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::ellipse_fit as pass;
use crate::plan::Plan;
use crate::scene::{Border, Curvature, Directions, HeightField, OcclusionChange};
use crate::{Error, Result};

/// Approximate number of directions that one dispatch reads, in some dozens of steps with sixteen ellipses each: tenths
/// of a second on a slow device.
const BAND_RAYS: u64 = 1 << 26;

/// Passes that fit an ellipse to the visible sky directions of each texel (`Ellipse`): six numbers for a shadow test
/// (Heidrich et al. 2000, §4).
///
/// Input: "heights". Outputs: "ellipse_axes", centre (east, north) and unit axis (east, north); "ellipse_radii", one over
/// the radius along the axis and across it, the lit minus the shadowed directions inside, and the last step of the
/// search, 0 for a full or an empty disc.
///
/// Only `directions` above horizontal count, all equally; `lowest_z` 0 wastes none below.
///
/// # Errors
/// A field too large for 16 bits per coordinate; no direction above horizontal; more visible points than one image
/// holds; a scene beyond the limits.
pub fn ellipses(
    field: &HeightField,
    border: Border,
    directions: &Directions,
    limits: &Limits,
) -> Result<Plan> {
    let mut begun = Begun::new(field, border, directions, limits)?;
    let outputs = ["ellipse_axes", "ellipse_radii"].map(|name| begun.output(name));
    begun.fit((None, ""), outputs);
    begun.finish(("ellipses of visible sky", None), Vec::new(), limits)
}

/// The ellipses of [`ellipses`] five times: on the flat base, and on bases bent towards east and then north by the two
/// curvatures, both above 0, outwards and inwards (Heidrich et al. 2000, §5). Hollows allow less curvature before
/// visibility changes. Between them ellipses change linearly: `CurvedEllipses`.
///
/// Input: "heights". Outputs: "ellipse_axes.k" and "ellipse_radii.k" of k = 0 to 4: flat, east +, east -, north +, north -.
///
/// # Errors
/// As [`ellipses`]; curvatures that are not above 0 or that [`Curvature::check`] rejects; directions without a
/// triangulation.
pub fn curved_ellipses(
    field: &HeightField,
    border: Border,
    directions: &Directions,
    [outwards, inwards]: [f64; 2],
    limits: &Limits,
) -> Result<Plan> {
    if ![outwards, inwards].iter().all(|k| *k > 0.0 && (*k as f32).is_normal()) {
        let found = format!("{outwards:?} and {inwards:?}");
        return Err(Error::setting("curvatures of ellipses", found, "two numbers above 0, 1/m"));
    }
    let four = [[outwards, 0.0], [-inwards, 0.0], [0.0, outwards], [0.0, -inwards]];
    let four = four.map(|per_m| Curvature { per_m });
    let changed = four.iter().map(|curvature| curvature.check(field, border));
    let changed = changed.collect::<Result<Vec<OcclusionChange>>>()?;
    let mut begun = Begun::new(field, border, directions, limits)?;
    let bends = Bends::make(&mut begun.builder, begun.size, directions, limits)?;
    let outputs: Vec<[ResourceId; 2]> = (0..5)
        .map(|i| ["ellipse_axes", "ellipse_radii"].map(|name| begun.output(&format!("{name}.{i}"))))
        .collect();
    begun.fit((None, "flat, "), outputs[0]);
    let names = ["east +", "east -", "north +", "north -"];
    let notes =
        changed.iter().zip(names).map(|(changed, name)| format!("the base bent {name}: {changed}"));
    for ((curvature, name), outputs) in four.into_iter().zip(names).zip(&outputs[1..]) {
        let points = [begun.points, begun.ground];
        bends.plan(&mut begun.builder, (field, border), curvature, points);
        begun.fit((Some(bends.bent), &format!("{name}, ")), *outputs);
    }
    let method = "ellipses of visible sky on curved bases";
    begun.finish((method, Some([outwards, inwards])), notes.collect(), limits)
}

/// A plan that has its visible points.
struct Begun<'a> {
    field: &'a HeightField,
    border: Border,
    directions: &'a Directions,
    size: [u32; 2],
    builder: Builder,
    points: ResourceId,
    ground: ResourceId,
    buffer: ResourceId,
    first: usize,
}

impl<'a> Begun<'a> {
    fn new(
        field: &'a HeightField,
        border: Border,
        directions: &'a Directions,
        limits: &Limits,
    ) -> Result<Self> {
        let size = limits.check_size(field.rows(), field.cols())?;
        check_field(field)?;
        if directions.vectors().iter().all(|e| e.z <= 0.0) {
            return Err(Error::setting("directions", "none above horizontal", "one or more"));
        }
        let mut builder = Builder::new(limits);
        let extent = [size[0], size[1], 1];
        let heights = builder.image("heights", Owner::Input, Format::R32Float, extent, false);
        let all = images(&mut builder, size, directions.count(), Owner::Internal, limits)?;
        let points = one_image(field, directions, &all, limits)?;
        let blocks = Blocks::make(&mut builder, size, border, true);
        blocks.plan(&mut builder, field, heights, None);
        let (buffer, first) = builder.constants(&texels(directions));
        let image = all.into_iter().next().expect("one image");
        plan_batch(&mut builder, (field, border), &blocks, (buffer, first), directions, image);
        let ground = blocks.ground;
        Ok(Self { field, border, directions, size, builder, points, ground, buffer, first })
    }

    fn output(&mut self, name: &str) -> ResourceId {
        let extent = [self.size[0], self.size[1], 1];
        self.builder.image(name, Owner::Output, Format::Rgba32Float, extent, false)
    }

    /// Fits one ellipse per texel, for directions as they are or on a curved base.
    fn fit(&mut self, (bent, base): (Option<ResourceId>, &str), [axes, radii]: [ResourceId; 2]) {
        let mut bound = vec![("ellipse_axes", axes), ("ellipse_radii", radii)];
        match bent {
            Some(bent) => bound.push(("bent", bent)),
            None => bound.extend([("visible_points", self.points), ("directions", self.buffer)]),
        }
        let band = BAND_RAYS / (u64::from(self.size[0]) * self.directions.count() as u64);
        let band = (band as u32 / 8 * 8).clamp(8, self.size[1].next_multiple_of(8));
        for row in (0..self.size[1]).step_by(band as usize) {
            let rows = row..self.size[1].min(row + band);
            let directions = (self.directions, self.first);
            pass::plan(&mut self.builder, self.field, directions, (rows, base), &bound);
        }
    }

    fn finish(
        self,
        (method, curvature): (&str, Option<[f64; 2]>),
        notes: Vec<String>,
        limits: &Limits,
    ) -> Result<Plan> {
        let settings = [
            ("method", method.to_owned()),
            ("border", format!("{:?}", self.border).to_lowercase()),
            ("directions", self.directions.count().to_string()),
            ("lowest_direction_z", self.directions.lowest_z().to_string()),
        ];
        let curvature = curvature.map(|k| ("curvatures_per_m", format!("{k:?}")));
        let settings = settings.into_iter().chain(curvature);
        let settings = settings.map(|(name, value)| (name.to_owned(), value)).collect();
        Plan::finish(self.builder, self.size, Vec::new(), notes, settings, limits)
    }
}
