// Computes: exit radiance of a fine grid, on its own slopes and albedo: by the light of a coarse grid, and by the sun with its
// shadow heights.
// Reads: normals (means over what a texel covers), albedo, sky (what `preview_gather` writes), heights, lit_above and
// dark_below (what `preview_shadow` writes).
// Writes: radiance.
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool HAS_SUN = false;
layout(constant_id = 1) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 2) const bool PERIODIC = false;

layout(binding = 0) uniform texture2D normals;
layout(binding = 1) uniform texture2D albedo;
layout(binding = 2, rgba32f) uniform readonly image2D sky;
layout(binding = 3) uniform texture2D heights;
layout(binding = 4) uniform texture2D lit_above;
layout(binding = 5) uniform texture2D dark_below;
layout(binding = 6, rgba32f) uniform writeonly image2D radiance;

#include "shared/sweep.glsl"

layout(push_constant) uniform PreviewShadePush {
    vec4 sky_by_normal;  // as in `preview_gather`
    vec4 sun_by_normal;
    vec4 most;           // radiance of a white texel that faces the sun
    vec4 colour;         // albedo where it is not a map; w: least value of the sky's function
    vec2 along_m;        // a cell's width towards the sun, east and north
    float rise_m;        // of a ray to the sun's lower edge over that width
    int cols;
    int rows;
    int sky_cols;
    int sky_rows;
    float sky_ratio;     // side of a fine cell over that of a coarse one
    int shear;           // of the lines of shadow heights
    uint flags;          // AZIMUTH_*
};

// Least height over which a texel goes from dark to lit, metres.
const float LEAST_EDGE_M = 1e-6;

// The visible share of the sun at a texel: where its height lies between the height below which none of the sun is visible
// and that from which all of it is. The slope of the texel's ground towards the sun, relative to the ray, moves the two apart.
float sun_share(ivec2 at, vec3 normal) {
    bool marches_rows = (flags & AZIMUTH_MARCHES_ROWS) != 0u;
    int lanes = marches_rows ? cols : rows;
    int steps = marches_rows ? rows : cols;
    int march = marches_rows ? at.y : at.x;
    int step = (flags & AZIMUTH_FLIPS_MARCH) != 0u ? steps - 1 - march : march;
    // The next line is one cell farther, at the next lane.
    float part = float((-step * shear) & (CELL - 1)) * (1.0 / float(CELL));
    int lane = marches_rows ? at.x : at.y;
    int beside = (flags & AZIMUTH_FLIPS_LANES) != 0u ? lane - 1 : lane + 1;
    int next = PERIODIC ? wrapped(beside, lanes) : clamp(beside, 0, lanes - 1);
    ivec2 other = marches_rows ? ivec2(next, at.y) : ivec2(at.x, next);
    float lit = mix(texelFetch(lit_above, at, 0).x, texelFetch(lit_above, other, 0).x, part);
    float dark = mix(texelFetch(dark_below, at, 0).x, texelFetch(dark_below, other, 0).x, part);
    vec2 slope = -normal.xy / max(normal.z, 1e-3);
    float spread = 0.5 * abs(dot(slope, along_m) - rise_m);
    float over = texelFetch(heights, at, 0).x - dark + spread;
    float share = clamp(over / max(lit - dark + 2.0 * spread, LEAST_EDGE_M), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 normal = texelFetch(normals, at, 0).xyz;
    ivec2 last = ivec2(sky_cols, sky_rows) - 1;
    vec2 from = clamp((vec2(at) + 0.5) * sky_ratio - 0.5, vec2(0.0), vec2(last));
    ivec2 a = ivec2(from);
    ivec2 d = min(a + 1, last);
    vec2 part = from - vec2(a);
    vec3 north = mix(imageLoad(sky, a).rgb, imageLoad(sky, ivec2(d.x, a.y)).rgb, part.x);
    vec3 south = mix(imageLoad(sky, ivec2(a.x, d.y)).rgb, imageLoad(sky, d).rgb, part.x);
    vec3 light = mix(north, south, part.y) * max(sky_by_normal.w + dot(normal, sky_by_normal.xyz), colour.w);
    if (HAS_SUN) {
        float facing = dot(normal, sun_by_normal.xyz);
        if (facing > 0.0) {
            light += most.rgb * (facing * sun_share(at, normal));
        }
    }
    light *= ALBEDO_IS_MAP ? texelFetch(albedo, at, 0).rgb : colour.rgb;
    imageStore(radiance, at, vec4(light, 1.0));
}
