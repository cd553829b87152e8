//! Visibility ellipses on curved base surfaces, interpolated between five fits (Heidrich et al.
//! 2000, §5).

use glam::{DVec2, DVec3};

use super::Ellipse;
use ridgelight::scene::Curvature;

/// A texel's ellipse on the flat base, and its linear change with curvature.
///
/// Independently fitted ellipses may swap or reverse their axes where the shapes hardly differ, so
/// axes cannot be interpolated. An ellipse is therefore stored as its centre and the symmetric
/// matrix P = Σ r a aᵀ over its axes a and radii r, which maps the unit disc to its shape. These
/// five numbers do not depend on the order of the axes and are linear in the radii. Full visibility
/// is the disc of radius 1; no visibility is P = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedEllipses {
    /// Centre (east, north), then P's xx, yy and xy. Order: flat base, curvature towards east above
    /// 0 and below 0, towards north above 0 and below 0.
    pub numbers: [[f64; 5]; 5],
    /// Curvatures of the fits, 1/m, both above 0: convex, concave.
    pub steps_per_m: [f64; 2],
}

impl CurvedEllipses {
    /// From one texel of [`plan::curved_ellipses`](ridgelight::plan::curved_ellipses).
    pub fn of(five: &[Ellipse; 5], steps_per_m: [f64; 2]) -> Self {
        // An empty ellipse has no centre: it takes the flat base's, else the mean of the others.
        let own = five.iter().filter(|e| **e != Ellipse::EMPTY).map(centre);
        let (sum, count) = own.fold((DVec2::ZERO, 0.0), |(s, n), c| (s + c, n + 1.0));
        let others = if count > 0.0 { sum / count } else { DVec2::ZERO };
        let flat = if five[0] == Ellipse::EMPTY { others } else { centre(&five[0]) };
        let numbers = five.map(|ellipse| {
            if ellipse == Ellipse::EMPTY {
                return [flat.x, flat.y, 0.0, 0.0, 0.0];
            }
            let (c, a, b) = (centre(&ellipse), ellipse.axis, ellipse.axis.perp());
            let [along, across] = radii(&ellipse);
            let of = |i: usize, j: usize| along * a[i] * a[j] + across * b[i] * b[j];
            [c.x, c.y, of(0, 0), of(1, 1), of(0, 1)]
        });
        Self { numbers, steps_per_m }
    }

    /// Centre and P on a base of this curvature: interpolated between the five fits, extrapolated
    /// beyond.
    pub fn at(&self, curvature: Curvature) -> [f64; 5] {
        let mut numbers = self.numbers[0];
        for (axis, k) in curvature.per_m.into_iter().enumerate() {
            let side = usize::from(k < 0.0);
            let share = k.abs() / self.steps_per_m[side];
            let towards = &self.numbers[1 + 2 * axis + side];
            for (number, (to, from)) in numbers.iter_mut().zip(towards.iter().zip(&self.numbers[0]))
            {
                *number += share * (to - from);
            }
        }
        numbers
    }

    /// Whether light arrives from a unit vector in the grid point's own frame, z above 0. The
    /// visibility of the grid point from that direction is the same.
    pub fn holds(&self, curvature: Curvature, direction: DVec3) -> bool {
        holds(self.at(curvature), direction)
    }
}

/// Whether |P⁻¹ v| ≤ 1 for v from the centre: |adj P v| ≤ det P. A shape extrapolated beyond
/// nothing is empty.
fn holds([x, y, xx, yy, xy]: [f64; 5], direction: DVec3) -> bool {
    let v = direction.truncate() - DVec2::new(x, y);
    let determinant = xx * yy - xy * xy;
    let to = DVec2::new(yy * v.x - xy * v.y, xx * v.y - xy * v.x);
    xx + yy > 0.0 && determinant > 0.0 && to.length_squared() <= determinant * determinant
}

fn centre(ellipse: &Ellipse) -> DVec2 {
    if ellipse.inverse_radii == [0.0; 2] { DVec2::ZERO } else { ellipse.centre }
}

fn radii(ellipse: &Ellipse) -> [f64; 2] {
    if ellipse.inverse_radii == [0.0; 2] {
        [1.0; 2]
    } else {
        ellipse.inverse_radii.map(|r| 1.0 / r)
    }
}
