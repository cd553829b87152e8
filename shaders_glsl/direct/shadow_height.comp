// Computes: for every grid point the height from which a whole sun is visible, the height of the penumbra below it, and
// the visible share of the sun's disc at the ground. Along each line two running maxima of the ground are kept, one for each edge of
// the sun.
// Reads: heights; of an outer field its shadow heights, outer_lit_above and outer_penumbra.
// Writes: lit_above (metres over the field's base), penumbra (metres), sun_share (0 to 1).
// One invocation is one line, or one segment of it: it first finds the highest ground of its segment, and then starts again from the
// highest ground of the segments before it. The last line of a workgroup is also the first of the next one. Lines are a cell apart. A grid point
// interpolates the two lines beside it.
#version 460

layout(local_size_x = 64, local_size_y_id = 1) in;

layout(constant_id = 0) const bool HAS_OUTER = false;
// Steps between two barriers.
layout(constant_id = 2) const int AT_ONCE = 4;
// Size of `of_lines`, and of `segment_top` and `segment_step`: one per invocation.
layout(constant_id = 3) const int LINE_WORDS = 512;
layout(constant_id = 4) const int SEGMENT_WORDS = 64;

layout(binding = 0) uniform texture2D heights;
layout(binding = 1) uniform texture2D outer_lit_above;
layout(binding = 2) uniform texture2D outer_penumbra;
layout(binding = 3, r32f) uniform writeonly image2D lit_above;
layout(binding = 4, r32f) uniform writeonly image2D penumbra;
layout(binding = 5, r32f) uniform writeonly image2D sun_share;

#include "shared/angle.glsl"
#include "shared/lines.glsl"

layout(push_constant) uniform ShadowHeightPush {
    ivec2 size;         // columns and rows
    ivec2 outer_size;
    vec2 outer_origin;  // column and row of the outer grid at this field's first grid point
    vec2 outer_step;    // cells of the outer grid per cell
    vec2 edges;         // tangents of the elevations of the sun's lower and upper edge
    float diameter_rad; // 0 for a point
    float step_m;       // world length of a march step
    float outer_base;   // of the outer field over this one's
    int shear;
    uint flags;         // AZIMUTH_*
    int first_group;
};

// Beyond it the upper edge is in the zenith, and nothing reaches that far.
const float STEEPEST = 1e8;

// No ground.
const float NOTHING = -1e30;

// Of AT_ONCE steps of each segment: shadow heights for the lower and the upper edge, and how many steps away the ground is that
// shades from each. Two such buffers alternate.
shared vec4 of_lines[LINE_WORDS];
// For each segment of each line, the highest shadowing ground for both edges, and its march steps.
shared vec2 segment_top[SEGMENT_WORDS];
shared vec2 segment_step[SEGMENT_WORDS];

bool has(uint flag) {
    return (flags & flag) != 0u;
}

// Column and row, also between grid points.
vec2 grid_place(float lane, float step, vec2 last) {
    float lane_at = has(AZIMUTH_FLIPS_LANES) ? last.x - lane : lane;
    float step_at = has(AZIMUTH_FLIPS_MARCH) ? last.y - step : step;
    return has(AZIMUTH_MARCHES_ROWS) ? vec2(lane_at, step_at) : vec2(step_at, lane_at);
}

ivec2 texel_of(int lane, int step, ivec2 last) {
    int lane_at = has(AZIMUTH_FLIPS_LANES) ? last.x - lane : lane;
    int step_at = has(AZIMUTH_FLIPS_MARCH) ? last.y - step : step;
    return has(AZIMUTH_MARCHES_ROWS) ? ivec2(lane_at, step_at) : ivec2(step_at, lane_at);
}

// lit_above and penumbra of the outer field, between its grid points.
vec2 outer_at(vec2 place) {
    vec2 at = clamp(outer_origin + place * outer_step, vec2(0.0), vec2(outer_size - 1));
    ivec2 a = ivec2(at);
    ivec2 b = min(a + 1, outer_size - 1);
    vec2 t = at - vec2(a);
    vec4 lit = vec4(texelFetch(outer_lit_above, a, 0).x, texelFetch(outer_lit_above, ivec2(b.x, a.y), 0).x,
                    texelFetch(outer_lit_above, ivec2(a.x, b.y), 0).x, texelFetch(outer_lit_above, b, 0).x);
    vec4 wide = vec4(texelFetch(outer_penumbra, a, 0).x, texelFetch(outer_penumbra, ivec2(b.x, a.y), 0).x,
                     texelFetch(outer_penumbra, ivec2(a.x, b.y), 0).x, texelFetch(outer_penumbra, b, 0).x);
    vec2 lit_rows = mix(lit.xz, lit.yw, t.x);
    vec2 wide_rows = mix(wide.xz, wide.yw, t.x);
    return vec2(mix(lit_rows.x, lit_rows.y, t.y) + outer_base, mix(wide_rows.x, wide_rows.y, t.y));
}

// Angle between two directions of slopes `from` and from + `rise`, 0 or more; a right angle or more counts as one.
float angle_over(float from, float rise) {
    float cosine = 1.0 + from * (from + rise);
    return cosine > 0.0 ? arc_tangent(vec4(max(rise, 0.0) / cosine)).x : HALF_PI;
}

// Share of a disc above a chord that cuts off `hidden` of its height: a segment. The square roots keep precision near 0 and 1.
float share_above(float hidden) {
    if (hidden <= 0.0 || hidden >= 1.0) {
        return hidden <= 0.0 ? 1.0 : 0.0;
    }
    float shown = 1.0 - hidden;
    vec2 roots = sqrt(vec2(hidden, shown));
    float angle = arc_tangent(vec4(roots.y / roots.x)).x;
    return min((angle - (hidden - shown) * roots.x * roots.y) * (2.0 / PI), 1.0);
}

// Visible share at height z. Neither of the two occluders hides less than the other's part: the larger counts.
float share_at(float z, vec4 shade) {
    if (diameter_rad == 0.0) {
        return z >= shade.x ? 1.0 : 0.0;
    }
    float hidden = angle_over(edges.x, (shade.x - z) / (shade.z * step_m)) / diameter_rad;
    hidden = z >= shade.x ? 0.0 : hidden;
    if (edges.y < STEEPEST) {
        // Down from the upper edge to the horizon.
        float below = (z - shade.y) / (shade.w * step_m);
        float shown = angle_over(edges.y - below, below) / diameter_rad;
        hidden = max(hidden, z <= shade.y ? 1.0 : 1.0 - shown);
    }
    return share_above(hidden);
}

// Along a line, the highest shadowing ground so far, for the lower and upper edge, and its march step.
struct Highest {
    vec2 top;
    vec2 step;
};

bool is_on_field(int place, int lanes) {
    return place > -CELL && place < lanes * CELL;
}

// Shadow heights of a line at `step`, for both edges, and how many steps away the ground is that shades from each. The line is
// at `place` in cells / CELL across the lanes; `ground` is set to the height at the first lane at or after `place`. The height of this step counts from the next step on.
vec4 marched(inout Highest highest, int step, int place, ivec2 last, vec2 rise, out float ground) {
    int cell = place >> CELL_SHIFT;
    int fraction = place & (CELL - 1);
    float below = texelFetch(heights, texel_of(clamp(cell, 0, last.x), step, last), 0).x;
    float above = texelFetch(heights, texel_of(clamp(cell + 1, 0, last.x), step, last), 0).x;
    float here = mix(below, above, float(fraction) * (1.0 / float(CELL)));
    bool is_on = is_on_field(place, last.x + 1);
    if (is_on && (step == 0 || !is_on_field(place - shear, last.x + 1))) {
        // Beyond the edge towards the sun, the ground is level at the height of the edge.
        highest = Highest(vec2(here), vec2(float(step - 1)));
        if (HAS_OUTER) {
            vec2 beyond = outer_at(grid_place(float(place) * (1.0 / float(CELL)), float(step), vec2(last)));
            // The outer field's penumbra grows by the same amount with each step.
            float ahead = max(beyond.y / max(rise.y - rise.x, 1e-30), 1.0);
            vec2 shade = beyond.x - vec2(0.0, beyond.y);
            bvec2 is_higher = greaterThan(shade, highest.top - rise);
            highest.top = mix(highest.top, shade + ahead * rise, is_higher);
            highest.step = mix(highest.step, vec2(float(step) - ahead), is_higher);
        }
    }
    vec2 ahead = float(step) - highest.step;
    vec2 shade = highest.top - ahead * rise;
    bvec2 is_higher = bvec2(uvec2(greaterThanEqual(vec2(here), shade)) & uvec2(is_on));
    highest.top = mix(highest.top, vec2(here), is_higher);
    highest.step = mix(highest.step, vec2(float(step)), is_higher);
    ground = fraction == 0 ? below : above;
    return vec4(shade, ahead);
}

void main() {
    int lanes = has(AZIMUTH_MARCHES_ROWS) ? size.x : size.y;
    int steps = has(AZIMUTH_MARCHES_ROWS) ? size.y : size.x;
    ivec2 last = ivec2(lanes, steps) - 1;
    int group_lines = int(gl_WorkGroupSize.x) - 1;
    int first_line = (first_group + int(gl_WorkGroupID.x)) * group_lines;
    int lead = lattice_lead(shear, steps, CELL_SHIFT, false);
    // The steps at which any line of the group is inside the field or less than a cell outside it.
    int begin = 0;
    int end = steps;
    if (shear > 0) {
        int lowest = (first_line - lead) * CELL;
        begin = max(0, (-CELL - (lowest + group_lines * CELL)) / shear);
        end = clamp((lanes * CELL - lowest) / shear + 1, begin, max(begin, steps));
    }
    vec2 rise = edges * step_m;
    int own = int(gl_LocalInvocationID.x);
    int y = (first_line + own - lead) * CELL;
    int segments = int(gl_WorkGroupSize.y);
    int segment = int(gl_LocalInvocationID.y);
    int length = ((end - begin + segments - 1) / segments + AT_ONCE - 1) / AT_ONCE * AT_ONCE;
    int from = begin + segment * length;
    Highest highest = Highest(vec2(NOTHING), vec2(0.0));
    if (segments > 1) {
        // Nothing follows the last segment.
        int until = segment < segments - 1 ? min(from + length, end) : from;
        for (int first = from; first < until; first += AT_ONCE) {
            for (int k = 0; k < AT_ONCE; k++) {
                int step = min(first + k, steps - 1);
                float ground;
                marched(highest, step, y + step * shear, last, rise, ground);
            }
        }
        int at = segment * int(gl_WorkGroupSize.x) + own;
        segment_top[at] = highest.top;
        segment_step[at] = highest.step;
        barrier();
        // In the order of the march.
        highest = Highest(vec2(NOTHING), vec2(0.0));
        for (int before = own; before < at; before += int(gl_WorkGroupSize.x)) {
            vec2 shade = highest.top - (segment_step[before] - highest.step) * rise;
            bvec2 is_higher = greaterThanEqual(segment_top[before], shade);
            highest.top = mix(highest.top, segment_top[before], is_higher);
            highest.step = mix(highest.step, segment_step[before], is_higher);
        }
    }
    int buffers = segment * 2 * AT_ONCE;
    for (int first = from; first < from + length; first += AT_ONCE) {
        vec4 mine[AT_ONCE];
        float ground[AT_ONCE];
        for (int k = 0; k < AT_ONCE; k++) {
            int step = min(first + k, steps - 1);
            mine[k] = marched(highest, step, y + step * shear, last, rise, ground[k]);
            of_lines[(buffers + k) * int(gl_WorkGroupSize.x) + own] = mine[k];
        }
        // One barrier is enough: the next iteration writes the other half, and this half is written again only after that
        // iteration's barrier.
        barrier();
        for (int k = 0; k < AT_ONCE; k++) {
            int step = first + k;
            int at = y + step * shear;
            int lane = (at + CELL - 1) >> CELL_SHIFT;
            if (own == group_lines || step >= end || lane < 0 || lane > last.x) {
                continue;
            }
            vec4 shade = mine[k];
            int ahead = lane * CELL - at;
            if (ahead > 0) {
                // Where this line lies on a lane, no interpolation is needed, and the next line may be outside the field.
                vec4 next = of_lines[(buffers + k) * int(gl_WorkGroupSize.x) + own + 1];
                shade = mix(shade, next, float(ahead) * (1.0 / float(CELL)));
            }
            ivec2 texel = texel_of(lane, step, last);
            imageStore(lit_above, texel, vec4(shade.x));
            imageStore(penumbra, texel, vec4(shade.z * (rise.y - rise.x)));
            imageStore(sun_share, texel, vec4(share_at(ground[k], shade)));
        }
        buffers ^= AT_ONCE;
    }
}
