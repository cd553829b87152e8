// Computes: incident light of a key light at every grid point as a series of spherical harmonics, from the horizons in the
// azimuths that it covers, added to earlier batches and lights. For bounces of specular light.
// Reads: lane_heights, azimuths, lattice.
// Reads and writes: arriving (four coefficients per layer, channel after channel).
// One invocation is four grid points side by side along the lane axis, at one march position.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

layout(constant_id = 0) const uint FUSE = 5u;
layout(constant_id = 1) const uint LATTICE = 0u;
layout(constant_id = 2) const int LINE_SHIFT = 15;
layout(constant_id = 3) const uint BORDER = 0u;
layout(constant_id = 4) const bool MARCHES_ROWS = false;
layout(constant_id = 5) const int ORDER = 4;
// One channel of radiance.
layout(constant_id = 6) const bool GREY = false;
const bool LATTICE_HAS_DISTANCES = false;
const int LATTICE_STRIDE = 1;
const int LANE_STRIDE = 1;
const bool OWN_PLANE_HIDES = true;
const bool CAN_RELIGHT = false;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 7) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
// LATTICE selects one of these.
layout(binding = 1, rgba16ui) uniform restrict readonly uimage2DArray lattice;
layout(binding = 7) uniform utexture2DArray lattice_words;

#include "shared/angle.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, rgba32f) uniform image2DArray arriving;

vec4 harmonics[36];
#include "shared/harmonics.glsl"

// Nodes and weights of Gauss and Legendre on [0, 1].
const float NODES[4] = float[](0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558);
const float WEIGHTS[4] = float[](0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226);

// Integrals of the harmonics over the visible directions, of the four grid points.
vec4 sums[36];

void add_light(uint index, Azimuth azimuth, vec4 lowest);
float dark_slope(Azimuth azimuth) {
    return azimuth.high_slope;
}

#include "direct/gather.glsl"

const int COUNT = ORDER * ORDER;
const int FOURS = (COUNT + 3) / 4;
const int CHANNELS = GREY ? 1 : 3;

// A wedge of azimuths has equal solid angles in equal steps of the sine of elevation. Harmonics of even m are polynomials of it, which
// four nodes integrate exactly. Those of odd m have the cosine of elevation as a factor: they err by at most 1 % of the wedge's
// solid angle where it ends at horizontal, 4 % from nadir to zenith.
void add_light(uint index, Azimuth azimuth, vec4 lowest) {
    vec4 slope = max(lowest, vec4(azimuth.low_slope));
    vec4 low = slope * inversesqrt(1.0 + slope * slope);
    float high = azimuth.high_slope * inversesqrt(1.0 + azimuth.high_slope * azimuth.high_slope);
    vec4 width = max(high - low, vec4(0.0));
    if (all(equal(width, vec4(0.0)))) {
        return;
    }
    for (int i = 0; i < 4; i++) {
        vec4 up = low + NODES[i] * width;
        vec4 flat_part = sqrt(max(1.0 - up * up, vec4(0.0)));
        find_harmonics(flat_part * azimuth.cos_phi, flat_part * azimuth.sin_phi, up);
        vec4 weight = (WEIGHTS[i] * azimuth.wedge_rad) * width;
        for (int k = 0; k < COUNT; k++) {
            sums[k] += weight * harmonics[k];
        }
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
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    // Zero past the last coefficient.
    for (int k = 0; k < 36; k++) {
        sums[k] = vec4(0.0);
    }
    add_all(q, lanes, steps, east, north);
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        for (int i = 0; i < FOURS; i++) {
            vec4 four = vec4(sums[4 * i][k], sums[4 * i + 1][k], sums[4 * i + 2][k], sums[4 * i + 3][k]);
            for (int c = 0; c < CHANNELS; c++) {
                ivec3 layer = ivec3(at, c * FOURS + i);
                vec4 light = colour[c] * four;
                if (colour.w == 0.0) {
                    light += imageLoad(arriving, layer);
                }
                imageStore(arriving, layer, light);
            }
        }
    }
}
