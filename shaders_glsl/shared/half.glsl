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

// The nearest f16 to each component, as bits. Includes subnormals (below 2^-14), which packHalf2x16 may flush to 0.
uvec4 f16_bits(vec4 x) {
    uvec4 bits = floatBitsToUint(x);
    uvec4 rounded = bits + 0xfffu + (bits >> 13 & 1u);
    uvec4 normal = (rounded >> 13) - (112u << 10) & 0x7fffu;
    uvec4 small = uvec4(roundEven(min(abs(x), 1.0) * 16777216.0));
    return mix(normal, small, lessThan(abs(x), vec4(6.103515625e-5))) | bits >> 16 & 0x8000u;
}

vec4 f16_from_bits(uvec4 bits) {
    vec4 normal = uintBitsToFloat((bits & 0x7fffu) + (112u << 10) << 13);
    vec4 small = vec4(bits & 0x3ffu) * (1.0 / 16777216.0);
    vec4 size = mix(normal, small, equal(bits & 0x7c00u, uvec4(0)));
    return mix(size, -size, notEqual(bits & 0x8000u, uvec4(0)));
}
