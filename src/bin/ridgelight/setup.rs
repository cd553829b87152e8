//! From arguments to scenes, qualities and devices.

use ridgelight::files::{self, HeightOptions};
use ridgelight::gpu::{Headless, HeadlessOptions, Timing};
use ridgelight::plan::{Limits, Plan};
use ridgelight::scene::{
    Albedo, Border, Fuse, HeightField, Hull, Lights, Lines, Method, Precision, Quality, Scene,
    Surface,
};
use ridgelight::{Error, Result};
use std::path::Path;

use crate::args::{
    BorderName, FuseName, GlobalArgs, HullName, LightArgs, LinesName, MethodName, PrecisionName,
    QualityArgs, SurfaceArgs, albedo_colour,
};

/// How a command ended that did not fail.
pub enum Outcome {
    Done,
    /// A comparison beyond its bound.
    Beyond,
}

pub fn field(path: &Path, surface: &SurfaceArgs) -> Result<HeightField> {
    if !surface.z_scale.is_finite() {
        return Err(Error::setting("--z-scale", surface.z_scale.to_string(), "a finite number"));
    }
    let options =
        HeightOptions { cell_m: surface.cell, z_scale: surface.z_scale, nodata: surface.nodata };
    files::read_heights(path, &options)
}

pub fn scene(field: HeightField, surface: &SurfaceArgs, lights: &LightArgs) -> Result<Scene> {
    let albedo = match albedo_colour(&surface.albedo) {
        Some(colour) => Albedo::Constant(colour),
        None => files::read_albedo(Path::new(&surface.albedo), field.rows(), field.cols())?,
    };
    let environment = match &lights.env {
        // Clockwise in compass terms; counter-clockwise inside.
        Some(path) => Some(files::read_environment(path, -lights.env_rotate.to_radians())?),
        None => None,
    };
    let none = lights.sky.is_none() && environment.is_none() && lights.sun.is_empty();
    Ok(Scene {
        surface: Surface { albedo, border: border(surface) },
        lights: Lights {
            sky: if none { Some([1.0; 3]) } else { lights.sky },
            environment,
            suns: lights.sun.clone(),
        },
        field,
    })
}

pub fn border(surface: &SurfaceArgs) -> Border {
    match surface.border {
        BorderName::Plane => Border::Plane,
        BorderName::Open => Border::Open,
        BorderName::Periodic => Border::Periodic,
    }
}

pub fn quality(args: &QualityArgs) -> Result<Quality> {
    let quality = Quality {
        method: match args.method {
            MethodName::Auto => Method::Auto,
            MethodName::Sweep => Method::Sweep,
            MethodName::Brute => Method::Brute,
            MethodName::Pyramid => {
                return Err(Error::setting(
                    "--method",
                    "pyramid",
                    "auto, sweep or brute: pyramid is not yet there",
                ));
            }
        },
        azimuths: args.azimuths,
        sun_azimuths: args.sun_azimuths,
        lines: match args.lines {
            LinesName::Exact => Lines::Exact,
            LinesName::QuarterCell => Lines::QuarterCell,
            LinesName::HalfCell => Lines::HalfCell,
            LinesName::Cell => Lines::Cell,
            LinesName::TwoCells => Lines::TwoCells,
            LinesName::FourCells => Lines::FourCells,
        },
        fuse: match args.fuse {
            FuseName::Nearest => Fuse::Nearest,
            FuseName::Slopes => Fuse::Slopes,
            FuseName::Own => Fuse::Own,
            FuseName::AimedNearest => Fuse::AimedNearest,
            FuseName::Aimed => Fuse::Aimed,
        },
        precision: match args.precision {
            PrecisionName::F32 => Precision::F32,
            PrecisionName::F16 => Precision::F16,
            PrecisionName::Packed => Precision::Packed,
        },
        hull: match args.hull {
            HullName::Auto => Hull::Auto,
            HullName::Private => Hull::Private,
            HullName::Shared => Hull::Shared,
            HullName::List => Hull::List,
        },
        table_elevations: args.table_elevations,
    };
    quality.check()?;
    Ok(quality)
}

pub fn device(global: &GlobalArgs) -> Result<(Headless, Limits)> {
    let options = HeadlessOptions { device: global.device.clone(), validation: false };
    let gpu = Headless::new(&options)?;
    let mut limits = gpu.report().limits;
    if let Some(budget) = global.memory_budget {
        limits.memory_budget = budget;
    }
    Ok((gpu, limits))
}

/// Texels of a plan's inputs, in its order.
pub fn contents(scene: &Scene) -> Vec<Vec<f32>> {
    let opaque =
        |texels: &[[f32; 3]]| texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let mut all = vec![scene.field.heights_m().to_vec()];
    if let Some(environment) = &scene.lights.environment {
        all.push(opaque(environment.texels()));
    }
    if let Albedo::Map(map) = &scene.surface.albedo {
        all.push(opaque(map));
    }
    all
}

/// What was used and how long it took, for files' metadata and --json.
pub fn metadata(
    gpu: &Headless,
    field: &HeightField,
    plan: &Plan,
    times: &[Timing],
) -> Vec<(String, String)> {
    let report = gpu.report();
    let mut all = vec![
        ("ridgelight".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("device".to_owned(), report.name.clone()),
        ("driver".to_owned(), report.driver.clone()),
        ("rows".to_owned(), field.rows().to_string()),
        ("cols".to_owned(), field.cols().to_string()),
        ("cell_m".to_owned(), format!("{},{}", field.cell_m()[0], field.cell_m()[1])),
        ("base_m".to_owned(), field.base_m().to_string()),
        ("device_bytes".to_owned(), plan.bytes().to_string()),
    ];
    all.extend(plan.settings.iter().cloned());
    all.extend(plan.notes.iter().enumerate().map(|(i, n)| (format!("note{}", i + 1), n.clone())));
    let total: f64 = times.iter().map(|t| t.ns).sum();
    if !times.is_empty() {
        all.push(("gpu_ms".to_owned(), format!("{:.3}", total / 1e6)));
    }
    all
}

pub fn as_json(metadata: &[(String, String)], times: &[Timing]) -> serde_json::Value {
    let settings: serde_json::Map<_, _> =
        metadata.iter().map(|(k, v)| (k.clone(), serde_json::Value::from(v.clone()))).collect();
    let passes: Vec<_> =
        times.iter().map(|t| serde_json::json!({ "pass": t.label, "ns": t.ns })).collect();
    serde_json::json!({ "settings": settings, "passes": passes })
}

/// Replaces values of void samples, in every plane.
pub fn mask_voids(field: &HeightField, planes: &mut [f32], channels: usize) {
    if let Some(voids) = field.voids() {
        for (i, texel) in planes.chunks_mut(channels).enumerate() {
            if voids[i % voids.len()] {
                texel.fill(f32::NAN);
            }
        }
    }
}

pub fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// A file that cannot be written is found out before the work, not after it.
pub fn check_output(flag: &str, path: &Path, kinds: &[&str]) -> Result<()> {
    let found = extension(path);
    if !kinds.contains(&found.as_str()) {
        return Err(Error::setting(
            flag,
            path.display().to_string(),
            format!("a file ending in .{}", kinds.join(" or .")),
        ));
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Error::setting(
            flag,
            path.display().to_string(),
            format!("a folder {} that exists", folder.display()),
        ));
    }
    Ok(())
}
