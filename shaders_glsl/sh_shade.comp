// Computes: the light of an environment at every sample from what it sees: a series of visibility times
// the light's matrix, for the sample's own normal.
// Reads: lane_heights, visibility, light_matrix. Writes: env_sum (exit radiance for albedo 1, RGB; in A
// 1 where a colour was below 0 and is now 0).
// One invocation is four samples side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
layout(constant_id = 2) const int ORDER = 4;
// The receiver is N_y, N_z, N_x alone; else the polynomials of bands 0 to 2 (band 1 at order 2).
layout(constant_id = 3) const bool IS_PLANE = true;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2DArray visibility;
layout(binding = 2) uniform texture2D light_matrix;
layout(binding = 3, rgba32f) uniform writeonly image2D env_sum;

layout(push_constant) uniform ShShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
};

#include "shared/quad.glsl"

vec4 red;
vec4 green;
vec4 blue;

// Polynomials of the four normals, times a column of the matrix, times that coefficient of the four.
void add_coefficient(int column, vec4 seen, vec4 x, vec4 y, vec4 z) {
    if (column >= ORDER * ORDER) {
        return;
    }
    int first = IS_PLANE ? 0 : 1;
    vec3 on_y = texelFetch(light_matrix, ivec2(column, first), 0).rgb;
    vec3 on_z = texelFetch(light_matrix, ivec2(column, first + 1), 0).rgb;
    vec3 on_x = texelFetch(light_matrix, ivec2(column, first + 2), 0).rgb;
    vec4 r = on_y.r * y + on_z.r * z + on_x.r * x;
    vec4 g = on_y.g * y + on_z.g * z + on_x.g * x;
    vec4 b = on_y.b * y + on_z.b * z + on_x.b * x;
    if (!IS_PLANE) {
        vec3 on_one = texelFetch(light_matrix, ivec2(column, 0), 0).rgb;
        r += on_one.r;
        g += on_one.g;
        b += on_one.b;
        if (ORDER > 2) {
            vec3 on_xy = texelFetch(light_matrix, ivec2(column, 4), 0).rgb;
            vec3 on_yz = texelFetch(light_matrix, ivec2(column, 5), 0).rgb;
            vec3 on_zz = texelFetch(light_matrix, ivec2(column, 6), 0).rgb;
            vec3 on_xz = texelFetch(light_matrix, ivec2(column, 7), 0).rgb;
            vec3 on_xx = texelFetch(light_matrix, ivec2(column, 8), 0).rgb;
            vec4 zz = 3.0 * z * z - 1.0;
            vec4 xx = x * x - y * y;
            r += on_xy.r * x * y + on_yz.r * y * z + on_zz.r * zz + on_xz.r * x * z + on_xx.r * xx;
            g += on_xy.g * x * y + on_yz.g * y * z + on_zz.g * zz + on_xz.g * x * z + on_xx.g * xx;
            b += on_xy.b * x * y + on_yz.b * y * z + on_zz.b * zz + on_xz.b * x * z + on_xx.b * xx;
        }
    }
    red += r * seen;
    green += g * seen;
    blue += b * seen;
}

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    int lane = int(gl_GlobalInvocationID.y) * 4;
    int march = int(gl_GlobalInvocationID.x);
    if (lane >= lanes || march >= steps) {
        return;
    }
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    vec4 z = inversesqrt(1.0 + east * east + north * north);
    vec4 x = -east * z;
    vec4 y = -north * z;
    red = vec4(0.0);
    green = vec4(0.0);
    blue = vec4(0.0);
    for (int layer = 0; layer < (ORDER * ORDER + 3) / 4; layer++) {
        mat4 four;
        for (int k = 0; k < 4; k++) {
            four[k] = texelFetch(visibility, ivec3(texel_at(min(lane + k, lanes - 1), march), layer), 0);
        }
        four = transpose(four);
        add_coefficient(4 * layer, four[0], x, y, z);
        add_coefficient(4 * layer + 1, four[1], x, y, z);
        add_coefficient(4 * layer + 2, four[2], x, y, z);
        add_coefficient(4 * layer + 3, four[3], x, y, z);
    }
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        vec3 light = vec3(red[k], green[k], blue[k]);
        float below = any(lessThan(light, vec3(0.0))) ? 1.0 : 0.0;
        imageStore(env_sum, texel_at(lane + k, march), vec4(max(light, vec3(0.0)), below));
    }
}
