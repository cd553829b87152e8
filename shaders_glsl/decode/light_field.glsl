// light_field.ktx2: layer k · LIGHT_FIELD_PHIS + j is the view from θ = (k + ½) π/2 / LIGHT_FIELD_THETAS from
// vertical and φ = 2π j / LIGHT_FIELD_PHIS counter-clockwise from east. RGB is radiance. A is the texel's visible
// area in the view over that of its cell, 0 where it is hidden. uv (0, 0) is the north-west corner.

// The layer of the view nearest to (θ, φ), radians.
int light_field_view(vec2 view) {
    int theta = min(int(view.x * 0.636619772 * float(LIGHT_FIELD_THETAS)), LIGHT_FIELD_THETAS - 1);
    return theta * LIGHT_FIELD_PHIS + int(fract(view.y * 0.159154943) * float(LIGHT_FIELD_PHIS) + 0.5) % LIGHT_FIELD_PHIS;
}

vec4 light_field(sampler2DArray map, vec2 uv, vec2 view) {
    return texture(map, vec3(uv, float(light_field_view(view))));
}
