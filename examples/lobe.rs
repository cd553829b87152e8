//! What a Phong lobe by spherical harmonics is off light paths by, for exponents and orders.
//!
//! `cargo run --release --example lobe -- [SIDE]` lights the middle SIDE² (64) samples of the bundled mountain by
//! the bundled sky in a lobe alone, without a sun, whose texels are cut at 20 times the mean: of so small a light
//! harmonics keep next to nothing, and suns belong in suns.

#[path = "shared/mountain.rs"]
mod mountain;
#[path = "shared/traced.rs"]
mod traced;

use mountain::{middle, side_of, sky};
use ridgelight::Result;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, Basis, Border, Lights, PhongSpecular, Quality, Receiver, Scene, Specular, Surface,
};
use traced::traced;

const BATCHES: u32 = 48;

fn main() {
    if let Err(error) = run() {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn run() -> Result<()> {
    let side = side_of(std::env::args().nth(1), 64)?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let (field, sky) = (middle(side, 1.0)?, sky()?);
    let device = gpu.report();
    println!(
        "Middle {side}² of mt_washington_256 under sky_512x256, cut at 20 times its mean; a lobe alone, {} light \
         paths a sample; {}, {}\n",
        BATCHES * REFERENCE_BATCH,
        device.name,
        device.driver
    );
    println!(
        "| exponent | receiver | order | RMSE % | ± | paths' noise % | mean shift % | set to 0 % |\n|---|---|---|---|---|---|---|---|"
    );
    for exponent in [1.0, 5.0, 20.0] {
        let scene = Scene {
            field: field.clone(),
            surface: Surface {
                albedo: Albedo::Constant([0.0; 3]),
                border: Border::Plane,
                specular: Some(Specular::Constant(PhongSpecular { exponent, scale: 1.0 })),
            },
            lights: Lights { environment: Some(sky.clone()), ..Lights::default() },
        };
        let truth = traced(&mut gpu, &scene, 0, BATCHES)?;
        for receiver in [Receiver::Plane, Receiver::Cosine] {
            for sh_order in 2..=6 {
                let quality =
                    Quality { basis: Basis::Sh, receiver, sh_order, ..Quality::default() };
                let (light, negative) = drawn(&mut gpu, &scene, &quality)?;
                let [rmse, error, noise, shift] = off(&light, &truth).map(|v| 100.0 * v);
                println!(
                    "| {exponent} | {} | {sh_order} | {rmse:.2} | {error:.4} | {noise:.3} | {shift:+.2} | {:.2} |",
                    receiver.name(),
                    100.0 * negative
                );
            }
        }
    }
    Ok(())
}

/// Radiance, and the share of samples where some was below 0.
fn drawn(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<(Vec<f32>, f64)> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let negative = gpu.negative_share(frame)?.unwrap_or(0.0);
        Ok((gpu.pixels(frame, 0)?.values, negative))
    })
}

/// RMSE over all channels, the paths' noise taken off, its standard error, that noise, and the shift of the mean;
/// shares of the mean. A square d² of a difference with noise σ wavers by √(4 d²σ² + 2 σ⁴).
fn off(light: &[f32], [truth, error]: &[Vec<f32>; 2]) -> [f64; 4] {
    let (mut mean, mut shift, mut count) = (0.0, 0.0, 0.0);
    let (mut squares, mut noises, mut spread) = (0.0, 0.0, 0.0);
    for (i, ((got, want), sigma)) in light.iter().zip(truth).zip(error).enumerate() {
        if i % 4 < 3 {
            let [off, noise] = [f64::from(got - want), f64::from(*sigma)].map(|v| v * v);
            mean += f64::from(*want);
            shift += f64::from(got - want);
            squares += off - noise;
            noises += noise;
            spread += 4.0 * off * noise + 2.0 * noise * noise;
            count += 1.0;
        }
    }
    let rmse = (squares.max(0.0_f64) / count).sqrt();
    let of_rmse = spread.sqrt() / count / (2.0 * rmse).max(f64::MIN_POSITIVE);
    [rmse, of_rmse, f64::sqrt(noises / count), shift / count].map(|v| v * count / mean)
}
