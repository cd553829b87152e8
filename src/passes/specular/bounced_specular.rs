//! Specular reflection of indirect light (Nowrouzezahrai & Snyder 2009, §5.3 and §7).
//!
//! Light arrives at every texel as an SH series: first direct light, then for each bounce the light that
//! `specular_gather` finds. `specular_exit` turns it into exit radiance, with diffuse light added. That is an
//! SH series again, whose pyramid is read in the direction to each texel that receives it; or one number, the
//! radiance towards the zenith.

use crate::basis::harmonics::{evaluate, product_rule};
use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::pyramid::Pyramid;
use crate::passes::sh_layout::by_fours;
use crate::scene::{BounceSpecular, Quality};

/// SH series of incoming light and of exit radiance.
#[derive(Clone, Copy)]
pub(crate) struct BouncedSpecular {
    /// Order of the series.
    pub order: u32,
    /// Whether radiance has one channel.
    pub grey: bool,
    /// Four coefficients per layer, channel after channel.
    pub arriving: ResourceId,
    /// Specular reflection of all bounces towards the view.
    pub bounced: ResourceId,
    pub layer: Option<ResourceId>,
    pub outgoing: ExitLight,
}

/// Exit radiance.
#[derive(Clone, Copy)]
pub(crate) enum ExitLight {
    Vectors(Vectors),
    /// Exit radiance towards the zenith.
    Upward(ResourceId),
}

/// Exit radiance as SH series.
#[derive(Clone, Copy)]
pub(crate) struct Vectors {
    /// Laid out as the series of incoming light.
    pub exit: ResourceId,
    /// All levels above the field's own resolution, and their table.
    pub levels: Option<[ResourceId; 2]>,
    /// Whether they are f16.
    pub halves: bool,
    /// Directions for the rotation of series.
    pub constants: ResourceId,
    pub first_texel: usize,
    /// Groups of four directions.
    pub fours: usize,
}

impl BouncedSpecular {
    /// Images for a field of `size`; `shade` are the levels of exit radiance, where the engine reads levels.
    pub(crate) fn make(
        builder: &mut Builder,
        (size, shade): ([u32; 2], Option<&Pyramid>),
        quality: &Quality,
        (grey, layers): (bool, bool),
        notes: &mut Vec<String>,
    ) -> Self {
        let [cols, rows] = size;
        let order = quality.sh_order;
        let count = layers_of(order, grey);
        let mut image =
            |name: &str, owner: Owner, format: Format, extent: [u32; 3], layered: bool| {
                builder.image(name, owner, format, extent, layered)
            };
        let colour = if grey { Format::R32Float } else { Format::Rgba32Float };
        let flat = [cols, rows, 1];
        let arriving = [cols, rows, count];
        let arriving = image("arriving", Owner::Internal, Format::Rgba32Float, arriving, true);
        let bounced = image("specular_bounced", Owner::Internal, Format::Rgba32Float, flat, false);
        let layer = layers.then(|| image("indirect.specular", Owner::Output, colour, flat, false));
        let outgoing = if quality.bounces.specular == BounceSpecular::Scalar {
            ExitLight::Upward(image("exit_upward", Owner::Internal, colour, flat, false))
        } else {
            let halves = quality.bounces.specular == BounceSpecular::VectorF16;
            notes.push(memory_note(size, shade, (order, count), halves));
            let format = if halves { Format::Rgba16Float } else { Format::Rgba32Float };
            let exit = image("exit_vectors", Owner::Internal, format, [cols, rows, count], true);
            let levels = shade.filter(|shade| shade.levels() > 0).map(|shade| {
                let width = 1 << shade.width_shift();
                let height = shade.all_texels().div_ceil(u64::from(width)) as u32;
                let extent = [width, height, count];
                let table = [shade.levels(), 1, 1];
                [
                    image("vector_levels", Owner::Internal, format, extent, true),
                    image("shade_table", Owner::Internal, Format::Rgba32Uint, table, false),
                ]
            });
            let texels = turning(order as usize);
            let fours = product_rule(order as usize).len().div_ceil(4);
            let (constants, first_texel) = builder.constants(&texels);
            ExitLight::Vectors(Vectors { exit, levels, halves, constants, first_texel, fours })
        };
        Self { order, grey, arriving, bounced, layer, outgoing }
    }

    /// Layers of four coefficients, of all channels.
    pub(crate) fn layers(&self) -> u32 {
        layers_of(self.order, self.grey)
    }

    /// Whether the series of exit radiance are of f16.
    pub(crate) fn halves(&self) -> bool {
        matches!(self.outgoing, ExitLight::Vectors(Vectors { halves: true, .. }))
    }

    /// Bytes per texel of the series of exit radiance.
    pub(crate) fn texel_bytes(&self) -> u64 {
        if self.halves() { 8 } else { 16 }
    }

    /// As the command line spells it.
    pub(crate) fn mode(&self) -> BounceSpecular {
        match self.outgoing {
            ExitLight::Upward(_) => BounceSpecular::Scalar,
            ExitLight::Vectors(Vectors { halves: true, .. }) => BounceSpecular::VectorF16,
            ExitLight::Vectors(_) => BounceSpecular::Vector,
        }
    }
}

fn layers_of(order: u32, grey: bool) -> u32 {
    (order * order).div_ceil(4) * if grey { 1 } else { 3 }
}

/// Memory of the pyramid of series, as stored and in the other precision.
fn memory_note(
    [cols, rows]: [u32; 2],
    shade: Option<&Pyramid>,
    (order, layers): (u32, u32),
    halves: bool,
) -> String {
    let texels = u64::from(cols) * u64::from(rows) + shade.map_or(0, Pyramid::all_texels);
    let [f32s, f16s] =
        [16, 8].map(|bytes| crate::graph::bytes_text(texels * u64::from(layers) * bytes));
    let [here, there] =
        if halves { [(f16s, "f16"), (f32s, "f32")] } else { [(f32s, "f32"), (f16s, "f16")] };
    format!(
        "radiance by direction of order {order}, all levels: {} as {}; {} as {}",
        here.0, here.1, there.0, there.1
    )
}

/// For each four directions: their x, y and z, then the Y_lm of each times its weight. Directions of weight 0
/// fill the last group.
fn turning(order: usize) -> Vec<f32> {
    let mut rule = product_rule(order);
    rule.resize(rule.len().next_multiple_of(4), (glam::DVec3::Z, 0.0));
    let mut texels = Vec::new();
    for four in rule.chunks_exact(4) {
        for axis in 0..3 {
            texels.extend(four.iter().map(|(o, _)| o[axis] as f32));
        }
        for (o, weight) in four {
            let weighed: Vec<f64> = evaluate(order, *o).iter().map(|y| weight * y).collect();
            texels.extend(by_fours(&weighed));
        }
    }
    texels
}
