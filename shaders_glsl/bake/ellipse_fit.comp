// Computes: the ellipse in the plan of the hemisphere that best covers the directions with visible sky (Heidrich et
// al. 2000, §4).
// Reads: visible_points (see bake/points.glsl), directions (east, north, up), or on a curved base surface bent (see
// bent_directions), of which directions above horizontal count.
// Writes: ellipse_axes (centre, unit axis), ellipse_radii (1 / radii, score, last step).
// One invocation is one grid point.
#version 460

#include "shared/conventions.glsl"
#include "bake/points.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Two directions per word.
layout(constant_id = 0) const bool SMALL = false;
layout(constant_id = 1) const bool BENT = false;

layout(binding = 0) uniform utexture2DArray visible_points;
layout(binding = 1) uniform textureBuffer directions;
layout(binding = 2, rgba32f) uniform writeonly image2D ellipse_axes;
layout(binding = 3, rgba32f) uniform writeonly image2D ellipse_radii;
layout(binding = 4) uniform texture2DArray bent;

layout(push_constant) uniform EllipseFitPush {
    int cols;
    int rows;
    int first_direction;  // texel in directions
    int end_direction;
    int first_row;
    float least_radius;
};

// Search step: starts at the first value, is halved when no move improves the score, ends at the last; maximum step
// count.
const float FIRST_STEP = 0.25;
const float LAST_STEP = 1.0 / 64.0;
const int MOST_STEPS = 48;

// Moves of centre and radius along an axis: either end, both ends to one side, both ends apart.
const vec4 MOVE_A = vec4(-1.0, 0.0, 1.0, -1.0);
const vec4 GROW_A = vec4(-1.0, -1.0, -1.0, 0.0);
const vec4 MOVE_B = vec4(1.0, -1.0, 0.0, 1.0);
const vec4 GROW_B = vec4(0.0, 1.0, 1.0, 1.0);

// Plan coordinates of a direction and its weight: 1 visible sky, -1 hidden, 0 below horizontal.
vec3 plan_of(int i, ivec2 at, out float z) {
    if (BENT) {
        vec4 own = texelFetch(bent, ivec3(at, i), 0);
        z = own.z;
        return vec3(own.xy, own.z > 0.0 ? (own.w == 0.0 ? 1.0 : -1.0) : 0.0);
    }
    vec3 e = texelFetch(directions, first_direction + i).xyz;
    uint point = point_of(texelFetch(visible_points, ivec3(at, SMALL ? i >> 1 : i), 0).x, i, SMALL);
    z = e.z;
    return vec3(e.xy, e.z > 0.0 ? (point == POINT_SKY ? 1.0 : -1.0) : 0.0);
}

// Which of four ellipses, moved along one axis, contain a point, given its coordinate along the axis and the other
// axis' term.
ivec4 held(float along, vec4 centre, vec4 radius, float other) {
    vec4 t = (along - centre) / max(radius, vec4(least_radius));
    return ivec4(lessThanEqual(t * t + other, vec4(1.0)));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    if (at.x >= cols || at.y >= rows) {
        return;
    }
    int count = end_direction - first_direction;
    // Moments over the plan's area: a direction has weight z times its solid angle.
    float z, weight = 0.0;
    vec2 mean = vec2(0.0);
    ivec2 counts = ivec2(0);
    for (int i = 0; i < count; i++) {
        vec3 s = plan_of(i, at, z);
        float w = s.z > 0.0 ? z : 0.0;
        weight += w;
        mean += w * s.xy;
        counts += ivec2(s.z > 0.0 ? 1 : 0, s.z < 0.0 ? 1 : 0);
    }
    mean /= max(weight, 1e-30);
    vec3 spread = vec3(0.0);
    for (int i = 0; i < count; i++) {
        vec3 s = plan_of(i, at, z);
        vec2 d = s.xy - mean;
        spread += (s.z > 0.0 ? z : 0.0) * vec3(d.x * d.x, d.x * d.y, d.y * d.y);
    }
    spread /= max(weight, 1e-30);
    // Eigenvectors of the covariance: the larger along (half + root, xy), or (xy, root - half), whichever is longer.
    float half_sum = 0.5 * (spread.x + spread.z);
    float half_difference = 0.5 * (spread.x - spread.z);
    float root = length(vec2(half_difference, spread.y));
    vec2 axis = half_difference >= 0.0 ? vec2(half_difference + root, spread.y)
                                       : (spread.y < 0.0 ? -1.0 : 1.0) * vec2(spread.y, root - half_difference);
    axis = root > 1e-6 * half_sum ? normalize(axis) : vec2(1.0, 0.0);
    // A filled ellipse of radius r has the variance r²/4 along it.
    vec2 variance = max(vec2(half_sum + root, half_sum - root), vec2(0.0));
    vec2 radii = max(2.0 * sqrt(variance), vec2(least_radius));
    vec2 centre = vec2(dot(axis, mean), dot(vec2(-axis.y, axis.x), mean));

    int score = 0;
    for (int i = 0; i < count; i++) {
        vec3 s = plan_of(i, at, z);
        vec2 t = (vec2(dot(axis, s.xy), dot(vec2(-axis.y, axis.x), s.xy)) - centre) / radii;
        score += int(s.z) * (dot(t, t) <= 1.0 ? 1 : 0);
    }
    float h = FIRST_STEP;
    bool mixed = counts.x > 0 && counts.y > 0;
    for (int k = 0; k < MOST_STEPS && h >= LAST_STEP && mixed; k++) {
        ivec4 scores[4] = ivec4[4](ivec4(0), ivec4(0), ivec4(0), ivec4(0));
        for (int i = 0; i < count; i++) {
            vec3 s = plan_of(i, at, z);
            vec2 p = vec2(dot(axis, s.xy), dot(vec2(-axis.y, axis.x), s.xy));
            vec2 t = (p - centre) / radii;
            t *= t;
            int sign = int(s.z);
            scores[0] += sign * held(p.x, centre.x + h * MOVE_A, radii.x + h * GROW_A, t.y);
            scores[1] += sign * held(p.x, centre.x + h * MOVE_B, radii.x + h * GROW_B, t.y);
            scores[2] += sign * held(p.y, centre.y + h * MOVE_A, radii.y + h * GROW_A, t.x);
            scores[3] += sign * held(p.y, centre.y + h * MOVE_B, radii.y + h * GROW_B, t.x);
        }
        int best = score, chosen = -1;
        for (int j = 0; j < 16; j++) {
            int other = scores[j >> 2][j & 3];
            chosen = other > best ? j : chosen;
            best = max(best, other);
        }
        if (chosen < 0) {
            h *= 0.5;
        } else {
            int j = chosen & 3;
            vec2 by = h * ((chosen & 4) == 0 ? vec2(MOVE_A[j], GROW_A[j]) : vec2(MOVE_B[j], GROW_B[j]));
            vec2 along = chosen < 8 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
            centre += by.x * along;
            radii = max(radii + by.y * along, vec2(least_radius));
            score = best;
        }
    }
    vec4 axes = vec4(axis * centre.x + vec2(-axis.y, axis.x) * centre.y, axis);
    vec4 inverse = vec4(1.0 / radii, float(score), h);
    int whole = counts.x - counts.y;
    if (whole >= score || counts.y == 0) {
        axes = vec4(0.0, 0.0, 1.0, 0.0);
        inverse = vec4(0.0, 0.0, float(whole), 0.0);
    }
    if (max(whole, score) <= 0 || counts.x == 0) {
        // Outside the unit disc by more than its own radius.
        axes = vec4(4.0, 0.0, 1.0, 0.0);
        inverse = vec4(1.0, 1.0, 0.0, 0.0);
    }
    imageStore(ellipse_axes, at, axes);
    imageStore(ellipse_radii, at, inverse);
}
