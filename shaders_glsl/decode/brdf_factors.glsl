// brdf_factors.ktx2: layer k is a function of the light's direction, layer BRDF_VIEWS + k one of the view's; both are
// the same where BRDF_VIEWS is 0. Texel (j, i) has φ = 2π j / BRDF_PHIS counter-clockwise from east and θ = (i + ½)
// π/2 / BRDF_THETAS from vertical. Linear between the angles. A direction is (θ, φ), radians.

vec3 brdf_factor(sampler2DArray map, int k, vec2 e) {
    vec2 size = vec2(BRDF_PHIS, BRDF_THETAS);
    vec2 place = e.yx * size * vec2(0.159154943, 0.636619772) - vec2(0.0, 0.5);
    place.y = clamp(place.y, 0.0, size.y - 1.0);
    vec2 low = floor(place);
    vec2 next = vec2(mod(low.x + 1.5, size.x), min(low.y + 1.0, size.y - 1.0));
    ivec4 at = ivec4(mod(low.x + 0.5, size.x), low.y, next);
    vec3 north = mix(texelFetch(map, ivec3(at.xy, k), 0).rgb, texelFetch(map, ivec3(at.zy, k), 0).rgb, place.x - low.x);
    vec3 south = mix(texelFetch(map, ivec3(at.xw, k), 0).rgb, texelFetch(map, ivec3(at.zw, k), 0).rgb, place.x - low.x);
    return mix(north, south, place.y - low.y);
}

// Radiance towards a view over the irradiance, cos θ, of a plane by a light, 1/sr.
vec3 brdf_of_factors(sampler2DArray map, vec2 light, vec2 view) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < BRDF_FACTORS; k++) {
        sum += brdf_factor(map, k, light) * brdf_factor(map, BRDF_VIEWS + k, view);
    }
    return sum;
}
