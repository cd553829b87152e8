// Computes: irradiance from an azimuth's wedge of the environment above each elevation (TW10 eq. 7), split into the
// three components of the normal. It is linear in them, so no normal angle is tabulated.
// Reads: wedge_rows.
// Writes: env_tables at [azimuth][moment][node], divided by pi.
// One invocation is one moment of one azimuth, from the zenith down.
#version 460

#include "shared/angle.glsl"

layout(local_size_x = 3, local_size_y = 4) in;

layout(binding = 0) readonly buffer WedgeRows { vec4 wedge_rows[]; };
layout(binding = 1, rgba32f) uniform writeonly image2DArray env_tables;

layout(push_constant) uniform EnvTablesPush {
    int height;        // rows from pole to pole
    int rows;          // those in wedge_rows
    int nodes;
    int azimuth_count;
    float bottom_rad;  // elevation of node 0: 0, or -pi/2 where light may come from below
};

// Integral from an elevation to the zenith: of cos^2 for the horizontal moments, of sin cos for the
// vertical one.
float moment_above(float elevation, bool vertical) {
    float c = cosine(elevation);
    float s = sine(elevation);
    return vertical ? 0.5 * c * c : 0.25 * PI - 0.5 * elevation - 0.5 * s * c;
}

void main() {
    int moment = int(gl_GlobalInvocationID.x);
    int k = int(gl_GlobalInvocationID.y);
    if (k >= azimuth_count) {
        return;
    }
    bool vertical = moment == 2;
    vec3 sum = vec3(0.0);
    int row = 0;
    float upper = HALF_PI;
    float above_upper = 0.0;
    for (int node = nodes - 1; node >= 0; node--) {
        float elevation = bottom_rad + (HALF_PI - bottom_rad) * float(node) / float(nodes - 1);
        // Whole rows above the node, then the part of the row that contains it.
        while (upper > elevation) {
            float row_bottom = HALF_PI - PI * float(row + 1) / float(height);
            float lower = max(row_bottom, elevation);
            float above_lower = moment_above(lower, vertical);
            sum += wedge_rows[(k * rows + min(row, rows - 1)) * 3 + moment].rgb * (above_lower - above_upper);
            upper = lower;
            above_upper = above_lower;
            row += row_bottom >= elevation ? 1 : 0;
        }
        imageStore(env_tables, ivec3(node, moment, k), vec4(sum * (1.0 / PI), 0.0));
    }
}
