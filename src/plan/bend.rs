//! Visible points on a curved base, between those on the flat one and what is made of them.

use super::visible_points::texels;
use crate::graph::{Builder, Format, Limits, Owner, ResourceId};

use crate::passes::{bent_directions, fan_weights};
use crate::scene::{Border, Curvature, Directions, Fans, HeightField};
use crate::{Error, Result};

/// Looks that one dispatch bends, about: tenths of a second on a slow device.
const BAND_LOOKS: u64 = 1 << 23;

/// What passes on curved bases share.
pub(super) struct Bends {
    /// Directions, then fans.
    buffer: ResourceId,
    texels: [usize; 2],
    count: u32,
    /// Directions of each sample in its own frame, and what they meet.
    pub bent: ResourceId,
}

impl Bends {
    /// The directions' net as the device reads it, and the image that they come to stand in.
    ///
    /// # Errors
    /// Directions that span no net; more of them than an image has layers.
    pub fn make(
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

    /// The passes that fill [`bent`](Self::bent); `points` and `ground` are the flat field's.
    pub fn record(
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

    /// The passes that weigh them, and their image.
    pub fn weigh(&self, builder: &mut Builder, field: &HeightField) -> ResourceId {
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
        let samples = (field.rows() * field.cols()) as u64;
        let each = (BAND_LOOKS / samples).clamp(1, self.count.into());
        let count = self.count;
        (0..count).step_by(each as usize).map(move |first| first..count.min(first + each as u32))
    }
}

/// Of each direction where its triangles begin, how many they are, and their solid angle; then of all in turn the two other
/// corners.
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
