// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: scatter.ktx2.
// Writes: values, a plane each.
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

#include "decode/scatter.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    int plane = int(gl_GlobalInvocationID.z);
    values[plane * cols * rows + i] = plane < 3 ? scatter(map, uv)[plane] : scatter_error(map, uv)[plane - 3];
}
