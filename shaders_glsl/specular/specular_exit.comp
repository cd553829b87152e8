// Computes: exit radiance of every grid point from its incident light: the Phong specular towards the view, and for
// the next bounce specular plus diffuse light, as a series of spherical harmonics or as one number towards straight
// above. With one number the view is also from straight above.
// Reads: arriving, ground, exit_radiance (diffuse), specular_direct, phong_map, constants.
// Reads and writes: specular_bounced (RGB, of all bounces so far).
// Writes: exit_vectors or exit_upward.
// One invocation is one grid point.
//
// A Phong lobe about the mirror direction r of o reflects towards o the incident light, smoothed by the lobe, at r. r
// is o rotated by half a turn about the normal, so exit radiance is the smoothed series under that rotation: its
// coefficients are integrals over directions, by a rule that is exact for such products.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const int ORDER = 4;
// One channel of radiance.
layout(constant_id = 1) const bool GREY = false;
layout(constant_id = 2) const bool SPECULAR_IS_MAP = false;
// For direct light, whose specular has been added already.
layout(constant_id = 3) const bool IS_DIRECT = false;
// Whether another bounce follows, and how its exit radiance is stored: by direction or straight upwards.
layout(constant_id = 4) const bool IS_BOUNCED = true;
layout(constant_id = 5) const bool VECTORS = true;
// Vectors of f16, whose largest number is 65504.
layout(constant_id = 6) const bool HALVES = false;

layout(binding = 0) uniform texture2DArray arriving;
layout(binding = 1) uniform texture2D ground;
layout(binding = 2) uniform texture2D exit_radiance;
layout(binding = 3) uniform texture2D specular_direct;
layout(binding = 4) uniform texture2D phong_map;
layout(binding = 5) uniform textureBuffer constants;
layout(binding = 6, rgba32f) uniform image2D specular_bounced;
// HALVES selects one of the first two.
layout(binding = 7, rgba32f) uniform writeonly image2DArray exit_vectors;
layout(binding = 9, rgba16f) uniform writeonly image2DArray exit_vectors_f16;
// GREY selects one of these.
layout(binding = 8, rgba32f) uniform writeonly image2D exit_upward;
layout(binding = 10, r32f) uniform writeonly image2D exit_upward_grey;

layout(push_constant) uniform SpecularExitPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 eye_m;       // over the field's base; w: 0 for a view from straight above
    uint begins;      // 1 for the first bounce
    int first_texel;  // in constants: x, y and z of four directions, then each one's Y_lm times its weight
    int fours;        // of directions
    float exponent;   // Phong exponent, where it is constant
    float scale;
};

const int COUNT = ORDER * ORDER;
const int FOURS = (COUNT + 3) / 4;
const int CHANNELS = GREY ? 1 : 3;

vec4 harmonics[36];
#include "shared/harmonics.glsl"
#include "specular/phong_bands.glsl"
#include "specular/mirror.glsl"

// Incident light, smoothed by the Phong lobe and scaled.
vec3 smoothed[36];
// Exit radiance.
vec4 leaving[27];

void find_smoothed(ivec2 at, vec2 specular) {
    for (int i = 0; i < 36; i++) {
        harmonics[i] = vec4(1.0);
    }
    keep_bands(vec4(specular.x), vec4(specular.y));
    for (int i = 0; i < FOURS; i++) {
        mat3x4 four = mat3x4(0.0);
        for (int c = 0; c < CHANNELS; c++) {
            four[c] = texelFetch(arriving, ivec3(at, c * FOURS + i), 0);
        }
        for (int k = 0; k < 4 && 4 * i + k < COUNT; k++) {
            smoothed[4 * i + k] = harmonics[4 * i + k].x * vec3(four[0][k], four[1][k], four[2][k]);
        }
    }
}

// Smoothed light at the mirror direction of the view.
vec3 reflected(ivec2 at, float height, vec3 normal) {
    vec2 place = vec2(float(at.x) * cell_x_m, float(rows - 1 - at.y) * cell_y_m);
    Mirrored mirror = mirrored(vec4(normal.x), vec4(normal.y), vec4(normal.z), vec4(place.x), vec4(place.y), vec4(height), eye_m);
    find_harmonics(mirror.east, mirror.north, mirror.up);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < COUNT; i++) {
        sum += harmonics[i].x * smoothed[i];
    }
    // Series ring; clamped at 0 where it is displayed.
    vec3 light = max(sum, vec3(0.0));
    return GREY ? light.xxx : light;
}

void store_vectors(ivec2 at, vec3 normal, vec3 diffuse) {
    for (int i = 0; i < CHANNELS * FOURS; i++) {
        leaving[i] = vec4(0.0);
    }
    int texel = first_texel;
    for (int four = 0; four < fours; four++) {
        vec4 x = texelFetch(constants, texel);
        vec4 y = texelFetch(constants, texel + 1);
        vec4 z = texelFetch(constants, texel + 2);
        vec4 twice = 2.0 * (normal.x * x + normal.y * y + normal.z * z);
        find_harmonics(twice * normal.x - x, twice * normal.y - y, twice * normal.z - z);
        texel += 3;
        vec4 red = vec4(0.0);
        vec4 green = vec4(0.0);
        vec4 blue = vec4(0.0);
        for (int i = 0; i < COUNT; i++) {
            red += harmonics[i] * smoothed[i].r;
            green += harmonics[i] * smoothed[i].g;
            blue += harmonics[i] * smoothed[i].b;
        }
        mat3x4 colours = mat3x4(red, green, blue);
        for (int k = 0; k < 4; k++) {
            for (int i = 0; i < FOURS; i++) {
                vec4 weighed = texelFetch(constants, texel + k * FOURS + i);
                for (int c = 0; c < CHANNELS; c++) {
                    leaving[c * FOURS + i] += colours[c][k] * weighed;
                }
            }
        }
        texel += 4 * FOURS;
    }
    for (int c = 0; c < CHANNELS; c++) {
        // A constant has only Y_00: sqrt(4 pi) times it.
        leaving[c * FOURS].x += 3.5449077018110318 * diffuse[c];
        for (int i = 0; i < FOURS; i++) {
            vec4 four = leaving[c * FOURS + i];
            ivec3 texel = ivec3(at, c * FOURS + i);
            if (HALVES) {
                imageStore(exit_vectors_f16, texel, clamp(four, vec4(-65504.0), vec4(65504.0)));
            } else {
                imageStore(exit_vectors, texel, four);
            }
        }
    }
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec4 own = texelFetch(ground, at, 0);
    vec3 normal = vec3(-own.y, -own.z, 1.0) * inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    vec2 specular = vec2(exponent, scale);
    if (SPECULAR_IS_MAP) {
        specular = texelFetch(phong_map, at, 0).xy;
    }
    vec3 visible = vec3(0.0);
    if (VECTORS || !IS_DIRECT) {
        find_smoothed(at, specular);
    }
    if (IS_DIRECT) {
        visible = texelFetch(specular_direct, at, 0).rgb;
    } else {
        visible = reflected(at, own.x, normal);
        vec4 before = imageLoad(specular_bounced, at);
        vec4 own_light = vec4(visible, 1.0);
        vec4 both = vec4(before.rgb + visible, 1.0);
        imageStore(specular_bounced, at, begins > 0u ? own_light : both);
    }
    if (IS_BOUNCED) {
        vec4 texel = texelFetch(exit_radiance, at, 0);
        vec3 diffuse = GREY ? texel.xxx : texel.rgb;
        if (VECTORS) {
            store_vectors(at, normal, diffuse);
        } else {
            vec4 all = vec4(diffuse + visible, 1.0);
            if (GREY) {
                imageStore(exit_upward_grey, at, all);
            } else {
                imageStore(exit_upward, at, all);
            }
        }
    }
}
