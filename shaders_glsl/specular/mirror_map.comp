// Computes: light of all azimuths, weighted by a Phong lobe about each direction of the sphere, from the whole slices of
// their tables. From fine azimuths it is the unoccluded reflection; from those that are swept, the same sum by which
// horizons are compared.
// Reads: azimuths, specular_tables.
// Writes: mirror_map (equirectangular: column 0 east, counter-clockwise; row 0 straight down, the last straight up). Where
// the azimuths are equally spaced and have the same light, the map is periodic, and only its first period is stored. Maps of
// several exponents lie one above the other.
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
    int columns;        // of a whole turn, a multiple of 4
    int stored;         // of those, the first period
    int height;
    int first_row;      // of the map within the image
    int first_peak;     // column of the table within the image
    int peaks;
    int azimuth_count;
    int node;           // of the zenith
    float first_rad;    // peak 0
    float per_rad;      // peaks in a radian
    float exponent;
    float least;        // a^n below it counts as 0
    float farthest;     // |p| beyond which a^n < least
    float first_turn;   // azimuth 0, in turns; negative unless azimuths are equally spaced and in order
    float lowest_up;    // sine of the elevation below which a lobe gets no light
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= stored || at.y >= height) {
        return;
    }
    // Sine and cosine of the azimuth from its quarter.
    int quarter = columns / 4;
    int turn = at.x / quarter;
    float within = HALF_PI * float(at.x - turn * quarter) / float(quarter);
    vec2 east_north = vec2(cosine(within), sine(within));
    east_north = (turn & 1) != 0 ? vec2(-east_north.y, east_north.x) : east_north;
    east_north = (turn & 2) != 0 ? -east_north : east_north;
    float elevation = PI * (float(at.y) / float(height - 1) - 0.5);
    float flat_part = cosine(elevation);
    east_north *= flat_part;
    float up = sine(elevation);
    if (up < lowest_up) {
        imageStore(mirror_map, at + ivec2(0, first_row), vec4(0.0));
        return;
    }
    // If the lobe does not reach the zenith, only azimuths near its own contribute.
    uint first = 0u;
    int count = azimuth_count;
    if (first_turn >= 0.0 && farthest < flat_part) {
        float reach = farthest / flat_part;
        float turns = angle_of(vec4(sqrt(max(1.0 - reach * reach, 0.0))), vec4(reach)).x / (2.0 * PI);
        float nearest = (float(at.x) / float(columns) - first_turn) * float(azimuth_count);
        float half_count = turns * float(azimuth_count) + 1.0;
        count = min(int(2.0 * half_count) + 2, azimuth_count);
        first = uint(int(floor(nearest - half_count)) + 2 * azimuth_count);
    }
    bool is_shared = imageSize(specular_tables).z == 1 && azimuth_count > 1;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; i++) {
        uint k = (first + uint(i)) % uint(azimuth_count);
        Azimuth azimuth = azimuth_at(azimuths, k);
        float along = east_north.x * azimuth.cos_phi + east_north.y * azimuth.sin_phi;
        float across = east_north.x * azimuth.sin_phi - east_north.y * azimuth.cos_phi;
        if (abs(across) > farthest || (along < 0.0 && farthest < flat_part)) {
            continue;
        }
        float power = off_slice(vec4(exponent), vec4(across), vec4(along * along + up * up)).x;
        if (power < least) {
            continue;
        }
        float place = (angle_of(vec4(along), vec4(up)).x - first_rad) * per_rad;
        if (place < 0.0) {
            continue;
        }
        int peak = clamp(int(place), 0, peaks - 2);
        float t = clamp(place - float(peak), 0.0, 1.0);
        int layer = is_shared ? 0 : int(k);
        ivec3 of_peak = ivec3(first_peak + peak, node, layer);
        vec3 low = imageLoad(specular_tables, of_peak).rgb;
        vec3 high = imageLoad(specular_tables, of_peak + ivec3(1, 0, 0)).rgb;
        sum += power * (is_shared ? azimuth.wedge_rad : 1.0) * mix(low, high, t);
    }
    imageStore(mirror_map, at + ivec2(0, first_row), vec4(sum, 0.0));
}
