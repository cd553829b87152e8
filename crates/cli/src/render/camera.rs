//! `render --camera`: a camera view of the field instead of its map.

use ridgelight::gpu::{DeviceReport, Timing, ViewPixels};
use ridgelight::plan::{Limits, Plan, View, ViewOptions, mesh_error_m};
use ridgelight::scene::Tone;
use ridgelight::scene::{Camera, HeightField, Lens, Scene};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Channels, Layer as FileLayer};

use crate::args::{CameraArgs, CameraAt, EyeArgs, Layer, RenderArgs};

/// A camera and the options of its view.
pub struct CameraView {
    pub camera: Camera,
    pub options: ViewOptions,
}

impl CameraView {
    /// Where specular is viewed from.
    pub fn eye_m(&self, field: &HeightField) -> [f64; 3] {
        eye_of(&self.camera, field)
    }
}

/// Where a camera views specular from. The rays of an orthographic lens meet far away.
fn eye_of(camera: &Camera, field: &HeightField) -> [f64; 3] {
    match camera.lens {
        Lens::Perspective { .. } => camera.eye_m().to_array(),
        Lens::Orthographic { .. } => {
            let [x, y] = field.cell_m();
            let largest = (x * field.cols() as f64).max(y * field.rows() as f64);
            let back = camera.axes()[2] * (1e4 * largest);
            [0, 1, 2].map(|i| camera.target_m[i] + back[i])
        }
    }
}

/// Default depth of a plinth, a share of the field's longer side.
pub const PLINTH: f32 = 0.04;

/// Refuses layers that the picture does not have.
pub fn check_layers(args: &RenderArgs) -> Result<()> {
    let is_depth = |layer: &Layer| *layer == Layer::Depth;
    match &args.camera.eye.camera {
        None if args.layers.iter().any(is_depth) => {
            Err(Error::setting("--layers", "depth without --camera", "a camera"))
        }
        Some(_) if !args.layers.iter().all(is_depth) => Err(Error::setting(
            "--layers",
            "layers of the map with --camera",
            "depth only, or no --camera",
        )),
        _ => Ok(()),
    }
}

/// The requested camera, checked as far as possible without a device. `for_screen`: a picture of codes, with a plinth.
pub fn requested(args: &CameraArgs, scene: &Scene, for_screen: bool) -> Result<Option<CameraView>> {
    let Some(at) = args.eye.camera else { return Ok(None) };
    check_cells(&scene.field)?;
    let on_plinth = on_plinth(&args.eye, at, &scene.field)?;
    let is_drawn = for_screen || args.eye.plinth.is_some();
    let options = ViewOptions {
        size: args.eye.size,
        samples: args.samples,
        mesh_step: args.mesh_step,
        background: args.background,
        plinth_base_m: on_plinth.as_ref().filter(|_| is_drawn).map(|(base_m, _)| *base_m),
    };
    options.check()?;
    let framed = on_plinth.as_ref().map(|(_, framed)| framed);
    let camera = placed(&args.eye, at, (&scene.field, framed), options.aspect())?;
    if at.elevation >= 0.0 {
        warn_below(&camera, &scene.field);
    }
    Ok(Some(CameraView { camera, options }))
}

/// Refuses a field of which a camera shows nothing: each triangle of its cells has a void corner.
fn check_cells(field: &HeightField) -> Result<()> {
    let (rows, cols) = (field.rows(), field.cols());
    let is_known = |i: usize| !field.voids().is_some_and(|voids| voids[i]);
    let is_shown = |i: &usize| {
        let (row, col) = (i / cols, i % cols);
        let has_cell = row + 1 < rows && col + 1 < cols;
        has_cell
            && is_known(*i)
            && is_known(i + cols + 1)
            && (is_known(i + 1) || is_known(i + cols))
    };
    if (0..rows * cols).any(|i| is_shown(&i)) {
        return Ok(());
    }
    let (voids, expected) = match field.voids() {
        None => ("", "2 × 2 or more"),
        Some(_) => (" with voids", "a triangle of a cell without voids at its corners"),
    };
    let found = format!("{cols} × {rows} grid points{voids}");
    Err(Error::setting("a field viewed by a camera", found, expected))
}

/// Whether a place, metres east and north of the south-west corner, lies on the field or at most its own size beside it.
pub fn is_near(field: &HeightField, place_m: [f64; 2]) -> bool {
    let [width, height] =
        [field.cell_m()[0] * field.cols() as f64, field.cell_m()[1] * field.rows() as f64];
    // Not numbers are refused elsewhere.
    let is_beyond = |x: f64, side: f64| x < -side || x > 2.0 * side;
    !is_beyond(place_m[0], width) && !is_beyond(place_m[1], height)
}

/// Where the requested camera views specular from, without its picture.
pub fn eye_m(args: &EyeArgs, field: &HeightField) -> Result<Option<[f64; 3]>> {
    let Some(at) = args.camera else { return Ok(None) };
    let on_plinth = on_plinth(args, at, field)?;
    let options = ViewOptions { size: args.size, ..ViewOptions::default() };
    options.check()?;
    let framed = on_plinth.as_ref().map(|(_, framed)| framed);
    let camera = placed(args, at, (field, framed), options.aspect())?;
    Ok(Some(eye_of(&camera, field)))
}

/// The plinth of a camera at `at`: see [`plinth`].
fn on_plinth(
    args: &EyeArgs,
    at: CameraAt,
    field: &HeightField,
) -> Result<Option<(f64, HeightField)>> {
    // From below it would hide the ground.
    let share = args.plinth.unwrap_or(if at.elevation < 0.0 { 0.0 } else { PLINTH });
    if !(0.0..=1.0).contains(&share) {
        return Err(Error::setting("plinth", share.to_string(), "0 to 1"));
    }
    Ok(plinth(field, share))
}

/// The camera at `at` before a field. Without a distance the field fits into the picture, with its plinth if it is `framed`.
fn placed(
    args: &EyeArgs,
    at: CameraAt,
    (field, framed): (&HeightField, Option<&HeightField>),
    aspect: f64,
) -> Result<Camera> {
    let azimuth_rad = (90.0 - at.azimuth).to_radians();
    let lens = if args.ortho {
        Lens::Orthographic { height_m: at.distance_m.unwrap_or(1.0) }
    } else {
        Lens::Perspective { fov_rad: args.fov.to_radians() }
    };
    if let Some(p) = args.look_at.filter(|p| !is_near(field, [p.east_m, p.north_m])) {
        crate::setup::warning(&format!(
            "--look-at {},{} is far outside the field: give metres east and north from its south-west corner",
            p.east_m, p.north_m
        ));
    }
    let target = args.look_at.map(|p| {
        let height = p.height_m.unwrap_or_else(|| nearest_m(field, [p.east_m, p.north_m]));
        [p.east_m, p.north_m, height]
    });
    let angles = [azimuth_rad, at.elevation.to_radians()];
    let framed = framed.filter(|_| at.distance_m.is_none()).unwrap_or(field);
    let mut camera = Camera::around(framed, target, angles, lens, aspect);
    if let Some(distance_m) = at.distance_m {
        match &mut camera.lens {
            Lens::Perspective { .. } => camera.distance_m = distance_m,
            Lens::Orthographic { height_m } => *height_m = distance_m,
        }
    }
    camera.check()?;
    Ok(camera)
}

/// Warns if the eye is below the ground: the picture would show the surface from below. The surface of a cell is no lower than the
/// lowest of its corners.
fn warn_below(camera: &Camera, field: &HeightField) {
    let [east_m, north_m, up_m] = camera.eye_m().to_array();
    let [cell_x, cell_y] = field.cell_m();
    let [col, row] =
        [east_m / cell_x, (field.rows() - 1) as f64 - north_m / cell_y].map(f64::floor);
    let is_in = |place: f64, count: usize| (0.0..(count - 1) as f64).contains(&place);
    let is_perspective = matches!(camera.lens, Lens::Perspective { .. });
    if !is_perspective || !is_in(col, field.cols()) || !is_in(row, field.rows()) {
        return;
    }
    let first = row as usize * field.cols() + col as usize;
    let corners = [first, first + 1, first + field.cols(), first + field.cols() + 1];
    if corners.iter().any(|i| field.voids().is_some_and(|voids| voids[*i])) {
        return;
    }
    let lowest = corners.iter().fold(f32::INFINITY, |low, i| low.min(field.heights_m()[*i]));
    let below_m = field.base_m() + f64::from(lowest) - up_m;
    if below_m > 0.0 {
        crate::setup::warning(&format!(
            "--camera: the eye is {below_m:.2} m below the ground: give --camera a higher elevation or a larger distance, or \
             --look-at a higher point"
        ));
    }
}

/// Height of a plinth's base, `share` of the field's longer side below the lowest height, and a field whose box is that of
/// the field on its plinth. None for a share of 0, and where the box is out of range.
pub fn plinth(field: &HeightField, share: f32) -> Option<(f64, HeightField)> {
    let [cell_x, cell_y] = field.cell_m();
    let sides = [(field.cols() - 1) as f64 * cell_x, (field.rows() - 1) as f64 * cell_y];
    let heights = field.heights_m().iter().map(|h| field.base_m() + f64::from(*h));
    let (low, high) =
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
    let base_m = low - f64::from(share) * sides[0].max(sides[1]);
    let framed = HeightField::new(2, 2, &[base_m, high, high, high], sides, None);
    framed.ok().filter(|_| share > 0.0).map(|framed| (base_m, framed))
}

/// Height of the grid point nearest to a place.
fn nearest_m(field: &HeightField, [east_m, north_m]: [f64; 2]) -> f64 {
    let [cell_x, cell_y] = field.cell_m();
    let nearest = |v: f64, count: usize| (v.round().max(0.0) as usize).min(count - 1);
    let col = nearest(east_m / cell_x, field.cols());
    let row = field.rows() - 1 - nearest(north_m / cell_y, field.rows());
    field.base_m() + f64::from(field.heights_m()[row * field.cols() + col])
}

impl CameraView {
    /// The view to record.
    pub fn view(&self, scene: &Scene, lit: &Plan, limits: &Limits) -> Result<View> {
        View::new(scene, lit, &self.camera, &self.options, limits)
    }

    /// The settings used, for the file's metadata.
    pub fn settings(&self, view: &View, field: &HeightField) -> Vec<(String, String)> {
        let mut all = view.settings.clone();
        if self.options.mesh_step > 1 {
            let error = mesh_error_m(field, self.options.mesh_step);
            all.push(("mesh_error_m".to_owned(), error.to_string()));
        }
        all
    }

    /// The report for the terminal.
    pub fn say(
        &self,
        args: &RenderArgs,
        field: &HeightField,
        times: &[Timing],
        report: &DeviceReport,
    ) {
        let ms = crate::setup::total_ns(times) / 1e6;
        let [width, height] = self.options.size;
        let name = args.output.display();
        crate::say!(
            "Wrote {name} ({width}x{height}) in {ms:.1} ms of GPU time on {}{}.",
            report.name,
            super::of_first_frame(report)
        );
        let step = self.options.mesh_step;
        if step > 1 {
            let error = mesh_error_m(field, step);
            crate::say!(
                "The mesh uses every {step}th grid point: heights differ by at most {error:.3} m."
            );
        }
    }
}

/// Writes the picture.
pub fn write(
    args: &RenderArgs,
    camera_view: &CameraView,
    pixels: &ViewPixels,
    exposure: Option<f32>,
    metadata: &[(String, String)],
) -> Result<()> {
    let [cols, rows] = camera_view.options.size.map(|n| n as usize);
    if let Some(exposure) = exposure {
        let tone = Tone::picture(exposure);
        return files::write_png(&args.output, rows, cols, &pixels.radiance, None, tone, metadata);
    }
    let main = |channels| FileLayer { name: String::new(), channels };
    let mut layers = vec![main(Channels::Rgb(&pixels.radiance))];
    if !args.layers.is_empty() {
        layers.push(main(Channels::Scalar("Z", &pixels.distances_m)));
    }
    files::write_exr(&args.output, rows, cols, &layers, metadata)
}
