// Rounds to f16 explicitly: packHalf2x16 may round either way and may flush numbers below 2^-14 to 0. Its inputs here
// are exact in f16, so all drivers store the same bits.

// The nearest f16 to x, ties to even, for |x| up to 65504; 0 below 2^-14.
float nearest_f16(float x) {
    uint bits = floatBitsToUint(x);
    uint rounded = (bits + 0xfffu + (bits >> 13 & 1u)) & ~0x1fffu;
    return (bits & 0x7fffffffu) < 0x38800000u ? 0.0 : uintBitsToFloat(rounded);
}

uint packed_f16(vec2 both) {
    return packHalf2x16(vec2(nearest_f16(both.x), nearest_f16(both.y)));
}
