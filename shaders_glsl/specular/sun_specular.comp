// Computes: Phong specular reflection of a sun towards the view, at every grid point: the lobe towards the sun's centre,
// times the sun's visible fraction. That fraction is the sun's diffuse light over its
// unoccluded diffuse light. Where another bounce follows, also the incident light of the sun as a series, all of it
// from its centre.
// Reads: lane_heights, sun_sum, phong_map.
// Reads and writes: specular_sum (exit radiance, RGB), arriving (four coefficients per layer, channel after channel).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
layout(constant_id = 2) const bool SPECULAR_IS_MAP = false;
// Order of the series; 0 for none. One channel of radiance.
layout(constant_id = 3) const int ORDER = 0;
layout(constant_id = 4) const bool GREY = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2D sun_sum;
layout(binding = 2, rgba32f) uniform image2D specular_sum;
// Phong exponent and scale.
layout(binding = 3) uniform texture2D phong_map;
layout(binding = 4, rgba32f) uniform image2DArray arriving;

layout(push_constant) uniform SunSpecularPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 towards;  // the sun's centre
    vec4 colour;   // irradiance; w: 1 where the sum begins
    vec4 eye_m;     // over the field's base; w: 0 for a view from straight above
    vec2 specular;  // Phong exponent and scale, where they are constant
};

#include "shared/quad.glsl"
#include "specular/phong_lobe.glsl"
#include "specular/mirror.glsl"

vec4 harmonics[36];
#include "shared/harmonics.glsl"

const int FOURS = (ORDER * ORDER + 3) / 4;
const int CHANNELS = GREY ? 1 : 3;

void add_arriving(ivec2 at, float visible) {
    for (int i = 0; i < FOURS; i++) {
        vec4 y = vec4(harmonics[4 * i].x, harmonics[4 * i + 1].x, harmonics[4 * i + 2].x, harmonics[4 * i + 3].x);
        for (int c = 0; c < CHANNELS; c++) {
            ivec3 layer = ivec3(at, c * FOURS + i);
            vec4 before = imageLoad(arriving, layer);
            vec4 light = (visible * colour[c]) * y;
            vec4 both = before + light;
            imageStore(arriving, layer, colour.w > 0.0 ? light : both);
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
    if (ORDER > 0) {
        // Zero past the last coefficient.
        for (int i = 0; i < 36; i++) {
            harmonics[i] = vec4(0.0);
        }
        find_harmonics(vec4(towards.x), vec4(towards.y), vec4(towards.z));
    }
    vec4 z = inversesqrt(1.0 + east * east + north * north);
    vec4 lane_at = vec4(lane, lane + 1, lane + 2, lane + 3);
    vec4 column = MARCHES_ROWS ? lane_at : vec4(march);
    vec4 row = MARCHES_ROWS ? vec4(march) : lane_at;
    Mirrored mirrors = mirrored(-east * z, -north * z, z, column * cell_x_m, (float(rows - 1) - row) * cell_y_m,
                                q.here.four, eye_m);
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        vec3 normal = vec3(-east[k], -north[k], 1.0) * z[k];
        vec3 mirror = vec3(mirrors.east[k], mirrors.north[k], mirrors.up[k]);
        vec2 of = specular;
        if (SPECULAR_IS_MAP) {
            of = texelFetch(phong_map, at, 0).xy;
        }
        float facing = dot(normal, towards.xyz);
        // Where the own plane cuts the disc, the visible fraction can exceed the mean cosine's.
        float visible = min(PI * texelFetch(sun_sum, at, 0).x / max(facing, 1e-30), 1.0);
        float density = facing > 0.0 ? of.y * phong_lobe(towards.xyz - mirror, of.x) : 0.0;
        // A: written by earlier SH passes.
        vec4 before = imageLoad(specular_sum, at);
        vec4 light = vec4(colour.rgb * (visible * density), 0.0);
        vec4 sum = before + light;
        imageStore(specular_sum, at, colour.w > 0.0 ? light : sum);
        if (ORDER > 0) {
            add_arriving(at, facing > 0.0 ? visible : 0.0);
        }
    }
}
