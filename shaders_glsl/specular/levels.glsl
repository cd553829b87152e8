// Exponents for which a map of specular has tables: levels that are evenly spaced in ln(n + 1), from 0 to the map's largest.
// In constants, three texels each: for maps exponent, least cosine to the lobe's axis, first column and last peak of its table; first
// row, height and columns of a turn of its map of unoccluded light; and the same of the swept azimuths. The including shader declares
// constants and the push constants first_level, level_count and levels_per_log.
const int LEVEL_TEXELS = 3;

// What horizons hide is summed at every second level: the hidden share changes more slowly with the exponent than the light.
const int SWEPT_EVERY = 2;

// Place of an exponent among the levels.
float level_of(float n) {
    return clamp(log(n + 1.0) * levels_per_log, 0.0, float(level_count - 1));
}

// The swept level at or below a place, and never the last of several; and the one above, which is the same of a single level.
ivec2 swept_levels(float place) {
    int last = max(level_count - 1 - SWEPT_EVERY, 0);
    int below = min(int(place) / SWEPT_EVERY * SWEPT_EVERY, last);
    return ivec2(below, min(below + SWEPT_EVERY, level_count - 1));
}
