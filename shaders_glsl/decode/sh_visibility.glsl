// sh_visibility.ktx2: ∫ V Y de over the sphere, V = 1 above the horizon. Real orthonormal harmonics with x east, y
// north, z up, without the Condon-Shortley phase; index l(l+1) + m. uv (0, 0) is the north-west corner.

// Integral over the visible directions of a function given as SH coefficients.
vec3 sh_visibility(sampler2DArray map, vec2 uv, vec3 coefficients[SH_COUNT]) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < SH_COUNT; i++) {
        sum += coefficients[i] * texture(map, vec3(uv, float(i / 4)))[i % 4];
    }
    return sum;
}
