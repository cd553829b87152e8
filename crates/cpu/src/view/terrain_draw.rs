//! Hit of a camera ray on the mesh, in f64, by testing every triangle. It shares only conventions of camera and mesh
//! with the recorded passes, no matrix.

use glam::DVec3;
use ridgelight::scene::{Camera, HeightField, Lens};

/// A visible point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Distance along the viewing direction, from the camera's plane.
    pub distance_m: f64,
    /// Column, in grid points.
    pub col: f64,
    /// Row, in grid points.
    pub row: f64,
}

/// A camera's ray: an origin and the offset per metre along the viewing direction.
pub fn ray(camera: &Camera, size: [u32; 2], pixel: [f64; 2]) -> [DVec3; 2] {
    let [right, up, back] = camera.axes();
    let [width, height] = size.map(f64::from);
    let x = (2.0 * pixel[0] / width - 1.0) * width / height;
    let y = 1.0 - 2.0 * pixel[1] / height;
    let aside = right * x + up * y;
    match camera.lens {
        Lens::Perspective { fov_rad } => [camera.eye_m(), aside * (fov_rad / 2.0).tan() - back],
        Lens::Orthographic { height_m } => [camera.eye_m() + aside * (height_m / 2.0), -back],
    }
}

/// First hit at a place of a picture: `pixel` counts pixels from the upper left corner, centres at halves. The mesh
/// has a vertex at every `step`th grid point.
pub fn terrain_draw(
    field: &HeightField,
    camera: &Camera,
    (size, pixel): ([u32; 2], [f64; 2]),
    step: u32,
) -> Option<Met> {
    let [origin, along] = ray(camera, size, pixel);
    let (rows, cols) = (field.rows(), field.cols());
    let step = step as usize;
    let nearest = match camera.lens {
        Lens::Perspective { .. } => 0.0,
        Lens::Orthographic { .. } => f64::NEG_INFINITY,
    };
    let mut best: Option<Met> = None;
    for r in (0..rows - 1).step_by(step) {
        for c in (0..cols - 1).step_by(step) {
            let (south, east) = ((r + step).min(rows - 1), (c + step).min(cols - 1));
            for corners in [[[r, c], [r, east], [south, east]], [[r, c], [south, east], [south, c]]]
            {
                let met = triangle(field, corners, [origin, along]);
                let Some(met) = met.filter(|m| m.distance_m > nearest && !is_hole(field, m)) else {
                    continue;
                };
                if best.is_none_or(|b| met.distance_m < b.distance_m) {
                    best = Some(met);
                }
            }
        }
    }
    best
}

/// Where a ray crosses a triangle, edges included (Möller & Trumbore 1997).
fn triangle(
    field: &HeightField,
    corners: [[usize; 2]; 3],
    [origin, along]: [DVec3; 2],
) -> Option<Met> {
    let [cell_x, cell_y] = field.cell_m();
    let last = field.rows() - 1;
    let place = |[r, c]: [usize; 2]| {
        let height = field.base_m() + f64::from(field.heights_m()[r * field.cols() + c]);
        DVec3::new(c as f64 * cell_x, (last - r) as f64 * cell_y, height)
    };
    let [a, b, c] = corners.map(place);
    let (ab, ac) = (b - a, c - a);
    let p = along.cross(ac);
    let volume = ab.dot(p);
    if volume == 0.0 {
        return None;
    }
    let from = origin - a;
    let q = from.cross(ab);
    let (u, v) = (from.dot(p) / volume, along.dot(q) / volume);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| {
        let mix = |of: usize| {
            let [a, b, c] = corners.map(|corner| corner[of] as f64);
            a + u * (b - a) + v * (c - a)
        };
        Met { distance_m: ac.dot(q) / volume, row: mix(0), col: mix(1) }
    })
}

/// Whether the field's own triangle at a position has a void corner.
fn is_hole(field: &HeightField, met: &Met) -> bool {
    let Some(voids) = field.voids() else { return false };
    let (row, col, [down, right]) = cell(field, met);
    let third = if down > right { [row + 1, col] } else { [row, col + 1] };
    [[row, col], third, [row + 1, col + 1]].iter().any(|[r, c]| voids[r * field.cols() + c])
}

/// The cell of a position, and how far down and right in it.
fn cell(field: &HeightField, met: &Met) -> (usize, usize, [f64; 2]) {
    let floor = |v: f64, grid_points: usize| (v.floor().max(0.0) as usize).min(grid_points - 2);
    let (row, col) = (floor(met.row, field.rows()), floor(met.col, field.cols()));
    (row, col, [met.row - row as f64, met.col - col as f64])
}

/// Exit radiance of a position, bilinear between the grid points around it.
pub fn colour(field: &HeightField, radiance: &[[f32; 3]], met: &Met) -> [f64; 3] {
    let (row, col, [down, right]) = cell(field, met);
    let at = |r: usize, c: usize, k: usize| f64::from(radiance[r * field.cols() + c][k]);
    std::array::from_fn(|k| {
        let across = |r: usize| at(r, col, k) + right * (at(r, col + 1, k) - at(r, col, k));
        across(row) + down * (across(row + 1) - across(row))
    })
}
