// Computes: what a sun gives to every sample through its horizons in the azimuths that its disc
// covers, added to what earlier batches gave.
// Reads: heights, azimuths, lattice. Reads and writes: sun_sum (exit radiance for
// irradiance 1 and albedo 1).
// One invocation is one sample.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
// A point: lit or not. Else the part of each chord of the disc that the horizon leaves free.
const bool LATTICE_HAS_DISTANCES = false;
layout(constant_id = 4) const bool POINT = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform utexture2DArray lattice;

#include "shared/angle.glsl"
#include "shared/field.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform image2D sun_sum;

layout(push_constant) uniform SunShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int warm_up;
    uint first_azimuth;  // of the batch
    uint clears;         // 1 in the first batch
    uint pad;
    uvec4 ends;          // where each of its four octants ends, counted from first_azimuth
};

float sun;

// One azimuth's light: `lowest` is the slope of the lowest direction that both the horizon and the
// sample's own plane leave free.
void add_light(uint index, Azimuth azimuth, float lowest, vec3 normal) {
    float flat_part = normal.x * azimuth.cos_phi + normal.y * azimuth.sin_phi;
    if (POINT) {
        float cos_elevation = inversesqrt(1.0 + azimuth.high_slope * azimuth.high_slope);
        float facing = (flat_part + normal.z * azimuth.high_slope) * cos_elevation;
        sun += lowest < azimuth.high_slope ? max(facing, 0.0) * azimuth.weight * (1.0 / PI) : 0.0;
    } else if (lowest < azimuth.high_slope) {
        vec2 moments = elevation_moments(max(lowest, azimuth.low_slope)) - elevation_moments(azimuth.high_slope);
        sun += (flat_part * moments.x + normal.z * moments.y) * azimuth.weight * (1.0 / PI);
    }
}

#include "shared/gather.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    float own = texelFetch(heights, at, 0).x;
    vec2 slope = field_slope(heights, at, ivec2(cols, rows), vec2(cell_x_m, cell_y_m), BORDER);
    float steepness = dot(slope, slope);
    vec3 normal = vec3(-slope, 1.0) * inversesqrt(1.0 + steepness);
    sun = clears == 0u ? imageLoad(sun_sum, at).x : 0.0;
    add_all(at, ivec2(cols, rows), own, slope, normal);
    imageStore(sun_sum, at, vec4(sun));
}
