// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: brdf.ktx2 at its angles, and `offset` of a step on in both azimuths.
// Writes: values, a plane each.
// One invocation is a pair of light and view.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int BRDF_THETAS = 2;
layout(constant_id = 1) const int BRDF_PHIS = 4;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/brdf.glsl"

// Of direction n: θ, φ.
vec2 angles_of(int n) {
    return vec2((float(n / BRDF_PHIS) + 0.5) * 1.57079633 / float(BRDF_THETAS), 6.28318531 * float(n % BRDF_PHIS) / float(BRDF_PHIS));
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    vec2 on = vec2(0.0, offset * 6.28318531 / float(BRDF_PHIS));
    vec3 found = brdf(map, angles_of(i / cols) + on, angles_of(i % cols) + on);
    for (int c = 0; c < 3; c++) {
        values[c * cols * rows + i] = found[c];
    }
}
