// Traversal of the field's cells by a ray, with block skipping. Needs constants BORDER, THIN_ROWS, THIN_COLS and push
// constants `land` before it.
//
// A ray starts at a point of the surface: cell `base` (within the field), `offset` in it (0 .. 1 towards east and
// south), height `own`. Coordinates are relative to the start, so short rays stay exact however large the field.
// Positions along the ray are t, in cells of its faster axis. Along the ray the surface is linear between crossings
// with columns, rows and diagonals.

#include "rays/bounds.glsl"

// A ray over a repeating field stops after this many cells. Its direction is then within relief / REACH_CELLS of
// horizontal; a falling one counts as hitting the ground.
const float REACH_CELLS = 16384.0;

struct Ray {
    ivec2 base;
    vec2 offset;
    float own;
    vec2 advance;  // cells per unit of t, towards east and south; the larger is 1 or -1
    float rise;    // height per unit of t
    float scale;   // t per metre
};

Ray ray_from(ivec2 base, vec2 offset, float own, vec3 e, vec2 cell_m) {
    vec2 direction = vec2(e.x, -e.y) / cell_m;
    // A steeper ray is above all heights before it leaves its first cell: 1e-9 m per metre.
    float along = max(max(abs(direction.x), abs(direction.y)), 1e-9 / max(cell_m.x, cell_m.y));
    vec2 advance = direction / along;
    // Vulkan allows f32 division an error of 2.5 ULP; here the quotient must be exactly 1 or -1.
    advance = mix(advance, sign(direction), equal(abs(direction), vec2(along)));
    // A ray that moves by less than this never leaves its column.
    advance = mix(advance, vec2(0.0), lessThan(abs(advance), vec2(1e-20)));
    return Ray(base, offset, own, advance, e.z / along, along);
}

// Height over `own` at a position (u, v) of a cell with these corners.
float cell_rise(vec4 corners, float own, vec2 at) {
    float north = (corners.x - own) + at.x * (corners.y - corners.x) + at.y * (corners.w - corners.y);
    float south = (corners.x - own) + at.y * (corners.z - corners.x) + at.x * (corners.w - corners.z);
    return at.y <= at.x ? north : south;
}

// Traversal state.
struct Walk {
    ivec2 cell;   // not wrapped where the field repeats
    ivec2 at;     // wrapped into the field
    float t;      // where it entered the block
    int level;    // of the current block; 0 is the cell
    bool leaves;  // has left the field
};

// The current block.
struct Block {
    ivec2 low;
    ivec2 high;
    ivec2 wrap;    // offset of the field's repetition
    float ahead;   // t at which the ray leaves it
    bool by_x;     // across an edge to the east or west
};

Walk walk_from(Ray ray) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    bvec2 onward = greaterThanEqual(ray.advance, vec2(0.0));
    // On a grid line a ray belongs to the cell that it enters; along the last line, to the last cell.
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
    return Walk(cell, at, 0.0, 0, leaves);
}

Block block_of(Walk walk, Ray ray) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    bvec2 onward = greaterThanEqual(ray.advance, vec2(0.0));
    bvec2 along_line = equal(ray.advance, vec2(0.0));
    vec2 inverse = mix(1.0 / ray.advance, vec2(1e30), along_line);
    int bits = LEVEL_BITS * walk.level;
    ivec2 low = (walk.at >> bits) << bits;
    ivec2 high = min(low + (1 << bits), cells_of);
    ivec2 wrap = BORDER == BORDER_PERIODIC ? walk.at - walk.cell : ivec2(0);
    ivec2 edge = ivec2(onward.x ? high.x : low.x, onward.y ? high.y : low.y) - wrap - ray.base;
    // Edges parallel to the ray are never reached, even where the ray runs along one.
    vec2 to_edge = mix((vec2(edge) - ray.offset) * inverse, vec2(1e30), along_line);
    float ahead = max(min(to_edge.x, to_edge.y), walk.t);
    return Block(low, high, wrap, ahead, to_edge.x <= to_edge.y);
}

// Steps to the next block of the level, exactly across the edge and never back along the other axis, if this one is
// `clear`. Goes to a coarser level on entering a coarser block, else to a finer one.
void walk_on(inout Walk walk, Ray ray, Block block, bool going, bool clear, int top_level) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    bvec2 onward = greaterThanEqual(ray.advance, vec2(0.0));
    int bits = LEVEL_BITS * walk.level;
    ivec2 low = block.low - block.wrap;
    ivec2 high = block.high - block.wrap;
    ivec2 other = ivec2(floor(ray.offset + block.ahead * ray.advance)) + ray.base;
    other = clamp(other, low, max(low, high - 1));
    other = ivec2(onward.x ? max(other.x, walk.cell.x) : min(other.x, walk.cell.x),
                  onward.y ? max(other.y, walk.cell.y) : min(other.y, walk.cell.y));
    ivec2 across = ivec2(onward.x ? high.x : low.x - 1, onward.y ? high.y : low.y - 1);
    ivec2 onto = ivec2(block.by_x ? across.x : other.x, block.by_x ? other.y : across.y);
    bool moves = going && clear;
    ivec2 next = moves ? onto : walk.cell;
    ivec2 at_next = BORDER == BORDER_PERIODIC ? walk.at + (next - walk.cell) : next;
    if (BORDER == BORDER_PERIODIC) {
        at_next.x += at_next.x < 0 ? cells_of.x : (at_next.x >= cells_of.x ? -cells_of.x : 0);
        at_next.y += at_next.y < 0 ? cells_of.y : (at_next.y >= cells_of.y ? -cells_of.y : 0);
    }
    ivec2 changed = (walk.at ^ at_next) >> (bits + LEVEL_BITS);
    int coarser = min(walk.level + (changed.x != 0 || changed.y != 0 ? 1 : 0), top_level);
    int level = clear ? coarser : walk.level - 1;
    walk.level = going ? level : walk.level;
    walk.t = moves ? block.ahead : walk.t;
    bool out_now = BORDER != BORDER_PERIODIC && (any(lessThan(at_next, ivec2(0))) || any(greaterThanEqual(at_next, cells_of)));
    walk.leaves = walk.leaves || (moves && out_now);
    walk.cell = next;
    walk.at = at_next;
}
