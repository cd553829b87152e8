// Computes: the horizon of every grid point in the azimuths of a batch, from the lattice of a sweep.
// Reads: lane_heights, azimuths, lattice.
// Writes: horizon_angles (elevation, radians), horizon_distances (world length to the horizon, 0 for none), at
// [azimuth][row][column].
// One invocation is four grid points side by side along the lane axis, at one march position, in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Eight march steps of the same lanes form a tile of the lattice. Neighbouring invocations fetch them together.
layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
layout(constant_id = 4) const bool WRITES_DISTANCES = false;
layout(constant_id = 5) const bool LATTICE_HAS_DISTANCES = false;
const int LATTICE_STRIDE = 1;
const int LANE_STRIDE = 1;
layout(constant_id = 6) const bool MARCHES_ROWS = false;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 7) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
// LATTICE selects one of these.
layout(binding = 1, rgba16ui) uniform restrict readonly uimage2DArray lattice;
layout(binding = 7) uniform utexture2DArray lattice_words;

#include "shared/angle.glsl"
#include "horizon/fuse.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform writeonly image2DArray horizon_angles;
layout(binding = 4, r32f) uniform writeonly image2DArray horizon_distances;

layout(push_constant) uniform SweepFusePush {
    int cols;
    int rows;
    int warm_up;
    uint first_azimuth;
};

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    int march = int(gl_GlobalInvocationID.x);
    int lane = int(gl_GlobalInvocationID.y) * 4;
    if (lane >= lanes || march >= steps) {
        return;
    }
    Azimuth azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    Met found = fused(azimuth, quad_at(lane, march, lanes, steps), lanes, steps, warm_up, vec4(-NO_SLOPE), diagonals_follow(azimuth));
    bvec4 nothing = lessThanEqual(found.slope, vec4(LOWEST_MET));
    vec4 angle = mix(arc_tangent(found.slope), vec4(-HALF_PI), nothing);
    vec4 distance = found.steps * azimuth.step_m;
    if (BORDER != BORDER_OPEN) {
        angle = max(angle, 0.0);
    }
    for (int i = 0; i < 4 && lane + i < lanes; i++) {
        ivec3 to = ivec3(texel_at(lane + i, march), azimuth.horizon_layer);
        imageStore(horizon_angles, to, vec4(angle[i]));
        if (WRITES_DISTANCES) {
            bool ground = nothing[i] || (BORDER != BORDER_OPEN && found.slope[i] <= 0.0);
            imageStore(horizon_distances, to, vec4(ground ? 0.0 : distance[i]));
        }
    }
}
