#extension GL_EXT_control_flow_attributes : require
#include "shared/half.glsl"
#include "shared/nodes.glsl"
#include "horizon/met.glsl"
#include "horizon/crossings.glsl"

// Resamples the lattice of a sweep at the field's grid points, four at a time. The including shader declares
// `lane_heights`, `lattice`, `lattice_words` and the constants FUSE, LATTICE, LATTICE_HAS_DISTANCES,
// LATTICE_STRIDE, LINE_SHIFT, BORDER, MARCHES_ROWS, LANE_STRIDE and READS_LANE_WINDOWS.
//
// `mix` selects between two expressions, here and in included files. `c ? a + b : a - b` is a branch, and
// SwiftShader's compiler follows every path through a loop: each branch doubles them.

const uint FUSE_DIRECT = 0u;   // the lattice holds one value per grid point or node
const uint FUSE_NEAREST = 1u;  // the slope of the nearer line
const uint FUSE_SLOPES = 2u;   // both lines' slopes, interpolated
const uint FUSE_OWN = 3u;      // both lines' occluders from the grid point's own height, interpolated
const uint FUSE_AIMED_NEAREST = 4u;  // the surface on the grid point's own line at the distance of the nearer
                                     // line's occluder; and the first crossings of its own line
const uint FUSE_AIMED = 5u;          // the same with both lines' occluders, the higher one

const uint FUSE_AIMED_AROUND = 6u;   // the same, and every crossing beside the nearer line's occluder

const uint FUSE_CROSSINGS = 7u;      // no lattice: first crossings only

const uint LATTICE_OCCLUDERS = 0u;
const uint LATTICE_SLOPES_F32 = 1u;
const uint LATTICE_SLOPES_F16 = 2u;

// Lines a cell apart pass four neighbouring grid points at the same distance and lie in two texels.
const bool LINES_FOLLOW_LANES = LINE_SHIFT == CELL_SHIFT && BORDER != BORDER_PERIODIC && LANE_STRIDE == 1;

// A texel of four u16 or f16; or of one or four f32, whose images have other formats.
uvec4 lattice_at(ivec3 texel) {
    return LATTICE == LATTICE_SLOPES_F32 ? texelFetch(lattice_words, texel, 0) : imageLoad(lattice, texel);
}

// Lattice values of four lines at a step (occluders: steps back).
uvec4 lattice_values(Azimuth azimuth, ivec4 line, int step) {
    uvec4 values;
    for (int k = 0; k < 4; k++) {
        values[k] = lattice_value(lattice_at(lattice_texel(azimuth, line[k], step)), line[k]);
    }
    return values;
}

// Lattice values of the four lines from `lowest` on, at a step. A line next to `first` .. `last` gets the value of the
// nearest of these. Values of lines farther out are arbitrary.
uvec4 four_lines(Azimuth azimuth, int lowest, int first, int last, int lines, int step) {
    int from = min(lowest, last);
    int texel = from >> 2;
    uvec4 a = lattice_at(lattice_texel(azimuth, max(texel, 0) << 2, step));
    uvec4 b = lattice_at(lattice_texel(azimuth, min(texel + 1, (lines - 1) >> 2) << 2, step));
    bvec4 by_two = bvec4((from & 2) != 0);
    bool is_odd = (from & 1) != 0;
    uvec4 four = mix(a, uvec4(a.zw, b.xy), by_two);
    uvec2 beyond = mix(b.xy, b.zw, by_two.xy);
    four = mix(four, uvec4(four.yzw, beyond.x), bvec4(is_odd));
    uint next = mix(beyond.x, beyond.y, is_odd);
    ivec4 line = lowest + ivec4(0, 1, 2, 3);
    uvec4 inside = mix(four, uvec4(four.yzw, next), lessThan(line, ivec4(first)));
    return mix(inside, four.xxyz, greaterThan(line, ivec4(last)));
}

// Values of a lattice of slopes. A value that f16 clamped is "none", too.
vec4 slopes_of(uvec4 values) {
    vec4 slope = uintBitsToFloat(values);
    if (LATTICE == LATTICE_SLOPES_F16) {
        slope = f16_from_bits(values);
    }
    return mix(slope, vec4(NO_SLOPE), lessThanEqual(slope, vec4(-65504.0)));
}

// The higher of `met` and, where `counts`, the point that lies `u` of the way from height `a` to height `b`, `steps` steps ahead.
// Slopes are rises per step.
Met higher_where(vec4 own, bvec4 counts, Met met, vec4 a, vec4 b, vec4 u, vec4 steps) {
    vec4 slope = ((a - own) + u * (b - a)) / steps;
    bvec4 takes = bvec4(uvec4(counts) & uvec4(greaterThan(slope, met.slope)));
    return Met(mix(met.slope, slope, takes), mix(met.steps, steps, takes));
}

// How far raise_beside has come.
struct Beside {
    ivec4 y;      // place across the lanes, at the step before
    ivec4 cell;   // of y
    mat4 near;    // near[i][k]: height of lane cell[k] - 1 + i there, for grid point k
    Met found;    // rises per step
};

// One step of raise_beside, to `back` steps ahead; none past `last`.
void step_beside(Azimuth azimuth, Quad q, ivec4 back, ivec4 last, int lanes, int steps, bool diagonals_along, inout Beside beside) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bvec4 along = bvec4(diagonals_along);
    int step = march_position(azimuth, q.march, steps);
    float advance = float(azimuth.shear) * (1.0 / float(CELL));
    float per_lane = 1.0 / max(advance, 1e-9);
    float per_split_across = 1.0 / (1.0 + advance);
    float per_split = diagonals_along ? 1.0 / max(1.0 - advance, 1e-9) : per_split_across;
    vec4 own = q.here.four;
    // With shear 0 a line stays in its lane and leaves no side of the field.
    int edge = wraps || azimuth.shear == 0 ? -0x7fffffff : 0;
    int lowest_on = wraps ? -0x7fffffff : 0;

    bvec4 exists = bvec4(uvec4(lessThanEqual(back, last)) & uvec4(greaterThan(beside.y, ivec4(edge))));
    beside.y -= azimuth.shear;
    // A line whose far end is off the field leaves at lane 0, the lane line that it crosses. That crossing, and those before it, count.
    bvec4 is_on = bvec4(uvec4(exists) & uvec4(greaterThanEqual(beside.y, ivec4(lowest_on))));
    ivec4 cell = beside.y >> CELL_SHIFT;
    mat4 far;
    for (int k = 0; k < 4; k++) {
        far[k] = row_at(azimuth, cell[k] - 1, step - back[k], lanes, steps);
    }
    far = transpose(far);
    bvec4 same_cell = equal(cell, beside.cell);
    vec4 near_low = mix(beside.near[0], beside.near[1], same_cell);
    vec4 near_high = mix(beside.near[1], beside.near[2], same_cell);

    // As in segment_crossings: `from` and `end` are places across the cell of the step's far end.
    vec4 from = vec4(beside.y & (CELL - 1)) * (1.0 / float(CELL));
    vec4 end = from + advance;
    bvec4 passes_lane = greaterThan(end, vec4(1.0 + HAIR));
    vec4 to_lane = (1.0 - from) * per_lane;
    beside.found = higher_where(own, is_on, beside.found, far[1], far[2], from, vec4(back));
    // With diagonals from (0, 0) to (1, 1), a line crosses either the diagonal inside the cell or the lane line. With
    // diagonals from (1, 0) to (0, 1) it always crosses one; if it also crosses the lane line, the next diagonal may follow.
    bvec4 is_lane = bvec4(uvec4(along) & uvec4(passes_lane));
    bvec4 is_inside = bvec4(uvec4(greaterThan(from, vec4(0.0))) & uvec4(lessThan(end, vec4(1.0 - HAIR))));
    bvec4 crosses = mix(greaterThan(end, vec4(0.0)), bvec4(uvec4(is_inside) | uvec4(passes_lane)), along);
    crosses = bvec4(uvec4(crosses) & uvec4(mix(is_on, exists, is_lane)));
    vec4 u = mix(mix(1.0 - from, from, along) * per_split, to_lane, is_lane);
    vec4 far_end = mix(far[2], far[1], bvec4(uvec4(along) & uvec4(not(is_lane))));
    beside.found = higher_where(own, crosses, beside.found, far_end, mix(near_low, near_high, along), u, vec4(back) - u);
    bvec4 crosses_more = bvec4(uvec4(exists) & uvec4(passes_lane) & uvec4(not(along)));
    beside.found = higher_where(own, crosses_more, beside.found, far[2], near_high, to_lane, vec4(back) - to_lane);
    vec4 to_next = (2.0 - from) * per_split_across;
    beside.found = higher_where(own, crosses_more, beside.found, far[3], near_high, to_next, vec4(back) - to_next);
    beside.near = far;
    beside.cell = cell;
}

// Raises `met` to the highest crossing of each grid point's own line with grid lines and diagonals beside the nearer line's
// proposal, `nearer` steps ahead: a step to either side, and one more towards the other line's. Ridges that unit steps miss
// lie there. `reach` steps lie ahead. The crossings are those of look_around, for four grid points at once: change both.
void raise_beside(Azimuth azimuth, Quad q, ivec4 nearer, ivec4 other, int reach, int lanes, int steps, bool diagonals_along, inout Met met) {
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    ivec4 lane = mix(q.lane, lanes - 1 - q.lane, bvec4(flips_lanes));
    int step = march_position(azimuth, q.march, steps);
    ivec4 at = mix(other, nearer, greaterThan(nearer, ivec4(0)));
    ivec4 towards = mix(ivec4(0), sign(other - at), greaterThan(other, ivec4(0)));
    ivec4 first = max(at + min(towards, 0), 1);
    ivec4 last = mix(ivec4(0), min(at + 1 + max(towards, 0), reach), greaterThan(at, ivec4(0)));
    Beside beside;
    beside.y = lane * CELL - (first - 1) * azimuth.shear;
    beside.cell = beside.y >> CELL_SHIFT;
    for (int k = 0; k < 4; k++) {
        beside.near[k] = row_at(azimuth, beside.cell[k] - 1, step - first[k] + 1, lanes, steps);
    }
    beside.near = transpose(beside.near);
    beside.found = Met(vec4(NO_SLOPE), vec4(0.0));
    if (READS_LANE_WINDOWS) {
        // llvmpipe keeps what a loop changes in memory.
        [[unroll]] for (int i = 0; i < 3; i++) {
            step_beside(azimuth, q, first + i, last, lanes, steps, diagonals_along, beside);
        }
    } else {
        // If the loop is unrolled, RADV uses more registers: with specular, occupancy falls by a third.
        [[dont_unroll]] for (int i = 0; i < 3; i++) {
            step_beside(azimuth, q, first + i, last, lanes, steps, diagonals_along, beside);
        }
    }
    Met found = beside.found;
    // Where nothing is crossed there is no slope, whatever the step.
    bvec4 crosses_any = greaterThan(found.slope, vec4(LOWEST_MET));
    found.slope = mix(vec4(NO_SLOPE), found.slope * (1.0 / azimuth.step_m), crosses_any);
    met = higher(met, found);
}

// Four grid points in the lattice of an azimuth.
struct Place {
    int step;           // warm-up included
    int first;          // of the lines on the field at that step; none where `last` lies before `first`
    int last;
    int lines;          // of the lattice
    ivec4 from_origin;  // lane positions, from that of line 0
};

Place place_of(Azimuth azimuth, Quad q, int lanes, int steps, int warm_up) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    ivec4 lane = mix(q.lane, lanes - 1 - q.lane, bvec4(flips_lanes));
    int spacing = 1 << LINE_SHIFT;
    int total = warm_up + steps;
    int lead = lattice_lead(azimuth.shear, total, LINE_SHIFT, wraps);
    int step = warm_up + march_position(azimuth, q.march, steps);
    int origin = step * azimuth.shear - lead * spacing;
    int first = (spacing - 1 - origin) >> LINE_SHIFT;
    int last = ((lanes - 1) * CELL - origin) >> LINE_SHIFT;
    return Place(step, first, last, lattice_lines(lanes, lead, LINE_SHIFT, wraps), lane * CELL - origin);
}

// Lattice values of the lines around four grid points: before each (or through it), and after it. Arbitrary where there
// is no line.
struct Around {
    uvec4 before;
    uvec4 after;
    bvec4 has_before;
    bvec4 has_after;
};

Around lines_around(Azimuth azimuth, Place at) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    ivec4 before = at.from_origin >> LINE_SHIFT;
    ivec4 offset = at.from_origin & ((1 << LINE_SHIFT) - 1);
    Around around;
    around.has_before = wraps ? bvec4(true) : greaterThanEqual(before, ivec4(at.first));
    around.has_after = wraps ? bvec4(true) : lessThan(before, ivec4(at.last));
    around.has_after = bvec4(uvec4(around.has_after) & uvec4(greaterThan(offset, ivec4(0))));
    if (LINES_FOLLOW_LANES) {
        // Five lines in two texels.
        int lowest = mix(before.x, before.w, flips_lanes);
        int texel = lowest >> 2;
        int last_texel = (at.lines - 1) >> 2;
        uvec4 a = lattice_at(lattice_texel(azimuth, clamp(texel, 0, last_texel) << 2, at.step));
        uvec4 b = lattice_at(lattice_texel(azimuth, clamp(texel + 1, 0, last_texel) << 2, at.step));
        bvec4 by_two = bvec4((lowest & 2) != 0);
        bvec4 is_odd = bvec4((lowest & 1) != 0);
        uvec4 even = mix(a, uvec4(a.zw, b.xy), by_two);
        uvec2 beyond = mix(b.xy, b.zw, by_two.xy);
        uvec4 odd = uvec4(even.yzw, beyond.x);
        uvec4 low = mix(even, odd, is_odd);
        uvec4 high = mix(odd, uvec4(even.zw, beyond), is_odd);
        around.before = mix(low, low.wzyx, bvec4(flips_lanes));
        around.after = mix(high, high.wzyx, bvec4(flips_lanes));
        return around;
    }
    // GLSL's clamp is undefined if the lower bound exceeds the upper.
    int first = at.first;
    int last = max(first, at.last);
    ivec4 before_line = wraps ? ivec4(wrapped(before.x, at.lines), wrapped(before.y, at.lines),
                                      wrapped(before.z, at.lines), wrapped(before.w, at.lines))
                              : clamp(before, first, last);
    ivec4 after_line = wraps ? mix(before_line + 1, ivec4(0), equal(before_line, ivec4(at.lines - 1)))
                             : clamp(before + 1, first, last);
    around.before = lattice_values(azimuth, before_line, at.step);
    around.after = lattice_values(azimuth, after_line, at.step);
    return around;
}

// Slopes of the horizons of four grid points and their distance in march steps. Slopes above `enough` need not be
// exact.
Met fused(Azimuth azimuth, Quad q, int lanes, int steps, int warm_up, vec4 enough, bool diagonals_along) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    Met met;
    if (FUSE == FUSE_DIRECT) {
        int step = march_position(azimuth, q.march, steps);
        ivec4 lane = mix(q.lane, lanes - 1 - q.lane, bvec4(flips_lanes));
        for (int k = 0; k < 4; k++) {
            ivec3 texel = ivec3(clamp(lane[k], 0, lanes - 1), step, azimuth.layer);
            if (LATTICE_STRIDE > 1) {
                texel.xy = ivec2(node_of(q.lane[k], LATTICE_STRIDE), node_of(q.march, LATTICE_STRIDE));
            }
            met.slope[k] = uintBitsToFloat(lattice_at(texel).x);
            texel.z++;
            met.steps[k] = LATTICE_HAS_DISTANCES ? uintBitsToFloat(lattice_at(texel).x) : 0.0;
        }
        return met;
    }
    if (FUSE == FUSE_CROSSINGS) {
        return first_crossings(azimuth, q, lanes, steps);
    }
    Place at = place_of(azimuth, q, lanes, steps, warm_up);
    int spacing = 1 << LINE_SHIFT;

    if (FUSE == FUSE_NEAREST || FUSE == FUSE_AIMED_NEAREST) {
        // The nearer one; on a tie, the one before.
        ivec4 line = (at.from_origin + (spacing / 2 - 1)) >> LINE_SHIFT;
        bool takes = wraps || at.first <= at.last;
        int first = at.first;
        int last = max(first, at.last);
        int lowest = mix(line.x, line.w, flips_lanes);
        uvec4 values;
        if (LINES_FOLLOW_LANES) {
            uvec4 four = four_lines(azimuth, lowest, first, last, at.lines, at.step);
            values = mix(four, four.wzyx, bvec4(flips_lanes));
        } else if (wraps) {
            line = ivec4(wrapped(line.x, at.lines), wrapped(line.y, at.lines), wrapped(line.z, at.lines), wrapped(line.w, at.lines));
            values = lattice_values(azimuth, line, at.step);
        } else {
            line = clamp(line, first, last);
            values = lattice_values(azimuth, line, at.step);
        }
        if (FUSE == FUSE_NEAREST) {
            return Met(mix(vec4(NO_SLOPE), slopes_of(values), bvec4(takes)), vec4(0.0));
        }
        // A proposal one step back is the first crossing itself.
        uvec4 back = mix(uvec4(0), values, greaterThan(values, uvec4(1)));
        back = mix(uvec4(0), back, bvec4(takes));
        met = first_crossings(azimuth, q, lanes, steps);
        return higher(met, surface_at(azimuth, q, q.lane * CELL, back, lanes, steps));
    }
    Around lines = lines_around(azimuth, at);
    ivec4 offset = at.from_origin & (spacing - 1);
    uvec4 before_back = mix(uvec4(0), lines.before, lines.has_before);
    uvec4 after_back = mix(uvec4(0), lines.after, lines.has_after);
    if (FUSE == FUSE_AIMED || FUSE == FUSE_AIMED_AROUND) {
        ivec4 y = q.lane * CELL;
        met = first_crossings(azimuth, q, lanes, steps);
        if (FUSE == FUSE_AIMED) {
            uvec4 before_far = mix(uvec4(0), before_back, greaterThan(before_back, uvec4(1)));
            uvec4 after_far = mix(uvec4(0), after_back, greaterThan(after_back, uvec4(1)));
            met = higher(met, surface_at(azimuth, q, y, before_far, lanes, steps));
            return higher(met, surface_at(azimuth, q, y, after_far, lanes, steps));
        }
        bvec4 is_past_half = greaterThan(offset, ivec4(spacing / 2));
        bvec4 takes_after = bvec4(uvec4(lines.has_after) & (uvec4(is_past_half) | uvec4(not(lines.has_before))));
        uvec4 nearer = mix(before_back, after_back, takes_after);
        uvec4 other = mix(after_back, before_back, takes_after);
        uvec4 other_far = mix(uvec4(0), other, greaterThan(other, uvec4(1)));
        met = higher(met, surface_at(azimuth, q, y, other_far, lanes, steps));
        // `raise_beside` also tests the step of the nearer line's occluder.
        // On llvmpipe the branch saves nothing.
        if (READS_LANE_WINDOWS || any(lessThan(met.slope, enough))) {
            raise_beside(azimuth, q, ivec4(nearer), ivec4(other), at.step, lanes, steps, diagonals_along, met);
        }
        return met;
    }
    Met b;
    Met a;
    if (FUSE == FUSE_OWN) {
        ivec4 y = q.lane * CELL;
        b = surface_at(azimuth, q, y + mix(-offset, offset, bvec4(flips_lanes)), before_back, lanes, steps);
        a = surface_at(azimuth, q, y + mix(spacing - offset, offset - spacing, bvec4(flips_lanes)), after_back, lanes, steps);
    } else {
        b = Met(mix(vec4(NO_SLOPE), slopes_of(lines.before), lines.has_before), vec4(0.0));
        a = Met(mix(vec4(NO_SLOPE), slopes_of(lines.after), lines.has_after), vec4(0.0));
    }
    // Where only one line has an occluder, use it alone.
    bvec4 both = greaterThan(min(a.slope, b.slope), vec4(LOWEST_MET));
    vec4 t = vec4(offset) * (1.0 / float(spacing));
    bvec4 nearer_after = greaterThan(t, vec4(0.5));
    Met one = higher(a, b);
    return Met(mix(one.slope, mix(b.slope, a.slope, t), both),
               mix(one.steps, mix(b.steps, a.steps, nearer_after), both));
}
