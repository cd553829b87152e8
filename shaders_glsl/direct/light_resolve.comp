// Computes: exit radiance of one light: its sum times its colour and the surface's albedo.
// Reads: scalar_sum or colour_sum, light_colours, albedo_map, dirty_texels, edit_list.
// Reads and writes: radiance (or radiance_grey).
// Writes: layer (or layer_grey).
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

#include "edit/dirty.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool SUM_HAS_COLOUR = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 2) const bool ADDS_TO_RADIANCE = true;
layout(constant_id = 3) const bool WRITES_LAYER = false;
// All colours are grey: images of one channel.
layout(constant_id = 4) const bool GREY = false;
// Only the grid points marked in dirty_texels, from the list of their words.
layout(constant_id = 5) const bool RELIGHTS = false;
// The light's colour is a texel of the caller's image.
layout(constant_id = 6) const bool COLOUR_IS_TEXEL = false;

layout(binding = 0) uniform texture2D scalar_sum;
layout(binding = 1) uniform texture2D colour_sum;
layout(binding = 2) uniform texture2D albedo_map;
layout(binding = 3, rgba32f) uniform image2D radiance;
layout(binding = 4, rgba32f) uniform writeonly image2D layer;
layout(binding = 5, r32f) uniform image2D radiance_grey;
layout(binding = 6, r32f) uniform writeonly image2D layer_grey;
layout(binding = 7) readonly buffer DirtyTexels { uint dirty_texels[]; };
layout(binding = 8) readonly buffer EditList { uint swept_steps; uint word_count; uint light_groups[3]; uint resolve_groups[3]; uint dirty_words[]; };
// One row, one texel per light.
layout(binding = 9) uniform texture2D light_colours;

layout(push_constant) uniform LightResolvePush {
    int cols;
    int rows;
    uint clears;  // 1 for the first light
    int texel;    // of light_colours
    vec4 colour;  // of the light, for a scalar sum without a texel; includes a constant albedo
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (RELIGHTS) {
        uint group = gl_WorkGroupID.y * GROUPS_ACROSS + gl_WorkGroupID.x;
        uint texel_of_list = group * (32u * RESOLVE_GROUP_WORDS) + gl_LocalInvocationIndex;
        uint word = dirty_words[min(texel_of_list >> 5, word_count - 1u)];
        uint i = texel_of_list & 31u;
        bool is_marked = (dirty_texels[word] >> i & 1u) != 0u;
        at = (texel_of_list >> 5) < word_count && is_marked ? word_corner(word, cols) + ivec2(i & 7u, i >> 3)
                                                             : ivec2(0x7fffffff);
    }
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    // precise: radiance must equal the sum of the layers, and an edit must equal a whole frame, bit for bit.
    precise vec4 light = SUM_HAS_COLOUR ? texelFetch(colour_sum, at, 0) : texelFetch(scalar_sum, at, 0).xxxx;
    // Rounding can make an almost hidden light negative. NaN stays NaN.
    light = mix(light, vec4(0.0), lessThan(light, vec4(0.0)));
    // Colour first, in the host's order of multiplication: the same bits.
    light *= COLOUR_IS_TEXEL ? colour * texelFetch(light_colours, ivec2(texel, 0), 0) : colour;
    if (ALBEDO_IS_MAP) {
        light *= texelFetch(albedo_map, at, 0);
    }
    light.w = 1.0;
    // The first light overwrites the old content, which may be NaN.
    bool keeps = clears == 0u;
    if (GREY) {
        if (WRITES_LAYER) {
            imageStore(layer_grey, at, light);
        }
        if (ADDS_TO_RADIANCE) {
            precise vec4 sum = imageLoad(radiance_grey, at) + light;
            imageStore(radiance_grey, at, keeps ? sum : light);
        }
    } else {
        if (WRITES_LAYER) {
            imageStore(layer, at, light);
        }
        if (ADDS_TO_RADIANCE) {
            precise vec4 sum = imageLoad(radiance, at) + light;
            imageStore(radiance, at, vec4((keeps ? sum : light).rgb, 1.0));
        }
    }
}
