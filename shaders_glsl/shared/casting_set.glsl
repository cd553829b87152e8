// A stretch of surface that a node sees: where it is in the mean, as column and row in halves of a word, and its weight.
// The last of an azimuth's, where slots are left, is none.

const uint CASTS_END = 0xffffffffu;

uvec2 cast_of(ivec2 place, float weight) {
    return uvec2(uint(place.x) | uint(place.y) << 16, floatBitsToUint(weight));
}

ivec2 cast_place(uvec2 kept) {
    return ivec2(kept.x & 0xffffu, kept.x >> 16);
}
