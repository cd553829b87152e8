//! All tests that need a Vulkan device; a module is a room of the passes. `tools/test` runs them on lavapipe, and those that
//! depend on the driver on SwiftShader, under validation with synchronisation validation; `--all` runs all of them on both.
//! Alone, they run on the first driver.

mod bake {
    pub mod cpu_reference;
    mod curved;
    mod decoders;
    mod scatter;
    mod scatter_views;
    mod sky_view;
}
mod bounce {
    pub mod cpu_reference;
    mod edges;
    mod engines;
    mod nodes;
    mod pits;
    mod walks;
}
mod cpu_reference;
mod device {
    pub mod cpu_reference;
}
mod direct {
    pub mod cpu_reference;
    mod keys;
    mod shadow_heights;
    mod sphere_sh;
    mod spheres;
    mod zenith;
}
mod edit {
    pub mod cpu_reference;
    mod edits;
}
mod embedding {
    mod ash_host;
    mod borrowed;
    mod buffers;
    mod colours;
    mod command_buffer;
    mod contract;
    mod debugger;
    mod host_faults;
    mod in_flight;
    mod lifetimes;
    mod plan_changes;
    mod repeated;
    mod wrong_heights;
}
#[expect(dead_code, reason = "its main, which prints")]
#[path = "../../examples/edit_rectangle.rs"]
mod edit_rectangle;
mod extremes;
#[path = "../common/fields.rs"]
mod fields;
#[expect(dead_code, reason = "its main, which prints")]
#[path = "../../examples/first_light.rs"]
mod first_light;
mod goldens;
mod horizon {
    mod analytic;
    pub mod cpu_reference;
    mod hull_storage;
    mod pyramid;
    mod terrain;
    mod windows;
}
#[path = "../common/brute_force_paths.rs"]
mod brute_force_paths;
mod pruned;
mod rays {
    pub mod cpu_reference;
}
mod reference {
    pub mod cpu_reference;
    mod edges;
    mod many_lights;
    pub mod quadrature;
}
#[expect(dead_code, reason = "of its scenes only pits and grooves are drawn here")]
#[path = "../common/reference_page.rs"]
mod reference_page;
#[path = "../common/scenes.rs"]
mod scenes;
mod sh {
    pub mod cpu_reference;
    mod harmonics;
    mod nodes;
    mod reference_numbers;
}
mod specular {
    mod bounced;
    pub mod cpu_reference;
    mod direct;
    mod kept_tables;
    mod keys;
    mod maps;
    mod spheres;
    mod spots;
    mod viewed_paths;
}
#[path = "../common/intercepted.rs"]
mod intercepted;
#[path = "../common/target.rs"]
mod target;
mod view {
    mod in_flight;
    mod map;
    mod pictures;
    mod preview;
}

use std::path::Path;
use std::sync::{Mutex, MutexGuard};

use fields::field;
use ridgelight::gpu::{Frame, Headless, HeadlessOptions, Pixels};
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{Border, HeightField, Quality, Scene};
use ridgelight_io::HeightOptions;

/// The program `ridgelight`, which cargo builds beside the tests of the whole workspace.
fn program() -> std::path::PathBuf {
    let tests = std::env::current_exe().expect("a test has a path");
    let folder = tests.ancestors().nth(2).expect("target/PROFILE/deps/TEST");
    let program = folder.join(format!("ridgelight{}", std::env::consts::EXE_SUFFIX));
    assert!(program.exists(), "{} is not built: cargo build --bins", program.display());
    program
}

/// One device at a time: two software devices on two cores only slow each other down.
static ONE: Mutex<()> = Mutex::new(());

/// A device whose validation messages fail the test that made it.
struct Device {
    gpu: Option<Headless>,
    validates: bool,
    _one: MutexGuard<'static, ()>,
}

impl Device {
    fn new() -> Self {
        let one = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let validation = std::env::var_os("RIDGELIGHT_VALIDATION").is_some_and(|v| v == "1");
        let options = HeadlessOptions { device: None, validation };
        let gpu =
            Headless::new(&options).expect("a Vulkan device that will do: run tools/setup --tests");
        Self { gpu: Some(gpu), validates: validation, _one: one }
    }

    fn limits(&self) -> Limits {
        limits_of(self.gpu.as_ref().expect("alive"))
    }

    fn report(&self) -> &ridgelight::gpu::DeviceReport {
        self.gpu.as_ref().expect("alive").report()
    }

    /// Draws a plan once and returns all its outputs.
    fn draw(&mut self, plan: Plan, contents: &[&[f32]]) -> Vec<Pixels> {
        let gpu = self.gpu.as_mut().expect("alive");
        let count = plan.outputs().count();
        let mut frame = gpu.frame(plan, contents).expect("a frame");
        gpu.draw(&mut frame).expect("a drawn frame");
        let pixels = (0..count).map(|o| gpu.pixels(&frame, o).expect("pixels")).collect();
        gpu.end(frame);
        pixels
    }

    /// Elevations of the horizon, radians, [azimuth][row][col] in the order of the circle.
    fn horizons(&mut self, field: &HeightField, border: Border, quality: &Quality) -> Vec<f32> {
        let limits = self.limits();
        self.horizons_within(field, border, quality, &limits)
    }

    fn horizons_within(
        &mut self,
        field: &HeightField,
        border: Border,
        quality: &Quality,
        limits: &Limits,
    ) -> Vec<f32> {
        let plan = plan::horizons(field, border, quality, limits, (0, quality.azimuths), false)
            .expect("a plan");
        self.draw(plan, &[field.heights_m()]).remove(0).values
    }

    /// The picture of a scene without albedo map: its first output.
    fn picture(&mut self, scene: &Scene, quality: &Quality) -> Pixels {
        let limits = self.limits();
        self.picture_within(scene, quality, &limits)
    }

    fn picture_within(&mut self, scene: &Scene, quality: &Quality, limits: &Limits) -> Pixels {
        self.outputs(scene, quality, limits, Picture::default()).remove(0)
    }

    /// The picture and the layer of each light and bounce.
    fn light_layers(&mut self, scene: &Scene, quality: &Quality, limits: &Limits) -> Vec<Pixels> {
        let wanted = Picture { light_layers: true, ..Picture::default() };
        self.outputs(scene, quality, limits, wanted)
    }

    fn outputs(&mut self, of: &Scene, by: &Quality, limits: &Limits, what: Picture) -> Vec<Pixels> {
        let plan = plan::picture(of, by, limits, what).expect("a plan");
        let contents = plan::picture_inputs(of);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        self.draw(plan, &contents)
    }
}

/// The limits of a device; with RIDGELIGHT_GPU_PLANS=1 as those of a GPU, so that a software driver runs a GPU's plans.
fn limits_of(gpu: &Headless) -> Limits {
    let limits = gpu.report().limits;
    let is_gpu = std::env::var_os("RIDGELIGHT_GPU_PLANS").is_some_and(|v| v == "1");
    // Few layers: lattices have wide ones.
    let image_layers = limits.image_layers.min(96);
    if is_gpu { Limits { image_layers, ..of_kind(false, limits) } } else { limits }
}

/// The same limits on a CPU or a GPU.
fn of_kind(is_cpu: bool, limits: Limits) -> Limits {
    let Limits { sweep, untuned_sweep, .. } = Limits::boundless(is_cpu, 0);
    Limits { is_cpu, sweep, untuned_sweep, ..limits }
}

impl Drop for Device {
    fn drop(&mut self) {
        if let Some(gpu) = self.gpu.take() {
            let messages = gpu.take_messages();
            if !std::thread::panicking() {
                assert!(messages.is_empty(), "validation said:\n{}", messages.join("\n"));
            }
        }
    }
}

/// An edit of a rectangle gives the bits of a whole frame, and differs from the frame before.
#[test]
fn the_example_of_edits_gives_the_bits_of_a_whole_frame() {
    let [before, edited, whole] = edit_rectangle::lights().expect("light");
    assert!(before.values != edited.values);
    let bits = |pixels: &Pixels| pixels.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&edited), bits(&whole));
}

/// The documentation's first program. A sky of 0.3 and a sun of irradiance 2 facing a texel, albedo 1: exit radiance
/// is at most 0.3 + 2/π, and at most 0.3 for texels in shadow.
#[test]
fn the_first_program_of_the_documentation_lights_its_field() {
    let lines = include_str!("../../examples/first_light.rs").lines().map(str::trim);
    let code = lines.filter(|line| !line.is_empty() && !line.starts_with("//")).count();
    assert!(code <= 30, "{code} lines for a newcomer");
    // The program has a device of its own: this lock keeps others away.
    let _one = ONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let light = first_light::light().expect("light");
    assert_eq!(
        (light.name.as_str(), light.channels, light.values.len()),
        ("radiance", 1, 128 * 128)
    );
    let most = 0.3 + 2.0 / std::f32::consts::PI;
    assert!(light.values.iter().all(|v| *v > 0.0 && *v < most * 1.000_1));
    let shadowed = light.values.iter().filter(|v| **v < 0.3).count();
    // Slopes of up to 1/2 under a sun of tan 12° = 0.21: some are in shadow, and the crests are not.
    assert!(shadowed > 1000 && shadowed < 128 * 96, "{shadowed}");
}

fn under_sky(field: HeightField, border: Border) -> Scene {
    fields::under_sky(field, border, 1.0)
}

/// Colours of an output; grey ones have one channel.
fn colours(pixels: &Pixels) -> Vec<[f64; 3]> {
    let colour = |t: &[f32]| match t {
        [grey] => [f64::from(*grey); 3],
        t => [t[0], t[1], t[2]].map(f64::from),
    };
    pixels.values.chunks_exact(pixels.channels).map(colour).collect()
}

/// Every output's bits.
fn bits(gpu: &mut Headless, frame: &Frame) -> Vec<u32> {
    let count = frame.plan().outputs().count();
    let all = (0..count).map(|o| gpu.pixels(frame, o).expect("pixels").values);
    all.flatten().map(f32::to_bits).collect()
}

/// The bundled terrain.
fn bundled() -> HeightField {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    ridgelight_io::read_heights(&path, &options).expect("the bundled field")
}

/// A small deterministic generator for random fields.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}
