// Irradiance of one azimuth's slice on a diffuse surface, in closed form. Directions of the slice are (cosine, sine)
// of their elevation. Needs angle.glsl.

// N·e = flat_part cos(omega) + up sin(omega).
struct Facing {
    float flat_part;
    float up;
};

float facing_of(Facing f, vec2 direction) {
    return f.flat_part * direction.x + f.up * direction.y;
}

vec2 direction_of(float slope) {
    return vec2(1.0, slope) * inversesqrt(1.0 + slope * slope);
}

// Half of the angle between two directions at most a right angle from horizontal; exact for small angles.
float half_width(vec2 low, vec2 high) {
    vec2 sum = low + high;
    vec2 difference = high - low;
    return arc_tangent(vec4(sqrt(dot(difference, difference) / max(dot(sum, sum), 1e-20)))).x;
}

// Integral over elevations between two directions of (A cos + B sin) cos, with A, B the normal's parts, D = high -
// low and S = high + low:  A/2 (D + cos S sin D) + B/2 sin S sin D.
float light_between(Facing f, vec2 low, vec2 high) {
    float width = 2.0 * half_width(low, high);
    float sine_of = low.x * high.y - low.y * high.x;
    vec2 together = vec2(low.x * high.x - low.y * high.y, low.x * high.y + low.y * high.x);
    return 0.5 * (f.flat_part * (width + together.x * sine_of) + f.up * together.y * sine_of);
}
