// One line per invocation: for GPUs, which hide load latency with many invocations. Heights come from `lane_buffer`, four
// steps before they are needed; whole workgroups are whole tiles of 32 lines. Part of horizon_sweep, which declares all
// constants, bindings and push constants.

const bool LINE_HULL_IN_SHARED = HULL_PLACE == HULL_IN_SHARED;

shared vec2 line_hull_shared[LINE_SHARED_ENTRIES];
// Occluders of four steps, as two words per line: all first words, two words of padding against bank conflicts, all second
// words. Two such buffers alternate.
shared uint written[WRITTEN_WORDS];

// Texels of lane_buffer: of lane position 0 at step 0; from step to step, and from lane to lane; and the last.
int origin;
int step_stride;
int lane_stride;
int last_texel;

// Heights of the lanes on both sides of a line that starts at lane position `from`, at a step. Beyond the field they are
// arbitrary, as is the one past the last lane, which has no weight.
vec2 heights_beside(int from, int step, int total) {
    step = min(step, total - 1);
    int cell = (from + step * azimuth.shear) >> CELL_SHIFT;
    if (PERIODIC) {
        int row = origin + (step % steps) * step_stride;
        return vec2(lane_buffer[row + wrapped(cell, lanes) * lane_stride],
                    lane_buffer[row + wrapped(cell + 1, lanes) * lane_stride]);
    }
    int here = origin + step * step_stride + clamp(cell, 0, lanes - 1) * lane_stride;
    return vec2(lane_buffer[here], lane_buffer[clamp(here + lane_stride, 0, last_texel)]);
}

// Whether the deeper of two vertices subtends at least the slope of the newer one.
bool subtends(float h, float x, vec2 newer, vec2 deeper) {
    precise float deeper_area = (deeper.x - h) * (x - newer.y);
    precise float newer_area = (newer.x - h) * (x - deeper.y);
    return deeper_area >= newer_area;
}

// The newest three hull vertices, as height and step. `depth` older ones are in the hull storage, which holds the newest
// HULL_DEPTH; entry `depth` is where the third goes if it is not popped. Entries below `kept` were overwritten there; a
// shared hull has copied them to private memory.
vec2 v1;
vec2 v2;
vec2 v3;
int depth;
int kept;
bool lost;
vec2 line_hull_private[LINE_PRIVATE_ENTRIES];

// Entry i >= 0 of a hull in shared memory. Overwritten entries come from their copy in private memory.
vec2 shared_entry(int i) {
    vec2 entry;
    if (i >= kept) {
        entry = line_hull_shared[(i & (HULL_DEPTH - 1)) * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x)];
    } else {
        entry = line_hull_private[min(i, LINE_PRIVATE_ENTRIES - 1)];
    }
    return entry;
}

// Pops the vertices hidden from a point, up to two per iteration. Both are read together, so an iteration costs the latency of one
// read. A subgroup runs as many iterations as its slowest line.
void pop_by_twos(float h, float x) {
    bool pops = subtends(h, x, v1, v2);
    bool pops_next = pops && subtends(h, x, v2, v3);
    v1 = pops ? v2 : v1;
    v2 = pops ? v3 : v2;
    depth -= pops ? 1 : 0;
    while (pops_next && !lost && depth > 0) {
        vec2 third = shared_entry(depth);
        vec2 fourth = shared_entry(depth - 1);
        bool pops_third = depth > 1 && subtends(h, x, v2, third);
        pops_next = pops_third && subtends(h, x, third, fourth);
        v1 = pops_third ? third : v2;
        v2 = pops_third ? fourth : third;
        depth -= pops_third ? 2 : 1;
    }
}

// Sweeps one step between these heights. Returns the steps back to its occluder, 0 for none.
uint occluder(int step, int from, vec2 beside) {
    int y = from + step * azimuth.shear;
    float t = float(y & (CELL - 1)) * (1.0 / float(CELL));
    precise float rise = t * (beside.y - beside.x);
    precise float sum = beside.x + rise;
    float h = PERIODIC || on_field(y, lanes) ? sum : OUTSIDE;
    float x = float(step);
    int group_lines = int(gl_WorkGroupSize.x);
    int own = int(gl_LocalInvocationID.x);
    int oldest = depth - HULL_DEPTH;
    int slot = depth & (HULL_DEPTH - 1);
    if (LINE_HULL_IN_SHARED) {
        if (oldest >= kept) {
            line_hull_private[min(oldest, LINE_PRIVATE_ENTRIES - 1)] = line_hull_shared[slot * group_lines + own];
            lost = lost || !HULL_HOLDS_LINE && oldest >= LINE_PRIVATE_ENTRIES;
        }
        line_hull_shared[slot * group_lines + own] = v3;
    } else {
        line_hull_private[slot] = v3;
    }
    kept = max(kept, oldest + 1);
    // Loops stop for a lost line and for an empty hull: overwritten entries and infinite heights could make them endless.
    if (LINE_HULL_IN_SHARED) {
        pop_by_twos(h, x);
    } else if (subtends(h, x, v1, v2)) {
        v1 = v2;
        v2 = v3;
        depth--;
        while (!lost && depth > 0 && subtends(h, x, v1, v2)) {
            lost = !HULL_HOLDS_LINE && depth < kept;
            v1 = v2;
            v2 = line_hull_private[depth & (HULL_DEPTH - 1)];
            depth--;
        }
    }
    uint back = v1.x > OUTSIDE ? uint(int(x - v1.y)) : 0u;
    depth++;
    kept = min(kept, depth);
    v3 = v2;
    v2 = v1;
    v1 = vec2(h, x);
    return back;
}

// The same occluders as four lines per invocation, bit for bit: four steps of 32 lines at a time, so that neighbouring
// invocations write neighbouring texels.
void sweep_one_line() {
    int total = warm_up + steps;
    int shear = azimuth.shear;
    int spacing = 1 << LINE_SHIFT;
    int lead = lattice_lead(shear, total, LINE_SHIFT, PERIODIC);
    int line_count = lattice_lines(lanes, lead, LINE_SHIFT, PERIODIC);
    int group_lines = int(gl_WorkGroupSize.x);
    int first_line = int(gl_WorkGroupID.x) * group_lines;
    if (first_line >= line_count) {
        return;
    }
    int begin = 0;
    int end = total;
    if (!PERIODIC && shear > 0) {
        int lowest = (first_line - lead) * spacing;
        int highest = lowest + (group_lines - 1) * spacing;
        begin = max(0, -highest / shear);
        end = clamp(((lanes - 1) * CELL - lowest) / shear + 1, begin, max(begin, total));
    }
    int row = (lanes + 3) & ~3;
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int first_row = flips_march ? steps - 1 : 0;
    int first_lane = flips_lanes ? lanes - 1 : 0;
    origin = LANE_BUFFER_PAD + first_row * row + first_lane;
    step_stride = flips_march ? -row : row;
    lane_stride = flips_lanes ? -1 : 1;
    last_texel = LANE_BUFFER_PAD + steps * row - 1;
    int own = int(gl_LocalInvocationID.x);
    int line = first_line + own;
    // Of the flush: the invocation's step of four, and the words of four lines at it.
    int own_step = own & 3;
    int own_words = ((own & 2) != 0 ? group_lines + 2 : 0) + (own & ~3);
    uint own_shift = (own & 1) != 0 ? 16u : 0u;
    ivec3 own_texel = lattice_texel(azimuth, first_line + (own & ~3), own_step);
    // Lane position at step 0.
    int from = (line - lead) * spacing;
    lost = false;
    v1 = vec2(OUTSIDE, float(begin - 1));
    v2 = vec2(UNDER_OUTSIDE, float(begin - 2));
    v3 = vec2(UNDER_OUTSIDE, float(begin - 3));
    depth = 0;
    kept = 0;
    int turn = 0;
    vec2 a = heights_beside(from, begin & ~3, total);
    vec2 b = heights_beside(from, (begin & ~3) + 1, total);
    vec2 c = heights_beside(from, (begin & ~3) + 2, total);
    vec2 d = heights_beside(from, (begin & ~3) + 3, total);
    for (int four = begin & ~3; four < end; four += 4) {
        vec2 a_now = a;
        vec2 b_now = b;
        vec2 c_now = c;
        vec2 d_now = d;
        a = heights_beside(from, four + 4, total);
        b = heights_beside(from, four + 5, total);
        c = heights_beside(from, four + 6, total);
        d = heights_beside(from, four + 7, total);
        uvec4 back = uvec4(0u);
        if (four >= begin) {
            back.x = occluder(four, from, a_now);
        }
        if (four + 1 >= begin && four + 1 < end) {
            back.y = occluder(four + 1, from, b_now);
        }
        if (four + 2 >= begin && four + 2 < end) {
            back.z = occluder(four + 2, from, c_now);
        }
        if (four + 3 >= begin && four + 3 < end) {
            back.w = occluder(four + 3, from, d_now);
        }
        int first_word = turn * (2 * group_lines + 2);
        written[first_word + own] = back.x | back.y << 16;
        written[first_word + group_lines + 2 + own] = back.z | back.w << 16;
        // One barrier is enough: the next iteration writes the other half, and this half is reused only after that iteration's
        // barrier.
        barrier();
        int at = first_word + own_words;
        uvec4 all = (uvec4(written[at], written[at + 1], written[at + 2], written[at + 3]) >> own_shift) & 0xffffu;
        if (four + own_step >= begin && four + own_step < end) {
            ivec3 texel = own_texel + ivec3(0, four, 0);
            imageStore(occluders, texel, all);
        }
        turn = 1 - turn;
    }
    if (!HULL_HOLDS_LINE) {
        int first_word = turn * (2 * group_lines + 2);
        written[first_word + own] = lost ? 1u : 0u;
        barrier();
        int at = first_word + (own & ~3);
        if ((own & 3) == 0) {
            int lost_word = lattice_four(azimuth, line);
            lost_lines[lost_word] = written[at] | written[at + 1] | written[at + 2] | written[at + 3];
        }
    }
}
