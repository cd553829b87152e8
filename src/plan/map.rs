use super::Plan;
use crate::graph::{Builder, Format, Limits, Owner};
use crate::passes::map_draw::Map;
use crate::{Result, passes};

/// The pass of a [`Map`].
///
/// Inputs, in order: "radiance"; "tone_steps" ([`Tone::steps`](crate::scene::Tone) of the map's tone); "voids" if there are any: 0 on
/// ground, 1 in a void. Output: "picture", the four bytes of each pixel as one word, the first byte lowest, the last 255.
/// Without voids, and from texels inside the field, it has the codes of `write_png`.
///
/// # Errors
/// A value out of range, or a picture beyond the limits.
pub fn map(map: &Map, limits: &Limits) -> Result<Plan> {
    map.check()?;
    let mut builder = Builder::new(limits);
    let mut image = |name: &str, owner: Owner, format: Format, [width, height]: [u32; 2]| {
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let format = if map.has_colour { Format::Rgba32Float } else { Format::R32Float };
    let mut bound = vec![
        ("radiance", image("radiance", Owner::Input, format, map.field)),
        ("tone_steps", image("tone_steps", Owner::Input, Format::R32Float, [256, 1])),
    ];
    if map.has_voids {
        bound.push(("voids", image("voids", Owner::Input, Format::R32Float, map.field)));
    }
    bound.push(("picture", image("picture", Owner::Output, Format::R32Uint, map.size)));
    passes::map_draw::plan(&mut builder, map, &bound);
    let none = Vec::new();
    Plan::finish(builder, map.field, Vec::new(), none, Vec::new(), limits)
}
