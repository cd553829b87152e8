//! Dunes that travel under a sun that moves, in a window. `dunes FRAMES PICTURE.png` draws that many frames, prints their mean
//! time, writes the window's picture and ends.

use std::time::Instant;

use bevy::app::AppExit;
use bevy::camera::Exposure;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy_ridgelight::{FieldLight, HeightField, RidgelightPlugin, TerrainMaterial, heights_image};

const SIZE: UVec2 = UVec2::new(256, 256);
const CELL: f32 = 2.0;

/// Heights of the dunes after some seconds: ridges across the wind that lean with it.
fn heights(seconds: f32) -> Vec<f32> {
    let at = |i: u32| {
        let at = Vec2::new((i % SIZE.x) as f32, (i / SIZE.x) as f32) * CELL;
        let bend = 14.0 * (at.y / 47.0).sin() + 9.0 * (at.y / 19.0 + at.x / 160.0).sin();
        let phase = (at.x + bend - 6.0 * seconds) / 64.0;
        let along = phase - phase.floor();
        let slope = if along < 0.75 { along / 0.75 } else { (1.0 - along) / 0.25 };
        let tall = 0.7 + 0.3 * (at.y / 71.0 + phase.floor()).sin();
        14.0 * tall * slope * slope * (3.0 - 2.0 * slope)
    };
    (0..SIZE.x * SIZE.y).map(at).collect()
}

/// Frames to draw, where the program ends by itself, and the time of the first.
#[derive(Resource)]
struct Ending {
    frames: u32,
    picture: String,
    drawn: u32,
    begun: Instant,
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let ending = match &args[..] {
        [] => None,
        [frames, picture] if frames.parse::<u32>().is_ok_and(|frames| frames > 1) => {
            let frames = frames.parse().unwrap_or_default();
            Some(Ending { frames, picture: picture.clone(), drawn: 0, begun: Instant::now() })
        }
        _ => {
            eprintln!("usage: dunes [FRAMES PICTURE.png], with FRAMES at least 2");
            std::process::exit(2);
        }
    };
    // Otherwise Bevy compiles beside the first frames, and draws without what is not compiled.
    let render = RenderPlugin { synchronous_pipeline_compilation: ending.is_some(), ..default() };
    let mut app = App::new();
    app.add_plugins((DefaultPlugins.set(render), RidgelightPlugin))
        .insert_resource(GlobalAmbientLight {
            color: Color::srgb(0.6, 0.75, 1.0),
            brightness: 4000.0,
            ..default()
        })
        .insert_resource(ClearColor(Color::srgb(0.65, 0.75, 0.9)))
        .add_systems(Startup, setup)
        .add_systems(Update, (travel, turn));
    if let Some(ending) = ending {
        app.insert_resource(ending).add_systems(Last, end);
    }
    app.run();
}

fn setup(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<TerrainMaterial>>,
) {
    let heights = images.add(heights_image(SIZE, &heights(0.0)));
    let field = HeightField::new(heights, SIZE, Vec2::splat(CELL));
    let light = FieldLight::new(&field, &mut images);
    let material = TerrainMaterial::new(&field, &light).with_colour(Color::srgb(0.87, 0.72, 0.5));
    let material = MeshMaterial3d(materials.add(material));
    commands.spawn((Mesh3d(meshes.add(field.mesh())), material, field, light));
    commands.spawn((
        DirectionalLight { color: Color::srgb(1.0, 0.93, 0.8), illuminance: 90_000.0, ..default() },
        Transform::default(),
    ));
    let centre = Vec3::new(SIZE.x as f32, 0.0, SIZE.y as f32) * (0.5 * CELL);
    commands.spawn((
        Camera3d::default(),
        Tonemapping::Reinhard,
        Exposure { ev100: 14.0 },
        Transform::from_translation(centre + Vec3::new(-60.0, 130.0, 330.0))
            .looking_at(centre, Vec3::Y),
    ));
}

/// New heights, written by the host as any Bevy image.
fn travel(time: Res<Time>, fields: Query<&HeightField>, mut images: ResMut<Assets<Image>>) {
    for field in &fields {
        let image = heights_image(SIZE, &heights(time.elapsed_secs()));
        if images.insert(&field.heights, image).is_err() {
            warn!("the image of heights is gone");
        }
    }
}

/// From east to west over the south in 40 seconds, 8 to 60 degrees high, from the morning on.
fn turn(time: Res<Time>, mut lights: Query<&mut Transform, With<DirectionalLight>>) {
    let way = (time.elapsed_secs() / 40.0 + 0.12).fract();
    let elevation = (8.0 + 52.0 * (std::f32::consts::PI * way).sin()).to_radians();
    let azimuth = (-180.0 * way).to_radians();
    let to_sun = Vec3::new(
        elevation.cos() * azimuth.cos(),
        elevation.sin(),
        -elevation.cos() * azimuth.sin(),
    );
    for mut light in &mut lights {
        *light = Transform::default().looking_to(-to_sun, Vec3::Y);
    }
}

fn end(mut ending: ResMut<Ending>, mut commands: Commands) {
    // The first frame compiles pipelines.
    if ending.drawn == 1 {
        ending.begun = Instant::now();
    }
    ending.drawn += 1;
    if ending.drawn == ending.frames {
        let ms = ending.begun.elapsed().as_secs_f64() * 1e3 / f64::from(ending.frames - 1);
        println!("{ms:.1} ms a frame");
        let picture = ending.picture.clone();
        commands.spawn(Screenshot::primary_window()).observe(
            move |taken: On<ScreenshotCaptured>, mut exit: MessageWriter<AppExit>| {
                let image = taken.image.clone().try_into_dynamic().map(|image| image.to_rgb8());
                if let Ok(image) = &image
                    && image.pixels().all(|pixel| pixel == image.get_pixel(0, 0))
                {
                    eprintln!("{picture}: all pixels have one colour");
                    exit.write(AppExit::error());
                    return;
                }
                match image.map(|image| image.save(&picture)) {
                    Ok(Ok(())) => exit.write(AppExit::Success),
                    Ok(Err(error)) => {
                        eprintln!("{picture}: {error}");
                        exit.write(AppExit::error())
                    }
                    Err(error) => {
                        eprintln!("{picture}: {error}");
                        exit.write(AppExit::error())
                    }
                };
            },
        );
    }
}
