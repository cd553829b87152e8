// Computes: for every step of every line of an azimuth, the earlier step of that line with the steepest slope
// (Timonen & Westerholm 2010, algorithm 1): an upper hull kept as a stack, O(1) amortised.
// Reads: lane_buffer, lane_heights or heights; azimuths.
// Writes: occluders (march steps back, 0 for none; u16) and / or slopes, at [azimuth][lines of a layer][step][line]: a
// lattice, see fuse.glsl.
// One invocation is four neighbouring lines, or one, from the horizon's side to the other end.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/lattice.glsl"

layout(local_size_x_id = 0) in;

const uint HULL_IN_PRIVATE = 0u;
const uint HULL_IN_SHARED = 1u;
const uint HULL_IN_OCCLUDERS = 2u;
// Hull storage. "In the occluders": the written occluders are the stack, a linked list.
layout(constant_id = 1) const uint HULL_PLACE = 0u;
// Entries kept per line, a power of two: the newest. A line that needs an older one is marked as lost and swept again
// with its hull in the occluders.
layout(constant_id = 2) const int HULL_DEPTH = 1;
layout(constant_id = 3) const int PRIVATE_ENTRIES = 1;
layout(constant_id = 4) const int PRIVATE_WORDS = 1;
layout(constant_id = 5) const int SHARED_WORDS = 1;
// True where HULL_DEPTH holds every step of a line: none can be lost.
layout(constant_id = 6) const bool HULL_HOLDS_LINE = true;
// An entry as f16 height and u16 step in one word (the paper's) instead of two f32.
layout(constant_id = 7) const bool HULL_PACKED = false;
layout(constant_id = 8) const bool WRITES_OCCLUDERS = true;
const uint SLOPES_F32 = 1u;
const uint SLOPES_F16 = 2u;
layout(constant_id = 9) const uint SLOPE_FORMAT = 0u;
layout(constant_id = 10) const bool PERIODIC = false;
// Lines are 2^LINE_SHIFT / 32768 cells apart.
layout(constant_id = 11) const int LINE_SHIFT = CELL_SHIFT;
// Sweeps only lines that an earlier run of this pass has marked as lost.
layout(constant_id = 12) const bool REDOES_LOST = false;
// An invocation sweeps one line and stores occluders alone, else four.
layout(constant_id = 13) const bool ONE_LINE = false;
// Of one line: entries per line in private memory. With a shared hull, they hold the oldest entries, which shared memory has
// overwritten. A line whose hull needs more is marked as lost.
layout(constant_id = 14) const int LINE_PRIVATE_ENTRIES = 1;
layout(constant_id = 15) const int LINE_SHARED_ENTRIES = 1;
// Of one line: two buffers of two words per line and two words of padding.
layout(constant_id = 16) const int WRITTEN_WORDS = 1;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, rgba16ui) uniform uimage2DArray occluders;
// SLOPE_FORMAT selects one of these.
layout(binding = 4, rgba32ui) uniform writeonly uimage2DArray slopes;
layout(binding = 7, rgba16ui) uniform writeonly uimage2DArray slopes_f16;
// One word for four lines, in the lattice's order.
layout(binding = 5) buffer LostLines { uint lost_lines[]; };
// All heights along the axis, [march position][lane], rows padded to a multiple of 4. Read if ONE_LINE.
layout(binding = 6) readonly buffer LaneBuffer { float lane_buffer[]; };

layout(push_constant) uniform HorizonSweepPush {
    int lanes;           // grid points across the march
    int steps;           // grid points along it
    int warm_up;         // steps marched before the first that counts: whole periods, or 0
    uint first_azimuth;
    float height_scale;  // packed entries: brings the largest |height| to 1
};

shared uint shared_hull[SHARED_WORDS];

const bool CAN_LOSE = !HULL_HOLDS_LINE && HULL_PLACE != HULL_IN_OCCLUDERS;

#include "horizon/line.glsl"
#include "horizon/one_line.glsl"

// `line_height` of four lines a cell apart that begin at y: five neighbouring lanes from two texels.
vec4 four_line_heights(int y, int step) {
    int march = march_position(azimuth, step, steps);
    int cell = y >> CELL_SHIFT;
    bool flipped = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int base = flipped ? lanes - 5 - cell : cell;
    int last = (lanes - 1) >> 2;
    vec4 a = imageLoad(lane_heights, ivec2(clamp(base >> 2, 0, last), march));
    vec4 b = imageLoad(lane_heights, ivec2(clamp((base >> 2) + 1, 0, last), march));
    bool odd = (base & 1) != 0;
    bool far = (base & 2) != 0;
    vec4 low = far ? vec4(a.zw, b.xy) : a;
    vec2 high = far ? b.zw : b.xy;
    vec4 here = odd ? vec4(low.yzw, high.x) : low;
    float fifth = odd ? high.y : high.x;
    vec4 next = vec4(here.yzw, fifth);
    if (flipped) {
        vec4 swap = next.wzyx;
        next = here.wzyx;
        here = swap;
    }
    // On the last lane there is no next one; the line is exactly on it.
    float t = float(y & (CELL - 1)) * (1.0 / float(CELL));
    ivec4 cells = ivec4(cell) + ivec4(0, 1, 2, 3);
    int end = t > 0.0 ? lanes - 1 : lanes;
    precise vec4 rise = t * (next - here);
    precise vec4 sum = here + rise;
    return mix(vec4(OUTSIDE), sum, lessThan(uvec4(cells), uvec4(end)));
}

vec2 unpacked_entry(uint word) {
    return vec2(unpackHalf2x16(word & 0xffffu).x / height_scale, float(word >> 16));
}

uint packed_entry(vec2 entry) {
    return packed_f16(vec2(entry.x * height_scale, 0.0)) | uint(entry.y) << 16;
}

void sweep_four_lines() {
    vec2 private_hull[4 * PRIVATE_ENTRIES];
    uint private_packed[4 * PRIVATE_WORDS];

    // All lines of a group march together, over the steps at which any of them is on the field.
    int total = warm_up + steps;
    int shear = azimuth.shear;
    int spacing = 1 << LINE_SHIFT;
    int lead = lattice_lead(shear, total, LINE_SHIFT, PERIODIC);
    int line_count = lattice_lines(lanes, lead, LINE_SHIFT, PERIODIC);
    int group_lines = int(gl_WorkGroupSize.x) * 4;
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
    int line = first_line + int(gl_LocalInvocationID.x) * 4;
    int y = (line - lead) * spacing + begin * shear;
    int lost_word = lattice_four(azimuth, line);
    if (REDOES_LOST && !subgroupAny(lost_lines[lost_word] != 0u)) {
        return;
    }
    bool lost = false;

    // The newest three hull vertices of each line, as height and step. Older ones are in the hull storage, `depth` of
    // them; entry `depth` is where the third goes if it is not popped. Entries below `kept` have been overwritten.
    vec4 h1 = vec4(OUTSIDE), h2 = vec4(UNDER_OUTSIDE), h3 = vec4(UNDER_OUTSIDE);
    vec4 x1 = vec4(float(begin - 1)), x2 = vec4(float(begin - 2)), x3 = vec4(float(begin - 3));
    ivec4 depth = ivec4(0);
    ivec4 kept = ivec4(0);
    for (int step = begin; step < end; step++) {
        float x = float(step);
        vec4 h;
        if (LINE_SHIFT == CELL_SHIFT && !PERIODIC) {
            h = four_line_heights(y, step);
        } else {
            for (int k = 0; k < 4; k++) {
                h[k] = line_height(y + k * spacing, step);
            }
        }
        // Pop while the deeper vertex subtends at least the slope of the newer one. The first pop moves registers
        // only; more are rare.
        bvec4 pops;
        kept = max(kept, depth + 1 - HULL_DEPTH);
        for (int k = 0; k < 4; k++) {
            precise float deeper = (h2[k] - h[k]) * (x - x1[k]);
            precise float newer = (h1[k] - h[k]) * (x - x2[k]);
            bool first = deeper >= newer;
            if (HULL_PLACE != HULL_IN_OCCLUDERS) {
                int slot = depth[k] & (HULL_DEPTH - 1);
                if (HULL_PLACE == HULL_IN_SHARED) {
                    int i = (slot * 4 + k) * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x);
                    if (HULL_PACKED) {
                        shared_hull[i] = packed_entry(vec2(h3[k], x3[k]));
                    } else {
                        shared_hull[2 * i] = floatBitsToUint(h3[k]);
                        shared_hull[2 * i + 1] = floatBitsToUint(x3[k]);
                    }
                } else if (HULL_PACKED) {
                    private_packed[k * PRIVATE_WORDS + slot] = packed_entry(vec2(h3[k], x3[k]));
                } else {
                    private_hull[k * PRIVATE_ENTRIES + slot] = vec2(h3[k], x3[k]);
                }
            }
            h1[k] = first ? h2[k] : h1[k];
            x1[k] = first ? x2[k] : x1[k];
            h2[k] = first ? h3[k] : h2[k];
            x2[k] = first ? x3[k] : x2[k];
            depth[k] -= first ? 1 : 0;
            precise float deeper_still = (h2[k] - h[k]) * (x - x1[k]);
            precise float newer_now = (h1[k] - h[k]) * (x - x2[k]);
            pops[k] = first && deeper_still >= newer_now;
        }
        // Values change only where `pops` holds: in llvmpipe (Mesa 22.3) a lane that leaves a loop early keeps
        // computing. No vote, which llvmpipe expands into a loop over lanes.
        do {
            for (int k = 0; k < 4; k++) {
                vec2 under;
                int slot = depth[k] & (HULL_DEPTH - 1);
                if (HULL_PLACE == HULL_IN_SHARED) {
                    int i = (slot * 4 + k) * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x);
                    under = HULL_PACKED
                        ? unpacked_entry(shared_hull[i])
                        : vec2(uintBitsToFloat(shared_hull[2 * i]), uintBitsToFloat(shared_hull[2 * i + 1]));
                } else if (HULL_PLACE == HULL_IN_PRIVATE) {
                    under = HULL_PACKED ? unpacked_entry(private_packed[k * PRIVATE_WORDS + slot])
                                        : private_hull[k * PRIVATE_ENTRIES + slot];
                }
                if (HULL_PLACE == HULL_IN_OCCLUDERS) {
                    // The occluder of the second vertex is the vertex below it.
                    int second = int(x2[k]);
                    int back = 0;
                    if (pops[k] && h2[k] > OUTSIDE) {
                        back = int(lattice_value(imageLoad(occluders, lattice_texel(azimuth, line, second)), k));
                    }
                    int place = second - back;
                    float h_place = kept_height(line_height(y + k * spacing - (step - place) * shear, max(place, 0)));
                    under = back > 0 ? vec2(h_place, float(place))
                                     : vec2(h2[k] > OUTSIDE ? OUTSIDE : UNDER_OUTSIDE, x2[k] - 1.0);
                } else if (!HULL_HOLDS_LINE) {
                    lost = lost || (pops[k] && depth[k] < kept[k]);
                }
                h1[k] = pops[k] ? h2[k] : h1[k];
                x1[k] = pops[k] ? x2[k] : x1[k];
                h2[k] = pops[k] ? under.x : h2[k];
                x2[k] = pops[k] ? under.y : x2[k];
                depth[k] -= pops[k] ? 1 : 0;
                precise float deeper = (h2[k] - h[k]) * (x - x1[k]);
                precise float newer = (h1[k] - h[k]) * (x - x2[k]);
                // An infinite height would pop for ever, as both products are infinite. If lines can be lost, popping an
                // empty hull marks the line as lost.
                bool has_more = CAN_LOSE || depth[k] >= 0;
                pops[k] = pops[k] && !lost && has_more && deeper >= newer;
            }
        } while (any(pops));
        bvec4 met = greaterThan(h1, vec4(OUTSIDE));
        ivec3 texel = lattice_texel(azimuth, line, step);
        if (WRITES_OCCLUDERS) {
            uvec4 back = uvec4(ivec4(mix(vec4(0.0), vec4(x) - x1, met)));
            imageStore(occluders, texel, back);
        }
        if (SLOPE_FORMAT != 0u) {
            vec4 slope = mix(vec4(NO_SLOPE), (h1 - h) / ((vec4(x) - x1) * azimuth.step_m), met);
            if (SLOPE_FORMAT == SLOPES_F32) {
                imageStore(slopes, texel, floatBitsToUint(slope));
            } else {
                imageStore(slopes_f16, texel, f16_bits(clamp(slope, -65504.0, 65504.0)));
            }
        }
        depth += 1;
        kept = min(kept, depth);
        h3 = h2;
        x3 = x2;
        h2 = h1;
        x2 = x1;
        for (int k = 0; k < 4; k++) {
            h1[k] = kept_height(h[k]);
        }
        x1 = vec4(x);
        y += shear;
    }
    if (!HULL_HOLDS_LINE && HULL_PLACE != HULL_IN_OCCLUDERS) {
        lost_lines[lost_word] = lost ? 1u : 0u;
    }
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    if (ONE_LINE) {
        sweep_one_line();
    } else {
        sweep_four_lines();
    }
}
