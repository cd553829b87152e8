// Computes: Phong specular reflection of sky and environment at every grid point: the unoccluded reflection times the
// share that horizons leave free, S (1 - B / T). With a map, S is interpolated between four levels of exponents, and the
// share between two.
// Reads: lane_heights, blocked_sum (B), blocked_above (B at the level above), unoccluded_map (S), swept_map (T), phong_map,
// constants.
// Writes: specular_sum (exit radiance, RGB).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
layout(constant_id = 2) const bool SPECULAR_IS_MAP = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2D blocked_sum;
layout(binding = 2) uniform texture2D unoccluded_map;
layout(binding = 3) uniform texture2D swept_map;
layout(binding = 4, rgba32f) uniform writeonly image2D specular_sum;
layout(binding = 5) uniform texture2D blocked_above;
// Phong exponent and scale.
layout(binding = 6) uniform texture2D phong_map;
layout(binding = 7) uniform textureBuffer constants;

layout(push_constant) uniform SpecularLightPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 eye_m;
    float scale;        // where it is constant
    int unoccluded_repeats;   // periods of the map in a turn
    int swept_repeats;
    int first_level;    // see levels.glsl; one level without a map
    int level_count;
    float levels_per_log;
};

#include "shared/quad.glsl"
#include "shared/angle.glsl"
#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"
#include "specular/levels.glsl"

// Weights of a cubic through four values, between the second and the third (Catmull-Rom).
vec4 cubic(float t) {
    return 0.5 * vec4(t * (t * (2.0 - t) - 1.0), t * t * (3.0 * t - 5.0) + 2.0, t * (t * (4.0 - 3.0 * t) + 1.0), t * t * (t - 1.0));
}

// A level's map within an image.
struct Map {
    int first_row;
    int height;
    int columns;   // of a whole turn; only one of `repeats` periods is stored
    int repeats;
};

// Of a level: `which` is 1 for unoccluded light, 2 for the swept azimuths.
Map map_of(int level, int which, int repeats) {
    ivec4 of = ivec4(texelFetch(constants, first_level + LEVEL_TEXELS * level + which));
    return Map(of.x, of.y, of.z, repeats);
}

// A map's texel; past a pole, the one on its other side.
vec3 map_texel(texture2D image, ivec2 at, Map map) {
    bool is_past = at.y < 0 || at.y >= map.height;
    int y = at.y < 0 ? -at.y : (is_past ? 2 * (map.height - 1) - at.y : at.y);
    int x = at.x + (is_past ? map.columns / 2 : 0);
    return texelFetch(image, ivec2((x + 2 * map.columns) % (map.columns / map.repeats), map.first_row + y), 0).rgb;
}

// A map's value at `turn` (0 to 1 from east) and `rise` (0 straight down, 1 straight up).
vec3 map_at(texture2D image, Map map, float turn, float rise) {
    vec2 place = vec2(turn * float(map.columns), rise * float(map.height - 1));
    ivec2 texel = ivec2(int(place.x), clamp(int(place.y), 0, map.height - 2));
    vec4 across = cubic(place.x - float(texel.x));
    vec4 up = cubic(place.y - float(texel.y));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 4; j++) {
        vec3 row = vec3(0.0);
        for (int i = 0; i < 4; i++) {
            row += across[i] * map_texel(image, texel + ivec2(i, j) - 1, map);
        }
        sum += up[j] * row;
    }
    return sum;
}

// Light without occlusion in the lobe of a level.
vec3 unoccluded(int level, float turn, float rise) {
    return map_at(unoccluded_map, map_of(level, 1, unoccluded_repeats), turn, rise);
}

// The share of a level's light that horizons hide.
vec3 hidden_share(int level, vec3 hidden, float turn, float rise) {
    vec3 swept = map_at(swept_map, map_of(level, 2, swept_repeats), turn, rise);
    // Where nothing is hidden, nothing is divided: the swept map may be 0 there.
    return mix(hidden / max(swept, hidden), vec3(0.0), lessThanEqual(hidden, vec3(0.0)));
}

// Unoccluded light at a fractional index of levels: Lagrange interpolation through the four nearest, or through all if there are fewer.
vec3 between_levels(float place, float turn, float rise) {
    int count = min(level_count, 4);
    int first = clamp(int(place) - 1, 0, level_count - count);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; i++) {
        float weight = 1.0;
        for (int j = 0; j < count; j++) {
            weight *= j == i ? 1.0 : (place - float(first + j)) / float(i - j);
        }
        sum += weight * unoccluded(first + i, turn, rise);
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
        vec3 blocked = texelFetch(blocked_sum, at, 0).rgb;
        if (!SPECULAR_IS_MAP) {
            vec3 whole = max(unoccluded(0, turn[k], rise[k]), 0.0);
            vec3 hidden = hidden_share(0, blocked, turn[k], rise[k]);
            imageStore(specular_sum, at, vec4(scale * whole * (1.0 - hidden), 0.0));
            continue;
        }
        vec2 of = texelFetch(phong_map, at, 0).xy;
        float place = level_of(of.x);
        ivec2 level = swept_levels(place);
        vec3 whole = max(between_levels(place, turn[k], rise[k]), 0.0);
        vec3 hidden = hidden_share(level.x, blocked, turn[k], rise[k]);
        if (level.y > level.x) {
            vec3 above = hidden_share(level.y, texelFetch(blocked_above, at, 0).rgb, turn[k], rise[k]);
            hidden = mix(hidden, above, (place - float(level.x)) / float(SWEPT_EVERY));
        }
        imageStore(specular_sum, at, vec4(of.y * whole * (1.0 - hidden), 0.0));
    }
}
