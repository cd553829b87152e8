// Which samples an edit changes the light of: a map of a bit each, and a list of the words of the map
// in which any is set. A word is eight columns of four rows, so that four samples side by side along
// either axis lie in one.

// Passes over the list have this many workgroups across, then another row: 65535 may be the most.
const uint GROUPS_ACROSS = 1024u;
// Words that a workgroup lights: 16 × 8 fours of samples. And resolves: 8 × 8 samples.
const uint LIGHT_GROUP_WORDS = 16u;
const uint RESOLVE_GROUP_WORDS = 2u;

int dirty_word(ivec2 at, int cols) {
    return (at.y >> 2) * ((cols + 7) >> 3) + (at.x >> 3);
}

uint dirty_bit(ivec2 at) {
    return 1u << uint((at.y & 3) * 8 + (at.x & 7));
}

// Column and row of a word's first sample.
ivec2 word_corner(uint word, int cols) {
    uint across = uint((cols + 7) >> 3);
    return ivec2(word % across * 8u, word / across * 4u);
}
