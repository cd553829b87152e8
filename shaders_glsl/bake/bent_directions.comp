// Computes: the direction in which each sample sees, on a curved base, what it sees in each direction of the flat field
// (Heidrich et al. 2000, §5).
// Reads: visible_points, ground, directions (east, north, up), fans. Writes: bent (direction in the sample's own frame; 1
// where the surface is seen, 0 the sky, -1 the ground beyond the field).
// One invocation is one sample and one direction.
//
// What is seen of the sky has no distance. A direction with a neighbour in the net that meets the surface moves as the
// nearest of them would, so that the silhouette between the two keeps its place between them; the others stay.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"
#include "bake/bend.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint BORDER = 0u;
// Two directions in a word.
layout(constant_id = 1) const bool SMALL = false;
// How far what a repeating field shows is looked for, cells of the axis along which the direction runs faster.
layout(constant_id = 2) const int REACH = 16384;

// A little more than half a cell, within which a sample is what is met.
const float HALF_SIDE = 0.51;
// By this share of what is compared over the surface, a ray still meets it: 128 roundings.
const float GRAZE = 7.62939453125e-6;
// Beyond all ways, m.
const float FAR = 1e18;

layout(binding = 0) uniform utexture2DArray visible_points;
layout(binding = 1) uniform texture2D ground;
layout(binding = 2) uniform textureBuffer directions;
// Of each direction where its triangles begin, how many they are, and the solid angle that they cover; of a triangle the two
// other corners, counter-clockwise.
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

uint seen(int i, ivec2 at) {
    return point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
}

// Rises from a sample to its neighbours in the east, south, west and north, then in the south-east and north-west.
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

// The surface over the sample, so many columns east and rows south of it, within a cell: of six triangles around it.
float risen(Around by, vec2 at) {
    vec2 off = abs(at);
    float along = at.x >= 0.0 ? by.sides.x : by.sides.z;
    float down = at.y >= 0.0 ? by.sides.y : by.sides.w;
    float corner = at.x >= 0.0 ? by.corners.x : by.corners.y;
    float both = (at.x >= 0.0) == (at.y >= 0.0) ? min(off.x, off.y) : 0.0;
    return both * corner + (off.x - both) * along + (off.y - both) * down;
}

// A ray past a sample: columns and rows from the sample where it is beside it, and of a cell along its faster axis; cells before
// that; what it rises a cell, and the sample over its start, m.
struct Ray {
    vec2 start;
    vec2 advance;
    float cells;
    float climb;
    float rise;
};

// How far it is over the surface u cells beyond, m.
float over_at(Ray ray, Around by, float u) {
    return (ray.cells + u) * ray.climb - ray.rise - risen(by, ray.start + u * ray.advance);
}

// Where what is `at` there comes to 0, cells.
float kink(float at, float pace, float from, float to) {
    return pace == 0.0 ? to : clamp(-at / pace, from, to);
}

// As far in the plan as the sample `there`, so many columns and rows off, stands along e.
float away_to(vec2 gaps, vec3 e) {
    return max(dot(gaps * vec2(cell_x_m, -cell_y_m), e.xy), 0.0) / dot(e.xy, e.xy);
}

// How far along e what is met lies, as far in the plan as the sample `there`, which stands within half a cell of it in the plan
// but on a steep wall far above or below: what moves with the base is off by half a cell's turn, whatever the slope. Of a field
// that repeats, the first of its like whose surface e touches, within half a cell of the sample: what is met is met there
// first. FAR where the base has turned by a right angle before.
float away_of(ivec2 here, ivec2 there, float own, vec3 e) {
    ivec2 off = there - here;
    if (dot(e.xy, e.xy) < 1e-12) {
        return 0.0;
    }
    if (BORDER != BORDER_PERIODIC) {
        return away_to(vec2(off), e);
    }
    float rise = texelFetch(ground, there, 0).x - own;
    vec2 pace = e.xy / vec2(cell_x_m, -cell_y_m);  // columns and rows a metre
    bool by_rows = abs(pace.y) > abs(pace.x);
    ivec2 size = by_rows ? ivec2(rows, cols) : ivec2(cols, rows);
    ivec2 gap = by_rows ? off.yx : off;
    float main_pace = max(abs(pace.x), abs(pace.y));
    vec2 advance = pace / main_pace;  // columns and rows a cell of the faster axis
    float aside = by_rows ? advance.x : advance.y;
    float climb = e.z / main_pace;
    bool up = (by_rows ? pace.y : pace.x) > 0.0;
    int first = up ? (gap.x < 0 ? gap.x + size.x : gap.x) : (gap.x > 0 ? size.x - gap.x : -gap.x);
    // Where the ray is level with the surface around the sample; a cell for half a square and roundings.
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
        // Within a column's or row's width a ray moves aside by one at most: only of lines two samples wide or less it passes two.
        float ways = (n * aside - float(gap.y)) / float(size.y);
        float turn = size.y > 2 ? floor(ways + 0.5) : floor(ways) + (aside < 0.0 ? 1.0 : 0.0);
        for (int j = 0; j < (size.y > 2 ? 1 : 2) && !met; j++) {
            float other = float(gap.y) + (turn + float(aside < 0.0 ? -j : j)) * float(size.y);
            float beside = n * aside - other;
            // Where it passes the square, cells from where it is beside the sample.
            vec2 sides = (vec2(-HALF_SIDE, HALF_SIDE) - beside) / (aside == 0.0 ? 1e-30 : aside);
            float from = max(max(-HALF_SIDE, -n), min(sides.x, sides.y));
            float to = min(HALF_SIDE, max(sides.x, sides.y));
            vec2 start = by_rows ? vec2(beside, 0.0) : vec2(0.0, beside);
            Ray ray = Ray(start, advance, n, climb, rise);
            // Linear between grid lines and the diagonal. No loop: llvmpipe ends all loops of an invocation together after 65,535
            // turns, and the two around it have up to 3 REACH.
            float last = over_at(ray, by, to);
            float least_at = min(last, over_at(ray, by, from));
            least_at = min(least_at, over_at(ray, by, kink(start.x, advance.x, from, to)));
            least_at = min(least_at, over_at(ray, by, kink(start.y, advance.y, from, to)));
            least_at = min(least_at, over_at(ray, by, kink(start.x - start.y, advance.x - advance.y, from, to)));
            // A sample's own surface is left where the ray begins.
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
    uint met = seen(i, at);
    uint by = met;   // what it moves with
    int as = i;
    if (met == SEES_SKY) {
        vec4 fan = texelFetch(fans, first_fan + i);
        float nearest = -2.0;
        for (int k = 0; k < int(fan.y); k++) {
            vec4 pair = texelFetch(fans, int(fan.x) + k);
            for (int corner = 0; corner < 2; corner++) {
                int j = int(pair[corner]);
                uint other = seen(j, at);
                float near = dot(texelFetch(directions, first_texel + j).xyz, e);
                bool is_nearer = other < SEES_LOST && near > nearest;
                nearest = is_nearer ? near : nearest;
                by = is_nearer ? other : by;
                as = is_nearer ? j : as;
            }
        }
    }
    vec3 to = e;
    if (by < SEES_LOST) {
        vec3 with = texelFetch(directions, first_texel + as).xyz;
        float away = away_of(at, ivec2(by & 0xffffu, by >> 16), own, with);
        to = bent_direction(e, away, own, vec2(curvature_x, curvature_y));
    }
    float what = met == SEES_SKY ? 0.0 : (met < SEES_LOST ? 1.0 : -1.0);
    imageStore(bent, ivec3(at, i), vec4(to, what));
}
