//! The quadrature against brute-force path tracing. Both evaluate indirect Phong specular towards straight above only.

use ridgelight::scene::{Albedo, Border, Environment, Lights, PhongSpecular, Specular};
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light};
use ridgelight_cpu::light::normal;

use super::{rough, under_sky};
use crate::brute_force_paths::Paths;

/// Bounces 0 to 3 at some texels of a rough field, diffuse with an albedo map and with Phong specular, under a
/// sky or an environment: within four standard errors of the paths plus the stated error of the quadrature. (4
/// σ: 6e-5 a comparison; 72 comparisons, one seed.)
#[test]
fn brute_force_paths_match_the_quadrature() {
    let field = || rough(5, 5, [1.0, 1.25], 2.5);
    let map = Albedo::Map((0..25_u8).map(|i| [0.8, f32::from(i % 4) / 4.0, 0.3]).collect());
    let mut plane = under_sky(field(), Border::Plane, 0.0);
    plane.surface.albedo = map.clone();
    let texels = (0..18_u8).map(|i| [f32::from(i % 5), 1.0, f32::from(i % 3)]).collect();
    let mut open = under_sky(field(), Border::Open, 0.0);
    open.surface.albedo = map;
    open.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.2 }));
    open.lights = Lights {
        environment: Some(Environment::new(6, 3, texels, 0.9).unwrap()),
        ..Lights::default()
    };
    let bounces = 3;
    for (name, scene) in [("plane", plane), ("open", open)] {
        let said =
            expected_light(&scene, bounces, Fineness { azimuths: 32, divisions: 1, strips: 16 })
                .unwrap();
        let mut paths = Paths::new(&scene, false);
        for texel in [6, 12, 19] {
            let up = normal(&scene.field, scene.surface.border, texel / 5, texel % 5);
            let light = paths.light(texel, up, bounces, 12_000);
            for (b, [mean, sigma]) in light.iter().enumerate() {
                for i in 0..3 {
                    let (mean, sigma) = (mean[i], sigma[i]);
                    let off = mean - said.radiance[b][texel][i];
                    let stated = said.error[b][texel][i];
                    println!(
                        "{name} {texel} bounce {b} channel {i}: {mean:.4} off {off:+.4}, σ {sigma:.4}, stated {stated:.4}"
                    );
                    assert!(off.abs() <= 4.0 * sigma + stated, "{name} {texel} {b} {i}");
                }
            }
        }
    }
}
