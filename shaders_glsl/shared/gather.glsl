#include "shared/fuse.glsl"

// Walks the azimuths of a batch at one sample. The including shader declares `azimuths` and the push
// constants first_azimuth, ends_cols and ends_rows, and defines add_light.

void add_axis(utexture2DArray lattice, uint first, uvec4 ends, int lane_at, int march_at, int lanes, int steps,
              int warm_up, float own, vec2 field_gradient, vec3 normal) {
    for (uint octant = 0; octant < 4; octant++) {
        uint k = first_azimuth + (octant == 0 ? first : ends[octant - 1]);
        uint end = first_azimuth + ends[octant];
        if (k >= end) {
            continue;
        }
        Azimuth azimuth = azimuths[k];
        int lane = lane_position(azimuth, lane_at, lanes);
        int step = march_position(azimuth, march_at, steps);
        Octant around = octant_around(azimuth, lane, step, lanes, steps, own);
        for (; k < end; k++) {
            azimuth = azimuths[k];
            float horizon = fused(lattice, azimuth, lane, step, lanes, steps, warm_up, around).x;
            // The sample's own plane rises towards the azimuth with the field's slope (TW10 eq. 4).
            float lowest = max(horizon, dot(field_gradient, vec2(azimuth.cos_phi, azimuth.sin_phi)));
            if (BORDER != BORDER_OPEN) {
                lowest = max(lowest, 0.0);
            }
            add_light(k, azimuth, lowest, normal);
        }
    }
}

void add_all(ivec2 at, ivec2 size, ivec2 warm_up, float own, vec2 field_gradient, vec3 normal) {
    add_axis(lattice_cols, 0u, ends_cols, at.y, at.x, size.y, size.x, warm_up.x, own, field_gradient, normal);
    add_axis(lattice_rows, ends_cols.w, ends_rows, at.x, at.y, size.x, size.y, warm_up.y, own, field_gradient, normal);
}
