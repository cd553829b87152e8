// Computes: for each grid point, the direction on a curved base surface of what is visible in each direction of the
// flat field (Heidrich et al. 2000, §5).
// Reads: visible_points, ground, directions (east, north, up), fans.
// Writes: bent (direction in the grid point's own frame; w: 1 surface, 0 sky, -1 ground beyond the field).
// One invocation is one grid point and one direction.
//
// Visible sky has no distance. Where a neighbouring direction of the triangulation hits the surface, the sky
// direction moves with the nearest hit, which keeps the silhouette between the two. Other sky directions stay.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"
#include "bake/bend.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// Two directions per word.
layout(constant_id = 1) const bool SMALL = false;
// Search range for the hit on a repeating field, in cells along the faster axis of the direction.
layout(constant_id = 2) const int REACH = 16384;

// Slightly more than half a cell: the hit lies within this distance of its nearest grid point.
const float HALF_SIDE = 0.51;
// Relative tolerance of the hit test: 128 roundings.
const float GRAZE = 7.62939453125e-6;
// Larger than every distance, m.
const float FAR = 1e18;

layout(binding = 0) uniform utexture2DArray visible_points;
layout(binding = 1) uniform texture2D ground;
layout(binding = 2) uniform textureBuffer directions;
// Per direction: first triangle, triangle count, and the solid angle they cover. Per triangle: its two other corners,
// counter-clockwise.
layout(binding = 3) uniform textureBuffer fans;
layout(binding = 4, rgba32f) uniform writeonly image2DArray bent;

layout(push_constant) uniform BentDirectionsPush {
    int cols;
    int rows;
    int first_texel;      // of the directions
    int first_fan;        // texel of the first direction's
    int first_direction;  // of this dispatch
    float cell_x_m;
    float cell_y_m;
    float curvature_x;
    float curvature_y;
};

uint point_towards(int i, ivec2 at) {
    return point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
}

// Rise from a grid point to its neighbours in the east, south, west and north, then south-east and north-west.
struct Around {
    vec4 sides;
    vec2 corners;
};

Around around(ivec2 there) {
    ivec2 size = ivec2(cols, rows);
    ivec2 next = ivec2(there.x + 1 == size.x ? 0 : there.x + 1, there.y + 1 == size.y ? 0 : there.y + 1);
    ivec2 last = ivec2(there.x == 0 ? size.x - 1 : there.x - 1, there.y == 0 ? size.y - 1 : there.y - 1);
    float own = texelFetch(ground, there, 0).x;
    vec4 sides = vec4(texelFetch(ground, ivec2(next.x, there.y), 0).x, texelFetch(ground, ivec2(there.x, next.y), 0).x,
                      texelFetch(ground, ivec2(last.x, there.y), 0).x, texelFetch(ground, ivec2(there.x, last.y), 0).x);
    vec2 corners = vec2(texelFetch(ground, next, 0).x, texelFetch(ground, last, 0).x);
    return Around(sides - own, corners - own);
}

// Height of the surface above the grid point, `u` columns east and `v` rows south within a cell: six triangles meet
// there.
float risen(Around by, vec2 at) {
    vec2 off = abs(at);
    float along = at.x >= 0.0 ? by.sides.x : by.sides.z;
    float down = at.y >= 0.0 ? by.sides.y : by.sides.w;
    float corner = at.x >= 0.0 ? by.corners.x : by.corners.y;
    float both = (at.x >= 0.0) == (at.y >= 0.0) ? min(off.x, off.y) : 0.0;
    return both * corner + (off.x - both) * along + (off.y - both) * down;
}

// A ray past a grid point: columns and rows from the grid point at closest approach and per cell of the faster axis;
// cells before that; rise per cell; height of the ray start over the grid point, m.
struct Ray {
    vec2 start;
    vec2 advance;
    float cells;
    float climb;
    float rise;
};

// Height over the surface u cells further on, m.
float over_at(Ray ray, Around by, float u) {
    return (ray.cells + u) * ray.climb - ray.rise - risen(by, ray.start + u * ray.advance);
}

// Zero crossing of `at`, cells.
float kink(float at, float pace, float from, float to) {
    return pace == 0.0 ? to : clamp(-at / pace, from, max(from, to));
}

// Horizontal distance along e to the grid point `there` (columns, rows), m.
float away_to(vec2 gaps, vec3 e) {
    return max(dot(gaps * vec2(cell_x_m, -cell_y_m), e.xy), 0.0) / dot(e.xy, e.xy);
}

// Distance along e to the hit, whose nearest grid point is `there` (columns, rows). The hit lies within half a cell
// of it in plan, except on a steep wall, so the moved direction has an error of at most half a cell's turn at any
// slope. On a repeating field, the first copy whose surface e touches within half a cell: that copy is hit first. FAR
// where the base has turned by a right angle before the hit.
float away_of(ivec2 here, ivec2 there, float own, vec3 e) {
    ivec2 off = there - here;
    if (dot(e.xy, e.xy) < 1e-12) {
        return 0.0;
    }
    if (BORDER != BORDER_PERIODIC) {
        return away_to(vec2(off), e);
    }
    float rise = texelFetch(ground, there, 0).x - own;
    vec2 pace = e.xy / vec2(cell_x_m, -cell_y_m);  // columns and rows per metre
    bool by_rows = abs(pace.y) > abs(pace.x);
    ivec2 size = by_rows ? ivec2(rows, cols) : ivec2(cols, rows);
    ivec2 gap = by_rows ? off.yx : off;
    float main_pace = max(abs(pace.x), abs(pace.y));
    vec2 advance = pace / main_pace;  // columns and rows per cell of the faster axis
    float aside = by_rows ? advance.x : advance.y;
    float climb = e.z / main_pace;
    bool up = (by_rows ? pace.y : pace.x) > 0.0;
    int first = up ? (gap.x < 0 ? gap.x + size.x : gap.x) : (gap.x > 0 ? size.x - gap.x : -gap.x);
    // Where the ray is level with the surface around the grid point; one more cell for half a square and roundings.
    Around by = around(there);
    float low = min(min(min(by.sides.x, by.sides.y), min(by.sides.z, by.sides.w)), min(min(by.corners.x, by.corners.y), 0.0));
    float high = max(max(max(by.sides.x, by.sides.y), max(by.sides.z, by.sides.w)), max(max(by.corners.x, by.corners.y), 0.0));
    float level = abs(climb) < 1e-30 ? (climb < 0.0 ? -1e-30 : 1e-30) : climb;
    vec2 between = vec2(rise + low, rise + high) / level;
    float turned = MOST_TURN / max(length(vec2(curvature_x, curvature_y) * e.xy), 1e-30) * main_pace;
    vec3 cells = vec3(min(between.x, between.y) - 1.0, max(between.x, between.y) + 1.0, turned + 1.0);
    ivec3 turns = max(ivec3(floor((clamp(cells, vec3(-2.0), vec3(REACH)) - float(first)) / float(size.x))), ivec3(0));
    bool cut = turns.y > turns.z;
    float relief = max(high, -low);
    float found = away_to(vec2(off), e);
    float least = 1e38;
    bool met = false;
    for (int k = turns.x; k <= min(turns.y, turns.z) && !met; k++) {
        int main_gap = first + k * size.x;
        float n = float(main_gap);
        // Within the width of a column or row, a ray moves sideways by at most one. Only on fields two grid points
        // wide or less does it cross two.
        float ways = (n * aside - float(gap.y)) / float(size.y);
        float turn = size.y > 2 ? floor(ways + 0.5) : floor(ways) + (aside < 0.0 ? 1.0 : 0.0);
        for (int j = 0; j < (size.y > 2 ? 1 : 2) && !met; j++) {
            float other = float(gap.y) + (turn + float(aside < 0.0 ? -j : j)) * float(size.y);
            float beside = n * aside - other;
            // Where it crosses the square, in cells from the closest approach.
            vec2 sides = (vec2(-HALF_SIDE, HALF_SIDE) - beside) / (aside == 0.0 ? 1e-30 : aside);
            float from = max(max(-HALF_SIDE, -n), min(sides.x, sides.y));
            float to = min(HALF_SIDE, max(sides.x, sides.y));
            vec2 start = by_rows ? vec2(beside, 0.0) : vec2(0.0, beside);
            Ray ray = Ray(start, advance, n, climb, rise);
            // Linear between grid lines and the diagonal. Unrolled: llvmpipe ends all loops of an invocation together
            // after 65,535 iterations, and the two enclosing loops take up to 3 REACH.
            float last = over_at(ray, by, to);
            float least_at = min(last, over_at(ray, by, from));
            least_at = min(least_at, over_at(ray, by, kink(start.x, advance.x, from, to)));
            least_at = min(least_at, over_at(ray, by, kink(start.y, advance.y, from, to)));
            least_at = min(least_at, over_at(ray, by, kink(start.x - start.y, advance.x - advance.y, from, to)));
            // The ray starts on the grid point's own surface.
            float over = main_gap == 0 && other == 0.0 ? last : least_at;
            bool passes = from <= to;
            float graze = GRAZE * (abs(rise) + relief * (1.0 + 2.0 * n));
            met = passes && over <= graze;
            if (met || (passes && over < least)) {
                vec2 gaps = vec2(up ? n : -n, other);
                found = away_to(by_rows ? gaps.yx : gaps, e);
                least = over;
            }
        }
    }
    return !met && cut ? FAR : found;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int i = first_direction + int(gl_WorkGroupID.z);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    vec3 e = texelFetch(directions, first_texel + i).xyz;
    float own = texelFetch(ground, at, 0).x;
    uint met = point_towards(i, at);
    uint by = met;   // the direction to move with
    int as = i;
    if (met == POINT_SKY) {
        vec4 fan = texelFetch(fans, first_fan + i);
        float nearest = -2.0;
        for (int k = 0; k < int(fan.y); k++) {
            vec4 pair = texelFetch(fans, int(fan.x) + k);
            for (int corner = 0; corner < 2; corner++) {
                int j = int(pair[corner]);
                uint other = point_towards(j, at);
                float near = dot(texelFetch(directions, first_texel + j).xyz, e);
                bool is_nearer = other < POINT_LOST && near > nearest;
                nearest = is_nearer ? near : nearest;
                by = is_nearer ? other : by;
                as = is_nearer ? j : as;
            }
        }
    }
    vec3 to = e;
    if (by < POINT_LOST) {
        vec3 with = texelFetch(directions, first_texel + as).xyz;
        float away = away_of(at, ivec2(by & 0xffffu, by >> 16), own, with);
        to = bent_direction(e, away, own, vec2(curvature_x, curvature_y));
    }
    float what = met == POINT_SKY ? 0.0 : (met < POINT_LOST ? 1.0 : -1.0);
    imageStore(bent, ivec3(at, i), vec4(to, what));
}
