//! Ellipses of visible sky on bases of any small curvature, between five that were fitted (Heidrich et al. 2000, §5).

use glam::{DVec2, DVec3};

use super::Ellipse;
use ridgelight::scene::Curvature;

/// Of a sample: the ellipse on the flat base, and by how much its numbers change with curvature, linearly.
///
/// Axes of ellipses that were fitted apart may be swapped or turned round where the shapes hardly differ, and between two
/// such lies nothing. So an ellipse is kept as its centre and the symmetric matrix that takes the unit disc to its shape, P =
/// Σ r a aᵀ of its axes a and radii r: five numbers which are the same whichever axis is called the first, and linear in
/// radii. The whole disc is that of radius 1, nothing the point P = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedEllipses {
    /// Centre (east, north), P's xx, yy and xy; of the flat base, of curvature towards east above 0 and below, towards north above
    /// and below.
    pub numbers: [[f64; 5]; 5],
    /// The curvatures that they were fitted at, 1/m, both above 0: outwards, inwards.
    pub steps_per_m: [f64; 2],
}

impl CurvedEllipses {
    /// Of what [`plan::curved_ellipses`](ridgelight::plan::curved_ellipses) leaves of a sample.
    pub fn of(five: &[Ellipse; 5], steps_per_m: [f64; 2]) -> Self {
        // What is nothing has no centre: that of the flat base, or of all others that have one.
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

    /// Centre and P on a base of some curvature: between the five, and beyond them on as they change there.
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

    /// Whether light from a direction of the sample's own frame arrives, a unit vector whose z is above 0; or the sample is
    /// seen from there.
    pub fn holds(&self, curvature: Curvature, direction: DVec3) -> bool {
        holds(self.at(curvature), direction)
    }
}

/// Whether |P⁻¹ v| ≤ 1 of v from the centre: |adj P v| ≤ det P. A shape that has shrunk to nothing and beyond holds nothing.
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
