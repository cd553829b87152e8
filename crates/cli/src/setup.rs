//! From arguments to scenes, qualities and devices.

mod settings_used;

use ridgelight::gpu::{self, Headless, HeadlessOptions};
use ridgelight::plan::{Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Basis, Border, Fuse, HeightField, Hull, Levels, LightBasis, Lights, Lines, Lobe,
    Method, Precision, Quality, Receiver, Scene, Surface, Wedges, Window,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use std::path::{Path, PathBuf};

use crate::args::{
    BasisName, BorderName, FieldArgs, FuseName, GlobalArgs, HullName, Layer, LevelsName, LightArgs,
    LightBasisName, LinesName, MethodName, PhongArg, PrecisionName, QualityArgs, ReceiverName,
    SubsampleName, SurfaceArgs, WedgesName, WindowName, albedo_colour,
};
pub use settings_used::{as_json, asked, metadata, typed};

/// How a command ended that did not fail.
pub enum Outcome {
    Done,
    /// A comparison beyond its bound.
    Beyond,
    /// FileNotes to end early; what it had is written.
    Interrupted,
}

/// Every Vulkan device has images of this side.
const LEAST_SIDE: usize = 4096;

/// Refuses a field that the device cannot hold by its header, before its samples are read. What is no
/// field and where there is no device is told later.
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

pub fn field(path: &Path, surface: &FieldArgs, global: &GlobalArgs) -> Result<HeightField> {
    if !surface.z_scale.is_finite() || surface.z_scale == 0.0 {
        let expected = "a finite number other than 0";
        return Err(Error::setting("--z-scale", surface.z_scale.to_string(), expected));
    }
    let options =
        HeightOptions { cell_m: surface.cell, z_scale: surface.z_scale, nodata: surface.nodata };
    check_size(path, global)?;
    files::read_heights(path, &options)
}

pub fn scene(field: HeightField, surface: &SurfaceArgs, lights: &LightArgs) -> Result<Scene> {
    let albedo = match albedo_colour(&surface.albedo) {
        Some(colour) => Albedo::Constant(colour),
        None => files::read_albedo(Path::new(&surface.albedo), field.rows(), field.cols())?,
    };
    let phong = match &surface.phong {
        None => None,
        Some(PhongArg::Constant(phong)) => Some(Lobe::Constant(*phong)),
        Some(PhongArg::File(path)) => Some(files::read_lobes(path, field.rows(), field.cols())?),
    };
    let environment = match &lights.env {
        // Clockwise in compass terms; counter-clockwise inside.
        Some(path) => Some(files::read_environment(path, -lights.env_rotate.to_radians())?),
        None => None,
    };
    Ok(Scene {
        surface: Surface { albedo, border: border(&surface.field), phong },
        lights: Lights {
            sky: if lights.is_empty() { Some([1.0; 3]) } else { lights.sky },
            environment,
            suns: lights.sun.clone(),
            keys: lights.key.clone(),
            spheres: lights.light.clone(),
        },
        field,
    })
}

pub fn border(surface: &FieldArgs) -> Border {
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
            MethodName::Pyramid => Method::Pyramid,
        },
        azimuths: args.azimuths,
        sun_azimuths: args.sun_azimuths,
        light_cutoff: args.light_cutoff,
        light_basis: match args.light_basis {
            LightBasisName::Exact => LightBasis::Exact,
            LightBasisName::Sh => LightBasis::Sh,
        },
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
            FuseName::AimedAround => Fuse::AimedAround,
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
        level_step: args.level_step,
        level_offset: args.level_offset,
        levels: match args.levels {
            LevelsName::Stack => Levels::Stack,
            LevelsName::Pyramid => Levels::Pyramid,
        },
        table_elevations: args.table_elevations,
        basis: match args.basis {
            BasisName::Auto => Basis::Auto,
            BasisName::Table => Basis::Table,
            BasisName::Sh => Basis::Sh,
        },
        sh_order: args.sh_order,
        wedges: match args.wedges {
            WedgesName::Slices => Wedges::Slices,
            WedgesName::Nlp => Wedges::Nlp,
            WedgesName::Table => Wedges::Table,
        },
        receiver: match args.receiver {
            ReceiverName::Plane => Receiver::Plane,
            ReceiverName::Lobe => Receiver::Lobe,
        },
        window: match args.window {
            WindowName::None => Window::None,
            WindowName::Lanczos => Window::Lanczos,
            WindowName::Hann => Window::Hann,
            WindowName::Nonnegative => Window::Nonnegative,
        },
        subsample: match args.subsample {
            SubsampleName::One => 1,
            SubsampleName::Two => 2,
            SubsampleName::Four => 4,
        },
        wedge_side: args.wedge_side,
        bounces: args.bounces.bounces()?,
    };
    quality.check()?;
    Ok(quality)
}

/// Refuses a lobe where light is judged by a truth without one.
pub fn check_diffuse(scene: &Scene, what: &str) -> Result<()> {
    match scene.surface.phong {
        None => Ok(()),
        Some(_) => Err(Error::setting(
            format!("--phong with {what}"),
            "a lobe",
            "none: what it judges light by is diffuse; `reference` and `compare` judge lobes",
        )),
    }
}

/// What is wrong with a request whatever the device: planned for one without limits, so that it is
/// said before a device is opened.
pub fn check_plan(global: &GlobalArgs, plan: impl Fn(&Limits) -> Result<Plan>) -> Result<()> {
    let budget = global.memory_budget.unwrap_or(1 << 50).min(1 << 50);
    plan(&Limits::boundless(true, budget))
        .or_else(|_| plan(&Limits::boundless(false, budget)))
        .map(drop)
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

/// What a picture of one frame holds.
pub fn wanted(layers: &[Layer]) -> Picture {
    Picture {
        light_layers: layers.contains(&Layer::Lights),
        sky_view: layers.contains(&Layer::SkyView),
        still: true,
        ..Picture::default()
    }
}

/// The files that a command reads.
pub fn inputs<'a>(
    field: &'a Path,
    lights: &'a LightArgs,
    surface: &'a SurfaceArgs,
) -> Vec<&'a Path> {
    let albedo = albedo_colour(&surface.albedo).is_none().then_some(Path::new(&surface.albedo));
    let phong = match &surface.phong {
        Some(PhongArg::File(path)) => Some(path.as_path()),
        _ => None,
    };
    [Some(field), lights.env.as_deref(), albedo, phong].into_iter().flatten().collect()
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
    if path.is_dir() {
        return Err(Error::setting(flag, format!("the directory {}", path.display()), "a file"));
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Error::setting(
            flag,
            path.display().to_string(),
            format!("a folder {} that exists", folder.display()),
        ));
    }
    files::check_writable(path)
}

/// No output may be another's, or an input: it would be lost.
pub fn check_distinct(outputs: &[(&str, Option<&Path>)], inputs: &[&Path]) -> Result<()> {
    let place = |path: &Path| -> Option<PathBuf> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        path.canonicalize()
            .ok()
            .or_else(|| Some(folder.canonicalize().ok()?.join(path.file_name()?)))
    };
    let mut taken: Vec<(&str, Option<PathBuf>)> =
        inputs.iter().map(|path| ("the input", place(path))).collect();
    for (flag, path) in outputs {
        let Some(path) = path else { continue };
        let here = place(path);
        if let Some((other, _)) = taken.iter().find(|(_, p)| p.is_some() && *p == here) {
            let found = format!("{}, which is {other}", path.display());
            return Err(Error::setting(*flag, found, "a file of its own"));
        }
        taken.push((flag, here));
    }
    Ok(())
}

/// Settings that the library names its own way, by the flags that their user wrote.
pub fn in_flags(error: Error) -> Error {
    const FLAGS: [(&str, &str); 22] = [
        ("sky radiance", "--sky"),
        ("sun ", "--sun "),
        ("key ", "--key "),
        ("light ", "--light "),
        ("phong", "--phong"),
        ("albedo", "--albedo"),
        ("cell_m", "--cell"),
        ("z_scale", "--z-scale"),
        ("environment rotation", "--env-rotate"),
        ("distances to the horizon", "--distances"),
        ("lights", "--sky, --env, --sun, --key, --light"),
        ("cell size", "--cell"),
        ("pixels per degree", "--pixels-per-degree"),
        ("camera: look-at point", "--look-at"),
        ("camera: field of view", "--fov"),
        ("camera", "--camera"),
        ("samples a pixel", "--samples"),
        ("picture size", "--size"),
        ("mesh step", "--mesh-step"),
        ("background", "--background"),
        ("directions", "--directions"),
        ("curvatures of ellipses", "--curvature"),
    ];
    match error {
        Error::Setting { name, found, expected } => {
            let named = FLAGS.iter().find_map(|(ours, flag)| {
                name.strip_prefix(ours).map(|rest| format!("{flag}{rest}"))
            });
            Error::Setting { name: named.unwrap_or(name), found, expected }
        }
        other => other,
    }
}
