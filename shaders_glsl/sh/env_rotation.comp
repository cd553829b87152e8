// Computes: Fourier sums of each environment row: integrals over azimuth of L times 1, cos m phi and sin m phi, m
// below the light's order.
// Reads: environment (equirectangular, row 0 at the zenith), constants.
// Writes: env_rotation at [row][turn].
// One invocation is one Fourier term of one row.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 32) in;

layout(binding = 0) uniform texture2D environment;
layout(binding = 1) uniform textureBuffer constants;
layout(binding = 2) writeonly buffer EnvRotation { vec4 env_rotation[]; };

layout(push_constant) uniform EnvRotationPush {
    int width;
    int rows;         // of the environment, from the zenith down, that are used
    int turns;        // 2n - 1
    int column_first; // in constants: weights of four columns per texel, term after term
};

// Columns per partial sum, in texels of constants: sums of sums round less.
const int BLOCK = 8;

void main() {
    int index = int(gl_GlobalInvocationID.x);
    int row = index / turns;
    if (row >= rows) {
        return;
    }
    int fours = (width + 3) / 4;
    int first = column_first + (index % turns) * fours;
    vec3 sum = vec3(0.0);
    for (int block = 0; block < fours; block += BLOCK) {
        vec3 part = vec3(0.0);
        for (int i = block; i < min(block + BLOCK, fours); i++) {
            vec4 weight = texelFetch(constants, first + i);
            // Weights beyond the last column are 0.
            for (int k = 0; k < 4; k++) {
                part += weight[k] * texelFetch(environment, ivec2(min(4 * i + k, width - 1), row), 0).rgb;
            }
        }
        sum += part;
    }
    env_rotation[index] = vec4(sum, 0.0);
}
