//! A field on a cylinder as real geometry: a mesh of triangles in space, and rays that know nothing of fields.

use glam::DVec3;
use ridgelight::scene::HeightField;

/// How far over its sample a ray begins, m: over the triangles that meet there, so that one downwards meets them.
const CLEARANCE_M: f64 = 1e-5;
/// Triangles that are looked at one by one.
const LEAF: usize = 4;

/// A sample's place on the base, and the axes of its frame.
#[derive(Clone, Copy)]
pub struct Frame {
    pub place: DVec3,
    pub east: DVec3,
    pub north: DVec3,
    pub up: DVec3,
}

impl Frame {
    /// A vector of the frame in space.
    pub fn out(&self, v: DVec3) -> DVec3 {
        v.x * self.east + v.y * self.north + v.z * self.up
    }
}

/// What a ray has met: a triangle, and how far off.
#[derive(Clone, Copy)]
pub struct Hit {
    pub triangle: usize,
    pub distance_m: f64,
}

struct Node {
    low: DVec3,
    high: DVec3,
    /// Of a leaf its triangles, of others the two nodes below.
    from: usize,
    to: usize,
    is_leaf: bool,
}

pub struct Mesh {
    pub frames: Vec<Frame>,
    /// The samples at each triangle's corners, counter-clockwise from outside.
    pub triangles: Vec<[usize; 3]>,
    places: Vec<DVec3>,
    order: Vec<usize>,
    nodes: Vec<Node>,
}

impl Mesh {
    /// A field whose base bends towards east by a curvature: its middle column stays level, columns stand on normals.
    pub fn bent(field: &HeightField, curvature_per_m: f64) -> Self {
        let (rows, cols) = (field.rows(), field.cols());
        let [cell_x, cell_y] = field.cell_m();
        let frame = |at: usize| {
            let (x, y) = (
                cell_x * ((at % cols) as f64 - 0.5 * (cols - 1) as f64),
                -cell_y * (at / cols) as f64,
            );
            let height = f64::from(field.heights_m()[at]);
            if curvature_per_m == 0.0 {
                let place = DVec3::new(x, y, height);
                return Frame { place, east: DVec3::X, north: DVec3::Y, up: DVec3::Z };
            }
            let radius = 1.0 / curvature_per_m;
            let (sin, cos) = (x / radius).sin_cos();
            let up = DVec3::new(sin, 0.0, cos);
            let place = (radius + height) * up + DVec3::new(0.0, y, -radius);
            Frame { place, east: DVec3::new(cos, 0.0, -sin), north: DVec3::Y, up }
        };
        let frames: Vec<Frame> = (0..rows * cols).map(frame).collect();
        let mut triangles = Vec::new();
        for row in 0..rows - 1 {
            for col in 0..cols - 1 {
                let at = row * cols + col;
                let [nw, ne, sw, se] = [at, at + 1, at + cols, at + cols + 1];
                triangles.extend([[nw, sw, se], [nw, se, ne]]);
            }
        }
        let places = frames.iter().map(|f| f.place).collect();
        let order = (0..triangles.len()).collect();
        let mut mesh = Self { frames, triangles, places, order, nodes: Vec::new() };
        mesh.split(0, mesh.triangles.len());
        mesh
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.places[i])
    }

    /// The sum of the adjoining quads' normals, which the renderer shades by, in space.
    pub fn normals(&self, cols: usize) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.places.len()];
        for pair in self.triangles.chunks_exact(2) {
            let [nw, sw, se, ne] = [pair[0][0], pair[0][1], pair[0][2], pair[1][2]];
            debug_assert_eq!(sw, nw + cols);
            let [a, b, c, d] = [nw, sw, se, ne].map(|i| self.places[i]);
            let normal = (c - a).cross(d - b);
            [nw, sw, se, ne].into_iter().for_each(|i| sums[i] += normal);
        }
        sums.into_iter().map(DVec3::normalize).collect()
    }

    /// The node over some of the order, halved across its widest extent.
    fn split(&mut self, from: usize, to: usize) -> usize {
        let corners = self.order[from..to].iter().flat_map(|t| self.corners(*t));
        let (low, high) = corners.fold((DVec3::MAX, DVec3::MIN), |(l, h), p| (l.min(p), h.max(p)));
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, from, to, is_leaf: true });
        if to - from > LEAF {
            let extent = high - low;
            let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).expect("three");
            let mut part = self.order[from..to].to_vec();
            let middle = |t: &usize| self.corners(*t).iter().map(|p| p[axis]).sum::<f64>();
            part.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
            self.order[from..to].copy_from_slice(&part);
            let half = (from + to) / 2;
            let first = self.split(from, half);
            let second = self.split(half, to);
            self.nodes[at] = Node { low, high, from: first, to: second, is_leaf: false };
        }
        at
    }

    /// Just over a sample, where its rays begin.
    pub fn over(&self, sample: usize) -> DVec3 {
        self.places[sample] + CLEARANCE_M * self.frames[sample].up
    }

    /// The side of a triangle that a ray has come to, as its normal.
    pub fn facing(&self, triangle: usize, e: DVec3) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a).normalize();
        if normal.dot(e) > 0.0 { -normal } else { normal }
    }

    /// Just over what a ray has met, where those begin that go on.
    pub fn place(&self, hit: &Hit, from: DVec3, e: DVec3) -> DVec3 {
        from + hit.distance_m * e + CLEARANCE_M * self.facing(hit.triangle, e)
    }

    /// The first that a ray meets.
    pub fn met(&self, from: DVec3, e: DVec3) -> Option<Hit> {
        let inverse = e.map(|c| 1.0 / c);
        let (mut open, mut best) = (vec![0], None::<Hit>);
        while let Some(node) = open.pop() {
            let node = &self.nodes[node];
            let [a, b] = [(node.low - from) * inverse, (node.high - from) * inverse];
            // What is 0 · ∞ leaves the other bound.
            let [near, far] = [a.min(b).max_element(), a.max(b).min_element()];
            let limit = best.map_or(f64::MAX, |hit| hit.distance_m);
            if near > far.min(limit) || far < 0.0 {
                continue;
            }
            if !node.is_leaf {
                open.extend([node.from, node.to]);
                continue;
            }
            for triangle in &self.order[node.from..node.to] {
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

/// How far off a ray meets a triangle, from either side (Möller & Trumbore 1997).
fn met([a, b, c]: [DVec3; 3], from: DVec3, e: DVec3) -> Option<f64> {
    let (u, v) = (b - a, c - a);
    let across = e.cross(v);
    let volume = u.dot(across);
    if volume == 0.0 {
        return None;
    }
    let to = from - a;
    let (first, turned) = (to.dot(across) / volume, to.cross(u));
    let (second, distance) = (e.dot(turned) / volume, v.dot(turned) / volume);
    // A seam belongs to both sides.
    let least = -1e-12;
    (first >= least && second >= least && first + second <= 1.0 - least && distance > 0.0)
        .then_some(distance)
}
