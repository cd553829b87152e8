// visible_points.ktx2: layer k holds what samples see along direction k, which bake.json has. Rows count from the north, columns from the west;
// uv (0, 0) is the north-west corner. Nearest texels.

// Column and row of the sample that is seen; -1 the sky, -2 the ground beyond the field.
ivec2 visible_point(sampler2DArray map, vec2 uv, int k) {
    ivec2 size = textureSize(map, 0).xy;
    vec2 code = texelFetch(map, ivec3(clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), k), 0).yx;
    return ivec2(65535.0 * code + 0.5) - 2;
}

// How much of a light arrives, 0 to 1: `corners` are three directions around it, of a triangle of the net of all, and `shares`
// how near it lies to each, 1 together.
float visible_share(sampler2DArray map, vec2 uv, ivec3 corners, vec3 shares) {
    float sum = 0.0;
    for (int c = 0; c < 3; c++) {
        sum += visible_point(map, uv, corners[c]).x == -1 ? shares[c] : 0.0;
    }
    return sum;
}
