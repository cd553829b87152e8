// Which samples an edit changes the light of: a bit each. A word is eight columns of four rows, so
// that four samples side by side along either axis lie in one.

int dirty_word(ivec2 at, int cols) {
    return (at.y >> 2) * ((cols + 7) >> 3) + (at.x >> 3);
}

uint dirty_bit(ivec2 at) {
    return 1u << uint((at.y & 3) * 8 + (at.x & 7));
}
