// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: bent_normal.ktx2.
// Writes: values, a plane each.
// One invocation is a texel.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const bool BENT_OCTAHEDRAL = true;
layout(constant_id = 1) const float BENT_CONE_SCALE = 1.0;
layout(constant_id = 2) const float BENT_Y = 1.0;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/bent_normal.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    vec4 bent = bent_normal(map, uv);
    for (int k = 0; k < 4; k++) {
        values[k * cols * rows + i] = bent[k];
    }
}
