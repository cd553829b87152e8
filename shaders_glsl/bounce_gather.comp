// Computes: what the surface throws at every sample by pyramids of heights and of exit radiance: along each azimuth
// one sample a level, at distances that grow by 2^(1/k) and are rounded to whole march steps. Each knot and
// midpoint of the B-spline over their elevations that is above all before it casts its radiance over the
// elevations that it opens (Nowrouzezahrai & Snyder 2009, eq. 6-17).
// Reads: heights, height_levels or height_stack, level_table, ground, exit_radiance, shade_levels or shade_stack,
// shade_table.
// Reads and writes: bounce_sum (exit radiance for albedo 1; until the last azimuths not yet divided by its A,
// what whole hemispheres would have given).
// One invocation is one sample, or one node: bounce_sum has a texel for each.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Levels are there at every sample, else at their own texels.
layout(constant_id = 1) const bool STACK = false;
// Levels beside the field itself; may be none.
layout(constant_id = 2) const int LEVELS = 0;
layout(constant_id = 3) const int SHADE_LEVELS = 0;
// Radiance of one channel.
layout(constant_id = 4) const bool GREY = false;
// The cosine is exact; else three bands of it, and four Legendre coefficients a slice.
layout(constant_id = 5) const bool IS_PLANE = true;
// Samples from node to node: 1, 2 or 4.
layout(constant_id = 6) const int NODE_STRIDE = 1;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D height_levels;
layout(binding = 2) uniform utexture2D level_table;
layout(binding = 3) uniform texture2DArray height_stack;
layout(binding = 4) uniform texture2D ground;
layout(binding = 5) uniform texture2D exit_radiance;
layout(binding = 6) uniform texture2D shade_levels;
layout(binding = 7) uniform utexture2D shade_table;
layout(binding = 8, rgba32f) uniform image2D bounce_sum;
layout(binding = 9) uniform texture2DArray shade_stack;

layout(push_constant) uniform BounceGatherPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int azimuths;       // of the circle, at the middles of equal parts
    int first_azimuth;  // of this dispatch
    int last_azimuth;   // not itself
    int warm_up;        // periods marched beyond the field, or 0
    int fine_samples;   // that look at the field itself
    int width_shift;
    float growth;       // of distances: 2^(1/k)
    int shade_fine;     // the same of radiance
    int shade_shift;
    int step_shade;     // levels an octave of radiance, and of heights
    int step_height;
};

#include "shared/angle.glsl"
#include "shared/cosine.glsl"
#include "shared/spline.glsl"
#include "shared/shade.glsl"
#include "shared/nodes.glsl"

// The march: whole steps along columns or rows, straight across the other axis.
ivec2 here;
bool by_x;
int forward;     // 1 or -1 along the march
float shear;     // samples across a step
float step_m;
// The slice.
Facing facing;
vec2 reached;    // direction up to which the surface is seen
float top;       // its elevation
vec3 thrown;
mat3x4 series;   // Legendre coefficients, R, G, B
// The last four elevations, the newest in w, and what the third of them looks at.
vec4 angles;
vec2 place_before;
int level_before;

// Where the march is after so many steps, in samples: column, row.
vec2 place_at(int steps) {
    float along = float(forward * steps);
    float across = float(steps) * shear;
    vec2 by_column = vec2(along, across);
    return vec2(here) + (by_x ? by_column : by_column.yx);
}

// The two samples on a march step's grid line that a place lies between.
void beside(vec2 place, out ivec2 low, out ivec2 high, out float t) {
    ivec2 size = ivec2(cols, rows);
    vec2 rounded = floor(place + 0.5);
    vec2 floored = floor(place);
    vec2 cell = by_x ? vec2(rounded.x, floored.y) : vec2(floored.x, rounded.y);
    ivec2 onward = by_x ? ivec2(0, 1) : ivec2(1, 0);
    low = ivec2(cell);
    high = low + onward;
    t = by_x ? place.y - cell.y : place.x - cell.x;
    if (PERIODIC) {
        low = ivec2(wrapped(low.x, size.x), wrapped(low.y, size.y));
        high = ivec2(wrapped(high.x, size.x), wrapped(high.y, size.y));
    } else {
        low = clamp(low, ivec2(0), size - 1);
        high = clamp(high, ivec2(0), size - 1);
    }
}

float height_at(int level, vec2 place) {
    if (level > 0 && !STACK) {
        Level of = level_of(texelFetch(level_table, ivec2(level - 1, 0), 0));
        precise vec2 at = place * of.per_sample;
        return spline_at(of, at, width_shift);
    }
    ivec2 low;
    ivec2 high;
    float t;
    beside(place, low, high, t);
    if (level > 0) {
        float h = texelFetch(height_stack, ivec3(low, level - 1), 0).x;
        return h + t * (texelFetch(height_stack, ivec3(high, level - 1), 0).x - h);
    }
    float h = texelFetch(heights, low, 0).x;
    return h + t * (texelFetch(heights, high, 0).x - h);
}

// Radiance of a level at a place: what radiates is not below 0.
vec3 radiance_at(int level, vec2 place) {
    if (level > 0 && !STACK) {
        Level of = level_of(texelFetch(shade_table, ivec2(level - 1, 0), 0));
        precise vec2 at = place * of.per_sample;
        return shade_at(of, at, shade_shift);
    }
    ivec2 low;
    ivec2 high;
    float t;
    beside(place, low, high, t);
    vec4 a;
    vec4 b;
    if (level > 0) {
        a = texelFetch(shade_stack, ivec3(low, level - 1), 0);
        b = texelFetch(shade_stack, ivec3(high, level - 1), 0);
    } else {
        a = texelFetch(exit_radiance, low, 0);
        b = texelFetch(exit_radiance, high, 0);
    }
    vec4 mean = a + t * (b - a);
    return GREY ? mean.xxx : mean.rgb;
}

// Integrals of the first four normalised Legendre polynomials of z = sin(omega) below an elevation (eq. 13).
vec4 occlusion(vec2 direction) {
    float s = direction.y;
    float c2 = direction.x * direction.x;
    return vec4(0.70710678 * (s + 1.0), -0.61237244 * c2, -0.79056942 * s * c2, 0.23385359 * c2 * (5.0 * c2 - 4.0));
}

// An elevation on the spline, seen where it is above all before, with the radiance of a place.
void cast_light(float angle, vec2 place, int level, bool on) {
    bool rises = on && angle > top;
    if (!subgroupAny(rises)) {
        return;
    }
    vec2 direction = vec2(cosine(angle), sine(angle));
    vec3 radiance = radiance_at(level, place);
    if (IS_PLANE) {
        float weight = max(light_between(facing, reached, direction), 0.0);
        float counts = rises ? weight : 0.0;
        thrown += counts * radiance;
    } else {
        vec4 opened = occlusion(direction) - occlusion(reached);
        opened = rises ? opened : vec4(0.0);
        series[0] += radiance.r * opened;
        series[1] += radiance.g * opened;
        series[2] += radiance.b * opened;
    }
    reached = rises ? direction : reached;
    top = rises ? angle : top;
}

// Takes an elevation in: first the spline's midpoint before the last knot, then that knot, both with what
// the sample of the knot looks at.
void take_in(float angle, vec2 place, int level, bool is_first, bool on) {
    vec4 shifted = vec4(angles.yzw, angle);
    vec4 four = is_first ? vec4(angle) : shifted;
    float knot = (four.y + 4.0 * four.z + four.w) * (1.0 / 6.0);
    float middle = ((four.x + four.w) + 23.0 * (four.y + four.z)) * (1.0 / 48.0);
    vec2 of = is_first ? place : place_before;
    int of_level = is_first ? level : level_before;
    // Both radiate alike: the higher opens what both do.
    cast_light(max(middle, knot), of, of_level, on);
    angles = on ? four : angles;
    place_before = on ? place : place_before;
    level_before = on ? level : level_before;
}

// Of every level, the field first: they are the same in all azimuths.
float own_heights[LEVELS + 1];

void march(bool exists) {
    ivec2 size = ivec2(cols, rows);
    int ahead_x = forward > 0 ? size.x - 1 - here.x : here.x;
    int ahead_y = forward > 0 ? size.y - 1 - here.y : here.y;
    int reach = by_x ? ahead_x : ahead_y;
    int side = by_x ? size.y : size.x;
    int at_side = by_x ? here.y : here.x;
    float room = shear > 0.0 ? float(side - 1 - at_side) : float(at_side);
    // A hair more, so that rounding decides no last step; beyond any step where it runs along the grid.
    float beside_it = min(room / max(abs(shear), 1e-9) + 1e-3, 1e6);
    float across = mix(beside_it, 1e6, shear == 0.0);
    int length_of = by_x ? size.x : size.y;
    int far = reach + warm_up * length_of;
    int bounded = min(reach, int(across));
    reach = PERIODIC ? far : bounded;
    bool meets = exists && reach > 0;
    bool on = meets;
    int next = 0;
    float back = 1.0;
    // Left by all lanes together, as in horizon_sweep.
    while (subgroupAny(on)) {
        int whole = int(back + 0.5);
        int at = min(whole, reach);
        vec2 place = place_at(at);
        int level = clamp(next + 1 - fine_samples, 0, LEVELS);
        float rise = height_at(level, place) - own_heights[level];
        float angle = arc_tangent(vec4(rise / (float(max(at, 1)) * step_m))).x;
        do {
            // As many octaves away, in levels of its own.
            int shade = clamp((next * step_shade + step_height / 2) / step_height + 1 - shade_fine, 0, SHADE_LEVELS);
            take_in(angle, place, shade, next == 0, on);
            next++;
            back *= growth;
        } while (int(back + 0.5) == whole);
        on = on && whole < reach;
    }
    float last = angles.w;
    take_in(last, place_before, level_before, false, meets);
    take_in(last, place_before, level_before, false, meets);
}

// What a series gives to the three bands 1/4 + c/2 + 5/32 (3 c^2 - 1) of the clamped cosine of c = f cos(omega) + u sin(omega):
// the spherical harmonics' sum over turns, by their addition theorem. With s = cos(omega), over z of -1 .. 1:
//   int P0 = sqrt(2), int z^2 P0 = sqrt(2)/3, int s P0 = pi/(2 sqrt(2)), int z P1 = sqrt(2/3), int z s P1 = sqrt(3/2) pi/8,
//   int z^2 P2 = sqrt(8/45), int s P2 = -sqrt(5/2) pi/16, int z s P3 = -sqrt(7/2) pi/32.
vec4 three_bands() {
    float f = facing.flat_part;
    float u = facing.up;
    float even = 0.25 - 0.15625 + 0.46875 * f * f;
    float zz = 0.46875 * (u * u - f * f);
    float zs = 0.9375 * f * u;
    return vec4(1.41421356 * even + 0.47140452 * zz + 0.5 * f * 1.11072073,
                0.5 * u * 0.81649658 + zs * 0.48095618,
                zz * 0.42163702 - 0.5 * f * 0.31045588,
                -zs * 0.18366818);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 nodes = ivec2(node_count(cols, NODE_STRIDE), node_count(rows, NODE_STRIDE));
    bool exists = at.x < nodes.x && at.y < nodes.y;
    here = min(at * NODE_STRIDE, ivec2(cols, rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    float up = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    // On its own sample either axis' grid line is the same.
    by_x = true;
    for (int level = 0; level <= LEVELS; level++) {
        own_heights[level] = height_at(level, vec2(here));
    }
    vec4 sum = vec4(0.0);
    for (int k = first_azimuth; k < last_azimuth; k++) {
        // Half a turn counted from west, in halves: the sines' range.
        float half_turn = PI * ((float(k) + 0.5) / float(azimuths) - 0.5);
        vec2 half_direction = vec2(cosine(half_turn), sine(half_turn));
        vec2 e = -vec2(half_direction.x * half_direction.x - half_direction.y * half_direction.y,
                       2.0 * half_direction.x * half_direction.y);
        // Parts of the circle are 1/1024 or more: what is so near to the grid is along it, and along the field's edge.
        e = mix(e, vec2(0.0), lessThan(abs(e), vec2(1e-5)));
        vec2 cells = vec2(e.x / cell_x_m, -e.y / cell_y_m);
        by_x = abs(cells.x) >= abs(cells.y);
        float along = by_x ? cells.x : cells.y;
        float beside_it = by_x ? cells.y : cells.x;
        forward = along > 0.0 ? 1 : -1;
        shear = beside_it / abs(along);
        step_m = 1.0 / abs(along);
        // The sample's own plane rises towards the azimuth with the field's slope.
        float own_slope = own.y * e.x + own.z * e.y;
        facing = Facing(-own_slope * up, up);
        reached = direction_of(own_slope);
        top = arc_tangent(vec4(own_slope)).x;
        thrown = vec3(0.0);
        series = mat3x4(0.0);
        angles = vec4(0.0);
        place_before = vec2(here);
        level_before = 0;
        float whole = light_between(facing, reached, vec2(0.0, 1.0));
        march(exists);
        if (!IS_PLANE) {
            vec4 weights = three_bands();
            // Per azimuth int u K dz, a whole hemisphere's being pi/2 of what `thrown` counts.
            thrown = vec3(dot(series[0], weights), dot(series[1], weights), dot(series[2], weights));
            whole = 0.5;
        }
        sum += vec4(thrown, whole);
    }
    if (exists) {
        vec4 before = imageLoad(bounce_sum, at);
        vec4 both = before + sum;
        sum = first_azimuth > 0 ? both : sum;
        // Weights of a whole hemisphere sum to 1: light of equal radiance all around arrives as it is.
        vec4 light = vec4(max(sum.rgb, vec3(0.0)) / max(sum.a, 1e-30), 1.0);
        bool is_whole = last_azimuth == azimuths;
        imageStore(bounce_sum, at, is_whole ? light : sum);
    }
}
