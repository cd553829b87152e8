#include "shared/slopes.glsl"

// Loads four grid points side by side along the lane axis, and those around them. Where LANE_STRIDE is not 1 they are
// nodes, that many lanes apart. The including shader declares `lane_heights` and the constants LANE_STRIDE, BORDER and
// MARCHES_ROWS.

// Heights are loaded four lanes at a time, as an image rather than a texture: llvmpipe (Mesa 22.3)
// calls a function to fetch from a texture, but loads from an image in place.
float height_at(int lane, int march) {
#ifdef LANE_WINDOWS
    if (READS_LANE_WINDOWS) {
        return imageLoad(lane_heights, ivec2(lane + 3, march)).x;
    }
#endif
    vec4 four = imageLoad(lane_heights, ivec2(lane >> 2, march));
    vec2 two = mix(four.xy, four.zw, bvec2((lane & 2) != 0));
    return mix(two.x, two.y, (lane & 1) != 0);
}

// Heights of a lane and the next. With READS_LANE_WINDOWS they are one load; with READS_LANE_BUFFER they are two loads of 4 bytes
// instead of two texels of 16.
vec2 two_heights_at(int lane, int next, int march, int lanes) {
#ifdef LANE_WINDOWS
    if (READS_LANE_WINDOWS) {
        return imageLoad(lane_heights, ivec2(lane + 3, march)).xy;
    }
#endif
#ifdef LANE_BUFFER
    if (READS_LANE_BUFFER) {
        int row = LANE_BUFFER_PAD + march * ((lanes + 3) & ~3);
        return vec2(lane_buffer[row + lane], lane_buffer[row + next]);
    }
#endif
    return vec2(height_at(lane, march), height_at(next, march));
}

Strip strip_at(int lane, int march, int lanes) {
    Strip s;
    if (LANE_STRIDE > 1) {
        for (int k = 0; k < 4; k++) {
            int own = min(lane + k * LANE_STRIDE, lanes - 1);
            s.below[k] = height_at(neighbour(own - 1, lanes), march);
            s.four[k] = height_at(own, march);
            s.above[k] = height_at(neighbour(own + 1, lanes), march);
        }
        return s;
    }
    int texel = lane >> 2;
#ifdef LANE_WINDOWS
    texel = READS_LANE_WINDOWS ? lane + 3 : texel;
#endif
    s.four = imageLoad(lane_heights, ivec2(texel, march));
    s.below = vec4(height_at(neighbour(lane - 1, lanes), march), s.four.xyz);
    s.above = vec4(s.four.yzw, height_at(neighbour(lane + 4, lanes), march));
    return s;
}

Quad quad_at(int lane, int march, int lanes, int steps) {
    Quad q;
    ivec4 apart = ivec4(lane, lane + LANE_STRIDE, lane + 2 * LANE_STRIDE, lane + 3 * LANE_STRIDE);
    ivec4 nodes = min(apart, lanes - 1);
    ivec4 side_by_side = lane + ivec4(0, 1, 2, 3);
    q.lane = LANE_STRIDE > 1 ? nodes : side_by_side;
    q.march = march;
    q.before = strip_at(lane, neighbour(march - 1, steps), lanes);
    q.here = strip_at(lane, march, lanes);
    q.after = strip_at(lane, neighbour(march + 1, steps), lanes);
    return q;
}
