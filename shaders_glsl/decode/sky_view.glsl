// sky_view.ktx2: sky view factor, the unoccluded cosine-weighted fraction of the hemisphere about the normal. Exit
// radiance of diffuse ground under a uniform sky: albedo * sky_radiance * sky_view(map, uv). uv (0, 0) is the
// north-west corner.
float sky_view(sampler2D map, vec2 uv) {
    return texture(map, uv).r;
}
