// Computes: the weight of each direction on a curved base surface: the solid angle of its triangles over that on the
// flat field. It is the importance of paths along that direction (Heidrich et al. 2000, §5, figure 8).
// Reads: bent (see bent_directions), fans.
// Writes: fan_weights; 0 where folded triangles outweigh the others.
// One invocation is one grid point and one direction.
#version 460

#include "shared/angle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform texture2DArray bent;
layout(binding = 1) uniform textureBuffer fans;
layout(binding = 2, r32f) uniform writeonly image2DArray fan_weights;

layout(push_constant) uniform FanWeightsPush {
    int cols;
    int rows;
    int first_fan;        // texel of the first direction's
    int first_direction;  // of this dispatch
};

// Signed solid angle of a spherical triangle, negative if clockwise (Van Oosterom & Strackee 1983).
float area_sr(vec3 a, vec3 b, vec3 c) {
    // From the sides, whose rounding error is relative to their length.
    float volume = dot(a, cross(b - a, c - a));
    float below = 1.0 + dot(a, b) + dot(b, c) + dot(c, a);
    float half_angle = arc_tangent(vec4(volume / (abs(below) < 1e-9 ? 1e-9 : below))).x;
    return 2.0 * (below < 0.0 ? half_angle + (volume < 0.0 ? -PI : PI) : half_angle);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int i = first_direction + int(gl_WorkGroupID.z);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec4 fan = texelFetch(fans, first_fan + i);
    vec3 e = texelFetch(bent, ivec3(at, i), 0).xyz;
    float sum = 0.0;
    for (int k = 0; k < int(fan.y); k++) {
        vec4 pair = texelFetch(fans, int(fan.x) + k);
        sum += area_sr(e, texelFetch(bent, ivec3(at, int(pair.x)), 0).xyz, texelFetch(bent, ivec3(at, int(pair.y)), 0).xyz);
    }
    float weight = fan.z > 0.0 ? max(sum / fan.z, 0.0) : 1.0;
    imageStore(fan_weights, ivec3(at, i), vec4(weight));
}
