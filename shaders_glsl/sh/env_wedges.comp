// Computes: the environment summed over each azimuth's wedge, row by row: three azimuthal moments.
// Reads: environment (equirectangular, row 0 at the zenith), azimuths.
// Writes: wedge_rows, as [azimuth][row][moment]: integrals over the wedge of L cos, L sin and L.
// One invocation is one row of the environment in one azimuth.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

#include "shared/angle.glsl"

layout(local_size_x = 8) in;

layout(binding = 0) uniform texture2D environment;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2) writeonly buffer WedgeRows { vec4 wedge_rows[]; };

layout(push_constant) uniform EnvWedgesPush {
    int width;
    int rows;          // of the environment, from the zenith down, with light that can arrive
    float rotation_rad;
};

void main() {
    int row = int(gl_GlobalInvocationID.x);
    uint k = gl_GlobalInvocationID.y;
    if (row >= rows) {
        return;
    }
    Azimuth azimuth = azimuth_at(azimuths, k);
    // Columns run clockwise from west: column x begins at azimuth pi + rotation - 2 pi x / width.
    float per_rad = float(width) / (2.0 * PI);
    float middle = (PI + rotation_rad - azimuth.centre_rad) * per_rad;
    float half_wedge = 0.5 * azimuth.wedge_rad * per_rad;
    vec3 along = vec3(0.0);
    vec3 across = vec3(0.0);
    vec3 plain = vec3(0.0);
    // From up to one width before the image to up to two past it. Ends are relative to the middle: a wedge far
    // narrower than a column keeps its width.
    for (int x = int(floor(middle - half_wedge)); x < int(ceil(middle + half_wedge)); x++) {
        float low = max(float(x) - middle, -half_wedge);
        float high = min(float(x + 1) - middle, half_wedge);
        vec3 radiance = texelFetch(environment, ivec2((x + 2 * width) % width, row), 0).rgb;
        // Counter-clockwise from the wedge's middle, at the middle of the covered part.
        float turn = -0.5 * (low + high) / per_rad;
        float width_rad = max(high - low, 0.0) / per_rad;
        // The integral of cos over an arc is its chord, 2 sin(half), times cos of its middle.
        float chord = 2.0 * sine(0.5 * width_rad);
        along += radiance * (cosine(turn) * chord);
        across += radiance * (sine(turn) * chord);
        plain += radiance * width_rad;
    }
    uint place = (k * uint(rows) + uint(row)) * 3u;
    // The mean direction of a wedge is its middle.
    vec2 centre = normalize(vec2(azimuth.wedge_cos, azimuth.wedge_sin));
    wedge_rows[place] = vec4(centre.x * along - centre.y * across, 0.0);
    wedge_rows[place + 1u] = vec4(centre.y * along + centre.x * across, 0.0);
    wedge_rows[place + 2u] = vec4(plain, 0.0);
}
