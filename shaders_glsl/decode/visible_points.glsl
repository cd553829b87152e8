// visible_points.ktx2: layer k holds what samples see along direction k, which bake.json has. Rows count from the north, columns from the west;
// uv (0, 0) is the north-west corner. Nearest texels.

// Column and row of the sample that is seen; -1 the sky, -2 the ground beyond the field.
ivec2 visible_point(sampler2DArray map, vec2 uv, int k) {
    ivec2 size = textureSize(map, 0).xy;
    vec2 code = texelFetch(map, ivec3(clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1), k), 0).yx;
    return ivec2(65535.0 * code + 0.5) - 2;
}
