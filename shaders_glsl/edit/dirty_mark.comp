// Computes: the grid points that an edited rectangle changes directly: its own and their neighbours, whose normals
// and first crossings depend on it. Clears the marks, list and counts of the last edit.
// Reads: nothing.
// Writes: dirty_texels, edit_list.
// One invocation is one word: eight columns of four rows.
#version 460

#include "edit/dirty.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) writeonly buffer DirtyTexels { uint dirty_texels[]; };
layout(binding = 1) writeonly buffer EditList { uint swept_steps; uint word_count; uint light_groups[3]; uint resolve_groups[3]; uint dirty_words[]; };

layout(push_constant) uniform DirtyMarkPush {
    int cols;
    int rows;
    int first_col;  // of the rectangle
    int first_row;
    int last_col;
    int last_row;
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) * ivec2(8, 4);
    if (at == ivec2(0)) {
        swept_steps = 0u;
        word_count = 0u;
        for (int i = 0; i < 3; i++) {
            light_groups[i] = i < 2 ? 0u : 1u;
            resolve_groups[i] = i < 2 ? 0u : 1u;
        }
    }
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    uint low = uint(clamp(first_col - 1 - at.x, 0, 8));
    uint high = uint(clamp(min(last_col + 2, cols) - at.x, 0, 8));
    uint columns = (1u << high) - (1u << low);
    uint word = 0u;
    for (int r = 0; r < 4; r++) {
        int row = at.y + r;
        bool inside = row >= first_row - 1 && row <= last_row + 1 && row < rows;
        word |= inside ? columns << uint(8 * r) : 0u;
    }
    dirty_texels[dirty_word(at, cols)] = word;
}
