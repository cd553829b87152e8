// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: curved_ellipse.ktx2.
// Writes: values, a plane each: the 25 numbers, and whether it is lit from (0.6, 0.48, 0.64) on a base bent outwards and inwards
// by half as much as the ellipses were fitted at.
// One invocation is a texel and a plane.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const float CURVATURE_OUTWARDS = 1.0;
layout(constant_id = 1) const float CURVATURE_INWARDS = 1.0;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/curved_ellipse.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    int plane = int(gl_GlobalInvocationID.z);
    if (i >= cols * rows) {
        return;
    }
    ivec2 at = ivec2(i % cols, i / cols);
    vec2 uv = (vec2(at) + 0.5) / vec2(cols, rows);
    vec2 curvature = vec2(0.5 * CURVATURE_OUTWARDS, -0.5 * CURVATURE_INWARDS);
    values[plane * cols * rows + i] =
        plane < 25 ? texelFetch(map, ivec3(at, plane / 4), 0)[plane % 4]
                   : curved_ellipse_lit(map, uv, curvature, vec3(0.6, 0.48, 0.64));
}
