// Light of a sun's chord in one azimuth above `lowest`, the slope of the lowest direction that is not hidden; 0 where all of
// it is hidden. `flat_part` and `vertical` are the normal's parts along the azimuth and up.
vec4 sun_light(Azimuth azimuth, vec4 flat_part, vec4 vertical, vec4 lowest, bool is_point) {
    vec4 light;
    if (is_point) {
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
