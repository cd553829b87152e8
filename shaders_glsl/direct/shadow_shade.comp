// Computes: direct light of a sun or a narrow key light where the shadow heights around a grid point prove in every azimuth that it sees the whole
// chord of the sun. The other grid points that face the sun are marked.
// Reads: lane_heights, azimuths, shadows.
// Writes: doubtful, at [march position][lane / 4]: the four lowest bits of a word mark grid points side by side along the lane axis.
// Reads and writes: sun_sum (exit radiance for albedo 1, irradiance 1), light_vector (see sun_light.glsl).
// One invocation is four grid points side by side along the lane axis, at one march position.
//
// A grid point's own line runs between two swept lines. Nothing on it, beyond its first step, is above the interpolation
// of their shadow heights (see shadow_sweep), so it sees the whole chord where it stands at least as high.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 16) in;

const int LANE_STRIDE = 1;
layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
// See sun_light.glsl.
layout(constant_id = 2) const uint SHAPE = 0u;
layout(constant_id = 3) const bool HAS_VECTOR = false;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, rgba32ui) uniform readonly uimage2DArray shadows;
layout(binding = 3, r32f) uniform image2D sun_sum;
layout(binding = 4, r32ui) uniform writeonly uimage2D doubtful;
layout(binding = 5, rgba32f) uniform image2D light_vector;

#include "shared/angle.glsl"
#include "horizon/met.glsl"
#include "direct/sun_light.glsl"

layout(push_constant) uniform ShadowShadePush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int warm_up;
    uint first_azimuth;  // of the batch
    uint azimuth_count;
    uint clears;         // 1 in the first batch
};

// Words of the lines before (or through) and after four grid points, and the places `t` between them. Returns whether they
// are lines of the lattice.
bvec4 shadows_around(Azimuth azimuth, int lane, int march, int lanes, int steps, out uvec4 before, out uvec4 after, out vec4 t) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool flips = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int total = warm_up + steps;
    int lead = lattice_lead(azimuth.shear, total, CELL_SHIFT, wraps);
    int lines = lattice_lines(lanes, lead, CELL_SHIFT, wraps);
    int step = warm_up + march_position(azimuth, march, steps);
    // The lowest of the four lanes in the order of the lines.
    int lowest = flips ? lanes - 4 - lane : lane;
    int from_origin = (lowest + lead) * CELL - step * azimuth.shear;
    int line = from_origin >> CELL_SHIFT;
    t = vec4(float(from_origin & (CELL - 1)) * (1.0 / float(CELL)));
    uint five[5];
    if (wraps) {
        for (int k = 0; k < 5; k++) {
            int at = wrapped(line + k, lines);
            five[k] = imageLoad(shadows, lattice_texel(azimuth, at, step))[at & 3];
        }
    } else {
        // Lines that do not exist have arbitrary words.
        int first = clamp(line, 0, lines - 1);
        int second = clamp(line + 4, 0, lines - 1);
        uvec4 a = imageLoad(shadows, lattice_texel(azimuth, first, step));
        uvec4 b = imageLoad(shadows, lattice_texel(azimuth, second, step));
        uvec4 low = mix(a, uvec4(a.zw, b.xy), bvec4((line & 2) != 0));
        uvec2 high = mix(b.xy, b.zw, bvec2((line & 2) != 0));
        bvec4 odd = bvec4((line & 1) != 0);
        uvec4 four = mix(low, uvec4(low.yzw, high.x), odd);
        five = uint[](four.x, four.y, four.z, four.w, mix(high.x, high.y, odd.x));
    }
    before = uvec4(five[0], five[1], five[2], five[3]);
    after = uvec4(five[1], five[2], five[3], five[4]);
    before = mix(before, before.wzyx, bvec4(flips));
    after = mix(after, after.wzyx, bvec4(flips));
    if (wraps) {
        return bvec4(true);
    }
    ivec4 place = line + mix(ivec4(0, 1, 2, 3), ivec4(3, 2, 1, 0), bvec4(flips));
    bvec4 has_before = bvec4(uvec4(greaterThanEqual(place, ivec4(0))) & uvec4(lessThan(place, ivec4(lines))));
    bvec4 has_after = bvec4(uvec4(greaterThanEqual(place, ivec4(-1))) & uvec4(lessThan(place, ivec4(lines - 1))));
    // On a line there is no other.
    bool is_on_line = t.x == 0.0;
    has_after = bvec4(uvec4(has_after) | uvec4(bvec4(is_on_line)));
    after = mix(after, before, bvec4(is_on_line));
    bvec4 known = bvec4(uvec4(has_before) & uvec4(has_after));
    before = mix(uvec4(0), before, known);
    after = mix(uvec4(0), after, known);
    return known;
}

void main() {
    int lanes = MARCHES_ROWS ? cols : rows;
    int steps = MARCHES_ROWS ? rows : cols;
    int lane = int(gl_GlobalInvocationID.y) * 4;
    int march = int(gl_GlobalInvocationID.x);
    if (lane >= lanes || march >= steps) {
        return;
    }
    Quad q = quad_at(lane, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), east, north);
    vec4 normal_up = inversesqrt(1.0 + east * east + north * north);
    vec4 normal_east = -east * normal_up;
    vec4 normal_north = -north * normal_up;
    float ground = BORDER == BORDER_OPEN ? NO_SLOPE : 0.0;

    vec4 sun = vec4(0.0);
    vec4 vector_east = vec4(0.0);
    vec4 vector_north = vec4(0.0);
    vec4 vector_up = vec4(0.0);
    bvec4 doubts = bvec4(false);
    for (uint k = first_azimuth; k < first_azimuth + azimuth_count; k++) {
        Azimuth azimuth = azimuth_at(azimuths, k);
        // Rise of the grid point's own tangent plane along the azimuth (TW10 eq. 4); and of level ground around the field.
        vec4 own = max(east * azimuth.cos_phi + north * azimuth.sin_phi, ground);
        bvec4 faces = lessThan(own, vec4(azimuth.high_slope));
        uvec4 before;
        uvec4 after;
        vec4 t;
        bvec4 known = shadows_around(azimuth, lane, march, lanes, steps, before, after, t);
        Met met = first_crossings(azimuth, q, lanes, steps);
        // The heights of the shadows are the words' high halves.
        vec4 shadow = mix(uintBitsToFloat(before & 0xffff0000u), uintBitsToFloat(after & 0xffff0000u), t);
        vec4 over_lines = t * (1.0 - t) * ((q.here.four - q.here.below) + (q.here.four - q.here.above));
        bvec4 over_shadow = lessThanEqual(shadow, over_lines);
        bvec4 ahead_is_low = lessThanEqual(met.slope, vec4(azimuth.low_slope));
        bvec4 sees_all = bvec4(uvec4(known) & uvec4(over_shadow) & uvec4(ahead_is_low));
        doubts = bvec4(uvec4(doubts) | (uvec4(faces) & uvec4(not(sees_all))));
        vec4 light = sun_light(azimuth, normal_east, normal_north, normal_up, own, SHAPE);
        bvec4 lit = bvec4(uvec4(faces) & uvec4(sees_all));
        sun += mix(vec4(0.0), light, lit);
        if (HAS_VECTOR) {
            add_vector(vector_east, vector_north, vector_up, azimuth, own, lit);
        }
    }
    uint marks = 0u;
    for (int k = 0; k < 4 && lane + k < lanes; k++) {
        ivec2 texel = texel_at(lane + k, march);
        marks |= doubts[k] ? 1u << k : 0u;
        if (!doubts[k]) {
            float sum = clears == 0u ? imageLoad(sun_sum, texel).x : 0.0;
            imageStore(sun_sum, texel, vec4(sum + sun[k]));
            if (HAS_VECTOR) {
                vec4 before = clears == 0u ? imageLoad(light_vector, texel) : vec4(0.0);
                imageStore(light_vector, texel, before + vec4(vector_east[k], vector_north[k], vector_up[k], 0.0));
            }
        }
    }
    imageStore(doubtful, ivec2(lane >> 2, march), uvec4(marks));
}
