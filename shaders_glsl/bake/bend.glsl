// Direction towards a point of a flat field after the field is bent over a curved base surface, from one of its grid
// points. The base has two principal curvatures (1/m, towards east and north, positive where it bends down).
//
// The base rolls along the straight path o to the point: its frame turns evenly by w = (k_x o_x, k_y o_y) about the
// horizontal axis across w. The part of the path across w keeps its length, the part along w becomes an arc, and the
// height stands on the normal at the end. This is exact for a cylinder along an axis and for a sphere, where the path
// is a geodesic. Elsewhere it is exact to second order in the path.

// The frame turns by at most a right angle.
const float MOST_TURN = 1.57079632679490;

// Series of (1 - cos v)/v^2 and (sin v / v - 1)/v^2 in s = v^2, up to (pi/2)^2: truncation error below 1e-8.
vec2 arc_parts(float s) {
    float fall = 0.5 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0 * (1.0 - s / 132.0)))));
    float less = -1.0 / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0)))));
    return vec2(fall, less);
}

// Unit vector, in the frame of a grid point at height `own`, towards the point `away` m along e on the flat field.
// Paths that turn further than MOST_TURN are clamped to it.
vec3 bent_direction(vec3 e, float away, float own, vec2 curvature) {
    vec2 turn = curvature * e.xy;  // per metre of path
    float rate = dot(turn, turn);
    bool is_far = away * away * rate > MOST_TURN * MOST_TURN;
    float t = is_far ? MOST_TURN * inversesqrt(rate) : away;
    float s = min(t * t * rate, MOST_TURN * MOST_TURN);
    vec2 parts = arc_parts(s);
    float height = own + t * e.z;
    float along = dot(e.xy, turn);
    vec2 across = turn * (t * t * along * parts.y + height * (1.0 + s * parts.y));
    return normalize(e + vec3(across, -t * (along + height * rate) * parts.x));
}
