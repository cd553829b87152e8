#include "shared/sweep.glsl"

// The frame of one marched azimuth. The including shader sets `azimuth`.

layout(push_constant) uniform MarchPush {
    int lanes;
    int steps;
    int warm_up;  // steps marched beyond the field: whole periods, or 0
    uint first_azimuth;
    int first;  // first row of nodes (horizon_march) or first line (surface_sweep)
};

Azimuth azimuth;

// Whether the cells' diagonals increase in both march and lane.
bool splits_along() {
    return ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
}
