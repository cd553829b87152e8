// Computes: visibility of every grid point, or of every node, above its horizons in the azimuths of a batch, as a
// series of spherical harmonics, added to earlier batches.
// Reads: lane_heights, azimuths, lattice.
// Reads and writes: visibility, four coefficients per layer.
// Writes: nodes (height, slopes towards east and north), where not every grid point is one.
// One invocation is four grid points or nodes side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
const bool LATTICE_HAS_DISTANCES = false;
layout(constant_id = 4) const int ORDER = 4;
// Slices of n Legendre coefficients, else exact ones.
layout(constant_id = 5) const bool BY_NLP = false;
layout(constant_id = 6) const bool MARCHES_ROWS = false;
const bool CAN_RELIGHT = false;
// Whether the grid point's own plane hides directions below it.
layout(constant_id = 7) const bool OWN_PLANE_HIDES = true;
// Grid points from node to node; and, where marches stored horizons for nodes alone, the same, else 1.
layout(constant_id = 8) const int LANE_STRIDE = 1;
layout(constant_id = 9) const int LATTICE_STRIDE = 1;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 10) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
// LATTICE selects one of these.
layout(binding = 1, rgba16ui) uniform restrict readonly uimage2DArray lattice;
layout(binding = 7) uniform utexture2DArray lattice_words;

#include "shared/angle.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, rgba32f) uniform image2DArray visibility;
layout(binding = 4, rgba32f) uniform writeonly image2D nodes;

// Of the four grid points; and the azimuth's weights.
#define VALUE vec4
vec4 series[36];
float turn[11];

#include "sh/visible.glsl"
#include "sh/turn.glsl"

void add_light(uint index, Azimuth azimuth, vec4 lowest) {
    turn_to(azimuth.wedge_rad, vec2(azimuth.cos_phi, azimuth.sin_phi));
    vec4 cos_ = inversesqrt(1.0 + lowest * lowest);
    vec4 sin_ = lowest * cos_;
    if (BY_NLP) {
        add_nlps(sin_, cos_);
    } else {
        add_slices(HALF_PI - arc_tangent(lowest), sin_, cos_);
    }
}

float dark_slope(Azimuth azimuth) {
    return -NO_SLOPE;
}

#include "direct/gather.glsl"

// Adds the sums of earlier batches in a layer to four coefficients of nodes, and stores them.
void keep(int layer, int across, int along, int count, vec4 a, vec4 b, vec4 c, vec4 d) {
    if (4 * layer >= ORDER * ORDER) {
        return;
    }
    for (int k = 0; k < 4 && across + k < count; k++) {
        ivec3 at = ivec3(texel_at(across + k, along), layer);
        vec4 own = vec4(a[k], b[k], c[k], d[k]);
        if (clears == 0u) {
            own += imageLoad(visibility, at);
        }
        imageStore(visibility, at, own);
    }
}

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    ivec2 place = place_of_four();
    int across = place.x;
    int along = place.y;
    int count = node_count(lanes, LANE_STRIDE);
    if (across >= count || along >= node_count(steps, LANE_STRIDE)) {
        return;
    }
    int lane = node_place(across, lanes, LANE_STRIDE);
    int march = node_place(along, steps, LANE_STRIDE);
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    for (int i = 0; i < 36; i++) {
        series[i] = vec4(0.0);
    }
    add_all(q, lanes, steps, east, north);
    if (LANE_STRIDE > 1 && clears == 1u) {
        for (int k = 0; k < 4 && across + k < count; k++) {
            imageStore(nodes, texel_at(across + k, along), vec4(q.here.four[k], east[k], north[k], 0.0));
        }
    }
    keep(0, across, along, count, series[0], series[1], series[2], series[3]);
    keep(1, across, along, count, series[4], series[5], series[6], series[7]);
    keep(2, across, along, count, series[8], series[9], series[10], series[11]);
    keep(3, across, along, count, series[12], series[13], series[14], series[15]);
    keep(4, across, along, count, series[16], series[17], series[18], series[19]);
    keep(5, across, along, count, series[20], series[21], series[22], series[23]);
    keep(6, across, along, count, series[24], series[25], series[26], series[27]);
    keep(7, across, along, count, series[28], series[29], series[30], series[31]);
    keep(8, across, along, count, series[32], series[33], series[34], series[35]);
}
