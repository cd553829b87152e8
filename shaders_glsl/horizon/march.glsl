#include "horizon/sweep.glsl"

// The field in the frame of one marched azimuth. The including shader declares `heights` and the constant PERIODIC,
// and sets `azimuth`.

layout(push_constant) uniform MarchPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched beyond the field: whole periods, or 0
    uint first_azimuth;
};

Azimuth azimuth;

// Both ends of each choice are computed: SwiftShader's compiler takes minutes over branches here.
float height_at(int lane, int step) {
    int lane_round = wrapped(lane, lanes);
    int step_round = wrapped(step, steps);
    int lane_held = clamp(lane, 0, lanes - 1);
    int step_held = clamp(step, 0, steps - 1);
    lane = lane_position(azimuth, PERIODIC ? lane_round : lane_held, lanes);
    step = march_position(azimuth, PERIODIC ? step_round : step_held, steps);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    ivec2 at = ivec2(by_row ? lane : step, by_row ? step : lane);
    return texelFetch(heights, at, 0).x;
}

// Whether the cells' diagonals increase in both march and lane.
bool splits_along() {
    return ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
}
