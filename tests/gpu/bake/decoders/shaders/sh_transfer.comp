// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: sh_transfer.ktx2, one coefficient at a time.
// Writes: values, a plane each.
// One invocation is a coefficient of a texel.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int SH_COUNT = 9;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/sh_transfer.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    vec3 light[SH_COUNT];
    for (int k = 0; k < SH_COUNT; k++) {
        light[k] = vec3(0.0, k == int(gl_GlobalInvocationID.z) ? 1.0 : 0.0, 0.0);
    }
    values[int(gl_GlobalInvocationID.z) * cols * rows + i] = sh_transfer(map, uv, light).y;
}
