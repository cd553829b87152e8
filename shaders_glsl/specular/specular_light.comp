// Computes: Phong specular reflection of sky and environment at every grid point: the unoccluded reflection times the
// share that horizons leave free, S (1 - B / T).
// Reads: lane_heights, blocked_sum (B), unoccluded_map (S), swept_map (T).
// Writes: specular_sum (exit radiance, RGB).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2D blocked_sum;
layout(binding = 2) uniform texture2D unoccluded_map;
layout(binding = 3) uniform texture2D swept_map;
layout(binding = 4, rgba32f) uniform writeonly image2D specular_sum;

layout(push_constant) uniform SpecularLightPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 eye_m;
    float scale;
    int unoccluded_columns;   // of a whole turn
    int swept_columns;
};

#include "shared/quad.glsl"
#include "shared/angle.glsl"
#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"

// Weights of a cubic through four values, between the second and the third (Catmull-Rom).
vec4 cubic(float t) {
    return 0.5 * vec4(t * (t * (2.0 - t) - 1.0), t * t * (3.0 * t - 5.0) + 2.0, t * (t * (4.0 - 3.0 * t) + 1.0), t * t * (t - 1.0));
}

// A map's texel; past a pole, the one on its other side. The stored columns repeat over a turn.
vec3 map_texel(texture2D map, ivec2 at, ivec2 size, int columns) {
    bool is_past = at.y < 0 || at.y >= size.y;
    int y = at.y < 0 ? -at.y : (is_past ? 2 * (size.y - 1) - at.y : at.y);
    int x = at.x + (is_past ? columns / 2 : 0);
    return texelFetch(map, ivec2((x + 2 * columns) % size.x, y), 0).rgb;
}

// A map's value at `turn` (0 to 1 from east) and `rise` (0 straight down, 1 straight up).
vec3 map_at(texture2D map, int columns, float turn, float rise) {
    ivec2 size = textureSize(map, 0);
    vec2 place = vec2(turn * float(columns), rise * float(size.y - 1));
    ivec2 texel = ivec2(int(place.x), clamp(int(place.y), 0, size.y - 2));
    vec4 across = cubic(place.x - float(texel.x));
    vec4 up = cubic(place.y - float(texel.y));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 4; j++) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; i++) {
            row += across[i] * map_texel(map, texel + ivec2(i, j) - 1, size, columns);
        }
        sum += up[j] * row;
    }
    return sum;
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
    vec4 normal_up = inversesqrt(1.0 + east * east + north * north);
    vec4 lane_at = vec4(lane, lane + 1, lane + 2, lane + 3);
    vec4 column = MARCHES_ROWS ? lane_at : vec4(march);
    vec4 row = MARCHES_ROWS ? vec4(march) : lane_at;
    Mirrored mirror = mirrored(-east * normal_up, -north * normal_up, normal_up, column * cell_x_m,
                               (float(rows - 1) - row) * cell_y_m, q.here.four, eye_m);
    vec4 flat_part = sqrt(mirror.east * mirror.east + mirror.north * mirror.north);
    vec4 azimuth = angle_of(mirror.east, mirror.north);
    vec4 turn = azimuth / (2.0 * PI) + mix(vec4(0.0), vec4(1.0), lessThan(azimuth, vec4(0.0)));
    vec4 rise = angle_of(flat_part, mirror.up) / PI + 0.5;
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        vec3 whole = max(map_at(unoccluded_map, unoccluded_columns, turn[k], rise[k]), 0.0);
        vec3 swept = map_at(swept_map, swept_columns, turn[k], rise[k]);
        vec3 blocked = texelFetch(blocked_sum, at, 0).rgb;
        // Where nothing is hidden, nothing is divided: the swept map may be 0 there.
        vec3 hidden = mix(blocked / max(swept, blocked), vec3(0.0), lessThanEqual(blocked, vec3(0.0)));
        imageStore(specular_sum, at, vec4(scale * whole * (1.0 - hidden), 0.0));
    }
}
