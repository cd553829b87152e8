// brdf_harmonics.ktx2: texel (j, i) is the weight of harmonic i of the light times harmonic j of the view. Real
// orthonormal harmonics with x east, y north, z up, without the Condon-Shortley phase; index l(l+1) + m.

// All harmonics of a unit vector: of each m those of l = m, m + 1, … by the recurrence of associated Legendre functions.
void brdf_harmonics(vec3 e, out float y[BRDF_TERMS]) {
    vec2 turn = vec2(0.282094792, 0.0);
    for (int m = 0; m < BRDF_ORDER; m++) {
        vec3 p = vec3(m == 0 ? 1.0 : sqrt(2.0), 0.0, 0.0);  // of l, of l - 1, what divides that of l
        for (int l = m; l < BRDF_ORDER; l++) {
            y[l * (l + 1) - m] = p.x * turn.y;
            y[l * (l + 1) + m] = p.x * turn.x;
            float next = sqrt(float((l + 1) * (l + 1) - m * m) / float(4 * (l + 1) * (l + 1) - 1));
            p = vec3((e.z * p.x - p.z * p.y) / next, p.x, next);
        }
        turn = sqrt(float(2 * m + 3) / float(2 * m + 2)) * vec2(turn.x * e.x - turn.y * e.y, turn.x * e.y + turn.y * e.x);
    }
}

// Radiance towards the view over the irradiance of a horizontal plane by the light, 1/sr; ringing can make it
// negative.
vec3 brdf_of_harmonics(sampler2D map, float light[BRDF_TERMS], float view[BRDF_TERMS]) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < BRDF_TERMS * BRDF_TERMS; k++) {
        sum += light[k / BRDF_TERMS] * view[k % BRDF_TERMS] * texelFetch(map, ivec2(k % BRDF_TERMS, k / BRDF_TERMS), 0).rgb;
    }
    return sum;
}
