// Computes: indirect light at every grid point from pyramids of heights and of exit radiance, as bounce_gather with
// an exact cosine, and the same light as a series of spherical harmonics, for the Phong specular. Radiance towards
// the grid point comes from series of exit radiance (vectors), or from one number per texel (scalars: Nowrouzezahrai
// & Snyder 2009, section 5.3).
// Reads: heights, height_levels or height_stack, level_table, ground, exit_vectors and vector_levels, or
// exit_radiance and shade_levels or shade_stack; shade_table.
// Reads and writes: bounce_sum (exit radiance for albedo 1; divided by A, the sum for whole hemispheres, after the
// last azimuths), arriving (four coefficients per layer, channel after channel).
// One invocation is one grid point.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Levels are stored at every grid point, else at their own texels.
layout(constant_id = 1) const bool STACK = false;
// Levels besides the field itself; may be 0.
layout(constant_id = 2) const int LEVELS = 0;
layout(constant_id = 3) const int SHADE_LEVELS = 0;
// One channel of radiance.
layout(constant_id = 4) const bool GREY = false;
layout(constant_id = 5) const bool VECTORS = true;
layout(constant_id = 6) const int ORDER = 4;
// Largest number of knots in a march.
layout(constant_id = 7) const int MOST_KNOTS = 64;

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
layout(binding = 10) uniform texture2DArray exit_vectors;
layout(binding = 11) uniform texture2DArray vector_levels;
layout(binding = 12, rgba32f) uniform image2DArray arriving;

#include "bounce/cast.glsl"

const int COUNT = ORDER * ORDER;
const int FOURS = (COUNT + 3) / 4;
const int CHANNELS = GREY ? 1 : 3;

vec4 harmonics[36];
#include "shared/harmonics.glsl"

// Visibility above an elevation, in this azimuth; 0 between uses.
#define VALUE float
float series[36];
float turn[11];
#include "sh/visible.glsl"
#include "sh/turn.glsl"

// The slice.
Facing facing;
vec2 azimuth;
vec2 reached;    // direction up to which the surface has been visited
float top;       // its elevation
vec3 indirect;
vec3 last;       // radiance of the last visible knot
vec3 arrived[36];

// Four texels of an image or a level, and their weights.
struct Taps4 {
    ivec2 at[4];
    vec4 weight;
};

// Two neighbouring texels of an axis, and the fraction between them.
void two_of(float place, int count, out ivec2 two, out float t) {
    int cell = int(floor(place));
    int held = clamp(cell, 0, max(count - 2, 0));
    ivec2 within = ivec2(held, min(held + 1, count - 1));
    ivec2 round = ivec2(wrapped(cell, count), wrapped(cell + 1, count));
    two = PERIODIC ? round : within;
    float from = place - float(cell);
    float from_held = clamp(place - float(held), 0.0, 1.0);
    t = PERIODIC ? from : from_held;
}

Taps4 taps_of(int level, vec2 place) {
    Taps4 taps;
    if (level > 0) {
        Level of = level_of(texelFetch(shade_table, ivec2(level - 1, 0), 0));
        precise vec2 at = place * of.per_grid_point;
        ivec2 x;
        ivec2 y;
        float t;
        float u;
        two_of(at.x, of.cols, x, t);
        two_of(at.y, of.rows, y, u);
        ivec2 row = of.first + y * of.cols;
        taps.at[0] = level_texel(row.x + x.x, shade_shift);
        taps.at[1] = level_texel(row.x + x.y, shade_shift);
        taps.at[2] = level_texel(row.y + x.x, shade_shift);
        taps.at[3] = level_texel(row.y + x.y, shade_shift);
        taps.weight = vec4((1.0 - u) * (1.0 - t), (1.0 - u) * t, u * (1.0 - t), u * t);
        return taps;
    }
    float t;
    beside(place, taps.at[0], taps.at[1], t);
    taps.at[2] = ivec2(0);
    taps.at[3] = ivec2(0);
    taps.weight = vec4(1.0 - t, t, 0.0, 0.0);
    return taps;
}

vec4 vector_at(int level, Taps4 taps, int layer) {
    vec4 a;
    vec4 b;
    vec4 c;
    vec4 d;
    if (level > 0) {
        a = texelFetch(vector_levels, ivec3(taps.at[0], layer), 0);
        b = texelFetch(vector_levels, ivec3(taps.at[1], layer), 0);
        c = texelFetch(vector_levels, ivec3(taps.at[2], layer), 0);
        d = texelFetch(vector_levels, ivec3(taps.at[3], layer), 0);
    } else {
        a = texelFetch(exit_vectors, ivec3(taps.at[0], layer), 0);
        b = texelFetch(exit_vectors, ivec3(taps.at[1], layer), 0);
        c = vec4(0.0);
        d = vec4(0.0);
    }
    return taps.weight.x * a + taps.weight.y * b + taps.weight.z * c + taps.weight.w * d;
}

// Radiance from a point towards the grid point, in a direction of its slice. Series ring; clamped at 0.
vec3 radiance_towards(vec2 direction, int level, vec2 place) {
    if (!VECTORS) {
        return radiance_at(level, place);
    }
    vec3 e = vec3(azimuth * direction.x, direction.y);
    find_harmonics(vec4(-e.x), vec4(-e.y), vec4(-e.z));
    Taps4 taps = taps_of(level, place);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < FOURS; i++) {
        vec4 y = vec4(harmonics[4 * i].x, harmonics[4 * i + 1].x, harmonics[4 * i + 2].x, harmonics[4 * i + 3].x);
        for (int c = 0; c < CHANNELS; c++) {
            sum[c] += dot(y, vector_at(level, taps, c * FOURS + i));
        }
    }
    vec3 light = max(sum, vec3(0.0));
    return GREY ? light.xxx : light;
}

// Change of incident radiance at `reached`, for all elevations above it.
void add_arriving(vec3 more) {
    add_slices(HALF_PI - top, reached.y, reached.x);
    for (int i = 0; i < COUNT; i++) {
        arrived[i] += more * series[i];
        series[i] = 0.0;
    }
}

// The visible knots along the azimuth: elevation, place, level. Stored first and evaluated later: lanes find their
// next one at different steps of a march.
vec4 knots[MOST_KNOTS];
int knot_count;

// Visible where it rises above all before.
void cast_light(float angle, vec2 place, int level, bool on) {
    if (on && angle > top) {
        knots[knot_count] = vec4(angle, place, float(level));
        knot_count++;
        top = angle;
    }
}

// Each knot's radiance replaces the previous knot's between that knot and itself.
void add_knots() {
    for (int i = 0; i < MOST_KNOTS; i++) {
        bool on = i < knot_count;
        if (!subgroupAny(on)) {
            break;
        }
        vec4 knot = knots[on ? i : 0];
        vec2 direction = vec2(cosine(knot.x), sine(knot.x));
        vec3 radiance = radiance_towards(direction, int(knot.w), knot.yz);
        float weight = max(light_between(facing, reached, direction), 0.0);
        float counts = on ? weight : 0.0;
        indirect += counts * radiance;
        vec3 change = radiance - last;
        vec3 more = on ? change : vec3(0.0);
        add_arriving(more);
        last += more;
        reached = on ? direction : reached;
        top = on ? knot.x : top;
    }
    add_arriving(-last);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    bool exists = at.x < cols && at.y < rows;
    here = min(at, ivec2(cols, rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    float up = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    find_own_heights();
    for (int i = 0; i < 36; i++) {
        // Zero past the last coefficient.
        harmonics[i] = vec4(0.0);
        series[i] = 0.0;
        arrived[i] = vec3(0.0);
    }
    bool begins = first_azimuth == 0;
    ivec2 held = min(at, ivec2(cols, rows) - 1);
    vec4 before = imageLoad(bounce_sum, held);
    vec4 sum = mix(before, vec4(0.0), bvec4(begins));
    for (int i = 0; i < FOURS; i++) {
        for (int c = 0; c < CHANNELS; c++) {
            vec4 earlier = imageLoad(arriving, ivec3(held, c * FOURS + i));
            vec4 four = mix(earlier, vec4(0.0), bvec4(begins));
            for (int k = 0; k < 4 && 4 * i + k < COUNT; k++) {
                arrived[4 * i + k][c] = four[k];
            }
        }
    }
    for (int k = first_azimuth; k < last_azimuth; k++) {
        azimuth = turn_march(k, azimuths, vec2(cell_x_m, cell_y_m));
        turn_to(2.0 * PI / float(azimuths), azimuth);
        // Rise of the grid point's own tangent plane along the azimuth.
        float own_slope = own.y * azimuth.x + own.z * azimuth.y;
        facing = Facing(-own_slope * up, up);
        reached = direction_of(own_slope);
        top = arc_tangent(vec4(own_slope)).x;
        indirect = vec3(0.0);
        last = vec3(0.0);
        float whole = light_between(facing, reached, vec2(0.0, 1.0));
        float own_top = top;
        knot_count = 0;
        // Lookup of a lane without a knot.
        knots[0] = vec4(0.0, vec2(here), 0.0);
        march(exists);
        top = own_top;
        add_knots();
        sum += vec4(indirect, whole);
    }
    if (!exists) {
        return;
    }
    // Weights over a whole hemisphere sum to 1: uniform incident radiance is preserved.
    vec4 light = vec4(max(sum.rgb, vec3(0.0)) / max(sum.a, 1e-30), 1.0);
    bool is_whole = last_azimuth == azimuths;
    imageStore(bounce_sum, at, is_whole ? light : sum);
    for (int i = 0; i < FOURS; i++) {
        for (int c = 0; c < CHANNELS; c++) {
            ivec3 layer = ivec3(at, c * FOURS + i);
            vec4 four = vec4(0.0);
            for (int k = 0; k < 4 && 4 * i + k < COUNT; k++) {
                four[k] = arrived[4 * i + k][c];
            }
            imageStore(arriving, layer, four);
        }
    }
}
