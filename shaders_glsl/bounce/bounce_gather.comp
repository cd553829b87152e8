// Computes: indirect light at every grid point from pyramids of heights and of exit radiance: along each azimuth one
// lookup per level, at distances that grow by 2^(1/k) and are rounded to whole march steps. Each knot and midpoint of
// the B-spline over their elevations that rises above all before it contributes its radiance over the newly visible
// elevations (Nowrouzezahrai & Snyder 2009, eq. 6-17).
// Reads: heights, height_levels or height_stack, level_table, ground, exit_radiance, shade_levels or shade_stack,
// shade_table.
// Reads and writes: bounce_sum (exit radiance for albedo 1; divided by A, the sum for whole hemispheres, after the
// last azimuths).
// One invocation is one grid point, or one node: bounce_sum has a texel for each.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool PERIODIC = false;
// Levels are stored at every grid point, else at their own texels.
layout(constant_id = 1) const bool STACK = false;
// Levels besides the field itself; may be 0.
layout(constant_id = 2) const int LEVELS = 0;
layout(constant_id = 3) const int SHADE_LEVELS = 0;
// One channel of radiance.
layout(constant_id = 4) const bool GREY = false;
// Exact cosine; else three bands of it, and four Legendre coefficients a slice.
layout(constant_id = 5) const bool IS_PLANE = true;
// Grid points from node to node: 1, 2, 4 or 8.
layout(constant_id = 6) const int NODE_STRIDE = 1;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D height_levels;
layout(binding = 2) uniform utexture2D level_table;
layout(binding = 3) uniform texture2DArray height_stack;
layout(binding = 4) uniform texture2D ground;
layout(binding = 5) uniform texture2D exit_radiance;
layout(binding = 6) uniform texture2D shade_levels;
layout(binding = 7) uniform utexture2D shade_table;
layout(binding = 8, rgba32f) uniform image2D bounce_sum;
layout(binding = 9) uniform texture2DArray shade_stack;

#include "bounce/cast.glsl"
#include "shared/nodes.glsl"

// The slice.
Facing facing;
vec2 reached;    // direction up to which the surface has been visited
float top;       // its elevation
vec3 indirect;
mat3x4 series;   // Legendre coefficients, R, G, B

// Integrals of the first four normalised Legendre polynomials of z = sin(omega) below an elevation (eq. 13).
vec4 occlusion(vec2 direction) {
    float s = direction.y;
    float c2 = direction.x * direction.x;
    return vec4(0.70710678 * (s + 1.0), -0.61237244 * c2, -0.79056942 * s * c2, 0.23385359 * c2 * (5.0 * c2 - 4.0));
}

// Visible where it rises above all before.
void cast_light(float angle, vec2 place, int level, bool on) {
    bool rises = on && angle > top;
    if (!subgroupAny(rises)) {
        return;
    }
    vec2 direction = vec2(cosine(angle), sine(angle));
    vec3 radiance = radiance_at(level, place);
    if (IS_PLANE) {
        float weight = max(light_between(facing, reached, direction), 0.0);
        float counts = rises ? weight : 0.0;
        indirect += counts * radiance;
    } else {
        vec4 opened = occlusion(direction) - occlusion(reached);
        opened = rises ? opened : vec4(0.0);
        series[0] += radiance.r * opened;
        series[1] += radiance.g * opened;
        series[2] += radiance.b * opened;
    }
    reached = rises ? direction : reached;
    top = rises ? angle : top;
}

// Contribution of a series to the three bands 1/4 + c/2 + 5/32 (3 c^2 - 1) of the clamped cosine of c = f cos(omega)
// + u sin(omega): the sum of spherical harmonics over azimuth, by their addition theorem. With s = cos(omega), over z
// of -1 .. 1:
//   int P0 = sqrt(2), int z^2 P0 = sqrt(2)/3, int s P0 = pi/(2 sqrt(2)), int z P1 = sqrt(2/3), int z s P1 = sqrt(3/2) pi/8,
//   int z^2 P2 = sqrt(8/45), int s P2 = -sqrt(5/2) pi/16, int z s P3 = -sqrt(7/2) pi/32.
vec4 three_bands() {
    float f = facing.flat_part;
    float u = facing.up;
    float even = 0.25 - 0.15625 + 0.46875 * f * f;
    float zz = 0.46875 * (u * u - f * f);
    float zs = 0.9375 * f * u;
    return vec4(1.41421356 * even + 0.47140452 * zz + 0.5 * f * 1.11072073,
                0.5 * u * 0.81649658 + zs * 0.48095618,
                zz * 0.42163702 - 0.5 * f * 0.31045588,
                -zs * 0.18366818);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    ivec2 nodes = ivec2(node_count(cols, NODE_STRIDE), node_count(rows, NODE_STRIDE));
    bool exists = at.x < nodes.x && at.y < nodes.y;
    here = min(at * NODE_STRIDE, ivec2(cols, rows) - 1);
    vec4 own = texelFetch(ground, here, 0);
    float up = inversesqrt(1.0 + own.y * own.y + own.z * own.z);
    find_own_heights();
    vec4 before = imageLoad(bounce_sum, min(at, nodes - 1));
    vec4 sum = mix(vec4(0.0), before, bvec4(first_azimuth > 0));
    for (int k = first_azimuth; k < last_azimuth; k++) {
        vec2 e = turn_march(k, azimuths, vec2(cell_x_m, cell_y_m));
        // Rise of the grid point's own tangent plane along the azimuth.
        float own_slope = own.y * e.x + own.z * e.y;
        facing = Facing(-own_slope * up, up);
        reached = direction_of(own_slope);
        top = arc_tangent(vec4(own_slope)).x;
        indirect = vec3(0.0);
        series = mat3x4(0.0);
        float whole = light_between(facing, reached, vec2(0.0, 1.0));
        march(exists);
        if (!IS_PLANE) {
            vec4 weights = three_bands();
            // Per azimuth int u K dz; a whole hemisphere's is pi/2 of the sum in `indirect`.
            indirect = vec3(dot(series[0], weights), dot(series[1], weights), dot(series[2], weights));
            whole = 0.5;
        }
        sum += vec4(indirect, whole);
    }
    if (exists) {
        // Weights over a whole hemisphere sum to 1: uniform incident radiance is preserved.
        vec4 light = vec4(max(sum.rgb, vec3(0.0)) / max(sum.a, 1e-30), 1.0);
        bool is_whole = last_azimuth == azimuths;
        imageStore(bounce_sum, at, is_whole ? light : sum);
    }
}
