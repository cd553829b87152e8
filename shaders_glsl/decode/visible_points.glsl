// visible_points.ktx2: layer k holds the grid point visible along direction k, which manifest.json lists. Rows count from
// the north, columns from the west; uv (0, 0) is the north-west corner. Use nearest texels.

// Column and row of the visible grid point; -1 sky, -2 ground beyond the field.
ivec2 visible_point(sampler2DArray map, vec2 uv, int k) {
    ivec2 size = textureSize(map, 0).xy;
    vec2 code = texelFetch(map, ivec3(clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), k), 0).yx;
    return ivec2(65535.0 * code + 0.5) - 2;
}

// Visibility of a light, 0 to 1: `corners` are the three directions of the triangle around it, `shares` its
// barycentric weights.
float visible_share(sampler2DArray map, vec2 uv, ivec3 corners, vec3 shares) {
    float sum = 0.0;
    for (int c = 0; c < 3; c++) {
        sum += visible_point(map, uv, corners[c]).x == -1 ? shares[c] : 0.0;
    }
    return sum;
}
