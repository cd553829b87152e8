//! `hillshade`, `shadow`, `ao`, `svf` and `openness`: maps, in one file.

use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

use glam::DVec3;
use ridgelight::gpu::{Headless, Timing};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Border, Bounces, HeightField, Lights, Quality, Scene, Sun, Surface, normal,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Georeference, Layer};

use crate::args::{
    FieldArgs, GlobalArgs, HillshadeArgs, MapArgs, OpennessArgs, ShadowArgs, SkyViewArgs,
};
use crate::render::world;
use crate::setup::lights::light;
use crate::setup::{self, Outcome};
use crate::{horizon, idle};

/// The layer of a picture, and the name of its map.
pub const SKY_VIEW: &str = "sky_view";

/// Plans the sky-view layer of `render`. Reading every horizon back to sum it here took four times
/// as long at 1024 × 1024.
pub fn sky_view_plan(
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
) -> Result<Plan> {
    // Its only input is the heights: no environment, no map of albedo.
    let surface = Surface { border, ..Surface::default() };
    let scene = Scene { field: field.clone(), surface, lights: Lights::default() };
    let wanted = Picture { sky_view: true, still: true, ..Picture::default() };
    plan::picture(&scene, quality, limits, wanted)
}

/// The sky-view layer of [`sky_view_plan`].
pub fn sky_view(
    gpu: &mut Headless,
    field: &HeightField,
    plan: Plan,
) -> Result<(Vec<f32>, Vec<Timing>)> {
    let layer = plan.outputs().position(|(_, image)| image.name == SKY_VIEW);
    let layer = layer.expect("a layer that was requested");
    gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        let times = gpu.draw(frame)?;
        Ok((gpu.pixels(frame, layer)?.values, times))
    })
}

/// What a map's values are.
pub struct Values {
    /// The channel of an .exr and the band of a .tif.
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    /// The values that are 0 and 255 in a .png.
    png: [f32; 2],
}

impl Values {
    /// A sentence that states what 0 and 255 of a .png stand for; empty where values are stored as they are.
    fn png_range(&self) -> String {
        let ([black, white], unit) = (self.png, self.unit);
        if self.png == [0.0, 255.0] {
            return String::new();
        }
        let blank = if unit.is_empty() { "" } else { " " };
        format!(" Pixel values 0 to 255 stand for {black} to {white}{blank}{unit}.")
    }
}

/// Linear, not sRGB: a texture of engines, and a layer to multiply by.
pub const SKY_VIEW_VALUES: Values = Values {
    name: SKY_VIEW,
    unit: "",
    about: "cosine-weighted share of the hemisphere about the normal that no ground occludes",
    png: [0.0, 1.0],
};

/// The same map. The range of a .png is that of RVT's 8-bit sky-view factor (`svf_bytscl` in `rvt/default.py` of RVT_py).
pub const SVF_VALUES: Values = Values { png: [0.6375, 1.0], ..SKY_VIEW_VALUES };

/// As `gdaldem hillshade`: 1 to 255, and 0 is no data.
const HILLSHADE_VALUES: Values = Values {
    name: "hillshade",
    unit: "",
    about: "1 + 254 max(cos, 0), cos between normal and sun; no shadows",
    png: [0.0, 255.0],
};

/// The range of a .png is that of RVT's 8-bit openness (`pos_opns_bytscl` in the same file).
const OPENNESS_VALUES: Values = Values {
    name: "openness",
    unit: "deg",
    about: "mean zenith angle of the horizon, degrees",
    png: [60.0, 95.0],
};

const NEGATIVE_OPENNESS_VALUES: Values = Values {
    name: "negative_openness",
    about: "mean zenith angle of the horizon of the negated heights, degrees",
    ..OPENNESS_VALUES
};

/// The maps of `shadow`. A .png holds the first.
const SHADOW_VALUES: [Values; 3] = [
    Values {
        name: "sun_share",
        unit: "",
        about: "visible share of the sun's disc; height from which all of it is visible, m; height of the penumbra below, m",
        png: [0.0, 1.0],
    },
    Values { name: "lit_above", unit: "m", about: "", png: [0.0, 1.0] },
    Values { name: "penumbra", unit: "m", about: "", png: [0.0, 1.0] },
];

/// [`setup::georeferenced`] or [`setup::of_neighbours`].
type Read = fn(&[PathBuf], &FieldArgs, &GlobalArgs) -> Result<(HeightField, Option<Georeference>)>;

/// A command's arguments and field.
struct Job<'a> {
    args: &'a MapArgs,
    surface: &'a FieldArgs,
    field: HeightField,
    georeference: Option<Georeference>,
}

impl<'a> Job<'a> {
    fn new(args: &'a MapArgs, surface: &'a FieldArgs, read: Read) -> Result<Self> {
        let MapArgs { input, output, global, .. } = args;
        let kinds: &[&str] = &["tif", "tiff", "npy", "exr", "png"];
        let json = global.json.as_deref();
        let outputs = [("-o", Some(output.as_path()), kinds), ("--json", json, &["json"])];
        setup::check_outputs(&outputs, &input.paths())?;
        let (field, georeference) = read(&input.path, surface, global)?;
        Ok(Self { args, surface, field, georeference })
    }

    /// Writes the map, and reports it. Several planes are bands, channels, or layers of an array; a .png has the first.
    /// `metadata` and `times` are those of the device, if it was used.
    fn write(
        &self,
        values: &[Values],
        mut planes: Vec<Vec<f32>>,
        mut metadata: Vec<(String, String)>,
        times: &[Timing],
    ) -> Result<Outcome> {
        let MapArgs { input, output: path, global, .. } = self.args;
        let size @ [rows, cols] = [self.field.rows(), self.field.cols()];
        planes.iter_mut().for_each(|plane| setup::mask_voids(&self.field, plane, 1));
        metadata.extend(setup::asked(input, self.surface, None));
        metadata.push(("values".into(), values[0].about.into()));
        let of_values = values.iter().zip(&planes);
        let layers: Vec<_> = of_values.map(|(v, plane)| Layer::scalar(v.name, plane)).collect();
        let place = self.georeference.as_ref();
        match setup::extension(path).as_str() {
            "npy" => {
                let shape = [&[planes.len()], &size[..]].concat();
                let shape = if planes.len() == 1 { &size[..] } else { &shape };
                files::write_npy_f32(path, shape, planes.iter().map(Vec::as_slice))?;
            }
            "png" => {
                let (channels, codes) = codes(&planes[0], values[0].png);
                let [black, white] = values[0].png;
                metadata.push(("png_range".into(), format!("{black},{white}")));
                let form = (channels, 8);
                files::write_codes_aside(path, [cols, rows], form, &codes, &metadata)?.place()?;
                world::write(path, input, place)?;
                world::note_shape(path, &self.field, place, global.quiet);
            }
            _ => {
                let units: Vec<_> = values.iter().map(|v| (v.name, v.unit)).collect();
                setup::write_layers(path, size, &layers, &units, place, &metadata)?;
            }
        }
        if let Some(json) = &global.json {
            files::write_json(json, &setup::as_json(&metadata, times))?;
        }
        if !global.quiet {
            let device = metadata.iter().find(|(name, _)| name == "device");
            let time = device.map_or(String::new(), |(_, device)| {
                format!(" in {:.1} ms of GPU time on {device}", setup::total_ns(times) / 1e6)
            });
            let is_png = setup::extension(path) == "png";
            let range = if is_png { values[0].png_range() } else { String::new() };
            crate::say!("Wrote {} ({cols}x{rows}){time}.{range}", path.display());
        }
        Ok(Outcome::Done)
    }
}

/// Grey of 8 bits, and alpha where there is NaN.
fn codes(plane: &[f32], [black, white]: [f32; 2]) -> (usize, Vec<u8>) {
    // A conversion from f32 saturates, and takes NaN to 0.
    let code = |v: f32| (255.0 * (v - black) / (white - black)).round() as u8;
    match plane.iter().any(|v| v.is_nan()) {
        false => (1, plane.iter().map(|v| code(*v)).collect()),
        true => {
            let alpha = |v: f32| if v.is_nan() { 0 } else { 255 };
            (2, plane.iter().flat_map(|v| [code(*v), alpha(*v)]).collect())
        }
    }
}

pub fn hillshade(args: &HillshadeArgs) -> Result<Outcome> {
    let lights = Lights { suns: args.sun.clone(), ..Lights::default() };
    setup::check_suns(&lights.suns, 0.0)?;
    lights.check()?;
    let [sun] = *lights.suns else {
        return Err(Error::setting("--sun 2", "another sun", "one sun: a hillshade has no more"));
    };
    let words = light("sun").words(&lights).concat();
    let direction = words.split(',').take(2).collect::<Vec<_>>().join(",");
    note_ignored("hillshade", &sun, false, args.map.global.quiet);
    if let (Some(device), false) = (&args.map.global.device, args.map.global.quiet) {
        idle::note("device", device, "for hillshade, which always runs on the CPU");
    }
    let job = Job::new(&args.map, &args.map.surface, setup::of_neighbours)?;
    let plane = lambert(&job.field, setup::border(job.surface), sun);
    let mut metadata = setup::of_field(&job.field);
    metadata.push(("sun1".into(), direction));
    job.write(&[HILLSHADE_VALUES], vec![plane], metadata, &[])
}

pub fn shadow(args: &ShadowArgs) -> Result<Outcome> {
    let lights = Lights { suns: args.sun.clone(), ..Lights::default() };
    setup::check_suns(&lights.suns, 0.0)?;
    let [sun] = *lights.suns else {
        return Err(Error::setting("--sun 2", "another sun", "one sun: run `shadow` once per sun"));
    };
    note_ignored("shadow", &sun, true, args.map.global.quiet);
    if setup::border(&args.map.surface) == Border::Periodic {
        let expected = "plane or open: `shadow` does not support a periodic field";
        return Err(Error::setting("--border", "periodic", expected));
    }
    let job = Job::new(&args.map, &args.map.surface, setup::georeferenced)?;
    let field = &job.field;
    let plan = |limits: &Limits| plan::shadow_heights(field, &sun, None, 1, limits);
    setup::check_plan(&args.map.global, plan)?;
    let (mut gpu, limits) = setup::device(&args.map.global)?;
    let plan = plan(&limits)?;
    let mut metadata = setup::metadata(&gpu, field, &plan);
    metadata.push(("sun1".into(), light("sun").words(&lights).concat()));
    let (mut planes, times) = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        let times = gpu.draw(frame)?;
        let of = |output| Ok(gpu.pixels(frame, output)?.values);
        Ok(([2, 0, 1].map(of).into_iter().collect::<Result<Vec<_>>>()?, times))
    })?;
    // Absolute, like the heights of the input.
    let absolute = |height: &mut f32| *height = (f64::from(*height) + field.base_m()) as f32;
    planes[1].iter_mut().for_each(absolute);
    job.write(&SHADOW_VALUES, planes, metadata, &times)
}

/// A note on values of a sun that a map ignores.
fn note_ignored(command: &str, sun: &Sun, uses_diameter: bool, quiet: bool) {
    let mut plain = Lights::default();
    light("sun").add(&mut plain, "0,0").expect("a sun of ours");
    let Sun { diameter_rad, irradiance, .. } = plain.suns[0];
    let has_diameter = !uses_diameter && sun.diameter_rad != diameter_rad;
    let what = match (has_diameter, sun.irradiance != irradiance) {
        (false, false) => return,
        (true, false) => "the diameter",
        (false, true) => "the irradiance",
        (true, true) => "the diameter and the irradiance",
    };
    if !quiet {
        setup::note(&format!("--sun: {command} ignores {what}"));
    }
}

/// Lambert's cosine as `gdaldem hillshade` stores it. Inside the field, the mean gradient of the four adjoining cells
/// is that of Horn (1981).
fn lambert(field: &HeightField, border: Border, sun: Sun) -> Vec<f32> {
    let (rows, cols) = (field.rows(), field.cols());
    let [(sin_az, cos_az), (sin_el, cos_el)] =
        [sun.azimuth_rad, sun.elevation_rad].map(f64::sin_cos);
    let sun = DVec3::new(cos_az * cos_el, sin_az * cos_el, sin_el);
    let cos = |i: usize| normal(field, border, i / cols, i % cols).dot(sun);
    (0..rows * cols).map(|i| (1.0 + 254.0 * cos(i).max(0.0)) as f32).collect()
}

/// `ao` and `svf`, by their values.
pub fn sky_view_map(args: &SkyViewArgs, values: Values) -> Result<Outcome> {
    let quality = Quality { bounces: Bounces::default(), ..args.quality.quality()? };
    let job = Job::new(&args.map, &args.map.surface, setup::georeferenced)?;
    let border = setup::border(job.surface);
    let plan = |limits: &Limits| sky_view_plan(&job.field, border, &quality, limits);
    setup::check_plan(&args.map.global, plan)?;
    let (mut gpu, limits) = setup::device(&args.map.global)?;
    let plan = plan(&limits)?;
    let mut used = plan.settings.clone();
    used.retain(|(name, _)| !name.starts_with("bounce"));
    let why = |name: &str| name.starts_with("bounce").then(|| "for this map".to_owned());
    idle::say_why(args.map.global.quiet, &args.quality.written, &used, &why);
    let metadata = setup::metadata(&gpu, &job.field, &plan);
    let bar = setup::terminal::progress(args.map.global.quiet, "sky view");
    let (plane, times) = sky_view(&mut gpu, &job.field, plan)?;
    bar.finish_and_clear();
    job.write(&[values], vec![plane], metadata, &times)
}

pub fn openness(OpennessArgs { of: args, negative }: &OpennessArgs) -> Result<Outcome> {
    let quality = args.quality.quality()?;
    let MapArgs { surface, global, .. } = &args.map;
    let surface = FieldArgs { is_negated: *negative, ..*surface };
    let job = Job::new(&args.map, &surface, setup::georeferenced)?;
    let (field, border) = (&job.field, setup::border(&surface));
    setup::check_plan(global, |limits| {
        let most = horizon::at_once(field, limits);
        horizon::plan_from(field, border, &quality, limits, (0, most), false)
    })?;
    let (mut gpu, limits) = setup::device(global)?;
    let used = horizon::used(field, border, &quality, &limits, false)?;
    idle::say(global.quiet, &args.quality.written, &used);
    let bar = setup::terminal::progress(global.quiet, "horizons");
    let mut sums = vec![(0.0_f64, 0_u32); field.rows() * field.cols()];
    let each = &mut |k: u32, elevations: &[f32], _: &[f32]| {
        bar.set_message(format!("horizons: azimuth {} of {}", k + 1, quality.azimuths));
        for ((sum, count), elevation) in sums.iter_mut().zip(elevations) {
            let elevation = f64::from(*elevation);
            if elevation > NO_GROUND {
                *sum += FRAC_PI_2 - elevation;
                *count += 1;
            }
        }
        Ok(())
    };
    let (times, plan) = horizon::for_each(&mut gpu, field, border, &quality, &limits, false, each)?;
    bar.finish_and_clear();
    let mut metadata = setup::metadata(&gpu, field, &plan);
    metadata.push(("azimuths".into(), quality.azimuths.to_string()));
    // Without ground in any azimuth, 0/0 is NaN: no data.
    let mean = |(sum, count): &(f64, u32)| (sum / f64::from(*count)).to_degrees() as f32;
    let plane = sums.iter().map(mean).collect();
    let values = if *negative { NEGATIVE_OPENNESS_VALUES } else { OPENNESS_VALUES };
    job.write(&[values], vec![plane], metadata, &times)
}

/// With an open border, the horizon is -90° in an azimuth without ground. Ground this steep, of slope 1e5, is none.
const NO_GROUND: f64 = 1e-5 - FRAC_PI_2;
