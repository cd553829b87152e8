//! A camera view of a lit field, as pure data.

mod passes;
mod reduced;

use glam::{DMat4, DVec3, DVec4};

use super::Plan;
use crate::graph::bytes_text;
use crate::graph::shaders::{PlinthDrawPush, SkyDrawPush, TerrainDrawPush};
use crate::graph::{Format, Limits};
use crate::passes::terrain_draw::TILE;
use crate::passes::{plinth_draw, sky_draw};
use crate::scene::{Camera, Lens, Scene, corners};
use crate::{Error, Result};

pub use passes::{ViewPass, ViewResource};
pub use reduced::mesh_error_m;

/// Options of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// Columns and rows of the picture, each 1 or more.
    pub size: [u32; 2],
    /// MSAA samples per pixel, 1, 2, 4 or 8. Every device has 1 and 4.
    pub samples: u32,
    /// Stride of the mesh, in grid points along both axes, [1..1024]; the last row and column always have vertices. The light
    /// keeps its resolution. Larger: faster; a height error of [`mesh_error_m`].
    pub mesh_step: u32,
    /// Radiance, linear RGB, of pixels without ground or sky: below horizontal, unless the border is `open`. A visible
    /// environment is added to it. It also replaces a sky whose radiance only the device knows
    /// ([`Picture::colours_on_device`](super::Picture::colours_on_device)).
    pub background: [f32; 3],
    /// Height of the base of a plinth, absolute like the heights of the file. None draws no plinth.
    pub plinth_base_m: Option<f64>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            samples: 4,
            mesh_step: 1,
            background: [0.0; 3],
            plinth_base_m: None,
        }
    }
}

/// A camera view of a lit field. [`ViewRenderer`](crate::gpu::ViewRenderer) records it.
///
/// The surface is the mesh of two triangles per cell, split from (r, c) to (r+1, c+1), visible from both sides. A triangle
/// with a void corner is a hole. A periodic field appears once. Exit radiance is bilinear between texels; its specular is
/// that of the lit field, viewed from its own eye ([`Picture::eye_m`](super::Picture)). Behind the ground are the uniform
/// sky and the environment by direction, bilinear between the centres of its texels; suns, key lights and sphere lights are
/// not visible. With an orthographic lens, visible ground reaches above and below the scene's heights by the height of the
/// picture and the heights' own extent along the view. For unknown heights, that range is from 0 to the target's height.
///
/// A plinth has walls from the field's edges down to a level base, and none where the ground is lower. It hides what is
/// behind it, but depths are those of the ground. Its light is not computed: a face has a fixed share of the ground's mean
/// luminance, more towards the brightest sun. A void at an edge leaves a gap in the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// MSAA samples per pixel.
    pub samples: u32,
    /// Columns and rows of the field.
    pub field: [u32; 2],
    /// Format of the lit field.
    pub radiance: Format,
    /// Columns and rows of the environment, if visible.
    pub environment: Option<[u32; 2]>,
    /// Whether the field has voids. You may set it for [unknown](crate::scene::HeightField::unknown) heights.
    pub has_voids: bool,
    /// The effective settings, as (name, value).
    pub settings: Vec<(String, String)>,
    pub(crate) terrain: TerrainDrawPush,
    pub(crate) tiles: u32,
    pub(crate) sky: SkyDrawPush,
    pub(crate) plinth: Option<PlinthDrawPush>,
    depths: Depths,
}

/// Meaning of the depth image: 0 is infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depths {
    /// `near_m` over the distance.
    Inverse { near_m: f64 },
    /// Linear from the farthest point, 0, to the nearest, 1.
    Even { near_m: f64, far_m: f64 },
}

impl View {
    /// The view of a camera on a scene whose light `lit` computes.
    ///
    /// # Errors
    /// A camera or options out of range; a field less than two grid points wide; a picture beyond the limits.
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
            let found = format!("{} × {} grid points", field.cols(), field.rows());
            return Err(Error::setting("a field viewed by a camera", found, "2 × 2 or more"));
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
        let plinth = options.plinth_base_m;
        let plinth = plinth.map(|base_m| plinth_draw::push(scene, camera, base_m, &terrain));
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
            sky: sky_draw::push(
                scene,
                camera,
                options.aspect(),
                options.background,
                lit.find("light_colours").is_some(),
            ),
            plinth,
            depths,
        };
        let bytes = view.bytes();
        if bytes > limits.memory_budget {
            return Err(Error::Limit {
                what: format!("a picture of {} × {}", view.size[0], view.size[1]),
                needs: bytes_text(bytes),
                limit: format!("{} of `memory_budget`", bytes_text(limits.memory_budget)),
            });
        }
        Ok(view)
    }

    /// Bytes of a picture's images, its own and the caller's.
    pub fn bytes(&self) -> u64 {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let of_samples = if self.samples > 1 { u64::from(self.samples) * 20 } else { 0 };
        pixels * (20 + of_samples)
    }

    /// Distance from the plane of the eye along the view direction for a value of the depth image; infinite without ground.
    pub fn distance_m(&self, depth: f32) -> f64 {
        let depth = f64::from(depth);
        match self.depths {
            _ if depth <= 0.0 => f64::INFINITY,
            Depths::Inverse { near_m } => near_m / depth,
            Depths::Even { near_m, far_m } => far_m - depth * (far_m - near_m),
        }
    }

    /// Whether a renderer of `other` can record this view: they may differ only in camera and light.
    pub fn is_shaped_like(&self, other: &Self) -> bool {
        let shape = |v: &Self| {
            let parts = [v.environment.is_some(), v.has_voids, v.plinth.is_some()];
            (v.size, v.samples, v.field, v.radiance, parts)
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
    /// The first value out of range on any device, by name.
    pub fn check(&self) -> Result<()> {
        let Self { size, samples, mesh_step, background, plinth_base_m } = self;
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
        if let Some(base) = plinth_base_m.filter(|base| !base.is_finite()) {
            return Err(Error::setting("plinth base", base.to_string(), "a finite height"));
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

/// The mesh and the meaning of its depths.
fn terrain(scene: &Scene, camera: &Camera, options: &ViewOptions) -> (TerrainDrawPush, Depths) {
    let field = &scene.field;
    let [cell_x, cell_y] = field.cell_m();
    let last_row = (field.rows() - 1) as f64;
    let [right, up, back] = camera.axes();
    let eye = camera.eye_m();
    let (projection, depths) = projection(scene, camera, options);
    // Origin of f32 coordinates: the eye of a perspective lens, else the target.
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
    let projected = |v: DVec3, w: f64| {
        let clip: DVec4 = projection * DVec4::new(v.dot(right), v.dot(up), v.dot(back), w);
        clip.as_vec4().to_array()
    };
    let push = TerrainDrawPush {
        clip_per_col: projected(DVec3::X * cell_x, 0.0),
        clip_per_row: projected(DVec3::Y * -cell_y, 0.0),
        clip_per_metre: projected(DVec3::Z, 0.0),
        clip_at_origin: projected(origin, 1.0),
        origin_col,
        origin_row,
        origin_m,
        cols: field.cols() as i32,
        rows: field.rows() as i32,
        mesh_step: options.mesh_step as i32,
        tiles_across: 0,
    };
    (push, depths)
}

/// Whole numbers up to this are exact in f32.
const WHOLE: i32 = 1 << 23;

/// From the camera's axes to clip coordinates: depth falls from 1 near to 0 far, y points down.
fn projection(scene: &Scene, camera: &Camera, options: &ViewOptions) -> (DMat4, Depths) {
    let aspect = options.aspect();
    let down = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    match camera.lens {
        Lens::Perspective { fov_rad } => {
            // The precision of an f32 depth does not depend on the near plane, so it lies before any ground that fills a pixel.
            let cell = scene.field.cell_m().into_iter().fold(f64::INFINITY, f64::min);
            let near_m = 1e-3 * cell.min(camera.distance_m);
            let matrix = DMat4::perspective_infinite_reverse_rh(fov_rad, aspect, near_m);
            (down * matrix, Depths::Inverse { near_m })
        }
        Lens::Orthographic { height_m } => {
            let back = camera.axes()[2];
            let eye = camera.eye_m();
            // Where only the device knows the heights, the target is the best estimate of the ground's height.
            let target = scene.field.is_unknown().then(|| DVec3::from(camera.target_m));
            let (near, far) = corners(&scene.field)
                .into_iter()
                .chain(target)
                .map(|c| (eye - c).dot(back))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(n, f), d| (n.min(d), f.max(d)));
            // Gives level ground a depth range, and room for heights that change on the device.
            let margin = far - near + height_m;
            let (near_m, far_m) = (near - margin, far + margin);
            let [x, y] = [height_m * aspect / 2.0, height_m / 2.0];
            // Near and far exchanged: reversed depth.
            let matrix = DMat4::orthographic_rh(-x, x, -y, y, far_m, near_m);
            (down * matrix, Depths::Even { near_m, far_m })
        }
    }
}

fn settings(camera: &Camera, options: &ViewOptions) -> Vec<(String, String)> {
    let [x, y, z] = camera.target_m;
    // In degrees, without the rounding to radians and back.
    let degrees = |rad: f64| (rad.to_degrees() * 1e9).round() / 1e9;
    let (compass, elevation) = (90.0 - degrees(camera.azimuth_rad), degrees(camera.elevation_rad));
    let lens = match camera.lens {
        Lens::Perspective { fov_rad } => format!("perspective {}", degrees(fov_rad)),
        Lens::Orthographic { height_m } => format!("orthographic {height_m}"),
    };
    let plinth = options.plinth_base_m.map(|base_m| ("plinth_base_m", base_m.to_string()));
    [
        ("camera", format!("{compass},{elevation},{}", camera.distance_m)),
        ("look_at", format!("{x},{y},{z}")),
        ("lens", lens),
        ("picture_size", format!("{}x{}", options.size[0], options.size[1])),
        ("samples", options.samples.to_string()),
        ("mesh_step", options.mesh_step.to_string()),
    ]
    .into_iter()
    .chain(plinth)
    .map(|(name, value)| (name.to_owned(), value))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Picture, picture};
    use crate::scene::{HeightField, Lights, Quality, Surface};
    use std::f64::consts::FRAC_PI_2;

    /// With unknown heights, ground near the target is within the depth range, whatever the target's height.
    #[test]
    fn an_orthographic_view_of_unknown_heights_reaches_its_target() {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let limits = Limits::lavapipe();
        for z in [0.0, 100.0, -1500.0] {
            let field = HeightField::unknown(5, 5, [2.0; 2]).unwrap();
            let scene = Scene { field, surface: Surface::default(), lights: lights.clone() };
            let lit = picture(&scene, &Quality::default(), &limits, Picture::default()).unwrap();
            let camera = Camera {
                target_m: [4.0, 4.0, z],
                azimuth_rad: 0.0,
                elevation_rad: FRAC_PI_2,
                distance_m: 7.0,
                lens: Lens::Orthographic { height_m: 8.0 },
            };
            let view = View::new(&scene, &lit, &camera, &ViewOptions::default(), &limits).unwrap();
            // The target is 7 m ahead; ground up to the picture's height above and below it is drawn.
            let [near, far] = [view.distance_m(1.0), view.distance_m(1e-30)];
            assert!(near <= 7.0 - 8.0 && far >= 7.0 + 8.0, "{z}: {near} to {far}");
        }
    }

    /// A sky with its colour on the device is not drawn in the scene's colour.
    #[test]
    fn a_sky_with_its_colour_on_the_device_is_drawn_as_background() {
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

    /// Level ground of 3 by 3 grid points at height 7, the eye 4 above its centre. The north-western point is 1 west and 1
    /// north of it. Under 90° the picture spans 8 there from bottom to top and, twice as wide as high, 16 across: the point is
    /// 1/8 to the left and 1/4 up. An orthographic picture 5 high and 10 wide gives 1/5 and 2/5.
    #[test]
    fn a_grid_point_projects_to_its_derived_position() {
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
