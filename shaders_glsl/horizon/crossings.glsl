#include "shared/quad.glsl"
#include "horizon/surface.glsl"

// Crossings of a grid point's own line with grid lines and diagonals. The including shader declares what quad.glsl needs.

// Heights of four flipped lanes from one on, at a flipped step. Lanes beyond a field that does not repeat have an
// arbitrary height and do not count.
vec4 row_at(Azimuth azimuth, int lane, int step, int lanes, int steps) {
    int march = march_position(azimuth, neighbour(step, steps), steps);
    bool flips = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    int mirrored = lanes - 4 - lane;
    int first = flips ? mirrored : lane;
    vec4 row;
#ifdef LANE_WINDOWS
    if (READS_LANE_WINDOWS) {
        first = BORDER == BORDER_PERIODIC ? wrapped(first, lanes) : clamp(first, -3, lanes - 1);
        row = imageLoad(lane_heights, ivec2(first + 3, march));
        return mix(row, row.wzyx, bvec4(flips));
    }
#endif
    if (BORDER == BORDER_PERIODIC) {
        for (int i = 0; i < 4; i++) {
            row[i] = height_at(lane_position(azimuth, wrapped(lane + i, lanes), lanes), march);
        }
        return row;
    }
#ifdef LANE_BUFFER
    if (READS_LANE_BUFFER) {
        // Clamping changes only the heights of lanes beyond the field.
        int length = (lanes + 3) & ~3;
        uint base = uint(clamp(LANE_BUFFER_PAD + march * length + first, 0, LANE_BUFFER_PAD + steps * length));
        row = vec4(lane_buffer[base], lane_buffer[base + 1u], lane_buffer[base + 2u], lane_buffer[base + 3u]);
        return mix(row, row.wzyx, bvec4(flips));
    }
#endif
    int last_texel = (lanes - 1) >> 2;
    vec4 a = imageLoad(lane_heights, ivec2(clamp(first >> 2, 0, last_texel), march));
    vec4 b = imageLoad(lane_heights, ivec2(clamp((first >> 2) + 1, 0, last_texel), march));
    vec4 by_one = vec4(a.yzw, b.x);
    vec4 by_three = vec4(a.w, b.xyz);
    vec4 even = mix(a, vec4(a.zw, b.xy), bvec4((first & 2) != 0));
    vec4 odd = mix(by_one, by_three, bvec4((first & 2) != 0));
    row = mix(even, odd, bvec4((first & 1) != 0));
    return mix(row, row.wzyx, bvec4(flips));
}

// Raises `best` (slope, steps) to the highest crossing of a grid point's own line with grid lines and diagonals
// between two distances in steps, rounded outwards to whole steps on the near side. In flipped lanes and steps.
void look_around(Azimuth azimuth, int lane, int step, float own, ivec2 ahead, int lanes, int steps, inout vec2 best) {
    bool wraps = BORDER == BORDER_PERIODIC;
    bool split_along = ((azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u) == ((azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u);
    float advance = float(azimuth.shear) * (1.0 / float(CELL));
    int y = lane * CELL - (ahead.x - 1) * azimuth.shear;
    int nearer_cell = y >> CELL_SHIFT;
    vec4 nearer = row_at(azimuth, nearer_cell - 1, step - ahead.x + 1, lanes, steps);
    for (int back = ahead.x; back <= ahead.y; back++) {
        bool on = wraps || azimuth.shear == 0 || y > 0;
        y -= azimuth.shear;
        int cell = y >> CELL_SHIFT;
        float f0 = float(y & (CELL - 1)) * (1.0 / float(CELL));
        vec4 farther = row_at(azimuth, cell - 1, step - back, lanes, steps);
        // From the line's cell on, at both ends of the step.
        vec3 far = farther.yzw;
        vec3 near = mix(nearer.xyz, nearer.yzw, bvec3(cell == nearer_cell));
        float rise = (far.x - own) + f0 * (far.y - far.x);
        float found = rise / (float(back) * azimuth.step_m);
        bool better = on && (wraps || y >= 0) && found > best.x;
        best = mix(best, vec2(found, float(back)), bvec2(better));
        vec3 places = segment_crossings(f0, advance, split_along);
        for (int c = 0; c < 3; c++) {
            float u = places[c];
            float f = f0 + u * advance;
            bool next = f > 1.0;
            f -= next ? 1.0 : 0.0;
            vec2 h0 = mix(far.xy, far.yz, bvec2(next));
            vec2 h1 = mix(near.xy, near.yz, bvec2(next));
            rise = surface_rise(h0.x, h1.x, h0.y, h1.y, own, u, f, split_along);
            float distance_steps = float(back) - u;
            found = rise / (distance_steps * azimuth.step_m);
            better = on && u < 1.0 && (wraps || float(y) + u * float(azimuth.shear) >= -0.5) && found > best.x;
            best = mix(best, vec2(found, distance_steps), bvec2(better));
        }
        nearer = farther;
        nearer_cell = cell;
    }
}
