//! From arguments to scenes, qualities and devices; what commands print while they run.

mod flags;
pub mod lights;
mod outputs;
pub mod scene_hash;
mod settings_used;
pub mod sky;
pub mod terminal;
pub mod tint;
pub mod tuned;
mod voids;

use ridgelight::gpu::{self, Headless, HeadlessOptions, Pixels, Timing};
use ridgelight::plan::{Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, Border, Bounces, HeightField, Lights, Lines, Quality, Scene, Specular, Sun,
    Surface,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Georeference, HeightOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::args::{
    BorderName, FieldArgs, GlobalArgs, Layer, LightArgs, QualityArgs, SceneArgs, SkyArg,
    SpecularArg, grey_or_colour,
};
pub use flags::{flags_in, in_flags};
use lights::light;
pub use outputs::{
    check_distinct, check_output, check_outputs, extension, folder_of, is_geotiff, write_layers,
};
pub use settings_used::{as_json, asked, metadata, of_field, typed};
use tint::Tint;
pub use voids::{mask_voids, masked};

/// How a command ended without an error.
pub enum Outcome {
    Done,
    /// Beyond a bound.
    Beyond,
    /// Ended early by a signal; the results so far are written.
    Interrupted,
}

/// Every Vulkan device has images of this side.
const LEAST_SIDE: usize = 4096;

/// Refuses a field that the device cannot hold by its header, before its heights are read. Files that are no field and a
/// missing device are reported later.
fn check_size(path: &Path, global: &GlobalArgs) -> Result<()> {
    let Some([rows, cols]) = files::height_size(path) else { return Ok(()) };
    let budget = global.memory_budget.unwrap_or(1 << 50).min(1 << 50);
    let mut limits = Limits::boundless(true, budget);
    if rows.max(cols) > LEAST_SIDE
        && let Ok(devices) = gpu::devices()
        && let Ok(index) = gpu::choose(&devices, global.device.as_deref())
    {
        limits.image_side = devices[index].limits.image_side;
    }
    limits.check_size(rows, cols).map(drop).map_err(|error| match error {
        Error::Limit { what, needs, limit } => {
            Error::Limit { what: format!("{}: {what}", path.display()), needs, limit }
        }
        other => other,
    })
}

pub fn field(paths: &[PathBuf], surface: &FieldArgs, global: &GlobalArgs) -> Result<HeightField> {
    Ok(georeferenced(paths, surface, global)?.0)
}

/// A field that the device can hold, and its position where the file states it.
pub fn georeferenced(
    paths: &[PathBuf],
    surface: &FieldArgs,
    global: &GlobalArgs,
) -> Result<(HeightField, Option<Georeference>)> {
    // A box cuts a field of any size to one that fits.
    if surface.bbox.is_none() {
        paths.iter().try_for_each(|path| check_size(path, global))?;
    }
    let effect = "which casts no shadow into it; for its shadows, use a wider box";
    reported(paths, read(paths, surface)?, surface, effect, global)
}

/// The same, for commands that need no device and no distant ground.
pub fn of_neighbours(
    paths: &[PathBuf],
    surface: &FieldArgs,
    global: &GlobalArgs,
) -> Result<(HeightField, Option<Georeference>)> {
    let effect = "so slopes at its edges are computed from the cells inside; for those of the whole field, use a box that is \
        wider by a cell";
    reported(paths, read_file(paths, surface)?, surface, effect, global)
}

/// Prints a file's warnings and notes. `effect` states what a box changes, and which box avoids it.
fn reported(
    paths: &[PathBuf],
    read: files::FieldFile,
    surface: &FieldArgs,
    effect: &str,
    global: &GlobalArgs,
) -> Result<(HeightField, Option<Georeference>)> {
    let files::FieldFile { field, georeference, notes, warnings, .. } = read;
    let name = match paths {
        [first, _, ..] => format!("{} and {} more", first.display(), paths.len() - 1),
        _ => paths.iter().map(|path| path.display().to_string()).collect(),
    };
    warnings.iter().for_each(|text| warning(&format!("{name}: {}", flags_in(text))));
    if !global.quiet {
        notes.iter().for_each(|text| note(&format!("{name}: {}", flags_in(text))));
        let at = georeference.as_ref().filter(|_| surface.bbox.is_some());
        if let Some([west, south, east, north]) = at.map(|at| at.extent(field.rows(), field.cols()))
        {
            note(&format!(
                "{name}: read without the ground outside --bbox, {effect} and cut the result: \
                `gdal_translate -projwin {west} {north} {east} {south} wide.tif out.tif`"
            ));
        }
    }
    Ok((field, georeference))
}

/// A note on standard error, as programs read standard output. `--quiet` leaves notes out.
pub fn note(text: &str) {
    // A closed standard error is no reason to end.
    let _ = writeln!(std::io::stderr(), "note: {text}");
}

/// A warning on standard error, also with `--quiet`: the result may differ from what the user expects.
pub fn warning(text: &str) {
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// A field, with its notes and warnings, which are not printed yet.
pub fn read(paths: &[PathBuf], surface: &FieldArgs) -> Result<files::FieldFile> {
    let mut read = read_file(paths, surface)?;
    read.notes.extend(read.curvature_note());
    Ok(read)
}

/// The same, without the note for commands that depend on distant ground.
fn read_file(paths: &[PathBuf], surface: &FieldArgs) -> Result<files::FieldFile> {
    if let Some(factor) = surface.z_scale.filter(|factor| !factor.is_finite() || *factor == 0.0) {
        let expected = "a finite number other than 0";
        return Err(Error::setting("--z-scale", factor.to_string(), expected));
    }
    let options = HeightOptions {
        cell_m: surface.cell,
        z_scale: surface.factor(),
        is_unit_known: surface.z_scale.is_some(),
        nodata: surface.nodata,
        band: surface.band,
        bbox: surface.bbox,
    };
    files::read_mosaic(paths, &options).map_err(convertible)
}

/// Extensions of rasters that GDAL reads and we do not.
const OTHER_RASTERS: [&str; 9] = ["vrt", "img", "jp2", "bil", "flt", "dem", "adf", "gpkg", "nc"];

/// Names the command that converts a file of another format.
fn convertible(error: Error) -> Error {
    match error {
        Error::File { path, place, found, expected }
            if place == "name" && OTHER_RASTERS.contains(&extension(&path).as_str()) =>
        {
            let file = terminal::quoted(&path.display().to_string());
            let expected = format!("{expected}; `gdal_translate {file} out.tif` converts it");
            Error::File { path, place, found, expected }
        }
        other => other,
    }
}

/// The light of a scene without lights.
#[derive(Clone, Copy)]
pub enum Unlit {
    /// A uniform sky of radiance 1.
    Sky,
    /// A sun and a clear sky, before a camera at a compass azimuth or on a map.
    Daylight(Option<f64>),
}

impl Unlit {
    /// Daylight, but a sky where lines must be exact: a sun's azimuths are no grid vectors.
    pub fn of(quality: &Quality, camera_deg: Option<f64>) -> Self {
        if quality.lines == Lines::Exact { Self::Sky } else { Self::Daylight(camera_deg) }
    }
}

pub fn scene(field: HeightField, args: &SceneArgs, unlit: Unlit, quiet: bool) -> Result<Scene> {
    let lights = &args.lights;
    check_suns(&lights.others.0.suns, -90.0)?;
    let set = lights.others.0.suns.iter().filter(|sun| sun.elevation_rad < 0.0).count();
    if set > 0 && !quiet {
        let suns = if set == 1 { "sun is" } else { "suns are" };
        note(&format!(
            "night: {set} {suns} below the horizontal; a scene without other lights gets a faint sky"
        ));
    }
    let mut far = lights.others.0.sphere_lights.iter().filter(|sphere| {
        let [east, north, _] = sphere.position_m;
        !crate::render::camera::is_near(&field, [east, north])
    });
    if let Some(sphere) = far.next_back() {
        let [east, north, _] = sphere.position_m;
        warning(&format!(
            "the sphere light at {east},{north} is far outside the field: give metres east and north from its south-west \
             corner"
        ));
    }
    let specular = match &args.specular {
        None => None,
        Some(SpecularArg::Constant(one)) => Some(Specular::Constant(*one)),
        Some(SpecularArg::File(path)) => {
            Some(files::read_specular(path, field.rows(), field.cols())?)
        }
    };
    let tint = args.tint.and_then(|tint| tint::albedo(&field, tint, specular.as_ref()));
    let albedo = match (tint, grey_or_colour(args.albedo())) {
        (Some(tint), _) => tint,
        (None, Some(colour)) => Albedo::Constant(colour),
        (None, None) => files::read_albedo(Path::new(args.albedo()), field.rows(), field.cols())?,
    };
    Ok(Scene {
        surface: Surface { albedo, border: border(&args.field), specular },
        lights: lights_of(lights, unlit)?,
        field,
    })
}

/// Tints a picture whose colours the command line does not give; returns its tint.
pub fn tinted(scene: &mut Scene, args: &SceneArgs) -> Tint {
    let tint = tint_of(args);
    if args.tint.is_none()
        && let Some(albedo) = tint::albedo(&scene.field, tint, scene.surface.specular.as_ref())
    {
        scene.surface.albedo = albedo;
    }
    tint
}

/// The tint of a picture.
pub fn tint_of(args: &SceneArgs) -> Tint {
    let default = if args.albedo.is_none() { Tint::Land } else { Tint::None };
    args.tint.unwrap_or(default)
}

/// Refuses suns whose elevation is not from `lowest_deg` to 90 degrees. The message has the order of the flag's numbers:
/// an elevation that is out of range is often an azimuth.
pub fn check_suns(suns: &[Sun], lowest_deg: f64) -> Result<()> {
    for (i, sun) in suns.iter().enumerate() {
        let found_deg = sun.elevation_rad.to_degrees();
        if !(lowest_deg..=90.0).contains(&found_deg) {
            let expected =
                format!("{lowest_deg}° to 90°, as in --sun AZ,EL: compass azimuth, then elevation");
            let name = format!("--sun {}: elevation", i + 1);
            return Err(Error::setting(name, format!("{found_deg}°"), expected));
        }
    }
    Ok(())
}

/// Radiance of the sky of a scene whose only lights are suns that have set, over their irradiance: no light at all is
/// refused.
const NIGHT: f32 = 1e-6;

fn has_set(sun: &Sun) -> bool {
    (-std::f64::consts::FRAC_PI_2..0.0).contains(&sun.elevation_rad)
}

fn is_dark(lights: &Lights) -> bool {
    let has_sky = lights.sky.is_some() || lights.environment.is_some();
    let has_others = !lights.suns.is_empty() || !lights.keys.is_empty();
    !has_sky && !has_others && lights.near().next().is_none()
}

/// Whether the only light is the faint sky that replaces a set sun.
pub fn is_night(args: &LightArgs, lights: &Lights) -> bool {
    let has_sky = matches!(args.sky, Some(SkyArg::Uniform(_)));
    !has_sky && args.others.0.suns.iter().any(has_set) && has_no_light_but_sky(lights)
}

/// Whether there is no light other than a uniform sky.
pub fn has_no_light_but_sky(lights: &Lights) -> bool {
    is_dark(&Lights { sky: None, ..lights.clone() })
}

fn lights_of(args: &LightArgs, unlit: Unlit) -> Result<Lights> {
    let mut lights = args.others.0.clone();
    check_suns(&lights.suns, -90.0)?;
    let sky = match unlit {
        _ if !args.is_empty() => args.sky,
        Unlit::Sky => Some(SkyArg::Uniform([1.0; 3])),
        Unlit::Daylight(camera_deg) => {
            let sun = sky::default_sun(camera_deg);
            light("sun").add(&mut lights, &sun).expect("words of a sun");
            Some(SkyArg::Clear)
        }
    };
    match sky {
        None => {}
        Some(SkyArg::Uniform(radiance)) => lights.sky = Some(radiance),
        Some(SkyArg::Clear) => {
            let expected = "a --sun, whose sky it is, and no --env";
            let sun = lights.suns.first().filter(|_| args.env.is_none());
            let sun = sun.ok_or_else(|| Error::setting("--sky", "clear", expected))?;
            if sun.elevation_rad >= 0.0 {
                lights.environment = Some(sky::clear(sun)?);
            }
        }
    }
    // A sun that has set is night, not an error.
    let night = lights.suns.iter().find(|sun| has_set(sun)).map(|sun| sun.irradiance);
    lights.suns.retain(|sun| !has_set(sun));
    if let Some(irradiance) = night.filter(|_| is_dark(&lights) && args.env.is_none()) {
        lights.sky = Some(irradiance.map(|c| NIGHT * c));
    }
    if let Some(path) = &args.env {
        // The compass turns clockwise, the library counter-clockwise.
        lights.environment = Some(files::read_environment(path, -args.env_rotate.to_radians())?);
    }
    Ok(lights)
}

/// Prints the default light as flags, with the bounces that were added. Prints nothing if the command line gives a light.
pub fn say_light(args: &LightArgs, scene: &Scene, added_bounces: Option<Bounces>) {
    if args.is_empty() {
        let bounces =
            added_bounces.map_or_else(String::new, |Bounces { count, azimuths, .. }| {
                format!(" --bounces {count} --bounce-azimuths {azimuths}")
            });
        match light("sun").words(&scene.lights).first() {
            Some(sun) => crate::say!("Light: --sun {sun} --sky clear{bounces} (default)."),
            None => crate::say!("Light: --sky 1{bounces} (default)."),
        }
    }
}

pub fn border(surface: &FieldArgs) -> Border {
    match surface.border {
        BorderName::Plane => Border::Plane,
        BorderName::Open => Border::Open,
        BorderName::Periodic => Border::Periodic,
    }
}

/// Sets the scene's default number of azimuths unless the user gives one. `--basis sh` keeps 32, because SH blurs narrow lobes.
pub fn suit(quality: &mut Quality, args: &QualityArgs, (scene, eye_m): (&Scene, Option<[f64; 3]>)) {
    if !args.gives("azimuths") && quality.basis != Basis::Sh {
        quality.azimuths = Quality::for_scene(scene, eye_m).azimuths;
    }
}

/// Prints the default number of azimuths where the scene changes it.
pub fn say_azimuths(quality: &Quality, args: &QualityArgs) {
    let count = quality.azimuths;
    if !args.gives("azimuths") && count != Quality::default().azimuths {
        crate::say!(
            "Azimuths: --azimuths {count}, because horizons may cut lobes of specular (default)."
        );
    }
}

/// Reports what no device can plan, before a device is opened.
pub fn check_plan(global: &GlobalArgs, plan: impl Fn(&Limits) -> Result<Plan>) -> Result<()> {
    let budget = global.memory_budget.unwrap_or(1 << 50).min(1 << 50);
    plan(&Limits::boundless(true, budget))
        .or_else(|_| plan(&Limits::boundless(false, budget)))
        .map(drop)
}

pub fn device(global: &GlobalArgs) -> Result<(Headless, Limits)> {
    let options = HeadlessOptions { device: global.device.clone(), validation: false };
    let gpu = Headless::new(&options)?;
    let limits = tuned::limits(gpu.report(), global.memory_budget);
    Ok((gpu, limits))
}

/// Images of one frame.
pub fn wanted(layers: &[Layer]) -> Picture {
    Picture {
        light_layers: layers.contains(&Layer::Lights),
        sky_view: layers.contains(&Layer::SkyView),
        still: true,
        ..Picture::default()
    }
}

/// Input files of a command.
pub fn inputs<'a>(field: &'a [PathBuf], args: &'a SceneArgs) -> Vec<&'a Path> {
    let albedo = grey_or_colour(args.albedo()).is_none().then_some(Path::new(args.albedo()));
    let specular = match &args.specular {
        Some(SpecularArg::File(path)) => Some(path.as_path()),
        _ => None,
    };
    let others = [args.lights.env.as_deref(), albedo, specular];
    field.iter().map(PathBuf::as_path).chain(others.into_iter().flatten()).collect()
}

/// Radiance of a picture: one plane where all is grey, else three; voids are NaN.
pub fn planes(pixels: &Pixels, field: &HeightField) -> Vec<Vec<f32>> {
    let channel = |c: usize| {
        let all = pixels.values.iter().skip(c).step_by(pixels.channels);
        masked(field, all.copied().collect())
    };
    (0..pixels.channels.min(3)).map(channel).collect()
}

/// Nanoseconds of all passes.
pub fn total_ns(times: &[Timing]) -> f64 {
    times.iter().map(|t| t.ns).sum()
}

/// The passes that a frame of new heights needs. The tables of the other passes depend on lights and settings alone.
pub fn after_new_heights(plan: &Plan) -> Vec<usize> {
    plan.passes_after(plan, plan.find("heights").as_slice())
}

pub fn no_timestamps() -> Error {
    Error::Device { doing: "timing a frame".into(), reason: "the device has no timestamps".into() }
}
