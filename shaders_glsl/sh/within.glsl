// Slopes of horizons up to a distance, in any direction: of the surface itself, and of a height pyramid. Negative
// where the ground falls away, NO_SLOPE for none. Include after `walk.glsl` and `spline.glsl`; needs the images and
// push constants that these and the two functions name.

// A ray over a repeating field stops after this many cells: two rays of a wedge fit llvmpipe's limit on loop
// iterations.
const float WITHIN_CELLS = 8192.0;

// Of the triangulated surface. The grid point's own triangle occludes at any distance.
float surface_within(Ray ray, float reach_m, bool going) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    float highest = imageLoad(maxima, ivec2(0, level_top(land.top_level, land.padded_rows))).x - ray.own;
    float step_m = 1.0 / ray.scale;
    float t_end = reach_m * ray.scale;
    if (BORDER == BORDER_PERIODIC) {
        t_end = min(t_end, WITHIN_CELLS);
    }
    float reached = NO_SLOPE;
    Walk walk = walk_from(ray);
    going = going && !walk.leaves;
    for (int turn_ = 0; turn_ < MOST_STEPS; turn_++) {
        if (!going) {
            break;
        }
        Block block = block_of(walk, ray);
        ivec2 fetched = clamp(walk.at, ivec2(0), cells_of - 1);
        vec4 corners = imageLoad(cells, fetched);
        int shown = max(walk.level, 1);
        float top = imageLoad(maxima, (fetched >> (LEVEL_BITS * shown)) + ivec2(0, level_top(shown, land.padded_rows))).x - ray.own;
        float rise = reached * step_m;
        bool is_cell = walk.level == 0;
        bool clear = is_cell || min(walk.t * rise, block.ahead * rise) >= top;
        // The cell: its diagonal, and where the ray leaves it, both clamped to the end.
        vec2 from = ray.offset + vec2(ray.base - walk.cell);
        float apart = ray.advance.x - ray.advance.y;
        float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
        bool is_split = t_split > walk.t && t_split < block.ahead;
        bool is_first = walk.t <= 0.0;
        float begin = is_split ? t_split : walk.t;
        float cut = min(t_split, t_end);
        float t_middle = is_first ? t_split : cut;
        float before_end = min(block.ahead, t_end);
        float t_exit = begin <= 0.0 ? block.ahead : before_end;
        float middle = cell_rise(corners, ray.own, clamp(from + t_middle * ray.advance, 0.0, 1.0));
        float exit = cell_rise(corners, ray.own, clamp(from + t_exit * ray.advance, 0.0, 1.0));
        float middle_slope = middle / max(t_middle * step_m, 1e-30);
        float exit_slope = exit / max(t_exit * step_m, 1e-30);
        bool in_cell = going && is_cell;
        bool has_middle = in_cell && is_split;
        bool has_exit = in_cell && t_exit > begin;
        reached = has_middle ? max(reached, middle_slope) : reached;
        reached = has_exit ? max(reached, exit_slope) : reached;
        walk_on(walk, ray, block, going, clear, land.top_level);
        bool is_over = reached > 0.0 && walk.t * reached * step_m >= highest;
        going = going && !walk.leaves && walk.t < t_end && !is_over;
    }
    return reached;
}

// Of every level of the pyramid at the grid point, the field first.
float own_heights[LEVELS + 1];

ivec2 texel_within(ivec2 at) {
    ivec2 round_ = ivec2(wrapped(at.x, land.cols), wrapped(at.y, land.rows));
    ivec2 held = clamp(at, ivec2(0), ivec2(land.cols, land.rows) - 1);
    return PERIODIC ? round_ : held;
}

// Between two texels' values on a grid line.
float between(float h, float next, float f) {
    return h + f * (next - h);
}

// Height of a level where a line crosses between columns (`crosses_row`) or between rows.
float height_within(int level, vec2 place, bool crosses_row) {
    vec2 low = floor(place);
    vec2 part = place - low;
    ivec2 along_row = ivec2(1, 0);
    ivec2 along_column = ivec2(0, 1);
    ivec2 on = texel_within(ivec2(low));
    ivec2 beside = texel_within(ivec2(low) + (crosses_row ? along_row : along_column));
    float f = crosses_row ? part.x : part.y;
    if (LEVELS > 0) {
        if (level > 0) {
            if (STACK) {
                return between(texelFetch(height_stack, ivec3(on, level - 1), 0).x, texelFetch(height_stack, ivec3(beside, level - 1), 0).x, f);
            }
            Level of = level_of(texelFetch(level_table, ivec2(level - 1, 0), 0));
            precise vec2 at = place * of.per_grid_point;
            return spline_at(of, at, width_shift);
        }
    }
    return between(texelFetch(heights, on, 0).x, texelFetch(heights, beside, 0).x, f);
}

void find_own_heights(ivec2 here) {
    for (int level = 0; level <= LEVELS; level++) {
        own_heights[level] = height_within(level, vec2(here), false);
    }
}

// The last four angles, the newest in w, their count, and the largest value of their B-spline up to the end, where it
// is evaluated too.
vec4 angles;
int taken;
float blocked;

void take_within(float angle, float u_end, bool on) {
    vec4 shifted = vec4(angles.yzw, angle);
    vec4 four = taken == 0 ? vec4(angle) : shifted;
    float newest = float(taken);
    float t = u_end - (newest - 2.0);
    float s = 1.0 - t;
    float knot = (four.y + 4.0 * four.z + four.w) * (1.0 / 6.0);
    float middle = ((four.x + four.w) + 23.0 * (four.y + four.z)) * (1.0 / 48.0);
    float inner = ((3.0 * t - 6.0) * t * t + 4.0) * four.y + ((3.0 * s - 6.0) * s * s + 4.0) * four.z;
    float at_end = (s * s * s * four.x + inner + t * t * t * four.w) * (1.0 / 6.0);
    float most = taken == 0 ? angle : blocked;
    most = newest - 1.0 <= u_end ? max(most, knot) : most;
    most = newest - 1.5 <= u_end ? max(most, middle) : most;
    most = t >= 0.0 && t < 1.0 ? max(most, at_end) : most;
    angles = on ? four : angles;
    blocked = on ? most : blocked;
    taken += on ? 1 : 0;
}

// Of the pyramid: as pyramid_march, with the spline evaluated up to the distance instead of to its end
// (Nowrouzezahrai & Snyder 2009, eq. 14-17; the thesis, eq. 4.24, 4.25). Includes the two lookups beyond that it
// depends on, so that it is continuous where the distance passes a lookup's.
float pyramid_within(ivec2 here, Ray ray, float reach_m, bool going) {
    vec2 last = vec2(land.cols - 1, land.rows - 1) - vec2(here);
    vec2 room = mix(vec2(here), last, greaterThan(ray.advance, vec2(0.0)));
    vec2 steps = mix(room / abs(ray.advance), vec2(1e8), lessThan(abs(ray.advance), vec2(1e-8)));
    // Slightly more, so that rounding does not leave the field a step early.
    float inside = min(steps.x, steps.y) + 1e-4;
    float endless = 1e8;
    int reach = int(PERIODIC ? endless : inside);
    bool crosses_row = abs(ray.advance.y) == 1.0;
    float step_m = 1.0 / ray.scale;
    float u_end = level_step * log2(max(reach_m * ray.scale, 1e-6));
    bool meets = going && reach > 0;
    bool on = meets;
    angles = vec4(0.0);
    blocked = 0.0;
    taken = 0;
    float angle = 0.0;
    float back = 1.0;
    int before = 0;
    for (int next = 0; next < LEVELS + fine_samples; next++) {
        if (!on) {
            break;
        }
        int whole = int(back + 0.5);
        if (whole > before) {
            int at = min(whole, reach);
            int level = clamp(next + 1 - fine_samples, 0, LEVELS);
            float rise = height_within(level, vec2(here) + float(at) * ray.advance, crosses_row) - own_heights[level];
            angle = arc_tangent(vec4(rise / (float(max(at, 1)) * step_m))).x;
        }
        take_within(angle, u_end, on);
        on = on && whole < reach && float(next) < floor(u_end) + 2.0;
        before = whole;
        back *= growth;
    }
    float newest = angles.w;
    take_within(newest, u_end, meets);
    take_within(newest, u_end, meets);
    return meets ? tangent(blocked) : NO_SLOPE;
}
