#include "shared/fuse.glsl"

// Walks the azimuths of a batch at four samples. The including shader declares `azimuths` and
// defines add_light.

layout(push_constant) uniform ShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int warm_up;
    uint first_azimuth;  // of the batch
    uint azimuth_count;
    uint clears;         // 1 in the first batch
};

// `east` and `north` are the field's slopes at the samples.
void add_all(Quad q, int lanes, int steps, vec4 east, vec4 north) {
    for (uint k = first_azimuth; k < first_azimuth + azimuth_count; k++) {
        Azimuth azimuth = azimuth_at(azimuths, k);
        vec4 horizon = fused(azimuth, q, lanes, steps, warm_up).slope;
        // The sample's own plane rises towards the azimuth with the field's slope (TW10 eq. 4).
        vec4 lowest = max(horizon, east * azimuth.cos_phi + north * azimuth.sin_phi);
        if (BORDER != BORDER_OPEN) {
            lowest = max(lowest, vec4(0.0));
        }
        add_light(k, azimuth, lowest);
    }
}
