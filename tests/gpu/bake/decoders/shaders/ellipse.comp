// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: ellipse.ktx2.
// Writes: values, a plane each: the six numbers, and whether it is lit from (0.6, 0.48, 0.64).
// One invocation is a texel and a plane.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/ellipse.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    int plane = int(gl_GlobalInvocationID.z);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    vec3 light = vec3(0.6, 0.48, 0.64);
    values[plane * cols * rows + i] =
        plane < 6 ? ellipse_part(map, uv, plane / 4)[plane % 4] : ellipse_lit(map, uv, light);
}
