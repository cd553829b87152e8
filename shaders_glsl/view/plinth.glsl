// Push constants of a field's plinth: src/passes/view/plinth_draw.rs.
layout(push_constant) uniform PlinthDrawPush {
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
    float base_m;
    float base_tone;
    // North, east, south, west. Tones are shares of the ground's mean luminance, negative on faces turned away.
    vec4 wall_tones;
};
