// Grid points whose light an edit changes: a bitmap, and a list of its nonzero words. A word is eight columns of four
// rows, so that four grid points side by side along either axis share one.

// Passes over the list have this many workgroups per row of the dispatch; 65535 is the guaranteed limit.
const uint GROUPS_ACROSS = 1024u;
// Words per shading workgroup: 16 × 8 fours of grid points. Per resolving workgroup: 8 × 8 grid points.
const uint LIGHT_GROUP_WORDS = 16u;
const uint RESOLVE_GROUP_WORDS = 2u;

int dirty_word(ivec2 at, int cols) {
    return (at.y >> 2) * ((cols + 7) >> 3) + (at.x >> 3);
}

uint dirty_bit(ivec2 at) {
    return 1u << uint((at.y & 3) * 8 + (at.x & 7));
}

// Column and row of a word's first grid point.
ivec2 word_corner(uint word, int cols) {
    uint across = uint((cols + 7) >> 3);
    return ivec2(word % across * 8u, word / across * 4u);
}
