//! Sphere lights by spherical harmonics: the constants of their passes, and where horizons come from.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::basis::bands;
use crate::basis::wedge::WedgeTable;
use crate::graph::{Builder, ResourceId};
use crate::passes::pyramid::Pyramid;
use crate::passes::pyramid_march;
use crate::passes::sh_layout::{Lit, by_fours, matrix};
use crate::scene::{Border, Method, Quality, Receiver, Wedges};

/// Sizes and offsets in [`Plan::constants`](crate::plan::Plan::constants), in texels of four.
pub(crate) struct SphereSh {
    pub order: u32,
    pub wedges: Wedges,
    pub receiver: Receiver,
    pub azimuths: u32,
    pub constants: ResourceId,
    pub entry_first: usize,
    pub entry_count: usize,
    pub table_first: usize,
    pub side: u32,
    /// Where horizons come from: levels of a height pyramid where any are read, else the surface.
    pub pyramid: Option<(Pyramid, Option<pyramid_march::Images>)>,
}

impl SphereSh {
    /// Sizes and constants for a quality. `levels` are those of a pyramid that the plan has for other lights.
    pub(crate) fn make(
        builder: &mut Builder,
        (size, border): ([u32; 2], Border),
        quality: &Quality,
        heights: ResourceId,
        levels: Option<pyramid_march::Images>,
    ) -> Self {
        let (constants, entry_first) = builder.constants(&entries(quality));
        let entry_count = builder.constants.len() / 4 - entry_first;
        let (order, azimuths) = (quality.sh_order, quality.sun_azimuths);
        let table = (quality.wedges == Wedges::Table).then(|| {
            let (side, width) = (quality.wedge_side as usize, TAU / f64::from(azimuths));
            let table = WedgeTable::new(order as usize, side, -FRAC_PI_2, width);
            table.texels.iter().flat_map(|texel| by_fours(texel)).collect::<Vec<f32>>()
        });
        let table_first = table.map_or(0, |texels| builder.constants(&texels).1);
        let pyramid = (quality.method == Method::Pyramid).then(|| {
            let pyramid = Pyramid::new(quality, size, border);
            let levels = levels.or_else(|| {
                let images = pyramid.images(builder);
                images.inspect(|images| pyramid.plan(builder, heights, images))
            });
            (pyramid, levels)
        });
        Self {
            order,
            wedges: quality.wedges,
            receiver: quality.receiver,
            azimuths,
            constants,
            entry_first,
            entry_count,
            table_first,
            side: quality.wedge_side,
            pyramid,
        }
    }

    /// The settings in use, as (name, value).
    pub(crate) fn settings(&self, quality: &Quality) -> Vec<(String, String)> {
        let mut all = vec![
            ("sh_order", self.order.to_string()),
            ("wedges", self.wedges.name().to_owned()),
            ("receiver", self.receiver.name().to_owned()),
            ("window", quality.window.name().to_owned()),
        ];
        if self.wedges == Wedges::Table {
            all.push(("wedge_side", self.side.to_string()));
        }
        if let Some((pyramid, _)) = &self.pyramid {
            all.extend([
                ("method", "pyramid".to_owned()),
                ("level_step", pyramid.level_step.to_string()),
                ("level_offset", pyramid.level_offset.to_string()),
                ("levels", pyramid.stored.name().to_owned()),
            ]);
        }
        all.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

/// Row of the receiver's polynomials, index in visibility, index in the light's series and the weight of their
/// product, for all products that a sphere light towards azimuth 0 takes part in: none with m < 0.
fn entries(quality: &Quality) -> Vec<f32> {
    let (order, light_order) = (quality.sh_order as usize, quality.light_order());
    let row_first = if quality.receiver == Receiver::Plane { 1 } else { 0 };
    let mut all = Vec::new();
    let lit = Lit::diffuse(quality.receiver);
    for (at, shares) in matrix(quality, light_order, lit).iter().enumerate() {
        let (row, coefficient) = (row_first + at / (order * order), at % (order * order));
        for (i, ((_, m), share)) in bands(light_order).zip(shares).enumerate() {
            // Products that are not 0 are above 1e-4: three harmonics, over π.
            if m >= 0 && share.abs() > 1e-9 {
                all.extend([row as f32, coefficient as f32, i as f32, *share as f32]);
            }
        }
    }
    all
}
