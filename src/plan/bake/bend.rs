//! Visible points on a curved base surface, computed from those on the flat one.

use super::visible_points::texels;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};

use crate::passes::{bent_directions, fan_weights};
use crate::scene::{Border, Curvature, Directions, Fans, HeightField};
use crate::{Error, Result};

/// Approximate number of rays that one dispatch bends: tenths of a second on a slow device.
const BAND_RAYS: u64 = 1 << 23;

/// Resources shared by passes on a curved base.
pub(super) struct Bends {
    /// Directions, then fans.
    buffer: ResourceId,
    texels: [usize; 2],
    count: u32,
    /// Directions of each texel in its own frame, with their visible points.
    pub bent: ResourceId,
}

impl Bends {
    /// Uploads the triangulation of the directions and creates the image of bent directions.
    ///
    /// # Errors
    /// Directions without a triangulation; more of them than an image has layers.
    pub(super) fn make(
        builder: &mut Builder,
        size: [u32; 2],
        directions: &Directions,
        limits: &Limits,
    ) -> Result<Self> {
        let count = directions.count() as u32;
        if count > limits.image_layers {
            return Err(Error::Limit {
                what: "directions on a curved base".into(),
                needs: format!("an image of {count} layers"),
                limit: format!("{} on this device; fewer directions fit", limits.image_layers),
            });
        }
        let net = directions.triangles()?;
        let fans = Fans::of(&net, directions.vectors());
        let (buffer, first) = builder.constants(&texels(directions));
        let first_pair = first + 2 * directions.count();
        let (_, first_fan) = builder.constants(&fan_texels(&fans, first_pair));
        let extent = [size[0], size[1], count];
        let bent = builder.image("bent", Owner::Internal, Format::Rgba32Float, extent, true);
        Ok(Self { buffer, texels: [first, first_fan], count, bent })
    }

    /// Plans the passes that fill [`bent`](Self::bent); `points` and `ground` are those of the flat field.
    pub(super) fn plan(
        &self,
        builder: &mut Builder,
        (field, border): (&HeightField, Border),
        curvature: Curvature,
        [points, ground]: [ResourceId; 2],
    ) {
        let bound = [
            ("visible_points", points),
            ("ground", ground),
            ("directions", self.buffer),
            ("fans", self.buffer),
            ("bent", self.bent),
        ];
        let [x, y] = curvature.per_m;
        for band in self.bands(field) {
            let part = format!("curvature {x} {y}, directions {}..{}", band.start, band.end);
            let of = (curvature, part.as_str());
            bent_directions::plan(builder, (field, border), of, band, self.texels, &bound);
        }
    }

    /// Plans the passes that weigh the directions; returns their image.
    pub(super) fn weigh(&self, builder: &mut Builder, field: &HeightField) -> ResourceId {
        let extent = [field.cols() as u32, field.rows() as u32, self.count];
        let weights = builder.image("fan_weights", Owner::Internal, Format::R32Float, extent, true);
        let bound = [("bent", self.bent), ("fans", self.buffer), ("fan_weights", weights)];
        for band in self.bands(field) {
            let part = format!("directions {}..{}", band.start, band.end);
            fan_weights::plan(builder, field, (band, &part), self.texels[1], &bound);
        }
        weights
    }

    fn bands(&self, field: &HeightField) -> impl Iterator<Item = std::ops::Range<u32>> + use<> {
        let grid_points = (field.rows() * field.cols()) as u64;
        let each = (BAND_RAYS / grid_points).clamp(1, self.count.into());
        let count = self.count;
        (0..count).step_by(each as usize).map(move |first| first..count.min(first + each as u32))
    }
}

/// For each direction: the first of its triangles, their number and their solid angle; then the two other corners of all
/// triangles in turn.
fn fan_texels(fans: &Fans, first_pair: usize) -> Vec<f32> {
    let mut next = first_pair;
    let mut texels = Vec::new();
    for (pairs, flat) in fans.pairs.iter().zip(&fans.flat_sr) {
        texels.extend([next as f32, pairs.len() as f32, *flat as f32, 0.0]);
        next += pairs.len();
    }
    let pairs = fans.pairs.iter().flatten();
    texels.extend(pairs.flat_map(|[a, b]| [*a as f32, *b as f32, 0.0, 0.0]));
    texels
}
