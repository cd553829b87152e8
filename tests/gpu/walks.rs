//! Bounces by walks over what sweeps have met: against closed forms, the engine that takes every crossing, and what
//! must be.

use ridgelight::measure::fractal::fractal;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Albedo, Border, BounceEngine, Bounces, Lines, Method, Quality, Scene};

use crate::reference_page::{PITS, pit, pit_bounds, pit_radiance};
use crate::{Device, field, random, under_sky};

/// So many bounces in so many azimuths, none dropped, of direct light by sweeps in as many.
fn swept(count: u32, azimuths: u32, engine: BounceEngine) -> Quality {
    let bounces = Bounces { count, azimuths, engine, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths, bounces, ..Quality::default() }
}

/// The first channel of the picture, of a scene under a sky alone.
fn drawn(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<f64> {
    gpu.picture(scene, quality).values.into_iter().map(f64::from).collect()
}

/// Pits against their closed form, within what the rim's staircase may do.
#[test]
fn a_pit_is_lit_as_its_closed_form() {
    let mut gpu = Device::new();
    for (alpha, albedo, bounces, _) in PITS {
        let (rho, count) = (f64::from(albedo), bounces.min(6));
        let mut scene = under_sky(pit(12.5, alpha), Border::Plane);
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        let whole = drawn(&mut gpu, &scene, &swept(count as u32, 32, BounceEngine::Sweep));
        let expected = pit_radiance(alpha, rho, count);
        let bounds = pit_bounds(12.5, alpha, rho, count).pop().expect("a bound a bounce");
        let squares: f64 = bounds.iter().map(|(i, _)| (whole[*i] - expected).powi(2)).sum();
        for (i, bound) in &bounds {
            let off = (whole[*i] - expected).abs();
            assert!(off <= *bound, "{alpha} {albedo} {count} {i}: {off} of {bound}");
        }
        let rms = (squares / bounds.len() as f64).sqrt();
        println!("pit {alpha}, {albedo}, {count} bounces: {:.3} %", 100.0 * rms / expected);
    }
}

/// White ground under a white sky: each bounce adds, and the sum comes up to 1 from below. Sky and ground are cut by
/// the same azimuths at the same horizons and their weights are scaled to a whole but for the sky's: what
/// a rule over so many azimuths misses, e^(-m asinh(1/slope)) for slopes up to 3 below 1e-4; each bounce rounds 64
/// times.
#[test]
fn a_furnace_comes_up_to_one() {
    let mut gpu = Device::new();
    let mut next = random(9);
    let noise: Vec<f64> = (0..72).map(|_| next()).collect();
    for border in [Border::Open, Border::Periodic] {
        let scene = under_sky(field(8, 9, [1.0, 1.5], |r, c| 1.5 * noise[r * 9 + c]), border);
        let mut before = drawn(&mut gpu, &scene, &swept(0, 32, BounceEngine::Sweep));
        for count in [1, 2, 12] {
            let now = drawn(&mut gpu, &scene, &swept(count, 32, BounceEngine::Sweep));
            for (a, b) in before.iter().zip(&now) {
                assert!(a <= b && *b < 1.0 + 2e-4, "{border:?} {count}: {a} {b}");
            }
            before = now;
        }
        let least = before.iter().fold(f64::MAX, |m, v| m.min(*v));
        println!("{border:?}: {least:.4}");
        assert!(least > 0.98, "{border:?}: {least}");
    }
}

/// Beside the engine that takes every crossing: what a walk steps over of a fractal is small beside a bounce, and
/// of a smoother land, the same at twice the samples a cell, less. A bounce less is more than that.
#[test]
fn walks_are_near_every_crossing() {
    let mut gpu = Device::new();
    let land = fractal(12, 3).unwrap();
    let h = |r: usize, c: usize| f64::from(land.heights_m()[r.min(11) * 12 + c.min(11)]);
    let fine = field(23, 23, land.cell_m().map(|c| c / 2.0), |r, c| {
        0.5 * (h(r / 2, c / 2) + h(r.div_ceil(2), c.div_ceil(2)))
    });
    let errors = [land.clone(), fine].map(|field| {
        let mut scene = under_sky(field, Border::Plane);
        scene.surface.albedo = Albedo::Constant([0.8; 3]);
        let [none, walked, every] =
            [(0, BounceEngine::Sweep), (1, BounceEngine::Sweep), (1, BounceEngine::Brute)]
                .map(|(count, engine)| drawn(&mut gpu, &scene, &swept(count, 48, engine)));
        let rms = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        rms(&walked, &every) / rms(&every, &none)
    });
    println!("off by {:.2} % and {:.2} % of a bounce", 100.0 * errors[0], 100.0 * errors[1]);
    assert!(errors[0] < 0.1 && errors[1] < errors[0], "{errors:?}");
}

/// Ways without lines have nothing to walk over, and say so; where nothing is reflected they are not asked.
#[test]
fn what_has_no_lines_is_refused() {
    let mut scene = under_sky(fractal(8, 1).unwrap(), Border::Plane);
    let of = |scene: &Scene, method, lines| {
        let quality = Quality { method, lines, ..swept(1, 8, BounceEngine::Sweep) };
        plan::picture(scene, &quality, &Limits::lavapipe(), Picture::default())
    };
    let ways = [
        (Method::Brute, Lines::Cell, "--method brute"),
        (Method::Pyramid, Lines::Cell, "--method pyramid"),
        (Method::Auto, Lines::Exact, "--lines exact"),
    ];
    for (method, lines, name) in ways {
        let said = of(&scene, method, lines).unwrap_err().to_string();
        assert!(said.contains("--bounce-engine sweep") && said.contains(name), "{said}");
    }
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    assert!(of(&scene, Method::Brute, Lines::Cell).is_ok());
}
