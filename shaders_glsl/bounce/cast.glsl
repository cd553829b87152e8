// Visible surface along one azimuth, from pyramids of heights and of exit radiance: one lookup per level, at
// distances that grow by 2^(1/k) and are rounded to whole march steps. The knots and midpoints of the B-spline over
// their elevations contribute light (Nowrouzezahrai & Snyder 2009, eq. 6-17).
//
// The including shader declares the constants PERIODIC, STACK, LEVELS, SHADE_LEVELS and GREY, and the images heights,
// height_levels, level_table, height_stack, exit_radiance, shade_levels, shade_table and shade_stack. It defines
// cast_light.
layout(push_constant) uniform GatherPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int azimuths;       // in the circle, at the middles of equal parts
    int first_azimuth;  // of this dispatch
    int last_azimuth;   // exclusive
    int warm_up_cols;   // grid points marched beyond the field, along columns: whole periods, or 0
    int warm_up_rows;
    int fine_samples;   // lookups in the field itself
    int width_shift;
    float growth;       // of distances: 2^(1/k)
    int shade_fine;     // the same for radiance
    int shade_shift;
    int step_shade;     // levels per octave of radiance, and of heights
    int step_height;
    int first_row;      // of this dispatch, in rows of invocations
};

#include "shared/angle.glsl"
#include "shared/cosine.glsl"
#include "shared/spline.glsl"
#include "bounce/shade.glsl"

// An elevation on the spline, with the place and level of its radiance.
void cast_light(float angle, vec2 place, int level, bool on);

// The march: whole steps along columns or rows, interpolated along the other axis.
ivec2 here;
bool by_x;
int forward;     // 1 or -1 along the march
float shear;     // grid points across per step
float step_m;
// The last four elevations, the newest in w, and the radiance lookup of the third.
vec4 angles;
vec2 place_before;
int level_before;

// Position of the march after that many steps, in grid points: column, row.
vec2 place_at(int steps) {
    float along = float(forward * steps);
    float across = float(steps) * shear;
    vec2 by_column = vec2(along, across);
    return vec2(here) + (by_x ? by_column : by_column.yx);
}

// The two grid points on a march step's grid line around a position.
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
        precise vec2 at = place * of.per_grid_point;
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

// Radiance of a level at a place, clamped at 0.
vec3 radiance_at(int level, vec2 place) {
    if (level > 0 && !STACK) {
        Level of = level_of(texelFetch(shade_table, ivec2(level - 1, 0), 0));
        precise vec2 at = place * of.per_grid_point;
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

// Adds an elevation: first the spline's midpoint before the last knot, then that knot, both with the radiance lookup
// of the knot.
void take_in(float angle, vec2 place, int level, bool is_first, bool on) {
    vec4 shifted = vec4(angles.yzw, angle);
    vec4 four = is_first ? vec4(angle) : shifted;
    float knot = (four.y + 4.0 * four.z + four.w) * (1.0 / 6.0);
    float middle = ((four.x + four.w) + 23.0 * (four.y + four.z)) * (1.0 / 48.0);
    vec2 of = is_first ? place : place_before;
    int of_level = is_first ? level : level_before;
    // Both have the same radiance: the higher opens the elevations of both.
    cast_light(max(middle, knot), of, of_level, on);
    angles = on ? four : angles;
    place_before = on ? place : place_before;
    level_before = on ? level : level_before;
}

// Per level, the field first; the same in all azimuths.
float own_heights[LEVELS + 1];

// Height of the grid point itself at every level; there the grid lines of both axes agree.
void find_own_heights() {
    by_x = true;
    for (int level = 0; level <= LEVELS; level++) {
        own_heights[level] = height_at(level, vec2(here));
    }
}

// Sets the march to azimuth k of so many, at the middles of equal parts of the circle; returns its direction.
vec2 turn_march(int k, int azimuths, vec2 cell_m) {
    // Half a turn counted from west, in halves: the sines' range.
    float half_turn = PI * ((float(k) + 0.5) / float(azimuths) - 0.5);
    vec2 half_direction = vec2(cosine(half_turn), sine(half_turn));
    vec2 e = -vec2(half_direction.x * half_direction.x - half_direction.y * half_direction.y,
                   2.0 * half_direction.x * half_direction.y);
    // Azimuths are multiples of 1/1024 of the circle or more: one this near to the grid lies on it, and along the
    // field's edge.
    e = mix(e, vec2(0.0), lessThan(abs(e), vec2(1e-5)));
    vec2 cells = vec2(e.x / cell_m.x, -e.y / cell_m.y);
    by_x = abs(cells.x) >= abs(cells.y);
    float along = by_x ? cells.x : cells.y;
    float beside_it = by_x ? cells.y : cells.x;
    forward = along > 0.0 ? 1 : -1;
    shear = beside_it / abs(along);
    step_m = 1.0 / abs(along);
    angles = vec4(0.0);
    place_before = vec2(here);
    level_before = 0;
    return e;
}

void march(bool exists) {
    ivec2 size = ivec2(cols, rows);
    int ahead_x = forward > 0 ? size.x - 1 - here.x : here.x;
    int ahead_y = forward > 0 ? size.y - 1 - here.y : here.y;
    int reach = by_x ? ahead_x : ahead_y;
    int side = by_x ? size.y : size.x;
    int at_side = by_x ? here.y : here.x;
    float room = shear > 0.0 ? float(side - 1 - at_side) : float(at_side);
    // Slightly more, so that rounding does not decide the last step; beyond every step where the march runs along the
    // grid.
    float beside_it = min(room / max(abs(shear), 1e-9) + 1e-3, 1e6);
    float across = mix(beside_it, 1e6, shear == 0.0);
    int far = reach + (by_x ? warm_up_cols : warm_up_rows);
    int bounded = min(reach, int(across));
    reach = PERIODIC ? far : bounded;
    bool meets = exists && reach > 0;
    bool on = meets;
    int next = 0;
    float back = 1.0;
    while (on) {
        int whole = int(back + 0.5);
        int at = min(whole, reach);
        vec2 place = place_at(at);
        int level = clamp(next + 1 - fine_samples, 0, LEVELS);
        float rise = height_at(level, place) - own_heights[level];
        float angle = arc_tangent(vec4(rise / (float(max(at, 1)) * step_m))).x;
        do {
            // As many octaves away, in radiance levels.
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
