//! A field on a cylinder as real geometry: a mesh of triangles in space, and rays that share no code
//! with height fields.

use glam::DVec3;
use ridgelight::scene::HeightField;

/// A ray begins so far above its grid point, m: over the triangles that meet there, so that a downward
/// ray hits them.
const CLEARANCE_M: f64 = 1e-5;
/// Triangles of a leaf.
const LEAF: usize = 4;

/// A grid point's place on the base, and the axes of its frame.
#[derive(Clone, Copy)]
pub struct Frame {
    place: DVec3,
    east: DVec3,
    north: DVec3,
    up: DVec3,
}

impl Frame {
    /// A vector of the frame in space.
    pub fn out(&self, v: DVec3) -> DVec3 {
        v.x * self.east + v.y * self.north + v.z * self.up
    }
}

/// The triangle that a ray hits, and how far away.
#[derive(Clone, Copy)]
pub struct Hit {
    pub triangle: usize,
    pub distance_m: f64,
}

/// The box of a part of the order; its halves are the next node and `second`, a leaf has none.
struct Node {
    low: DVec3,
    high: DVec3,
    part: std::ops::Range<usize>,
    second: Option<usize>,
}

pub struct Mesh {
    pub frames: Vec<Frame>,
    /// The grid points at each triangle's corners, counter-clockwise from outside.
    pub triangles: Vec<[usize; 3]>,
    order: Vec<usize>,
    nodes: Vec<Node>,
}

impl Mesh {
    /// A field whose base bends towards east: its middle column stays level, columns stand on normals.
    pub fn bent(field: &HeightField, curvature_per_m: f64) -> Self {
        let (rows, cols) = (field.rows(), field.cols());
        let [cell_x, cell_y] = field.cell_m();
        let frame = |at: usize| {
            let x = cell_x * ((at % cols) as f64 - 0.5 * (cols - 1) as f64);
            let y = -cell_y * (at / cols) as f64;
            let height = f64::from(field.heights_m()[at]);
            let (north, radius) = (DVec3::Y, 1.0 / curvature_per_m);
            if curvature_per_m == 0.0 {
                return Frame {
                    place: DVec3::new(x, y, height),
                    east: DVec3::X,
                    north,
                    up: DVec3::Z,
                };
            }
            let (sin, cos) = (x / radius).sin_cos();
            let up = DVec3::new(sin, 0.0, cos);
            let place = (radius + height) * up + DVec3::new(0.0, y, -radius);
            Frame { place, east: DVec3::new(cos, 0.0, -sin), north, up }
        };
        let frames: Vec<Frame> = (0..rows * cols).map(frame).collect();
        let mut triangles = Vec::new();
        for nw in (0..(rows - 1) * cols).filter(|at| at % cols < cols - 1) {
            let [ne, sw, se] = [nw + 1, nw + cols, nw + cols + 1];
            triangles.extend([[nw, sw, se], [nw, se, ne]]);
        }
        let order = (0..triangles.len()).collect();
        let mut mesh = Self { frames, triangles, order, nodes: Vec::new() };
        mesh.split(0..mesh.triangles.len());
        mesh
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.frames[i].place)
    }

    /// The sum of the adjoining quads' normals, as the renderer shades, in space.
    pub fn normals(&self) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.frames.len()];
        for pair in self.triangles.chunks_exact(2) {
            let quad = [pair[0][0], pair[0][1], pair[0][2], pair[1][2]];
            let [a, b, c, d] = quad.map(|i| self.frames[i].place);
            let normal = (c - a).cross(d - b);
            quad.into_iter().for_each(|i| sums[i] += normal);
        }
        sums.into_iter().map(DVec3::normalize).collect()
    }

    /// Adds the nodes of a part of the order, halved across its widest extent.
    fn split(&mut self, part: std::ops::Range<usize>) -> usize {
        let corners = self.order[part.clone()].iter().flat_map(|t| self.corners(*t));
        let (low, high) = corners.fold((DVec3::MAX, DVec3::MIN), |(l, h), p| (l.min(p), h.max(p)));
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, part: part.clone(), second: None });
        if part.len() > LEAF {
            let extent = high - low;
            let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).expect("three");
            let mut own = self.order[part.clone()].to_vec();
            let middle = |t: &usize| self.corners(*t).iter().map(|p| p[axis]).sum::<f64>();
            own.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
            self.order[part.clone()].copy_from_slice(&own);
            let half = (part.start + part.end) / 2;
            self.split(part.start..half);
            self.nodes[at].second = Some(self.split(half..part.end));
        }
        at
    }

    /// Just over a grid point, where its rays begin.
    pub fn over(&self, at: usize) -> DVec3 {
        self.frames[at].place + CLEARANCE_M * self.frames[at].up
    }

    /// The normal of the side of a triangle that a ray hits.
    pub fn facing(&self, triangle: usize, e: DVec3) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a).normalize();
        if normal.dot(e) > 0.0 { -normal } else { normal }
    }

    /// Just over a hit, where the next ray begins.
    pub fn place(&self, hit: &Hit, from: DVec3, e: DVec3) -> DVec3 {
        from + hit.distance_m * e + CLEARANCE_M * self.facing(hit.triangle, e)
    }

    /// The first hit of a ray.
    pub fn met(&self, from: DVec3, e: DVec3) -> Option<Hit> {
        let inverse = e.map(|c| 1.0 / c);
        let (mut open, mut best) = (vec![0], None::<Hit>);
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            let [a, b] = [(node.low - from) * inverse, (node.high - from) * inverse];
            // 0 · ∞ is NaN, and leaves the other bound.
            let [near, far] = [a.min(b).max_element(), a.max(b).min_element()];
            let limit = best.map_or(f64::MAX, |hit| hit.distance_m);
            if near > far.min(limit) || far < 0.0 {
                continue;
            }
            if let Some(second) = node.second {
                open.extend([at + 1, second]);
                continue;
            }
            for triangle in &self.order[node.part.clone()] {
                if let Some(distance_m) = met(self.corners(*triangle), from, e)
                    && best.is_none_or(|hit| distance_m < hit.distance_m)
                {
                    best = Some(Hit { triangle: *triangle, distance_m });
                }
            }
        }
        best
    }
}

/// The distance at which a ray hits a triangle, from either side (Möller & Trumbore 1997).
fn met([a, b, c]: [DVec3; 3], from: DVec3, e: DVec3) -> Option<f64> {
    let (u, v) = (b - a, c - a);
    let across = e.cross(v);
    let volume = u.dot(across);
    let to = from - a;
    let (first, turned) = (to.dot(across) / volume, to.cross(u));
    let (second, distance) = (e.dot(turned) / volume, v.dot(turned) / volume);
    // A seam belongs to both sides. A volume of 0 makes NaN, which fails.
    let least = -1e-12;
    (first >= least && second >= least && first + second <= 1.0 - least && distance > 0.0)
        .then_some(distance)
}
