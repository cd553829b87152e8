//! The light in Bevy's images and pictures, without a window, beside that of the core on the same driver.

use std::sync::{Arc, Mutex};

use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, RenderTarget, ScalingMode};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages};
use bevy::render::renderer::RenderDevice;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_ridgelight::{
    FieldLight, HeightEdit, HeightField, RidgelightPlugin, Submissions, TerrainMaterial,
    heights_image,
};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{self, Lights, Quality, Scene, Surface};

/// Rows of a multiple of 256 bytes, which a readback would pad otherwise.
const SIZE: UVec2 = UVec2::new(128, 80);
const CELL: Vec2 = Vec2::new(10.0, 8.0);

/// Hills of several sizes.
fn heights() -> Vec<f32> {
    let at = |i: u32| {
        let [x, y] = [(i % SIZE.x) as f32, (i / SIZE.x) as f32];
        let wave =
            |length: f32, turn: f32| (x * turn.cos() / length + y * turn.sin() / length).sin();
        60.0 * wave(14.0, 0.4) * wave(11.0, 2.0) + 12.0 * wave(3.1, 1.1) + 90.0
    };
    (0..SIZE.x * SIZE.y).map(at).collect()
}

fn sun_at(azimuth: f32, elevation: f32) -> Transform {
    let [azimuth, elevation] = [azimuth, elevation].map(f32::to_radians);
    let to_sun = Vec3::new(
        elevation.cos() * azimuth.cos(),
        elevation.sin(),
        -elevation.cos() * azimuth.sin(),
    );
    Transform::default().looking_to(-to_sun, Vec3::Y)
}

/// The core's light of a scene: the layers of the sun and of the sky.
fn expected(heights: &[f32], azimuth: f32, elevation: f32) -> [Vec<f32>; 2] {
    // As Bevy has it after its transforms were propagated.
    let to_sun = *GlobalTransform::from(sun_at(azimuth, elevation)).back();
    let sun = scene::Sun {
        azimuth_rad: f64::from((-to_sun.z).atan2(to_sun.x)),
        elevation_rad: f64::from(to_sun.y).asin(),
        diameter_rad: f64::from(0.53_f32.to_radians()),
        irradiance: [1.0; 3],
    };
    let [rows, cols] = [SIZE.y as usize, SIZE.x as usize];
    let field =
        scene::HeightField::unknown(rows, cols, CELL.to_array().map(f64::from)).expect("a field");
    let lights = Lights { sky: Some([1.0; 3]), suns: vec![sun], ..Lights::default() };
    let scene = Scene { field, surface: Surface::default(), lights };
    let quality = Quality { azimuths: 32, ..Quality::default() };
    let mut gpu = Headless::new(&HeadlessOptions::default()).expect("a device");
    let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(&scene, &quality, &gpu.report().limits, wanted).expect("a plan");
    let names: Vec<_> = plan.outputs().map(|(_, output)| output.name.clone()).collect();
    let mut frame = gpu.frame(plan, &[heights]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let layers = ["direct.sun1", "direct.sky"].map(|name| {
        let output = names.iter().position(|n| n == name).expect("a layer");
        gpu.pixels(&frame, output).expect("texels").values
    });
    gpu.end(frame);
    layers
}

/// Bevy without a window.
fn app() -> App {
    let mut app = App::new();
    let window =
        WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
    app.add_plugins(DefaultPlugins.set(window).set(render).disable::<WinitPlugin>())
        .add_plugins(RidgelightPlugin);
    app.finish();
    app.cleanup();
    app
}

/// Waits for the queue. wgpu waits only seconds when it is dropped, and then panics.
fn end(app: &App) {
    let device = app.world().resource::<RenderDevice>().wgpu_device();
    device.poll(wgpu::PollType::wait_indefinitely()).expect("done");
}

fn spawn(
    app: &mut App,
    heights: &[f32],
    change: impl FnOnce(&mut HeightField),
) -> (Entity, FieldLight) {
    let world = app.world_mut();
    let image = world.resource_mut::<Assets<Image>>().add(heights_image(SIZE, heights));
    let mut field = HeightField::new(image, SIZE, CELL);
    change(&mut field);
    let light = FieldLight::new(&field, &mut world.resource_mut::<Assets<Image>>());
    let mesh = world.resource_mut::<Assets<Mesh>>().add(field.mesh());
    let material = TerrainMaterial::new(&field, &light);
    let material = world.resource_mut::<Assets<TerrainMaterial>>().add(material);
    let entity = world.spawn((Mesh3d(mesh), MeshMaterial3d(material), field, light.clone())).id();
    (entity, light)
}

/// The bytes of an image after some frames.
fn bytes(app: &mut App, image: &Handle<Image>) -> Vec<u8> {
    // A frame to take the change, one to draw it.
    for _ in 0..3 {
        app.update();
    }
    end(app);
    let found = Arc::new(Mutex::new(None));
    let into = found.clone();
    let reader = app
        .world_mut()
        .spawn(Readback::texture(image.clone()))
        .observe(move |read: On<ReadbackComplete>| *into.lock().unwrap() = Some(read.data.clone()))
        .id();
    for _ in 0..100 {
        // The queue is done in each, so that their number does not depend on the machine.
        app.update();
        end(app);
        if found.lock().unwrap().is_some() {
            break;
        }
    }
    app.world_mut().despawn(reader);
    let bytes = found.lock().unwrap().take();
    bytes.expect("read within 100 frames")
}

fn floats(app: &mut App, image: &Handle<Image>) -> Vec<f32> {
    let bytes = bytes(app, image);
    bytes.as_chunks::<4>().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
}

fn same_bits(found: &[f32], expected: &[f32], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let differ = found.iter().zip(expected).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert_eq!(differ, 0, "{what}: {differ} of {} texels differ, by {worst}", found.len());
}

/// Raises a rectangle, as an edit.
fn raise(heights: &mut [f32], field: Entity, corner: UVec2, size: UVec2) -> HeightEdit {
    let mut raised = Vec::new();
    for row in corner.y..corner.y + size.y {
        for col in corner.x..corner.x + size.x {
            let height = &mut heights[(row * SIZE.x + col) as usize];
            *height += 80.0;
            raised.push(*height);
        }
    }
    HeightEdit { field, corner, size, heights: raised }
}

/// Bit for bit the core's: at first, after the sun has moved a little and far, after edits, in other images, after a wrong
/// image, and of new heights.
///
/// It logs two errors of the field, one for each refusal, though the sun moves meanwhile: `check` counts them.
#[test]
fn light_is_that_of_the_core() {
    let mut app = app();
    let mut heights = heights();
    let (entity, light) = spawn(&mut app, &heights, |_| {});
    let sun = app.world_mut().spawn((DirectionalLight::default(), sun_at(140.0, 25.0))).id();
    for (azimuth, elevation) in [(140.0, 25.0), (141.0, 26.0), (300.0, 40.0)] {
        *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(azimuth, elevation);
        let [of_sun, of_sky] = expected(&heights, azimuth, elevation);
        let moved = format!("sun at {azimuth}");
        same_bits(&floats(&mut app, &light.sun), &of_sun, &moved);
        same_bits(&floats(&mut app, &light.sky_view), &of_sky, &moved);
    }
    let before = heights.clone();
    let submissions = app.world().resource::<Submissions>().clone();
    let [whole, passes, edits] = submissions.counts();
    let edit = raise(&mut heights, entity, UVec2::new(40, 30), UVec2::new(7, 5));
    app.world_mut().write_message(edit);
    let [of_sun, of_sky] = expected(&heights, 300.0, 40.0);
    assert_ne!(expected(&before, 300.0, 40.0)[0], of_sun);
    same_bits(&floats(&mut app, &light.sun), &of_sun, "edit");
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "edit");
    assert_eq!(submissions.counts(), [whole, passes, edits + 1], "all passes, some passes, edits");

    // Two edits, each within reach of the other, in the frame in which the sun moves.
    for corner in [UVec2::new(50, 34), UVec2::new(46, 40)] {
        let edit = raise(&mut heights, entity, corner, UVec2::new(6, 4));
        app.world_mut().write_message(edit);
    }
    *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(302.0, 38.0);
    let [of_sun, of_sky] = expected(&heights, 302.0, 38.0);
    same_bits(&floats(&mut app, &light.sun), &of_sun, "two edits");
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "two edits");

    // Other images, and the same field.
    let field = app.world().get::<HeightField>(entity).unwrap().clone();
    let light = FieldLight::new(&field, &mut app.world_mut().resource_mut::<Assets<Image>>());
    app.world_mut().entity_mut(entity).insert(light.clone());
    same_bits(&floats(&mut app, &light.sun), &of_sun, "other images");
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "other images");

    // Below the horizon: the last shadows stay.
    *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(302.0, -10.0);
    same_bits(&floats(&mut app, &light.sun), &of_sun, "night");
    *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(300.0, 40.0);

    // An edit is not lost beside a setting that needs other images.
    let edit = raise(&mut heights, entity, UVec2::new(70, 20), UVec2::new(5, 5));
    app.world_mut().write_message(edit);
    app.world_mut().get_mut::<HeightField>(entity).unwrap().bent_normal = true;
    for azimuth in [301.0, 302.0, 300.0] {
        *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(azimuth, 40.0);
        app.update();
    }
    same_bits(&floats(&mut app, &light.sun), &of_sun, "images of another setting");
    app.world_mut().get_mut::<HeightField>(entity).unwrap().bent_normal = false;
    let [of_sun, of_sky] = expected(&heights, 300.0, 40.0);
    same_bits(&floats(&mut app, &light.sun), &of_sun, "an edit beside an error");

    // A wrong image is refused; the right one is lit again.
    let small = UVec2::new(64, 64);
    let image = field.heights.clone();
    let put = |app: &mut App, size: UVec2, heights: &[f32]| {
        let mut images = app.world_mut().resource_mut::<Assets<Image>>();
        images.insert(&image, heights_image(size, heights)).expect("replaced");
    };
    put(&mut app, small, &[0.0; 64 * 64]);
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "a wrong size");

    heights.iter_mut().for_each(|height| *height *= 0.5);
    put(&mut app, SIZE, &heights);
    let [of_sun, of_sky] = expected(&heights, 300.0, 40.0);
    same_bits(&floats(&mut app, &light.sun), &of_sun, "new heights");
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "new heights");
    end(&app);
}

/// Frames of new heights compute no tables of bent normals. They equal a new field's first frame bit for bit, also where the sun
/// moves a little or far in the same frame, and after that.
#[test]
fn new_heights_have_the_light_of_a_new_field() {
    let mut app = app();
    let with_bent = |field: &mut HeightField| field.bent_normal = true;
    let (entity, light) = spawn(&mut app, &heights(), with_bent);
    let sun = app.world_mut().spawn((DirectionalLight::default(), sun_at(140.0, 25.0))).id();
    let image = app.world().get::<HeightField>(entity).unwrap().heights.clone();
    let texels = |app: &mut App, light: &FieldLight| -> Vec<f32> {
        let bent = light.bent_normal.as_ref().unwrap();
        [&light.sun, &light.sky_view, bent].map(|image| floats(app, image)).concat()
    };
    let mut last = texels(&mut app, &light);
    let submissions = app.world().resource::<Submissions>().clone();
    for (n, azimuth) in [140.0, 141.0, 141.0, 300.0, 300.0].into_iter().enumerate() {
        let [whole, passes, edits] = submissions.counts();
        let raised: Vec<f32> = heights().iter().map(|h| h * (0.9 - 0.15 * n as f32)).collect();
        *app.world_mut().get_mut::<Transform>(sun).unwrap() = sun_at(azimuth, 25.0);
        {
            let mut images = app.world_mut().resource_mut::<Assets<Image>>();
            images.insert(&image, heights_image(SIZE, &raised)).expect("replaced");
        }
        let found = texels(&mut app, &light);
        assert!(found != last, "{n}: the light of the frame before");
        if n % 2 == 0 {
            let after = submissions.counts();
            assert!(after[1] > passes, "{n}: {after:?}");
            assert_eq!([after[0], after[2]], [whole, edits], "{n}: only some passes");
        }
        let (other, fresh) = spawn(&mut app, &raised, with_bent);
        let expected = texels(&mut app, &fresh);
        assert!(submissions.counts()[0] > whole, "{n}: a new field has all passes");
        same_bits(&found, &expected, &format!("heights {n}, sun at {azimuth}"));
        app.world_mut().despawn(other);
        last = found;
    }
    end(&app);
}

/// Without a sun, with one below the horizon, or with a NaN rotation, the sky view equals the core's. Until a visible sun rises, the
/// sun image is that of a sun at the zenith. A brighter sun that has set does not hide a moon.
#[test]
fn fields_are_lit_before_a_sun_rises() {
    let mut app = app();
    let heights = heights();
    let [at_zenith, of_sky] = expected(&heights, 0.0, 90.0);
    let (_, light) = spawn(&mut app, &heights, |_| {});
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "no sun");
    let sun = app.world_mut().spawn((DirectionalLight::default(), sun_at(140.0, -5.0))).id();
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "below the horizon");
    let unknown = Transform::from_rotation(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0));
    app.world_mut().entity_mut(sun).insert(unknown);
    same_bits(&floats(&mut app, &light.sky_view), &of_sky, "a direction that is not a number");
    app.world_mut().entity_mut(sun).insert((sun_at(140.0, 25.0), Visibility::Hidden));
    same_bits(&floats(&mut app, &light.sun), &at_zenith, "hidden");
    app.world_mut().entity_mut(sun).insert(Visibility::Inherited);
    same_bits(&floats(&mut app, &light.sun), &expected(&heights, 140.0, 25.0)[0], "risen");
    app.world_mut().entity_mut(sun).insert(sun_at(0.0, 90.0));
    same_bits(&floats(&mut app, &light.sun), &at_zenith, "at the zenith");
    app.world_mut().entity_mut(sun).insert(sun_at(140.0, -5.0));
    let moon = DirectionalLight { illuminance: 0.2, ..default() };
    app.world_mut().spawn((moon, sun_at(140.0, 25.0)));
    same_bits(&floats(&mut app, &light.sun), &expected(&heights, 140.0, 25.0)[0], "a moon");
    end(&app);
}

/// Level ground: bent normals up, whose vector is two thirds long, and level horizons. Behind a wall in the south the
/// bent normal turns north, and the horizon rises there alone.
#[test]
fn bent_normals_and_horizons_of_a_wall() {
    let mut app = app();
    let wall = |i: u32| if i / SIZE.x >= 60 { 100.0 } else { 0.0 };
    let heights: Vec<f32> = (0..SIZE.x * SIZE.y).map(wall).collect();
    let (_, light) = spawn(&mut app, &heights, |field| {
        field.bent_normal = true;
        field.horizon_azimuths = 8;
    });
    app.world_mut().spawn((DirectionalLight::default(), sun_at(90.0, 30.0)));
    let sky = floats(&mut app, &light.sky_view);
    let bent = floats(&mut app, light.bent_normal.as_ref().unwrap());
    let at = |row: u32, channel: usize| {
        let texel = 4 * (row * SIZE.x + 48) as usize;
        2.0 * bent[texel + channel] - sky[texel]
    };
    let far = [0, 1, 2].map(|channel| at(2, channel));
    // The wall rises 100 over 580, and covers 1 - cos² of the slices towards it.
    assert!(far[0].abs() < 0.01 && (0.6..0.68).contains(&far[1]) && far[2] < 0.0, "{far:?}");
    let near = [0, 1, 2].map(|channel| at(57, channel));
    assert!(near[0].abs() < 0.01 && near[2] < 2.0 * far[2] && near[1] < far[1], "{near:?}");
    let horizons = floats(&mut app, light.horizon.as_ref().unwrap());
    let angle = |azimuth: u32, row: u32| {
        horizons[azimuth as usize * (SIZE.x * SIZE.y) as usize + (row * SIZE.x + 48) as usize]
    };
    // Counter-clockwise from east: south is six of eight.
    let expected = (100.0 / (3.0 * CELL.y)).atan();
    assert!((angle(6, 57) - expected).abs() < 1e-5, "{} {expected}", angle(6, 57));
    for azimuth in 0..8 {
        let is_southern = (5..8).contains(&azimuth);
        let found = angle(azimuth, 57);
        assert!(if is_southern { found > 0.5 } else { found.abs() < 1e-5 }, "{azimuth}: {found}");
    }
    end(&app);
}

/// sRGB's curve.
fn encoded(value: f32) -> f32 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

fn picture_of(app: &mut App, size: UVec2, camera: impl Bundle) -> Vec<u8> {
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let (dimension, format) = (TextureDimension::D2, TextureFormat::Rgba8UnormSrgb);
    let mut image =
        Image::new_fill(extent, dimension, &[0; 4], format, RenderAssetUsages::default());
    image.texture_descriptor.usage |= TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
    let image = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    let target = RenderTarget::Image(image.clone().into());
    let camera = app.world_mut().spawn((Camera3d::default(), target, camera)).id();
    let bytes = bytes(app, &image);
    app.world_mut().despawn(camera);
    bytes
}

/// From straight above, a pixel for each grid point: colours of sun and sky times their layers, in sRGB, to a code. And a
/// picture from the side, which RIDGELIGHT_PICTURE=FILE.png writes.
#[test]
fn pictures_have_the_light() {
    let mut app = app();
    let heights = heights();
    spawn(&mut app, &heights, |_| {});
    let ev100 = 9.0_f32;
    let exposure = 1.0 / (1.2 * 2_f32.powf(ev100));
    // So that white ground, lit by both, is a little below white.
    let (illuminance, brightness) = (0.55 * std::f32::consts::PI / exposure, 0.35 / exposure);
    // All six differ, so that swapped channels or swapped lights give another picture.
    let [sun_colour, sky_colour] = [[1.0_f32, 0.8, 0.5], [0.4, 0.6, 0.9]];
    let colour = |[r, g, b]: [f32; 3]| Color::linear_rgb(r, g, b);
    let light = DirectionalLight { color: colour(sun_colour), illuminance, ..default() };
    app.world_mut().spawn((light, sun_at(140.0, 25.0)));
    let ambient = GlobalAmbientLight { color: colour(sky_colour), brightness, ..default() };
    app.world_mut().insert_resource(ambient);
    let centre = 0.5 * (SIZE - UVec2::ONE).as_vec2() * CELL;
    let centre = Vec3::new(centre.x, 0.0, centre.y);
    let above =
        Transform::from_translation(centre + 1000.0 * Vec3::Y).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    let [width, height] = (SIZE.as_vec2() * CELL).to_array();
    let map = Projection::Orthographic(OrthographicProjection {
        scaling_mode: ScalingMode::Fixed { width, height },
        far: 2000.0,
        ..OrthographicProjection::default_3d()
    });
    let camera = (above, map, Tonemapping::None, Exposure { ev100 }, Msaa::Off);
    let codes = picture_of(&mut app, SIZE, camera);
    let [of_sun, of_sky] = expected(&heights, 140.0, 25.0);
    let mut worst = 0.0_f32;
    // Pixels at the edge are half beyond the ground.
    for row in 1..SIZE.y - 1 {
        for col in 1..SIZE.x - 1 {
            let i = (row * SIZE.x + col) as usize;
            for channel in 0..3 {
                let sun = sun_colour[channel] * illuminance * of_sun[i];
                let sky = sky_colour[channel] * brightness * of_sky[i];
                let code = 255.0 * encoded((sun + sky) * exposure);
                worst = worst.max((f32::from(codes[4 * i + channel]) - code).abs());
            }
        }
    }
    // Half a code of rounding, and as much for the device's curve of sRGB (Vulkan allows 0.6 codes in all) and for
    // where a pixel's centre is met.
    assert!(worst < 1.0, "{worst} codes");

    let Some(file) = std::env::var_os("RIDGELIGHT_PICTURE") else { return end(&app) };
    let size = UVec2::new(1024, 576);
    let eye = centre + Vec3::new(-500.0, 420.0, 620.0);
    let side = Transform::from_translation(eye).looking_at(centre + 40.0 * Vec3::Y, Vec3::Y);
    let codes = picture_of(&mut app, size, (side, Tonemapping::None, Exposure { ev100 }));
    let picture = image::RgbaImage::from_raw(size.x, size.y, codes).expect("as many bytes");
    picture.save(file).expect("written");
    end(&app);
}
