//! `reference`: traces paths in batches until there are enough, the error is small enough, or the
//! user stops it.

use std::sync::atomic::{AtomicBool, Ordering};

use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Limits, REFERENCE_BATCH};
use ridgelight::scene::Scene;
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::{Channels, Georeference, Layer};

use crate::args::ReferenceArgs;
use crate::render::{camera, rgb};
use crate::setup::{self, Outcome};

/// Fewest batches for a reliable error: its relative standard error is 1/√(2·7).
const LEAST_BATCHES: u32 = 8;

/// Batches between two estimates of the error.
const BATCHES_A_CHECK: u32 = 4;

/// Whether a signal ends the tracing instead of the program.
static IS_TRACING: AtomicBool = AtomicBool::new(false);
static WAS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Handles a signal. Returns whether it ends only the tracing, so that the result so far is
/// written. A second signal ends the program.
pub fn takes_signal() -> bool {
    IS_TRACING.load(Ordering::SeqCst) && !WAS_INTERRUPTED.swap(true, Ordering::SeqCst)
}

pub fn run(args: &ReferenceArgs) -> Result<Outcome> {
    check(args)?;
    let (field, georeference) =
        setup::georeferenced(&args.input.path, &args.scene.field, &args.global)?;
    let scene = setup::scene(
        field,
        &args.scene,
        setup::Unlit::Daylight(args.camera.compass_deg()),
        args.global.quiet,
    )?;
    let eye_m = camera::eye_m(&args.camera, &scene.field)?;
    let is_idle =
        eye_m.is_some() && scene.surface.specular.is_none() && !args.scene.lights.is_empty();
    if is_idle && !args.has_camera_of_file && !args.global.quiet {
        setup::note("--camera changes nothing without --specular");
    }
    let plan = |limits: &Limits| {
        plan::reference(&scene, args.bounces, args.normals.into(), eye_m, args.seed, limits)
    };
    setup::check_plan(&args.global, plan)?;
    // From here on a signal ends the tracing only.
    IS_TRACING.store(true, Ordering::SeqCst);
    let (mut gpu, limits) = setup::device(&args.global)?;
    let contents = plan::reference_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let mut frame = gpu.frame(plan(&limits)?, &contents)?;
    let traced = trace(args, &scene, &mut gpu, &mut frame);
    let traced = traced.and_then(|traced| {
        write(args, (&scene, georeference.as_ref()), &gpu, &frame, &traced).map(|()| traced)
    });
    IS_TRACING.store(false, Ordering::SeqCst);
    gpu.end(frame);
    let traced = traced?;
    let interrupted = WAS_INTERRUPTED.load(Ordering::SeqCst);
    // NaN is within no error.
    let is_within = |wanted: &f64| traced.error < *wanted;
    let missed = args.until_error.filter(|wanted| !interrupted && !is_within(wanted));
    if !args.global.quiet {
        let paths = traced.batches * REFERENCE_BATCH;
        crate::say!(
            "Wrote {} ({}x{}, {paths} paths per texel, {}) in {:.1} ms of GPU time on {}.",
            args.output.display(),
            scene.field.cols(),
            scene.field.rows(),
            error_text(traced.error),
            setup::total_ns(&traced.times) / 1e6,
            gpu.report().name
        );
        setup::say_light(&args.scene.lights, &scene, None);
        if let Some(wanted) = missed {
            let least = 2 * REFERENCE_BATCH;
            let whole = match paths == args.spp {
                true => String::new(),
                false => format!(" (whole batches of {REFERENCE_BATCH}, at least {least})"),
            };
            crate::say!(
                "--spp {} ended the tracing after {paths} paths{whole}, before --until-error \
                    {wanted} was reached",
                args.spp
            );
        }
    }
    Ok(match (interrupted, missed) {
        (true, _) => Outcome::Interrupted,
        (false, Some(_)) => Outcome::Beyond,
        (false, None) => Outcome::Done,
    })
}

fn check(args: &ReferenceArgs) -> Result<()> {
    let outputs = [
        ("-o", Some(args.output.as_path()), &["exr", "tif", "tiff"][..]),
        ("--json", args.global.json.as_deref(), &["json"]),
    ];
    setup::check_outputs(&outputs, &setup::inputs(&args.input.path, &args.scene))?;
    // Paths are counted in whole batches.
    let most = u32::MAX / REFERENCE_BATCH * REFERENCE_BATCH;
    if args.spp > most {
        return Err(Error::setting("--spp", args.spp.to_string(), format!("at most {most}")));
    }
    args.until_error.map_or(Ok(()), |e| crate::render::check_positive("--until-error", e))
}

/// The result of the paths.
struct Traced {
    /// Paths of every texel; some rows of an interrupted run may have more.
    batches: u32,
    radiance: Vec<[f32; 3]>,
    /// From the spread between batches.
    standard_error: Vec<[f32; 3]>,
    /// Root mean square of the standard error, including unsampled light, over the mean radiance.
    error: f64,
    /// Standard error of unsampled light, by channel: [`plan::unsampled_light_error`].
    unsampled: [f64; 3],
    /// Sums, by pass.
    times: Vec<Timing>,
}

fn trace(
    args: &ReferenceArgs,
    scene: &Scene,
    gpu: &mut Headless,
    frame: &mut Frame,
) -> Result<Traced> {
    let passes = frame.plan().passes.iter().enumerate();
    let bands: Vec<usize> = passes.filter(|(_, p)| p.name() == "path_trace").map(|b| b.0).collect();
    let wanted = args.spp.div_ceil(REFERENCE_BATCH).max(2);
    let progress = crate::setup::terminal::progress(args.global.quiet, "tracing");
    let mut times = gpu.draw(frame)?;
    let mut batches = 1;
    loop {
        let interrupted = WAS_INTERRUPTED.load(Ordering::SeqCst);
        let is_due = batches % BATCHES_A_CHECK == 0 && batches >= LEAST_BATCHES;
        // At least two batches: one has no error estimate.
        if batches >= 2 && (batches >= wanted || interrupted || is_due) {
            let radiance = rgb(&gpu.pixels(frame, 0)?);
            let standard_error = rgb(&gpu.pixels(frame, 1)?);
            let (mean, error) = mean_and_error(scene, &radiance, &standard_error)?;
            let unsampled =
                plan::unsampled_light_error(scene, args.bounces, batches * REFERENCE_BATCH);
            let error = relative(error.hypot(root_mean_square(unsampled)), mean);
            progress.set_message(format!(
                "{} of {} paths per texel, {}",
                batches * REFERENCE_BATCH,
                wanted * REFERENCE_BATCH,
                error_text(error)
            ));
            let enough = batches >= LEAST_BATCHES && args.until_error.is_some_and(|e| error < e);
            if batches >= wanted || interrupted || enough {
                progress.finish_and_clear();
                if let Some(lost) = frame.plan().find("lost_rays") {
                    none_lost(gpu.read(frame, lost)?[0])?;
                }
                return Ok(Traced { batches, radiance, standard_error, error, unsampled, times });
            }
        }
        for &band in &bands {
            let more = gpu.draw_passes(frame, &[band])?;
            if let (Some(sum), Some(one)) = (times.get_mut(band), more.first()) {
                sum.ns += one.ns;
            }
            if batches >= 2 && WAS_INTERRUPTED.load(Ordering::SeqCst) {
                break;
            }
        }
        if batches < 2 || !WAS_INTERRUPTED.load(Ordering::SeqCst) {
            batches += 1;
        }
    }
}

/// The error in words. A percentage is meaningless where almost no light has been sampled.
fn error_text(error: f64) -> String {
    match error {
        _ if error < 10.0 => format!("error {:.3} %", 100.0 * error),
        _ => "error far above the mean radiance".to_owned(),
    }
}

/// Error over the mean: 0 for no error, infinite where all is dark with an error.
fn relative(error: f64, mean: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / mean }
}

pub fn root_mean_square(v: [f64; 3]) -> f64 {
    (v.iter().map(|v| v * v).sum::<f64>() / 3.0).sqrt()
}

/// Mean radiance and root mean square of the standard error, over all channels of texels that are
/// no voids.
fn mean_and_error(
    scene: &Scene,
    radiance: &[[f32; 3]],
    standard_error: &[[f32; 3]],
) -> Result<(f64, f64)> {
    let is_void = |i: usize| scene.field.voids().is_some_and(|v| v[i]);
    let (mut light, mut squares, mut count) = (0.0, 0.0, 0.0_f64);
    for i in (0..radiance.len()).filter(|i| !is_void(*i)) {
        for c in 0..3 {
            light += f64::from(radiance[i][c]);
            squares += f64::from(standard_error[i][c]).powi(2);
            count += 1.0;
        }
    }
    if !(light + squares).is_finite() {
        let most = "radiances whose sum over 64 paths is within 32-bit numbers: below 1e36";
        return Err(Error::setting("lights", "brighter light", most));
    }
    let count = count.max(1.0);
    Ok((light / count, (squares / count).sqrt()))
}

/// Refuses a result with rays that were given up, whose light would be missing.
pub fn none_lost(count: u32) -> Result<()> {
    match count {
        0 => Ok(()),
        _ => Err(Error::Device {
            doing: "tracing paths".into(),
            reason: format!("{count} rays took more steps than the field can require"),
        }),
    }
}

fn write(
    args: &ReferenceArgs,
    (scene, georeference): (&Scene, Option<&Georeference>),
    gpu: &Headless,
    frame: &Frame,
    traced: &Traced,
) -> Result<()> {
    let mut metadata = setup::metadata(gpu, &scene.field, frame.plan());
    let lit = Some((&args.scene, scene));
    metadata.extend(setup::asked(&args.input, &args.scene.field, lit));
    let mut add = |name: &str, value: String| metadata.push((name.to_owned(), value));
    add("spp", (traced.batches * REFERENCE_BATCH).to_string());
    add("relative_standard_error", traced.error.to_string());
    if let Some(wanted) = args.until_error {
        add("until_error", wanted.to_string());
    }
    add("unsampled_standard_error", traced.unsampled.map(|v| v.to_string()).join(","));
    let mut layers =
        [("", traced.radiance.clone()), ("standard_error", traced.standard_error.clone())];
    for (_, texels) in &mut layers {
        setup::mask_voids(&scene.field, texels.as_flattened_mut(), 3);
    }
    let layers: Vec<Layer> = layers
        .iter()
        .map(|(name, texels)| Layer { name: (*name).into(), channels: Channels::Rgb(texels) })
        .collect();
    let size = [scene.field.rows(), scene.field.cols()];
    setup::write_layers(&args.output, size, &layers, &[], georeference, &metadata)?;
    match &args.global.json {
        Some(json) => files::write_json(json, &setup::as_json(&metadata, &traced.times)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Surface};

    /// No error of no light; no number of forty digits for almost no light.
    #[test]
    fn huge_errors_are_stated_in_words() {
        let of = |error, mean| error_text(relative(error, mean));
        assert_eq!(of(0.0, 0.0), "error 0.000 %");
        assert_eq!(of(0.02, 2.0), "error 1.000 %");
        for (error, mean) in [(1.0, 0.0), (1.0, 1e-40), (f64::NAN, 1.0)] {
            assert_eq!(of(error, mean), "error far above the mean radiance");
        }
    }

    #[test]
    fn lost_rays_are_an_error() {
        assert!(none_lost(0).is_ok());
        let said = none_lost(3).unwrap_err().to_string();
        assert!(said.contains("3 rays took more steps"), "{said}");
    }

    /// 1 and 3 with errors 3 and 4: mean 2, root mean square √12.5. A dark texel with an error has
    /// no error of 0 %; sums beyond f32 are refused.
    #[test]
    fn errors_are_shares_of_the_mean() {
        let field = HeightField::new(1, 2, &[0.0; 2], [1.0; 2], None).unwrap();
        let scene = Scene {
            field,
            surface: Surface::default(),
            lights: ridgelight::scene::Lights::default(),
        };
        let both = [[1.0; 3], [3.0; 3]];
        let (mean, error) = mean_and_error(&scene, &both, &[[3.0; 3], [4.0; 3]]).unwrap();
        assert!((mean - 2.0).abs() < 1e-12 && (error - 12.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(relative(0.0, 0.0), 0.0);
        assert_eq!(relative(1e-9, 0.0), f64::INFINITY);
        let said = mean_and_error(&scene, &both, &[[0.0; 3], [f32::NAN; 3]]).unwrap_err();
        assert!(said.to_string().contains("below 1e36"), "{said}");
    }
}
