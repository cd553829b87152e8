// Computes: what a uniform sky and an environment give to every sample through its horizons in the
// azimuths of a batch, added to what earlier batches gave.
// Reads: heights, azimuths, lattice, env_tables. Reads and writes: sky_sum (exit
// radiance for sky radiance 1 and albedo 1), env_sum (exit radiance for albedo 1, RGB).
// One invocation is one sample.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
const bool LATTICE_HAS_DISTANCES = false;
layout(constant_id = 4) const bool HAS_SKY = true;
layout(constant_id = 5) const bool HAS_ENVIRONMENT = false;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform utexture2DArray lattice;

#include "shared/angle.glsl"
#include "shared/field.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform image2D sky_sum;
layout(binding = 4, rgba32f) uniform image2D env_sum;
// x: elevation node, y: moment (cos, sin, vertical), layer: azimuth.
layout(binding = 5) uniform texture2DArray env_tables;

layout(push_constant) uniform SkyShadePush {
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

float sky;
vec3 environment;

// One azimuth's light: `lowest` is the slope of the lowest direction that both the horizon and the
// sample's own plane leave free.
void add_light(uint index, Azimuth azimuth, float lowest, vec3 normal) {
    if (HAS_SKY) {
        // TW10 eq. 5 with the normal integrated over the wedge instead of taken at its centre.
        vec2 moments = elevation_moments(lowest);
        float flat_part = normal.x * azimuth.wedge_cos + normal.y * azimuth.wedge_sin;
        sky += (flat_part * moments.x + normal.z * azimuth.wedge_rad * moments.y) * (1.0 / PI);
    }
    if (HAS_ENVIRONMENT) {
        int nodes = textureSize(env_tables, 0).x;
        float bottom = BORDER == BORDER_OPEN ? -HALF_PI : 0.0;
        float place = (arc_tangent(lowest) - bottom) / (HALF_PI - bottom) * float(nodes - 1);
        int node = clamp(int(place), 0, nodes - 2);
        float t = clamp(place - float(node), 0.0, 1.0);
        vec3 moment[3];
        for (int m = 0; m < 3; m++) {
            vec3 low = texelFetch(env_tables, ivec3(node, m, index), 0).rgb;
            vec3 high = texelFetch(env_tables, ivec3(node + 1, m, index), 0).rgb;
            moment[m] = mix(low, high, t);
        }
        environment += normal.x * moment[0] + normal.y * moment[1] + normal.z * moment[2];
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
    sky = 0.0;
    environment = vec3(0.0);
    if (clears == 0u) {
        if (HAS_SKY) {
            sky = imageLoad(sky_sum, at).x;
        }
        if (HAS_ENVIRONMENT) {
            environment = imageLoad(env_sum, at).rgb;
        }
    }
    add_all(at, ivec2(cols, rows), own, slope, normal);
    if (HAS_SKY) {
        imageStore(sky_sum, at, vec4(sky));
    }
    if (HAS_ENVIRONMENT) {
        imageStore(env_sum, at, vec4(environment, 0.0));
    }
}
