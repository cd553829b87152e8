#include "shared/conventions.glsl"

// Floats of `lane_buffer` before the first height and after the last: sweeping.rs has the same number.
const int LANE_BUFFER_PAD = 4;

// Position along the march axis at a step, and the step at a position: the same flip.
int march_position(Azimuth azimuth, int step, int steps) {
    int flipped = steps - 1 - step;
    return (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u ? flipped : step;
}

// Position along the lane axis of a lane, and back.
int lane_position(Azimuth azimuth, int lane, int lanes) {
    int flipped = lanes - 1 - lane;
    return (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u ? flipped : lane;
}

// Remainders of negative numbers are undefined in Vulkan. The selection is between names: glslang makes branches of
// selected expressions, for which SwiftShader's compiler takes minutes and gigabytes.
int wrapped(int i, int n) {
    bool below = i < 0;
    int mirrored = -1 - i;
    int whole = below ? mirrored : i;
    int r = whole % n;
    int from_end = n - 1 - r;
    return below ? from_end : r;
}

// Whether a lane position lies on the field.
bool on_field(int y, int lanes) {
    return y >= 0 && y <= (lanes - 1) * CELL;
}
