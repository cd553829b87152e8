// Included by shadow_sweep, which declares all constants, bindings and push constants. Sweeps one line per invocation by the
// operations of four lines per invocation: bit-identical where the compiler contracts both alike. Heights are fetched from `lane_buffer` four steps ahead.

// Words of four steps of each line, for each segment. Two such buffers alternate.
shared uint written[WRITTEN_WORDS];
// The highest ground of each segment of each line, and its step.
shared float segment_top[SEGMENT_WORDS];
shared int segment_step[SEGMENT_WORDS];

// Heights of six lanes, from the one before the line's cell at the step before.
struct Six {
    vec4 a;
    vec2 b;
};

// Texels of lane_buffer: of lane 0 at step 0; from step to step, and from lane to lane.
int origin;
int step_stride;
int lane_stride;

// The highest ground so far, over a plane through the beginning of the march.
float line_top;
int line_top_step;
// Of the step before: the lane before the line; slopes from lane to lane, from one lane before that; and the line over the
// plane, raised by K.
int line_cell;
vec4 line_slopes;
float line_raised;

float height_on(int row, int lane) {
    int on = PERIODIC ? wrapped(lane, lanes) : clamp(lane, 0, lanes - 1);
    return lane_buffer[row + on * lane_stride];
}

// Heights at `step` for six lanes, starting one lane before the line's cell at the previous step.
Six six_heights(int step, int total) {
    int last = min(step, total - 1);
    int row = origin + (PERIODIC ? last % steps : last) * step_stride;
    int first = ((y + (max(step - 1, begin) - begin) * azimuth.shear) >> CELL_SHIFT) - 1;
    return Six(vec4(height_on(row, first), height_on(row, first + 1), height_on(row, first + 2), height_on(row, first + 3)),
               vec2(height_on(row, first + 4), height_on(row, first + 5)));
}

// Advances the line by one step and returns its word. Ground from step `end` on is ignored.
uint word_of_step(int step, int end, Six six) {
    int place = y + (step - begin) * azimuth.shear;
    vec4 to = vec4(six.a.yzw, six.b.x) - six.a;
    float last_to = six.b.y - six.b.x;
    // E. Slopes of the step before against those of the same cells, and of the cells one lane on.
    vec4 same = line_slopes - to;
    vec3 next = line_slopes.xyz - to.yzw;
    float most = max(max(same.x, same.y), max(same.z, same.w));
    float least = min(min(same.x, same.y), min(same.z, same.w));
    float turn = max(most, max(next.x, max(next.y, next.z)));
    float twist = splits_along ? -least : most;
    float between = 0.25 * (shear_cells * max(turn, 0.0) + max(twist, 0.0));
    bool moves = place >> CELL_SHIFT != line_cell;
    line_slopes = mix(to, vec4(to.yzw, last_to), bvec4(moves));
    line_cell = place >> CELL_SHIFT;
    float f = float(place & (CELL - 1)) * (1.0 / float(CELL));
    float h = mix(moves ? six.a.z : six.a.y, moves ? six.a.w : six.a.z, f);
    float plane = float(step) * rise;
    float over_plane = h + plane;

    float over = line_top - over_plane + (abs(line_top) + abs(h) + abs(plane)) * 1e-6;
    uint back = line_top <= NOTHING ? 0u : uint(clamp(step - line_top_step, 0, 0xffff));
    uint bits = floatBitsToUint(over) + (over > 0.0 ? 0xffffu : 0u);
    uint word = bits & 0xffff0000u | back;

    float bend = line_slopes.x - line_slopes.y;
    float next_bend = line_slopes.y - line_slopes.z;
    float now = over_plane + f * (1.0 - f) * max(max(bend, next_bend), 0.0);
    float apart = abs(now - line_raised);
    float middle = 0.5 * (now + line_raised) + between + apart * apart / max(16.0 * between, 1e-30);
    float found = apart < 4.0 * between ? middle : max(now, line_raised);
    found = step == begin ? now : found;
    line_raised = now;
    bool counts = step < end && (PERIODIC || place > -CELL && place < lanes * CELL);
    bool higher = counts && found > line_top;
    line_top = higher ? found : line_top;
    line_top_step = higher ? step : line_top_step;
    return word;
}

// Marches steps [from, to) of the line; to - from is a multiple of 4. Steps from `end` on are ignored. If `writes`, four steps of all
// lines of the workgroup are stored together, so that neighbouring invocations write neighbouring texels.
void march_steps(int line, int from, int to, int end, int total, bool writes) {
    int group_lines = int(gl_WorkGroupSize.x);
    int own = int(gl_LocalInvocationID.x);
    int own_step = own & 3;
    int own_words = own_step * group_lines + (own & ~3);
    int segment_words = 2 * 4 * group_lines * int(gl_LocalInvocationID.y);
    ivec3 own_texel = lattice_texel(azimuth, line & ~3, own_step);
    int turn = 0;
    Six a = six_heights(from, total);
    Six b = six_heights(from + 1, total);
    Six c = six_heights(from + 2, total);
    Six d = six_heights(from + 3, total);
    for (int four = from; four < to; four += 4) {
        Six a_now = a;
        Six b_now = b;
        Six c_now = c;
        Six d_now = d;
        a = six_heights(four + 4, total);
        b = six_heights(four + 5, total);
        c = six_heights(four + 6, total);
        d = six_heights(four + 7, total);
        uvec4 words;
        words.x = word_of_step(four, end, a_now);
        words.y = word_of_step(four + 1, end, b_now);
        words.z = word_of_step(four + 2, end, c_now);
        words.w = word_of_step(four + 3, end, d_now);
        if (writes) {
            int half_words = segment_words + turn * 4 * group_lines;
            int at = half_words + own;
            // Steps beyond the end are not stored.
            written[at] = words.x;
            written[at + group_lines] = words.y;
            written[at + 2 * group_lines] = words.z;
            written[at + 3 * group_lines] = words.w;
            // One barrier is enough: the next iteration writes the other half, and this half is reused only after that iteration's
            // barrier.
            barrier();
            int first = half_words + own_words;
            if (four + own_step < end) {
                imageStore(shadows, own_texel + ivec3(0, four, 0),
                           uvec4(written[first], written[first + 1], written[first + 2], written[first + 3]));
            }
            turn = 1 - turn;
        }
    }
}

// Marches the line up to step `end`, in as many segments of equal length as the workgroup has invocations along y. If there are
// several, an invocation first finds the highest ground of its segment, and then starts again from the highest ground of the segments
// before it: bit-identical to one segment where the compiler contracts both alike.
void march_line(int line, int end, int total) {
    int row = (lanes + 3) & ~3;
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    origin = LANE_BUFFER_PAD + (flips_march ? (steps - 1) * row : 0) + (flips_lanes ? lanes - 1 : 0);
    step_stride = flips_march ? -row : row;
    lane_stride = flips_lanes ? -1 : 1;
    int segments = int(gl_WorkGroupSize.y);
    int segment = int(gl_LocalInvocationID.y);
    int length = ((end - begin + segments - 1) / segments + 3) & ~3;
    int from = begin + segment * length;
    // Rebuilds the state of a march from `begin`, except the highest ground. It depends on the step before only.
    line_top = NOTHING;
    line_top_step = 0;
    line_slopes = vec4(0.0);
    line_raised = NOTHING;
    line_cell = y + max(from - 2 - begin, 0) * azimuth.shear >> CELL_SHIFT;
    if (segment > 0 && from < end) {
        word_of_step(from - 1, end, six_heights(from - 1, total));
    }
    if (segments > 1) {
        line_top = NOTHING;
        int own_cell = line_cell;
        vec4 own_slopes = line_slopes;
        float own_raised = line_raised;
        // Nothing follows the last segment.
        if (segment < segments - 1) {
            march_steps(line, from, from + length, end, total, false);
        }
        int at = segment * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x);
        segment_top[at] = line_top;
        segment_step[at] = line_top_step;
        barrier();
        line_top = NOTHING;
        line_top_step = 0;
        for (int before = int(gl_LocalInvocationID.x); before < at; before += int(gl_WorkGroupSize.x)) {
            bool higher = segment_top[before] > line_top;
            line_top = higher ? segment_top[before] : line_top;
            line_top_step = higher ? segment_step[before] : line_top_step;
        }
        line_cell = own_cell;
        line_slopes = own_slopes;
        line_raised = own_raised;
    }
    march_steps(line, from, from + length, end, total, true);
}
