// Computes: indirect light at every grid point, exact except for the azimuth count: along each azimuth the visible
// intervals of the surface, each with its cosine-weighted part of the slice in closed form and its radiance at the
// weighted mean distance. With specular also the same light as a series of spherical harmonics, and exit radiance by
// direction.
// Reads: cells, maxima, ground, exit_radiance or exit_vectors.
// Reads and writes: bounce_sum (exit radiance for albedo 1; divided by A, the sum for whole hemispheres, after the
// last azimuths), arriving (four coefficients per layer, channel after channel).
// One invocation is one grid point, or one node: bounce_sum has a texel for each.
#version 460

#include "shared/angle.glsl"
#include "shared/cosine.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// A field one grid point wide that does not repeat is a line: it gives no indirect light.
layout(constant_id = 1) const bool THIN_ROWS = false;
layout(constant_id = 2) const bool THIN_COLS = false;
// More steps than a ray of this field can take; llvmpipe ends all loops together after 65,535 iterations.
layout(constant_id = 3) const int MOST_STEPS = 60000;
// One channel of radiance.
layout(constant_id = 4) const bool GREY = false;
// Grid points from node to node: 1, 2, 4 or 8.
layout(constant_id = 5) const int NODE_STRIDE = 1;
// Order of the series of arriving light; 0 for none.
layout(constant_id = 6) const int ORDER = 0;
// Exit radiance by direction, as series of that order.
layout(constant_id = 7) const bool VECTORS = false;

layout(binding = 0, rgba32f) uniform readonly image2D cells;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform texture2D ground;
layout(binding = 3) uniform texture2D exit_radiance;
layout(binding = 4, rgba32f) uniform image2D bounce_sum;
layout(binding = 5) uniform texture2DArray exit_vectors;
layout(binding = 6, rgba32f) uniform image2DArray arriving;

#include "rays/land.glsl"

layout(push_constant) uniform BounceMarchPush {
    LandPush land;
    int azimuths;       // in the circle, at the middles of equal parts
    int first_azimuth;  // of this dispatch
    int last_azimuth;   // exclusive
    int first_row;      // of this dispatch, in nodes
};

#include "rays/walk.glsl"
#include "shared/nodes.glsl"

const int FOURS = (ORDER * ORDER + 3) / 4;
vec4 harmonics[36];
#include "shared/harmonics.glsl"
// SH series of the visibility above an elevation in this azimuth; all 0 between uses.
#define VALUE float
float series[36];
float turn[11];
#include "sh/visible.glsl"
#include "sh/turn.glsl"

// Calls a function for each layer of four coefficients. Unrolled: llvmpipe ends all loops together after 65,535 iterations.
#define EACH_FOUR(f) \
    if (FOURS > 0) { f(0); } \
    if (FOURS > 1) { f(1); } \
    if (FOURS > 2) { f(2); } \
    if (FOURS > 3) { f(3); } \
    if (FOURS > 4) { f(4); } \
    if (FOURS > 5) { f(5); } \
    if (FOURS > 6) { f(6); } \
    if (FOURS > 7) { f(7); } \
    if (FOURS > 8) { f(8); }

// The slice.
vec2 azimuth;
Facing facing;
// So far: the slope up to which the surface is visible, its indirect light, and the radiance of the last visible
// interval.
float reached;
vec3 indirect;
vec3 last_radiance;

// Arriving light so far.
vec4 arrived_red[9];
vec4 arrived_green[9];
vec4 arrived_blue[9];
ivec2 own_texel;

void load_arrived(int i) {
    arrived_red[i] = imageLoad(arriving, ivec3(own_texel, i));
    if (!GREY) {
        arrived_green[i] = imageLoad(arriving, ivec3(own_texel, FOURS + i));
        arrived_blue[i] = imageLoad(arriving, ivec3(own_texel, 2 * FOURS + i));
    }
}

void clear_arrived(int i) {
    arrived_red[i] = vec4(0.0);
    arrived_green[i] = vec4(0.0);
    arrived_blue[i] = vec4(0.0);
}

void store_arrived(int i) {
    imageStore(arriving, ivec3(own_texel, i), arrived_red[i]);
    if (!GREY) {
        imageStore(arriving, ivec3(own_texel, FOURS + i), arrived_green[i]);
        imageStore(arriving, ivec3(own_texel, 2 * FOURS + i), arrived_blue[i]);
    }
}

// Change of incident radiance.
vec3 change;

void add_change(int i) {
    vec4 four = vec4(series[4 * i], series[4 * i + 1], series[4 * i + 2], series[4 * i + 3]);
    arrived_red[i] += change.r * four;
    arrived_green[i] += change.g * four;
    arrived_blue[i] += change.b * four;
    series[4 * i] = 0.0;
    series[4 * i + 1] = 0.0;
    series[4 * i + 2] = 0.0;
    series[4 * i + 3] = 0.0;
}

// Changes incident radiance for all elevations above `reached`.
void add_arriving(vec3 more) {
    vec2 direction = direction_of(reached);
    add_slices(HALF_PI - arc_tangent(vec4(reached)).x, direction.y, direction.x);
    change = more;
    EACH_FOUR(add_change)
}

// Radiance of a cell's corners: north-west, north-east, south-west, south-east.
vec3 corners_of[4];
ivec2 corner_texels[4];

vec3 radiance_at(ivec2 at) {
    vec4 texel = texelFetch(exit_radiance, at, 0);
    return GREY ? texel.xxx : texel.rgb;
}

vec3 part_towards(ivec2 at, int i, vec4 y) {
    float red = dot(y, texelFetch(exit_vectors, ivec3(at, i), 0));
    vec3 light = vec3(red);
    if (!GREY) {
        light.g = dot(y, texelFetch(exit_vectors, ivec3(at, FOURS + i), 0));
        light.b = dot(y, texelFetch(exit_vectors, ivec3(at, 2 * FOURS + i), 0));
    }
    return light;
}

void add_towards(int i) {
    vec4 y = vec4(harmonics[4 * i].x, harmonics[4 * i + 1].x, harmonics[4 * i + 2].x, harmonics[4 * i + 3].x);
    corners_of[0] += part_towards(corner_texels[0], i, y);
    corners_of[1] += part_towards(corner_texels[1], i, y);
    corners_of[2] += part_towards(corner_texels[2], i, y);
    corners_of[3] += part_towards(corner_texels[3], i, y);
}

// Finds the corners' exit radiance towards the grid point; `direction` points from there to the surface, within the slice.
void find_corners(vec2 direction) {
    if (VECTORS) {
        vec3 e = vec3(azimuth * direction.x, direction.y);
        find_harmonics(vec4(-e.x), vec4(-e.y), vec4(-e.z));
        corners_of[0] = vec3(0.0);
        corners_of[1] = vec3(0.0);
        corners_of[2] = vec3(0.0);
        corners_of[3] = vec3(0.0);
        EACH_FOUR(add_towards)
    } else {
        corners_of[0] = radiance_at(corner_texels[0]);
        corners_of[1] = radiance_at(corner_texels[1]);
        corners_of[2] = radiance_at(corner_texels[2]);
        corners_of[3] = radiance_at(corner_texels[3]);
    }
}

// Linear on each of the cell's triangles.
vec3 radiance_within(vec2 at) {
    vec3 north = corners_of[0] + at.x * (corners_of[1] - corners_of[0]) + at.y * (corners_of[3] - corners_of[1]);
    vec3 south = corners_of[0] + at.y * (corners_of[2] - corners_of[0]) + at.x * (corners_of[3] - corners_of[2]);
    return at.y <= at.x ? north : south;
}

// Fraction of a surface piece, between two (distance, height), at which an elevation meets it.
float share_at(vec2 begin, vec2 end, vec2 direction) {
    float under = begin.y * direction.x - direction.y * begin.x;
    float over = end.y * direction.x - direction.y * end.x;
    return clamp(under / min(under - over, -1e-30), 0.0, 1.0);
}

// Adds a piece, if `on`: llvmpipe runs a branch for all lanes. It is the part from `reached` up to its end, if that is higher. `place` and `advance` give its start in the
// cell and its direction through it.
void add_piece(vec2 begin, vec2 end, vec2 place, vec2 advance, bool on) {
    float slope = end.y / max(end.x, 1e-30);
    bool rises = on && end.x > begin.x && slope > reached;
    vec2 low = direction_of(reached);
    vec2 high = direction_of(max(slope, reached));
    float weight = max(light_between(facing, low, high), 0.0);
    // Gauss' rule of two points over the interval's elevations: 1/sqrt(3) of the half width from the middle.
    vec2 middle = normalize(low + high);
    float beside = 0.5773502691896258 * half_width(low, high);
    vec2 turn = vec2(cosine(beside), sine(beside));
    vec2 before = vec2(middle.x * turn.x + middle.y * turn.y, middle.y * turn.x - middle.x * turn.y);
    vec2 after = vec2(middle.x * turn.x - middle.y * turn.y, middle.y * turn.x + middle.x * turn.y);
    float weight_before = max(facing_of(facing, before), 0.0) * before.x;
    float weight_after = max(facing_of(facing, after), 0.0) * after.x;
    float both = max(weight_before + weight_after, 1e-30);
    float share = (weight_before * share_at(begin, end, before) + weight_after * share_at(begin, end, after)) / both;
    if (VECTORS && rises) {
        find_corners(middle);
    }
    // Clamped at 0: rounding, and ringing of SH series, can make radiance negative.
    vec3 radiance = max(radiance_within(clamp(place + min(share, 1.0) * advance, 0.0, 1.0)), vec3(0.0));
    float counts = rises ? weight : 0.0;
    indirect += counts * radiance;
    if (ORDER > 0 && rises) {
        add_arriving(radiance - last_radiance);
    }
    last_radiance = rises ? radiance : last_radiance;
    reached = rises ? slope : reached;
}

// March over the surface as far as any of it may be visible.
void march(Ray ray, bool going) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    float highest = imageLoad(maxima, ivec2(0, level_top(land.top_level, land.padded_rows))).x - ray.own;
    float step_m = 1.0 / ray.scale;
    Walk walk = walk_from(ray);
    going = going && !walk.leaves;
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
        vec2 at_entry = clamp(from + walk.t * ray.advance, 0.0, 1.0);
        vec2 at_middle = clamp(from + t_middle * ray.advance, 0.0, 1.0);
        vec2 at_exit = clamp(from + block.ahead * ray.advance, 0.0, 1.0);
        vec2 entry = vec2(walk.t * step_m, cell_rise(corners, ray.own, at_entry));
        vec2 middle = vec2(t_middle * step_m, (corners.x - ray.own) + at_middle.x * (corners.w - corners.x));
        middle.y = is_split ? middle.y : entry.y;
        vec2 exit = vec2(block.ahead * step_m, cell_rise(corners, ray.own, at_exit));
        // Rounding must not lift the grid point off the surface.
        entry.y = walk.t > 0.0 ? entry.y : 0.0;
        middle.y = t_middle > 0.0 ? middle.y : 0.0;
        float middle_slope = middle.y / max(middle.x, 1e-30);
        float exit_slope = exit.y / max(exit.x, 1e-30);
        // In an unsplit cell the middle is the entry, whose slope has been added already.
        float split_slope = max(middle_slope, exit_slope);
        float steepest = is_split ? split_slope : exit_slope;
        bool opens = going && is_cell && block.ahead > walk.t && steepest > reached;
        if (opens) {
            ivec2 size = ivec2(land.cols, land.rows);
            ivec2 next = fetched + 1;
            next *= ivec2(lessThan(next, size));
            corner_texels[0] = fetched;
            corner_texels[1] = ivec2(next.x, fetched.y);
            corner_texels[2] = ivec2(fetched.x, next.y);
            corner_texels[3] = next;
            if (!VECTORS) {
                find_corners(vec2(1.0, 0.0));
            }
            add_piece(entry, middle, at_entry, at_middle - at_entry, opens);
            add_piece(middle, exit, at_middle, at_exit - at_middle, opens);
        }
        walk_on(walk, ray, block, going, clear, land.top_level);
        bool is_over = reached >= 0.0 && walk.t > 0.0 && walk.t * reached * step_m >= highest;
        going = going && !walk.leaves && !is_over && (BORDER != BORDER_PERIODIC || walk.t < REACH_CELLS);
    }
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    ivec2 nodes = ivec2(node_count(land.cols, NODE_STRIDE), node_count(land.rows, NODE_STRIDE));
    bool exists = at.x < nodes.x && at.y < nodes.y;
    ivec2 here = min(at * NODE_STRIDE, ivec2(land.cols, land.rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    float up = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    bool is_line = THIN_ROWS || THIN_COLS;
    vec4 before = imageLoad(bounce_sum, min(at, nodes - 1));
    vec4 sum = mix(vec4(0.0), before, bvec4(first_azimuth > 0));
    own_texel = min(at, nodes - 1);
    for (int i = 0; i < 36; i++) {
        // Zero past the last coefficient.
        harmonics[i] = vec4(0.0);
        series[i] = 0.0;
    }
    if (first_azimuth > 0) {
        EACH_FOUR(load_arrived)
    } else {
        EACH_FOUR(clear_arrived)
    }
    for (int k = first_azimuth; k < last_azimuth; k++) {
        // Half a turn counted from west, in halves: the sines' range.
        float half_turn = PI * ((float(k) + 0.5) / float(azimuths) - 0.5);
        vec2 half_direction = vec2(cosine(half_turn), sine(half_turn));
        vec2 e = -vec2(half_direction.x * half_direction.x - half_direction.y * half_direction.y,
                       2.0 * half_direction.x * half_direction.y);
        // Azimuths are multiples of 1/1024 of the circle or more: one this near to the grid lies on it, and along the
        // field's edge.
        e = mix(e, vec2(0.0), lessThan(abs(e), vec2(1e-5)));
        // Rise of the grid point's own tangent plane along the azimuth.
        float own_slope = own.y * e.x + own.z * e.y;
        azimuth = e;
        turn_to(2.0 * PI / float(azimuths), e);
        facing = Facing(-own_slope * up, up);
        reached = own_slope;
        indirect = vec3(0.0);
        last_radiance = vec3(0.0);
        march(ray_from(here, vec2(0.0), own.x, vec3(e, 0.0), vec2(land.cell_x_m, land.cell_y_m)), exists && !is_line);
        if (BORDER == BORDER_PERIODIC) {
            // A ray without a hit up to horizontal continues over the same terrain forever.
            float rest = max(light_between(facing, direction_of(min(reached, 0.0)), vec2(1.0, 0.0)), 0.0);
            indirect += rest * last_radiance;
            reached = max(reached, 0.0);
        }
        if (ORDER > 0) {
            add_arriving(-last_radiance);
        }
        sum += vec4(indirect, light_between(facing, direction_of(own_slope), vec2(0.0, 1.0)));
    }
    if (exists) {
        // Weights over a whole hemisphere sum to 1: uniform incident radiance is preserved.
        vec4 light = vec4(sum.rgb / max(sum.a, 1e-30), 1.0);
        bool is_whole = last_azimuth == azimuths;
        imageStore(bounce_sum, at, is_whole ? light : sum);
        EACH_FOUR(store_arrived)
    }
}
