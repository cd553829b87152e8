// Computes: the compact list of the bitmap's nonzero words, and the workgroup counts of the passes that shade them.
// Reads: dirty_texels.
// Reads and writes: edit_list.
// One invocation is one word.
#version 460

#include "edit/dirty.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) readonly buffer DirtyTexels { uint dirty_texels[]; };
layout(binding = 1) buffer EditList { uint swept_steps; uint word_count; uint light_groups[3]; uint resolve_groups[3]; uint dirty_words[]; };

layout(push_constant) uniform DirtyListPush {
    int cols;
    int rows;
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) * ivec2(8, 4);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    int word = dirty_word(at, cols);
    if (dirty_texels[word] == 0u) {
        return;
    }
    uint place = atomicAdd(word_count, 1u);
    dirty_words[place] = uint(word);
    uint light = place / LIGHT_GROUP_WORDS;
    atomicMax(light_groups[0], min(light + 1u, GROUPS_ACROSS));
    atomicMax(light_groups[1], light / GROUPS_ACROSS + 1u);
    uint resolve = place / RESOLVE_GROUP_WORDS;
    atomicMax(resolve_groups[0], min(resolve + 1u, GROUPS_ACROSS));
    atomicMax(resolve_groups[1], resolve / GROUPS_ACROSS + 1u);
}
