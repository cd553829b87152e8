#include "shared/conventions.glsl"

// Arc tangent to 1.2e-7 rad: Abramowitz & Stegun 4.4.49 on [0, 1], atan(x) = pi/2 - atan(1/x) beyond. The built-in
// may have an error of 4096 ULP.
vec4 arc_tangent(vec4 x) {
    vec4 a = abs(x);
    vec4 z = min(a, 1.0) / max(a, 1.0);
    vec4 s = z * z;
    vec4 p = vec4(0.0028662257);
    p = p * s - 0.0161657367;
    p = p * s + 0.0429096138;
    p = p * s - 0.0752896400;
    p = p * s + 0.1065626393;
    p = p * s - 0.1420889944;
    p = p * s + 0.1999355085;
    p = p * s - 0.3333314528;
    p = z + z * s * p;
    p = mix(p, HALF_PI - p, greaterThan(a, vec4(1.0)));
    return mix(p, -p, lessThan(x, vec4(0.0)));
}

// Integrals over elevation from the one of this slope to the zenith, of cos^2 (x) and of sin cos (y): contribution of
// a slice of the sky to the horizontal and the vertical component of a normal (Timonen & Westerholm 2010, eq. 5, with
// elevation instead of zenith angle).
//   int cos^2 = pi/4 - omega/2 - sin(omega) cos(omega)/2,   int sin cos = cos(omega)^2 / 2.
struct Moments {
    vec4 flat_part;
    vec4 vertical;
};

Moments elevation_moments(vec4 slope) {
    vec4 cos2 = 1.0 / (1.0 + slope * slope);
    return Moments(0.25 * PI - 0.5 * arc_tangent(slope) - 0.5 * slope * cos2, 0.5 * cos2);
}

// Sine on [-pi/2, pi/2] to 6e-8: Taylor to the 11th power. The built-in may have an error of 2^-11.
float sine(float x) {
    float s = x * x;
    return x * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362880.0 - s / 39916800.0)))));
}

// Cosine on [-pi/2, pi/2].
float cosine(float x) {
    return sine(HALF_PI - abs(x));
}

// Tangent on (-pi/2, pi/2), to a relative 3e-8 on [0, pi/4] (Abramowitz & Stegun 4.3.101), the reciprocal of its
// complement beyond. The built-in may have an error of 2^-11 in its sine and cosine.
float tangent(float x) {
    float a = abs(x);
    float complement = max(HALF_PI - a, 1e-9);
    bool steep = a > 0.25 * PI;
    float z = steep ? complement : a;
    float s = z * z;
    float p = 0.0095168091;
    p = p * s + 0.0029005250;
    p = p * s + 0.0245650893;
    p = p * s + 0.0533740603;
    p = p * s + 0.1333923995;
    p = p * s + 0.3333314036;
    p = z + z * s * p;
    float inverse = 1.0 / p;
    float t = steep ? inverse : p;
    return x < 0.0 ? -t : t;
}
