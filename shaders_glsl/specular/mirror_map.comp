// Computes: light of all azimuths, weighted by a Phong lobe about each direction of the sphere, from the whole slices of
// their tables. From fine azimuths it is the unoccluded reflection; from those that are swept, the same sum by which
// horizons are compared.
// Reads: azimuths, specular_tables.
// Writes: mirror_map (equirectangular: column 0 east, counter-clockwise; row 0 straight down, the last straight up).
// One invocation is one direction.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

#include "shared/angle.glsl"
#include "specular/phong_slice.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform textureBuffer azimuths;
layout(binding = 1, rgba32f) uniform readonly image2DArray specular_tables;
layout(binding = 2, rgba32f) uniform writeonly image2D mirror_map;

layout(push_constant) uniform MirrorMapPush {
    int width;
    int height;
    int azimuth_count;
    int node;         // of the zenith
    float first_rad;  // peak 0
    float per_rad;    // peaks in a radian
    float exponent;
    float least;      // a^n below it counts as 0
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= width || at.y >= height) {
        return;
    }
    // Sine and cosine of the azimuth from its quarter.
    int quarter = width / 4;
    int turn = at.x / quarter;
    float within = HALF_PI * float(at.x - turn * quarter) / float(quarter);
    vec2 east_north = vec2(cosine(within), sine(within));
    east_north = (turn & 1) != 0 ? vec2(-east_north.y, east_north.x) : east_north;
    east_north = (turn & 2) != 0 ? -east_north : east_north;
    float elevation = PI * (float(at.y) / float(height - 1) - 0.5);
    east_north *= cosine(elevation);
    float up = sine(elevation);
    ivec3 size = imageSize(specular_tables);
    bool is_shared = size.z == 1 && azimuth_count > 1;
    vec3 sum = vec3(0.0);
    for (int k = 0; k < azimuth_count; k++) {
        Azimuth azimuth = azimuth_at(azimuths, uint(k));
        float along = east_north.x * azimuth.cos_phi + east_north.y * azimuth.sin_phi;
        float across = east_north.x * azimuth.sin_phi - east_north.y * azimuth.cos_phi;
        float power = off_slice(exponent, vec4(across)).x;
        if (power < least) {
            continue;
        }
        float place = (angle_of(vec4(along), vec4(up)).x - first_rad) * per_rad;
        if (place < 0.0) {
            continue;
        }
        int peak = clamp(int(place), 0, size.x - 2);
        float t = clamp(place - float(peak), 0.0, 1.0);
        int layer = is_shared ? 0 : k;
        vec3 low = imageLoad(specular_tables, ivec3(peak, node, layer)).rgb;
        vec3 high = imageLoad(specular_tables, ivec3(peak + 1, node, layer)).rgb;
        sum += power * (is_shared ? azimuth.wedge_rad : 1.0) * mix(low, high, t);
    }
    imageStore(mirror_map, at, vec4(sum, 0.0));
}
