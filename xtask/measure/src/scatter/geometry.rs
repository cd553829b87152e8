//! A repeating field as geometry: repetitions of it, path-traced, before a distant orthographic camera.

use glam::DVec3;
use ridgelight::gpu::{Frame, Headless, ViewPixels};
use ridgelight::plan::{self, View, ViewOptions};
use ridgelight::scene::{Albedo, Border, Camera, HeightField, Lens, Lights, Normals, Scene, Sun};
use ridgelight::{Error, Result};

/// Pixels along the picture's edges.
const SIDE: u32 = 400;

/// A point of irradiance 1 facing it.
fn sun(e: DVec3) -> Sun {
    Sun {
        azimuth_rad: e.y.atan2(e.x),
        elevation_rad: e.z.asin(),
        diameter_rad: 0.0,
        irradiance: [1.0; 3],
    }
}

/// Repetitions of a field, lit.
pub struct Geometry {
    scene: Scene,
    frame: Frame,
    /// Lengths of one repetition, and how many there are.
    period_m: [f64; 2],
    repeats: [usize; 2],
    middle_m: f64,
}

impl Geometry {
    /// As many repetitions as a view needs around one in the middle, by 64 paths per grid point, under a
    /// sun in direction `light`. Cells are cut into `times`² more: a grid point beside an edge is lit by
    /// the mean of its two slopes.
    pub fn of(
        gpu: &mut Headless,
        (scene, times): (&Scene, usize),
        [light, view]: [DVec3; 2],
        bounces: u32,
    ) -> Result<Self> {
        let scene = scene.finer(times)?;
        let field = &scene.field;
        let [cols, rows] = [field.cols(), field.rows()];
        let period_m = [cols as f64 * field.cell_m()[0], rows as f64 * field.cell_m()[1]];
        let heights = || field.heights_m().iter().map(|h| f64::from(*h));
        let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
        // From the lowest or the highest place a view shifts by so much against the middle's plane.
        let beside = [view.x, view.y].map(|along| 0.5 * (high - low) * along.abs() / view.z);
        // And a cell, by which the last repetition's mesh is shorter.
        let margin = [0, 1].map(|i| 2.0 * (beside[i] + field.cell_m()[i]) / period_m[i]);
        let repeats = margin.map(|m| 1 + m.ceil() as usize);
        let wide = cols * repeats[0];
        let of = |i: usize| i / wide % rows * cols + i % wide % cols;
        let count = wide * rows * repeats[1];
        let all: Vec<f64> =
            (0..count).map(|i| field.base_m() + f64::from(field.heights_m()[of(i)])).collect();
        let mut surface = scene.surface.clone();
        if let Albedo::Map(map) = &mut surface.albedo {
            *map = (0..count).map(|i| map[of(i)]).collect();
        }
        surface.border = Border::Periodic;
        let middle_m = field.base_m() + 0.5 * (low + high);
        let field = HeightField::new(rows * repeats[1], wide, &all, field.cell_m(), None)?;
        let lights = Lights { suns: vec![sun(light)], ..Lights::default() };
        let scene = Scene { field, surface, lights };
        let plan = plan::reference(&scene, bounces, Normals::Flat, None, 1, &gpu.report().limits)?;
        let mut frame = gpu.frame(plan, &plan::reference_inputs(&scene))?;
        gpu.draw(&mut frame)?;
        Ok(Self { scene, frame, period_m, repeats, middle_m })
    }

    pub fn end(self, gpu: &mut Headless) {
        gpu.end(self.frame);
    }

    /// The picture from `v`, one repetition of the plane just in it, and for each pixel where in that
    /// repetition it lies, if in it.
    pub fn view(
        &self,
        gpu: &mut Headless,
        v: DVec3,
    ) -> Result<(ViewPixels, Vec<Option<[f64; 2]>>)> {
        // Any place is the middle of a repetition.
        let target = [0, 1].map(|i| 0.5 * self.repeats[i] as f64 * self.period_m[i]);
        let mut camera = Camera {
            target_m: [target[0], target[1], self.middle_m],
            azimuth_rad: v.y.atan2(v.x),
            elevation_rad: v.z.asin(),
            distance_m: 100.0 * (self.period_m[0] + self.period_m[1]),
            lens: Lens::Orthographic { height_m: 1.0 },
        };
        let [right, up, _] = camera.axes();
        let [x, y] = self.period_m;
        let corners = [[x, y], [x, -y]].map(|c| DVec3::new(0.5 * c[0], 0.5 * c[1], 0.0));
        let reach = corners.iter().flat_map(|c| [c.dot(right).abs(), c.dot(up).abs()]);
        let height_m = 2.0 * reach.fold(0.0, f64::max);
        camera.lens = Lens::Orthographic { height_m };
        let options = ViewOptions { size: [SIDE; 2], ..ViewOptions::default() };
        let limits = gpu.report().limits;
        let view = View::new(&self.scene, self.frame.plan(), &camera, &options, &limits)?;
        let pixels = gpu.look(&self.frame, &view, None)?;
        let pixel = height_m / f64::from(SIDE);
        let (sin, cos) = camera.azimuth_rad.sin_cos();
        let place = |i: u32| {
            let u = (f64::from(i % SIDE) + 0.5 - 0.5 * f64::from(SIDE)) * pixel;
            let w = (0.5 * f64::from(SIDE) - f64::from(i / SIDE) - 0.5) * pixel;
            // u = d · (-sin φ, cos φ), w = -sin ε d · (cos φ, sin φ) of a place d in the middle's plane.
            let along = -w / v.z;
            let d = [cos * along - sin * u, sin * along + cos * u];
            let within = [d[0] / x + 0.5, d[1] / y + 0.5];
            within.iter().all(|p| (0.0..1.0).contains(p)).then_some(within)
        };
        Ok((pixels, (0..SIDE * SIDE).map(place).collect()))
    }

    /// Mean radiance over one repetition of the plane.
    pub fn mean(&self, gpu: &mut Headless, v: DVec3) -> Result<[f64; 3]> {
        let (view, places) = self.view(gpu, v)?;
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        let pixels = view.radiance.iter().zip(&view.distances_m).zip(&places);
        for ((light, distance), _) in pixels.filter(|(_, place)| place.is_some()) {
            if !distance.is_finite() {
                let reason = "no ground where there should be some".into();
                return Err(Error::Device { doing: "drawing repetitions".into(), reason });
            }
            (0..3).for_each(|c| sum[c] += f64::from(light[c]));
            count += 1.0;
        }
        Ok(sum.map(|s| s / count))
    }
}
