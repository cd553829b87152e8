const uint SHAPE_DISC = 0u;   // the part of each chord above the horizon
const uint SHAPE_POINT = 1u;  // lit or not
const uint SHAPE_PATCH = 2u;  // the part of its elevations above the horizon, over each wedge

// Light of a sun's chord, or of a key light's wedge, above `lowest`: the slope of the lowest direction that is not hidden. 0
// where all of it is hidden. `east`, `north` and `up` are the normal.
vec4 sun_light(Azimuth azimuth, vec4 east, vec4 north, vec4 up, vec4 lowest, uint shape) {
    vec4 flat_part = east * azimuth.cos_phi + north * azimuth.sin_phi;
    vec4 vertical = up;
    if (shape == SHAPE_PATCH) {
        flat_part = east * azimuth.wedge_cos + north * azimuth.wedge_sin;
        vertical = up * azimuth.wedge_rad;
    }
    vec4 light;
    if (shape == SHAPE_POINT) {
        float cos_elevation = inversesqrt(1.0 + azimuth.high_slope * azimuth.high_slope);
        light = max((flat_part + vertical * azimuth.high_slope) * cos_elevation, 0.0);
    } else {
        Moments above = elevation_moments(max(lowest, azimuth.low_slope));
        Moments top = elevation_moments(vec4(azimuth.high_slope));
        light = flat_part * (above.flat_part - top.flat_part) + vertical * (above.vertical - top.vertical);
    }
    bvec4 lit = lessThan(lowest, vec4(azimuth.high_slope));
    return mix(vec4(0.0), light * azimuth.weight * (1.0 / PI), lit);
}

// Adds the part of a sun's chord above `lowest` to the light vectors of four grid points: directions times irradiance (Gershun 1939).
// For a wholly visible sun of irradiance 1 the sum is the unit vector towards the sun.
void add_vector(inout vec4 east, inout vec4 north, inout vec4 up, Azimuth azimuth, vec4 lowest, bvec4 lit) {
    Moments above = elevation_moments(max(lowest, azimuth.low_slope));
    Moments top = elevation_moments(vec4(azimuth.high_slope));
    lit = bvec4(uvec4(lit) & uvec4(lessThan(lowest, vec4(azimuth.high_slope))));
    vec4 weight = mix(vec4(0.0), vec4(azimuth.weight), lit);
    vec4 along = weight * (above.flat_part - top.flat_part);
    east += along * azimuth.cos_phi;
    north += along * azimuth.sin_phi;
    up += weight * (above.vertical - top.vertical);
}
