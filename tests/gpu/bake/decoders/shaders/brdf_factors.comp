// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: brdf_factors.ktx2 at its angles, `offset` of a step on in azimuth, and the sum of its products for a view of θ 0.5, φ 2 in three more planes.
// Writes: values, a plane each.
// One invocation is a direction and a plane.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int BRDF_THETAS = 2;
layout(constant_id = 1) const int BRDF_PHIS = 4;
layout(constant_id = 2) const int BRDF_FACTORS = 8;
layout(constant_id = 3) const int BRDF_VIEWS = 0;
layout(binding = 0) uniform sampler2DArray map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/brdf_factors.glsl"

// Of direction n: θ, φ.
vec2 angles_of(int n) {
    return vec2((float(n / BRDF_PHIS) + 0.5) * 1.57079633 / float(BRDF_THETAS), 6.28318531 * float(n % BRDF_PHIS) / float(BRDF_PHIS));
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    int plane = int(gl_GlobalInvocationID.z);
    vec2 e = angles_of(i) + vec2(0.0, offset * 6.28318531 / float(BRDF_PHIS));
    vec3 found = plane < 3 * BRDF_FACTORS ? brdf_factor(map, plane / 3, e) : brdf_of_factors(map, e, vec2(0.5, 2.0));
    values[plane * cols * rows + i] = found[plane % 3];
}
