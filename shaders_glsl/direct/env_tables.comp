// Computes: irradiance from an azimuth's wedge of the environment above each elevation (TW10 eq. 7), split into the
// three components of the normal. It is linear in them, so no normal angle is tabulated. Nodes are even in the sine of
// the elevation.
// Reads: wedge_rows, azimuths.
// Writes: env_tables at [azimuth][moment][node]. RGB: the moment above the node, divided by pi. Alpha of moments 0, 1
// and 2: red, green and blue of the wedge's mean radiance from the node to the next (even in the sine).
// One invocation is one moment of one azimuth, from the zenith down.
#version 460

#include "shared/angle.glsl"

layout(local_size_x = 3, local_size_y = 4) in;

layout(binding = 0) readonly buffer WedgeRows { vec4 wedge_rows[]; };
layout(binding = 1, rgba32f) uniform writeonly image2DArray env_tables;
layout(binding = 2) uniform textureBuffer azimuths;

layout(push_constant) uniform EnvTablesPush {
    int height;         // rows from pole to pole
    int rows;           // those in wedge_rows
    int nodes;
    int azimuth_count;
    float bottom_sine;  // of the elevation of node 0: 0, or -1 where light may come from below
};

// Integral from an elevation to the zenith, by its sine, its cosine and its angle from the zenith: of cos^2 for the
// horizontal moments, of sin cos for the vertical one.
float moment_above(float s, float c, float zenith_rad, bool vertical) {
    return vertical ? 0.5 * c * c : 0.5 * (zenith_rad - s * c);
}

float moment_above_row(int row, bool vertical) {
    float elevation = HALF_PI - PI * float(row + 1) / float(height);
    return moment_above(sine(elevation), cosine(elevation), HALF_PI - elevation, vertical);
}

float moment_above_node(int node, bool vertical) {
    float from_top = (1.0 - bottom_sine) * float(nodes - 1 - node) / float(nodes - 1);
    float s = 1.0 - from_top;
    float c = sqrt(from_top * (2.0 - from_top));
    float zenith_rad = HALF_PI - arc_tangent(vec4(s / max(c, 1e-9))).x;
    return moment_above(s, c, zenith_rad, vertical);
}

void main() {
    int moment = int(gl_GlobalInvocationID.x);
    int k = int(gl_GlobalInvocationID.y);
    if (k >= azimuth_count) {
        return;
    }
    bool vertical = moment == 2;
    float step = (1.0 - bottom_sine) / float(nodes - 1);
    float wedge_rad = azimuth_at(azimuths, uint(k)).wedge_rad;
    vec3 sum = vec3(0.0);
    int row = 0;
    float upper = 1.0;
    float above_upper = 0.0;
    for (int node = nodes - 1; node >= 0; node--) {
        float node_sine = bottom_sine + step * float(node);
        // Whole rows above the node, then the part of the row that contains it.
        float radiance = 0.0;
        while (upper > node_sine) {
            float row_sine = row + 1 < height ? sine(HALF_PI - PI * float(row + 1) / float(height)) : -1.0;
            bool ends_row = row_sine >= node_sine;
            float lower = ends_row ? row_sine : node_sine;
            float above_lower = ends_row ? moment_above_row(row, vertical) : moment_above_node(node, vertical);
            int place = (k * rows + min(row, rows - 1)) * 3;
            sum += wedge_rows[place + moment].rgb * (above_lower - above_upper);
            radiance += wedge_rows[place + 2][moment] * (upper - lower);
            upper = lower;
            above_upper = above_lower;
            row += ends_row ? 1 : 0;
        }
        float mean = wedge_rad > 0.0 ? radiance / (step * wedge_rad) : 0.0;
        imageStore(env_tables, ivec3(node, moment, k), vec4(sum * (1.0 / PI), mean));
    }
}
