// Computes: what the decoder that `bake` writes beside a map makes of it.
// Reads: brdf_harmonics.ktx2, by pairs of single harmonics; the harmonics of directions; what both make of pairs of them.
// Writes: values, three planes of texels, one of harmonics, one of pairs.
// One invocation is a texel, a harmonic (column) of a direction (row), a view (column) and a light (row).
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int BRDF_ORDER = 2;
layout(constant_id = 1) const int BRDF_TERMS = 4;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Values {
    float values[];
};
layout(push_constant) uniform Push {
    int cols;
    int rows;
    float offset;
};

#include "decode/brdf_harmonics.glsl"

// Of BRDF_TERMS ones above horizontal.
vec3 direction_of(int n) {
    float z = (float(n) + 0.5) / float(BRDF_TERMS);
    float t = float(2 * n - BRDF_TERMS) / 4.0;
    return vec3(sqrt(1.0 - z * z) * vec2(1.0 - t * t, 2.0 * t) / (1.0 + t * t), z);
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= cols * rows) {
        return;
    }
    int col = i % cols;
    int row = i / cols;
    float light[BRDF_TERMS];
    float view[BRDF_TERMS];
    for (int k = 0; k < BRDF_TERMS; k++) {
        light[k] = k == row ? 1.0 : 0.0;
        view[k] = k == col ? 1.0 : 0.0;
    }
    vec3 texel = brdf_of_harmonics(map, light, view);
    brdf_harmonics(direction_of(row), light);
    brdf_harmonics(direction_of(col), view);
    int plane = cols * rows;
    values[i] = texel.r;
    values[plane + i] = texel.g;
    values[2 * plane + i] = texel.b;
    values[3 * plane + i] = light[col];
    values[4 * plane + i] = brdf_of_harmonics(map, light, view).r;
}
