// Computes: exact horizons of the triangulated surface in azimuths along grid vectors (a, b). Every grid point lies
// on a line, and the hull includes every crossing of a line with grid lines and diagonals.
// Reads: lane_heights, azimuths.
// Writes: slopes (f32 bits) at [layer][step][lane] and, if requested, the march steps to the horizon (f32 bits) in
// the next layer.
// Reads and writes: hull_buffer, if the hull does not fit private memory, at [entry][height, step, fraction][line].
// One invocation is one line, from the horizon's side to the other end.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_vote : require

layout(local_size_x_id = 0) in;
// Hull entries in private memory: four per step, the most crossings it can have; 1 if HULL_IN_BUFFER.
layout(constant_id = 1) const int PRIVATE_ENTRIES = 1;
layout(constant_id = 2) const bool PERIODIC = false;
layout(constant_id = 3) const bool WRITES_DISTANCES = false;
layout(constant_id = 4) const bool HULL_IN_BUFFER = false;

layout(binding = 0, rgba32f) uniform readonly image2D lane_heights;
layout(binding = 1) uniform textureBuffer azimuths;
layout(binding = 2, r32ui) uniform writeonly uimage2DArray slopes;
layout(binding = 3) buffer HullBuffer { float hull_buffer[]; };

#include "shared/conventions.glsl"

const bool MARCHES_ROWS = false;
const int LANE_STRIDE = 1;
const uint BORDER = PERIODIC ? BORDER_PERIODIC : BORDER_PLANE;

#include "horizon/crossings.glsl"
#include "horizon/march.glsl"

// Height of a grid point of the marched frame.
float marched_height(int lane, int step) {
    return height_at(lane_position(azimuth, neighbour(lane, lanes), lanes), march_position(azimuth, neighbour(step, steps), steps));
}

// Rise over `own` of the surface `u` past step `step`, for a line at lane position y (in 1/march
// of a cell) at that step.
float rise_over(float own, int y, int step, float u) {
    int march = azimuth.vector_march;
    int cell = (y + march * 65536) / march - 65536;
    float f = float(y - cell * march) / float(march) + u * float(azimuth.vector_lane) / float(march);
    bool over = f > 1.0;
    f -= over ? 1.0 : 0.0;
    cell += over ? 1 : 0;
    bool split_along = splits_along();
    return surface_rise(marched_height(cell, step), marched_height(cell, step + 1), marched_height(cell + 1, step),
                        marched_height(cell + 1, step + 1), own, u, f, split_along);
}

// A hull vertex: height, and position as whole step and fraction, so that differences of near positions stay exact.
struct Vertex {
    float h;
    float step;
    float rest;
};

float hull_h[PRIVATE_ENTRIES];
float hull_step[PRIVATE_ENTRIES];
float hull_rest[PRIVATE_ENTRIES];
int depth;

int in_buffer(int i, int part) {
    int lines = int(gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    return (3 * i + part) * lines + int(gl_GlobalInvocationID.x);
}

Vertex vertex(int i) {
    if (HULL_IN_BUFFER) {
        return Vertex(hull_buffer[in_buffer(i, 0)], hull_buffer[in_buffer(i, 1)], hull_buffer[in_buffer(i, 2)]);
    }
    return Vertex(hull_h[i], hull_step[i], hull_rest[i]);
}

// Pops the vertices hidden from a point at height h, `rest` past `step`.
void pop_under(float h, float step, float rest, bool exists) {
    // All lanes leave together: without the vote SwiftShader finds wrong horizons.
    bool pops = exists;
    do {
        Vertex newest = vertex(max(depth - 1, 0));
        Vertex older = vertex(max(depth - 2, 0));
        float to_newest = (step - newest.step) + (rest - newest.rest);
        float to_older = (step - older.step) + (rest - older.rest);
        precise float deeper = (older.h - h) * to_newest;
        precise float newer = (newest.h - h) * to_older;
        pops = pops && depth > 1 && deeper >= newer;
        depth -= pops ? 1 : 0;
    } while (subgroupAny(pops));
}

void push(float h, float step, float rest, bool exists) {
    if (exists && HULL_IN_BUFFER) {
        hull_buffer[in_buffer(depth, 0)] = h;
        hull_buffer[in_buffer(depth, 1)] = step;
        hull_buffer[in_buffer(depth, 2)] = rest;
    } else if (exists) {
        hull_h[depth] = h;
        hull_step[depth] = step;
        hull_rest[depth] = rest;
    }
    depth += exists ? 1 : 0;
}

// Adds a crossing of the line that is at lane position y0 at `step`, where it is on the field.
void cross_at(float u, int y0, int step, bool on) {
    // Not before the first step, nor before the line has entered across the first lane.
    bool exists = on && u <= 1.0 && step >= 0
               && (PERIODIC || float(y0) + u * float(azimuth.vector_lane) >= -1e-3);
    float h = rise_over(0.0, y0, step, u);
    pop_under(h, float(step), u, exists);
    push(h, float(step), u, exists);
}

void main() {
    azimuth = azimuth_at(azimuths, first_azimuth + gl_GlobalInvocationID.z);
    int march = azimuth.vector_march;
    int shear = azimuth.vector_lane;
    int total = warm_up + steps;
    int width = PERIODIC ? lanes * march - 1 : (lanes - 1) * march;
    int lead = PERIODIC ? 0 : (total - 1) * shear;
    int line = first + int(gl_GlobalInvocationID.x);
    // Other azimuths have more lines.
    if (line - int(gl_LocalInvocationID.x) > lead + width) {
        return;
    }
    bool split_along = splits_along();
    float advance = float(shear) / float(march);
    // All lines of a group march together, over the steps at which any of them is on the field.
    int lowest = first + int(gl_WorkGroupID.x * gl_WorkGroupSize.x) - lead;
    int highest = lowest + int(gl_WorkGroupSize.x) - 1;
    int begin = shear > 0 && !PERIODIC ? max(0, (-highest + shear - 1) / shear) : 0;
    int end = shear > 0 && !PERIODIC ? min(total, (width - lowest) / shear + 1) : total;

    depth = 0;
    for (int step = begin; step < end; step++) {
        int y = line - lead + step * shear;
        bool on = PERIODIC ? line <= width : y >= 0 && y <= width;
        // The segment that ends here, from its crossings to the step itself.
        int y0 = y - shear;
        int cell0 = (y0 + march * 65536) / march - 65536;
        float f0 = float(y0 - cell0 * march) / float(march);
        vec3 places = segment_crossings(f0, advance, split_along);
        cross_at(places.x, y0, step - 1, on);
        cross_at(places.y, y0, step - 1, on);
        cross_at(places.z, y0, step - 1, on);
        int cell = (y + march * 65536) / march - 65536;
        float f = float(y - cell * march) / float(march);
        float h = marched_height(cell, step);
        h += f > 0.0 ? f * (marched_height(cell + 1, step) - h) : 0.0;
        // As the end of its segment: positions within one step differ by their fractions.
        pop_under(h, float(step - 1), 1.0, on);
        if (on && y == cell * march && step >= warm_up) {
            float slope = NO_SLOPE;
            float back = 0.0;
            if (depth > 0) {
                Vertex met = vertex(depth - 1);
                int met_step = int(met.step);
                back = float(step - met_step) - met.rest;
                slope = rise_over(h, y - (step - met_step) * shear, met_step, met.rest) / (back * azimuth.step_m);
            }
            ivec2 texel = ivec2(PERIODIC ? wrapped(cell, lanes) : cell, PERIODIC ? step - warm_up : step);
            int layer = int(azimuth.layer);
            imageStore(slopes, ivec3(texel, layer), uvec4(floatBitsToUint(slope)));
            if (WRITES_DISTANCES) {
                imageStore(slopes, ivec3(texel, layer + 1), uvec4(floatBitsToUint(back)));
            }
        }
        push(h, float(step - 1), 1.0, on);
    }
}
