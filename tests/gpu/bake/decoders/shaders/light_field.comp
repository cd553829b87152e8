// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: light_field.ktx2, at `offset` of a step on in azimuth.
// Writes: values, a plane each: four of every view.
// One invocation is a texel and a plane.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int LIGHT_FIELD_THETAS = 2;
layout(constant_id = 1) const int LIGHT_FIELD_PHIS = 4;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/light_field.glsl"

// Of direction n: θ, φ.
vec2 angles_of(int n) {
    return vec2((float(n / LIGHT_FIELD_PHIS) + 0.5) * 1.57079633 / float(LIGHT_FIELD_THETAS), 6.28318531 * float(n % LIGHT_FIELD_PHIS) / float(LIGHT_FIELD_PHIS));
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    int plane = int(gl_GlobalInvocationID.z);
    vec2 on = vec2(0.0, offset * 6.28318531 / float(LIGHT_FIELD_PHIS));
    values[plane * cols * rows + i] = light_field(map, uv, angles_of(plane / 4) + on)[plane % 4];
}
