// The visible point of a grid point in a direction, as one word: row << 16 | column of the grid point nearest to the
// hit, or one of the values below. Fields of at most 255 by 255 grid points pack two directions per word, the even one
// in the lower half: row << 8 | column, and the lower halves of the same values.

const uint POINT_SKY = 0xffffffffu;     // no hit
const uint POINT_GROUND = 0xfffffffeu;  // hit on the level black ground beyond the field
const uint POINT_LOST = 0xfffffffdu;    // the ray exceeded the step limit

// Value of direction i in its word.
uint point_of(uint word, int i, bool small) {
    uint half_word = (word >> (16 * (i & 1))) & 0xffffu;
    uint widened = half_word >= 0xfffdu ? 0xffff0000u | half_word : ((half_word >> 8) << 16) | (half_word & 0xffu);
    return small ? widened : word;
}

// Inverse of the above.
uint word_of(uint point, int i, bool small) {
    uint narrowed = point >= POINT_LOST ? point & 0xffffu : ((point >> 16) << 8) | (point & 0xffu);
    return small ? narrowed << (16 * (i & 1)) : point;
}
