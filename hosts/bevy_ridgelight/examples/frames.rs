//! Times Bevy frames without a window. `frames COUNT` prints two means in milliseconds: of COUNT frames with new heights in each, and
//! of COUNT frames without.

use std::time::Instant;

use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::renderer::RenderDevice;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_ridgelight::{FieldLight, HeightField, RidgelightPlugin, heights_image};

const SIZE: UVec2 = UVec2::new(64, 48);

fn heights() -> Image {
    let height = |i: u32| ((i / SIZE.x * 31 + i % SIZE.x * 17) % 7) as f32 - 3.0;
    heights_image(SIZE, &(0..SIZE.x * SIZE.y).map(height).collect::<Vec<_>>())
}

/// Draws `count` frames and waits for the device after each. Returns the mean time of a frame in milliseconds.
fn frame_ms(app: &mut App, count: u32, mut before: impl FnMut(&mut App)) -> f64 {
    let device = app.world().resource::<RenderDevice>().wgpu_device().clone();
    let begun = Instant::now();
    for _ in 0..count {
        before(app);
        app.update();
        device.poll(wgpu::PollType::wait_indefinitely()).expect("done");
    }
    begun.elapsed().as_secs_f64() * 1e3 / f64::from(count)
}

fn main() {
    let count = std::env::args().nth(1).and_then(|count| count.parse().ok());
    let Some(count) = count.filter(|count| *count > 0) else {
        eprintln!("usage: frames COUNT");
        std::process::exit(2);
    };
    let mut app = App::new();
    let window =
        WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
    // Rendered on the same thread: a frame is submitted when its update returns.
    let plugins = DefaultPlugins.set(window).set(render);
    let plugins = plugins.disable::<WinitPlugin>().disable::<PipelinedRenderingPlugin>();
    app.add_plugins((plugins, RidgelightPlugin));
    app.finish();
    app.cleanup();
    let image = app.world_mut().resource_mut::<Assets<Image>>().add(heights());
    let mut field = HeightField::new(image.clone(), SIZE, Vec2::ONE);
    field.azimuths = ridgelight::scene::Quality::default().azimuths;
    let light = FieldLight::new(&field, &mut app.world_mut().resource_mut::<Assets<Image>>());
    let sun = Transform::default().looking_to(Vec3::new(-0.75_f32.sqrt(), -0.5, 0.0), Vec3::Y);
    app.world_mut().spawn((field, light));
    app.world_mut().spawn((DirectionalLight::default(), sun));
    let renew = |app: &mut App| {
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        images.insert(&image, heights()).expect("replaced");
    };
    frame_ms(&mut app, 20, renew);
    let with = frame_ms(&mut app, count, renew);
    let without = frame_ms(&mut app, count, |_| {});
    println!("{with:.4} {without:.4}");
}
