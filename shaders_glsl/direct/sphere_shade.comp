// Computes: direct light of a sphere light: some of its vertical slices, each in closed form over the visible
// intervals, added to other slices and sphere lights; and its Phong specular. Where a bounce of specular light follows, also its incident
// light as a series of spherical harmonics.
// Reads: cells, maxima, ground, phong_map.
// Reads and writes: sphere_sum (exit radiance for albedo 1), specular_sum (exit radiance), arriving (four coefficients per layer, channel
// after channel).
// One invocation is one grid point.
//
// In a slice the sphere is a disc. An elevation is lit where the ray enters the disc (from inside: leaves it) before
// it hits the surface. The surface in front of the disc hides everything below its highest slope. Between the near
// and far ends of the disc, each visible surface piece either has disc in front of it or not.
#version 460
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/angle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// A field one grid point wide that does not repeat is a line: only slices along it hit it.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 2) const bool THIN_COLS = false;
// More steps than a ray of this field can take; llvmpipe ends all loops together after 65,535 iterations.
layout(constant_id = 3) const int MOST_STEPS = 60000;

layout(constant_id = 4) const bool HAS_SPECULAR = false;
layout(constant_id = 5) const bool SPECULAR_IS_MAP = false;
// Order of the series; 0 for none. One channel of radiance.
layout(constant_id = 6) const int ORDER = 0;
layout(constant_id = 7) const bool GREY = false;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform texture2D ground;
layout(binding = 3, rgba32f) uniform image2D sphere_sum;
layout(binding = 4, rgba32f) uniform image2D specular_sum;
// Phong exponent and scale.
layout(binding = 5) uniform texture2D phong_map;
layout(binding = 6, rgba32f) uniform image2DArray arriving;

#include "rays/land.glsl"

layout(push_constant) uniform SphereShadePush {
    LandPush land;
    ivec2 first;       // grid point of the dispatch: column, row
    ivec2 base;        // of the sphere's centre: whole cells east of the first column, south of the first row
    vec2 offset;       // the remaining fraction of a cell
    float up_m;        // of the sphere's centre over the base height
    float radius_m;
    float reach_m;     // farther grid points get nothing
    int slices;        // for a sphere that subtends a narrow angle at the grid point
    int slices_around; // for one that surrounds it; wide ones use the same count per radian
    int first_slice;
    int last_slice;    // exclusive
    float exponent;    // of the Phong lobe, where it is constant, and its scale
    float scale;
    float specular_begins; // 1 where the specular sum begins
    vec4 radiance;     // w: 1 where the sum begins
    vec4 eye_m;        // over the field's base; w: 0 for a view from straight above
};

#include "rays/walk.glsl"
#include "specular/phong_slice.glsl"
#include "specular/mirror.glsl"

vec4 harmonics[36];
#include "shared/harmonics.glsl"

const int COUNT = ORDER * ORDER;
const int FOURS = (COUNT + 3) / 4;
const int CHANNELS = GREY ? 1 : 3;

// The slice: its distance axis is horizontal, the grid point is its origin; metres.
vec2 disc;           // centre
float disc_radius;
float tangent2;      // square of a tangent's length; 0 or negative inside the sphere
vec2 axis;           // origin of elevations: the unit vector towards the disc's centre
float high_slope;    // of the disc's upper end
// The normal within the slice.
float flat_part;
float normal_up;
// The lobe about the mirror direction within the slice: the mirror direction's part in the slice, scaled to unit length, and a^n.
float phong_n;
float phong_along;
float phong_up;
float phong_power;
// State of the slice: the slope below which the surface hides it, and the light of the visible interval below.
float reached;
float visible_light;
float visible_specular;
// For a series: four equal parts of the disc's elevations, counted from the axis. Where each begins, how high it is, how much of it is
// visible, and the integral of the elevation over that.
vec4 part_begins;
float part_rad;
vec4 part_visible;
vec4 part_moment;

// A direction of the slice, counted from the axis: cosine and sine.
vec2 from_axis(float slope) {
    vec2 direction = vec2(1.0, slope) * inversesqrt(1.0 + slope * slope);
    return vec2(dot(axis, direction), axis.x * direction.y - axis.y * direction.x);
}

vec2 turned(vec2 a, vec2 b) {
    // `precise`: doubling an eighth turn gives a cosine of exactly 0.
    precise float x = a.x * b.x - a.y * b.y;
    return vec2(x, a.x * b.y + a.y * b.x);
}

// Integral over elevations between two directions of the slice of (A cos + B sin) cos, with A, B the normal's parts:
// D = high - low and S = high + low in  A/2 (D + cos S sin D) + B/2 sin S sin D.
float light_between(vec2 low, vec2 high) {
    vec2 sum = low + high;
    vec2 difference = high - low;
    // tan(D/2); exact for small discs, as both are relative to their middle.
    float half_tangent = sqrt(dot(difference, difference) / max(dot(sum, sum), 1e-20));
    float width = 2.0 * arc_tangent(vec4(half_tangent)).x;
    float sine_of = low.x * high.y - low.y * high.x;
    vec2 twice = turned(turned(axis, axis), turned(low, high));
    return 0.5 * (flat_part * (width + twice.x * sine_of) + normal_up * twice.y * sine_of);
}

// Integral of the lobe times cos over elevations between two directions of the slice, without a^n. A narrow interval uses the lobe
// in its middle, as the antiderivatives at its ends are nearly equal.
float specular_between(vec2 low, vec2 high) {
    vec2 sum = low + high;
    vec2 difference = high - low;
    float sum2 = max(dot(sum, sum), 1e-20);
    float width = 2.0 * arc_tangent(vec4(sqrt(dot(difference, difference) / sum2))).x;
    if (width * width * (phong_n + 1.0) < 2.5e-3) {
        vec2 middle = turned(axis, sum * inversesqrt(sum2));
        float c = phong_along * middle.x + phong_up * middle.y;
        float s = phong_along * middle.y - phong_up * middle.x;
        float power = exp(-0.5 * phong_n * minus_log(vec4(min(s * s, 1.0)), vec4(c * c)).x);
        return c > 0.0 ? (phong_n + 1.0) / (2.0 * PI) * power * middle.x * width : 0.0;
    }
    vec2 from = turned(axis, low);
    vec2 to = turned(axis, high);
    vec4 along = vec4(phong_along);
    vec4 up = vec4(phong_up);
    float above = phong_integral(phong_n, along, up, vec4(to.x), vec4(to.y)).x;
    return max(above - phong_integral(phong_n, along, up, vec4(from.x), vec4(from.y)).x, 0.0);
}

// Adds the elevations between two directions to the parts of the disc.
void add_to_parts(vec2 low, vec2 high) {
    vec4 ends = arc_tangent(vec4(low.y, high.y, 0.0, 0.0) / max(vec4(low.x, high.x, 1.0, 1.0), 1e-30));
    vec4 part_ends = part_begins + part_rad;
    vec4 from = min(max(vec4(ends.x), part_begins), part_ends);
    vec4 to = min(max(vec4(ends.y), part_begins), part_ends);
    vec4 visible = max(to - from, 0.0);
    part_visible += visible;
    part_moment += 0.5 * visible * (from + to);
}

// Harmonics of each part at the middle of what is visible of it, in the slice of azimuth e, and their weights: integrals of the
// cosine of elevation over an interval of that length.
vec4 part_harmonics(vec2 e) {
    vec4 flat_parts;
    vec4 up;
    vec4 middle = min(max(part_moment / max(part_visible, 1e-30), part_begins), part_begins + part_rad);
    for (int k = 0; k < 4; k++) {
        vec2 direction = turned(axis, vec2(cosine(middle[k]), sine(middle[k])));
        flat_parts[k] = max(direction.x, 0.0);
        up[k] = direction.y;
    }
    find_harmonics(flat_parts * e.x, flat_parts * e.y, up);
    return flat_parts * part_visible * (1.0 - part_visible * part_visible / 24.0);
}

// Adds the light in front of a surface piece between two distances, up to a slope.
void add_interval(vec2 begin, float slope, float from, float to, float top_slope, bool counts) {
    float low = max((begin.y + slope * (from - begin.x)) / from, reached);
    float high = min((begin.y + slope * (to - begin.x)) / to, top_slope);
    float light = light_between(from_axis(low), from_axis(high));
    counts = counts && to > from && high > low;
    visible_light += counts ? light : 0.0;
    if (HAS_SPECULAR && counts) {
        visible_specular += specular_between(from_axis(low), from_axis(high));
    }
    if (ORDER > 0 && counts) {
        add_to_parts(from_axis(low), from_axis(high));
    }
}

// Adds a surface piece, from a distance and height to a farther one: the visible interval of the disc in front of it,
// where some of the piece itself is visible.
void add_piece(vec2 begin, vec2 end) {
    float slope = (end.y - begin.y) / (end.x - begin.x);
    float end_slope = end.y / end.x;
    float top_slope = min(end_slope, high_slope);
    // The piece is visible from where it crosses `reached`; the part above the disc does not count.
    float under = begin.y - reached * begin.x;
    float over = end.y - reached * end.x;
    float visible_from = begin.x + (end.x - begin.x) * clamp(under / min(under - over, -1e-30), 0.0, 1.0);
    float below_top = begin.y - high_slope * begin.x;
    float above_top = end.y - high_slope * end.x;
    float cut = begin.x + (end.x - begin.x) * clamp(below_top / min(below_top - above_top, -1e-30), 0.0, 1.0);
    float visible_to = end_slope > high_slope ? cut : end.x;
    // The circle's intersection with the piece's line: within half a chord of the foot of the perpendicular.
    float a = 1.0 + slope * slope;
    vec2 to_middle = disc - begin;
    float beside = to_middle.y - slope * to_middle.x;
    float chord2 = (disc_radius * disc_radius - beside * beside / a) / a;
    float foot = begin.x + (to_middle.x + slope * to_middle.y) / a;
    float half_chord = sqrt(max(chord2, 0.0));
    bool is_met = chord2 > 0.0;
    float last_visible = max(visible_from, visible_to);
    float enters = clamp(foot - half_chord, visible_from, last_visible);
    float leaves = clamp(foot + half_chord, visible_from, last_visible);
    enters = is_met ? enters : visible_to;
    leaves = is_met ? leaves : visible_to;
    // Outside the disc, but between its tangents: behind it if beyond the line through the points of tangency.
    float before_at = 0.5 * (visible_from + enters);
    float after_at = 0.5 * (leaves + visible_to);
    float before = before_at * disc.x + (begin.y + slope * (before_at - begin.x)) * disc.y;
    float after = after_at * disc.x + (begin.y + slope * (after_at - begin.x)) * disc.y;
    float from_outside = before > tangent2 ? visible_from : enters;
    float to_outside = after > tangent2 ? visible_to : leaves;
    bool counts = begin.x > 0.0 && end.x > begin.x && end_slope > reached && reached < high_slope;
    // From inside, a hit within the sphere hides: there may be light on both sides of it.
    bool is_inside = tangent2 <= 0.0;
    float from = is_inside ? leaves : from_outside;
    float to = is_inside ? visible_to : to_outside;
    add_interval(begin, slope, from, to, top_slope, counts);
    if (is_inside) {
        add_interval(begin, slope, visible_from, enters, top_slope, counts);
    }
}

// March over the surface from the grid point to the disc's far end.
void march(Ray ray, bool going) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    float highest = imageLoad(maxima, ivec2(0, level_top(land.top_level, land.padded_rows))).x - ray.own;
    float step_m = 1.0 / ray.scale;
    float near_m = tangent2 > 0.0 ? disc.x - disc_radius : -1.0;
    float t_end = (disc.x + disc_radius) * ray.scale;
    if (BORDER == BORDER_PERIODIC) {
        t_end = min(t_end, REACH_CELLS);
    }
    Walk walk = walk_from(ray);
    going = going && !walk.leaves && t_end > 0.0;
    for (int turn = 0; turn < MOST_STEPS; turn++) {
        if (!going) {
            break;
        }
        Block block = block_of(walk, ray);
        ivec2 fetched = clamp(walk.at, ivec2(0), cells_of - 1);
        vec4 corners = imageLoad(cells, fetched);
        int shown = max(walk.level, 1);
        float top = imageLoad(maxima, (fetched >> (LEVEL_BITS * shown)) + ivec2(0, level_top(shown, land.padded_rows))).x - ray.own;
        float rise = reached * step_m;
        bool is_cell = walk.level == 0;
        bool clear = is_cell || min(walk.t * rise, block.ahead * rise) >= top;
        // The cell: where the ray enters it, its diagonal, and where it leaves.
        vec2 from = ray.offset + vec2(ray.base - walk.cell);
        float apart = ray.advance.x - ray.advance.y;
        float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
        bool is_split = t_split > walk.t && t_split < block.ahead;
        float t_middle = is_split ? t_split : walk.t;
        vec2 at_middle = clamp(from + t_middle * ray.advance, 0.0, 1.0);
        // In an unsplit cell the middle is the entry, whose slope has been added already.
        vec2 middle = vec2(t_middle * step_m, (corners.x - ray.own) + at_middle.x * (corners.w - corners.x));
        vec2 exit = vec2(block.ahead * step_m, cell_rise(corners, ray.own, clamp(from + block.ahead * ray.advance, 0.0, 1.0)));
        bool in_cell = going && is_cell;
        bool has_piece = in_cell && block.ahead > walk.t;
        float middle_slope = middle.y / max(middle.x, 1e-30);
        float exit_slope = exit.y / max(exit.x, 1e-30);
        float steepest = is_split ? max(middle_slope, exit_slope) : exit_slope;
        bool opens = has_piece && exit.x > near_m && steepest > reached && reached < high_slope;
        if (opens) {
            float kept = visible_light;
            float reached_before = reached;
            vec2 entry = vec2(walk.t * step_m, cell_rise(corners, ray.own, clamp(from + walk.t * ray.advance, 0.0, 1.0)));
            middle.y = is_split ? middle.y : entry.y;
            add_piece(entry, middle);
            reached = is_split ? max(reached, middle_slope) : reached;
            add_piece(middle, exit);
            visible_light = opens ? visible_light : kept;
            reached = reached_before;
        }
        reached = has_piece ? max(reached, steepest) : reached;
        walk_on(walk, ray, block, going, clear, land.top_level);
        bool is_over = reached >= high_slope || (reached > 0.0 && walk.t * reached * step_m >= highest);
        going = going && !walk.leaves && walk.t < t_end && !is_over;
    }
}

// Light of the slice at azimuth e, by `turn` from the sphere's centre, per radian: diffuse, and specular of scale 1.
vec2 slice_light(ivec2 here, vec4 own, vec3 mirror, vec2 turn, vec2 e, float away, float up, bool alive) {
    float across = away * turn.y;
    float chord2 = (radius_m - across) * (radius_m + across);
    disc = vec2(away * turn.x, up);
    disc_radius = sqrt(max(chord2, 0.0));
    bool is_inside = tangent2 <= 0.0;
    float tangent_m = sqrt(max(tangent2, 0.0));
    float distance_m = sqrt(max(dot(disc, disc), 1e-30));
    axis = is_inside ? vec2(1.0, 0.0) : disc / distance_m;
    float sine_half = is_inside ? 1.0 : min(disc_radius / distance_m, 1.0);
    float cosine_half = is_inside ? 0.0 : tangent_m / distance_m;
    // The disc's ends, relative to the axis and to horizontal; clamped at the vertical.
    vec2 low = vec2(cosine_half, -sine_half);
    vec2 high = vec2(cosine_half, sine_half);
    vec2 low_end = turned(axis, low);
    vec2 high_end = turned(axis, high);
    bool low_ahead = low_end.x > 0.0;
    bool high_ahead = high_end.x > 0.0;
    float low_slope = clamp(low_end.y / max(low_end.x, 1e-30), NO_SLOPE, -NO_SLOPE);
    high_slope = clamp(high_end.y / max(high_end.x, 1e-30), NO_SLOPE, -NO_SLOPE);
    low_slope = low_ahead ? low_slope : NO_SLOPE;
    high_slope = high_ahead ? high_slope : -NO_SLOPE;
    low = low_ahead ? low : vec2(-axis.y, -axis.x);
    high = high_ahead ? high : vec2(axis.y, axis.x);
    alive = alive && chord2 > 0.0 && (is_inside || low_ahead || high_ahead);
    normal_up = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    // Rise of the grid point's own tangent plane along the azimuth.
    float own_slope = own.y * e.x + own.z * e.y;
    flat_part = -own_slope * normal_up;
    reached = max(low_slope, own_slope);
    visible_light = 0.0;
    visible_specular = 0.0;
    if (HAS_SPECULAR) {
        float along = dot(mirror.xy, e);
        float within = along * along + mirror.z * mirror.z;
        float shorten = inversesqrt(max(within, 1e-30));
        phong_along = along * shorten;
        phong_up = mirror.z * shorten;
        phong_power = off_slice(vec4(phong_n), vec4(mirror.x * e.y - mirror.y * e.x), vec4(within)).x;
    }
    if (ORDER > 0) {
        vec4 ends = arc_tangent(vec4(low.y, high.y, 0.0, 0.0) / max(vec4(low.x, high.x, 1.0, 1.0), 1e-30));
        part_rad = 0.25 * max(ends.y - ends.x, 0.0);
        part_begins = ends.x + part_rad * vec4(0.0, 1.0, 2.0, 3.0);
        part_visible = vec4(0.0);
        part_moment = vec4(0.0);
    }
    bool is_lit = alive && reached < high_slope;
    march(ray_from(here, vec2(0.0), own.x, vec3(e, 0.0), vec2(land.cell_x_m, land.cell_y_m)), is_lit);
    vec2 visible_from = from_axis(reached);
    vec2 lowest = reached > low_slope ? visible_from : low;
    float rest = light_between(lowest, high);
    float light = max(visible_light + (reached < high_slope ? rest : 0.0), 0.0);
    float specular = 0.0;
    if (HAS_SPECULAR) {
        float of_rest = reached < high_slope ? specular_between(lowest, high) : 0.0;
        specular = phong_power * (visible_specular + of_rest);
    }
    if (ORDER > 0 && is_lit && reached < high_slope) {
        add_to_parts(lowest, high);
    }
    return alive ? vec2(light, specular) : vec2(0.0);
}

void main() {
    ivec2 at = first + ivec2(gl_GlobalInvocationID.xy);
    bool exists = at.x < land.cols && at.y < land.rows;
    ivec2 here = min(at, ivec2(land.cols, land.rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    vec2 cells_to = vec2(base - here) + offset;
    vec2 flat_m = vec2(cells_to.x * land.cell_x_m, -cells_to.y * land.cell_y_m);
    float up = up_m - own.x;
    float away = length(flat_m);
    float distance_m = length(vec2(away, up));
    tangent2 = (distance_m - radius_m) * (distance_m + radius_m);
    vec2 towards = away > 0.0 ? flat_m / away : vec2(1.0, 0.0);
    // No part of the sphere is above the grid point's own plane.
    float plane_m = up - own.y * flat_m.x - own.z * flat_m.y;
    bool faces = plane_m + radius_m * sqrt(1.0 + own.y * own.y + own.z * own.z) > 0.0;
    bool alive = exists && faces && distance_m <= reach_m;
    bool around = away <= radius_m;
    float sine_widest = min(radius_m / max(away, 1e-30), 1.0);
    float widest = arc_tangent(vec4(sine_widest / sqrt(max((1.0 - sine_widest) * (1.0 + sine_widest), 1e-20)))).x;
    // Slightly less, so that rounding decides nothing at widths that divide the circle.
    int wide = max(int(ceil(float(slices_around) * widest / PI - 0.001)), slices);
    int count = around ? slices_around : wide;
    vec3 mirror = vec3(0.0);
    float of_scale = scale;
    if (HAS_SPECULAR) {
        phong_n = exponent;
        if (SPECULAR_IS_MAP) {
            vec2 of = texelFetch(phong_map, here, 0).xy;
            phong_n = of.x;
            of_scale = of.y;
        }
        vec4 z = vec4(inversesqrt(1.0 + own.y * own.y + own.z * own.z));
        vec2 place = vec2(here.x, land.rows - 1 - here.y) * vec2(land.cell_x_m, land.cell_y_m);
        Mirrored about = mirrored(-own.y * z, -own.z * z, z, vec4(place.x), vec4(place.y), vec4(own.x), eye_m);
        mirror = vec3(about.east.x, about.north.x, about.up.x);
    }
    vec2 light = vec2(0.0);
    float series[36];
    if (ORDER > 0) {
        // Zero past the last coefficient.
        for (int k = 0; k < 36; k++) {
            series[k] = 0.0;
        }
    }
    for (int i = first_slice; i < last_slice; i++) {
        bool has_slice = alive && i < count;
        if (!subgroupAny(has_slice)) {
            break;
        }
        // From -1 to 1. Even spacing all around, else spaced so that the disc's width is smooth.
        // The middle is exactly 0 despite inexact division.
        float off_middle = (2.0 * float(i) + 1.0) / float(count) - 1.0;
        float centre = 2 * i + 1 == count ? 0.0 : off_middle;
        float u = HALF_PI * centre;
        float spaced = 0.5 * widest * sine(u);
        float half_turn = around ? u : spaced;
        float weight_around = 2.0 * PI / float(count);
        // Narrow discs are cos u wide: midpoints sum cos² exactly, except that a single one counts it twice.
        float alone = count > 1 ? 1.0 : 0.5;
        float weight_ahead = alone * widest * cosine(u) * PI / float(count);
        float weight = around ? weight_around : weight_ahead;
        vec2 half_way = vec2(cosine(half_turn), sine(half_turn));
        vec2 turn = turned(half_way, half_way);
        vec2 e = turned(towards, turn);
        vec2 slice = slice_light(here, own, mirror, turn, e, away, up, has_slice);
        light += has_slice ? weight * slice : vec2(0.0);
        if (ORDER > 0 && has_slice) {
            vec4 weights = weight * part_harmonics(e);
            for (int k = 0; k < COUNT; k++) {
                series[k] += dot(weights, harmonics[k]);
            }
        }
    }
    if (exists) {
        vec4 before = imageLoad(sphere_sum, at);
        bool begins = radiance.w > 0.0;
        vec4 sum = vec4(begins ? vec3(0.0) : before.rgb, 1.0);
        imageStore(sphere_sum, at, sum + vec4(radiance.rgb * (light.x / PI), 0.0));
        if (HAS_SPECULAR) {
            vec4 already = imageLoad(specular_sum, at);
            vec4 more = vec4(radiance.rgb * (of_scale * light.y), 0.0);
            vec4 together = already + more;
            imageStore(specular_sum, at, specular_begins > 0.0 ? more : together);
        }
        if (ORDER > 0) {
            for (int i = 0; i < FOURS; i++) {
                vec4 four = vec4(series[4 * i], series[4 * i + 1], series[4 * i + 2], series[4 * i + 3]);
                for (int c = 0; c < CHANNELS; c++) {
                    ivec3 layer = ivec3(at, c * FOURS + i);
                    vec4 already = imageLoad(arriving, layer);
                    vec4 more = radiance[c] * four;
                    vec4 together = already + more;
                    imageStore(arriving, layer, specular_begins > 0.0 ? more : together);
                }
            }
        }
    }
}
