// First hit of a ray on the triangulated surface. Needs bindings cells and maxima, constants BORDER, THIN_ROWS,
// THIN_COLS, MOST_STEPS, and push constants land, highest_m before it.
//
// The hit lies before the first crossing (see walk.glsl) at which the surface is not below the ray. The start is
// excluded: only crossings at t > 0 count. If the surface rises faster than the ray within the very first triangle,
// the hit is at t = 0.

#include "rays/walk.glsl"

const uint RAY_FREE = 0u;     // left the field, or rose above all of it, or reached its end
const uint RAY_HIT = 1u;
const uint RAY_GROUND = 2u;   // left level or falling, where the ground continues level and black
const uint RAY_LOST = 3u;     // exceeded the step limit

struct Met {
    uint what;
    float t;       // of the hit
    ivec2 cell;    // the cell, wrapped into the field
    vec2 offset;   // position in it
    bool lower;    // in its southern triangle
};

// First hit of a ray before t_end.
Met trace(Ray ray, float t_end, bool going) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    Walk walk = walk_from(ray);
    // From here on a rising ray is above everything.
    float t_over = ray.rise > 0.0 ? max(highest_m - ray.own, 0.0) / ray.rise : 1e30;
    t_end = min(t_end, t_over);
    if (BORDER == BORDER_PERIODIC) {
        t_end = min(t_end, REACH_CELLS);
    }
    bool hit = false;
    going = going && !walk.leaves && t_end > 0.0;
    float t_next = 0.0;
    for (int turn = 0; turn < MOST_STEPS; turn++) {
        Block block = block_of(walk, ray);
        float ahead = block.ahead;
        // Clamped: finished lanes keep fetching.
        ivec2 fetched = clamp(walk.at, ivec2(0), cells_of - 1);
        vec4 corners = imageLoad(cells, fetched);
        int shown = max(walk.level, 1);
        float top = imageLoad(maxima, (fetched >> (LEVEL_BITS * shown)) + ivec2(0, level_top(shown, land.padded_rows))).x - ray.own;
        // The cell: its diagonal and its far edge.
        vec2 from = ray.offset + vec2(ray.base - walk.cell);
        vec2 exit = clamp(from + ahead * ray.advance, 0.0, 1.0);
        float over_exit = ahead * ray.rise - cell_rise(corners, ray.own, exit);
        float apart = ray.advance.x - ray.advance.y;
        float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
        float share = clamp(from.x + t_split * ray.advance.x, 0.0, 1.0);
        float over_split = t_split * ray.rise - ((corners.x - ray.own) + share * (corners.w - corners.x));
        bool in_split = t_split > walk.t && t_split < ahead && over_split <= 0.0;
        bool blocked = in_split || (ahead > walk.t && over_exit <= 0.0);
        bool clear = walk.level == 0 ? !blocked : min(walk.t * ray.rise, ahead * ray.rise) > top;
        bool hits = going && walk.level == 0 && blocked;
        hit = hit || hits;
        t_next = going ? ahead : t_next;
        going = going && !hits;
        walk_on(walk, ray, block, going, clear, land.top_level);
        going = going && !walk.leaves && walk.t < t_end;
        // Tested last, as llvmpipe completes an iteration.
        if (!going) {
            break;
        }
    }
    float t = walk.t;
    Met met;
    met.t = t;
    met.cell = clamp(walk.at, ivec2(0), cells_of - 1);
    // Position in its cell: the surface is linear before and behind the diagonal.
    vec4 corners = imageLoad(cells, met.cell);
    vec2 from = ray.offset + vec2(ray.base - walk.cell);
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
    // At the start the ray is on the surface, despite rounding.
    over_a = t_a == 0.0 ? 0.0 : max(over_a, 0.0);
    float s = over_a / max(over_a - over_b, 1e-30);
    met.t = t_a + clamp(s, 0.0, 1.0) * (t_b - t_a);
    met.offset = clamp(from + met.t * ray.advance, 0.0, 1.0);
    vec2 between = from + 0.5 * (t_a + t_b) * ray.advance;
    met.lower = between.y > between.x;
    bool below = BORDER == BORDER_PLANE && walk.leaves && ray.rise <= 0.0;
    // On a repeating field, a ray without a hit within its reach rises free or sinks into the ground.
    bool sinks = BORDER == BORDER_PERIODIC && ray.rise <= 0.0 && t_end >= REACH_CELLS;
    met.what = going ? RAY_LOST : (hit ? RAY_HIT : (below || sinks ? RAY_GROUND : RAY_FREE));
    return met;
}
