// Computes: direct light of a sun or a key light from the horizons in the azimuths that it covers, added to earlier
// batches; and the Phong specular of a key light.
// Reads: lane_heights, azimuths, lattice, phong_map, dirty_texels, edit_list.
// Reads and writes: sun_sum (exit radiance for albedo 1, and irradiance 1 of a sun or radiance 1 of a key light),
// light_vector (see sun_light.glsl), specular_sum (exit radiance, RGB).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Eight march steps of the same lanes form a tile of the lattice. Neighbouring invocations fetch them together.
layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
const bool LATTICE_HAS_DISTANCES = false;
const int LATTICE_STRIDE = 1;
const int LANE_STRIDE = 1;
const bool OWN_PLANE_HIDES = true;
const bool CAN_RELIGHT = true;
// See sun_light.glsl.
layout(constant_id = 4) const uint SHAPE = 0u;
layout(constant_id = 5) const bool MARCHES_ROWS = false;
// For SHAPE_PATCH.
layout(constant_id = 6) const bool HAS_SPECULAR = false;
layout(constant_id = 7) const bool SPECULAR_IS_MAP = false;
// For SHAPE_DISC.
layout(constant_id = 8) const bool HAS_VECTOR = false;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 9) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
// LATTICE selects one of these.
layout(binding = 1, rgba16ui) uniform restrict readonly uimage2DArray lattice;
layout(binding = 7) uniform utexture2DArray lattice_words;

#include "shared/angle.glsl"
#include "direct/sun_light.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform image2D sun_sum;
layout(binding = 4, rgba32f) uniform image2D specular_sum;
// Phong exponent and scale.
layout(binding = 5) uniform texture2D phong_map;
layout(binding = 9, rgba32f) uniform image2D light_vector;

// Sums of the four grid points, and their normals.
vec4 sun;
vec4 normal_east;
vec4 normal_north;
vec4 normal_up;
vec4 vector_east;
vec4 vector_north;
vec4 vector_up;

void add_specular(Azimuth azimuth, vec4 lowest);

// Adds azimuth `index`: `lowest` is the slope of the lowest direction above both the horizon and the grid point's own
// plane.
void add_light(uint index, Azimuth azimuth, vec4 lowest) {
    sun += sun_light(azimuth, normal_east, normal_north, normal_up, lowest, SHAPE);
    if (HAS_SPECULAR) {
        add_specular(azimuth, lowest);
    }
    if (HAS_VECTOR) {
        add_vector(vector_east, vector_north, vector_up, azimuth, lowest, bvec4(true));
    }
}

float dark_slope(Azimuth azimuth) {
    return azimuth.high_slope;
}

#include "direct/gather.glsl"
#include "specular/key_specular.glsl"

// Specular of a key light of radiance 1, for scale 1; and the exponents of a map.
vec4 mirrored_light;
vec4 exponents;
Mirrored mirror;

void add_specular(Azimuth azimuth, vec4 lowest) {
    if (!SPECULAR_IS_MAP) {
        mirrored_light += key_specular(exponent, azimuth, mirror, lowest);
        return;
    }
    for (int k = 0; k < 4; k++) {
        vec4 light = key_specular(exponents[k], azimuth, mirror, lowest);
        mirrored_light[k] += light[k];
    }
}

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    ivec2 place = place_of_four();
    int lane = place.x;
    int march = place.y;
    if (lane >= lanes || march >= steps) {
        return;
    }
    bvec4 lit = lit_texels(lane, march);
    if (!any(lit)) {
        return;
    }
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    normal_up = inversesqrt(1.0 + east * east + north * north);
    normal_east = -east * normal_up;
    normal_north = -north * normal_up;
    sun = vec4(0.0);
    if (clears == 0u) {
        for (int k = 0; k < 4; k++) {
            sun[k] = imageLoad(sun_sum, texel_at(min(lane + k, lanes - 1), march)).x;
        }
    }
    vector_east = vec4(0.0);
    vector_north = vec4(0.0);
    vector_up = vec4(0.0);
    vec4 scales = vec4(1.0);
    if (HAS_SPECULAR) {
        mirrored_light = vec4(0.0);
        vec4 lane_at = vec4(lane, lane + 1, lane + 2, lane + 3);
        vec4 column = MARCHES_ROWS ? lane_at : vec4(march);
        vec4 row = MARCHES_ROWS ? vec4(march) : lane_at;
        mirror = mirrored(normal_east, normal_north, normal_up, column * cell_x_m, (float(rows - 1) - row) * cell_y_m,
                          q.here.four, eye_m);
        if (SPECULAR_IS_MAP) {
            for (int k = 0; k < 4; k++) {
                vec2 of = texelFetch(phong_map, texel_at(min(lane + k, lanes - 1), march), 0).xy;
                exponents[k] = of.x;
                scales[k] = of.y;
            }
        }
    }
    add_all(q, lanes, steps, east, north);
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        if (lit[k]) {
            imageStore(sun_sum, at, vec4(sun[k]));
        }
        if (HAS_VECTOR) {
            vec4 before = clears == 0u ? imageLoad(light_vector, at) : vec4(0.0);
            imageStore(light_vector, at, before + vec4(vector_east[k], vector_north[k], vector_up[k], 0.0));
        }
        if (HAS_SPECULAR) {
            vec4 before = imageLoad(specular_sum, at);
            vec4 light = vec4(colour.rgb * (scales[k] * mirrored_light[k]), 0.0);
            vec4 sum = before + light;
            imageStore(specular_sum, at, colour.w > 0.0 ? light : sum);
        }
    }
}
