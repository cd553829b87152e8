// Value of a Phong lobe of unit integral, (n + 1) / (2 pi) cos^n of the angle to its axis, in a direction that
// differs by `apart` from the axis; both are unit vectors.
//
// The built-in power has an error of 1e-3 at exponents of 1e4. 1 - cos from the difference stays exact near the axis,
// and ln(1 - m) = -2 atanh(m / (2 - m)), a series to 1e-7 up to m = 1/2.
float phong_lobe(vec3 apart, float n) {
    float m = 0.5 * dot(apart, apart);
    float z = m / (2.0 - m);
    float s = z * z;
    float series = 1.0 + s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0 + s * (1.0 / 11.0 + s / 13.0)))));
    float power = n * (m < 0.5 ? -2.0 * z * series : log(max(1.0 - m, 1e-30)));
    return m < 1.0 ? (n + 1.0) / (2.0 * PI) * exp(power) : 0.0;
}
