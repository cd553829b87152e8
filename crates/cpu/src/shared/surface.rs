//! `surface.glsl`: the surface between two march steps, in local coordinates of a line: u along the
//! march from the earlier step, f across the lanes from the line's cell, both from 0 to 1.

/// No crossing: beyond the end of the segment.
pub const NO_CROSSING: f32 = 2.0;

/// Threshold between equal and greater: positions are multiples of 1/32768 of a cell, or quotients with integers up
/// to 4096, which a device may round with an error of 2.5 ulp.
pub const HAIR: f32 = 1e-5;

/// Where a line that starts at `f0` and advances by `shear` crosses lane lines and cell diagonals
/// strictly between two steps, sorted; these and the steps themselves are all the vertices of the
/// profile. `split_along` says that diagonals run from (0, 0) to (1, 1), else from (1, 0) to (0, 1).
pub fn segment_crossings(f0: f32, shear: f32, split_along: bool) -> [f32; 3] {
    let mut u = [NO_CROSSING; 3];
    if f0 + shear > 1.0 + HAIR {
        u[0] = (1.0 - f0) / shear;
    }
    if split_along {
        // f - u is an integer: from f0 down to f0 + shear - 1, past 0.
        if f0 > 0.0 && f0 + shear < 1.0 - HAIR {
            u[1] = f0 / (1.0 - shear);
        }
    } else {
        // f + u is an integer: from f0 up to f0 + shear + 1, past 1 and perhaps 2.
        if f0 + shear > 0.0 {
            u[1] = (1.0 - f0) / (1.0 + shear);
        }
        if f0 + shear > 1.0 + HAIR {
            u[2] = (2.0 - f0) / (1.0 + shear);
        }
    }
    u.sort_by(f32::total_cmp);
    u
}

/// Rise over `own` of the two triangles with corner heights h00, h10 (march), h01 (lane), h11, given
/// in that order. Takes differences first, so that a small rise on a high summit keeps its digits.
pub fn surface_rise(corners: [f32; 4], own: f32, u: f32, f: f32, split_along: bool) -> f32 {
    let [h00, h10, h01, h11] = corners;
    if split_along {
        if f <= u {
            (h00 - own) + u * (h10 - h00) + f * (h11 - h10)
        } else {
            (h00 - own) + f * (h01 - h00) + u * (h11 - h01)
        }
    } else if u + f <= 1.0 {
        (h00 - own) + u * (h10 - h00) + f * (h01 - h00)
    } else {
        (h11 - own) + (1.0 - u) * (h01 - h11) + (1.0 - f) * (h10 - h11)
    }
}
