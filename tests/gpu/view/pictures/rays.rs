//! A scene drawn on the device, and the same by rays in f64.

use std::f64::consts::PI;

use ridgelight::gpu::ViewPixels;
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{Border, Camera, HeightField, Lens, Method, Quality, Scene, Sun};
use ridgelight_cpu::sky_draw::sky_draw;
use ridgelight_cpu::terrain_draw::{Met, colour, ray, terrain_draw};

use crate::{Device, random, under_sky};

/// Bits of a picture's place that every device keeps: `subPixelPrecisionBits` is 4 or more. Vertices are moved to the
/// nearest such place.
pub(super) const SNAP: f64 = 0.5 / 16.0;

/// Error of a vertex before that, as a part of the picture: a few roundings of numbers about as large as the picture.
pub(super) const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// Radiance, and distance, infinite where there is no ground.
type GroundTruth = ([f64; 3], f64);

pub(super) struct Shot {
    pub(super) scene: Scene,
    pub(super) camera: Camera,
    pub(super) options: ViewOptions,
    /// The lit field.
    pub(super) lit: Vec<[f32; 3]>,
    pub(super) visible: ViewPixels,
}

pub(super) fn quality() -> Quality {
    Quality { method: Method::Sweep, azimuths: 8, ..Quality::default() }
}

/// Lights a scene and draws it from a camera.
pub(super) fn shoot(
    device: &mut Device,
    scene: Scene,
    camera: Camera,
    options: ViewOptions,
) -> Shot {
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality(), &limits, Picture::default()).expect("a plan");
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let contents = plan::picture_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let (lit, visible) = gpu
        .with_frame(plan, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            let lit = gpu.pixels(frame, 0)?;
            let channels = lit.channels;
            let texel = |t: &[f32]| [t[0], t[channels.min(3) / 2], t[(channels - 1).min(2)]];
            let lit: Vec<[f32; 3]> = lit.values.chunks_exact(channels).map(texel).collect();
            Ok((lit, gpu.look(frame, &view, scene.field.voids())?))
        })
        .expect("a picture");
    Shot { scene, camera, options, lit, visible }
}

impl Shot {
    fn met(&self, pixel: [f64; 2]) -> Option<Met> {
        let Shot { scene, camera, options, .. } = self;
        terrain_draw(&scene.field, camera, (options.size, pixel), options.mesh_step)
    }

    /// Radiance and distance at a place of the picture, in f64.
    fn ground_truth(&self, pixel: [f64; 2]) -> GroundTruth {
        match self.met(pixel) {
            Some(met) => (colour(&self.scene.field, &self.lit, &met), met.distance_m),
            None => {
                let [_, along] = ray(&self.camera, self.options.size, pixel);
                (sky_draw(&self.scene, self.options.background, along), f64::INFINITY)
            }
        }
    }

    /// Compares every pixel with the rays about its middle: a triangle with moved vertices shows a point no farther
    /// away than they have moved. Where all of these rays hit ground, or none does, the pixel must, too; its distance
    /// and its light must lie between theirs, extended by their own difference (a crease between two rays stands out
    /// by no more) and roundings. Returns the number of pixels compared: an edge of the ground passes through the
    /// others.
    pub(super) fn check(&self) -> usize {
        let [width, height] = self.options.size;
        let away = SNAP + ROUNDING * f64::from(width.max(height));
        let mut held = 0;
        for i in 0..self.visible.radiance.len() {
            let at = [i % width as usize, i / width as usize].map(|v| v as f64 + 0.5);
            let around = [-1.0, 0.0, 1.0].map(|y| [-1.0, 0.0, 1.0].map(|x| [x * away, y * away]));
            let ground_truths: Vec<GroundTruth> = around
                .iter()
                .flatten()
                .map(|d| self.ground_truth([at[0] + d[0], at[1] + d[1]]))
                .collect();
            let met = ground_truths.iter().filter(|t| t.1.is_finite()).count();
            if met != 0 && met != ground_truths.len() {
                continue;
            }
            held += 1;
            let got = f64::from(self.visible.distances_m[i]);
            assert_eq!(got.is_finite(), met > 0, "pixel {at:?}: {got} for {ground_truths:?}");
            let edge = f64::from(width.max(height));
            let range = |of: &dyn Fn(&GroundTruth) -> f64| {
                let low = ground_truths.iter().map(of).fold(f64::INFINITY, f64::min);
                let high = ground_truths.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
                (low, high, (high - low) / away)
            };
            let check = |got: f64, (low, high, _): (f64, f64, f64), rounding: f64| {
                let give = high - low + rounding;
                assert!(
                    (low - give..=high + give).contains(&got),
                    "pixel {at:?}: {got} beyond {low} to {high}, give or take {give}"
                );
            };
            if met > 0 {
                // Interpolated over the picture: it loses the same part of its change from edge to edge, and of
                // itself.
                let distances = range(&|t| t.1);
                check(got, distances, ROUNDING * (distances.1 + distances.2 * edge));
            }
            for k in 0..3 {
                let light = range(&|t| t.0[k]);
                // An angle of the sky errs by 4096 roundings (Vulkan, precision of atan).
                let turned = if met > 0 { 0.0 } else { PI * 4096.0 * f64::from(f32::EPSILON) };
                let pixels = (turned + ROUNDING) * edge;
                check(
                    f64::from(self.visible.radiance[i][k]),
                    light,
                    ROUNDING * light.1 + light.2 * pixels,
                );
            }
        }
        held
    }
}

/// Uneven ground under a coloured sky and a sun, cells that are not square.
pub(super) fn uneven(seed: u64) -> Scene {
    let mut next = random(seed);
    let heights: Vec<f64> = (0..33 * 29).map(|_| 100.0 + 3.0 * next()).collect();
    let rough = HeightField::new(29, 33, &heights, [2.0, 3.0], None).expect("a field");
    let mut scene = under_sky(rough, Border::Plane);
    scene.lights.sky = Some([0.3, 0.5, 0.9]);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.6,
        diameter_rad: 0.0,
        irradiance: [3.0, 2.0, 1.0],
    }];
    scene
}

pub(super) fn around(
    scene: &Scene,
    compass: f64,
    elevation: f64,
    lens: Lens,
    options: &ViewOptions,
) -> Camera {
    let angles = [(90.0 - compass).to_radians(), elevation.to_radians()];
    Camera::around(&scene.field, None, angles, lens, options.aspect())
}

pub(super) const LENSES: [Lens; 2] =
    [Lens::Perspective { fov_rad: 0.7 }, Lens::Orthographic { height_m: 1.0 }];
