// Computes: direct light of a sphere light by spherical harmonics: visibility up to the sphere's distance, times the
// sphere, times the receiver, all three as series, in a frame rotated so that the sphere is at azimuth 0. Some of the
// azimuths at a time: A holds the light of all until they are complete.
// Reads: ground, constants; cells and maxima, or heights and the levels of a pyramid.
// Reads and writes: sphere_sum (RGB: exit radiance for albedo 1; A: of this sphere, for radiance 1, before clamping
// at 0).
// One invocation is one grid point.
//
// Follows the thesis on local lights on height fields, sections 4.3 and 5.3, appendix A, after Snyder &
// Nowrouzezahrai 2008: horizons of all azimuths, of both ends of wedges of a table. With slices instead
// (Nowrouzezahrai & Snyder 2009, section 6): azimuths across the sphere alone, as far to either side as it reaches;
// the horizons at both ends continue around the rest. Terrain that does not hide the sphere then does not darken it,
// however few bands blur it.
#version 460

#include "shared/angle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// As in sphere_shade.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 2) const bool THIN_COLS = false;
layout(constant_id = 3) const int MOST_STEPS = 60000;
layout(constant_id = 4) const int ORDER = 4;
// Treatment of azimuths: slices, slices of n Legendre coefficients, wedges between two from a table.
layout(constant_id = 5) const uint WEDGES = 0u;
layout(constant_id = 6) const bool OWN_PLANE_HIDES = true;
// Horizons come from a height pyramid, else from the surface.
layout(constant_id = 7) const bool BY_PYRAMID = false;
// As in pyramid_march.
layout(constant_id = 8) const bool STACK = false;
layout(constant_id = 9) const int LEVELS = 0;
const bool PERIODIC = BORDER == BORDER_PERIODIC;
const uint BY_NLP = 1u;
const uint BY_TABLE = 2u;
// Equal wedges from one end of the azimuths across the sphere around to the other, without horizons of their own:
// enough for the grid point's own plane, which is a smooth curve.
const int BEYOND = 32;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform texture2D ground;
layout(binding = 3, rgba32f) uniform image2D sphere_sum;
layout(binding = 4) uniform textureBuffer constants;
layout(binding = 5) uniform texture2D heights;
layout(binding = 6) uniform texture2D height_levels;
layout(binding = 7) uniform utexture2D level_table;
layout(binding = 8) uniform texture2DArray height_stack;

#include "rays/land.glsl"

layout(push_constant) uniform SphereShShadePush {
    LandPush land;
    ivec2 first;       // as in sphere_shade
    ivec2 base;
    vec2 offset;
    float up_m;
    float radius_m;
    float reach_m;
    int azimuths;
    int first_azimuth;
    int last_azimuth;  // exclusive
    int entry_first;   // in constants: row of the receiver, index in visibility, index in the sphere, factor
    int entry_count;
    int table_first;   // in constants: wedges of the whole sphere, as in sh_wedges
    int side;
    int fine_samples;  // as in pyramid_march
    int width_shift;
    float growth;
    float level_step;
    vec4 radiance;     // w: 1 where the sum begins
};

#include "rays/walk.glsl"
#include "shared/spline.glsl"
#include "sh/within.glsl"

// Of the sphere: coefficients of m below 0 are 0, as it is at azimuth 0. Of visibility. Of one wedge. The azimuth's
// weights.
#define VALUE float
float light[36];
float series[36];
float wedge[36];
float turn[11];

#include "sh/visible.glsl"
#include "sh/turn.glsl"
#include "sh/wedge.glsl"

vec2 turned(vec2 a, vec2 b) {
    // `precise`: doubling an eighth turn gives a cosine of exactly 0.
    precise float x = a.x * b.x - a.y * b.y;
    return vec2(x, a.x * b.y + a.y * b.x);
}

// Cosine and sine on [-pi, pi].
vec2 direction(float angle) {
    vec2 half_ = vec2(cosine(0.5 * angle), sine(0.5 * angle));
    return turned(half_, half_);
}

// Maps 0 .. 2 azimuths to -1 .. 1. The middle is exactly 0 despite inexact division.
float off_middle(int halves) {
    float off = float(halves) / float(azimuths) - 1.0;
    return halves == azimuths ? 0.0 : off;
}

// A cap of half-angle a about an axis of this sine and cosine of elevation. Band l: 2 pi times the integral of P_l
// over the cap's z (1 - cos a, or sin^2 a P_l'(cos a) / (l (l + 1)) by Legendre's equation) times Y_lm of the axis.
// From inside, the whole sphere: asin(r / d) has no value there.
void find_light(float distance_m, vec2 elevation) {
    bool is_inside = distance_m < radius_m;
    float share = min(radius_m / max(distance_m, 1e-30), 1.0);
    float outside_cosine = sqrt((1.0 - share) * (1.0 + share));
    float outside_sine2 = share * share;
    float whole = -1.0;
    float none = 0.0;
    float cosine_ = is_inside ? whole : outside_cosine;
    float sine2 = is_inside ? none : outside_sine2;
    float small = sine2 / (1.0 + outside_cosine);
    float large = 1.0 - cosine_;
    float before = 0.0;
    float derivative = 1.0;
    float value_before = 1.0;
    float value = cosine_;
    float shares[6];
    shares[0] = is_inside ? large : small;
    for (int l = 1; l < ORDER; l++) {
        shares[l] = sine2 * derivative / float(l * (l + 1));
        // P'_(l+1) = P'_(l-1) + (2 l + 1) P_l, and Bonnet's for P.
        float next = before + float(2 * l + 1) * value;
        before = derivative;
        derivative = next;
        float further = (float(2 * l + 1) * cosine_ * value - float(l) * value_before) / float(l + 1);
        value_before = value;
        value = further;
    }
    // Normalised associated Legendre functions at the axis, by their recurrences, times cos 0 / sqrt(pi).
    float diagonal = 0.7071067811865476;
    for (int m = 0; m < ORDER; m++) {
        if (m > 0) {
            diagonal *= sqrt(float(2 * m + 1) / float(2 * m)) * elevation.x;
        }
        float around = 2.0 * PI * (m == 0 ? 0.3989422804014327 : 0.5641895835477563);
        float below = 0.0;
        float theta = diagonal;
        for (int l = m; l < ORDER; l++) {
            light[l * (l + 1) + m] = around * shares[l] * theta;
            float of_next = float((l + 1) * (l + 1));
            float of_this = float(l * l);
            float m2 = float(m * m);
            float down = sqrt(max((of_this - m2) / (4.0 * of_this - 1.0), 0.0));
            float next = (elevation.y * theta - down * below) * sqrt((4.0 * of_next - 1.0) / (of_next - m2));
            below = theta;
            theta = next;
        }
    }
}

// Adds visibility above a slope along an azimuth to the series.
void add_slice(float width_rad, vec2 one, float lowest) {
    turn_to(width_rad, one);
    float cos_ = inversesqrt(1.0 + lowest * lowest);
    float sin_ = lowest * cos_;
    if (WEDGES == BY_NLP) {
        add_nlps(sin_, cos_);
    } else {
        add_slices(HALF_PI - arc_tangent(vec4(lowest)).x, sin_, cos_);
    }
}

// Adds the table's visibility above two horizons, at table positions.
void add_wedge(vec2 one, float near, float far) {
    int row = min(int(near), side - 2);
    int col = min(int(far), side - 2);
    float u = near - float(row);
    float v = far - float(col);
    int layers = (ORDER * ORDER + 3) / 4;
    for (int layer = 0; layer < layers; layer++) {
        int at = table_first + (row * side + col) * layers + layer;
        int below = at + side * layers;
        vec4 near_row = mix(texelFetch(constants, at), texelFetch(constants, at + layers), v);
        vec4 far_row = mix(texelFetch(constants, below), texelFetch(constants, below + layers), v);
        vec4 four = mix(near_row, far_row, u);
        wedge[4 * layer] = four.x;
        wedge[4 * layer + 1] = four.y;
        wedge[4 * layer + 2] = four.z;
        wedge[4 * layer + 3] = four.w;
    }
    add_turned(one);
}

// The grid point: texel, height and slopes; and the direction to the sphere.
ivec2 here;
vec4 own;
vec2 towards;

float own_slope(vec2 one) {
    vec2 e = turned(towards, one);
    return own.y * e.x + own.z * e.y;
}

// Slope of the lowest visible direction up to a distance, ignoring the grid point's own plane.
float free_above(vec2 one, float within_m, bool alive) {
    vec2 e = turned(towards, one);
    Ray ray = ray_from(here, vec2(0.0), own.x, vec3(e, 0.0), vec2(land.cell_x_m, land.cell_y_m));
    if (BY_PYRAMID) {
        return pyramid_within(here, ray, within_m, alive);
    }
    return surface_within(ray, within_m, alive);
}

float lowest_of(float free, vec2 one) {
    return OWN_PLANE_HIDES ? max(free, own_slope(one)) : free;
}

// Slices across the sphere, and on from both ends around.
void add_slices_across(float half_width, float within_m, bool alive) {
    float width = 2.0 * half_width / float(azimuths);
    float beyond = (PI - half_width) / float(BEYOND / 2);
    for (int i = first_azimuth; i < last_azimuth; i++) {
        vec2 one = direction(half_width * off_middle(2 * i + 1));
        float free = free_above(one, within_m, alive);
        add_slice(width, one, lowest_of(free, one));
        float last_too = i == azimuths - 1 ? 1.0 : 0.0;
        float first_too = i == 0 ? 1.0 : 0.0;
        int beyond_count = i == 0 || i == azimuths - 1 ? BEYOND / 2 : 0;
        for (int k = 0; k < beyond_count; k++) {
            vec2 right = direction(half_width + beyond * (float(k) + 0.5));
            vec2 left = vec2(right.x, -right.y);
            add_slice(beyond * last_too, right, lowest_of(free, right));
            add_slice(beyond * first_too, left, lowest_of(free, left));
        }
    }
}

// Table position of the horizon of an azimuth of the whole circle.
float place_of(int i, float within_m, bool alive) {
    // From -pi on.
    vec2 one = direction(PI * off_middle(2 * i));
    float lowest = lowest_of(free_above(one, within_m, alive), one);
    float place = (arc_tangent(vec4(lowest)).x + HALF_PI) * (float(side - 1) / PI);
    return clamp(place, 0.0, float(side - 1));
}

void add_wedges_around(float within_m, bool alive) {
    float near = 0.0;
    for (int i = first_azimuth; i <= last_azimuth; i++) {
        float far = place_of(i % azimuths, within_m, alive);
        if (i > first_azimuth) {
            add_wedge(direction(PI * off_middle(2 * i - 2)), near, far);
        }
        near = far;
    }
}

// Series of the sphere and of visibility, times the receiver.
float product() {
    float z = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    vec2 level = vec2(-own.y, -own.z) * z;
    float x = dot(level, towards);
    float y = towards.x * level.y - towards.y * level.x;
    float receiver[9] = float[9](1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y);
    float sum = 0.0;
    for (int i = 0; i < entry_count; i++) {
        vec4 entry = texelFetch(constants, entry_first + i);
        sum += entry.w * receiver[int(entry.x)] * series[int(entry.y)] * light[int(entry.z)];
    }
    return sum;
}

void main() {
    ivec2 at = first + ivec2(gl_GlobalInvocationID.xy);
    bool exists = at.x < land.cols && at.y < land.rows;
    here = min(at, ivec2(land.cols, land.rows) - 1);
    own = texelFetch(ground, here, 0);
    vec2 cells_to = vec2(base - here) + offset;
    vec2 flat_m = vec2(cells_to.x * land.cell_x_m, -cells_to.y * land.cell_y_m);
    float up = up_m - own.x;
    float away = length(flat_m);
    float distance_m = length(vec2(away, up));
    bool alive = exists && distance_m <= reach_m;
    towards = away > 0.0 ? flat_m / away : vec2(1.0, 0.0);
    for (int i = 0; i < 36; i++) {
        light[i] = 0.0;
        series[i] = 0.0;
    }
    if (BY_PYRAMID) {
        find_own_heights(here);
    }
    vec2 up_there = vec2(away, up) / max(distance_m, 1e-30);
    vec2 straight_up = vec2(0.0, 1.0);
    find_light(distance_m, distance_m > 0.0 ? up_there : straight_up);
    // Range: the sphere's centre, or the farthest point in the plane where a ray touches it: t cos(omega - a), t the
    // tangents' length. From inside, its radius.
    float tangent2 = max((distance_m - radius_m) * (distance_m + radius_m), 0.0);
    float share = radius_m / max(distance_m, 1e-30);
    float touched_m = up_there.x * (tangent2 / max(distance_m, 1e-30)) + sqrt(tangent2) * share * abs(up_there.y);
    float outside_m = max(away, touched_m);
    float within_m = distance_m < radius_m ? radius_m : outside_m;
    if (WEDGES == BY_TABLE) {
        add_wedges_around(within_m, alive);
    } else {
        // asin(r / away), continuous to the whole circle from where the sphere is overhead or around.
        float half_angle_sin = min(radius_m / max(away, 1e-30), 1.0);
        float half_angle = arc_tangent(vec4(half_angle_sin * inversesqrt(max((1.0 - half_angle_sin) * (1.0 + half_angle_sin), 1e-20)))).x;
        add_slices_across(max(half_angle, PI * half_angle_sin * half_angle_sin * half_angle_sin), within_m, alive);
    }
    float part = product();
    if (exists) {
        vec4 before = imageLoad(sphere_sum, at);
        bool begins = radiance.w > 0.0;
        float so_far = (first_azimuth == 0 ? 0.0 : before.w) + (alive ? part : 0.0);
        vec3 sum = begins ? vec3(0.0) : before.rgb;
        vec3 whole = sum + radiance.rgb * max(so_far, 0.0);
        bool is_whole = last_azimuth == azimuths;
        imageStore(sphere_sum, at, vec4(is_whole ? whole : sum, so_far));
    }
}
