//! Light colours in the caller's images and buffers: the bits of the same colours in the scene.

use ridgelight::plan::{self, Format, Limits, Picture, Plan, Rectangle};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, KeyLight, Lights, PhongSpecular, Quality, Scene, Specular, SphereLight, Sun,
    Surface,
};

use super::borrowed::packed;
use crate::Device;
use crate::target::{Input, Staging};

/// The colours of the sky, two suns and a key light: 0 and 1, which every format holds.
type Colours = [[f32; 3]; 4];

const FIRST: Colours = [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
const SECOND: Colours = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];

fn scene([sky, one, other, patch]: Colours) -> Scene {
    let sun = |azimuth_rad, diameter_rad, irradiance| Sun {
        azimuth_rad,
        elevation_rad: 0.4,
        diameter_rad,
        irradiance,
    };
    let key =
        KeyLight { azimuth_rad: 2.6, width_rad: 1.7, elevations_rad: [0.1, 0.5], radiance: patch };
    Scene {
        field: fractal(40, 3).expect("a field"),
        surface: Surface {
            albedo: Albedo::Constant([0.7, 0.5, 0.3]),
            border: Border::Plane,
            specular: None,
        },
        lights: Lights {
            sky: Some(sky),
            suns: vec![sun(2.0, 0.1, one), sun(-1.1, 0.0, other)],
            keys: vec![key],
            ..Lights::default()
        },
    }
}

/// Alpha has no effect: it is 0 or 1.
fn texels(colours: Colours) -> Vec<f32> {
    let all = colours.iter().zip([1.0, 0.0, 0.0, 1.0]);
    all.flat_map(|([r, g, b], alpha)| [*r, *g, *b, alpha]).collect()
}

fn planned(scene: &Scene, limits: &Limits, wanted: Picture) -> Plan {
    let quality = Quality { azimuths: 8, sun_azimuths: 2, ..Quality::default() };
    plan::picture(scene, &quality, limits, wanted).expect("a plan")
}

/// The device's colours replace those of the scene: no light that is black in the scene is dropped, each layer belongs
/// to its light, and other colours only add up existing sums again.
#[test]
fn colours_of_the_device_light_as_the_scenes_do() {
    let mut device = Device::new();
    let limits = device.limits();
    let kept = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
    let [first, second] = [FIRST, SECOND].map(scene);
    let right = [&first, &second].map(|scene| {
        // A light of radiance 0 has no layer there: its layer here is all 0.
        let outputs = device.draw(planned(scene, &limits, kept), &[scene.field.heights_m()]);
        outputs.into_iter().map(|o| (o.name, o.values)).collect::<Vec<_>>()
    });
    let unknown = scene([[0.0; 3]; 4]);
    let wanted = Picture { colours_on_device: true, ..kept };
    let plan = planned(&unknown, &limits, wanted);
    let names: Vec<_> = plan.inputs().map(|(_, r)| r.name.clone()).collect();
    assert_eq!(names, ["heights", "light_colours"]);
    let gpu = device.gpu.as_mut().expect("alive");
    let heights = first.field.heights_m();
    let mut frame = gpu.frame(plan.clone(), &[heights, &texels(FIRST)]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let colours = plan.find("light_colours").expect("an input");
    for (n, right) in right.iter().enumerate() {
        if n == 1 {
            gpu.refill(&frame, 1, &texels(SECOND)).expect("other colours");
            let passes = plan.passes_after(&plan, &[colours]);
            // The sums over lights are recomputed, from the stored horizons.
            let is_swept = |pass: &usize| plan.passes[*pass].name().ends_with("_sweep");
            assert!(!passes.is_empty() && !passes.iter().any(is_swept), "{passes:?}");
            gpu.draw_passes(&mut frame, &passes).expect("drawn");
        }
        for (output, (_, resource)) in plan.outputs().enumerate() {
            let lit = gpu.pixels(&frame, output).expect("pixels").values;
            match right.iter().find(|(name, _)| *name == resource.name) {
                Some((name, values)) => assert!(lit == *values, "{name} of {n}"),
                None => {
                    assert!((n, resource.name.as_str()) == (1, "direct.sun2"), "{}", resource.name);
                    assert!(lit.chunks_exact(4).all(|t| t == [0.0, 0.0, 0.0, 1.0]));
                }
            }
        }
    }
    // An edit resolves with the same texels.
    let edited = Rectangle { col: 9, row: 21, cols: 5, rows: 3 };
    let mut raised = heights.to_vec();
    (21..24).for_each(|row| raised[row * 40 + 9..][..5].iter_mut().for_each(|h| *h += 2.0));
    gpu.refill(&frame, 0, &raised).expect("raised");
    gpu.draw_edit(&mut frame, edited).expect("drawn");
    let by_edit = gpu.pixels(&frame, 0).expect("pixels").values;
    gpu.draw(&mut frame).expect("drawn");
    assert!(by_edit == gpu.pixels(&frame, 0).expect("pixels").values);
    assert!(by_edit != right[1][0].1, "the edit is visible");
    gpu.end(frame);
}

/// In an image of each format, and in a buffer, of which one copy is made; the bounced light is the same.
#[test]
fn colours_come_in_formats_and_buffers() {
    let mut device = Device::new();
    let limits = device.limits();
    let gpu = device.gpu.as_mut().expect("alive");
    let (known, unknown) = (scene(FIRST), scene(SECOND));
    let heights = known.field.heights_m();
    let bounced = |scene: &Scene, colours_on_device| {
        let mut quality = Quality { azimuths: 8, sun_azimuths: 2, ..Quality::default() };
        quality.bounces.count = 1;
        quality.bounces.azimuths = 4;
        let wanted = Picture { colours_on_device, ..Picture::default() };
        plan::picture(scene, &quality, &limits, wanted).expect("a plan")
    };
    let mut frame = gpu.frame(bounced(&known, false), &[heights]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let right = gpu.pixels(&frame, 0).expect("pixels").values;
    gpu.end(frame);
    let plan = bounced(&unknown, true);
    let mut frame = gpu.frame(plan.clone(), &[heights, &texels(SECOND)]).expect("a frame");
    let outputs = frame.outputs();
    let formats = [Format::Rgba32Float, Format::Rgba16Float, Format::Rgba8Unorm, Format::Rgba8Srgb];
    for format in formats {
        gpu.draw(&mut frame).expect("drawn");
        assert!(gpu.pixels(&frame, 0).expect("pixels").values != right, "the other colours");
        let bytes = packed(&texels(FIRST), format.vk());
        let lent = Input::new(gpu, format.vk(), [4, 1], &bytes).expect("an image");
        let given = [frame.inputs()[0], lent.arg()];
        gpu.run(|commands| frame.renderer().record(commands, 0, &given, &outputs)).expect("run");
        assert!(gpu.pixels(&frame, 0).expect("pixels").values == right, "{format:?}");
        lent.end(gpu.host());

        gpu.draw(&mut frame).expect("drawn");
        let mut taking = plan.clone();
        taking.take_buffer("light_colours", format).expect("an input");
        let lent = Staging::new(gpu.host(), &bytes);
        let given = [frame.inputs()[0].into(), lent.arg().into()];
        let made = ridgelight::gpu::Renderer::new(gpu.host(), taking, 1);
        let mut renderer = made.expect("a renderer");
        gpu.run(|commands| {
            renderer.record::<ridgelight::gpu::InputArg>(commands, 0, &given, &outputs)
        })
        .expect("run");
        assert!(gpu.pixels(&frame, 0).expect("pixels").values == right, "{format:?}, a buffer");
        renderer.destroy();
        lent.end(gpu.host());
    }
    gpu.end(frame);
}

/// Methods whose sums hold the lights' colours are refused, by name.
#[test]
fn colours_that_are_summed_up_are_the_scenes() {
    let wanted = Picture { colours_on_device: true, ..Picture::default() };
    let refuse = |scene: &Scene, says: &str| {
        let refused = plan::picture(scene, &Quality::default(), &Limits::lavapipe(), wanted);
        let said = refused.expect_err(says).to_string();
        assert!(said.starts_with(&format!("picture: colours_on_device: found {says}")), "{said}");
    };
    let mut with_sphere_light = scene(FIRST);
    let sphere_light = SphereLight { position_m: [1.0; 3], radius_m: 1.0, radiance: [1.0; 3] };
    with_sphere_light.lights.sphere_lights = vec![sphere_light];
    refuse(&with_sphere_light, "a sphere light");
    let mut with_specular = scene(FIRST);
    with_specular.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent: 9.0, scale: 0.25 }));
    refuse(&with_specular, "specular");
    let lone = Scene { lights: Lights::default(), ..scene(FIRST) };
    refuse(&lone, "nothing that has one");
}
