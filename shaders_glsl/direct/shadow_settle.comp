// Computes: direct light of a sun or a narrow key light at the marked grid points, from the exact horizon in every azimuth: the surface where the
// nearer swept line is shadowed from, then a walk over the grid point's own line that skips blocks of cells below the
// horizon found so far.
// Reads: lane_heights, maxima, azimuths, shadows, doubtful (see shadow_shade).
// Reads and writes: sun_sum (exit radiance for albedo 1, irradiance 1), light_vector (see sun_light.glsl).
// One workgroup is 16 march positions of 4 TILE_FOURS lanes. Its invocations share the grid points that are marked: one
// invocation is one azimuth of one grid point, so that neighbours walk alike.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint BORDER = 0u;
layout(constant_id = 1) const bool MARCHES_ROWS = false;
// See sun_light.glsl.
layout(constant_id = 2) const uint SHAPE = 0u;
// More steps than a walk over this field can take; llvmpipe ends all loops together after 65,535 iterations.
layout(constant_id = 3) const int MOST_STEPS = 60000;
layout(constant_id = 4) const int TILE_FOURS = 8;
// Loads corners only in cells and maxima only in blocks. Off on CPU devices, as llvmpipe runs both sides of a branch.
layout(constant_id = 5) const bool BRANCHES = false;
layout(constant_id = 6) const bool HAS_VECTOR = false;
const int LANE_STRIDE = 1;
const bool THIN_ROWS = false;
const bool THIN_COLS = false;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1, r32f) uniform readonly image2D maxima;
layout(binding = 2) uniform textureBuffer azimuths;
layout(binding = 3, r32ui) uniform readonly uimage2D doubtful;
layout(binding = 4, r32f) uniform image2D sun_sum;
layout(binding = 5, rgba32ui) uniform readonly uimage2DArray shadows;
layout(binding = 6, rgba32f) uniform image2D light_vector;

#include "rays/land.glsl"

layout(push_constant) uniform ShadowSettlePush {
    LandPush land;
    uint first_azimuth;
    uint azimuth_count;
    uint clears;  // 1 in the first dispatch of a light
    int warm_up;
    vec2 tilt;    // of the plane over which maxima are, for each column and row
};

#include "shared/quad.glsl"
#include "shared/lattice.glsl"
#include "shared/angle.glsl"
#include "direct/sun_light.glsl"
#include "rays/walk.glsl"

shared uint marked_count;
shared uint marked[64 * TILE_FOURS];
// Bits of those that are not hidden in every azimuth by what hides the lines beside them; and their list.
shared uint open_bits[2 * TILE_FOURS];
shared uint open_count;
shared uint open[64 * TILE_FOURS];
// Light in one azimuth.
shared float lights[64];
shared vec3 vectors[64];

// Heights of a cell's corners: north-west, north-east, south-west, south-east.
vec4 corners_at(ivec2 cell) {
    ivec2 next = ivec2(neighbour(cell.x + 1, land.cols), neighbour(cell.y + 1, land.rows));
    ivec2 near = MARCHES_ROWS ? cell : cell.yx;
    ivec2 far = MARCHES_ROWS ? next : next.yx;
    float across = height_at(far.x, near.y);
    float along = height_at(near.x, far.y);
    return vec4(height_at(near.x, near.y), MARCHES_ROWS ? across : along, MARCHES_ROWS ? along : across, height_at(far.x, far.y));
}

// Cells towards the horizon, of one march step.
vec2 step_cells(Azimuth azimuth) {
    float shear = float(azimuth.shear) * (1.0 / float(CELL));
    float march = (azimuth.flags & AZIMUTH_FLIPS_MARCH) != 0u ? 1.0 : -1.0;
    float lane = (azimuth.flags & AZIMUTH_FLIPS_LANES) != 0u ? shear : -shear;
    return (azimuth.flags & AZIMUTH_MARCHES_ROWS) != 0u ? vec2(lane, march) : vec2(march, lane);
}

// Slope of the surface on the grid point's own line at the distance from which the nearer swept line is shadowed: not above
// the horizon, and mostly the horizon itself.
float proposed_slope(Azimuth azimuth, int lane, int march, float own) {
    bool wraps = BORDER == BORDER_PERIODIC;
    int lanes = MARCHES_ROWS ? land.cols : land.rows;
    int steps = MARCHES_ROWS ? land.rows : land.cols;
    int lead = lattice_lead(azimuth.shear, warm_up + steps, CELL_SHIFT, wraps);
    int lines = lattice_lines(lanes, lead, CELL_SHIFT, wraps);
    int step = march_position(azimuth, march, steps);
    int of_lane = lane_position(azimuth, lane, lanes);
    int line = ((of_lane + lead) * CELL - (warm_up + step) * azimuth.shear + (CELL / 2 - 1)) >> CELL_SHIFT;
    int held = clamp(line, 0, lines - 1);
    int round = wrapped(line, lines);
    line = wraps ? round : held;
    uint word = imageLoad(shadows, lattice_texel(azimuth, line, warm_up + step))[line & 3];
    int back = int(word & 0xffffu);
    int y = of_lane * CELL - back * azimuth.shear;
    bool exists = back > 0 && back <= warm_up + step && (wraps || y >= 0);
    int cell = neighbour(y >> CELL_SHIFT, lanes);
    int next = neighbour(cell + 1, lanes);
    int at = march_position(azimuth, neighbour(step - back, steps), steps);
    float h = height_at(lane_position(azimuth, cell, lanes), at);
    float h_next = height_at(lane_position(azimuth, next, lanes), at);
    h += float(y & (CELL - 1)) * (1.0 / float(CELL)) * (h_next - h);
    float slope = (h - own) / (float(max(back, 1)) * azimuth.step_m);
    return exists ? slope : NO_SLOPE;
}

// The slope of the horizon within `t_end` steps, or `reached` if that is higher; anything from `high` on may stand for more.
float horizon_slope(Ray ray, float step_m, float t_end, float reached, float high, bool going) {
    ivec2 cells_of = ivec2(land.cells_x, land.cells_y);
    // Over the plane: the grid point, and the plane's fall along the ray.
    float own = ray.own + dot(tilt, vec2(ray.base));
    float fall = dot(tilt, ray.advance);
    float rounding = 1e-6 * (abs(own) + dot(abs(tilt), vec2(cells_of)));
    Walk walk = walk_from(ray);
    going = going && !walk.leaves;
    for (int turn = 0; turn < MOST_STEPS; turn++) {
        if (!going) {
            break;
        }
        Block block = block_of(walk, ray);
        ivec2 fetched = clamp(walk.at, ivec2(0), cells_of - 1);
        bool is_cell = walk.level == 0;
        int shown = max(walk.level, 1);
        float top = 0.0;
        if (!BRANCHES || !is_cell) {
            top = imageLoad(maxima, (fetched >> (LEVEL_BITS * shown)) + ivec2(0, level_top(shown, land.padded_rows))).x;
        }
        // Where the field repeats, the plane goes on.
        float over_own = top + dot(tilt, vec2(walk.cell - walk.at)) - own + rounding;
        vec4 corners = vec4(0.0);
        if (!BRANCHES || is_cell) {
            corners = corners_at(fetched);
        }
        float rise = reached * step_m + fall;
        bool clear = is_cell || min(walk.t * rise, block.ahead * rise) >= over_own;
        // The cell: its diagonal, and where the ray leaves it.
        vec2 from = ray.offset + vec2(ray.base - walk.cell);
        float apart = ray.advance.x - ray.advance.y;
        float t_split = abs(apart) < 1e-30 ? -1.0 : (from.y - from.x) / apart;
        bool is_split = t_split > walk.t && t_split < block.ahead;
        float share = clamp(from.x + t_split * ray.advance.x, 0.0, 1.0);
        float middle_slope = ((corners.x - ray.own) + share * (corners.w - corners.x)) / max(t_split * step_m, 1e-30);
        vec2 exit = clamp(from + block.ahead * ray.advance, 0.0, 1.0);
        float exit_slope = cell_rise(corners, ray.own, exit) / max(block.ahead * step_m, 1e-30);
        float steepest = is_split ? max(middle_slope, exit_slope) : exit_slope;
        bool is_passed = going && is_cell && block.ahead > walk.t;
        reached = is_passed ? max(reached, steepest) : reached;
        walk_on(walk, ray, block, going, clear, land.top_level);
        going = going && !walk.leaves && walk.t < t_end && reached < high;
    }
    return reached;
}

// A grid point and its slopes.
struct Ground {
    ivec2 texel;
    float height;
    float east;
    float north;
};

Ground ground_at(int lane, int march) {
    int lanes = MARCHES_ROWS ? land.cols : land.rows;
    int steps = MARCHES_ROWS ? land.rows : land.cols;
    Quad q = quad_at(lane & ~3, march, lanes, steps);
    vec4 east;
    vec4 north;
    quad_slopes(q, lanes, steps, vec2(land.cell_x_m, land.cell_y_m), east, north);
    return Ground(texel_at(lane, march), q.here.four[lane & 3], east[lane & 3], north[lane & 3]);
}

// The lowest slope from which light arrives: of the chord, of the grid point's own plane along the azimuth (TW10 eq. 4) and
// of level ground around the field.
float own_slope(Ground ground, Azimuth azimuth) {
    float rise = ground.east * azimuth.cos_phi + ground.north * azimuth.sin_phi;
    float level = BORDER == BORDER_OPEN ? NO_SLOPE : 0.0;
    float high = azimuth.high_slope;
    // The chord of a point is a few units in the last place.
    float low = SHAPE == SHAPE_POINT ? high - 2.4e-7 * max(abs(high), 1e-6) : azimuth.low_slope;
    return max(max(rise, level), low);
}

// Marked grid points of the workgroup, as march position and lane.
void find_marked(uint thread) {
    int lanes = MARCHES_ROWS ? land.cols : land.rows;
    int steps = MARCHES_ROWS ? land.rows : land.cols;
    ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(16, TILE_FOURS);
    for (uint word = thread; word < uint(16 * TILE_FOURS); word += 64u) {
        int march = first.x + int(word) % 16;
        int four = first.y + int(word) / 16;
        bool exists = march < steps && 4 * four < lanes;
        uint marks = exists ? imageLoad(doubtful, ivec2(four, march)).x : 0u;
        if (marks != 0u) {
            uint place = atomicAdd(marked_count, uint(bitCount(marks)));
            for (uint k = 0u; k < 4u; k++) {
                if ((marks >> k & 1u) != 0u) {
                    marked[place] = uint(4 * four + int(k)) << 16 | uint(march);
                    place++;
                }
            }
        }
    }
}

void main() {
    uint thread = gl_LocalInvocationIndex;
    if (thread == 0u) {
        marked_count = 0u;
        open_count = 0u;
    }
    if (thread < uint(2 * TILE_FOURS)) {
        open_bits[thread] = 0u;
    }
    barrier();
    find_marked(thread);
    barrier();
    if (marked_count == 0u) {
        return;
    }
    // This invocation's azimuth, and its grid point of those that are done together.
    uint together = 64u / azimuth_count;
    bool works = thread < together * azimuth_count;
    uint of_together = works ? thread / azimuth_count : 0u;
    Azimuth azimuth = azimuth_at(azimuths, first_azimuth + thread % azimuth_count);
    for (uint i = 0u; i < marked_count; i += together) {
        uint at = i + of_together;
        bool exists = works && at < marked_count;
        uint place = marked[exists ? at : i];
        int lane = int(place >> 16);
        int march = int(place & 0xffffu);
        float slope = proposed_slope(azimuth, lane, march, height_at(lane, march));
        if (exists && slope < azimuth.high_slope) {
            atomicOr(open_bits[at >> 5], 1u << (at & 31u));
        }
    }
    barrier();
    for (uint at = thread; at < marked_count; at += 64u) {
        uint place = marked[at];
        if ((open_bits[at >> 5] >> (at & 31u) & 1u) != 0u) {
            open[atomicAdd(open_count, 1u)] = place;
        } else if (clears != 0u) {
            ivec2 texel = texel_at(int(place >> 16), int(place & 0xffffu));
            imageStore(sun_sum, texel, vec4(0.0));
            if (HAS_VECTOR) {
                imageStore(light_vector, texel, vec4(0.0));
            }
        }
    }
    barrier();
    for (uint i = 0u; i < open_count; i += together) {
        bool exists = works && i + of_together < open_count;
        uint place = open[exists ? i + of_together : i];
        int lane = int(place >> 16);
        int march = int(place & 0xffffu);
        Ground ground = ground_at(lane, march);
        float own = own_slope(ground, azimuth);
        float high = azimuth.high_slope;
        float lowest = max(own, proposed_slope(azimuth, lane, march, ground.height));
        // As far as sweeps march.
        int steps = MARCHES_ROWS ? land.rows : land.cols;
        float t_end = float(warm_up + march_position(azimuth, march, steps));
        Ray ray = Ray(ground.texel, vec2(0.0), ground.height, step_cells(azimuth), 0.0, 1.0 / azimuth.step_m);
        lowest = horizon_slope(ray, azimuth.step_m, t_end, lowest, high, exists && lowest < high);
        float normal_up = inversesqrt(1.0 + ground.east * ground.east + ground.north * ground.north);
        vec3 normal = vec3(-ground.east, -ground.north, 1.0) * normal_up;
        lights[thread] = sun_light(azimuth, vec4(normal.x), vec4(normal.y), vec4(normal.z), vec4(lowest), SHAPE).x;
        if (HAS_VECTOR) {
            vec4 vector_east = vec4(0.0);
            vec4 vector_north = vec4(0.0);
            vec4 vector_up = vec4(0.0);
            add_vector(vector_east, vector_north, vector_up, azimuth, vec4(lowest), bvec4(true));
            vectors[thread] = vec3(vector_east.x, vector_north.x, vector_up.x);
        }
        barrier();
        // In the order of the azimuths.
        if (exists && thread % azimuth_count == 0u) {
            float sun = clears == 0u ? imageLoad(sun_sum, ground.texel).x : 0.0;
            for (uint k = 0u; k < azimuth_count; k++) {
                sun += lights[thread + k];
            }
            imageStore(sun_sum, ground.texel, vec4(sun));
            if (HAS_VECTOR) {
                vec4 sum = clears == 0u ? imageLoad(light_vector, ground.texel) : vec4(0.0);
                for (uint k = 0u; k < azimuth_count; k++) {
                    sum.xyz += vectors[thread + k];
                }
                imageStore(light_vector, ground.texel, sum);
            }
        }
        barrier();
    }
}
