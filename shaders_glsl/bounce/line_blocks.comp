// Computes: blocks of every swept line of some azimuths: the largest height of each, and the mean radiance of its
// ground.
// Reads: bounce_ground (or grey_ground), azimuths.
// Writes: line_blocks (or grey_blocks).
// One invocation is 256 steps of a line.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Lines side by side, as they are in the image.
layout(local_size_x = 64) in;

layout(constant_id = 0) const int LINE_SHIFT = 15;
layout(constant_id = 1) const uint BORDER = 0u;
layout(constant_id = 2) const bool MARCHES_ROWS = false;
// One channel of radiance.
layout(constant_id = 3) const bool GREY = false;

layout(binding = 0, rgba32f) uniform readonly image2D bounce_ground;
layout(binding = 1, rgba16ui) uniform readonly uimage2D grey_ground;
layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, rgba32ui) uniform writeonly uimage2DArray line_blocks;
layout(binding = 4, rgba16ui) uniform writeonly uimage2DArray grey_blocks;

#include "shared/lines.glsl"
#include "bounce/line_blocks.glsl"

layout(push_constant) uniform LineBlocksPush {
    int cols;
    int rows;
    int warm_up;
    uint first_azimuth;
    int block_layers; // of one azimuth
};

Azimuth azimuth;
int lanes;
int steps;
int total;
int line;
int lead;
int first_layer;
int origin;  // of the line, at its first step

// A block, and the height where it begins.
struct Weighed {
    Block block;
    float begin;
};

// Radiance and height of the line at a step, counted with the warm-up.
vec4 point_at(int on) {
    int y = origin + on * azimuth.shear;
    int held = clamp(y, 0, (lanes - 1) * CELL);
    int place = BORDER == BORDER_PERIODIC ? y : held;
    return ground_on_line(azimuth, place, on - warm_up, lanes, steps);
}

// From both: the far one begins where the near one ends, `length` steps from where that begins. Their ground counts as
// it rises over all that is nearer.
Weighed joined(Weighed far, Weighed near, int length) {
    float over = max(near.block.top, near.begin);
    float flat_rise = FLAT_RISE * azimuth.step_m * float(length);
    float near_weight = (over - near.begin) + flat_rise;
    float far_weight = max(far.block.top - over, 0.0) + flat_rise;
    vec3 light = mix(near.block.light, far.block.light, far_weight / (near_weight + far_weight));
    bool is_far = far.block.top > near.block.top;
    int beyond = far.block.top_steps + length;
    float top = is_far ? far.block.top : near.block.top;
    int top_steps = is_far ? beyond : near.block.top_steps;
    return Weighed(Block(top, top_steps, light), near.begin);
}

void store(int level, int end, Block block) {
    int among = block_line(line, lead, azimuth.shear, end);
    if (among >= 0 && among < block_lines(lanes) && end < total) {
        ivec3 texel = block_texel(first_layer, among, level, end);
        if (GREY) {
            imageStore(grey_blocks, texel, split_u32(block_words(block).xy));
        } else {
            imageStore(line_blocks, texel, block_words(block));
        }
    }
}

// The ground between two neighbouring steps. The top is the far one: the near one is in the block before.
Weighed step_between(vec4 far, vec4 near) {
    return Weighed(Block(far.w, 1, 0.5 * (far.rgb + near.rgb)), near.w);
}

// The last point so far.
vec4 before;

// The two steps that end there, stored.
Weighed two_steps(int end) {
    vec4 middle = point_at(end - 1);
    vec4 near = point_at(end);
    Weighed two = joined(step_between(before, middle), step_between(middle, near), 1);
    before = near;
    store(1, end, two.block);
    return two;
}

void main() {
    lanes = MARCHES_ROWS ? cols : rows;
    steps = MARCHES_ROWS ? rows : cols;
    line = int(gl_GlobalInvocationID.x);
    azimuth = azimuth_at(azimuths, first_azimuth + gl_WorkGroupID.z);
    first_layer = int(gl_WorkGroupID.z) * block_layers;
    bool wraps = BORDER == BORDER_PERIODIC;
    total = warm_up + steps;
    lead = lattice_lead(azimuth.shear, total, LINE_SHIFT, wraps);
    int spacing = 1 << LINE_SHIFT;
    origin = (line - lead) * spacing;
    const int LENGTH = 1 << MOST_LEVEL;
    int begin = int(gl_WorkGroupID.y) * LENGTH;
    // Lines are read up to a spacing beside the field, where they have the values of its edge.
    int low = origin + begin * azimuth.shear;
    int high = low + LENGTH * azimuth.shear;
    bool is_beside = !wraps && (high < -spacing || low > (lanes - 1) * CELL + spacing);
    if (is_beside || line >= lattice_lines(lanes, lead, LINE_SHIFT, wraps)) {
        return;
    }
    before = point_at(begin);
    // Of each level the block that waits for the one after it.
    Weighed waiting[MOST_LEVEL - 2];
    for (int i = 0; i < LENGTH / 8; i++) {
        int end = begin + 8 * i;
        Weighed a = two_steps(end + 2);
        Weighed b = joined(a, two_steps(end + 4), 2);
        store(2, end + 4, b.block);
        Weighed c = two_steps(end + 6);
        Weighed d = joined(c, two_steps(end + 8), 2);
        store(2, end + 8, d.block);
        Weighed all = joined(b, d, 4);
        store(3, end + 8, all.block);
        int level = 3;
        while (((i >> (level - 3)) & 1) == 1) {
            all = joined(waiting[level - 3], all, 1 << level);
            level++;
            store(level, end + 8, all.block);
        }
        waiting[level - 3] = all;
    }
}
