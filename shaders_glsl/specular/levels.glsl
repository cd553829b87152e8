// Exponent levels of a specular map, evenly spaced in ln(n + 1) from 0 to the map's largest exponent; a constant exponent is one
// level. Each takes three texels of constants:
// 0: of a specular map, exponent, least cosine to the lobe's axis, first column and last peak of its table;
// 1: first row, height and columns per 360 degrees of its mirror map of unoccluded light;
// 2: the same of its mirror map of the swept azimuths.
// The including shader declares constants and the push constants first_level, level_count and levels_per_log.
const int LEVEL_TEXELS = 3;

// The hidden share changes more slowly with the exponent than the light does, so every second level is enough.
const int SWEPT_EVERY = 2;

// Fractional index of an exponent among the levels.
float level_of(float n) {
    return clamp(log(n + 1.0) * levels_per_log, 0.0, float(level_count - 1));
}

// The swept levels below and above a fractional index. The lower one is never the last, except where there is only one: then both
// are the same.
ivec2 swept_levels(float place) {
    int last = max(level_count - 1 - SWEPT_EVERY, 0);
    // Also of a texel that is no number.
    int below = clamp(int(place) / SWEPT_EVERY * SWEPT_EVERY, 0, last);
    return ivec2(below, min(below + SWEPT_EVERY, level_count - 1));
}
