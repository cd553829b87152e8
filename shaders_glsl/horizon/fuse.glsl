#include "shared/lattice.glsl"
#include "shared/nodes.glsl"
#include "shared/quad.glsl"
#include "horizon/surface.glsl"

// Resamples the lattice of a sweep at the field's grid points, four at a time. The including shader declares
// `lane_heights`, `lattice`, `lattice_words` and the constants FUSE, LATTICE, LATTICE_HAS_DISTANCES, LATTICE_STRIDE,
// LINE_SHIFT, BORDER, MARCHES_ROWS and LANE_STRIDE.
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

const uint FUSE_AIMED_AROUND = 6u;   // the same, and every crossing within two steps of either occluder

const uint FUSE_CROSSINGS = 7u;      // no lattice: first crossings only

const uint LATTICE_OCCLUDERS = 0u;
const uint LATTICE_SLOPES_F32 = 1u;
const uint LATTICE_SLOPES_F16 = 2u;

// Lines a cell apart pass four neighbouring grid points at the same distance and lie in two texels.
const bool LINES_FOLLOW_LANES = LINE_SHIFT == CELL_SHIFT && BORDER != BORDER_PERIODIC && LANE_STRIDE == 1;

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

// A texel of four u16 or f16; or of one or four f32, whose images have other formats.
uvec4 lattice_at(ivec3 texel) {
    return LATTICE == LATTICE_SLOPES_F32 ? texelFetch(lattice_words, texel, 0) : imageLoad(lattice, texel);
}

// Value i of the eight in two texels.
uint value_of_eight(uvec4 a, uvec4 b, int i) {
    if (LATTICE == LATTICE_SLOPES_F32) {
        uvec4 four = mix(a, b, bvec4(i >= 4));
        uvec2 two = mix(four.xy, four.zw, bvec2((i & 2) != 0));
        return mix(two.x, two.y, (i & 1) != 0);
    }
    return lattice_u16(mix(a.xy, b.xy, bvec2(i >= 4)), i);
}

// Lattice values of four lines at a step (occluders: steps back). Where lines follow lanes, all of them lie in lowest
// .. lowest + 4.
uvec4 lattice_values(Azimuth azimuth, ivec4 line, int lowest, int lines, int step) {
    uvec4 values;
    if (LINES_FOLLOW_LANES) {
        int first = lowest & ~3;
        uvec4 a = lattice_at(lattice_texel(azimuth, lowest, step));
        uvec4 b = lattice_at(lattice_texel(azimuth, min(lowest + 4, lines - 1), step));
        values.x = value_of_eight(a, b, line.x - first);
        values.y = value_of_eight(a, b, line.y - first);
        values.z = value_of_eight(a, b, line.z - first);
        values.w = value_of_eight(a, b, line.w - first);
    } else {
        for (int k = 0; k < 4; k++) {
            uvec4 a = lattice_at(lattice_texel(azimuth, line[k], step));
            values[k] = value_of_eight(a, a, line[k] & 3);
        }
    }
    return values;
}

// Values of a lattice of slopes. A value that f16 clamped is "none", too.
vec4 slopes_of(uvec4 values) {
    vec4 slope = uintBitsToFloat(values);
    if (LATTICE == LATTICE_SLOPES_F16) {
        slope = vec4(unpackHalf2x16(values.x).x, unpackHalf2x16(values.y).x, unpackHalf2x16(values.z).x,
                     unpackHalf2x16(values.w).x);
    }
    return mix(slope, vec4(NO_SLOPE), lessThanEqual(slope, vec4(-65504.0)));
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
        if (BORDER == BORDER_PERIODIC) {
            cell = wrapped(cell, lanes);
            next = mix(cell + 1, 0, cell + 1 == lanes);
            m = wrapped(m, steps);
        } else {
            cell = clamp(cell, 0, lanes - 1);
            next = clamp(next, 0, lanes - 1);
            m = clamp(m, 0, steps - 1);
        }
        float h = height_at(cell, m);
        height[k] = h + float(place[k] & (CELL - 1)) * (1.0 / float(CELL)) * (height_at(next, m) - h);
    }
    vec4 distance = vec4(max(back, uvec4(1)));
    vec4 slope = (height - q.here.four) * (1.0 / azimuth.step_m) / distance;
    return Met(mix(vec4(NO_SLOPE), slope, stands), distance);
}

// Heights of four flipped lanes from one on, at a flipped step. Lanes beyond a field that does not repeat have an
// arbitrary height and do not count.
vec4 row_at(Azimuth azimuth, int lane, int step, int lanes, int steps) {
    int march = march_position(azimuth, neighbour(step, steps), steps);
    vec4 row;
    if (BORDER == BORDER_PERIODIC) {
        for (int i = 0; i < 4; i++) {
            row[i] = height_at(lane_position(azimuth, wrapped(lane + i, lanes), lanes), march);
        }
        return row;
    }
    bool flips = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int mirrored = lanes - 4 - lane;
    int first = flips ? mirrored : lane;
    int last_texel = (lanes - 1) >> 2;
    vec4 a = imageLoad(lane_heights, ivec2(clamp(first >> 2, 0, last_texel), march));
    vec4 b = imageLoad(lane_heights, ivec2(clamp((first >> 2) + 1, 0, last_texel), march));
    vec4 by_one = vec4(a.yzw, b.x);
    vec4 by_three = vec4(a.w, b.xyz);
    vec4 even = mix(a, vec4(a.zw, b.xy), bvec4((first & 2) != 0));
    vec4 odd = mix(by_one, by_three, bvec4((first & 2) != 0));
    row = mix(even, odd, bvec4((first & 1) != 0));
    return mix(row, row.wzyx, bvec4(flips));
}

// Raises `best` (slope, steps) to the highest crossing of a grid point's own line with grid lines and diagonals
// between two distances in steps, rounded outwards to whole steps on the near side: as `horizon_march`. In flipped
// lanes and steps.
void look_around(Azimuth azimuth, int lane, int step, float own, ivec2 ahead, int lanes, int steps, inout vec2 best) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool split_along = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    float advance = float(azimuth.shear) * (1.0 / float(CELL));
    int y = lane * CELL - (ahead.x - 1) * azimuth.shear;
    int nearer_cell = y >> CELL_SHIFT;
    vec4 nearer = row_at(azimuth, nearer_cell - 1, step - ahead.x + 1, lanes, steps);
    for (int back = ahead.x; back <= ahead.y; back++) {
        bool on = wraps || azimuth.shear == 0 || y > 0;
        y -= azimuth.shear;
        int cell = y >> CELL_SHIFT;
        float f0 = float(y & (CELL - 1)) * (1.0 / float(CELL));
        vec4 farther = row_at(azimuth, cell - 1, step - back, lanes, steps);
        // From the line's cell on, at both ends of the step.
        vec3 far = farther.yzw;
        vec3 near = mix(nearer.xyz, nearer.yzw, bvec3(cell == nearer_cell));
        float rise = (far.x - own) + f0 * (far.y - far.x);
        float found = rise / (float(back) * azimuth.step_m);
        bool better = on && (wraps || y >= 0) && found > best.x;
        best = mix(best, vec2(found, float(back)), bvec2(better));
        vec3 places = segment_crossings(f0, advance, split_along);
        for (int c = 0; c < 3; c++) {
            float u = places[c];
            float f = f0 + u * advance;
            bool next = f > 1.0;
            f -= next ? 1.0 : 0.0;
            vec2 h0 = mix(far.xy, far.yz, bvec2(next));
            vec2 h1 = mix(near.xy, near.yz, bvec2(next));
            rise = surface_rise(h0.x, h1.x, h0.y, h1.y, own, u, f, split_along);
            float distance_steps = float(back) - u;
            found = rise / (distance_steps * azimuth.step_m);
            better = on && u < 1.0 && (wraps || float(y) + u * float(azimuth.shear) >= -0.5) && found > best.x;
            best = mix(best, vec2(found, distance_steps), bvec2(better));
        }
        nearer = farther;
        nearer_cell = cell;
    }
}

// Ridges that unit steps miss stand beside a proposal: all crossings within two steps of both lines' proposals,
// `back` steps ahead; 0 for none. `reach` steps lie ahead.
void look_around_both(Azimuth azimuth, int lane, int step, float own, ivec2 back, int reach, int lanes, int steps, inout vec2 best) {
    int first = back.x > 0 ? back.x : back.y;
    int second = back.y > 0 ? back.y : back.x;
    int near = min(first, second);
    int far = max(first, second);
    ivec2 ahead = ivec2(max(near - 1, 1), min(near + 2, reach));
    // Then the rest of the other proposal's: one call, as SwiftShader compiles each call separately.
    for (int side = 0; side < 2 && near > 0 && ahead.x <= ahead.y; side++) {
        look_around(azimuth, lane, step, own, ahead, lanes, steps, best);
        ahead = ivec2(max(far - 1, near + 3), min(far + 2, reach));
    }
}

// Slopes of the horizons of four grid points and their distance in march steps. Slopes above `enough` need not be
// exact.
Met fused(Azimuth azimuth, Quad q, int lanes, int steps, int warm_up, vec4 enough) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int step = march_position(azimuth, q.march, steps);
    ivec4 lane = mix(q.lane, lanes - 1 - q.lane, bvec4(flips_lanes));
    Met met;
    if (FUSE == FUSE_DIRECT) {
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
    // Line 0 here, and the lines that are on the field here: none where `last` lies before `first`.
    int spacing = 1 << LINE_SHIFT;
    int total = warm_up + steps;
    int lead = lattice_lead(azimuth.shear, total, LINE_SHIFT, wraps);
    int lines = lattice_lines(lanes, lead, LINE_SHIFT, wraps);
    step += warm_up;
    int origin = step * azimuth.shear - lead * spacing;
    int first = (spacing - 1 - origin) >> LINE_SHIFT;
    int last = ((lanes - 1) * CELL - origin) >> LINE_SHIFT;
    ivec4 from_origin = lane * CELL - origin;

    if (FUSE == FUSE_NEAREST || FUSE == FUSE_AIMED_NEAREST) {
        // The nearer one; on a tie, the one before.
        ivec4 line = (from_origin + (spacing / 2 - 1)) >> LINE_SHIFT;
        bool takes = wraps || first <= last;
        int lowest = clamp(mix(line.x, line.w, flips_lanes), first, last);
        if (wraps) {
            line = ivec4(wrapped(line.x, lines), wrapped(line.y, lines), wrapped(line.z, lines), wrapped(line.w, lines));
        } else {
            line = clamp(line, first, last);
        }
        uvec4 values = lattice_values(azimuth, line, lowest, lines, step);
        if (FUSE == FUSE_NEAREST) {
            return Met(mix(vec4(NO_SLOPE), slopes_of(values), bvec4(takes)), vec4(0.0));
        }
        // A proposal one step back is the first crossing itself.
        uvec4 back = mix(uvec4(0), values, greaterThan(values, uvec4(1)));
        back = mix(uvec4(0), back, bvec4(takes));
        met = first_crossings(azimuth, q, lanes, steps);
        return higher(met, surface_at(azimuth, q, q.lane * CELL, back, lanes, steps));
    }
    // The lines around each grid point: before it (or through it), and after it.
    ivec4 before = from_origin >> LINE_SHIFT;
    ivec4 offset = from_origin & (spacing - 1);
    vec4 t = vec4(offset) * (1.0 / float(spacing));
    bvec4 has_before = wraps ? bvec4(true) : greaterThanEqual(before, ivec4(first));
    bvec4 has_after = wraps ? bvec4(true) : lessThan(before, ivec4(last));
    has_after = bvec4(uvec4(has_after) & uvec4(greaterThan(offset, ivec4(0))));
    int lowest = clamp(mix(before.x, before.w, flips_lanes), first, last);
    ivec4 before_line = wraps ? ivec4(wrapped(before.x, lines), wrapped(before.y, lines), wrapped(before.z, lines),
                                      wrapped(before.w, lines)) : clamp(before, first, last);
    ivec4 after_line = wraps ? mix(before_line + 1, ivec4(0), equal(before_line, ivec4(lines - 1)))
                             : clamp(before + 1, first, last);
    uvec4 before_values = lattice_values(azimuth, before_line, lowest, lines, step);
    uvec4 after_values = lattice_values(azimuth, after_line, lowest, lines, step);
    uvec4 before_back = mix(uvec4(0), before_values, has_before);
    uvec4 after_back = mix(uvec4(0), after_values, has_after);
    if (FUSE == FUSE_AIMED || FUSE == FUSE_AIMED_AROUND) {
        ivec4 y = q.lane * CELL;
        uvec4 before_far = mix(uvec4(0), before_back, greaterThan(before_back, uvec4(1)));
        uvec4 after_far = mix(uvec4(0), after_back, greaterThan(after_back, uvec4(1)));
        met = first_crossings(azimuth, q, lanes, steps);
        met = higher(met, surface_at(azimuth, q, y, before_far, lanes, steps));
        met = higher(met, surface_at(azimuth, q, y, after_far, lanes, steps));
        if (FUSE == FUSE_AIMED_AROUND) {
            for (int k = 0; k < 4; k++) {
                if (met.slope[k] < enough[k]) {
                    vec2 best = vec2(met.slope[k], met.steps[k]);
                    ivec2 back = ivec2(before_back[k], after_back[k]);
                    look_around_both(azimuth, lane[k], step - warm_up, q.here.four[k], back, step, lanes, steps, best);
                    met.slope[k] = best.x;
                    met.steps[k] = best.y;
                }
            }
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
        b = Met(mix(vec4(NO_SLOPE), slopes_of(before_values), has_before), vec4(0.0));
        a = Met(mix(vec4(NO_SLOPE), slopes_of(after_values), has_after), vec4(0.0));
    }
    // Where only one line has an occluder, use it alone.
    bvec4 both = greaterThan(min(a.slope, b.slope), vec4(LOWEST_MET));
    bvec4 nearer_after = greaterThan(t, vec4(0.5));
    Met one = higher(a, b);
    return Met(mix(one.slope, mix(b.slope, a.slope, t), both),
               mix(one.steps, mix(b.steps, a.steps, nearer_after), both));
}
