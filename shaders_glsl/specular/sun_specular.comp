// Computes: Phong specular reflection of a sun towards the view, at every grid point: the mean of the lobe over the sun's
// disc, times the sun's visible fraction. That fraction is the sun's diffuse light over its
// unoccluded diffuse light. With a light vector, a partly hidden disc has the vector's magnitude as its visible share and
// the vector's direction as its centre. Where another bounce follows, also the incident light of the sun as a series, all of it
// from its centre.
// Reads: lane_heights, sun_sum, light_vector, phong_map.
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
layout(constant_id = 5) const bool HAS_VECTOR = false;
const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2D sun_sum;
layout(binding = 2, rgba32f) uniform image2D specular_sum;
// Phong exponent and scale.
layout(binding = 3) uniform texture2D phong_map;
layout(binding = 4, rgba32f) uniform image2DArray arriving;
layout(binding = 5) uniform texture2D light_vector;

layout(push_constant) uniform SunSpecularPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    vec4 towards;  // the sun's centre; w: its angular radius squared
    vec4 level;    // horizontal, at a right angle to the centre; w: 1 - cosine of the radius
    vec4 colour;   // irradiance; w: 1 where the sum begins
    vec4 eye_m;     // over the field's base; w: 0 for a view from straight above
    vec2 specular;  // Phong exponent and scale, where they are constant
};

#include "shared/quad.glsl"
#include "specular/phong_lobe.glsl"
#include "specular/mirror.glsl"
#include "shared/angle.glsl"

// Nodes and weights of Gauss and Legendre on [0, 1], for 1, 2, 4 and 8 rings, one after the other.
const float NODES[15] = float[](0.5, 0.2113248654, 0.7886751346, 0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558,
                                0.0198550718, 0.1016667613, 0.2372337950, 0.4082826788, 0.5917173212, 0.7627662050,
                                0.8983332387, 0.9801449282);
// ln(1e-7): lobes below this share of their peak are skipped.
const float DARK_LOG = -16.118096;
// A light vector of this magnitude or more counts as a wholly visible sun.
const float WHOLE = 0.999;
const float WEIGHTS[15] = float[](1.0, 0.5, 0.5, 0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226, 0.0506142681,
                                  0.1111905172, 0.1568533229, 0.1813418917, 0.1813418917, 0.1568533229, 0.1111905172,
                                  0.0506142681);

// An ellipse on the sphere: its middle, and two half axes in radii of the sun.
struct Ellipse {
    vec3 middle;
    vec3 along;
    vec3 across;
};

// Visible part of the sun, from its light vector, as the segment left by a straight edge. The segment's centre is c radii from
// the sun's. Half axes of the ellipse with nearly its second moments: 1 - c, with an error of 0.05 radii at most, and
// sqrt((1 - c) (1 + 1.7 c)), with one of 0.01.
Ellipse visible_part(vec3 vector, float share) {
    vec3 middle = vector / max(share, 1e-30);
    float radius = sqrt(level.w * (2.0 - level.w));
    vec3 apart = middle - towards.xyz;
    apart -= dot(apart, middle) * middle;
    float off = length(apart);
    float c = min(off / radius, 1.0);
    // Of a small share, rounding may move the centre out of the disc.
    middle = off > radius ? normalize(towards.xyz + (radius / off) * apart) : middle;
    // Where the centres nearly agree, both half axes have nearly the same length: any direction will do.
    vec3 along = off > 1e-4 * radius ? apart / off : level.xyz;
    return Ellipse(middle, (1.0 - c) * along, sqrt((1.0 - c) * (1.0 + 1.7 * c)) * cross(middle, along));
}

// Mean of the lobe of exponent n over the sun's disc or an ellipse within it, for irradiance 1. Over a disc its error is at most 2.5e-4 of
// the lobe's peak; at the lobe's end 8e-4, and with n below 1 more (measured: disc_rings in tolerance.rs). Each ring has a share of the solid angle that is its weight, and
// four times as many directions as there are rings. Where n r^2 > 48 the lobe is narrower than a seventh of the disc's radius, and is widened to that.
// At 90 degrees from the mirror direction the lobe ends, and its slope may jump. If a disc of twice the radius reaches that end,
// there are eight rings, or one for a small disc and a finite slope. A lobe that changes little across the disc is evaluated at the
// centre only, with its second derivatives along both half axes; not if a disc of four or ten times the radius reaches that end.
float disc_density(vec3 mirror, float n, Ellipse part) {
    n = min(n, 48.0 / max(towards.w, 1e-30));
    float wide = n * towards.w;
    float radius = sqrt(level.w * (2.0 - level.w));
    float to_middle = dot(mirror, part.middle);
    // Half axes of the part are at most 1.04 radii long.
    float farthest = HAS_VECTOR ? min(1.04 * radius, 1.0) : radius;
    float cos_farthest = sqrt(1.0 - farthest * farthest);
    float at_edge = to_middle * cos_farthest + sqrt(max(1.0 - to_middle * to_middle, 0.0)) * farthest;
    float largest = to_middle < cos_farthest ? at_edge : 1.0;
    if (largest <= 0.0 || n * log(max(largest, 1e-30)) < DARK_LOG) {
        return 0.0;
    }
    // Radiance times solid angle of a disc of irradiance 1.
    float full = 2.0 / (2.0 - level.w);
    float to_end = abs(to_middle);
    bool has_finite_slope = n >= 1.0;
    vec2 squared = vec2(dot(part.along, part.along), dot(part.across, part.across));
    if (wide <= 0.05 && to_end >= (has_finite_slope ? 4.0 : 10.0) * radius) {
        vec2 aside = vec2(dot(mirror, part.along), dot(mirror, part.across));
        float bend = (n - 1.0) * dot(aside, aside) / max(to_middle * to_middle, 1e-12) - squared.x - squared.y;
        return full * phong_lobe(part.middle - mirror, n) * (1.0 + wide / 8.0 * bend);
    }
    int at_end = has_finite_slope && radius < 0.01 ? 1 : 8;
    int rings = to_end < 2.0 * radius ? at_end : wide <= 0.15 ? 1 : wide <= 2.0 ? 2 : wide <= 11.0 ? 4 : 8;
    float sum = 0.0;
    for (int i = 0; i < rings; i++) {
        float h = level.w * NODES[rings - 1 + i];
        float across = sqrt(h * (2.0 - h));
        float ring = 0.0;
        for (int j = 0; j < rings; j++) {
            float angle = (float(j) + 0.5) * (HALF_PI / float(rings));
            vec2 turn = vec2(cosine(angle), sine(angle));
            vec3 a = across * (turn.x * part.along + turn.y * part.across);
            vec3 b = across * (turn.x * part.across - turn.y * part.along);
            // Depth of this direction below the tangent plane at the ellipse's centre.
            vec2 turn2 = turn * turn;
            vec2 depth = HAS_VECTOR ? h * vec2(dot(turn2, squared), dot(turn2, squared.yx)) : vec2(h);
            vec3 apart_a = (part.middle - mirror) - depth.x * part.middle;
            vec3 apart_b = (part.middle - mirror) - depth.y * part.middle;
            ring += phong_lobe(apart_a + a, n) + phong_lobe(apart_a - a, n) + phong_lobe(apart_b + b, n) + phong_lobe(apart_b - b, n);
        }
        sum += WEIGHTS[rings - 1 + i] * ring / float(4 * rings);
    }
    return full * sum;
}

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
        Ellipse part = Ellipse(towards.xyz, level.xyz, cross(towards.xyz, level.xyz));
        float share = visible;
        bool reaches = facing > 0.0;
        if (HAS_VECTOR) {
            vec3 vector = texelFetch(light_vector, at, 0).xyz;
            float magnitude = length(vector);
            if (magnitude < WHOLE) {
                share = magnitude;
                part = visible_part(vector, magnitude);
                // Below it, directions are rounding.
                reaches = magnitude > 1e-6;
            }
        }
        float density = reaches ? of.y * disc_density(mirror, of.x, part) : 0.0;
        vec4 light = vec4(colour.rgb * (share * density), 0.0);
        if (colour.w == 0.0) {
            // A: written by earlier SH passes.
            light += imageLoad(specular_sum, at);
        }
        imageStore(specular_sum, at, light);
        if (ORDER > 0) {
            add_arriving(at, facing > 0.0 ? visible : 0.0);
        }
    }
}
