#include "shared/lattice.glsl"
#include "shared/quad.glsl"

// What the own lines of four grid points meet. The including shader declares what quad.glsl needs.

// Horizons of four grid points: slopes, and march steps to them.
struct Met {
    vec4 slope;
    vec4 steps;
};

// The higher of two horizons.
Met higher(Met a, Met b) {
    bvec4 takes = greaterThan(b.slope, a.slope);
    return Met(mix(a.slope, b.slope, takes), mix(a.steps, b.steps, takes));
}

// Horizon of the own lines within their first step: the crossing with the next grid line, and with the cell's
// diagonal where that lies across. Nearly everything that unit steps miss lies here.
Met first_crossings(Azimuth azimuth, Quad q, int lanes, int steps) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    ivec4 lane = q.lane;
    bool is_before_last = q.march < steps - 1;
    bool is_after_first = q.march > 0;
    bool marches_on = flips_march ? is_before_last : is_after_first;
    bool has_ahead = wraps || marches_on;
    bvec4 has_above = lessThan(lane, ivec4(wraps ? lanes : lanes - 1));
    bvec4 has_below = greaterThan(lane, ivec4(wraps ? -1 : 0));
    bvec4 has_side = mix(has_below, has_above, bvec4(flips_lanes));
    vec4 own = q.here.four;
    vec4 side = mix(q.here.below, q.here.above, bvec4(flips_lanes));
    vec4 ahead = mix(q.before.four, q.after.four, bvec4(flips_march));
    vec4 ahead_above = mix(q.before.above, q.after.above, bvec4(flips_march));
    vec4 ahead_below = mix(q.before.below, q.after.below, bvec4(flips_march));
    vec4 ahead_side = mix(ahead_below, ahead_above, bvec4(flips_lanes));

    float shear = float(azimuth.shear) * (1.0 / float(CELL));
    float per_m = 1.0 / azimuth.step_m;
    Met next;
    next.slope = ((ahead - own) + shear * (ahead_side - ahead)) * per_m;
    next.steps = vec4(1.0);
    // (1, 0) to (0, 1) is crossed by (u, u * shear) at u = 1 / (1 + shear).
    float u = 1.0 / (1.0 + shear);
    Met split;
    split.slope = ((side - own) + u * (ahead - side)) * ((1.0 + shear) * per_m);
    split.steps = vec4(u);
    bool split_crosses = flips_march != flips_lanes;
    bvec4 none = bvec4(false);
    split.slope = mix(vec4(NO_SLOPE), split.slope, mix(none, has_side, bvec4(split_crosses)));
    Met found = higher(next, split);
    bvec4 inside = mix(bvec4(true), has_side, bvec4(azimuth.shear > 0));
    inside = mix(none, inside, bvec4(has_ahead));
    found.slope = mix(vec4(NO_SLOPE), found.slope, inside);
    return found;
}

// The surface at proposed distances, `back` steps ahead on lines through the lane positions `y` (not flipped),
// relative to the grid points. None where `back` is 0 or the line has left the field.
Met surface_at(Azimuth azimuth, Quad q, ivec4 y, uvec4 back, int lanes, int steps) {
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int shear = mix(-azimuth.shear, azimuth.shear, flips_lanes);
    ivec4 place = y + ivec4(back) * shear;
    bvec4 stands = notEqual(back, uvec4(0));
    if (BORDER != BORDER_PERIODIC) {
        bvec4 on_field = lessThanEqual(uvec4(place), uvec4((lanes - 1) * CELL));
        stands = bvec4(uvec4(stands) & uvec4(on_field));
        place = mix(y, place, stands);
    }
    ivec4 march = q.march + mix(-ivec4(back), ivec4(back), bvec4(flips_march));
    vec4 height;
    for (int k = 0; k < 4; k++) {
        int cell = place[k] >> CELL_SHIFT;
        int next = cell + 1;
        int m = march[k];
        vec2 two;
#ifdef LANE_BUFFER
        if (READS_LANE_BUFFER && BORDER != BORDER_PERIODIC) {
            // On the last lane the height after it has no weight.
            int row = (lanes + 3) & ~3;
            int at = LANE_BUFFER_PAD + clamp(m * row + cell, 0, steps * row - 1);
            two = vec2(lane_buffer[at], lane_buffer[at + 1]);
        } else
#endif
        if (BORDER == BORDER_PERIODIC) {
            cell = wrapped(cell, lanes);
            next = mix(cell + 1, 0, cell + 1 == lanes);
            m = wrapped(m, steps);
            two = two_heights_at(cell, next, m, lanes);
        } else {
            cell = clamp(cell, 0, lanes - 1);
            next = clamp(next, 0, lanes - 1);
            m = clamp(m, 0, steps - 1);
            two = two_heights_at(cell, next, m, lanes);
        }
        height[k] = two.x + float(place[k] & (CELL - 1)) * (1.0 / float(CELL)) * (two.y - two.x);
    }
    vec4 distance = vec4(max(back, uvec4(1)));
    vec4 slope = (height - q.here.four) * (1.0 / azimuth.step_m) / distance;
    return Met(mix(vec4(NO_SLOPE), slope, stands), distance);
}
