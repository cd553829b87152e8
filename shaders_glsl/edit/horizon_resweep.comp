// Computes: the occluders that horizon_sweep would now find on the lines that an edited rectangle can reach, bit for
// bit: from where a line meets the rectangle until no hull vertex depends on it.
// Reads: heights, azimuths.
// Reads and writes: occluders (a linked list per line: the occluder of a hull vertex is the vertex below it),
// dirty_texels.
// Writes: edit_list (steps times four lines).
// One invocation is four neighbouring lines.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

#include "shared/lattice.glsl"
#include "edit/dirty.glsl"

// 32 lines, of one layer of the lattice. They march together.
layout(local_size_x = 8) in;
const int GROUP_LINES = 32;

// Lines are 2^LINE_SHIFT / 32768 cells apart.
layout(constant_id = 0) const int LINE_SHIFT = CELL_SHIFT;
// Heights on the hull are rounded to f16, as those of the sweep were.
layout(constant_id = 1) const bool HULL_PACKED = false;
// Lines of a periodic field have no beginning.
const bool PERIODIC = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, rgba16ui) uniform uimage2DArray occluders;
layout(binding = 3) buffer DirtyTexels { uint dirty_texels[]; };
layout(binding = 4) buffer EditList { uint swept_steps; uint word_count; uint light_groups[3]; uint resolve_groups[3]; uint dirty_words[]; };

layout(push_constant) uniform HorizonResweepPush {
    int lanes;
    int steps;
    uint first_azimuth;
    float height_scale;
    int first_col;  // of the rectangle
    int first_row;
    int last_col;
    int last_row;
};

#include "horizon/line.glsl"

const int SPACING = 1 << LINE_SHIFT;
const int NEVER = 0x7fffffff;

// Pops while the deeper vertex subtends at least the slope of the newer one: horizon_sweep's comparison.
bool is_popped(float h, float x, vec2 newer, vec2 deeper) {
    precise float of_deeper = (deeper.x - h) * (x - newer.y);
    precise float of_newer = (newer.x - h) * (x - deeper.y);
    return of_deeper >= of_newer;
}

// The vertex, as height and step, below `vertex` on the hull of line `line` + k; `y` is the line's lane position at
// step 0.
vec2 under(vec2 vertex, int y, int line, int k) {
    int step = int(vertex.y);
    int back = 0;
    if (vertex.x > OUTSIDE) {
        back = int(lattice_value(imageLoad(occluders, lattice_texel(azimuth, line, step)), k));
    }
    int place = step - back;
    float h = kept_height(line_height(y + place * azimuth.shear, max(place, 0)));
    return back > 0 ? vec2(h, float(place)) : vec2(vertex.x > OUTSIDE ? OUTSIDE : UNDER_OUTSIDE, vertex.y - 1.0);
}

// Marks the grid points that use the line's occluder at a step: up to one line spacing away.
void mark(int y, int step) {
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    int march = march_position(azimuth, step, steps);
    int last = min((y + SPACING) >> CELL_SHIFT, lanes - 1);
    for (int lane = max((y - SPACING + CELL - 1) >> CELL_SHIFT, 0); lane <= last; lane++) {
        int column = lane_position(azimuth, lane, lanes);
        ivec2 at = by_row ? ivec2(column, march) : ivec2(march, column);
        atomicOr(dirty_texels[dirty_word(at, by_row ? lanes : steps)], dirty_bit(at));
    }
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    int shear = azimuth.shear;
    int lead = lattice_lead(shear, steps, LINE_SHIFT, false);
    int line_count = lattice_lines(lanes, lead, LINE_SHIFT, false);

    // The rectangle in steps and lane positions. A grid point's own line may lie up to SPACING beside the proposing
    // one, and its surface between two lanes.
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    ivec2 lane_range = by_row ? ivec2(first_col, last_col) : ivec2(first_row, last_row);
    ivec2 step_range = by_row ? ivec2(first_row, last_row) : ivec2(first_col, last_col);
    if ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u) {
        lane_range = lanes - 1 - lane_range.yx;
    }
    if ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) {
        step_range = steps - 1 - step_range.yx;
    }
    int low = (lane_range.x - 1) * CELL - SPACING;
    int high = (lane_range.y + 1) * CELL + SPACING;

    // The groups of the rectangle's lines.
    int lowest_line = max(((low - step_range.y * shear) >> LINE_SHIFT) + lead, 0) & ~(GROUP_LINES - 1);
    int first_line = lowest_line + int(gl_WorkGroupID.x) * GROUP_LINES;
    int lowest = (first_line - lead) * SPACING;
    int highest = lowest + (GROUP_LINES - 1) * SPACING;
    if (first_line >= line_count || highest + step_range.y * shear < low || lowest + step_range.x * shear > high) {
        return;
    }
    // The steps from where any line of the group has met the rectangle to the end of the field.
    int start = step_range.x;
    int end = steps;
    if (shear > 0) {
        start = max(start, (max(low, 0) - highest) / shear);
        end = clamp(((lanes - 1) * CELL - lowest) / shear + 1, start, max(start, steps));
    }
    int line = first_line + int(gl_LocalInvocationID.x) * 4;
    int y0 = (line - lead) * SPACING;

    // The newest two hull vertices of each line, as height and step; the rest is in the occluders.
    vec2 newer[4];
    vec2 deeper[4];
    for (int k = 0; k < 4; k++) {
        int y = y0 + k * SPACING;
        bool stands = start > 0 && on_field(y + (start - 1) * shear, lanes);
        float h = kept_height(line_height(y + (start - 1) * shear, max(start - 1, 0)));
        newer[k] = vec2(stands ? h : OUTSIDE, float(start - 1));
        deeper[k] = under(newer[k], y, line, k);
    }
    // Per line: the first step in the rectangle; the newest step that is in it or whose occluder has changed; and the
    // newest hull vertex that is no newer than that. Once the last lies before the first, neither the hull nor any
    // later result depends on the edit.
    ivec4 entered = ivec4(NEVER);
    ivec4 touched = ivec4(-1);
    ivec4 standing = ivec4(-1);
    uint swept = 0u;
    bool going = true;
    for (int step = start; step < end && going; step++) {
        float x = float(step);
        vec4 h;
        bvec4 pops;
        for (int k = 0; k < 4; k++) {
            h[k] = line_height(y0 + k * SPACING + step * shear, step);
            pops[k] = is_popped(h[k], x, newer[k], deeper[k]);
        }
        // All lanes leave together.
        while (subgroupAny(any(pops))) {
            for (int k = 0; k < 4; k++) {
                vec2 next = under(deeper[k], y0 + k * SPACING, line, k);
                newer[k] = pops[k] ? deeper[k] : newer[k];
                deeper[k] = pops[k] ? next : deeper[k];
                bool again = is_popped(h[k], x, newer[k], deeper[k]);
                // An infinite height would pop for ever, as in horizon_sweep.
                pops[k] = pops[k] && again && newer[k].x > OUTSIDE;
            }
        }
        ivec3 texel = lattice_texel(azimuth, line, step);
        ivec4 before = ivec4(imageLoad(occluders, texel));
        ivec4 back;
        for (int k = 0; k < 4; k++) {
            back[k] = newer[k].x > OUTSIDE ? step - int(newer[k].y) : 0;
        }
        imageStore(occluders, texel, uvec4(back));
        bool stays = false;
        for (int k = 0; k < 4; k++) {
            int y = y0 + k * SPACING + step * shear;
            bool stands = on_field(y, lanes);
            int met = back[k] > 0 ? step - back[k] : -1;
            int y_met = y - back[k] * shear;
            bool inside = stands && step >= step_range.x && step <= step_range.y && y >= low && y <= high;
            bool met_inside = met >= step_range.x && met <= step_range.y && y_met >= low && y_met <= high;
            bool changed = stands && back[k] != before[k];
            entered[k] = inside ? min(entered[k], step) : entered[k];
            bool touches = inside || changed;
            touched[k] = touches ? step : touched[k];
            standing[k] = touches ? step : (met <= touched[k] ? met : standing[k]);
            if (changed || (stands && met_inside)) {
                mark(y, step);
            }
            bool passed = step >= step_range.y || y + shear > high;
            bool has_left = y > (lanes - 1) * CELL;
            stays = stays || !(has_left || (passed && standing[k] < entered[k]));
            deeper[k] = newer[k];
            newer[k] = vec2(kept_height(h[k]), x);
        }
        swept++;
        going = subgroupAny(stays);
    }
    atomicAdd(swept_steps, swept);
}
