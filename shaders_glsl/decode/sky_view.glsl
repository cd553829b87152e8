// sky_view.ktx2: the cosine-weighted share of the hemisphere about the normal that is free.
// Light of a uniform sky on diffuse ground: albedo * sky_radiance * sky_view(map, uv). uv (0, 0) is the north-west corner.
float sky_view(sampler2D map, vec2 uv) {
    return texture(map, uv).r;
}
