// Push constants of a field's mesh (src/passes/view/terrain_draw.rs) or, with PLINTH, of its plinth (plinth_draw.rs); and the
// picture positions of grid points, for both.

#ifdef PLINTH
layout(push_constant) uniform PlinthDrawPush {
#else
layout(push_constant) uniform TerrainDrawPush {
#endif
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
#ifdef PLINTH
    float base_m;
    float base_tone;
    // North, east, south, west. Tones are shares of the ground's mean luminance, negative on faces turned away.
    vec4 wall_tones;
#else
    int tiles_across;
#endif
};

// The picture position of a grid point at a height.
//
// Positions are integers and heights relative to an origin near the camera: exact close to it. Shaders that share edges
// declare gl_Position invariant, so that no gap opens between them.
vec4 picture_place(ivec2 place, float height_m) {
    vec2 away = vec2(place - ivec2(origin_col, origin_row));
    float rise = height_m - origin_m;
    return clip_at_origin + away.x * clip_per_col + away.y * clip_per_row + rise * clip_per_metre;
}
