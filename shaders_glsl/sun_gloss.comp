// Computes: what a lobe about the mirror direction of the view from straight above reflects of a sun at every
// sample: the lobe towards the sun's middle, times the part of the sun that is seen. That part is what it gives to
// diffuse ground over what all of it would.
// Reads: lane_heights, sun_sum. Reads and writes: gloss_sum (exit radiance for scale 1, RGB).
// One invocation is four samples side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2D sun_sum;
layout(binding = 2, rgba32f) uniform image2D gloss_sum;

layout(push_constant) uniform SunGlossPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 towards;  // the sun's middle; w: the lobe's exponent
    vec4 colour;   // irradiance; w: 1 where the sum begins
};

#include "shared/quad.glsl"
#include "shared/lobe.glsl"

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    int lane = int(gl_GlobalInvocationID.y) * 4;
    int march = int(gl_GlobalInvocationID.x);
    if (lane >= lanes || march >= steps) {
        return;
    }
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    vec4 z = inversesqrt(1.0 + east * east + north * north);
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        vec3 normal = vec3(-east[k], -north[k], 1.0) * z[k];
        vec3 mirror = 2.0 * normal.z * normal - vec3(0.0, 0.0, 1.0);
        float facing = dot(normal, towards.xyz);
        // Of a disc that the sample's own plane cuts, more may be seen than faces it in the mean.
        float seen = min(PI * texelFetch(sun_sum, at, 0).x / max(facing, 1e-30), 1.0);
        float density = facing > 0.0 ? lobe_density(towards.xyz - mirror, towards.w) : 0.0;
        // A: what harmonics have left there.
        vec4 before = imageLoad(gloss_sum, at);
        vec4 light = vec4(colour.rgb * (seen * density), 0.0);
        vec4 sum = before + light;
        imageStore(gloss_sum, at, colour.w > 0.0 ? light : sum);
    }
}
