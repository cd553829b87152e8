// Computes: the matrix that maps a series of visibility to exit radiance under the environment. First the SH series
// of the environment, from the sums of its rows, plus that of a uniform sky; then the matrix, which is linear in it.
// Reads: env_rotation (where there are rows), constants.
// Writes: light_matrix at [row of the receiver][coefficient], RGB.
// One workgroup is the whole dispatch; one invocation is a coefficient of the series, then some matrix entries.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

layout(binding = 0) readonly buffer EnvRotation { vec4 env_rotation[]; };
layout(binding = 1) uniform textureBuffer constants;
layout(binding = 2, rgba32f) uniform writeonly image2D light_matrix;

layout(push_constant) uniform LightMatrixPush {
    int rows;         // of the environment; 0 where there is none
    int light_order;
    int order;        // of the visibility series
    int receivers;    // rows of the matrix
    int row_first;    // in constants: weights of four rows per texel, (l, m) after (l, m), m from 0
    int matrix_first; // in constants: entry after entry, four coefficients a texel
    ivec2 pads;
    vec4 sky;         // radiance of a sky included in this matrix
};

const int MAX_COUNT = 36;
// Rows per partial sum, in texels of constants.
const int BLOCK = 8;

shared vec4 series[MAX_COUNT];

// Of the environment, at l (l + 1) + m.
vec3 coefficient(int place) {
    int l = 0;
    while ((l + 1) * (l + 1) <= place) {
        l++;
    }
    int m = place - l * (l + 1);
    int turns = 2 * light_order - 1;
    int turn = m + light_order - 1;
    int fours = (rows + 3) / 4;
    int first = row_first + (l * (l + 1) / 2 + abs(m)) * fours;
    vec3 sum = vec3(0.0);
    for (int block = 0; block < fours; block += BLOCK) {
        vec3 part = vec3(0.0);
        for (int i = block; i < min(block + BLOCK, fours); i++) {
            vec4 weight = texelFetch(constants, first + i);
            // Weights beyond the last row are 0.
            for (int k = 0; k < 4; k++) {
                part += weight[k] * env_rotation[min(4 * i + k, rows - 1) * turns + turn].rgb;
            }
        }
        sum += part;
    }
    return sum;
}

void main() {
    int self = int(gl_LocalInvocationIndex);
    int count = light_order * light_order;
    if (self < count) {
        // A constant has only Y_00: sqrt(4 pi) times it.
        vec3 of_sky = self == 0 ? 3.5449077018110318 * sky.rgb : vec3(0.0);
        series[self] = vec4(coefficient(self) + of_sky, 0.0);
    }
    barrier();
    int size = order * order;
    int fours = (count + 3) / 4;
    for (int entry = self; entry < receivers * size; entry += 64) {
        vec3 sum = vec3(0.0);
        for (int i = 0; i < fours; i++) {
            vec4 weight = texelFetch(constants, matrix_first + entry * fours + i);
            // Weights beyond the last coefficient are 0.
            for (int k = 0; k < 4; k++) {
                sum += weight[k] * series[min(4 * i + k, count - 1)].rgb;
            }
        }
        imageStore(light_matrix, ivec2(entry % size, entry / size), vec4(sum, 0.0));
    }
}
