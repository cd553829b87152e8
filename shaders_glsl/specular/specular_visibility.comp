// Computes: incident light of sky and environment at every grid point as a series of spherical harmonics: the product
// of visibility and light.
// Reads: visibility, light_matrix.
// Writes: arriving (four coefficients per layer, channel after channel).
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const int ORDER = 4;
// One channel of radiance.
layout(constant_id = 1) const bool GREY = false;

layout(binding = 0) uniform texture2DArray visibility;
layout(binding = 1) uniform texture2D light_matrix;
layout(binding = 2, rgba32f) uniform writeonly image2DArray arriving;

layout(push_constant) uniform SpecularVisibilityPush {
    int cols;
    int rows;
};

const int COUNT = ORDER * ORDER;
const int FOURS = (COUNT + 3) / 4;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    for (int layer = 0; layer < FOURS; layer++) {
        mat3x4 four = mat3x4(0.0);
        for (int from = 0; from < FOURS; from++) {
            vec4 visible = texelFetch(visibility, ivec3(at, from), 0);
            for (int k = 0; k < 4 && 4 * from + k < COUNT; k++) {
                for (int row = 0; row < 4 && 4 * layer + row < COUNT; row++) {
                    vec3 share = visible[k] * texelFetch(light_matrix, ivec2(4 * from + k, 4 * layer + row), 0).rgb;
                    four[0][row] += share.r;
                    four[1][row] += share.g;
                    four[2][row] += share.b;
                }
            }
        }
        imageStore(arriving, ivec3(at, layer), four[0]);
        if (!GREY) {
            imageStore(arriving, ivec3(at, FOURS + layer), four[1]);
            imageStore(arriving, ivec3(at, 2 * FOURS + layer), four[2]);
        }
    }
}
