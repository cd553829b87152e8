#include "shared/conventions.glsl"

// Floats of `lane_buffer` before the first height and after the last: sweeping.rs has the same number.
const int LANE_BUFFER_PAD = 4;

// Position along the march axis at a step, and the step at a position: the same flip.
int march_position(Azimuth azimuth, int step, int steps) {
    int flipped = steps - 1 - step;
    return (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u ? flipped : step;
}

// Whether the diagonals of the cells go from (0, 0) to (1, 1) of an azimuth's lanes and steps, not from (1, 0) to (0, 1).
bool diagonals_follow(Azimuth azimuth) {
    return ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
}

// Position along the lane axis of a lane, and back.
int lane_position(Azimuth azimuth, int lane, int lanes) {
    int flipped = lanes - 1 - lane;
    return (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u ? flipped : lane;
}

// The remainder of i by n, 0 to n - 1, for |i| up to 2^20: there the quotient, with an error of 2.5 ulp, is off by one at most.
// Lanes, steps and lines are below 2^19. CPUs have no vector instruction that divides integers.
int wrapped(int i, int n) {
    int r = i - n * int(floor(float(i) / float(n)));
    int up = r + n;
    r = mix(r, up, r < 0);
    int down = r - n;
    return mix(r, down, r >= n);
}

// Whether a lane position lies on the field.
bool on_field(int y, int lanes) {
    return y >= 0 && y <= (lanes - 1) * CELL;
}
