// Computes: one step of a set of light paths for every grid point: the radiance that leaves it back along its path
// or, in the last step, towards each view. All grid points share their directions (method of dependent tests,
// Heidrich et al. 2000, section 3.2), so each step writes an image in which the next one looks up.
// Reads: ground, direct, visible_points, links, carried_in, sun_points, albedo_map, phong_map; on a curved base
// surface bent and fan_weights.
// Writes: carried; or reads and writes scattered (mean of the paths so far; w: path count).
// One invocation is one grid point of one path; in the last step, one grid point of one view, all paths.
//
// Scattered light is the integral of f_r(e) max(N.e, 0) L(e) de over the sphere, with L the radiance of the grid
// point visible along e. For e drawn uniformly from the directions, with total solid angle W, the estimate W f_r
// max(N.e, 0) L is unbiased for the sum over all directions. So is the product along a path, as its directions are
// drawn independently. On a curved base surface e depends on the grid point and is weighted by its fan weight.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"
#include "specular/phong_lobe.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const uint FROM_NONE = 0u;     // the visible point contributes nothing: beyond the last bounce
const uint FROM_DIRECT = 1u;   // its direct light alone
const uint FROM_CARRIED = 2u;  // radiance from an earlier step

layout(constant_id = 0) const uint SOURCE = FROM_DIRECT;
layout(constant_id = 1) const bool SUMS = false;  // the last step
// Two directions per word.
layout(constant_id = 2) const bool SMALL = false;
layout(constant_id = 3) const bool ALBEDO_IS_MAP = false;
layout(constant_id = 4) const bool HAS_SPECULAR = false;
layout(constant_id = 5) const bool SPECULAR_IS_MAP = false;
layout(constant_id = 6) const bool BENT = false;
// Views include the grid point's own Phong specular reflection of the lights.
layout(constant_id = 7) const bool DIRECT_SPECULAR = false;

layout(binding = 0) uniform texture2D ground;
// Diffuse exit radiance.
layout(binding = 1) uniform texture2D direct;
layout(binding = 2) uniform utexture2DArray visible_points;
// Steps of a path, two texels each: direction and its index; the sky radiance there. Then suns: direction, and
// irradiance facing it. Then the directions of the views.
layout(binding = 3) uniform textureBuffer links;
layout(binding = 4) uniform texture2DArray carried_in;
// Visibility towards each sun.
layout(binding = 5) uniform utexture2DArray sun_points;
layout(binding = 6) uniform texture2D albedo_map;
layout(binding = 7) uniform texture2D phong_map;
layout(binding = 8, rgba32f) uniform writeonly image2DArray carried;
layout(binding = 9, rgba32f) uniform image2DArray scattered;  // one layer per view
layout(binding = 10) uniform texture2DArray bent;
layout(binding = 11) uniform texture2DArray fan_weights;

layout(push_constant) uniform ScatterGatherPush {
    int cols;
    int rows;
    int first_link;       // texel of the first step of the first path of this pass
    int steps;            // per path
    int step;             // index of this step
    int first_path;       // paths in the mean so far
    int paths;            // 0: no scattered light
    int first_direction;  // of the image of visible points
    int first_sun;        // texel
    int suns;
    float weight_sr;      // W
    float exponent;
    float specular_scale;
    int first_view;       // texel
    float curvature_x;    // of the base, 1/m
    float curvature_y;
    vec4 albedo;          // where it is constant
};

vec3 sun_specular(ivec2 here, vec3 normal, vec3 mirror, vec2 specular) {
    vec3 light = vec3(0.0);
    for (int i = 0; i < suns; i++) {
        vec3 e = texelFetch(links, first_sun + 2 * i).xyz;
        uint point = point_of(texelFetch(sun_points, ivec3(here, SMALL ? i >> 1 : i), 0).x, i, SMALL);
        bool lit = point == POINT_SKY && dot(normal, e) > 0.0;
        vec3 irradiance = texelFetch(links, first_sun + 2 * i + 1).rgb;
        light += lit ? specular.y * phong_lobe(e - mirror, specular.x) * irradiance : vec3(0.0);
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
        // Directions over an elevated field diverge.
        normal.xy /= 1.0 + own.x * vec2(curvature_x, curvature_y);
    }
    normal = normalize(normal);
    vec3 colour = albedo.rgb;
    vec2 specular = vec2(exponent, specular_scale);
    if (ALBEDO_IS_MAP) {
        colour = texelFetch(albedo_map, at, 0).rgb;
    }
    if (SPECULAR_IS_MAP) {
        specular = texelFetch(phong_map, at, 0).xy;
    }
    int first = SUMS ? 0 : int(gl_WorkGroupID.z);
    int end = SUMS ? paths : first + 1;
    vec3 towards_view = vec3(0.0, 0.0, 1.0);
    if (SUMS && HAS_SPECULAR) {
        towards_view = texelFetch(links, first_view + view).xyz;
    }
    vec3 sum = vec3(0.0);
    for (int path = first; path < end; path++) {
        int link = first_link + 2 * (path * steps + step);
        vec4 ahead = texelFetch(links, link);
        int i = int(ahead.w) - first_direction;
        uint point = point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
        bool met = point < POINT_LOST;
        ivec2 there = met ? ivec2(point & 0xffffu, point >> 16) : at;
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
        if (HAS_SPECULAR) {
            vec3 back = SUMS ? towards_view : -texelFetch(links, link - 2).xyz;
            mirror = 2.0 * dot(normal, back) * normal - back;
            // Sky light is part of the diffuse direct light and of the grid point's own.
            bool is_sky = (!SUMS || DIRECT_SPECULAR) && point == POINT_SKY;
            vec3 all = arriving + (is_sky ? texelFetch(links, link + 1).rgb : vec3(0.0));
            light += facing > 0.0 ? specular.y * phong_lobe(ahead.xyz - mirror, specular.x) * all : vec3(0.0);
        }
        light *= weight_sr;
        if (!SUMS) {
            light += texelFetch(direct, at, 0).rgb;
            if (HAS_SPECULAR) {
                light += sun_specular(at, normal, mirror, specular);
            }
            imageStore(carried, ivec3(at, path), vec4(light, 1.0));
        }
        sum += light;
    }
    if (SUMS) {
        if (DIRECT_SPECULAR) {
            vec3 mirror = 2.0 * dot(normal, towards_view) * normal - towards_view;
            sum += float(paths) * sun_specular(at, normal, mirror, specular);
        }
        vec4 before = imageLoad(scattered, ivec3(at, view));
        before = first_path > 0 ? before : vec4(0.0);
        float n = before.w + float(paths);
        imageStore(scattered, ivec3(at, view), vec4(before.rgb + (sum - float(paths) * before.rgb) / n, n));
    }
}
