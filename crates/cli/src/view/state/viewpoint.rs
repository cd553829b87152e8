//! The viewpoint: from above or by a camera, and where a pixel meets the ground.

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::{Limits, Map, Plan, View, ViewOptions};
use ridgelight::scene::{Camera, HeightField, Lens, Scene, Tone};

use super::hundredths;
use crate::render::camera::{PLINTH, plinth};

/// Vertical field of view of the camera, degrees.
pub const FOV_DEG: f64 = 40.0;

/// Most cells of the mesh along a side: larger fields skip grid points.
const MOST_CELLS: u32 = 1024;

/// The same while something moves on a software driver.
const MOVING_CELLS: u32 = 192;
/// Most grid points a pixel, as [`Map`] allows.
const MOST_PER_PIXEL: f64 = 1e3;

/// Most steps along a ray to the ground.
const MOST_STEPS: f64 = 4096.0;

/// A section of the map.
#[derive(Clone, Copy)]
struct Place {
    /// Column and row in the middle of the picture.
    middle: [f64; 2],
    grid_points_per_pixel: f64,
}

/// Where a field is viewed from.
#[derive(Clone, Copy, Default)]
pub struct Viewpoint {
    /// None: all of the field.
    place: Option<Place>,
    /// None: from straight above.
    pub camera: Option<Camera>,
    /// Of the field as it was when the camera began.
    plinth_base_m: Option<f64>,
}

impl Viewpoint {
    /// The visible section in a picture of a size.
    pub fn map(
        &self,
        field: &HeightField,
        (size, swaps, has_colour): ([u32; 2], bool, bool),
        tone: Tone,
    ) -> Map {
        let Place { grid_points_per_pixel, .. } = self.place(field, size);
        Map {
            field: [field.cols() as u32, field.rows() as u32],
            has_colour,
            has_voids: field.voids().is_some(),
            size,
            corner: self.corner(field, size).map(|c| c as f32),
            grid_points_per_pixel: grid_points_per_pixel as f32,
            is_smooth: false,
            tone,
            swaps,
        }
    }

    /// Column and row at the map's upper left corner; whole pixels, so that all texels have the
    /// same size.
    fn corner(&self, field: &HeightField, size: [u32; 2]) -> [f64; 2] {
        let Place { middle, grid_points_per_pixel } = self.place(field, size);
        std::array::from_fn(|i| {
            let pixels = middle[i] / grid_points_per_pixel - f64::from(size[i]) / 2.0;
            pixels.round() * grid_points_per_pixel
        })
    }

    fn place(&self, field: &HeightField, size: [u32; 2]) -> Place {
        self.place.unwrap_or_else(|| {
            let field = [field.cols(), field.rows()].map(|n| n as f64);
            let needed = (field[0] / f64::from(size[0])).max(field[1] / f64::from(size[1]));
            // Whole pixels per texel where there are enough; of a field that is too large for the window, its middle.
            let grid_points_per_pixel = if needed <= 1.0 {
                1.0 / (1.0 / needed).floor()
            } else {
                needed.min(MOST_PER_PIXEL)
            };
            Place { middle: field.map(|n| n / 2.0), grid_points_per_pixel }
        })
    }

    fn shift(&mut self, field: &HeightField, size: [u32; 2], pixels: [f64; 2]) {
        let mut place = self.place(field, size);
        let field = [field.cols(), field.rows()];
        for i in 0..2 {
            let moved = place.middle[i] - pixels[i] * place.grid_points_per_pixel;
            place.middle[i] = moved.clamp(0.0, field[i] as f64);
        }
        self.place = Some(place);
    }

    /// Zooms by a factor around a pixel of a map.
    pub fn near(&mut self, field: &HeightField, size: [u32; 2], factor: f64, at: [f64; 2]) {
        if let Some(camera) = &mut self.camera {
            camera.distance_m = (camera.distance_m / factor).clamp(1e-6, 1e12);
            return;
        }
        let mut place = self.place(field, size);
        let finer = (place.grid_points_per_pixel / factor).clamp(1.0 / 64.0, 64.0);
        for i in 0..2 {
            let off = at[i] - f64::from(size[i]) / 2.0;
            place.middle[i] += off * (place.grid_points_per_pixel - finer);
        }
        place.grid_points_per_pixel = finer;
        self.place = Some(place);
    }

    /// The camera's view, if there is a camera.
    pub fn view(
        &self,
        (scene, is_coarse): (&Scene, bool),
        lit: &Plan,
        size: [u32; 2],
        limits: &Limits,
    ) -> Result<Option<View>> {
        let Some(camera) = &self.camera else { return Ok(None) };
        let mut options = Self::options(&scene.field, size, limits);
        options.plinth_base_m = self.plinth_base_m;
        if is_coarse {
            let longest = scene.field.rows().max(scene.field.cols()) as u32;
            options.mesh_step = longest.div_ceil(MOVING_CELLS).clamp(options.mesh_step, 1024);
        }
        View::new(scene, lit, camera, &options, limits).map(Some)
    }

    pub fn options(field: &HeightField, size: [u32; 2], limits: &Limits) -> ViewOptions {
        let longest = field.rows().max(field.cols()) as u32;
        ViewOptions {
            size,
            // Software rasterisers pay for each.
            samples: if limits.is_cpu { 1 } else { 4 },
            mesh_step: longest.div_ceil(MOST_CELLS).min(1024),
            ..ViewOptions::default()
        }
    }

    /// All of the field: from above, or from the south where there is a camera.
    pub fn all(&mut self, field: &HeightField, size: [u32; 2]) {
        match &self.camera {
            Some(_) => self.begin_camera(field, size),
            None => self.place = None,
        }
    }

    /// From the south, with all of the field and its plinth in the picture. The field has two rows and two
    /// columns.
    pub fn begin_camera(&mut self, field: &HeightField, size: [u32; 2]) {
        let aspect = aspect(size);
        let lens = Lens::Perspective { fov_rad: FOV_DEG.to_radians() };
        let angles = [-90_f64, 45.0].map(f64::to_radians);
        let on_plinth = plinth(field, PLINTH);
        let framed = on_plinth.as_ref().map_or(field, |(_, framed)| framed);
        self.plinth_base_m = on_plinth.as_ref().map(|(base_m, _)| *base_m);
        self.camera = Some(Camera::around(framed, None, angles, lens, aspect));
    }

    /// Moves the view by pixels.
    pub fn pan(&mut self, field: &HeightField, size: [u32; 2], pixels: [f64; 2]) {
        let Some(camera) = &mut self.camera else { return self.shift(field, size, pixels) };
        let [right, up, _] = camera.axes();
        let metres = 2.0 * camera.distance_m * tan(camera) / f64::from(size[1].max(1));
        let moved = right * (-pixels[0] * metres) + up * (pixels[1] * metres);
        for (place, by) in camera.target_m.iter_mut().zip(moved.to_array()) {
            *place += by;
        }
    }

    /// Turns the camera by pixels, or moves the map where there is none.
    pub fn turn(&mut self, field: &HeightField, size: [u32; 2], pixels: [f64; 2]) {
        let Some(camera) = &mut self.camera else { return self.shift(field, size, pixels) };
        let per_pixel = 180.0 / f64::from(size[1].max(1));
        // Hundredths of degrees, which files keep.
        let azimuth = camera.azimuth_rad.to_degrees() - pixels[0] * per_pixel;
        camera.azimuth_rad = (90.0 - hundredths(90.0 - azimuth) % 360.0).to_radians();
        let elevation = camera.elevation_rad.to_degrees() + pixels[1] * per_pixel;
        camera.elevation_rad = hundredths(elevation).clamp(1.0, 90.0).to_radians();
    }

    /// The ground under a pixel, absolute; none where there is none.
    pub fn ground(&self, field: &HeightField, size: [u32; 2], at: [f64; 2]) -> Option<[f64; 3]> {
        let Some(camera) = &self.camera else {
            let (corner, Place { grid_points_per_pixel, .. }) =
                (self.corner(field, size), self.place(field, size));
            // A texel is centred in its pixels.
            let [col, row] =
                std::array::from_fn(|i| corner[i] + at[i] * grid_points_per_pixel - 0.5);
            return height(field, [col, row]).map(|z| place(field, [col, row], z));
        };
        let [right, up, back] = camera.axes();
        let tan = tan(camera);
        let x = (2.0 * at[0] / f64::from(size[0].max(1)) - 1.0) * tan * aspect(size);
        let y = (1.0 - 2.0 * at[1] / f64::from(size[1].max(1))) * tan;
        met(field, camera.eye_m(), right * x + up * y - back)
    }

    /// The pixel of a place, and the size of a length there in pixels; none behind the eye.
    pub fn pixel(
        &self,
        field: &HeightField,
        size: [u32; 2],
        [x, y, z]: [f64; 3],
        length_m: f64,
    ) -> Option<([f64; 2], f64)> {
        let Some(camera) = &self.camera else {
            let (corner, Place { grid_points_per_pixel, .. }) =
                (self.corner(field, size), self.place(field, size));
            let [cell_x, cell_y] = field.cell_m();
            let grid_point = [x / cell_x, (field.rows() - 1) as f64 - y / cell_y];
            let at =
                std::array::from_fn(|i| (grid_point[i] + 0.5 - corner[i]) / grid_points_per_pixel);
            return Some((at, length_m / cell_x / grid_points_per_pixel));
        };
        let [right, up, back] = camera.axes();
        let from = DVec3::new(x, y, z) - camera.eye_m();
        let depth = -from.dot(back);
        let half = f64::from(size[1]) / 2.0;
        let scale = half / (depth * tan(camera));
        let at = [f64::from(size[0]) / 2.0 + from.dot(right) * scale, half - from.dot(up) * scale];
        (depth > 0.0).then_some((at, length_m * scale))
    }
}

fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0]) / f64::from(size[1].max(1))
}

/// Half the vertical field of view.
fn tan(camera: &Camera) -> f64 {
    match camera.lens {
        Lens::Perspective { fov_rad } => (fov_rad / 2.0).tan(),
        // The window uses perspective only.
        Lens::Orthographic { .. } => 0.0,
    }
}

/// Absolute position of a column and a row.
fn place(field: &HeightField, [col, row]: [f64; 2], z: f64) -> [f64; 3] {
    let [cell_x, cell_y] = field.cell_m();
    [col * cell_x, ((field.rows() - 1) as f64 - row) * cell_y, z]
}

/// Absolute height at a column and a row, bilinear; none beyond half a cell around the field.
pub fn height(field: &HeightField, [col, row]: [f64; 2]) -> Option<f64> {
    let (rows, cols) = (field.rows(), field.cols());
    let last = [cols - 1, rows - 1].map(|n| n as f64);
    let is_inside = |v: f64, last: f64| v >= -0.5 && v < last + 0.5;
    if !(is_inside(col, last[0]) && is_inside(row, last[1])) {
        return None;
    }
    let [x, y] = [col.clamp(0.0, last[0]), row.clamp(0.0, last[1])];
    let [c, r] = [x.floor(), y.floor()].map(|v| v as usize);
    let at =
        |r: usize, c: usize| f64::from(field.heights_m()[r.min(rows - 1) * cols + c.min(cols - 1)]);
    let along = |r: usize| at(r, c) + (at(r, c + 1) - at(r, c)) * x.fract();
    Some(field.base_m() + along(r) + (along(r + 1) - along(r)) * y.fract())
}

/// Where a ray first goes below the ground.
fn met(field: &HeightField, eye: DVec3, towards: DVec3) -> Option<[f64; 3]> {
    let [cell_x, cell_y] = field.cell_m();
    // Columns and rows instead of metres.
    let last_row = (field.rows() - 1) as f64;
    let from = [eye.x / cell_x, last_row - eye.y / cell_y];
    let way = [towards.x / cell_x, -towards.y / cell_y];
    let (mut begin, mut end) = (0.0_f64, f64::INFINITY);
    for (i, last) in [(0, (field.cols() - 1) as f64), (1, last_row)] {
        if way[i].abs() < 1e-12 {
            if from[i] < 0.0 || from[i] > last {
                return None;
            }
            continue;
        }
        let [a, b] = [-from[i] / way[i], (last - from[i]) / way[i]];
        (begin, end) = (begin.max(a.min(b)), end.min(a.max(b)));
    }
    let speed = way[0].hypot(way[1]);
    if speed < 1e-9 {
        // Straight down.
        return height(field, from).map(|z| place(field, from, z));
    }
    if begin >= end {
        return None;
    }
    let above = |t: f64| {
        let at = [from[0] + t * way[0], from[1] + t * way[1]];
        height(field, at).map(|z| (eye.z + t * towards.z - z, at, z))
    };
    // Half a cell per step.
    let steps = ((end - begin) * speed * 2.0).ceil().clamp(1.0, MOST_STEPS);
    let step = (end - begin) / steps;
    let t = |n: f64| begin + n * step;
    let first = (0..=steps as u32).find(|n| above(t(f64::from(*n))).is_some_and(|a| a.0 <= 0.0))?;
    let (mut high, mut low) = (t(f64::from(first.saturating_sub(1))), t(f64::from(first)));
    for _ in 0..24 {
        let middle = 0.5 * (high + low);
        match above(middle) {
            Some((gap, ..)) if gap <= 0.0 => low = middle,
            _ => high = middle,
        }
    }
    above(low).map(|(_, at, z)| place(field, at, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hill() -> HeightField {
        let height = |i: usize| {
            let (x, y) = ((i % 40) as f64 - 20.0, (i / 40) as f64 - 15.0);
            100.0 + 6.0 * (-(x * x + y * y) / 60.0).exp()
        };
        let heights: Vec<f64> = (0..40 * 30).map(height).collect();
        HeightField::new(30, 40, &heights, [2.0, 3.0], None).unwrap()
    }

    /// A window of one pixel shows the middle of a field that is wider than 1,000 grid points.
    #[test]
    fn a_window_may_be_as_small_as_a_pixel() {
        let (cols, limits) = (1201, Limits::boundless(true, 1 << 30));
        let field = HeightField::new(2, cols, &vec![0.0; 2 * cols], [1.0; 2], None).unwrap();
        for size in [[1, 1], [2, 2]] {
            let options = (size, false, false);
            let map = Viewpoint::default().map(&field, options, Tone::default());
            assert!(ridgelight::plan::map(&map, &limits).is_ok(), "{map:?}");
        }
    }

    /// A visible place on the ground maps to a pixel and back: from above to rounding, by a camera
    /// to the share of half a march step that bisection leaves, 2^-24 of it.
    #[test]
    fn a_pixel_and_its_ground_are_each_others() {
        let field = hill();
        let size = [300, 200];
        let mut viewpoint = Viewpoint::default();
        for with_camera in [false, true] {
            if with_camera {
                viewpoint.begin_camera(&field, size);
            }
            for at in [[20.0, 15.0], [3.25, 28.5], [38.0, 20.75], [20.0, 20.0]] {
                let want = place(&field, at, height(&field, at).unwrap());
                let (pixel, length) = viewpoint.pixel(&field, size, want, 2.0).unwrap();
                assert!(length > 0.0);
                let got = viewpoint.ground(&field, size, pixel).unwrap();
                let off = (DVec3::from(got) - DVec3::from(want)).length();
                assert!(off < 1e-5, "{with_camera} {at:?}: {got:?}, {want:?}");
            }
            assert!(viewpoint.ground(&field, size, [-500.0, 100.0]).is_none());
        }
    }
}
