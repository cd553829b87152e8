// sh_transfer.ktx2: ∫ V max(N·e, 0) Y de / π. Real orthonormal harmonics with x east, y north, z up, without the
// Condon-Shortley phase; index l(l+1) + m. uv (0, 0) is the north-west corner.

// Exit radiance of white diffuse ground under light given as SH coefficients; multiply by albedo for other ground.
vec3 sh_transfer(sampler2DArray map, vec2 uv, vec3 light[SH_COUNT]) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < SH_COUNT; i++) {
        sum += light[i] * texture(map, vec3(uv, float(i / 4)))[i % 4];
    }
    return sum;
}
