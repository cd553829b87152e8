// Computes: visibility of every grid point, or of every node, between the horizons of neighbouring azimuths, as a
// series of spherical harmonics, from a table of wedges (Snyder & Nowrouzezahrai 2008; Nowrouzezahrai's thesis,
// section 4.2.1).
// Reads: lane_heights, horizon_angles, constants.
// Writes: visibility, four coefficients per layer; nodes (height, slopes towards east and north), where not every
// grid point is one.
// One invocation is four grid points or nodes side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
layout(constant_id = 2) const int ORDER = 4;
layout(constant_id = 3) const bool OWN_PLANE_HIDES = true;
// Grid points from node to node.
layout(constant_id = 4) const int LANE_STRIDE = 1;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform texture2DArray horizon_angles;
layout(binding = 2) uniform textureBuffer constants;
layout(binding = 3, rgba32f) uniform writeonly image2DArray visibility;
layout(binding = 4, rgba32f) uniform writeonly image2D nodes;

layout(push_constant) uniform ShWedgesPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int azimuth_count;
    int azimuth_first; // in constants: cosine, sine, in the circle's order
    int table_first;   // in constants: [first horizon][last horizon], four coefficients a texel
    int side;          // horizons on either axis of the table
    float lowest_rad;  // of the table, which ends at the zenith
};

#include "shared/quad.glsl"
#include "shared/angle.glsl"
#include "shared/nodes.glsl"

const int LAYERS = (ORDER * ORDER + 3) / 4;

// Of the four grid points; and of one wedge from the table.
#define VALUE vec4
vec4 series[4 * LAYERS];
vec4 wedge[4 * LAYERS];

#include "sh/wedge.glsl"

// Table position of the four grid points' horizons in an azimuth.
vec4 places(int layer, vec2 towards, ivec4 lane, int march, vec4 east, vec4 north) {
    vec4 angle;
    for (int k = 0; k < 4; k++) {
        angle[k] = texelFetch(horizon_angles, ivec3(texel_at(lane[k], march), layer), 0).x;
    }
    if (OWN_PLANE_HIDES) {
        angle = max(angle, arc_tangent(east * towards.x + north * towards.y));
    }
    vec4 place = (angle - lowest_rad) * (float(side - 1) / (HALF_PI - lowest_rad));
    return clamp(place, 0.0, float(side - 1));
}

// Interpolates between the four nearest texels, for each grid point.
void look_up(vec4 first, vec4 last) {
    ivec4 row = min(ivec4(first), side - 2);
    ivec4 col = min(ivec4(last), side - 2);
    vec4 u = first - vec4(row);
    vec4 v = last - vec4(col);
    for (int layer = 0; layer < LAYERS; layer++) {
        mat4 four;
        for (int k = 0; k < 4; k++) {
            int at = table_first + (row[k] * side + col[k]) * LAYERS + layer;
            int below = at + side * LAYERS;
            vec4 near = mix(texelFetch(constants, at), texelFetch(constants, at + LAYERS), v[k]);
            vec4 far = mix(texelFetch(constants, below), texelFetch(constants, below + LAYERS), v[k]);
            four[k] = mix(near, far, u[k]);
        }
        four = transpose(four);
        wedge[4 * layer] = four[0];
        wedge[4 * layer + 1] = four[1];
        wedge[4 * layer + 2] = four[2];
        wedge[4 * layer + 3] = four[3];
    }
}

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    int across = int(gl_GlobalInvocationID.y) * 4;
    int along = int(gl_GlobalInvocationID.x);
    int count = node_count(lanes, LANE_STRIDE);
    if (across >= count || along >= node_count(steps, LANE_STRIDE)) {
        return;
    }
    int march = node_place(along, steps, LANE_STRIDE);
    Quad q = quad_at(node_place(across, lanes, LANE_STRIDE), march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    ivec4 lane = min(q.lane, lanes - 1);
    for (int i = 0; i < 4 * LAYERS; i++) {
        series[i] = vec4(0.0);
    }
    vec2 towards = texelFetch(constants, azimuth_first).xy;
    vec4 first = places(0, towards, lane, march, east, north);
    for (int k = 1; k <= azimuth_count; k++) {
        int layer = k % azimuth_count;
        vec2 next = texelFetch(constants, azimuth_first + layer).xy;
        vec4 last = places(layer, next, lane, march, east, north);
        look_up(first, last);
        add_turned(towards);
        towards = next;
        first = last;
    }
    for (int k = 0; k < 4 && across + k < count; k++) {
        ivec2 at = texel_at(across + k, along);
        for (int layer = 0; layer < LAYERS; layer++) {
            vec4 own = vec4(series[4 * layer][k], series[4 * layer + 1][k], series[4 * layer + 2][k], series[4 * layer + 3][k]);
            imageStore(visibility, ivec3(at, layer), own);
        }
        if (LANE_STRIDE > 1) {
            imageStore(nodes, at, vec4(q.here.four[k], east[k], north[k], 0.0));
        }
    }
}
