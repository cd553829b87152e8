// Computes: one step of some light paths at every sample: the light that leaves it back along its path, or, of the last
// step, towards each view. All samples look along the same directions (method of dependent tests, Heidrich et al. 2000,
// section 3.2), so that what a step leaves is a picture that the next one looks things up in.
// Reads: ground, direct, visible_points, links, carried_in, sun_points, albedo_map, phong_map; on a curved base bent and
// fan_weights. Writes: carried, or reads and writes scattered (mean of the paths so far; w: how many).
// One invocation is one sample of one path; of the last step, one sample of one view, of all paths.
//
// The light that a sample scatters is the integral of f_r(e) max(N.e, 0) L(e) de over the sphere, L that of the sample
// seen along e. With e one of the directions, each as likely, of all the solid angle W that they stand for, its estimate is
// W f_r max(N.e, 0) L: unbiased for the sum over all directions, and so is a path's product of them, as each of its
// directions is drawn apart. On a curved base e is each sample's own, and counts for as much as its triangles have grown.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"
#include "specular/lobe.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const uint FROM_NONE = 0u;     // what is seen gives nothing: beyond the last bounce
const uint FROM_DIRECT = 1u;   // its direct light alone
const uint FROM_CARRIED = 2u;  // what an earlier step left

layout(constant_id = 0) const uint SOURCE = FROM_DIRECT;
layout(constant_id = 1) const bool SUMS = false;  // the last step
// Two directions in a word.
layout(constant_id = 2) const bool SMALL = false;
layout(constant_id = 3) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 4) const bool HAS_LOBE = false;
layout(constant_id = 5) const bool LOBE_IS_MAP = false;
layout(constant_id = 6) const bool BENT = false;
// Views see what the sample's own lobe mirrors of the lights, too.
layout(constant_id = 7) const bool OWN_LOBE = false;

layout(binding = 0) uniform texture2D ground;
// Exit radiance of what is diffuse.
layout(binding = 1) uniform texture2D direct;
layout(binding = 2) uniform utexture2DArray visible_points;
// A path's steps, two texels each: direction and its number; the light of the sky there. Then suns: direction, and
// irradiance facing it. Then views: towards them.
layout(binding = 3) uniform textureBuffer links;
layout(binding = 4) uniform texture2DArray carried_in;
// What samples see towards each sun.
layout(binding = 5) uniform utexture2DArray sun_points;
layout(binding = 6) uniform texture2D albedo_map;
layout(binding = 7) uniform texture2D phong_map;
layout(binding = 8, rgba32f) uniform writeonly image2DArray carried;
layout(binding = 9, rgba32f) uniform image2DArray scattered;  // a layer a view
layout(binding = 10) uniform texture2DArray bent;
layout(binding = 11) uniform texture2DArray fan_weights;

layout(push_constant) uniform ScatterGatherPush {
    int cols;
    int rows;
    int first_link;       // texel of the first step of this pass's first path
    int steps;            // of a path
    int step;             // this one
    int first_path;       // how many the mean holds before
    int paths;            // 0 where nothing is scattered
    int first_direction;  // of the image of visible points
    int first_sun;        // texel
    int suns;
    float weight_sr;      // W
    float exponent;
    float lobe_share;
    int first_view;       // texel
    float curvature_x;    // of the base, 1/m
    float curvature_y;
    vec4 albedo;          // where it is constant
};

vec3 sun_lobe(ivec2 here, vec3 normal, vec3 mirror, vec2 lobe) {
    vec3 light = vec3(0.0);
    for (int i = 0; i < suns; i++) {
        vec3 e = texelFetch(links, first_sun + 2 * i).xyz;
        uint seen = point_of(texelFetch(sun_points, ivec3(here, SMALL ? i >> 1 : i), 0).x, i, SMALL);
        bool lit = seen == SEES_SKY && dot(normal, e) > 0.0;
        vec3 irradiance = texelFetch(links, first_sun + 2 * i + 1).rgb;
        light += lit ? lobe.y * lobe_density(e - mirror, lobe.x) * irradiance : vec3(0.0);
    }
    return light;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    int view = int(gl_WorkGroupID.z);
    if (paths == 0) {
        imageStore(scattered, ivec3(at, view), vec4(0.0));
        return;
    }
    vec4 own = texelFetch(ground, at, 0);
    vec3 normal = vec3(-own.y, -own.z, 1.0);
    if (BENT) {
        // At a height over the base the field is drawn apart.
        normal.xy /= 1.0 + own.x * vec2(curvature_x, curvature_y);
    }
    normal = normalize(normal);
    vec3 colour = albedo.rgb;
    vec2 lobe = vec2(exponent, lobe_share);
    if (ALBEDO_IS_MAP) {
        colour = texelFetch(albedo_map, at, 0).rgb;
    }
    if (LOBE_IS_MAP) {
        lobe = texelFetch(phong_map, at, 0).xy;
    }
    int first = SUMS ? 0 : int(gl_WorkGroupID.z);
    int end = SUMS ? paths : first + 1;
    vec3 towards_view = vec3(0.0, 0.0, 1.0);
    if (SUMS && HAS_LOBE) {
        towards_view = texelFetch(links, first_view + view).xyz;
    }
    vec3 sum = vec3(0.0);
    for (int path = first; path < end; path++) {
        int link = first_link + 2 * (path * steps + step);
        vec4 ahead = texelFetch(links, link);
        int i = int(ahead.w) - first_direction;
        uint seen = point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
        bool met = seen < SEES_LOST;
        ivec2 there = met ? ivec2(seen & 0xffffu, seen >> 16) : at;
        vec3 arriving = vec3(0.0);
        if (SOURCE == FROM_DIRECT) {
            arriving = texelFetch(direct, there, 0).rgb;
        }
        if (SOURCE == FROM_CARRIED) {
            arriving = texelFetch(carried_in, ivec3(there, path), 0).rgb;
        }
        arriving = met ? arriving : vec3(0.0);
        float facing = max(dot(normal, BENT ? texelFetch(bent, ivec3(at, i), 0).xyz : ahead.xyz), 0.0);
        if (BENT) {
            facing *= texelFetch(fan_weights, ivec3(at, i), 0).x;
        }
        vec3 light = colour * (facing / PI) * arriving;
        vec3 mirror = vec3(0.0);
        if (HAS_LOBE) {
            vec3 back = SUMS ? towards_view : -texelFetch(links, link - 2).xyz;
            mirror = 2.0 * dot(normal, back) * normal - back;
            // The sky's light belongs to the direct light of what is diffuse, and of the sample itself.
            bool sees_sky = (!SUMS || OWN_LOBE) && seen == SEES_SKY;
            vec3 all = arriving + (sees_sky ? texelFetch(links, link + 1).rgb : vec3(0.0));
            light += facing > 0.0 ? lobe.y * lobe_density(ahead.xyz - mirror, lobe.x) * all : vec3(0.0);
        }
        light *= weight_sr;
        if (!SUMS) {
            light += texelFetch(direct, at, 0).rgb;
            if (HAS_LOBE) {
                light += sun_lobe(at, normal, mirror, lobe);
            }
            imageStore(carried, ivec3(at, path), vec4(light, 1.0));
        }
        sum += light;
    }
    if (SUMS) {
        if (OWN_LOBE) {
            vec3 mirror = 2.0 * dot(normal, towards_view) * normal - towards_view;
            sum += float(paths) * sun_lobe(at, normal, mirror, lobe);
        }
        vec4 before = imageLoad(scattered, ivec3(at, view));
        before = first_path > 0 ? before : vec4(0.0);
        float n = before.w + float(paths);
        imageStore(scattered, ivec3(at, view), vec4(before.rgb + (sum - float(paths) * before.rgb) / n, n));
    }
}
