#include "shared/sweep.glsl"

// Four grid points side by side along the lane axis, and the grid points around them. Lanes and march positions are
// the field's own here, not flipped, so that all azimuths of an axis share them. Where LANE_STRIDE is not 1 they are
// nodes, that many lanes apart. The including shader declares `lane_heights` and the constants LANE_STRIDE, BORDER
// and MARCHES_ROWS.

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

// Heights are loaded four lanes at a time, as an image rather than a texture: llvmpipe (Mesa 22.3)
// calls a function to fetch from a texture, but loads from an image in place.
float height_at(int lane, int march) {
    vec4 four = imageLoad(lane_heights, ivec2(lane >> 2, march));
    vec2 two = mix(four.xy, four.zw, bvec2((lane & 2) != 0));
    return mix(two.x, two.y, (lane & 1) != 0);
}

// Heights of two lanes. With READS_LANE_BUFFER they are two loads of 4 bytes instead of two texels of 16.
vec2 two_heights_at(int lane, int next, int march, int lanes) {
#ifdef LANE_BUFFER
    if (READS_LANE_BUFFER) {
        int row = march * ((lanes + 3) & ~3);
        return vec2(lane_buffer[row + lane], lane_buffer[row + next]);
    }
#endif
    return vec2(height_at(lane, march), height_at(next, march));
}

// Index of a neighbour along one axis: wrapped where the field repeats, else clamped.
int neighbour(int i, int n) {
    return BORDER == BORDER_PERIODIC ? wrapped(i, n) : clamp(i, 0, n - 1);
}

Strip strip_at(int lane, int march, int lanes) {
    Strip s;
    if (LANE_STRIDE > 1) {
        for (int k = 0; k < 4; k++) {
            int own = min(lane + k * LANE_STRIDE, lanes - 1);
            s.below[k] = height_at(neighbour(own - 1, lanes), march);
            s.four[k] = height_at(own, march);
            s.above[k] = height_at(neighbour(own + 1, lanes), march);
        }
        return s;
    }
    s.four = imageLoad(lane_heights, ivec2(lane >> 2, march));
    s.below = vec4(height_at(neighbour(lane - 1, lanes), march), s.four.xyz);
    s.above = vec4(s.four.yzw, height_at(neighbour(lane + 4, lanes), march));
    return s;
}

Quad quad_at(int lane, int march, int lanes, int steps) {
    Quad q;
    ivec4 apart = ivec4(lane, lane + LANE_STRIDE, lane + 2 * LANE_STRIDE, lane + 3 * LANE_STRIDE);
    ivec4 nodes = min(apart, lanes - 1);
    ivec4 side_by_side = lane + ivec4(0, 1, 2, 3);
    q.lane = LANE_STRIDE > 1 ? nodes : side_by_side;
    q.march = march;
    q.before = strip_at(lane, neighbour(march - 1, steps), lanes);
    q.here = strip_at(lane, march, lanes);
    q.after = strip_at(lane, neighbour(march + 1, steps), lanes);
    return q;
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
