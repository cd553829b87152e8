// Computes: exit radiance under a uniform sky and under an environment, from the horizons in the azimuths of a batch,
// added to earlier batches; and the light that the horizons hide from a Phong lobe.
// Reads: lane_heights, lane_buffer, azimuths, lattice, env_tables, specular_tables, phong_map, constants, dirty_texels,
// edit_list.
// Reads and writes: sky_sum (exit radiance for sky radiance 1 and albedo 1), env_sum (exit radiance for albedo 1,
// RGB), blocked_sum (radiance for scale 1, RGB), blocked_above (of a map: for the level of exponents above).
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
layout(constant_id = 4) const bool HAS_SKY = true;
layout(constant_id = 5) const bool HAS_ENVIRONMENT = false;
layout(constant_id = 6) const bool MARCHES_ROWS = false;
layout(constant_id = 7) const bool HAS_SPECULAR = false;
// One table of lobes for all azimuths, of a sky alone.
layout(constant_id = 8) const bool SPECULAR_IS_SHARED = false;

#define LANE_BUFFER
layout(constant_id = 9) const bool READS_LANE_BUFFER = false;
// The exponent varies; see levels.glsl.
layout(constant_id = 10) const bool SPECULAR_IS_MAP = false;

#define LANE_WINDOWS
// The image bound as lane_heights is lane_windows.
layout(constant_id = 11) const bool READS_LANE_WINDOWS = false;

layout(binding = 0, rgba32f) uniform restrict readonly image2D lane_heights;
layout(binding = 11) readonly buffer LaneBuffer { float lane_buffer[]; };
layout(binding = 12) readonly buffer AzimuthBuffer { vec4 azimuth_buffer[]; };
// LATTICE selects one of these.
layout(binding = 1, rgba16ui) uniform restrict readonly uimage2DArray lattice;
layout(binding = 7) uniform utexture2DArray lattice_words;

#include "shared/angle.glsl"

layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32f) uniform image2D sky_sum;
layout(binding = 4, rgba32f) uniform image2D env_sum;
// RGB: moment (y: cos, sin, vertical) of the light above a node (x), by azimuth (layer). Alpha of moments 0, 1 and 2: red,
// green and blue of the mean radiance up to the next node. Nodes are even in the sine of the elevation.
layout(binding = 5, rgba32f) uniform readonly image2DArray env_tables;
// x: elevation of the lobe's peak, y: elevation, layer: azimuth.
layout(binding = 9, rgba32f) uniform readonly image2DArray specular_tables;
layout(binding = 10, rgba32f) uniform image2D blocked_sum;
layout(binding = 13, rgba32f) uniform image2D blocked_above;
// Phong exponent and scale.
layout(binding = 14) uniform texture2D phong_map;
layout(binding = 15) uniform textureBuffer constants;

// Sums of the four grid points, and their normals.
vec4 sky;
vec4 env_red;
vec4 env_green;
vec4 env_blue;
vec4 normal_east;
vec4 normal_north;
vec4 normal_up;

void add_hidden(uint index, Azimuth azimuth, vec4 lowest);

// Adds the environment above `lowest`: the moments above the node below it, less the part up to it. That part is taken
// as even, with the integrals of cos^2 and of sin cos over it: the cosine and the sine at its middle, times its width in
// the sine. Half the loads of an interpolation between nodes, and no angle.
void add_environment(uint index, Azimuth azimuth, vec4 lowest) {
    int nodes = imageSize(env_tables).x;
    float bottom = BORDER == BORDER_OPEN ? -1.0 : 0.0;
    float step = (1.0 - bottom) / float(nodes - 1);
    vec4 cosine = inversesqrt(1.0 + lowest * lowest);
    vec4 sine = lowest * cosine;
    ivec4 node = clamp(ivec4((sine - bottom) / step), 0, nodes - 2);
    vec4 node_sine = bottom + step * vec4(node);
    vec4 width = clamp(sine - node_sine, 0.0, step);
    // The cosine falls by the slope times the sine's rise. At the zenith, where the slope has no bound, its mean over a
    // whole step is 2/3 sqrt(2 step).
    float most = sqrt(8.0 / 9.0 * step);
    vec4 middle = cosine + min(max(0.5 * lowest * width, -most), most);
    vec4 flat_part = normal_east * azimuth.wedge_cos + normal_north * azimuth.wedge_sin;
    vec4 up_part = normal_up * azimuth.wedge_rad;
    vec4 hidden = (flat_part * middle + up_part * (node_sine + 0.5 * width)) * (width * (1.0 / PI));
    for (int k = 0; k < 4; k++) {
        vec4 east = imageLoad(env_tables, ivec3(node[k], 0, index));
        vec4 north = imageLoad(env_tables, ivec3(node[k], 1, index));
        vec4 up = imageLoad(env_tables, ivec3(node[k], 2, index));
        vec3 sum = normal_east[k] * east.rgb + normal_north[k] * north.rgb + normal_up[k] * up.rgb;
        sum -= hidden[k] * vec3(east.a, north.a, up.a);
        env_red[k] += sum.r;
        env_green[k] += sum.g;
        env_blue[k] += sum.b;
    }
}

// Adds azimuth `index`: `lowest` is the slope of the lowest direction above both the horizon and the grid point's own
// plane.
void add_light(uint index, Azimuth azimuth, vec4 lowest) {
    if (HAS_SKY) {
        // TW10 eq. 5, with the normal integrated over the wedge instead of evaluated at its centre.
        Moments moments = elevation_moments(lowest);
        vec4 flat_part = normal_east * azimuth.wedge_cos + normal_north * azimuth.wedge_sin;
        sky += (flat_part * moments.flat_part + normal_up * azimuth.wedge_rad * moments.vertical) * (1.0 / PI);
    }
    if (HAS_ENVIRONMENT) {
        add_environment(index, azimuth, lowest);
    }
    if (HAS_SPECULAR) {
        add_hidden(index, azimuth, lowest);
    }
}

float dark_slope(Azimuth azimuth) {
    return -NO_SLOPE;
}

#include "direct/gather.glsl"
#include "specular/blocked.glsl"

void add_hidden(uint index, Azimuth azimuth, vec4 lowest) {
    add_blocked(index, azimuth, lowest);
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
    sky = vec4(0.0);
    env_red = vec4(0.0);
    env_green = vec4(0.0);
    env_blue = vec4(0.0);
    blocked[0] = Blocked(vec4(0.0), vec4(0.0), vec4(0.0));
    blocked[1] = blocked[0];
    if (HAS_SPECULAR) {
        vec4 lane_at = vec4(lane, lane + 1, lane + 2, lane + 3);
        vec4 column = MARCHES_ROWS ? lane_at : vec4(march);
        vec4 row = MARCHES_ROWS ? vec4(march) : lane_at;
        mirror = mirrored(normal_east, normal_north, normal_up, column * cell_x_m, (float(rows - 1) - row) * cell_y_m,
                          q.here.four, eye_m);
        if (SPECULAR_IS_MAP) {
            ivec4 across = min(lane + ivec4(0, 1, 2, 3), lanes - 1);
            find_specular(MARCHES_ROWS ? across : ivec4(march), MARCHES_ROWS ? ivec4(march) : across);
        }
    }
    if (clears == 0u) {
        for (int k = 0; k < 4; k++) {
            ivec2 at = texel_at(min(lane + k, lanes - 1), march);
            if (HAS_SKY) {
                sky[k] = imageLoad(sky_sum, at).x;
            }
            if (HAS_ENVIRONMENT) {
                vec3 sum = imageLoad(env_sum, at).rgb;
                env_red[k] = sum.r;
                env_green[k] = sum.g;
                env_blue[k] = sum.b;
            }
            if (HAS_SPECULAR) {
                vec3 sum = imageLoad(blocked_sum, at).rgb;
                blocked[0].red[k] = sum.r;
                blocked[0].green[k] = sum.g;
                blocked[0].blue[k] = sum.b;
            }
            if (HAS_SPECULAR && SPECULAR_IS_MAP) {
                vec3 sum = imageLoad(blocked_above, at).rgb;
                blocked[1].red[k] = sum.r;
                blocked[1].green[k] = sum.g;
                blocked[1].blue[k] = sum.b;
            }
        }
    }
    add_all(q, lanes, steps, east, north);
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 at = texel_at(lane + k, march);
        if (HAS_SKY && lit[k]) {
            imageStore(sky_sum, at, vec4(sky[k]));
        }
        if (HAS_ENVIRONMENT && lit[k]) {
            imageStore(env_sum, at, vec4(env_red[k], env_green[k], env_blue[k], 0.0));
        }
        if (HAS_SPECULAR && lit[k]) {
            imageStore(blocked_sum, at, vec4(blocked[0].red[k], blocked[0].green[k], blocked[0].blue[k], 0.0));
        }
        if (HAS_SPECULAR && SPECULAR_IS_MAP && lit[k]) {
            imageStore(blocked_above, at, vec4(blocked[1].red[k], blocked[1].green[k], blocked[1].blue[k], 0.0));
        }
    }
}
