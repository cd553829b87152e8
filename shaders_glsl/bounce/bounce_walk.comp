// Computes: indirect light at every grid point from the azimuths of a batch, added to earlier batches: the visible
// ground along the grid point's own line step by step, and farther away in the blocks of the nearest swept line, up to
// the horizon at the occluder that this line has stored; each part with its own radiance, weighted in closed form.
// Reads: azimuths, occluders, line_blocks and bounce_ground (or grey_blocks and grey_ground).
// Reads and writes: bounce_sum (exit radiance for albedo 1; divided by A, the sum for whole hemispheres, after the
// last dispatch); where FINDS_SHARE, sky_share (exit radiance under a sky of radiance 1).
// Writes: visibility_cache (of the nodes of later bounces).
// One invocation is one grid point, or one node: bounce_sum has a texel for each.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

// Side by side across the lanes, as lines are in line_blocks.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int LINE_SHIFT = 15;
layout(constant_id = 1) const uint BORDER = 0u;
layout(constant_id = 2) const bool MARCHES_ROWS = false;
// One channel of radiance.
layout(constant_id = 3) const bool GREY = false;
// Grid points from node to node: 1, 2, 4 or 8.
layout(constant_id = 4) const int NODE_STRIDE = 1;
// Nodes of a dispatch. 0: all. FROM_KEPT: every KEPT_EACH-th along both axes, and the last ones; they fill the visibility
// cache for later bounces. FROM_BETWEEN: the others of the same lanes. FROM_REST: those of the other lanes.
layout(constant_id = 5) const uint FROM = 0u;
// 2 or 4.
layout(constant_id = 6) const int KEPT_EACH = 2;
layout(constant_id = 7) const bool FINDS_SHARE = false;
const uint FROM_KEPT = 1u;
const uint FROM_BETWEEN = 2u;
const uint FROM_REST = 3u;
const bool FILLS_CACHE = FROM == FROM_KEPT;

layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, rgba16ui) uniform readonly uimage2DArray occluders;
layout(binding = 3, rgba32f) uniform readonly image2D bounce_ground;
layout(binding = 4, rgba16ui) uniform readonly uimage2D grey_ground;
layout(binding = 5, rgba32f) uniform image2D bounce_sum;
layout(binding = 6, rgba32ui) uniform writeonly uimage2DArray visibility_cache;
layout(binding = 7, rgba32ui) uniform readonly uimage2DArray line_blocks;
layout(binding = 8, rgba16ui) uniform readonly uimage2DArray grey_blocks;
layout(binding = 9, r32f) uniform image2D sky_share;

#include "shared/angle.glsl"
#include "shared/lattice.glsl"
#include "shared/slopes.glsl"
#include "shared/nodes.glsl"
#include "bounce/line_blocks.glsl"
#include "bounce/visibility_cache.glsl"

layout(push_constant) uniform BounceWalkPush {
    int cols;
    int rows;
    float cell_x_m;
    float cell_y_m;
    int warm_up;
    uint first_azimuth;
    uint azimuth_count;
    uint clears;  // 1 in the first dispatch of a bounce
    uint is_last; // 1 in the last
    uint begin;   // of the azimuths used for bounces
    uint block_layers; // of one azimuth in line_blocks
};

// The grid point, in lanes and steps of the current azimuth.
Azimuth azimuth;
uint azimuth_index;
int lanes;
int steps;
int own_lane;
int own_step;
float own_height;
ivec2 own_node;      // texel of its sum
ivec2 own_kept_node; // texel of its visibility cache

Block block_at(ivec3 texel) {
    uvec4 words;
    if (GREY) {
        words = uvec4(join_u16(imageLoad(grey_blocks, texel)), 0u, 0u);
    } else {
        words = imageLoad(line_blocks, texel);
    }
    return block_of(words);
}

// A point of the grid point's own line.
vec4 point_at(int back) {
    return ground_on_line(azimuth, own_lane * CELL - back * azimuth.shear, own_step - back, lanes, steps);
}

float slope_of(float height, float back) {
    precise float above = height - own_height;
    return above / (back * azimuth.step_m);
}

// The swept line nearest to the grid point, the lines before lane 0 at the first step, and the steps to the line's
// occluder there; 0 for none.
struct Nearest {
    int line;
    int lead;
    int back;
};

Nearest nearest_line() {
    bool wraps = BORDER == BORDER_PERIODIC;
    int spacing = 1 << LINE_SHIFT;
    int lead = lattice_lead(azimuth.shear, warm_up + steps, LINE_SHIFT, wraps);
    int lines = lattice_lines(lanes, lead, LINE_SHIFT, wraps);
    int on = own_step + warm_up;
    int origin = on * azimuth.shear - lead * spacing;
    // The nearer one; on a tie, the one before.
    int nearest = (own_lane * CELL - origin + (spacing / 2 - 1)) >> LINE_SHIFT;
    int first = (spacing - 1 - origin) >> LINE_SHIFT;
    int last = ((lanes - 1) * CELL - origin) >> LINE_SHIFT;
    bool stands = wraps || first <= last;
    int line_round = wrapped(nearest, lines);
    int first_held = max(first, 0);
    int line_held = clamp(nearest, first_held, max(first_held, last));
    int line = wraps ? line_round : line_held;
    int found = int(lattice_value(imageLoad(occluders, lattice_texel(azimuth, line, on)), line));
    return Nearest(line, lead, stands ? found : 0);
}

// Whether the own line crosses the diagonal of the grid point's cell within its first step: (1, 0) to (0, 1), by (u,
// u * shear) at u = 1 / (1 + shear).
bool crosses_split() {
    bool flips_march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u;
    bool flips_lanes = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u;
    return flips_march != flips_lanes && (BORDER == BORDER_PERIODIC || own_lane > 0);
}

// Ends of that diagonal: the grid point's neighbours across the lanes, and ahead.
ivec4 split_ends() {
    int low_round = wrapped(own_lane - 1, lanes);
    int low_held = max(own_lane - 1, 0);
    int low = BORDER == BORDER_PERIODIC ? low_round : low_held;
    int ahead_round = wrapped(own_step - 1, steps);
    int ahead_held = max(own_step - 1, 0);
    int ahead = BORDER == BORDER_PERIODIC ? ahead_round : ahead_held;
    return ivec4(lane_position(azimuth, low, lanes), march_position(azimuth, own_step, steps),
                 lane_position(azimuth, own_lane, lanes), march_position(azimuth, ahead, steps));
}

vec2 moments_above(float slope) {
    Moments moments = elevation_moments(vec4(slope));
    return vec2(moments.flat_part.x, moments.vertical.x);
}

// Progress of a walk: the surface is visible up to `reached`, the slope of the last point that rose.
vec2 faces;
vec2 passed;
float reached;
vec3 indirect;
// Of all azimuths so far: the weight of directions above the horizon.
float sky;

void add_indirect(vec2 opened, vec3 light) {
    indirect += dot(faces, opened) * light;
}

// The visibility cache so far, per ring: weights, and weights times the distance in steps.
vec4 ring_weights;
vec4 ring_moments;

// A visible part and its middle.
void add_to_cache(float middle, vec2 opened, bool on) {
    float weight = mix(0.0, max(dot(faces, opened), 0.0), on);
    vec3 within = vec3(lessThan(vec3(middle), RING_ENDS));
    vec4 of_rings = weight * (vec4(within, 1.0) - vec4(0.0, within));
    ring_weights += of_rings;
    ring_moments += middle * of_rings;
}

// Indirect light along the azimuth, on a surface with this normal that rises by `plane` along it; and the same for
// radiance 1 from every direction.
vec4 walked(vec3 normal, float plane) {
    int reach = own_step + warm_up;
    if (BORDER != BORDER_PERIODIC && azimuth.shear > 0) {
        reach = min(reach, own_lane * CELL / azimuth.shear);
    }
    // The horizon lies at the occluder, or at the edge of the field where the own line leaves it before.
    Nearest nearest = nearest_line();
    int limit = min(max(nearest.back, 1), reach);
    bool walking = limit > 0;

    faces = vec2(normal.x * azimuth.wedge_cos + normal.y * azimuth.wedge_sin, normal.z * azimuth.wedge_rad);
    passed = moments_above(plane);
    float whole = dot(faces, passed);
    indirect = vec3(0.0);
    ring_weights = vec4(0.0);
    ring_moments = vec4(0.0);
    reached = plane;
    // The triangle of the grid point: the first surface is met at once. It ends at the cell's diagonal where that is
    // crossed, else at the first step.
    bool split = crosses_split();
    ivec4 ends = split_ends();
    float u = 1.0 / (1.0 + float(azimuth.shear) * (1.0 / float(CELL)));
    vec4 side = ground_at(ends.x, ends.y);
    vec4 ahead = ground_at(ends.z, ends.w);
    precise float rise = (side.w - own_height) + u * (ahead.w - side.w);
    precise float split_slope = rise / (u * azimuth.step_m);
    vec3 own_light = ground_at(lane_position(azimuth, own_lane, lanes), ends.y).rgb;
    vec3 split_light = mix(side.rgb, ahead.rgb, u);
    bool split_rises = walking && split && split_slope > reached;
    vec2 split_moments = moments_above(split_slope);
    vec2 split_opened = mix(vec2(0.0), passed - split_moments, bvec2(split_rises));
    add_indirect(split_opened, own_light);
    if (FILLS_CACHE) {
        add_to_cache(0.0, split_opened, split_rises);
    }
    passed = mix(passed, split_moments, bvec2(split_rises));
    reached = split_rises ? split_slope : reached;
    // Start of the next piece: distance in steps, slope, and radiance.
    int at = 0;
    float from = split ? u : 0.0;
    float slope = split ? split_slope : plane;
    vec3 light = mix(own_light, split_light, bvec3(split));
    // Step by step, up to where the first block ends; without branch or vote: llvmpipe (Mesa 22.3) runs both sides of a
    // branch and expands a vote into eight. It also lets a lane that has left the loop keep computing, so a result
    // counts only while the lane is still walking; the compiler does not know this of `turns_on`.
    int on = own_step + warm_up;
    int near_limit = min(limit, near_steps() + (on & 1));
    int turns_on = int(walking);
    while (turns_on > 0) {
        int to = min(at + 1, max(limit, 1));
        vec4 point = point_at(to);
        float to_slope = slope_of(point.w, float(to));
        vec3 there = point.rgb;
        bool rises = walking && to_slope > reached;
        bool is_own = at == 0 && !split;
        vec3 far = mix(there, own_light, bvec3(is_own));
        // Where the piece rises over what is before it; radiance is linear.
        float under = max(reached - slope, 0.0) * from;
        float over = (to_slope - reached) * float(to);
        float hidden = under / max(under + over, 1e-30);
        vec3 begins = mix(light, far, hidden);
        vec2 now = moments_above(to_slope);
        vec2 opened = mix(vec2(0.0), passed - now, bvec2(rises));
        add_indirect(opened, mix(vec3(0.0), 0.5 * (begins + far), bvec3(rises)));
        if (FILLS_CACHE) {
            float begin_of = mix(from, float(to), hidden);
            float middle = mix(0.5 * (begin_of + float(to)), 0.0, is_own);
            add_to_cache(middle, opened, rises);
        }
        passed = mix(passed, now, bvec2(rises));
        reached = rises ? to_slope : reached;
        light = mix(light, there, bvec3(walking));
        at = walking ? to : at;
        from = walking ? float(to) : from;
        slope = walking ? to_slope : slope;
        walking = walking && at < near_limit;
        turns_on = int(walking);
    }
    // Block by block, cut at the horizon, which the last one reaches: the share of ground is that below the horizon.
    int end = max(limit, 1);
    float horizon = slope_of(point_at(end).w, float(end));
    int layer = int((azimuth_index - first_azimuth) * block_layers);
    walking = limit > near_limit;
    turns_on = int(walking);
    while (turns_on > 0) {
        int block_end = max(on - at, 2);
        int longest = min(findMSB(at) - SHARE_BITS, findMSB(max(limit - at, 1)));
        int level = clamp(min(findLSB(block_end), longest), 1, MOST_LEVEL);
        int among = block_line(nearest.line, nearest.lead, azimuth.shear, block_end);
        Block block = block_at(block_texel(layer, among, level, block_end));
        float to_slope = slope_of(block.top, float(at + block.top_steps));
        int to = at + (1 << level);
        bool is_last_block = to >= limit;
        to_slope = is_last_block ? horizon : min(to_slope, horizon);
        bool rises = walking && to_slope > reached;
        vec2 now = moments_above(to_slope);
        vec2 opened = mix(vec2(0.0), passed - now, bvec2(rises));
        add_indirect(opened, mix(vec3(0.0), block.light, bvec3(rises)));
        if (FILLS_CACHE) {
            add_to_cache(float(at) + 0.5 * float(1 << level), opened, rises);
        }
        passed = mix(passed, now, bvec2(rises));
        reached = rises ? to_slope : reached;
        at = walking ? to : at;
        walking = walking && !is_last_block;
        turns_on = int(walking);
    }
    if (FILLS_CACHE) {
        vec4 steps_to = ring_moments / max(ring_weights, vec4(1e-30));
        uvec4 kept = cache_word(steps_to, ring_weights / azimuth.wedge_rad);
        imageStore(visibility_cache, ivec3(own_kept_node, int(azimuth_index - begin)), kept);
    }
    sky += dot(faces, passed);
    return vec4(indirect, whole);
}

// One lane and those beside it.
Strip strip_of(int lane, int march) {
    float below = ground_at(neighbour(lane - 1, lanes), march).w;
    float above = ground_at(neighbour(lane + 1, lanes), march).w;
    return Strip(vec4(below), vec4(ground_at(lane, march).w), vec4(above));
}

void main() {
    lanes = MARCHES_ROWS ? cols : rows;
    steps = MARCHES_ROWS ? rows : cols;
    int across = int(gl_GlobalInvocationID.x);
    int along = int(gl_GlobalInvocationID.y);
    int nodes_across = node_count(lanes, NODE_STRIDE);
    int nodes_along = node_count(steps, NODE_STRIDE);
    if (FROM == FROM_KEPT || FROM == FROM_BETWEEN) {
        int kept_along = node_count(nodes_along, KEPT_EACH);
        if (across >= node_count(nodes_across, KEPT_EACH) || FROM == FROM_KEPT && along >= kept_along) {
            return;
        }
        own_kept_node = texel_at(across, along);
        across = coarse_node(across, nodes_across, KEPT_EACH);
        along = FROM == FROM_KEPT ? coarse_node(along, nodes_along, KEPT_EACH) : other_node(along, KEPT_EACH);
        if (FROM == FROM_BETWEEN && is_coarse(along, nodes_along, KEPT_EACH)) {
            return;
        }
    } else if (FROM == FROM_REST) {
        across = other_node(across, KEPT_EACH);
        if (is_coarse(across, nodes_across, KEPT_EACH)) {
            return;
        }
    }
    if (across >= nodes_across || along >= nodes_along) {
        return;
    }
    own_node = texel_at(across, along);
    int lane = node_place(across, lanes, NODE_STRIDE);
    int march = node_place(along, steps, NODE_STRIDE);
    Quad q;
    q.lane = ivec4(lane);
    q.march = march;
    q.before = strip_of(lane, neighbour(march - 1, steps));
    q.here = strip_of(lane, march);
    q.after = strip_of(lane, neighbour(march + 1, steps));
    vec4 easts;
    vec4 norths;
    quad_slopes(q, lanes, steps, vec2(cell_x_m, cell_y_m), easts, norths);
    float east = easts.x;
    float north = norths.x;
    vec3 normal = vec3(-east, -north, 1.0) * inversesqrt(1.0 + east * east + north * north);
    own_height = q.here.four.x;
    vec4 sum = vec4(0.0);
    if (clears == 0u) {
        sum = imageLoad(bounce_sum, own_node);
    }
    sky = 0.0;
    if (FINDS_SHARE && clears == 0u) {
        sky = imageLoad(sky_share, own_node).x;
    }
    for (uint k = first_azimuth; k < first_azimuth + azimuth_count; k++) {
        azimuth = azimuth_at(azimuths, k);
        azimuth_index = k;
        own_lane = lane_position(azimuth, lane, lanes);
        own_step = march_position(azimuth, march, steps);
        sum += walked(normal, east * azimuth.cos_phi + north * azimuth.sin_phi);
    }
    // Weights over a whole hemisphere sum to 1: uniform incident radiance is preserved. Later bounces from the
    // visibility cache divide by the same sum.
    vec4 light = vec4(sum.rgb / max(sum.a, 1e-30), sum.a);
    imageStore(bounce_sum, own_node, mix(sum, light, bvec4(is_last != 0u)));
    if (FINDS_SHARE) {
        float share = sky / max(sum.a, 1e-30);
        imageStore(sky_share, own_node, vec4(mix(sky, share, is_last != 0u)));
    }
}
