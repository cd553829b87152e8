// The picture position of a grid point at a height. Includers declare push constants with the matrix and its origin.
//
// Positions are integers and heights relative to an origin near the camera: exact close to it. Shaders that share edges
// declare gl_Position invariant, so that no gap opens between them.
vec4 picture_place(ivec2 place, float height_m) {
    vec2 away = vec2(place - ivec2(origin_col, origin_row));
    float rise = height_m - origin_m;
    return clip_at_origin + away.x * clip_per_col + away.y * clip_per_row + rise * clip_per_metre;
}
