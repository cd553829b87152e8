// btf.ktx2: layer l · (BTF_THETAS · BTF_PHIS) + v is for light l and view v, direction k · BTF_PHIS + j of θ = (k +
// ½) π/2 / BTF_THETAS from vertical and φ = 2π j / BTF_PHIS counter-clockwise from east. RGB is radiance under
// irradiance 1 facing the light. A is the texel's visible area in the view over that of its cell, 0 where it is
// hidden. uv (0, 0) is the north-west corner.

// The direction nearest to (θ, φ), radians.
int btf_direction(vec2 e) {
    int theta = min(int(e.x * 0.636619772 * float(BTF_THETAS)), BTF_THETAS - 1);
    return theta * BTF_PHIS + int(fract(e.y * 0.159154943) * float(BTF_PHIS) + 0.5) % BTF_PHIS;
}

vec4 btf(sampler2DArray map, vec2 uv, vec2 light, vec2 view) {
    int layer = btf_direction(light) * BTF_THETAS * BTF_PHIS + btf_direction(view);
    return texture(map, vec3(uv, float(layer)));
}
