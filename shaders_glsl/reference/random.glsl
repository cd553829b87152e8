// Random numbers that are a function of where they are used: no state, no order.

// Four words mixed (Jarzynski & Olano 2020, "Hash functions for GPU rendering", pcg4d).
uvec4 mixed(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Words for a grid point. Mixed once, those of neighbouring grid points stay slightly correlated: over 200 seeds the
// standard deviation of an image mean is 1.1 times that of independent samples; mixed twice, 0.93 times (each ±
// 0.05).
uvec4 words_of(uvec4 place) {
    return mixed(mixed(place).yzwx);
}

// A random permutation of words in which each bit is flipped by lower bits only (Laine & Karras 2011 with the
// constants of Vegdahl 2021): an Owen scramble of bit-reversed fractions.
uint nested(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Point of an Owen-scrambled Sobol' net of 2^bits points in [0, 1)^2 (bits up to 8; Burley 2020, "Practical
// hash-based Owen scrambling"): the one whose first coordinate lies in interval `order` of 2^bits. Each point is
// uniform; sets of other words are independent of it.
vec2 net_point(uint order, uint bits, uvec4 words) {
    uint reversed = bitfieldReverse(order << (32u - bits));
    uint mask = (1u << bits) - 1u;
    uint i = nested(reversed, words.x) & mask;
    uint x = (nested(i, words.w) & ~mask) | reversed;
    // The second dimension, bit-reversed: Pascal's triangle modulo 2 as a matrix.
    uint y = i ^ ((i & 0xaau) >> 1u);
    y ^= (y & 0xccu) >> 2u;
    y ^= (y & 0xf0u) >> 4u;
    y = nested(y, words.y);
    return vec2(bitfieldReverse(x) >> 8u, bitfieldReverse(y) >> 8u) * (1.0 / 16777216.0);
}

// Position of `order` in a shuffled row of 2^bits.
uint shuffled(uint order, uint bits, uint word) {
    return nested(bitfieldReverse(order << (32u - bits)), word) & ((1u << bits) - 1u);
}

// (cos, sin) of `turn` turns, 0 .. 1. Drivers may have an error of 2^-11 (Vulkan's bound); Taylor's series over an
// eighth of a turn has 2e-9.
vec2 on_circle(float turn) {
    float quarter = floor(4.0 * turn + 0.5);
    float x = (turn - 0.25 * quarter) * 6.28318530717959;
    float y = x * x;
    float s = x * (1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0))));
    float c = 1.0 - y / 2.0 * (1.0 - y / 12.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0)));
    int q = int(quarter) & 3;
    vec2 turned = (q & 1) == 0 ? vec2(c, s) : vec2(-s, c);
    return (q & 2) == 0 ? turned : -turned;
}

// The direction at `up` = 1 - cos of the angle to a unit vector, `turn` turns around it (basis of Duff et
// al. 2017, "Building an orthonormal basis, revisited").
vec3 direction_about(vec3 axis, float up, float turn) {
    float side = axis.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + axis.z);
    float b = axis.x * axis.y * a;
    vec3 u = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    vec3 v = vec3(b, side + axis.y * axis.y * a, -axis.y);
    vec2 round = on_circle(turn) * sqrt(max(up * (2.0 - up), 0.0));
    return normalize(round.x * u + round.y * v + (1.0 - up) * axis);
}
