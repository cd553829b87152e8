// Where a place of a flat field stands once the field lies on a base of two principal curvatures (1/m, towards east and
// north, above 0 where the base bends down), as seen from one of its samples.
//
// The base rolls along the straight way o to the place: over it, its frame turns evenly by w = (k_x o_x, k_y o_y) about the
// horizontal axis across w. The way's part across w stays as long as it is, that along w becomes an arc, and the height stands
// on the end's normal. Of a cylinder along an axis and of a sphere that is exact (a way is a geodesic there); of others to
// second order in the way.

// No way turns the frame by more than a right angle here.
const float MOST_TURN = 1.57079632679490;

// Series of (1 - cos v)/v^2 and (sin v / v - 1)/v^2 of s = v^2 up to (pi/2)^2: what is left out is below 1e-8.
vec2 arc_parts(float s) {
    float fall = 0.5 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0 * (1.0 - s / 132.0)))));
    float less = -1.0 / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0)))));
    return vec2(fall, less);
}

// Towards what stands `away` m off along e on the flat field, from a sample at height `own`: a unit vector in the sample's
// own frame. A way that would turn further is taken as far as MOST_TURN.
vec3 bent_direction(vec3 e, float away, float own, vec2 curvature) {
    vec2 turn = curvature * e.xy;  // of a metre of the way
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
