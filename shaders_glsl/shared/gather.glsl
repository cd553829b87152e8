#include "shared/fuse.glsl"

// Walks the azimuths of a batch at one sample. The including shader declares `azimuths` and the push
// constants first_azimuth, ends and warm_up, and defines add_light.

// `size` is (cols, rows); `plane` is the field's slope at the sample.
void add_all(ivec2 at, ivec2 size, float own, vec2 plane, vec3 normal) {
    for (uint octant = 0; octant < 4; octant++) {
        uint k = octant == 0 ? 0u : ends[octant - 1];
        if (k >= ends[octant]) {
            continue;
        }
        Azimuth azimuth = azimuth_at(azimuths, first_azimuth + k);
        bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
        int lanes = by_row ? size.x : size.y;
        int steps = by_row ? size.y : size.x;
        int lane = lane_position(azimuth, by_row ? at.x : at.y, lanes);
        int step = march_position(azimuth, by_row ? at.y : at.x, steps);
        Octant around = octant_around(azimuth, lane, step, lanes, steps, own);
        for (; k < ends[octant]; k++) {
            azimuth = azimuth_at(azimuths, first_azimuth + k);
            float horizon = fused(azimuth, lane, step, lanes, steps, warm_up, around).x;
            // The sample's own plane rises towards the azimuth with the field's slope (TW10 eq. 4).
            float lowest = max(horizon, dot(plane, vec2(azimuth.cos_phi, azimuth.sin_phi)));
            if (BORDER != BORDER_OPEN) {
                lowest = max(lowest, 0.0);
            }
            add_light(first_azimuth + k, azimuth, lowest, normal);
        }
    }
}
