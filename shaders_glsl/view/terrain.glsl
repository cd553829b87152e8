// Push constants of a field's mesh: src/passes/view/terrain_draw.rs.
layout(push_constant) uniform TerrainDrawPush {
    // Columns of the matrix from (columns, rows, metres) relative to the origin to clip coordinates.
    vec4 clip_per_col;
    vec4 clip_per_row;
    vec4 clip_per_metre;
    vec4 clip_at_origin;
    int origin_col;
    int origin_row;
    float origin_m;
    int cols;
    int rows;
    int mesh_step;
    int tiles_across;
};
