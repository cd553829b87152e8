// Light leaks over ridges from nodes off a grid point's plane, or where it is off theirs. A node has half weight
// where the two together deviate by a quarter of their distance. Fitted: best or within 2 % of it among 0.05, 0.1,
// 0.25, 0.5 and 1 on two elevation models; bilinear weights alone have a 15 to 31 % larger error. To fit it again,
// change it here and in the CPU reference, and run `cargo measure soft`.
const float OFF_PLANE = 0.25;

// Weight of one point (height, slopes towards east and north) for four others (`h`, `east`, `north`), or of them for
// it; offsets towards east and north are from them to it.
vec4 alike(vec4 one, vec4 h, vec4 east, vec4 north, vec4 east_m, vec4 north_m, float cell_m) {
    vec4 rise = one.x - h;
    vec4 off = abs(rise - (east * east_m + north * north_m)) + abs(rise - (one.y * east_m + one.z * north_m));
    // A grid point coincides with its own node: at least 0.
    vec4 distance2 = max(east_m * east_m + north_m * north_m, vec4(cell_m * cell_m));
    return 1.0 / (1.0 + off * off / (OFF_PLANE * OFF_PLANE * distance2));
}
