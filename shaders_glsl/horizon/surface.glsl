#include "shared/conventions.glsl"

// The surface between two march steps, in local coordinates of a line: u along the march from the
// earlier step, f across the lanes from the line's cell, both from 0 to 1.

// No crossing: beyond the end of the segment.
const float NO_CROSSING = 2.0;

// Threshold between equal and greater: positions are multiples of 1/32768 of a cell, or quotients with integers up to
// 4096, which a device may round with an error of 2.5 ulp.
const float HAIR = 1e-5;

// Where a line that starts at f0 and advances by `shear` crosses lane lines and cell diagonals
// strictly between two steps, sorted; these and the steps themselves are all the vertices of the
// profile. `split_along` says that diagonals run from (0, 0) to (1, 1), else from (1, 0) to (0, 1).
vec3 segment_crossings(float f0, float shear, bool split_along) {
    vec3 u = vec3(NO_CROSSING);
    if (f0 + shear > 1.0 + HAIR) {
        u.x = (1.0 - f0) / shear;
    }
    if (split_along) {
        // f - u is an integer: from f0 down to f0 + shear - 1, past 0.
        if (f0 > 0.0 && f0 + shear < 1.0 - HAIR) {
            u.y = f0 / (1.0 - shear);
        }
    } else {
        // f + u is an integer: from f0 up to f0 + shear + 1, past 1 and perhaps 2.
        if (f0 + shear > 0.0) {
            u.y = (1.0 - f0) / (1.0 + shear);
        }
        if (f0 + shear > 1.0 + HAIR) {
            u.z = (2.0 - f0) / (1.0 + shear);
        }
    }
    float low = min(u.x, min(u.y, u.z));
    float high = max(u.x, max(u.y, u.z));
    return vec3(low, max(min(u.x, u.y), min(max(u.x, u.y), u.z)), high);
}

// Rise over `own` of the two triangles with corner heights h00, h10 (march), h01 (lane), h11. Takes
// differences first, so that a small rise on a high summit keeps its digits.
float surface_rise(float h00, float h10, float h01, float h11, float own, float u, float f, bool split_along) {
    float along_march = (h00 - own) + u * (h10 - h00) + f * (h11 - h10);
    float along_lane = (h00 - own) + f * (h01 - h00) + u * (h11 - h01);
    float near_corner = (h00 - own) + u * (h10 - h00) + f * (h01 - h00);
    float far_corner = (h11 - own) + (1.0 - u) * (h01 - h11) + (1.0 - f) * (h10 - h11);
    float split = f <= u ? along_march : along_lane;
    float across = u + f <= 1.0 ? near_corner : far_corner;
    return split_along ? split : across;
}
