// What a sample sees in a direction, in one word: row << 16 | column of the sample nearest to what is met, or a
// value below. Of fields of at most 255 by 255 samples two directions share a word, the even one in the lower half:
// row << 8 | column, and the same values' lower halves.

const uint SEES_SKY = 0xffffffffu;     // nothing is met
const uint SEES_GROUND = 0xfffffffeu;  // the level, black ground beyond the field
const uint SEES_LOST = 0xfffffffdu;    // a ray that took more steps than there can be

// That of direction i out of its word.
uint point_of(uint word, int i, bool small) {
    uint half_word = (word >> (16 * (i & 1))) & 0xffffu;
    uint widened = half_word >= 0xfffdu ? 0xffff0000u | half_word : ((half_word >> 8) << 16) | (half_word & 0xffu);
    return small ? widened : word;
}

// And back.
uint word_of(uint point, int i, bool small) {
    uint narrowed = point >= SEES_LOST ? point & 0xffffu : ((point >> 16) << 8) | (point & 0xffu);
    return small ? narrowed << (16 * (i & 1)) : point;
}
