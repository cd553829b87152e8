// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: horizon.ktx2 along its azimuths, and halfway between.
// Writes: values, a plane each.
// One invocation is a texel along an azimuth.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int HORIZON_AZIMUTHS = 8;
layout(constant_id = 1) const float HORIZON_SCALE = 1.0;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/horizon.glsl"

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    values[int(gl_GlobalInvocationID.z) * cols * rows + i] = horizon(map, uv, 6.28318531 * (float(gl_GlobalInvocationID.z) + offset) / float(HORIZON_AZIMUTHS));
}
