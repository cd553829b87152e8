// Rays over the triangulated surface. Needs bindings cells and maxima, constants BORDER, THIN_ROWS, THIN_COLS,
// MOST_STEPS, and push constants cells_x, cells_y, padded_rows, top_level, highest_m before it.
//
// A ray starts at a place on the surface: cell `base` (counted past the edge in neither direction),
// `offset` in it (0 .. 1 towards east and south), height `own`. Everything is counted from there, so a
// short ray keeps its digits however large the field. Positions along the ray are t, in cells of the
// axis along which it runs faster. The surface along the ray is linear between its crossings with
// columns, rows and diagonals, so it is hit before the first of them at which it does not stand below the ray.
// The start itself never counts: only crossings at t > 0 are looked at. Where the surface already rises
// faster than the ray in the very first triangle, the hit lies at t = 0: the ground right there.

#include "shared/bounds.glsl"

const uint RAY_FREE = 0u;     // left the field, or rose above all of it, or came to its end
const uint RAY_HIT = 1u;
const uint RAY_GROUND = 2u;   // left level or falling, where the ground goes on level and black
const uint RAY_LOST = 3u;     // took more steps than there can be
// A ray over a field that repeats is given up after this many cells. What goes on so long is within
// relief / REACH_CELLS of horizontal; what falls there counts as ground.
const float REACH_CELLS = 16384.0;

struct Ray {
    ivec2 base;
    vec2 offset;
    float own;
    vec2 advance;  // cells a unit of t, towards east and south; the larger is 1 or -1
    float rise;    // height a unit of t
    float scale;   // t a metre
};

struct Met {
    uint what;
    float t;       // where it was hit
    ivec2 cell;    // the cell, wrapped into the field
    vec2 offset;   // the place in it
    bool lower;    // in its southern triangle
};

Ray ray_from(ivec2 base, vec2 offset, float own, vec3 e, vec2 cell_m) {
    vec2 direction = vec2(e.x, -e.y) / cell_m;
    // Steeper than this, a ray is over all heights before it has left its first cell: 1e-9 m a metre.
    float along = max(max(abs(direction.x), abs(direction.y)), 1e-9 / max(cell_m.x, cell_m.y));
    vec2 advance = direction / along;
    // What moves by less than this never leaves its column.
    advance = mix(advance, vec2(0.0), lessThan(abs(advance), vec2(1e-20)));
    return Ray(base, offset, own, advance, e.z / along, along);
}

// Height over `own` at a place (u, v) of a cell with these corners.
float cell_rise(vec4 corners, float own, vec2 at) {
    float north = (corners.x - own) + at.x * (corners.y - corners.x) + at.y * (corners.w - corners.y);
    float south = (corners.x - own) + at.y * (corners.z - corners.x) + at.x * (corners.w - corners.z);
    return at.y <= at.x ? north : south;
}

// What a ray meets before t_end.
Met trace(Ray ray, float t_end, bool going) {
    ivec2 cells_of = ivec2(cells_x, cells_y);
    bvec2 onward = greaterThanEqual(ray.advance, vec2(0.0));
    bvec2 along_line = equal(ray.advance, vec2(0.0));
    vec2 inverse = mix(1.0 / ray.advance, vec2(1e30), along_line);
    // On a grid line a ray belongs to the cell that it runs into; along the last line, to the last cell.
    ivec2 cell = ray.base;
    cell.x -= ray.offset.x == 0.0 && !onward.x ? 1 : 0;
    cell.y -= ray.offset.y == 0.0 && !onward.y ? 1 : 0;
    ivec2 at = cell;
    bool leaves = false;
    if (BORDER == BORDER_PERIODIC) {
        at.x += at.x < 0 ? cells_of.x : 0;
        at.y += at.y < 0 ? cells_of.y : 0;
    } else {
        at.x -= ray.advance.x == 0.0 && at.x == cells_of.x ? 1 : 0;
        at.y -= ray.advance.y == 0.0 && at.y == cells_of.y ? 1 : 0;
        cell = at;
        leaves = (THIN_ROWS && ray.advance.y != 0.0) || (THIN_COLS && ray.advance.x != 0.0)
              || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, cells_of));
    }
    // From here on a rising ray is over everything.
    float t_over = ray.rise > 0.0 ? max(highest_m - ray.own, 0.0) / ray.rise : 1e30;
    t_end = min(t_end, t_over);
    if (BORDER == BORDER_PERIODIC) {
        t_end = min(t_end, REACH_CELLS);
    }
    bool hit = false;
    going = going && !leaves && t_end > 0.0;
    float t = 0.0;
    float t_next = 0.0;
    int level = 0;
    for (int turn = 0; turn < MOST_STEPS; turn++) {
        int bits = LEVEL_BITS * level;
        ivec2 low = (at >> bits) << bits;
        ivec2 high = min(low + (1 << bits), cells_of);
        ivec2 seen = BORDER == BORDER_PERIODIC ? at - cell : ivec2(0);
        ivec2 edge = ivec2(onward.x ? high.x : low.x, onward.y ? high.y : low.y) - seen - ray.base;
        // Along a grid line the edges beside it are never reached, not even where it is one of them.
        vec2 to_edge = mix((vec2(edge) - ray.offset) * inverse, vec2(1e30), along_line);
        float ahead = max(min(to_edge.x, to_edge.y), t);
        // Held inside: lanes that are done go on fetching.
        ivec2 fetched = clamp(at, ivec2(0), cells_of - 1);
        vec4 corners = texelFetch(cells, fetched, 0);
        int shown = max(level, 1);
        float top = texelFetch(maxima, (fetched >> (LEVEL_BITS * shown)) + ivec2(0, level_top(shown, padded_rows)), 0).x - ray.own;
        // The cell: its diagonal and its far edge.
        vec2 from = ray.offset + vec2(ray.base - cell);
        vec2 exit = clamp(from + ahead * ray.advance, 0.0, 1.0);
        float over_exit = ahead * ray.rise - cell_rise(corners, ray.own, exit);
        float apart = ray.advance.x - ray.advance.y;
        float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
        float share = clamp(from.x + t_split * ray.advance.x, 0.0, 1.0);
        float over_split = t_split * ray.rise - ((corners.x - ray.own) + share * (corners.w - corners.x));
        bool in_split = t_split > t && t_split < ahead && over_split <= 0.0;
        bool blocked = in_split || (ahead > t && over_exit <= 0.0);
        bool clear = level == 0 ? !blocked : min(t * ray.rise, ahead * ray.rise) > top;
        hit = going && level == 0 && blocked ? true : hit;
        t_next = going ? ahead : t_next;
        going = going && !(level == 0 && blocked);
        // On to the next block of the level: exactly across the edge, and never back along the other axis.
        bool by_x = to_edge.x <= to_edge.y;
        ivec2 other = ivec2(floor(ray.offset + ahead * ray.advance)) + ray.base;
        other = clamp(other, low - seen, high - 1 - seen);
        other = ivec2(onward.x ? max(other.x, cell.x) : min(other.x, cell.x), onward.y ? max(other.y, cell.y) : min(other.y, cell.y));
        ivec2 across = ivec2(onward.x ? high.x : low.x - 1, onward.y ? high.y : low.y - 1) - seen;
        ivec2 onto = ivec2(by_x ? across.x : other.x, by_x ? other.y : across.y);
        bool moves = going && clear;
        ivec2 next = moves ? onto : cell;
        ivec2 at_next = BORDER == BORDER_PERIODIC ? at + (next - cell) : next;
        if (BORDER == BORDER_PERIODIC) {
            at_next.x += at_next.x < 0 ? cells_of.x : (at_next.x >= cells_of.x ? -cells_of.x : 0);
            at_next.y += at_next.y < 0 ? cells_of.y : (at_next.y >= cells_of.y ? -cells_of.y : 0);
        }
        ivec2 changed = (at ^ at_next) >> (bits + LEVEL_BITS);
        level = going ? (clear ? min(level + (changed.x != 0 || changed.y != 0 ? 1 : 0), top_level) : level - 1) : level;
        t = moves ? ahead : t;
        bool out_now = BORDER != BORDER_PERIODIC && (any(lessThan(at_next, ivec2(0))) || any(greaterThanEqual(at_next, cells_of)));
        leaves = leaves || (moves && out_now);
        cell = next;
        at = at_next;
        going = going && !out_now && t < t_end;
        // Left by all lanes together, as in horizon_sweep; asked last, as llvmpipe runs a turn to its end.
        if (!subgroupAny(going)) {
            break;
        }
    }
    Met met;
    met.t = t;
    met.cell = clamp(at, ivec2(0), cells_of - 1);
    // Where in its cell: the surface is linear before and behind the diagonal.
    vec4 corners = texelFetch(cells, met.cell, 0);
    vec2 from = ray.offset + vec2(ray.base - cell);
    float apart = ray.advance.x - ray.advance.y;
    float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
    bool split = t_split > t && t_split < t_next;
    float t_middle = split ? t_split : t_next;
    vec2 at_start = clamp(from + t * ray.advance, 0.0, 1.0);
    vec2 at_middle = clamp(from + t_middle * ray.advance, 0.0, 1.0);
    vec2 at_end = clamp(from + t_next * ray.advance, 0.0, 1.0);
    float over_middle = t_middle * ray.rise - (split ? (corners.x - ray.own) + at_middle.x * (corners.w - corners.x)
                                                     : cell_rise(corners, ray.own, at_middle));
    bool first = over_middle <= 0.0;
    float t_a = first ? t : t_middle;
    float t_b = first ? t_middle : t_next;
    float over_a = first ? t * ray.rise - cell_rise(corners, ray.own, at_start) : over_middle;
    float over_b = first ? over_middle : t_next * ray.rise - cell_rise(corners, ray.own, at_end);
    // At the start the ray is on the surface, whatever rounding says.
    over_a = t_a == 0.0 ? 0.0 : max(over_a, 0.0);
    float s = over_a / max(over_a - over_b, 1e-30);
    met.t = t_a + clamp(s, 0.0, 1.0) * (t_b - t_a);
    met.offset = clamp(from + met.t * ray.advance, 0.0, 1.0);
    vec2 between = from + 0.5 * (t_a + t_b) * ray.advance;
    met.lower = between.y > between.x;
    bool below = BORDER == BORDER_PLANE && leaves && ray.rise <= 0.0;
    // A ray that repetitions have not met within its reach rises free or sinks into the ground.
    bool sinks = BORDER == BORDER_PERIODIC && ray.rise <= 0.0 && t_end >= REACH_CELLS;
    met.what = going ? RAY_LOST : (hit ? RAY_HIT : (below || sinks ? RAY_GROUND : RAY_FREE));
    return met;
}
