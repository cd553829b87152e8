// Computes: the horizon of every sample in the azimuths of a batch, from the lattice of a sweep.
// Reads: heights, azimuths, lattice_cols, lattice_rows. Writes: horizon_angles (elevation, radians),
// horizon_distances (world length to what makes the horizon, 0 where nothing does), [azimuth][row][column].
// One invocation is one sample in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
layout(constant_id = 4) const bool WRITES_DISTANCES = false;
layout(constant_id = 5) const bool LATTICE_HAS_DISTANCES = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform utexture2DArray lattice_cols;
layout(binding = 2) uniform utexture2DArray lattice_rows;

#include "shared/angle.glsl"
#include "shared/fuse.glsl"

layout(binding = 3) readonly buffer Azimuths { Azimuth azimuths[]; };
layout(binding = 4, r32f) uniform writeonly image2DArray horizon_angles;
layout(binding = 5, r32f) uniform writeonly image2DArray horizon_distances;

layout(push_constant) uniform SweepFusePush {
    int cols;
    int rows;
    int warm_up_cols;
    int warm_up_rows;
    uint first_azimuth;
};

vec2 horizon(utexture2DArray lattice, Azimuth azimuth, int lane_at, int march_at, int lanes, int steps, int warm_up, float own) {
    int lane = lane_position(azimuth, lane_at, lanes);
    int step = march_position(azimuth, march_at, steps);
    return fused(lattice, azimuth, lane, step, lanes, steps, warm_up,
                 octant_around(azimuth, lane, step, lanes, steps, own));
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    Azimuth azimuth = azimuths[first_azimuth + at.z];
    float own = texelFetch(heights, at.xy, 0).x;
    vec2 found;
    if ((azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u) {
        found = horizon(lattice_rows, azimuth, at.x, at.y, cols, rows, warm_up_rows, own);
    } else {
        found = horizon(lattice_cols, azimuth, at.y, at.x, rows, cols, warm_up_cols, own);
    }
    bool nothing = found.x <= NO_SLOPE;
    float angle = nothing ? -HALF_PI : arc_tangent(found.x);
    imageStore(horizon_angles, at, vec4(BORDER == BORDER_OPEN ? angle : max(angle, 0.0)));
    if (WRITES_DISTANCES) {
        bool ground = nothing || (BORDER != BORDER_OPEN && found.x <= 0.0);
        imageStore(horizon_distances, at, vec4(ground ? 0.0 : found.y * azimuth.step_m));
    }
}
