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

// Point `index` of the 2^bits points of a Hammersley set, in [0, 1)². `words` shift the set around the
// torus (Cranley & Patterson 1976), so that every point is uniform by itself, and put its points in an
// order of its own, so that sets of other words are independent of it.
vec2 set_point(uint index, uint bits, uvec4 words) {
    uint i = (index * (words.z | 1u) ^ words.w) & ((1u << bits) - 1u);
    uvec2 at = uvec2(i << (32u - bits), bitfieldReverse(i)) + words.xy;
    return vec2(at >> 8) * (1.0 / 16777216.0);
}

// (cos, sin) of `turn` turns, 0 .. 1. Drivers may be off by 2^-11 (Vulkan's bound); Taylor's series
// over an eighth of a turn by 2e-9.
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
