// Computes: height and exit radiance of every grid point, side by side for the walks.
// Reads: heights, exit_radiance (or exit_grey).
// Writes: bounce_ground (or grey_ground).
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// One channel of radiance.
layout(constant_id = 0) const bool GREY = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, rgba32f) uniform readonly image2D exit_radiance;
layout(binding = 2, r32f) uniform readonly image2D exit_grey;
layout(binding = 3, rgba32f) uniform writeonly image2D bounce_ground;
layout(binding = 4, rgba16ui) uniform writeonly uimage2D grey_ground;

layout(push_constant) uniform BounceGroundPush {
    int cols;
    int rows;
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    float height = texelFetch(heights, at, 0).x;
    if (GREY) {
        vec2 two = vec2(imageLoad(exit_grey, at).x, height);
        imageStore(grey_ground, at, split_u32(floatBitsToUint(two)));
    } else {
        imageStore(bounce_ground, at, vec4(imageLoad(exit_radiance, at).rgb, height));
    }
}
