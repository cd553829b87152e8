// horizon.ktx2: layer k holds the horizon along azimuth 360° k / HORIZON_AZIMUTHS, counter-clockwise from east. The
// first row is the northernmost: uv (0, 0) is the north-west corner.

// Elevation of the horizon, radians (its sine where the manifest has "-sin"), along an azimuth in radians from east.
float horizon(sampler2DArray map, vec2 uv, float azimuth_rad) {
    float turn = fract(azimuth_rad / 6.28318531) * float(HORIZON_AZIMUTHS);
    float before = floor(turn);
    vec2 layers = floor(mod(vec2(before, before + 1.0) + 0.5, float(HORIZON_AZIMUTHS)));
    float a = texture(map, vec3(uv, layers.x)).r;
    float b = texture(map, vec3(uv, layers.y)).r;
    return HORIZON_SCALE * mix(a, b, turn - before);
}
