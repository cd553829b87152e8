// Computes: one light's share of the picture: its sum times its colour and the surface's albedo.
// Reads: scalar_sum or colour_sum, albedo_map. Reads and writes: radiance (or radiance_grey). Writes:
// layer (or layer_grey).
// One invocation is one sample.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool SUM_HAS_COLOUR = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 2) const bool ADDS_TO_RADIANCE = true;
layout(constant_id = 3) const bool WRITES_LAYER = false;
// All colours are grey: pictures of one channel.
layout(constant_id = 4) const bool GREY = false;

layout(binding = 0) uniform texture2D scalar_sum;
layout(binding = 1) uniform texture2D colour_sum;
layout(binding = 2) uniform texture2D albedo_map;
layout(binding = 3, rgba32f) uniform image2D radiance;
layout(binding = 4, rgba32f) uniform writeonly image2D layer;
layout(binding = 5, r32f) uniform image2D radiance_grey;
layout(binding = 6, r32f) uniform writeonly image2D layer_grey;

layout(push_constant) uniform LightResolvePush {
    int cols;
    int rows;
    uint clears;  // 1 for the first light
    float pad;
    vec4 colour;  // of the light, where the sum has none; times the albedo, where that is constant
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 light = SUM_HAS_COLOUR ? texelFetch(colour_sum, at, 0).rgb : vec3(texelFetch(scalar_sum, at, 0).x);
    light *= colour.rgb;
    if (ALBEDO_IS_MAP) {
        light *= texelFetch(albedo_map, at, 0).rgb;
    }
    if (WRITES_LAYER) {
        if (GREY) {
            imageStore(layer_grey, at, vec4(light.x));
        } else {
            imageStore(layer, at, vec4(light, 1.0));
        }
    }
    if (ADDS_TO_RADIANCE && GREY) {
        float sum = clears == 1u ? 0.0 : imageLoad(radiance_grey, at).x;
        imageStore(radiance_grey, at, vec4(sum + light.x));
    } else if (ADDS_TO_RADIANCE) {
        vec3 sum = clears == 1u ? vec3(0.0) : imageLoad(radiance, at).rgb;
        imageStore(radiance, at, vec4(sum + light, 1.0));
    }
}
