//! `render`: lights a field and writes a picture.

pub mod auto;
mod bounce;
pub mod camera;
mod choices;
pub mod world;

use ridgelight::gpu::{DeviceReport, Headless, Pixels};
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::Tone;
use ridgelight::scene::{HeightField, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Channels, Georeference, Layer as FileLayer};

use choices::{Choice, Place};

use crate::args::{Layer, RenderArgs};
use crate::idle;
use crate::setup::sky;
use crate::setup::tint::{self, Tint};
use crate::setup::{self, Outcome};

/// Where automatic exposure puts the luminance that a share of the pixels does not exceed, where the tint is lightest.
const EXPOSED: f64 = 0.8;
const EXPOSED_SHARE: f64 = 0.99;

pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let outputs = [
        ("-o", Some(args.output.as_path()), &["exr", "tif", "tiff", "png"][..]),
        ("--json", args.global.json.as_deref(), &["json"]),
    ];
    setup::check_outputs(&outputs, &setup::inputs(&args.input.path, &args.scene))?;
    let is_png = setup::extension(&args.output) == "png";
    let is_tif = setup::is_geotiff(&args.output);
    args.exposure.map_or(Ok(()), |exposure| check_positive("--exposure", exposure))?;
    if is_png && !args.layers.is_empty() {
        return Err(Error::setting(
            "--layers",
            "a .png output",
            "an .exr output, or a .tif without --camera: a .png has no layers",
        ));
    }
    if !is_png && args.exposure.is_some() {
        let kind = if is_tif { "a .tif" } else { "an .exr" };
        return Err(Error::setting(
            "--exposure",
            format!("{kind} output"),
            format!("a .png output: {kind} keeps linear radiance"),
        ));
    }
    if is_tif && args.camera.eye.camera.is_some() {
        return Err(Error::setting(
            "--camera",
            "a .tif output",
            "an .exr or .png output: a .tif is a map",
        ));
    }
    camera::check_layers(args)?;
    let goal = auto::goal(args.auto.max_error, args.auto.time_budget)?;
    auto::say_idle(&args.auto, args.global.quiet);
    let mut quality = args.quality.quality()?;
    let asked_azimuths = quality.azimuths;
    let (field, georeference) =
        setup::georeferenced(&args.input.path, &args.scene.field, &args.global)?;
    let unlit = setup::Unlit::of(&quality, args.camera.eye.compass_deg());
    let mut scene = setup::scene(field, &args.scene, unlit, args.global.quiet)?;
    let tint = match is_png {
        true => setup::tinted(&mut scene, &args.scene),
        false => args.scene.tint.unwrap_or(Tint::None),
    };
    let scene = scene;
    let camera_view = camera::requested(&args.camera, &scene, is_png)?;
    let eye_m = camera_view.as_ref().map(|view| view.eye_m(&scene.field));
    // A goal chooses them by measuring.
    if goal.is_none() {
        setup::suit(&mut quality, &args.quality, (&scene, eye_m));
    }
    let wanted = Picture { eye_m, ..setup::wanted(&args.layers) };
    let picture =
        |quality: &Quality, limits: &Limits| plan::picture(&scene, quality, limits, wanted);
    setup::check_plan(&args.global, |limits| {
        let plan = picture(&quality, limits)?;
        camera_view
            .as_ref()
            .map_or(Ok(()), |camera_view| camera_view.view(&scene, &plan, limits).map(drop))?;
        Ok(plan)
    })?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    let progress = crate::setup::terminal::progress(args.global.quiet, "lighting");
    let mut choice = None;
    if let Some(goal) = goal {
        let goal = (goal, args.auto.seed.unwrap_or(0));
        let place = Place::of((gpu.report(), &limits), &scene, goal, &quality, wanted);
        let kept = if args.auto.no_cache { None } else { place.find() };
        let kept = kept.and_then(|kept| Some((kept.quality().ok()?, kept)));
        let (found, now) = match kept {
            Some((found, kept)) => {
                if !args.global.quiet {
                    setup::note("choice: that of an earlier run; --no-cache chooses again");
                }
                (found, kept)
            }
            None => {
                let own = (quality.hull, quality.bounces.count, wanted);
                let chosen = auto::choose(&mut gpu, &limits, &scene, goal, own, &progress)?;
                let now = Choice::of(goal, &chosen, &scene);
                if !args.auto.no_cache
                    && let Err(error) = place.keep(&now)
                    && !args.global.quiet
                {
                    setup::note(&format!("choice: not kept: {error}"));
                }
                (chosen.trial.quality, now)
            }
        };
        (quality, choice) = (found, Some(now));
        progress.set_message("lighting");
    }
    let is_given = args.quality.gives("bounces") || goal.is_some() || !args.scene.lights.is_empty();
    let with_bounce = match is_png && !is_given && bounce::changes_picture(&scene) {
        true => {
            let has_azimuths = args.quality.gives("bounce_azimuths");
            bounce::plan_with_bounce(&quality, has_azimuths, |quality| picture(quality, &limits))
        }
        false => None,
    };
    let added_bounces = with_bounce.as_ref().map(|(quality, _)| quality.bounces);
    let plan = match with_bounce {
        Some((bounced, plan)) => {
            quality = bounced;
            plan
        }
        None => picture(&quality, &limits)?,
    };
    let horizon = args.layers.contains(&Layer::Horizon);
    // Azimuths chosen for specular change the light alone.
    let azimuths = if choice.is_none() { asked_azimuths } else { quality.azimuths };
    let of_horizons = Quality { azimuths, ..quality };
    let mut used = plan.settings.clone();
    if horizon {
        let border = setup::border(&args.scene.field);
        used.extend(crate::horizon::used(&scene.field, border, &of_horizons, &limits, false)?);
    }
    idle::say(args.global.quiet, &args.quality.written, &used);
    let view = camera_view
        .as_ref()
        .map(|camera_view| camera_view.view(&scene, &plan, &limits))
        .transpose()?;
    let outputs = plan.outputs().count();
    let (times, pixels, camera_pixels, mut metadata) =
        gpu.with_frame(plan, &plan::picture_inputs(&scene), |gpu, frame| {
            let mut times = gpu.draw(frame)?;
            let pixels: Vec<Pixels> =
                (0..outputs).map(|output| gpu.pixels(frame, output)).collect::<Result<_>>()?;
            pixels.iter().try_for_each(|p| check_finite(p, &scene.field))?;
            let look = |view| gpu.look(frame, view, scene.field.voids());
            let camera_pixels = view.as_ref().map(look).transpose()?;
            if let Some(drawn) = &camera_pixels {
                times.extend(drawn.timings.iter().cloned());
            }
            let mut metadata = setup::metadata(gpu, &scene.field, frame.plan());
            if let Some(share) = gpu.negative_share(frame)? {
                metadata.push(("negative_share".to_owned(), share.to_string()));
            }
            Ok((times, pixels, camera_pixels, metadata))
        })?;
    metadata.extend(setup::asked(&args.input, &args.scene.field, Some((&args.scene, &scene))));
    if tint != Tint::None && args.scene.tint.is_none() {
        metadata.retain(|(name, _)| name != "albedo");
        metadata.push(("tint".to_owned(), tint.name()));
    }
    if let Some(choice) = &choice {
        metadata.extend(choice.metadata.iter().cloned());
    }
    if let (Some(camera_view), Some(view)) = (&camera_view, &view) {
        metadata.extend(camera_view.settings(view, &scene.field));
    }
    let mean_horizon =
        if horizon { Some(mean_horizon(&mut gpu, &scene, &of_horizons, &limits)?) } else { None };
    progress.finish_and_clear();
    let mut shown = None;
    let night = if setup::is_night(&args.scene.lights, &scene.lights) { NIGHT_SHARE } else { 1.0 };
    let white = night * white(&scene.field, tint);
    let (rows, cols) = (scene.field.rows(), scene.field.cols());
    if let (Some(camera_view), Some(camera_pixels)) = (&camera_view, &camera_pixels) {
        if is_png {
            // The background would decide on the terrain's exposure.
            let around: Vec<bool> =
                camera_pixels.distances_m.iter().map(|d| !d.is_finite()).collect();
            let picture = &camera_pixels.radiance;
            let exposure = args.exposure.unwrap_or_else(|| exposure(picture, Some(&around), white));
            note_black(args, &scene, picture, Some(&around));
            shown = Some(exposure);
            metadata.push(("exposure".to_owned(), exposure.to_string()));
        }
        camera::write(args, camera_view, camera_pixels, shown, &metadata)?;
        if is_png {
            world::warn_of_stale(&args.output, "this one is a camera view");
        }
    } else if !is_png {
        let georeference = georeference.as_ref();
        write_floats(
            args,
            &scene.field,
            georeference,
            &pixels,
            mean_horizon.as_deref(),
            &metadata,
        )?;
    } else {
        let picture = rgb(&pixels[0]);
        let voids = scene.field.voids();
        let exposure = args.exposure.unwrap_or_else(|| exposure(&picture, voids, white));
        note_black(args, &scene, &picture, voids);
        shown = Some(exposure);
        metadata.push(("exposure".to_owned(), exposure.to_string()));
        let tone = Tone::picture(exposure);
        files::write_png(&args.output, rows, cols, &picture, voids, tone, &metadata)?;
        let (at, quiet) = (georeference.as_ref(), args.global.quiet);
        world::write(&args.output, &args.input, at)?;
        world::note_shape(&args.output, &scene.field, at, quiet);
    }
    if let Some(json) = &args.global.json {
        let mut report = setup::as_json(&metadata, &times);
        if let Some(choice) = &choice {
            report["settings"]["tried"] = choice.tried.as_str().into();
        }
        files::write_json(json, &report)?;
    }
    if !args.global.quiet {
        if let Some(camera_view) = &camera_view {
            camera_view.say(args, &scene.field, &times, gpu.report());
        } else {
            let ms = setup::total_ns(&times) / 1e6;
            crate::say!(
                "Wrote {} ({cols}x{rows}) in {ms:.1} ms of GPU time on {}{}.",
                args.output.display(),
                gpu.report().name,
                of_first_frame(gpu.report())
            );
        }
        setup::say_light(&args.scene.lights, &scene, added_bounces);
        if choice.is_none() {
            setup::say_azimuths(&quality, &args.quality);
        }
        if let Some(exposure) = shown {
            let tint = tint.name();
            let by = if args.exposure.is_none() { "automatic" } else { "given" };
            crate::say!("Picture: --tint {tint} --exposure {exposure} ({by}).");
        }
        for sentence in choice.iter().flat_map(Choice::sentences) {
            crate::say!("{sentence}");
        }
    }
    Ok(Outcome::Done)
}

/// Software drivers compile shaders while the first frame runs.
pub fn of_first_frame(report: &DeviceReport) -> &'static str {
    if report.limits.is_cpu { ", compiling its shaders included" } else { "" }
}

pub fn check_positive<T: Copy + Into<f64> + ToString>(flag: &str, x: T) -> Result<()> {
    let is_positive = x.into().is_finite() && x.into() > 0.0;
    is_positive.then_some(()).ok_or_else(|| Error::setting(flag, x.to_string(), "a number above 0"))
}

/// Brightness of a night picture relative to other pictures, with automatic exposure.
pub const NIGHT_SHARE: f64 = 0.1;

/// Where automatic exposure puts the 99th percentile of luminance: 0.8 for the lightest colour of a tint. A field without
/// that colour stays as dark as its tint.
pub fn white(field: &HeightField, tint: Tint) -> f64 {
    EXPOSED * tint::peak(field, tint, EXPOSED_SHARE)
}

/// The exposure that puts the 99th percentile of luminance at [`white`], of the pixels that are not left out. 1 where that
/// is dark.
pub fn exposure(picture: &[[f32; 3]], left_out: Option<&[bool]>, white: f64) -> f32 {
    let texels = picture.iter().enumerate().filter(|(i, _)| !left_out.is_some_and(|v| v[*i]));
    let mut all: Vec<f64> = texels.map(|(_, t)| sky::luminance(t.map(f64::from))).collect();
    let Some(bright) = tint::at_share(&mut all, EXPOSED_SHARE) else { return 1.0 };
    // Four digits: a factor that can be typed.
    let exposure = format!("{:.3e}", white / bright).parse::<f32>().unwrap_or(1.0);
    if exposure.is_finite() && exposure > 0.0 { exposure } else { 1.0 }
}

/// A note on a picture that is black because less than 1 % of it is lit.
fn note_black(args: &RenderArgs, scene: &Scene, picture: &[[f32; 3]], left_out: Option<&[bool]>) {
    let has_sky = scene.lights.sky.is_some() || scene.lights.environment.is_some();
    if args.global.quiet || args.exposure.is_some() || has_sky {
        return;
    }
    let counts = |i: usize| !left_out.is_some_and(|v| v[i]);
    let all = (0..picture.len()).filter(|i| counts(*i)).count();
    let is_lit = |i: &usize| counts(*i) && picture[*i].iter().any(|v| *v > 0.0);
    let lit = (0..picture.len()).filter(is_lit).count();
    if (lit as f64) < (1.0 - EXPOSED_SHARE) * all as f64 {
        let share = 100.0 * lit as f64 / all as f64;
        let path = args.output.display();
        setup::note(&format!(
            "{path}: only {share:.2} % of the picture is lit; --sky lights the rest"
        ));
    }
}

/// Refuses light that overflows, although each light is finite.
pub fn check_finite(pixels: &Pixels, field: &HeightField) -> Result<()> {
    let is_void = |i: usize| field.voids().is_some_and(|v| v[i]);
    let texels = pixels.values.chunks_exact(pixels.channels).enumerate();
    for (i, texel) in texels.filter(|(i, _)| !is_void(*i)) {
        if let Some(value) = texel.iter().take(3).find(|v| !v.is_finite()) {
            let (row, col) = (i / field.cols(), i % field.cols());
            let found = format!("light of {value} at row {row}, column {col} of {}", pixels.name);
            return Err(Error::setting("lights", found, "radiances whose sum is below 3e38"));
        }
    }
    Ok(())
}

pub fn rgb(pixels: &Pixels) -> Vec<[f32; 3]> {
    match pixels.channels {
        1 => pixels.values.iter().map(|v| [*v; 3]).collect(),
        _ => pixels.values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

/// Mean elevation of the horizon over the azimuths, radians.
fn mean_horizon(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    limits: &Limits,
) -> Result<Vec<f32>> {
    let field = &scene.field;
    let mut sum = vec![0.0_f64; field.rows() * field.cols()];
    let border = scene.surface.border;
    let mut add = |_: u32, angles: &[f32], _: &[f32]| {
        sum.iter_mut().zip(angles).for_each(|(s, a)| *s += f64::from(*a));
        Ok(())
    };
    crate::horizon::for_each(gpu, field, border, quality, limits, false, &mut add)?;
    Ok(sum.iter().map(|s| (s / f64::from(quality.azimuths)) as f32).collect())
}

/// Writes an EXR or a GeoTIFF.
fn write_floats(
    args: &RenderArgs,
    field: &HeightField,
    georeference: Option<&Georeference>,
    pixels: &[Pixels],
    horizon: Option<&[f32]>,
    metadata: &[(String, String)],
) -> Result<()> {
    let masked = |p: &Pixels| {
        let mut texels = rgb(p);
        setup::mask_voids(field, texels.as_flattened_mut(), 3);
        texels
    };
    let masked: Vec<Vec<[f32; 3]>> = pixels.iter().map(masked).collect();
    let named = || pixels.iter().map(|p| p.name.as_str()).zip(&masked);
    let sky_view = named().filter(|(name, _)| *name == "sky_view");
    let sky_view: Vec<f32> = sky_view.flat_map(|(_, t)| t.iter().map(|t| t[0])).collect();
    let horizon = horizon.map(|plane| setup::masked(field, plane.to_vec()));
    let layers = named().map(|(name, texels)| match name {
        "sky_view" => FileLayer::scalar(name, &sky_view),
        "radiance" => FileLayer { name: String::new(), channels: Channels::Rgb(texels) },
        _ => FileLayer { name: name.to_owned(), channels: Channels::Rgb(texels) },
    });
    let horizon = horizon.iter().map(|plane| FileLayer::scalar("horizon_mean", plane));
    let layers: Vec<FileLayer> = layers.chain(horizon).collect();
    let (size, units) = ([field.rows(), field.cols()], [("horizon_mean", "rad")]);
    setup::write_layers(&args.output, size, &layers, &units, georeference, metadata)
}
