//! Triangulation of points on the unit sphere: their convex hull, whose faces are the spherical Delaunay triangulation, as
//! no other point lies in a face's circumcircle.
//!
//! Computed once, in f64, by inserting one point after the other and testing all faces for each: N² steps.

use glam::DVec3;

/// Height above a face's plane, on a unit sphere, above which the face is visible from a point: far above the rounding of its distance,
/// 4 · 2⁻⁵³, and far below the height of the cap of any isolated point. Four points on one circle become two triangles,
/// either pair.
const LEAST_ABOVE: f64 = 1e-13;

/// A triangulation of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    corners: Vec<[u32; 3]>,
}

impl Triangles {
    /// The triangulation of unit vectors. `None` for fewer than four, or if not all of them lie on their hull: two equal
    /// points, or all on one circle.
    ///
    /// If the points do not surround the centre, as on a hemisphere, the faces below it are omitted, as no point represents
    /// them.
    pub(crate) fn of(points: &[DVec3]) -> Option<Self> {
        let first = tetrahedron(points)?;
        let centre = first.iter().map(|i| points[*i]).sum::<DVec3>() / 4.0;
        let mut faces: Vec<[usize; 3]> = (0..4)
            .map(|left_out| {
                let [a, b, c] = [1, 2, 3].map(|k| first[(left_out + k) % 4]);
                if above(points, [a, b, c], centre) > 0.0 { [a, c, b] } else { [a, b, c] }
            })
            .collect();
        for i in (0..points.len()).filter(|i| !first.contains(i)) {
            let (visible, kept): (Vec<_>, Vec<_>) =
                faces.into_iter().partition(|face| above(points, *face, points[i]) > LEAST_ABOVE);
            if visible.is_empty() {
                return None;
            }
            let edges: Vec<[usize; 2]> = visible.iter().flat_map(|face| edges(*face)).collect();
            faces = kept;
            // Edges of only one visible face form the rim.
            let rim = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
            faces.extend(rim.map(|[a, b]| [*a, *b, i]));
        }
        // Euler: F = 2 V - 4 for a closed net of all points.
        if faces.len() != 2 * points.len() - 4 {
            return None;
        }
        let outside = faces.into_iter().filter(|face| volume(points, *face) > 0.0);
        Some(Self { corners: outside.map(|face| face.map(|i| i as u32)).collect() })
    }

    /// Keeps the triangles whose centres are not below a height; `points` are those of construction. Removes the lid over a cap
    /// without points.
    pub(crate) fn above(mut self, points: &[DVec3], lowest_z: f64) -> Self {
        self.corners.retain(|face| {
            let sum: DVec3 = face.iter().map(|i| points[*i as usize]).sum();
            sum.z >= lowest_z * sum.length()
        });
        self
    }

    /// Indices of points, counter-clockwise from outside.
    pub fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }

    /// Solid angle of each triangle over `points`, sr: those of construction, or the same after a small move. Negative where
    /// triangles have flipped.
    ///
    /// # Panics
    /// If there are fewer points than at construction.
    fn areas_sr(&self, points: &[DVec3]) -> Vec<f64> {
        self.corners.iter().map(|face| area_sr(face.map(|i| points[i as usize]))).collect()
    }

    /// A third of the solid angle of the triangles around each point, sr: the share of the sphere that it represents.
    ///
    /// # Panics
    /// If there are fewer points than at construction.
    pub fn fans_sr(&self, points: &[DVec3]) -> Vec<f64> {
        let mut fans = vec![0.0; points.len()];
        for (face, area) in self.corners.iter().zip(self.areas_sr(points)) {
            face.iter().for_each(|i| fans[*i as usize] += area / 3.0);
        }
        fans
    }

    /// The corners of the triangle that contains a direction, with barycentric weights in the flat triangle at the direction's
    /// intersection; they sum to 1. `None` where no triangle covers it.
    ///
    /// # Panics
    /// As [`fans_sr`](Self::fans_sr).
    pub fn around(&self, points: &[DVec3], direction: DVec3) -> Option<[(u32, f64); 3]> {
        let shares = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|i| points[i as usize]);
            let of =
                [direction.dot(b.cross(c)), direction.dot(c.cross(a)), direction.dot(a.cross(b))];
            let sum = of[0] + of[1] + of[2];
            of.map(|v| v / sum)
        };
        let inside = |face: &&[u32; 3]| {
            let [a, b, c] = face.map(|i| points[i as usize]);
            // On an edge, either triangle is correct.
            let least = -LEAST_ABOVE;
            direction.dot(a.cross(b)) >= least
                && direction.dot(b.cross(c)) >= least
                && direction.dot(c.cross(a)) >= least
                && direction.dot(a + b + c) > 0.0
        };
        let face = self.corners.iter().find(inside)?;
        let shares = shares(face);
        Some([0, 1, 2].map(|k| (face[k], shares[k].max(0.0))))
    }
}

/// Four points that span a tetrahedron: two far apart, one far from their line, one far from their plane.
fn tetrahedron(points: &[DVec3]) -> Option<[usize; 4]> {
    let farthest = |of: &dyn Fn(DVec3) -> f64| {
        (0..points.len()).max_by(|a, b| of(points[*a]).total_cmp(&of(points[*b])))
    };
    let a = *points.first()?;
    let i = farthest(&|p| (p - a).length())?;
    let b = points[i];
    let j = farthest(&|p| (p - a).cross(b - a).length())?;
    let normal = (b - a).cross(points[j] - a);
    let k = farthest(&|p| (p - a).dot(normal).abs())?;
    let spans = (points[k] - a).dot(normal).abs() > LEAST_ABOVE * normal.length();
    (spans && normal.length() > LEAST_ABOVE).then_some([0, i, j, k])
}

/// Height of a point above a face's plane.
fn above(points: &[DVec3], face: [usize; 3], place: DVec3) -> f64 {
    let [a, b, c] = face.map(|i| points[i]);
    let normal = (b - a).cross(c - a);
    (place - a).dot(normal) / normal.length()
}

/// Six times the volume between a face and the centre.
fn volume(points: &[DVec3], face: [usize; 3]) -> f64 {
    let [a, b, c] = face.map(|i| points[i]);
    a.dot(b.cross(c))
}

fn edges([a, b, c]: [usize; 3]) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Solid angle of a spherical triangle, sr; negative if clockwise (Van Oosterom & Strackee 1983).
fn area_sr([a, b, c]: [DVec3; 3]) -> f64 {
    2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
