#include "shared/conventions.glsl"

// Position along the march axis at a step, and the step at a position: the same flip.
int march_position(Azimuth azimuth, int step, int steps) {
    return (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u ? steps - 1 - step : step;
}

// Position along the lane axis of a lane, and back.
int lane_position(Azimuth azimuth, int lane, int lanes) {
    return (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u ? lanes - 1 - lane : lane;
}

int wrapped(int i, int n) {
    int r = i % n;
    return r < 0 ? r + n : r;
}

// Whether a lane position lies on the field.
bool on_field(int y, int lanes) {
    return y >= 0 && y <= (lanes - 1) * CELL;
}
