// visible_sky.ktx2: the unoccluded fraction of the upper hemisphere's solid angle, independent of the normal.
// uv (0, 0) is the north-west corner.
float visible_sky(sampler2D map, vec2 uv) {
    return texture(map, uv).r;
}
