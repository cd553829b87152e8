#include "shared/sweep.glsl"

// Four grid points side by side along the lane axis, and the slopes of the surface there. Lanes and march positions are
// the field's own here, not flipped, so that all azimuths of an axis share them. The including shader declares the
// constants BORDER and MARCHES_ROWS.

// One march position: the four lanes, and those beside each.
struct Strip {
    vec4 below;
    vec4 four;
    vec4 above;
};

struct Quad {
    ivec4 lane;  // those beyond the last lane are not on the field
    int march;
    Strip before;  // clamped at the edges of the field where it does not repeat, as are the lanes
    Strip here;
    Strip after;
};

// Column and row of a lane at a march position.
ivec2 texel_at(int lane, int march) {
    return MARCHES_ROWS ? ivec2(lane, march) : ivec2(march, lane);
}

// Index of a neighbour along one axis: wrapped where the field repeats, else clamped.
int neighbour(int i, int n) {
    return BORDER == BORDER_PERIODIC ? wrapped(i, n) : clamp(i, 0, n - 1);
}

// Slopes of the surface towards east and north: the mean over the adjoining quads, which is the direction of the sum
// of their unnormalised normals. Where a field is one grid point wide there is no quad across it, and the slope
// across is 0.
void quad_slopes(Quad q, int lanes, int steps, vec2 cell_m, out vec4 east, out vec4 north) {
    bool wraps = BORDER == BORDER_PERIODIC;
    // Number of quads to each side: 0 or 1. Across an axis without any, the one line of grid points stands for them.
    float before = steps > 1 && (wraps || q.march > 0) ? 1.0 : 0.0;
    float after = steps > 1 && (wraps || q.march < steps - 1) ? 1.0 : 0.0;
    float marches = before + after;
    vec3 march_weight = marches > 0.0 ? vec3(before, marches, after) / (2.0 * marches) : vec3(0.0, 1.0, 0.0);
    ivec4 lane = q.lane;
    vec4 below = vec4(lanes > 1 && wraps ? bvec4(true) : greaterThan(lane, ivec4(0)));
    vec4 above = vec4(lanes > 1 && wraps ? bvec4(true) : lessThan(lane, ivec4(lanes - 1)));
    vec4 sides = below + above;
    vec4 side_weight = 0.5 / max(sides, vec4(1.0));
    vec4 middle_weight = mix(vec4(1.0), vec4(0.5), greaterThan(sides, vec4(0.0)));

    vec4 across = march_weight.x * (q.before.above - q.before.below) +
                  march_weight.y * (q.here.above - q.here.below) +
                  march_weight.z * (q.after.above - q.after.below);
    vec4 along = below * side_weight * (q.after.below - q.before.below) +
                 middle_weight * (q.after.four - q.before.four) +
                 above * side_weight * (q.after.above - q.before.above);
    vec2 cell = MARCHES_ROWS ? cell_m : cell_m.yx;  // lane, march
    across = across / (max(sides, vec4(1.0)) * cell.x) * vec4(greaterThan(sides, vec4(0.0)));
    along = along / (max(marches, 1.0) * cell.y);
    // Rows count southwards.
    east = MARCHES_ROWS ? across : along;
    north = MARCHES_ROWS ? -along : -across;
}
