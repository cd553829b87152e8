// Computes: exit radiance under an environment at every grid point from its visibility series, or those of the nodes
// around it: the series times the light's matrix, for the grid point's own normal.
// Reads: lane_heights, visibility, light_matrix, nodes, phong_map.
// Writes: env_sum (exit radiance for albedo 1, or of the Phong specular, RGB; A: 1 where a negative colour was
// clamped to 0).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
layout(constant_id = 2) const int ORDER = 4;
const uint RECEIVER_COSINE = 0u; // polynomials of N, bands 0 to 2 (band 1 at order 2)
const uint RECEIVER_PLANE = 1u;  // N_y, N_z, N_x only
const uint RECEIVER_SPECULAR = 2u;  // Y_lm of the mirror direction of the view
layout(constant_id = 3) const uint RECEIVER = 1u;
// Grid points from node to node: 1, 2 or 4.
layout(constant_id = 4) const int NODE_STRIDE = 1;
layout(constant_id = 5) const bool SPECULAR_IS_MAP = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2DArray visibility;
layout(binding = 2) uniform texture2D light_matrix;
layout(binding = 3, rgba32f) uniform writeonly image2D env_sum;
// Height, slopes towards east and north.
layout(binding = 4, rgba32f) uniform readonly image2D nodes;
// Phong exponent and scale.
layout(binding = 5) uniform texture2D phong_map;

layout(push_constant) uniform ShShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 eye_m;     // specular: the eye, over the field's base; w: 0 for a view from straight above
    vec2 specular;  // exponent and scale, where they are constant
};

#include "shared/quad.glsl"
#include "shared/nodes.glsl"
#include "sh/alike.glsl"

vec4 harmonics[36];

#include "shared/harmonics.glsl"
#include "specular/phong_bands.glsl"
#include "specular/mirror.glsl"

// The nodes on both sides across the lanes of four grid points, at two march positions: their texels, and their
// weights for each of the four.
const int ACROSS = 4 / NODE_STRIDE + 1;
ivec2 node_texels[2 * ACROSS];
vec4 node_weights[2 * ACROSS];

// 1 at `here`, 0 at the two nodes beside it.
vec4 hat(vec4 x, int before, int here, int after) {
    vec4 rising = (x - float(before)) / float(max(here - before, 1));
    vec4 falling = (float(after) - x) / float(max(after - here, 1));
    return clamp(min(rising, falling), 0.0, 1.0);
}

void find_nodes(Quad q, int lanes, int steps, vec4 east, vec4 north) {
    vec4 x = vec4(q.lane);
    int along = q.march / NODE_STRIDE;
    int last_across = node_count(lanes, NODE_STRIDE) - 1;
    int last_along = node_count(steps, NODE_STRIDE) - 1;
    int march_before = node_place(along, steps, NODE_STRIDE);
    int march_after = node_place(along + 1, steps, NODE_STRIDE);
    float t = float(q.march - march_before) / float(max(march_after - march_before, 1));
    float cell_m = min(cell_x_m, cell_y_m);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 2 * ACROSS; i++) {
        int across = q.lane.x / NODE_STRIDE + (i >> 1);
        int here = node_place(across, lanes, NODE_STRIDE);
        int before = node_place(across - 1, lanes, NODE_STRIDE);
        // Past the last node there is no interval.
        int next = node_place(across + 1, lanes, NODE_STRIDE);
        int beyond = here + 1;
        int after = across < last_across ? next : beyond;
        float exists = across <= last_across ? 1.0 : 0.0;
        bool is_after = (i & 1) == 1;
        int march = is_after ? march_after : march_before;
        float from_before = 1.0 - t;
        float weight = is_after ? t : from_before;
        node_texels[i] = texel_at(min(across, last_across), min(along + (i & 1), last_along));
        vec4 node = imageLoad(nodes, node_texels[i]);
        vec4 lane_m = (float(here) - x) * (MARCHES_ROWS ? cell_x_m : -cell_y_m);
        vec4 march_m = vec4(float(march - q.march) * (MARCHES_ROWS ? -cell_y_m : cell_x_m));
        vec4 east_m = MARCHES_ROWS ? lane_m : march_m;
        vec4 north_m = MARCHES_ROWS ? march_m : lane_m;
        vec4 near = exists * weight * hat(x, before, here, after);
        node_weights[i] = near * alike(node, q.here.four, east, north, east_m, north_m, cell_m);
        sum += node_weights[i];
    }
    for (int i = 0; i < 2 * ACROSS; i++) {
        node_weights[i] /= sum;
    }
}

// Four visibility coefficients of the four grid points: [coefficient][grid point].
mat4 visibility_at(int layer, int lane, int march, int lanes) {
    mat4 four = mat4(0.0);
    if (NODE_STRIDE > 1) {
        for (int i = 0; i < 2 * ACROSS; i++) {
            vec4 node = texelFetch(visibility, ivec3(node_texels[i], layer), 0);
            four[0] += node.x * node_weights[i];
            four[1] += node.y * node_weights[i];
            four[2] += node.z * node_weights[i];
            four[3] += node.w * node_weights[i];
        }
        return four;
    }
    for (int k = 0; k < 4; k++) {
        four[k] = texelFetch(visibility, ivec3(texel_at(min(lane + k, lanes - 1), march), layer), 0);
    }
    return transpose(four);
}

vec4 red;
vec4 green;
vec4 blue;

// Polynomials of the four normals, times a column of the matrix, times that coefficient of the four.
void add_coefficient(int column, vec4 visible, vec4 x, vec4 y, vec4 z) {
    if (column >= ORDER * ORDER) {
        return;
    }
    int first = RECEIVER == RECEIVER_PLANE ? 0 : 1;
    vec3 on_y = texelFetch(light_matrix, ivec2(column, first), 0).rgb;
    vec3 on_z = texelFetch(light_matrix, ivec2(column, first + 1), 0).rgb;
    vec3 on_x = texelFetch(light_matrix, ivec2(column, first + 2), 0).rgb;
    vec4 r = on_y.r * y + on_z.r * z + on_x.r * x;
    vec4 g = on_y.g * y + on_z.g * z + on_x.g * x;
    vec4 b = on_y.b * y + on_z.b * z + on_x.b * x;
    if (RECEIVER == RECEIVER_COSINE) {
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
    red += r * visible;
    green += g * visible;
    blue += b * visible;
}

// The same for the Phong specular, for all coefficients of a layer: one loop, as SwiftShader compiles each for
// seconds.
void add_specular(int layer, mat4 four) {
    for (int k = 0; k < 4 && 4 * layer + k < ORDER * ORDER; k++) {
        vec4 visible = four[k];
        for (int row = 0; row < ORDER * ORDER; row++) {
            vec3 on = texelFetch(light_matrix, ivec2(4 * layer + k, row), 0).rgb;
            vec4 share = harmonics[row] * visible;
            red += on.r * share;
            green += on.g * share;
            blue += on.b * share;
        }
    }
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
    if (RECEIVER == RECEIVER_SPECULAR) {
        vec4 lane_at = vec4(q.lane);
        vec4 column = MARCHES_ROWS ? lane_at : vec4(march);
        vec4 row = MARCHES_ROWS ? vec4(march) : lane_at;
        Mirrored mirror = mirrored(x, y, z, column * cell_x_m, (float(rows - 1) - row) * cell_y_m, q.here.four, eye_m);
        find_harmonics(mirror.east, mirror.north, mirror.up);
        vec4 exponents = vec4(specular.x);
        vec4 scales = vec4(specular.y);
        for (int k = 0; k < 4 && SPECULAR_IS_MAP; k++) {
            vec2 of = texelFetch(phong_map, texel_at(min(lane + k, lanes - 1), march), 0).xy;
            exponents[k] = of.x;
            scales[k] = of.y;
        }
        keep_bands(exponents, scales);
    }
    if (NODE_STRIDE > 1) {
        find_nodes(q, lanes, steps, east, north);
    }
    red = vec4(0.0);
    green = vec4(0.0);
    blue = vec4(0.0);
    for (int layer = 0; layer < (ORDER * ORDER + 3) / 4; layer++) {
        mat4 four = visibility_at(layer, lane, march, lanes);
        if (RECEIVER == RECEIVER_SPECULAR) {
            add_specular(layer, four);
            continue;
        }
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
