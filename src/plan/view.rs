//! A lit field as a camera sees it: what its passes are told, as pure data.

mod passes;
mod reduced;

use std::f64::consts::TAU;

use glam::{DMat4, DVec3, DVec4};

use super::Plan;
use crate::graph::bytes_text;
use crate::graph::{Format, Limits};
use crate::passes::sky_draw::SkyDrawPush;
use crate::passes::terrain_draw::{TILE, TerrainDrawPush};
use crate::scene::{Border, Camera, Lens, Scene, corners};
use crate::{Error, Result};

pub use passes::{ViewPass, ViewResource};
pub use reduced::surface_error_m;

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// Columns and rows of the picture, each 1 or more.
    pub size: [u32; 2],
    /// Samples a pixel, 1, 2, 4 or 8: edges are means of so many. Every device has 1 and 4.
    pub samples: u32,
    /// The mesh has a vertex at every `mesh_step`th sample of every such row, [1..1024], and along the last row and
    /// column. The light is not reduced. Larger: faster, and off by [`surface_error_m`].
    pub mesh_step: u32,
    /// Radiance, linear RGB, where neither ground nor sky is seen: below horizontal, unless the border is `open`.
    /// An environment is seen there, too, and added. Also in place of a sky whose radiance the device alone knows
    /// ([`Picture::colours_on_device`](super::Picture::colours_on_device)).
    pub background: [f32; 3],
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { size: [1280, 720], samples: 4, mesh_step: 1, background: [0.0; 3] }
    }
}

/// What is to be seen of a lit field, and from where: [`ViewRenderer`](crate::gpu::ViewRenderer) records it.
///
/// The surface is the mesh of two triangles a cell, split from (r, c) to (r+1, c+1), seen from both sides; a triangle
/// with a void corner is a hole. A field that repeats is drawn once. Between samples the exit radiance is bilinear:
/// a lobe is that of the view from straight above, as in the lit field. Behind it are the uniform sky and the
/// environment by direction, radiance bilinear between the middles of its texels; suns, key lights and balls of light
/// themselves are not drawn. Before an orthographic lens ground is seen as far above and below the scene's own heights as
/// the picture spans, and as these reach along the view.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// Columns and rows of the field.
    pub field: [u32; 2],
    /// Format of the lit field.
    pub radiance: Format,
    /// Columns and rows of the environment, where one is seen.
    pub environment: Option<[u32; 2]>,
    /// Whether the field has voids: may be set where its heights are [unknown](crate::scene::HeightField::unknown).
    pub has_voids: bool,
    /// The settings really used, as (name, value).
    pub settings: Vec<(String, String)>,
    pub(crate) terrain: TerrainDrawPush,
    pub(crate) tiles: u32,
    pub(crate) sky: SkyDrawPush,
    depths: Depths,
}

/// What depths in the depth image stand for: 0 infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depths {
    /// This length over the distance.
    Inverse { near_m: f64 },
    /// From the farthest, 0, to the nearest, 1.
    Even { near_m: f64, far_m: f64 },
}

impl View {
    /// What a camera sees of a scene whose light `lit` draws.
    ///
    /// # Errors
    /// A camera or options out of range; a field less than two samples wide; a picture beyond the limits.
    pub fn new(
        scene: &Scene,
        lit: &Plan,
        camera: &Camera,
        options: &ViewOptions,
        limits: &Limits,
    ) -> Result<Self> {
        camera.check()?;
        options.check()?;
        options.check_within(limits)?;
        let Scene { field, lights, .. } = scene;
        if field.rows() < 2 || field.cols() < 2 {
            let found = format!("{} × {} samples", field.cols(), field.rows());
            return Err(Error::setting("a field before a camera", found, "2 × 2 or more"));
        }
        let radiance = lit.find("radiance").and_then(|id| lit.resources.get(id.0)?.format());
        let radiance = radiance.ok_or_else(|| {
            Error::setting("the plan before a camera", "no radiance", "that of a picture")
        })?;
        let (terrain, depths) = terrain(scene, camera, options);
        let cells =
            [field.cols(), field.rows()].map(|n| (n as u32 - 1).div_ceil(options.mesh_step));
        let [across, down] = cells.map(|n| n.div_ceil(TILE));
        let environment = lights.environment.as_ref();
        let view = Self {
            size: options.size,
            samples: options.samples,
            field: [field.cols() as u32, field.rows() as u32],
            radiance,
            environment: environment.map(|e| [e.width() as u32, e.height() as u32]),
            has_voids: field.voids().is_some(),
            settings: settings(camera, options),
            terrain: TerrainDrawPush { tiles_across: across as i32, ..terrain },
            tiles: across * down,
            sky: sky(scene, camera, options, lit.find("light_colours").is_some()),
            depths,
        };
        let bytes = view.bytes();
        if bytes > limits.memory_budget {
            return Err(Error::Limit {
                what: format!("a picture of {} × {}", view.size[0], view.size[1]),
                needs: bytes_text(bytes),
                limit: format!("{} of --memory-budget", bytes_text(limits.memory_budget)),
            });
        }
        Ok(view)
    }

    /// Bytes of the images that a picture takes, its own and the caller's.
    pub fn bytes(&self) -> u64 {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let of_samples = if self.samples > 1 { u64::from(self.samples) * 20 } else { 0 };
        pixels * (20 + of_samples)
    }

    /// Distance along the direction of view, from the plane of the eye, of a value of the depth image; infinite where
    /// no ground is seen.
    pub fn distance_m(&self, depth: f32) -> f64 {
        let depth = f64::from(depth);
        match self.depths {
            _ if depth <= 0.0 => f64::INFINITY,
            Depths::Inverse { near_m } => near_m / depth,
            Depths::Even { near_m, far_m } => far_m - depth * (far_m - near_m),
        }
    }

    /// Whether a renderer of another view can record this one: of what both know, only cameras and light differ.
    pub fn is_shaped_like(&self, other: &Self) -> bool {
        let shape = |v: &Self| {
            (v.size, v.samples, v.field, v.radiance, v.environment.is_some(), v.has_voids)
        };
        shape(self) == shape(other)
    }
}

impl ViewOptions {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// # Errors
    /// What is out of range whatever the device, by name.
    pub fn check(&self) -> Result<()> {
        let Self { size, samples, mesh_step, background } = self;
        if size.contains(&0) {
            let found = format!("{} × {}", size[0], size[1]);
            return Err(Error::setting("picture size", found, "1 × 1 or more"));
        }
        if ![1, 2, 4, 8].contains(samples) {
            return Err(Error::setting("samples a pixel", samples.to_string(), "1, 2, 4 or 8"));
        }
        if !(1..=1024).contains(mesh_step) {
            return Err(Error::setting("mesh step", mesh_step.to_string(), "1 to 1024"));
        }
        if !background.iter().all(|v| v.is_finite() && *v >= 0.0) {
            let found = format!("{background:?}");
            return Err(Error::setting("background", found, "finite numbers, 0 or more"));
        }
        Ok(())
    }

    fn check_within(&self, limits: &Limits) -> Result<()> {
        let [width, height] = self.size;
        let longest = width.max(height);
        if longest <= limits.image_side {
            return Ok(());
        }
        Err(Error::Limit {
            what: format!("a picture of {width} × {height}"),
            needs: format!("images {longest} pixels long"),
            limit: format!("{} on this device", limits.image_side),
        })
    }
}

/// The mesh and what its depths stand for.
fn terrain(scene: &Scene, camera: &Camera, options: &ViewOptions) -> (TerrainDrawPush, Depths) {
    let field = &scene.field;
    let [cell_x, cell_y] = field.cell_m();
    let last_row = (field.rows() - 1) as f64;
    let [right, up, back] = camera.axes();
    let eye = camera.eye_m();
    let (projection, depths) = projection(scene, camera, options);
    // Numbers of f32 are counted from here: where all rays begin, or about which they stand.
    let near_m = match camera.lens {
        Lens::Perspective { .. } => eye,
        Lens::Orthographic { .. } => DVec3::from(camera.target_m),
    };
    let whole = |v: f64| v.round().clamp(f64::from(-WHOLE), f64::from(WHOLE)) as i32;
    let (origin_col, origin_row) = (whole(near_m.x / cell_x), whole(last_row - near_m.y / cell_y));
    let origin_m = (near_m.z - field.base_m()) as f32;
    let origin = DVec3::new(
        f64::from(origin_col) * cell_x,
        (last_row - f64::from(origin_row)) * cell_y,
        field.base_m() + f64::from(origin_m),
    ) - eye;
    let seen = |v: DVec3, w: f64| {
        let clip: DVec4 = projection * DVec4::new(v.dot(right), v.dot(up), v.dot(back), w);
        clip.as_vec4().to_array()
    };
    let push = TerrainDrawPush {
        clip_per_col: seen(DVec3::X * cell_x, 0.0),
        clip_per_row: seen(DVec3::Y * -cell_y, 0.0),
        clip_per_metre: seen(DVec3::Z, 0.0),
        clip_at_origin: seen(origin, 1.0),
        origin_col,
        origin_row,
        origin_m,
        cols: field.cols() as i32,
        rows: field.rows() as i32,
        step_samples: options.mesh_step as i32,
        tiles_across: 0,
    };
    (push, depths)
}

/// Whole numbers up to it are f32's, too.
const WHOLE: i32 = 1 << 23;

/// From the camera's axes to clip coordinates: depth falls from 1 near to 0 far away, y points down.
fn projection(scene: &Scene, camera: &Camera, options: &ViewOptions) -> (DMat4, Depths) {
    let aspect = options.aspect();
    let down = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    match camera.lens {
        Lens::Perspective { fov_rad } => {
            // The f32 of a depth is as exact wherever the near plane is: nearer than any ground that fills a pixel.
            let cell = scene.field.cell_m().into_iter().fold(f64::INFINITY, f64::min);
            let near_m = 1e-3 * cell.min(camera.distance_m);
            let matrix = DMat4::perspective_infinite_reverse_rh(fov_rad, aspect, near_m);
            (down * matrix, Depths::Inverse { near_m })
        }
        Lens::Orthographic { height_m } => {
            let back = camera.axes()[2];
            let eye = camera.eye_m();
            let (near, far) = corners(&scene.field)
                .iter()
                .map(|c| (eye - *c).dot(back))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(n, f), d| (n.min(d), f.max(d)));
            // Level ground seen from above has depth; and heights that an engine changes have some room.
            let margin = far - near + height_m;
            let (near_m, far_m) = (near - margin, far + margin);
            let [x, y] = [height_m * aspect / 2.0, height_m / 2.0];
            // Near and far exchanged.
            let matrix = DMat4::orthographic_rh(-x, x, -y, y, far_m, near_m);
            (down * matrix, Depths::Even { near_m, far_m })
        }
    }
}

/// `is_on_device`: the device alone knows the sky's radiance.
fn sky(scene: &Scene, camera: &Camera, options: &ViewOptions, is_on_device: bool) -> SkyDrawPush {
    let [right, up, back] = camera.axes();
    let half_m = match camera.lens {
        Lens::Perspective { fov_rad } => (fov_rad / 2.0).tan(),
        Lens::Orthographic { .. } => 0.0,
    };
    let four = |v: DVec3| v.extend(0.0).as_vec4().to_array();
    let colour = |c: [f32; 3]| [c[0], c[1], c[2], 0.0];
    let above = match (scene.lights.sky, &scene.lights.environment) {
        (Some(sky), _) if !is_on_device => sky,
        (None, Some(_)) => [0.0; 3],
        _ => options.background,
    };
    let is_open = scene.surface.border == Border::Open;
    let below = if is_open { above } else { options.background };
    let turns = scene.lights.environment.as_ref().map_or(0.0, |e| e.rotation_rad() / TAU);
    SkyDrawPush {
        forward: four(-back),
        right: four(right * half_m * options.aspect()),
        down: four(-up * half_m),
        above: colour(above),
        below: colour(below),
        rotation_turns: (turns - turns.floor()) as f32,
    }
}

fn settings(camera: &Camera, options: &ViewOptions) -> Vec<(String, String)> {
    let [x, y, z] = camera.target_m;
    // As the flags take them, less the rounding of turning degrees to radians and back.
    let degrees = |rad: f64| (rad.to_degrees() * 1e9).round() / 1e9;
    let (compass, elevation) = (90.0 - degrees(camera.azimuth_rad), degrees(camera.elevation_rad));
    let lens = match camera.lens {
        Lens::Perspective { fov_rad } => format!("perspective {}", degrees(fov_rad)),
        Lens::Orthographic { height_m } => format!("orthographic {height_m}"),
    };
    [
        ("camera", format!("{compass},{elevation},{}", camera.distance_m)),
        ("look_at", format!("{x},{y},{z}")),
        ("lens", lens),
        ("picture_size", format!("{}x{}", options.size[0], options.size[1])),
        ("samples", options.samples.to_string()),
        ("mesh_step", options.mesh_step.to_string()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Picture, picture};
    use crate::scene::{HeightField, Lights, Quality, Surface};
    use std::f64::consts::FRAC_PI_2;

    /// A sky that the device alone knows the colour of is not drawn in the scene's.
    #[test]
    fn a_sky_of_the_device_is_background() {
        let field = HeightField::new(3, 3, &[7.0; 9], [1.0; 2], None).unwrap();
        let lights = Lights { sky: Some([9.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let limits = Limits::lavapipe();
        let options = ViewOptions { background: [0.25; 3], ..ViewOptions::default() };
        let camera = Camera {
            target_m: [1.0, 1.0, 7.0],
            azimuth_rad: 0.0,
            elevation_rad: 0.5,
            distance_m: 4.0,
            lens: Lens::Perspective { fov_rad: FRAC_PI_2 },
        };
        for (colours_on_device, want) in [(false, 9.0), (true, 0.25)] {
            let wanted = Picture { colours_on_device, ..Picture::default() };
            let lit = picture(&scene, &Quality::default(), &limits, wanted).unwrap();
            let view = View::new(&scene, &lit, &camera, &options, &limits).unwrap();
            assert_eq!(view.sky.above[..3], [want; 3]);
        }
    }

    /// Level ground of 3 by 3 samples at height 7, the eye 4 above its middle. The north-western sample is 1 west and 1
    /// north of it. Under 90° the picture spans 8 there from below to above and, twice as wide as high, 16 across: the
    /// sample is 1/8 to the left and 1/4 up. A parallel picture 5 high and 10 wide: 1/5 and 2/5.
    #[test]
    fn samples_are_where_they_are_derived() {
        let field = HeightField::new(3, 3, &[7.0; 9], [1.0; 2], None).unwrap();
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let limits = Limits::lavapipe();
        let lit = picture(&scene, &Quality::default(), &limits, Picture::default()).unwrap();
        let options = ViewOptions { size: [200, 100], ..ViewOptions::default() };
        for (lens, want) in [
            (Lens::Perspective { fov_rad: FRAC_PI_2 }, [-0.125, -0.25]),
            (Lens::Orthographic { height_m: 5.0 }, [-0.2, -0.4]),
        ] {
            let camera = Camera {
                target_m: [1.0, 1.0, 7.0],
                azimuth_rad: -FRAC_PI_2,
                elevation_rad: FRAC_PI_2,
                distance_m: 4.0,
                lens,
            };
            let view = View::new(&scene, &lit, &camera, &options, &limits).unwrap();
            let t = view.terrain;
            let away = [-t.origin_col as f32, -t.origin_row as f32, 0.0 - t.origin_m];
            let clip: [f32; 4] = std::array::from_fn(|k| {
                t.clip_at_origin[k]
                    + away[0] * t.clip_per_col[k]
                    + away[1] * t.clip_per_row[k]
                    + away[2] * t.clip_per_metre[k]
            });
            // A few roundings of numbers up to 4.
            let is = |got: f32, want: f64| assert!((f64::from(got) - want).abs() < 4e-6, "{got}");
            is(clip[0] / clip[3], want[0]);
            is(clip[1] / clip[3], want[1]);
            let distance = view.distance_m(clip[2] / clip[3]);
            assert!((distance - 4.0).abs() < 4e-6, "{distance}");
            assert_eq!(view.distance_m(0.0), f64::INFINITY);
        }
    }
}
