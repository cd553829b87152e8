#include "shared/words.glsl"

// What walks read: points of lines, with height and exit radiance between two lanes, and blocks of them. The including
// shader declares `bounce_ground`, `grey_ground`, `line_blocks`, `grey_blocks` and the constants LINE_SHIFT, BORDER, GREY and MARCHES_ROWS.

// Exit radiance and height.
vec4 ground_at(int lane, int march) {
    ivec2 by_row = ivec2(lane, march);
    ivec2 by_col = ivec2(march, lane);
    ivec2 at = MARCHES_ROWS ? by_row : by_col;
    // No early exit: it makes loops out of functions, for which SwiftShader's compiler takes gigabytes.
    vec4 ground;
    if (GREY) {
        ground = uintBitsToFloat(join_u16(imageLoad(grey_ground, at)).xxxy);
    } else {
        ground = imageLoad(bounce_ground, at);
    }
    return ground;
}

// The same at a lane position and a step: wrapped where the field repeats, else clamped. Both ends of each choice are
// computed: SwiftShader's compiler takes minutes over branches here.
vec4 ground_on_line(Azimuth azimuth, int y, int step, int lanes, int steps) {
    int cell = y >> CELL_SHIFT;
    int lane_round = wrapped(cell, lanes);
    int lane_held = clamp(cell, 0, lanes - 1);
    int lane = BORDER == BORDER_PERIODIC ? lane_round : lane_held;
    int next_round = wrapped(lane + 1, lanes);
    int next_held = min(lane + 1, lanes - 1);
    int next = BORDER == BORDER_PERIODIC ? next_round : next_held;
    int step_round = wrapped(step, steps);
    int step_held = clamp(step, 0, steps - 1);
    int march = march_position(azimuth, BORDER == BORDER_PERIODIC ? step_round : step_held, steps);
    float t = float(y & (CELL - 1)) * (1.0 / float(CELL));
    vec4 a = ground_at(lane_position(azimuth, lane, lanes), march);
    vec4 b = ground_at(lane_position(azimuth, next, lanes), march);
    precise float rise = t * (b.w - a.w);
    precise float height = a.w + rise;
    return vec4(mix(a.rgb, b.rgb, t), height);
}

// Line blocks: 2, 4, … or 256 steps of a swept line, each from a multiple of its own length. A walk reads its own line
// step by step at first, and farther ground in blocks of at most a quarter of their distance, or 2 steps. A block has
// its largest height with its place, and the mean radiance of its ground. The mean weights each piece by its rise
// above all nearer ground of the block.

// Up to this distance a walk reads every step, with lines one cell apart; to as many times that as they are farther
// apart, because the nearest line may lie half of that beside.
int near_steps() {
    return 8 << max(LINE_SHIFT - CELL_SHIFT, 0);
}

// Blocks are at most 2^-SHARE_BITS of their distance long.
const int SHARE_BITS = 2;
// log2 of the longest block.
const int MOST_LEVEL = 8;
// Every piece has this rise in addition, over world distance.
const float FLAT_RISE = 1e-3;

struct Block {
    float top;
    int top_steps;  // from the end towards the grid point to the top, 1 to the block's length
    vec3 light;
};

// Lines of one azimuth that are on the field at a step, or less than a spacing beside it; all of a field that repeats.
int block_lines(int lanes) {
    return (((lanes - 1) * CELL) >> LINE_SHIFT) + 3;
}

// Which of them a line is.
int block_line(int line, int lead, int shear, int end) {
    return BORDER == BORDER_PERIODIC ? line : line - lead + 1 + ((end * shear) >> LINE_SHIFT);
}

// Where the block of 2^level steps that ends at a step is in the image: in the row of its middle, which is no other
// block's, as ends are multiples of the length.
ivec3 block_texel(int first_layer, int among_lines, int level, int end) {
    int row = end - (1 << (level - 1));
    return ivec3(among_lines & 31, row, first_layer + (among_lines >> 5));
}

// The place takes the low eight bits of the first channel, which is rounded to the rest. Grey blocks store no
// further channel.
uvec4 block_words(Block block) {
    uint first = ((floatBitsToUint(block.light.r) + 128u) & ~255u) | uint(block.top_steps - 1);
    return uvec4(floatBitsToUint(block.top), first, floatBitsToUint(block.light.gb));
}

Block block_of(uvec4 words) {
    vec3 light = uintBitsToFloat(uvec3(words.y & ~255u, words.zw));
    return Block(uintBitsToFloat(words.x), int(words.y & 255u) + 1, GREY ? light.rrr : light);
}
