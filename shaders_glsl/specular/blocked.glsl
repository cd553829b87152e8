// Sums the light that horizons hide from a Phong lobe, at four grid points. The including shader declares specular_tables, the
// push constants of gather.glsl, and the constants BORDER and SPECULAR_IS_SHARED.

#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"

Mirrored mirror;
vec4 blocked_red;
vec4 blocked_green;
vec4 blocked_blue;

// Adds azimuth `index`, hidden up to the slope `lowest`.
void add_blocked(uint index, Azimuth azimuth, vec4 lowest) {
    vec4 along = mirror.east * azimuth.cos_phi + mirror.north * azimuth.sin_phi;
    vec4 across = mirror.east * azimuth.sin_phi - mirror.north * azimuth.cos_phi;
    float bottom = BORDER == BORDER_OPEN ? -HALF_PI : 0.0;
    // The largest cosine of a hidden direction to the lobe's axis: at the horizon if the lobe peaks above it.
    vec4 reach = (along + mirror.up * lowest) * inversesqrt(1.0 + lowest * lowest);
    vec4 rises = along * lowest - mirror.up;
    bvec4 is_above = lessThan(rises, vec4(0.0));
    // Behind and below: the lobe decreases from straight down on.
    is_above = bvec4(uvec4(is_above) & uvec4(greaterThan(max(along, mirror.up), vec4(0.0))));
    vec4 largest = mix(sqrt(max(1.0 - across * across, 0.0)), reach, is_above);
    bvec4 is_dark = lessThanEqual(largest, vec4(least_cosine));
    if (BORDER != BORDER_OPEN) {
        is_dark = bvec4(uvec4(is_dark) | uvec4(lessThanEqual(lowest, vec4(0.0))));
    }
    if (all(is_dark)) {
        return;
    }
    ivec3 size = imageSize(specular_tables);
    vec4 power = off_slice(exponent, across) * (SPECULAR_IS_SHARED ? azimuth.wedge_rad : 1.0);
    vec4 angle = angle_of(along, mirror.up);
    float first = BORDER == BORDER_OPEN ? -PI : -HALF_PI;
    vec4 peak_place = (angle - first) / (PI - first) * float(size.x - 1);
    vec4 node_place = (arc_tangent(lowest) - bottom) / (HALF_PI - bottom) * float(size.y - 1);
    ivec4 peak = clamp(ivec4(peak_place), 0, size.x - 2);
    ivec4 node = clamp(ivec4(node_place), 0, size.y - 2);
    vec4 s = clamp(peak_place - vec4(peak), 0.0, 1.0);
    vec4 t = clamp(node_place - vec4(node), 0.0, 1.0);
    int layer = SPECULAR_IS_SHARED ? 0 : int(index);
    for (int k = 0; k < 4; k++) {
        // A lobe that peaks behind and below gives nothing above horizontal.
        if (is_dark[k] || peak_place[k] < 0.0) {
            continue;
        }
        ivec3 at = ivec3(peak[k], node[k], layer);
        vec3 low = mix(imageLoad(specular_tables, at).rgb, imageLoad(specular_tables, at + ivec3(1, 0, 0)).rgb, s[k]);
        vec3 high = mix(imageLoad(specular_tables, at + ivec3(0, 1, 0)).rgb, imageLoad(specular_tables, at + ivec3(1, 1, 0)).rgb, s[k]);
        vec3 light = power[k] * mix(low, high, t[k]);
        blocked_red[k] += light.r;
        blocked_green[k] += light.g;
        blocked_blue[k] += light.b;
    }
}
