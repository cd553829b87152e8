// Computes: the horizon of every sample in the azimuths of a batch, from the lattice of a sweep.
// Reads: heights, azimuths, lattice. Writes: horizon_angles (elevation, radians),
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
layout(binding = 1) uniform utexture2DArray lattice;

#include "shared/angle.glsl"
#include "shared/fuse.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform writeonly image2DArray horizon_angles;
layout(binding = 4, r32f) uniform writeonly image2DArray horizon_distances;

layout(push_constant) uniform SweepFusePush {
    int cols;
    int rows;
    int warm_up;
    uint first_azimuth;
    uint first_layer;  // of the images written
};

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    Azimuth azimuth = azimuth_at(azimuths, first_azimuth + at.z);
    bool by_row = (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u;
    int lanes = by_row ? cols : rows;
    int steps = by_row ? rows : cols;
    int lane = lane_position(azimuth, by_row ? at.x : at.y, lanes);
    int step = march_position(azimuth, by_row ? at.y : at.x, steps);
    float own = texelFetch(heights, at.xy, 0).x;
    Octant around = octant_around(azimuth, lane, step, lanes, steps, own);
    vec2 found = fused(azimuth, lane, step, lanes, steps, warm_up, around);
    ivec3 to = ivec3(at.xy, at.z + int(first_layer));
    bool nothing = found.x <= LOWEST_MET;
    float angle = nothing ? -HALF_PI : arc_tangent(found.x);
    imageStore(horizon_angles, to, vec4(BORDER == BORDER_OPEN ? angle : max(angle, 0.0)));
    if (WRITES_DISTANCES) {
        bool ground = nothing || (BORDER != BORDER_OPEN && found.x <= 0.0);
        imageStore(horizon_distances, to, vec4(ground ? 0.0 : found.y * azimuth.step_m));
    }
}
