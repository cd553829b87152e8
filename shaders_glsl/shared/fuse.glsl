#include "shared/lattice.glsl"

// Brings the lattice of a sweep back to the field's samples. The including shader declares
// `heights`, `lattice` and the constants FUSE, LATTICE,
// LATTICE_HAS_DISTANCES, LINE_SHIFT and BORDER.

const uint FUSE_DIRECT = 0u;   // the lattice holds one value a sample
const uint FUSE_NEAREST = 1u;  // the slope that the nearer line found
const uint FUSE_SLOPES = 2u;   // both lines' slopes, interpolated
const uint FUSE_OWN = 3u;      // both lines' occluders seen from the sample's own height, interpolated
const uint FUSE_AIMED_NEAREST = 4u;  // the surface on the sample's own line where the nearer line's
                                     // occluder stands; and the first crossings of its own line
const uint FUSE_AIMED = 5u;          // the same with both lines' proposals, the higher one

const uint LATTICE_OCCLUDERS = 0u;
const uint LATTICE_SLOPES_F32 = 1u;
const uint LATTICE_SLOPES_F16 = 2u;

// A sample's surroundings in march and lane coordinates of one octant of azimuths: heights one
// step towards the horizon, straight, and to the lower lane; and of the lower lane's neighbour.
struct Octant {
    float own;
    float ahead;
    float ahead_low;
    float low;
    bool ahead_exists;
    bool low_exists;
    bool split_crosses;  // the cell's diagonal runs between `ahead` and `low`
};

// The slope that a line found.
float line_slope(int line, uvec4 texel) {
    uvec2 pair = (line & 2) == 0 ? texel.xy : texel.zw;
    float slope = LATTICE == LATTICE_SLOPES_F16 ? unpackHalf2x16(lattice_u16(texel.xy, line)).x
                                                : uintBitsToFloat((line & 1) == 0 ? pair.x : pair.y);
    // What f16 clamped is nothing, too.
    return slope <= -65504.0 ? NO_SLOPE : slope;
}

// The height of the surface at a lane position and a march step; false outside the field.
bool surface_on_line(Azimuth azimuth, int y, int step, int lanes, int steps, out float height) {
    int cell = y >> CELL_SHIFT;
    int next = min(cell + 1, lanes - 1);
    if (BORDER == BORDER_PERIODIC) {
        cell = wrapped(cell, lanes);
        next = (cell + 1) % lanes;
        step = wrapped(step, steps);
    } else if (!on_field(y, lanes) || step < 0) {
        height = 0.0;
        return false;
    }
    int march = march_position(azimuth, step, steps);
    int a = lane_position(azimuth, cell, lanes);
    int b = lane_position(azimuth, next, lanes);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    float ha = texelFetch(heights, by_row ? ivec2(a, march) : ivec2(march, a), 0).x;
    float hb = texelFetch(heights, by_row ? ivec2(b, march) : ivec2(march, b), 0).x;
    height = ha + float(y & (CELL - 1)) * (1.0 / float(CELL)) * (hb - ha);
    return true;
}

// The sample's surroundings for all azimuths that share its march axis and flips.
Octant octant_around(Azimuth azimuth, int lane, int step, int lanes, int steps, float own) {
    bool wraps = BORDER == BORDER_PERIODIC;
    Octant o;
    o.own = own;
    o.ahead_exists = wraps || step > 0;
    o.low_exists = wraps || lane > 0;
    o.split_crosses = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) != ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    int here = march_position(azimuth, step, steps);
    int ahead = march_position(azimuth, o.ahead_exists ? (step + steps - 1) % steps : step, steps);
    int middle = lane_position(azimuth, lane, lanes);
    int low = lane_position(azimuth, o.low_exists ? (lane + lanes - 1) % lanes : lane, lanes);
    o.ahead = texelFetch(heights, by_row ? ivec2(middle, ahead) : ivec2(ahead, middle), 0).x;
    o.ahead_low = texelFetch(heights, by_row ? ivec2(low, ahead) : ivec2(ahead, low), 0).x;
    o.low = texelFetch(heights, by_row ? ivec2(low, here) : ivec2(here, low), 0).x;
    return o;
}

// The higher of two findings, each (slope, march steps to what is met).
vec2 higher(vec2 a, vec2 b) {
    return b.x > a.x ? b : a;
}

// What the sample's own line meets within its first step: its crossing with the next grid line, and
// with the cell's diagonal where that lies across. Nearly all that unit steps miss lies here.
vec2 first_crossings(Azimuth azimuth, Octant o) {
    float shear = float(azimuth.shear) * (1.0 / float(CELL));
    if (!o.ahead_exists || (azimuth.shear > 0 && !o.low_exists)) {
        return vec2(NO_SLOPE, 0.0);
    }
    float rise = (o.ahead - o.own) + shear * (o.ahead_low - o.ahead);
    vec2 found = vec2(rise / azimuth.step_m, 1.0);
    if (o.split_crosses && o.low_exists) {
        // (1, 0) to (0, 1) is crossed by (u, u * shear) at u = 1 / (1 + shear).
        float u = 1.0 / (1.0 + shear);
        float split_rise = (o.low - o.own) + u * (o.ahead - o.low);
        found = higher(found, vec2(split_rise / (u * azimuth.step_m), u));
    }
    return found;
}

// The surface where a proposal stands, seen from the sample.
vec2 seen(Azimuth azimuth, int y, uint back, int step, int lanes, int steps, float own) {
    float h;
    if (back == 0u || !surface_on_line(azimuth, y - int(back) * azimuth.shear, step - int(back), lanes, steps, h)) {
        return vec2(NO_SLOPE, 0.0);
    }
    return vec2((h - own) / (float(back) * azimuth.step_m), float(back));
}

// Slope of the horizon at a sample (lane, step) and how many march steps away it stands.
vec2 fused(Azimuth azimuth, int lane, int step, int lanes, int steps, int warm_up, Octant o) {
    if (FUSE == FUSE_DIRECT) {
        ivec3 texel = ivec3(lane, step, azimuth.layer);
        float slope = uintBitsToFloat(texelFetch(lattice, texel, 0).x);
        texel.z++;
        return vec2(slope, LATTICE_HAS_DISTANCES ? uintBitsToFloat(texelFetch(lattice, texel, 0).x) : 0.0);
    }
    // The lines around the sample, before it (or through it) and after it.
    bool wraps = BORDER == BORDER_PERIODIC;
    int y = lane * CELL;
    int spacing = 1 << LINE_SHIFT;
    int total = warm_up + steps;
    int lead = lattice_lead(azimuth.shear, total, LINE_SHIFT, wraps);
    int lines = lattice_lines(lanes, lead, LINE_SHIFT, wraps);
    // Of line 0, and which line lies before the sample.
    int origin = (step + warm_up) * azimuth.shear - lead * spacing;
    int before_line = (y - origin) >> LINE_SHIFT;
    int before = origin + before_line * spacing;
    int after = before + spacing;
    bool has_before = wraps || before >= 0;
    bool has_after = before < y && (wraps || after <= (lanes - 1) * CELL);
    int after_line = wraps ? wrapped(before_line + 1, lines) : min(before_line + 1, lines - 1);
    before_line = wraps ? wrapped(before_line, lines) : before_line;
    float t = float(y - before) / float(spacing);
    bool takes_after = has_after && (t > 0.5 || !has_before);
    bool takes_one = has_after || has_before;

    if (FUSE == FUSE_NEAREST || FUSE == FUSE_AIMED_NEAREST) {
        int line = takes_after ? after_line : before_line;
        uvec4 texel = texelFetch(lattice, lattice_texel(azimuth, line, step + warm_up), 0);
        if (FUSE == FUSE_NEAREST) {
            return vec2(takes_one ? line_slope(line, texel) : NO_SLOPE, 0.0);
        }
        vec2 found = first_crossings(azimuth, o);
        uint back = takes_one ? lattice_u16(texel.xy, line) : 0u;
        // A proposal one step back is the first crossing itself.
        return higher(found, seen(azimuth, y, back > 1u ? back : 0u, step, lanes, steps, o.own));
    }
    uvec4 before_texel = texelFetch(lattice, lattice_texel(azimuth, before_line, step + warm_up), 0);
    uvec4 after_texel = texelFetch(lattice, lattice_texel(azimuth, after_line, step + warm_up), 0);
    uint before_back = has_before ? lattice_u16(before_texel.xy, before_line) : 0u;
    uint after_back = has_after ? lattice_u16(after_texel.xy, after_line) : 0u;
    if (FUSE == FUSE_AIMED) {
        vec2 found = first_crossings(azimuth, o);
        found = higher(found, seen(azimuth, y, before_back > 1u ? before_back : 0u, step, lanes, steps, o.own));
        return higher(found, seen(azimuth, y, after_back > 1u ? after_back : 0u, step, lanes, steps, o.own));
    }
    vec2 b;
    vec2 a;
    if (FUSE == FUSE_OWN) {
        b = seen(azimuth, before, before_back, step, lanes, steps, o.own);
        a = seen(azimuth, after, after_back, step, lanes, steps, o.own);
    } else {
        b = vec2(has_before ? line_slope(before_line, before_texel) : NO_SLOPE, 0.0);
        a = vec2(has_after ? line_slope(after_line, after_texel) : NO_SLOPE, 0.0);
    }
    // Where only one line met anything, it speaks for the sample.
    if (b.x <= LOWEST_MET || a.x <= LOWEST_MET) {
        return higher(a, b);
    }
    return vec2(mix(b.x, a.x, t), takes_after ? a.y : b.y);
}
