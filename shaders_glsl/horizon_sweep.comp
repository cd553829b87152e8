// Computes: for every sample of every line of an azimuth, the earlier sample of the line that rises
// highest (Timonen & Westerholm 2010, algorithm 1): an upper hull kept as a stack, O(1) amortised.
// Reads: heights, azimuths. Writes: occluders (march steps back, 0 where nothing is met) and / or
// slopes, at [layer][march position][lane].
// One invocation is one line, from the horizon's side to the other end.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

#include "shared/sweep.glsl"

layout(local_size_x_id = 0) in;

const uint HULL_IN_PRIVATE = 0u;
const uint HULL_IN_SHARED = 1u;
const uint HULL_IN_OCCLUDERS = 2u;
// Where the hull lives; in the occluders means that what was written is the stack (a linked list).
layout(constant_id = 1) const uint HULL_PLACE = 0u;
// Entries a line keeps, a power of two. A deeper hull goes on in the occluders already written.
layout(constant_id = 2) const int HULL_DEPTH = 1;
layout(constant_id = 3) const int PRIVATE_ENTRIES = 1;
layout(constant_id = 4) const int PRIVATE_WORDS = 1;
layout(constant_id = 5) const int SHARED_WORDS = 1;
// True where HULL_DEPTH holds every sample of a line: nothing can spill.
layout(constant_id = 6) const bool HULL_HOLDS_LINE = true;
// An entry as f16 height and u16 step in one word (the paper's) instead of two f32.
layout(constant_id = 7) const bool HULL_PACKED = false;
layout(constant_id = 8) const bool WRITES_OCCLUDERS = true;
const uint SLOPES_F32 = 1u;
const uint SLOPES_F16 = 2u;
layout(constant_id = 9) const uint SLOPE_FORMAT = 0u;
layout(constant_id = 10) const bool HEIGHTS_IN_IMAGE = false;
layout(constant_id = 11) const bool PERIODIC = false;
// Lines are 2^LINE_SHIFT / 32768 cells apart.
layout(constant_id = 12) const int LINE_SHIFT = CELL_SHIFT;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) readonly buffer LaneHeights { float lane_heights[]; };
layout(binding = 2) readonly buffer Azimuths { Azimuth azimuths[]; };
layout(binding = 3, r16ui) uniform uimage2DArray occluders;
layout(binding = 4) uniform writeonly uimage2DArray slopes;

layout(push_constant) uniform HorizonSweepPush {
    int lanes;           // samples across the march
    int steps;           // samples along it
    int warm_up;         // steps marched before the first that is written: whole periods, or 0
    uint first_azimuth;
    float height_scale;  // packed entries: brings the largest |height| to 1
};

shared uint shared_hull[SHARED_WORDS];

Azimuth azimuth;

float height_at(int lane, int march) {
    int column = lane_position(azimuth, lane, lanes);
    if (HEIGHTS_IN_IMAGE) {
        bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
        return texelFetch(heights, by_row ? ivec2(column, march) : ivec2(march, column), 0).x;
    }
    return lane_heights[march * lanes + column];
}

float line_height(int y, int step) {
    int march = march_position(azimuth, PERIODIC ? step % steps : step, steps);
    int cell = y >> CELL_SHIFT;
    int lane = PERIODIC ? wrapped(cell, lanes) : clamp(cell, 0, lanes - 1);
    int next = PERIODIC ? wrapped(cell + 1, lanes) : min(lane + 1, lanes - 1);
    float t = float(y & (CELL - 1)) * (1.0 / float(CELL));
    float h = height_at(lane, march);
    return h + t * (height_at(next, march) - h);
}

ivec3 lattice_texel(int y, int step) {
    int line_cell = y >> LINE_SHIFT;
    int slots = (lanes * CELL) >> LINE_SHIFT;
    return ivec3(PERIODIC ? wrapped(line_cell, slots) : line_cell,
                 march_position(azimuth, PERIODIC ? step % steps : step, steps), azimuth.layer);
}

void write_result(int y, int step, int back, float slope) {
    ivec3 texel = lattice_texel(y, step);
    if (WRITES_OCCLUDERS) {
        imageStore(occluders, texel, uvec4(back));
    }
    float met = back > 0 ? slope : NO_SLOPE;
    if (SLOPE_FORMAT == SLOPES_F32) {
        imageStore(slopes, texel, uvec4(floatBitsToUint(met)));
    } else if (SLOPE_FORMAT == SLOPES_F16) {
        imageStore(slopes, texel, uvec4(packHalf2x16(vec2(clamp(met, -65504.0, 65504.0), 0.0))));
    }
}

// What an entry becomes by being packed.
vec2 stored(vec2 entry) {
    return HULL_PACKED ? vec2(unpackHalf2x16(packHalf2x16(vec2(entry.x * height_scale, 0.0))).x / height_scale, entry.y)
                       : entry;
}

uint packed_entry(vec2 entry) {
    return packHalf2x16(vec2(entry.x * height_scale, 0.0)) | uint(entry.y) << 16;
}

vec2 unpacked_entry(uint word) {
    return vec2(unpackHalf2x16(word & 0xffffu).x / height_scale, float(word >> 16));
}

vec2 shared_entry(int slot) {
    int i = slot * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x);
    if (HULL_PACKED) {
        return unpacked_entry(shared_hull[i]);
    }
    return vec2(uintBitsToFloat(shared_hull[2 * i]), uintBitsToFloat(shared_hull[2 * i + 1]));
}

void keep_shared(int slot, vec2 entry) {
    int i = slot * int(gl_WorkGroupSize.x) + int(gl_LocalInvocationID.x);
    if (HULL_PACKED) {
        shared_hull[i] = packed_entry(entry);
    } else {
        shared_hull[2 * i] = floatBitsToUint(entry.x);
        shared_hull[2 * i + 1] = floatBitsToUint(entry.y);
    }
}

void main() {
    azimuth = azimuths[first_azimuth + gl_GlobalInvocationID.z];
    vec2 private_hull[PRIVATE_ENTRIES];
    uint private_packed[PRIVATE_WORDS];

    // All lines of the group march together, over the steps at which any of them is on the field.
    int total = warm_up + steps;
    int shear = azimuth.shear;
    int spacing = 1 << LINE_SHIFT;
    int lead = PERIODIC ? 0 : ((total - 1) * shear + spacing - 1) >> LINE_SHIFT;
    int width = PERIODIC ? lanes * CELL - 1 : (lanes - 1) * CELL;
    int line_count = (width >> LINE_SHIFT) + 1 + lead;
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
        end = min(total, (width - lowest) / shear + 1);
    }
    int line = first_line + int(gl_LocalInvocationID.x);
    bool exists = line < line_count;
    int y = (line - lead) * spacing + begin * shear;

    // The newest two hull vertices, (height, step): in registers. The rest, `depth` - 1 of them
    // counting the second, in the hull's memory from entry `kept` on.
    vec2 top = vec2(0.0);
    vec2 under = vec2(0.0);
    int depth = 0;
    int kept = 0;
    for (int step = begin; step < end; step++) {
        if (exists && (PERIODIC || on_field(y, lanes))) {
            float h = line_height(y, step);
            float x = float(step);
            // Pop while the deeper vertex looks at least as high as the newer one.
            while (true) {
                precise float deeper = (under.x - h) * (x - top.y);
                precise float newer = (top.x - h) * (x - under.y);
                if (depth < 2 || !(deeper >= newer)) {
                    break;
                }
                top = under;
                depth--;
                int i = depth - 2;
                if (HULL_HOLDS_LINE || (HULL_PLACE != HULL_IN_OCCLUDERS && i >= kept)) {
                    int slot = max(i, 0) & (HULL_DEPTH - 1);
                    if (HULL_PLACE == HULL_IN_SHARED) {
                        under = shared_entry(slot);
                    } else {
                        under = HULL_PACKED ? unpacked_entry(private_packed[slot]) : private_hull[slot];
                    }
                } else if (i >= 0) {
                    // What met `top` then is what lies under it now.
                    int top_step = int(top.y);
                    int back = int(imageLoad(occluders, lattice_texel(y - (step - top_step) * shear, top_step)).x);
                    int under_step = top_step - back;
                    under = stored(vec2(line_height(y - (step - under_step) * shear, under_step), float(under_step)));
                }
            }
            kept = min(kept, depth);
            if (step >= warm_up) {
                write_result(y, step, depth > 0 ? step - int(top.y) : 0, (top.x - h) / ((x - top.y) * azimuth.step_m));
            }
            // Push: what was on top goes to memory, the new sample on top.
            if (depth > 0 && HULL_PLACE != HULL_IN_OCCLUDERS) {
                int slot = (depth - 1) & (HULL_DEPTH - 1);
                if (HULL_PLACE == HULL_IN_SHARED) {
                    keep_shared(slot, top);
                } else if (HULL_PACKED) {
                    private_packed[slot] = packed_entry(top);
                } else {
                    private_hull[slot] = top;
                }
                kept = max(kept, depth - HULL_DEPTH);
            }
            under = top;
            top = stored(vec2(h, x));
            depth++;
        }
        y += shear;
    }
}
