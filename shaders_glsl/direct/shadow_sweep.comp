// Computes: for every step of every line of an azimuth, up to which height the ground ahead shadows it from the lower
// edge of a sun: a running maximum of the ground over a plane that rises with the sun's light, raised so far that nothing
// between two lines is above the interpolation of their maxima.
// Reads: lane_heights or lane_buffer, azimuths.
// Writes: shadows at [azimuth][lines of a layer][step][line], a lattice (see lattice.glsl). The high half of a word is the shadow's
// height over the line in metres: the high half of an f32, never too low. The low half is the march steps back to the
// ground that casts it, 0 for none.
// One invocation is four neighbouring lines, a cell apart, from the sun's side to the other end; or a segment of one line.
//
// Interpolate bilinearly between the heights at which two lines cross two steps. At a share u of the way from one step to
// the other the surface is above that by at most
//   (1 - u) K0 + u K1 + 4 u (1 - u) E.
// K0, K1: at a step, a grid point between the lines, at f of a cell from one, stands above the chord between them by
// f (1 - f) of the change of slope at it. E: between the steps the lines move by `shear` across the lanes, where the steps
// may slope differently: shear / 4 of the difference; and a cell is two triangles: 1/4 of its twist.
#version 460

#include "shared/lattice.glsl"

layout(local_size_x_id = 0, local_size_y_id = 4) in;

layout(constant_id = 1) const bool PERIODIC = false;
// An invocation marches one line: for GPUs, which hide latency with many invocations.
layout(constant_id = 2) const bool ONE_LINE = false;
// Size of `written`: if ONE_LINE, two buffers of four steps of each line of the workgroup.
layout(constant_id = 3) const int WRITTEN_WORDS = 1;
// Size of `segment_top` and `segment_step`: if ONE_LINE, one word per invocation.
layout(constant_id = 5) const int SEGMENT_WORDS = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, rgba32ui) uniform writeonly uimage2DArray shadows;
// All heights along the axis, [march position][lane], rows padded to a multiple of 4. Read if ONE_LINE.
layout(binding = 3) readonly buffer LaneBuffer { float lane_buffer[]; };

layout(push_constant) uniform ShadowSweepPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched before the first that counts: whole periods, or 0
    uint first_azimuth;
};

// No ground ahead.
const float NOTHING = -1e30;

Azimuth azimuth;

// March state: first step; lane position of the (first) line; rise of the plane and shear in cells, a step; and whether the
// cells' diagonals run along the march.
int begin;
int y;
float rise;
float shear_cells;
bool splits_along;

#include "direct/shadow_line.glsl"

// Heights of nine lanes of a step.
struct Nine {
    vec4 a;
    vec4 b;
    float c;
};

// Heights at one step: three texels from that of a lane on; nine heights if periodic.
struct Fetched {
    vec4 a;
    vec4 b;
    vec4 c;
};

// In the field's own order, the first of the nine lanes that start at `lane` in march order.
int first_of_nine(int lane) {
    bool flips = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int mirrored = lanes - 9 - lane;
    return flips ? mirrored : lane;
}

Fetched fetch_nine(int lane, int step) {
    int march = march_position(azimuth, PERIODIC ? step % steps : step, steps);
    int base = first_of_nine(lane);
    Fetched all;
    if (PERIODIC) {
        float nine[9];
        for (int k = 0; k < 9; k++) {
            int at = wrapped(base + k, lanes);
            nine[k] = imageLoad(lane_heights, ivec2(at >> 2, march))[at & 3];
        }
        all = Fetched(vec4(nine[0], nine[1], nine[2], nine[3]), vec4(nine[4], nine[5], nine[6], nine[7]),
                      vec4(nine[8]));
    } else {
        int first = base >> 2;
        int last = (lanes - 1) >> 2;
        all.a = imageLoad(lane_heights, ivec2(clamp(first, 0, last), march));
        all.b = imageLoad(lane_heights, ivec2(clamp(first + 1, 0, last), march));
        all.c = imageLoad(lane_heights, ivec2(clamp(first + 2, 0, last), march));
    }
    return all;
}

// Heights from a lane on, in the order of the lines. Beyond the edge of a field that does not repeat they stay the same.
Nine nine_heights(Fetched all, int lane) {
    bool flips = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int base = first_of_nine(lane);
    Nine nine;
    if (PERIODIC) {
        nine = Nine(all.a, all.b, all.c.x);
    } else {
        int first = base >> 2;
        int last = (lanes - 1) >> 2;
        // The lanes past the last of a texel repeat it.
        vec4 a = mix(mix(all.a, all.a.xxxx, bvec4(first < 0)), all.a.wwww, bvec4(first > last));
        vec4 b = mix(mix(all.b, all.b.xxxx, bvec4(first < -1)), all.b.wwww, bvec4(first + 1 > last));
        vec4 c = mix(mix(all.c, all.c.xxxx, bvec4(first < -2)), all.c.wwww, bvec4(first + 2 > last));
        bvec4 two = bvec4((base & 2) != 0);
        vec4 a2 = mix(a, vec4(a.zw, b.xy), two);
        vec4 b2 = mix(b, vec4(b.zw, c.xy), two);
        vec2 c2 = mix(c.xy, c.zw, two.xy);
        bvec4 one = bvec4((base & 1) != 0);
        nine.a = mix(a2, vec4(a2.yzw, b2.x), one);
        nine.b = mix(b2, vec4(b2.yzw, c2.x), one);
        nine.c = mix(c2.x, c2.y, one.x);
    }
    Nine mirrored = Nine(vec4(nine.c, nine.b.wzy), vec4(nine.b.x, nine.a.wzy), nine.a.x);
    bvec4 swaps = bvec4(flips);
    return Nine(mix(nine.a, mirrored.a, swaps), mix(nine.b, mirrored.b, swaps), mix(nine.c, mirrored.c, flips));
}

// Number of the first line.
int line;
// The highest ground so far, over a plane through the beginning of the march.
vec4 top;
ivec4 top_step;
// Of the step before: the lane before line 0; slopes from lane to lane, from one lane before that; and the lines over
// the plane, raised by K.
int cell;
vec4 slopes_a;
vec3 slopes_b;
vec4 raised;

void march_over(int step, Fetched fetched) {
    Nine nine = nine_heights(fetched, cell - 1);
    vec4 to_a = vec4(nine.a.yzw, nine.b.x) - nine.a;
    vec4 to_b = vec4(nine.b.yzw, nine.c) - nine.b;
    // E. Slopes of the step before against those of the same cells, and of the cells one lane on.
    vec4 same_a = slopes_a - to_a;
    vec3 same_b = slopes_b - to_b.xyz;
    vec4 next_a = slopes_a - vec4(to_a.yzw, to_b.x);
    vec2 next_b = slopes_b.xy - to_b.yz;
    vec4 most = max(max(same_a, vec4(same_a.yzw, same_b.x)), max(vec4(same_a.zw, same_b.xy), vec4(same_a.w, same_b)));
    vec4 least = min(min(same_a, vec4(same_a.yzw, same_b.x)), min(vec4(same_a.zw, same_b.xy), vec4(same_a.w, same_b)));
    vec4 turn = max(most, max(next_a, max(vec4(next_a.yzw, next_b.x), vec4(next_a.zw, next_b))));
    vec4 twist = splits_along ? -least : most;
    vec4 between = 0.25 * (shear_cells * max(turn, 0.0) + max(twist, 0.0));
    // From here on of this step's own lanes.
    bool moves = y >> CELL_SHIFT != cell;
    bvec4 on = bvec4(moves);
    vec4 h_a = mix(nine.a, vec4(nine.a.yzw, nine.b.x), on);
    vec4 h_b = mix(nine.b, vec4(nine.b.yzw, nine.c), on);
    slopes_a = mix(to_a, vec4(to_a.yzw, to_b.x), on);
    slopes_b = mix(to_b.xyz, to_b.yzw, on.xyz);
    cell = y >> CELL_SHIFT;
    float f = float(y & (CELL - 1)) * (1.0 / float(CELL));
    vec4 h = mix(vec4(h_a.yzw, h_b.x), vec4(h_a.zw, h_b.xy), f);
    float plane = float(step) * rise;
    vec4 over_plane = h + plane;

    // Of the sums and of the heights: a few units in the last place.
    vec4 over = top - over_plane + (abs(top) + abs(h) + abs(plane)) * 1e-6;
    uvec4 back = uvec4(clamp(step - top_step, 0, 0xffff));
    back = mix(back, uvec4(0), lessThanEqual(top, vec4(NOTHING)));
    // Negative ones are cut off towards 0, which is up.
    uvec4 bits = floatBitsToUint(over) + mix(uvec4(0), uvec4(0xffff), greaterThan(over, vec4(0.0)));
    uvec4 words = bits & 0xffff0000u | back;
    imageStore(shadows, lattice_texel(azimuth, line, step), words);

    // K, of the grid points on both sides of each line.
    vec4 bend = slopes_a - vec4(slopes_a.yzw, slopes_b.x);
    vec4 next_bend = vec4(slopes_a.yzw, slopes_b.x) - vec4(slopes_a.zw, slopes_b.xy);
    vec4 now = over_plane + f * (1.0 - f) * max(max(bend, next_bend), 0.0);
    // The maximum over u.
    vec4 apart = abs(now - raised);
    vec4 middle = 0.5 * (now + raised) + between + apart * apart / max(16.0 * between, 1e-30);
    vec4 found = mix(max(now, raised), middle, lessThan(apart, 4.0 * between));
    ivec4 place = y + ivec4(0, CELL, 2 * CELL, 3 * CELL);
    found = mix(found, now, bvec4(step == begin));
    raised = now;
    bvec4 counts = bvec4(true);
    if (!PERIODIC) {
        counts = bvec4(uvec4(greaterThan(place, ivec4(-CELL))) & uvec4(lessThan(place, ivec4(lanes * CELL))));
    }
    bvec4 higher = bvec4(uvec4(counts) & uvec4(greaterThan(found, top)));
    top = mix(top, found, higher);
    top_step = mix(top_step, ivec4(step), higher);
    y += azimuth.shear;
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    int total = warm_up + steps;
    int shear = azimuth.shear;
    int lead = lattice_lead(shear, total, CELL_SHIFT, PERIODIC);
    int line_count = lattice_lines(lanes, lead, CELL_SHIFT, PERIODIC);
    int group_lines = int(gl_WorkGroupSize.x) * (ONE_LINE ? 1 : 4);
    int first_line = int(gl_WorkGroupID.x) * group_lines;
    if (first_line >= line_count) {
        return;
    }
    // The steps at which any line of the group is on the field, or less than a cell beside it: rays between it and
    // the next line are. And the step before, from which such rays enter the field.
    begin = 0;
    int end = total;
    if (!PERIODIC && shear > 0) {
        int lowest = (first_line - lead) * CELL;
        int highest = lowest + (group_lines - 1) * CELL;
        begin = max(0, (-2 * CELL - highest) / shear);
        end = clamp((lanes * CELL - lowest) / shear + 1, begin, max(begin, total));
    }
    rise = azimuth.low_slope * azimuth.step_m;
    shear_cells = float(shear) * (1.0 / float(CELL));
    splits_along = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    line = first_line + int(gl_LocalInvocationID.x) * (ONE_LINE ? 1 : 4);
    y = (line - lead) * CELL + begin * shear;
    if (ONE_LINE) {
        march_line(line, end, total);
        return;
    }
    top = vec4(NOTHING);
    top_step = ivec4(0);
    cell = y >> CELL_SHIFT;
    slopes_a = vec4(0.0);
    slopes_b = vec3(0.0);
    raised = vec4(NOTHING);
    for (int step = begin; step < end; step++) {
        march_over(step, fetch_nine(cell - 1, step));
    }
}
