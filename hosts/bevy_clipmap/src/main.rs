//! Renders terrain with bevy-clipmap and horizons from `ridgelight horizon --fourier`.
//!
//! `view` writes a perspective picture. `map` renders from straight above, one pixel per texel, once with these horizons and
//! once with horizons of 0. The ratio of the two is the shadow, independent of slope, colour and exposure. `map` compares
//! it with the horizons of an .npy.

use std::process::ExitCode;

use bevy::app::AppExit;
use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, ScalingMode};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::image::{CompressedImageFormats, ImageSampler, ImageType};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::window::WindowResolution;
use bevy_clipmap::{Clipmap, ClipmapPlugin};

const USAGE: &str = "usage: bevy_clipmap_host map|view HEIGHTS.png CELL AZIMUTH,ELEVATION HORIZON.ktx2 COEFFICIENTS \
HORIZONS.npy|PICTURE.png

  HEIGHTS.png   16 bits, in metres; CELL: metres between grid points
  AZIMUTH,ELEVATION   of the sun: whole compass degrees, and degrees
  HORIZONS.npy  elevations at 360 azimuths, with map; PICTURE.png, with view";
/// Frames before the screenshot: new grids and pipelines are ready only some frames later.
const FRAMES: u32 = 40;
/// Elevation range over which bevy-clipmap's shader fades the sun in, radians.
const PENUMBRA: f64 = 0.3;
/// Largest error of sRGB encoding, in 8-bit codes: 0.6 (Direct3D 11.3 Functional Specification, FLOAT to SRGB).
const CODE: f64 = 0.6;
/// Azimuths of the exact horizons.
const AZIMUTHS: usize = 360;
/// Pixels of the view.
const VIEW: UVec2 = UVec2::new(768, 432);
/// Compass azimuth and elevation of the camera from the middle, degrees, its distance over the field's width, and its vertical field
/// of view, degrees. hosts/bevy_clipmap/check gives the command line the same.
const CAMERA: [f32; 4] = [200.0, 30.0, 0.55, 30.0];

#[derive(Resource, Clone)]
struct Wanted {
    is_map: bool,
    size: UVec2,
    heights: Vec<u16>,
    cell: f32,
    sun: Vec2,
    horizon: Vec<u8>,
    coefficients: u32,
    output: String,
}

/// Frames since the clipmap was last made, and the picture with horizons of 0.
#[derive(Resource, Default)]
struct Drawn {
    frames: u32,
    flat: Option<Vec<u8>>,
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let wanted = match wanted(&args) {
        Ok(wanted) => wanted,
        Err(error) => {
            eprintln!("{error}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let size = if wanted.is_map { wanted.size } else { VIEW };
    let window = Window {
        resolution: WindowResolution::new(size.x, size.y).with_scale_factor_override(1.0),
        ..default()
    };
    // A program that ends while a driver compiles may abort.
    let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
    let window = WindowPlugin { primary_window: Some(window), ..default() };
    let plugins = DefaultPlugins.set(window).set(render);
    // Nor may a thread still render when it ends.
    let plugins = plugins.disable::<PipelinedRenderingPlugin>();
    let exit = App::new()
        .add_plugins((plugins, ClipmapPlugin))
        .insert_resource(GlobalAmbientLight { brightness: 0.0, ..default() })
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(wanted)
        .init_resource::<Drawn>()
        .add_systems(Startup, setup)
        .add_systems(Last, draw)
        .run();
    match exit {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(code) => ExitCode::from(code.get()),
    }
}

fn wanted(args: &[String]) -> Result<Wanted, String> {
    let [kind, heights, cell, sun, horizon, coefficients, output] = args else {
        return Err("7 arguments are expected".into());
    };
    let number = |text: &str| text.parse::<f32>().map_err(|error| format!("{text}: {error}"));
    let file = |path: &String| format!("{path}: ");
    let (azimuth, elevation) = sun.split_once(',').ok_or("AZIMUTH,ELEVATION")?;
    let image = image::open(heights).map_err(|error| file(heights) + &error.to_string())?;
    let image = image.into_luma16();
    Ok(Wanted {
        is_map: kind == "map",
        size: UVec2::new(image.width(), image.height()),
        heights: image.into_raw(),
        cell: number(cell)?,
        sun: Vec2::new(number(azimuth)?, number(elevation)?),
        horizon: std::fs::read(horizon).map_err(|error| file(horizon) + &error.to_string())?,
        coefficients: coefficients.parse().map_err(|error| format!("{coefficients}: {error}"))?,
        output: output.clone(),
    })
}

/// A direction from compass azimuth and elevation, degrees: +X is east, +Z south.
fn direction(azimuth: f32, elevation: f32) -> Vec3 {
    let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
    Vec3::new(elevation.cos() * azimuth.sin(), elevation.sin(), -elevation.cos() * azimuth.cos())
}

fn setup(mut commands: Commands, wanted: Res<Wanted>) {
    let to_sun = direction(wanted.sun.x, wanted.sun.y);
    commands.spawn((
        DirectionalLight { illuminance: 10_000.0, shadows_enabled: false, ..default() },
        Transform::default().looking_to(-to_sun, Vec3::Y),
    ));
    let [_, max] = bounds(&wanted.heights);
    let width = wanted.size.x as f32 * wanted.cell;
    // Any exposure works for the ratio if no pixel clips.
    let camera = (Camera3d::default(), Tonemapping::None, DebandDither::Disabled, Msaa::Off);
    let target = if wanted.is_map {
        let projection = OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: wanted.size.y as f32 * wanted.cell,
            },
            far: 2.0 * max + 1000.0,
            ..OrthographicProjection::default_3d()
        };
        let above = Transform::from_xyz(0.0, max + 500.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
        commands.spawn((camera, Projection::from(projection), Exposure { ev100: 11.5 }, above)).id()
    } else {
        let [azimuth, elevation, distance, fov] = CAMERA;
        let middle = Vec3::new(0.0, middle(&wanted), 0.0);
        let eye = middle + direction(azimuth, elevation) * distance * width;
        let projection =
            PerspectiveProjection { fov: fov.to_radians(), far: 10.0 * width, ..default() };
        let from = Transform::from_translation(eye).looking_at(middle, Vec3::Y);
        commands.spawn((camera, Projection::from(projection), Exposure { ev100: 11.5 }, from)).id()
    };
    commands.insert_resource(Target(target));
}

#[derive(Resource)]
struct Target(Entity);

fn bounds(heights: &[u16]) -> [f32; 2] {
    let [low, high] = [heights.iter().min(), heights.iter().max()];
    [low, high].map(|height| f32::from(*height.expect("a texel")))
}

/// The height at the middle of the grid.
fn middle(wanted: &Wanted) -> f32 {
    let UVec2 { x, y } = wanted.size / 2;
    f32::from(wanted.heights[(y * wanted.size.x + x) as usize])
}

/// A clipmap with the file's horizons, or with horizons of 0.
fn clipmap(wanted: &Wanted, target: Entity, images: &mut Assets<Image>, is_flat: bool) -> Clipmap {
    let usage = RenderAssetUsages::RENDER_WORLD;
    let extent = |layers| Extent3d {
        width: wanted.size.x,
        height: wanted.size.y,
        depth_or_array_layers: layers,
    };
    let [min, max] = bounds(&wanted.heights);
    let heights = wanted.heights.iter().map(|height| (f32::from(*height) - min) / (max - min));
    let heights: Vec<u8> = heights.flat_map(f32::to_le_bytes).collect();
    let plane = TextureDimension::D2;
    let mut heightmap = Image::new(extent(1), plane, heights, TextureFormat::R32Float, usage);
    heightmap.sampler = ImageSampler::linear();
    let one = Extent3d { width: 1, height: 1, depth_or_array_layers: 1 };
    let color = Image::new(one, plane, vec![255; 4], TextureFormat::Rgba8UnormSrgb, usage);
    let read = Image::from_buffer(
        &wanted.horizon,
        ImageType::Extension("ktx2"),
        CompressedImageFormats::NONE,
        false,
        ImageSampler::linear(),
        usage,
    );
    let mut horizon = read.expect("a KTX2 file");
    if is_flat {
        horizon.data = horizon.data.map(|bytes| vec![0; bytes.len()]);
    }
    Clipmap {
        half_width: 128,
        // The coarsest level reaches half_width * 2^(levels - 1) * base_scale = 32.8 km from the camera. The far edge of the field
        // lies 19.4 km from the camera of the view. With another `base_scale`, bevy-clipmap 1.0.4 does not draw parts of the
        // coarser levels.
        levels: 9,
        base_scale: 1.0,
        texel_size: wanted.cell,
        target,
        color: images.add(color),
        heightmap: images.add(heightmap),
        horizon: images.add(horizon),
        horizon_coeffs: wanted.coefficients,
        min,
        max,
        wireframe: false,
    }
}

fn draw(
    mut commands: Commands,
    wanted: Res<Wanted>,
    target: Res<Target>,
    mut drawn: ResMut<Drawn>,
    mut images: ResMut<Assets<Image>>,
    clipmaps: Query<Entity, With<Clipmap>>,
) {
    if drawn.frames == 0 {
        let is_flat = wanted.is_map && drawn.flat.is_none();
        clipmaps.iter().for_each(|old| commands.entity(old).despawn());
        commands.spawn(clipmap(&wanted, target.0, &mut images, is_flat));
    }
    drawn.frames += 1;
    if drawn.frames == FRAMES {
        commands.spawn(Screenshot::primary_window()).observe(taken);
    }
}

fn taken(
    taken: On<ScreenshotCaptured>,
    wanted: Res<Wanted>,
    mut drawn: ResMut<Drawn>,
    mut exit: MessageWriter<AppExit>,
) {
    let picture = taken.image.clone().try_into_dynamic().expect("a picture").to_rgb8();
    let result = if !wanted.is_map {
        picture.save(&wanted.output).map_err(|error| error.to_string())
    } else if let Some(flat) = &drawn.flat {
        compare(&wanted, flat, &picture)
    } else {
        *drawn = Drawn { frames: 0, flat: Some(picture.into_raw()) };
        return;
    };
    match result {
        Ok(()) => exit.write(AppExit::Success),
        Err(error) => {
            eprintln!("{}: {error}", wanted.output);
            exit.write(AppExit::error())
        }
    };
}

/// Linear light of an sRGB code, which need not be whole.
fn linear(code: f64) -> f64 {
    let value = (code / 255.0).clamp(0.0, 1.0);
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The shader's share of the sun above a horizon.
fn share(horizon: f64, elevation: f64) -> f64 {
    let t = ((elevation - horizon) / PENUMBRA).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Compares the rendered shadow with that of the truncated series, and the series with the exact horizons.
fn compare(wanted: &Wanted, flat: &[u8], shadowed: &[u8]) -> Result<(), String> {
    let bytes = std::fs::read(&wanted.output).map_err(|error| error.to_string())?;
    let header = bytes.get(8..10).map_or(0, |b| usize::from(u16::from_le_bytes([b[0], b[1]])));
    let all = bytes.get(10 + header..).unwrap_or_default();
    let texels = wanted.heights.len();
    if [all.len() / AZIMUTHS / 4, flat.len() / 3, shadowed.len() / 3] != [texels; 3] {
        let found = [all.len() / AZIMUTHS, flat.len(), shadowed.len()];
        return Err(format!(
            "found {found:?} bytes (one azimuth of HORIZONS.npy, two pictures), expected 4, 3 and 3 for each of {texels} texels"
        ));
    }
    let of_sun = wanted.sun.x as usize % AZIMUTHS;
    let (mut exact, mut series) = (vec![0.0; texels], vec![0.0; texels]);
    for (azimuth, plane) in all.chunks_exact(4 * texels).enumerate() {
        let turn = (azimuth as f64 - of_sun as f64) * std::f64::consts::TAU / AZIMUTHS as f64;
        // The mean and these frequencies of the transform over azimuth.
        let held: f64 = (1..=wanted.coefficients / 2).map(|k| (f64::from(k) * turn).cos()).sum();
        let weight = (1.0 + 2.0 * held) / AZIMUTHS as f64;
        for (i, bytes) in plane.chunks_exact(4).enumerate() {
            let elevation = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]).max(0.0);
            series[i] += weight * f64::from(elevation).tan();
            if azimuth == of_sun {
                exact[i] = f64::from(elevation);
            }
        }
    }
    let series: Vec<f64> = series.iter().map(|tangent| tangent.max(0.0).atan()).collect();
    let elevation = f64::from(wanted.sun.y).to_radians();
    let whole = share(0.0, elevation);
    let [width, height] = [wanted.size.x as usize, wanted.size.y as usize];
    let (mut compared, mut beyond, mut found_error, mut series_error) =
        (0_usize, 0_usize, 0.0, 0.0);
    for i in 0..texels {
        let [bright, dark] = [flat, shadowed].map(|picture| f64::from(picture[3 * i + 1]));
        let (row, col) = (i / width, i % width);
        let is_inner = (1..width - 1).contains(&col) && (1..height - 1).contains(&row);
        // Skips the border, clipped pixels, and pixels so dark that one code is a large relative error.
        if !is_inner || !(60.0..255.0).contains(&bright) {
            continue;
        }
        // lavapipe's sampler rounds positions to 1/256 of a texel (subTexelPrecisionBits is 8). Vulkan allows atan an error
        // of 4096 ULP.
        let around = [i - 1, i + 1, i - width, i + width];
        let steepest = around.iter().map(|n| (series[*n] - series[i]).abs()).fold(0.0, f64::max);
        let moved = steepest / 256.0 + 4096.0 * f64::from(f32::EPSILON) * (series[i] + elevation);
        let least = linear(dark - CODE) / linear(bright + CODE) * whole;
        let most = linear(dark + CODE) / linear(bright - CODE) * whole;
        let is_within = share(series[i] + moved, elevation) <= most
            && share(series[i] - moved, elevation) >= least;
        compared += 1;
        beyond += usize::from(!is_within);
        let found = linear(dark) / linear(bright) * whole;
        found_error += (found - share(series[i], elevation)).powi(2);
        series_error += (share(series[i], elevation) - share(exact[i], elevation)).powi(2);
    }
    let [found_error, series_error] =
        [found_error, series_error].map(|sum| (sum / compared as f64).sqrt());
    println!(
        "{compared} of {texels} texels compared; share of the sun: RMS error of the picture against the series \
         {found_error:.4}, {beyond} texels beyond the tolerance; RMS error of the series against exact horizons \
         {series_error:.4}"
    );
    if 4 * compared < 3 * texels || beyond > 0 {
        return Err(format!(
            "found {beyond} texels beyond the tolerance and {compared} of {texels} compared; expected 0 and at least three quarters"
        ));
    }
    Ok(())
}
