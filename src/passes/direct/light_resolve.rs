use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::dirty_list;

/// One light's sum and where it is added.
pub(crate) struct Light {
    pub sum: ResourceId,
    /// Whether the sum has colour; else it has one channel.
    pub has_colour: bool,
    /// Colour of the light, where neither the sum nor a texel holds it, times a constant albedo.
    pub colour: [f32; 3],
    /// The caller's colours, and the light's index among them.
    pub texel: Option<(ResourceId, u32)>,
    pub albedo_map: Option<ResourceId>,
    /// The picture, and whether this light is its first.
    pub radiance: Option<(ResourceId, bool)>,
    pub layer: Option<ResourceId>,
    pub grey: bool,
    /// Texels that an edit changes: their mask and their list. Only these are resolved.
    pub edited: Option<[ResourceId; 2]>,
}

/// Adds one light to the picture, and writes its own layer where requested.
pub(crate) fn plan(builder: &mut Builder, [cols, rows]: [u32; 2], part: &str, light: &Light) {
    let mut bound = vec![(if light.has_colour { "colour_sum" } else { "scalar_sum" }, light.sum)];
    bound.extend(light.texel.map(|(colours, _)| ("light_colours", colours)));
    bound.extend(light.albedo_map.map(|a| ("albedo_map", a)));
    bound.extend(
        light.radiance.map(|r| (if light.grey { "radiance_grey" } else { "radiance" }, r.0)),
    );
    bound.extend(light.layer.map(|l| (if light.grey { "layer_grey" } else { "layer" }, l)));
    if let Some([dirty, list]) = light.edited {
        bound.extend([("dirty_texels", dirty), ("edit_list", list)]);
    }
    let grid_points = u64::from(cols) * u64::from(rows);
    let texel = if light.grey { 4 } else { 16 };
    let written = u64::from(light.radiance.is_some()) * 2 + u64::from(light.layer.is_some());
    let pass = builder.pass(
        shaders::LightResolve {
            sum_has_colour: light.has_colour,
            albedo_is_map: light.albedo_map.is_some(),
            adds_to_radiance: light.radiance.is_some(),
            writes_layer: light.layer.is_some(),
            grey: light.grey,
            relights: light.edited.is_some(),
            colour_is_texel: light.texel.is_some(),
        },
        part,
        "the light's sum, coloured, into the picture",
        shaders::LIGHT_RESOLVE.groups([cols, rows, 1]),
        &shaders::LightResolvePush {
            cols: cols as i32,
            rows: rows as i32,
            clears: u32::from(light.radiance.is_some_and(|r| r.1)),
            texel: light.texel.map_or(0, |(_, texel)| texel as i32),
            colour: [light.colour[0], light.colour[1], light.colour[2], 1.0],
        },
        &bound,
        grid_points * (if light.has_colour { 16 } else { 4 } + written * texel),
        grid_points,
    );
    pass.indirect = light.edited.map(|[_, list]| (list, dirty_list::RESOLVE_GROUPS_AT));
}
