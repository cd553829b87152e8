// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: btf.ktx2, at `offset` of a step on in both azimuths.
// Writes: values, a plane each: four of every pair.
// One invocation is a texel and a plane.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int BTF_THETAS = 2;
layout(constant_id = 1) const int BTF_PHIS = 4;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/btf.glsl"

// Of direction n: θ, φ.
vec2 angles_of(int n) {
    return vec2((float(n / BTF_PHIS) + 0.5) * 1.57079633 / float(BTF_THETAS), 6.28318531 * float(n % BTF_PHIS) / float(BTF_PHIS));
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 uv = (vec2(i % cols, i / cols) + 0.5) / vec2(cols, rows);
    int plane = int(gl_GlobalInvocationID.z);
    int count = BTF_THETAS * BTF_PHIS;
    vec2 on = vec2(0.0, offset * 6.28318531 / float(BTF_PHIS));
    vec2 light = angles_of(plane / 4 / count) + on;
    vec2 view = angles_of(plane / 4 % count) + on;
    values[plane * cols * rows + i] = btf(map, uv, light, view)[plane % 4];
}
