// Computes: one light's share of the picture: its sum times its colour and the surface's albedo.
// Reads: sum (scalar_sum or colour_sum), albedo. Reads and writes: radiance. Writes: layer.
// One invocation is one sample.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool SUM_HAS_COLOUR = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 2) const bool ADDS_TO_RADIANCE = true;
layout(constant_id = 3) const bool WRITES_LAYER = false;

layout(binding = 0) uniform texture2D scalar_sum;
layout(binding = 1) uniform texture2D colour_sum;
layout(binding = 2) uniform texture2D albedo_map;
layout(binding = 3, rgba32f) uniform image2D radiance;
layout(binding = 4, rgba32f) uniform writeonly image2D layer;

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
        imageStore(layer, at, vec4(light, 1.0));
    }
    if (ADDS_TO_RADIANCE) {
        vec3 sum = clears == 1u ? vec3(0.0) : imageLoad(radiance, at).rgb;
        imageStore(radiance, at, vec4(sum + light, 1.0));
    }
}
