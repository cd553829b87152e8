// A Phong lobe of unit integral, (n + 1) / (2 pi) max(0, e.m)^n about m, in the vertical slice of one azimuth phi.
//
// With A = m.x cos phi + m.y sin phi and B = m.z, a direction of elevation w in the slice has e.m = A cos w + B sin w =
// a cos(w - w0): the lobe peaks at the elevation w0, scaled by a^n, a^2 = A^2 + B^2 = 1 - p^2, p = m.x sin phi - m.y cos phi.

// -ln(rest) for m = 1 - rest in [0, 1]: 2 atanh(m / (2 - m)), a series to 1e-7 up to 1/2.
vec4 minus_log(vec4 m, vec4 rest) {
    vec4 z = m / (2.0 - m);
    vec4 s = z * z;
    vec4 series = 1.0 + s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0 + s * (1.0 / 11.0 + s / 13.0)))));
    return mix(2.0 * z * series, -log(max(rest, 1e-30)), greaterThan(m, vec4(0.5)));
}

// Angle of (x, y), -pi to pi.
vec4 angle_of(vec4 x, vec4 y) {
    vec4 angle = arc_tangent(abs(y) / max(abs(x), 1e-30));
    angle = mix(angle, PI - angle, lessThan(x, vec4(0.0)));
    return mix(angle, -angle, lessThan(y, vec4(0.0)));
}

// a^n, for `across` = p and `within` = a^2.
vec4 off_slice(vec4 n, vec4 across, vec4 within) {
    return exp(-0.5 * n * minus_log(min(across * across, vec4(1.0)), within));
}

// Integral of cos^(n + 1) from 0 to u, for s = sin u and y2 = -ln cos^2 u. With q = n + 3/2 and y^2 = y2 it is
// sqrt(pi / 2q) (1 - 1 / 16 q^2) erf(y sqrt(q / 2)) + exp(-q y2 / 2) y (y2 + 3 / q) / (48 q), to an order of q^-3.
// Below n = 5 from n + 4, by two steps of the recursion of cos^n. The error function: Abramowitz & Stegun 7.1.26.
vec4 cosine_integral(float n, vec4 s, vec4 y2) {
    bool steps_down = n < 5.0;
    float q = (steps_down ? n + 4.0 : n) + 1.5;
    vec4 y = sqrt(y2);
    vec4 e = exp(-0.5 * q * y2);
    vec4 t = 1.0 / (1.0 + 0.3275911 * sqrt(0.5 * q) * y);
    vec4 erf = 1.0 - e * t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    vec4 c = sqrt(0.5 * PI / q) * (1.0 - 1.0 / (16.0 * q * q)) * erf + e * y * (y2 + 3.0 / q) / (48.0 * q);
    c = mix(c, -c, lessThan(s, vec4(0.0)));
    if (steps_down) {
        c = ((n + 5.0) * c - exp(-0.5 * (n + 4.0) * y2) * s) / (n + 4.0);
        c = ((n + 3.0) * c - exp(-0.5 * (n + 2.0) * y2) * s) / (n + 2.0);
    }
    return c;
}

// Antiderivative over elevation w of (n + 1) / (2 pi) max(0, e.m)^n cos w, for A^2 + B^2 = 1.
vec4 phong_integral(float n, vec4 along, vec4 up, vec4 cos_w, vec4 sin_w) {
    vec4 c = along * cos_w + up * sin_w;
    vec4 s = along * sin_w - up * cos_w;
    // A right angle or more from the peak: the lobe has not begun where it peaks above horizontal, and has ended where it peaks
    // below. A lobe that peaks at the horizontal begins straight down and ends straight up.
    vec4 end = mix(vec4(1.0), vec4(-1.0), greaterThan(up, vec4(0.0)));
    vec4 level_end = mix(vec4(1.0), vec4(-1.0), lessThan(sin_w, vec4(0.0)));
    level_end = mix(vec4(-1.0), level_end, greaterThan(along, vec4(0.0)));
    end = mix(end, level_end, equal(up, vec4(0.0)));
    s = mix(s, end, lessThanEqual(c, vec4(0.0)));
    // Takes cos^2 directly: near the lobe's end, 1 - sin^2 cancels to rounding error.
    c = max(c, 0.0);
    vec4 y2 = minus_log(min(s * s, vec4(1.0)), c * c);
    vec4 power = exp(-0.5 * (n + 1.0) * y2);
    return (1.0 / (2.0 * PI)) * ((n + 1.0) * along * cosine_integral(n, s, y2) + up * power);
}
