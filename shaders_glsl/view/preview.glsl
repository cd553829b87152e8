// The slopes of a grid of heights, for previews. The including shader declares `heights`.

float height_at(ivec2 at) {
    return texelFetch(heights, at, 0).x;
}

// Upward. Central differences; one-sided at the edge.
vec3 normal_at(ivec2 at, ivec2 last, vec2 cell_m) {
    ivec2 before = max(at - 1, ivec2(0));
    ivec2 after = min(at + 1, last);
    float east = height_at(ivec2(after.x, at.y)) - height_at(ivec2(before.x, at.y));
    float south = height_at(ivec2(at.x, after.y)) - height_at(ivec2(at.x, before.y));
    vec2 apart = max(vec2(after - before), vec2(1.0)) * cell_m;
    return normalize(vec3(-east / apart.x, south / apart.y, 1.0));
}
