// Sums the light that horizons hide from a Phong lobe, at four grid points. The including shader declares specular_tables,
// phong_map, constants, the push constants of gather.glsl, and the constants BORDER, SPECULAR_IS_SHARED and SPECULAR_IS_MAP.

#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"
#include "specular/levels.glsl"

Mirrored mirror;

// Specular at four grid points, and where their tables are.
struct Specular {
    vec4 exponent;
    vec4 least_cosine;
    ivec4 first_peak;
    ivec4 last_peak;
};

// For a specular map: the swept levels below and above each texel's exponent.
Specular speculars[2];

struct Blocked {
    vec4 red;
    vec4 green;
    vec4 blue;
};

Blocked blocked[2];

void find_specular(ivec4 columns, ivec4 rows) {
    for (int k = 0; k < 4; k++) {
        vec2 of = texelFetch(phong_map, ivec2(columns[k], rows[k]), 0).xy;
        ivec2 level = swept_levels(level_of(of.x));
        for (int i = 0; i < 2; i++) {
            vec4 texel = texelFetch(constants, first_level + LEVEL_TEXELS * level[i]);
            speculars[i].exponent[k] = texel.x;
            // No cosine reaches 2: a texel of scale 0 skips every direction.
            speculars[i].least_cosine[k] = of.y > 0.0 ? texel.y : 2.0;
            speculars[i].first_peak[k] = int(texel.z);
            speculars[i].last_peak[k] = int(texel.w);
        }
    }
}

void add_to(inout Blocked sum, Specular of, uint index, Azimuth azimuth, vec4 lowest) {
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
    bvec4 is_dark = lessThanEqual(largest, of.least_cosine);
    if (BORDER != BORDER_OPEN) {
        is_dark = bvec4(uvec4(is_dark) | uvec4(lessThanEqual(lowest, vec4(0.0))));
    }
    if (all(is_dark)) {
        return;
    }
    int nodes = imageSize(specular_tables).y;
    vec4 power = off_slice(of.exponent, across, along * along + mirror.up * mirror.up) * (SPECULAR_IS_SHARED ? azimuth.wedge_rad : 1.0);
    vec4 angle = angle_of(along, mirror.up);
    float first = BORDER == BORDER_OPEN ? -PI : -HALF_PI;
    vec4 peak_place = (angle - first) / (PI - first) * vec4(of.last_peak);
    vec4 node_place = (arc_tangent(lowest) - bottom) / (HALF_PI - bottom) * float(nodes - 1);
    ivec4 peak = clamp(ivec4(peak_place), ivec4(0), of.last_peak - 1);
    ivec4 node = clamp(ivec4(node_place), 0, nodes - 2);
    vec4 s = clamp(peak_place - vec4(peak), 0.0, 1.0);
    vec4 t = clamp(node_place - vec4(node), 0.0, 1.0);
    int layer = SPECULAR_IS_SHARED ? 0 : int(index);
    for (int k = 0; k < 4; k++) {
        // A lobe that peaks behind and below gives nothing above horizontal.
        if (is_dark[k] || peak_place[k] < 0.0) {
            continue;
        }
        ivec3 at = ivec3(of.first_peak[k] + peak[k], node[k], layer);
        vec3 low = mix(imageLoad(specular_tables, at).rgb, imageLoad(specular_tables, at + ivec3(1, 0, 0)).rgb, s[k]);
        vec3 high = mix(imageLoad(specular_tables, at + ivec3(0, 1, 0)).rgb, imageLoad(specular_tables, at + ivec3(1, 1, 0)).rgb, s[k]);
        vec3 light = power[k] * mix(low, high, t[k]);
        sum.red[k] += light.r;
        sum.green[k] += light.g;
        sum.blue[k] += light.b;
    }
}

// Adds azimuth `index`, hidden up to the slope `lowest`.
void add_blocked(uint index, Azimuth azimuth, vec4 lowest) {
    if (!SPECULAR_IS_MAP) {
        ivec4 last = ivec4(imageSize(specular_tables).x - 1);
        add_to(blocked[0], Specular(vec4(exponent), vec4(least_cosine), ivec4(0), last), index, azimuth, lowest);
        return;
    }
    add_to(blocked[0], speculars[0], index, azimuth, lowest);
    add_to(blocked[1], speculars[1], index, azimuth, lowest);
}
