// brdf.ktx2: texel (v, l) is for view v and light l, direction k · BRDF_PHIS + j of θ = (k + ½) π/2 / BRDF_THETAS
// from vertical and φ = 2π j / BRDF_PHIS counter-clockwise from east. Linear between the angles.

// Radiance towards a view over the irradiance of a horizontal plane by a light, which includes cos θ, 1/sr; each is
// (θ, φ), radians.
vec3 brdf(sampler2D map, vec2 light, vec2 view) {
    vec2 size = vec2(BRDF_THETAS, BRDF_PHIS);
    vec4 place = vec4(light, view) * size.xyxy * vec2(0.636619772, 0.159154943).xyxy - vec2(0.5, 0.0).xyxy;
    place.xz = clamp(place.xz, 0.0, size.x - 1.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 16; i++) {
        vec4 corner = floor(place) + vec4(i & 1, i >> 1 & 1, i >> 2 & 1, i >> 3);
        vec4 share = max(1.0 - abs(place - corner), 0.0);
        corner = vec4(min(corner.x, size.x - 1.0), mod(corner.y + 0.5, size.y), min(corner.z, size.x - 1.0), mod(corner.w + 0.5, size.y));
        ivec2 at = ivec2(corner.zx) * BRDF_PHIS + ivec2(corner.wy);
        sum += share.x * share.y * share.z * share.w * texelFetch(map, at, 0).rgb;
    }
    return sum;
}
