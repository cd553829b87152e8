//! Small scenes for comparing the f64 quadrature with the path tracer.

use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, Environment, Lights, PhongSpecular, Scene, Specular, SphereLight, Sun, Surface,
};

use super::fields::field;

/// A scene and its name. Each light has a channel of its own: red the sky, green a sun, blue a sphere light; an
/// environment adds to all three.
pub fn scenes() -> Vec<(&'static str, Scene)> {
    let sphere_light =
        |x, y, z| SphereLight { position_m: [x, y, z], radius_m: 1.5, radiance: [0.0, 0.0, 9.0] };
    let apart = |place| Lights {
        sky: Some([1.0, 0.0, 0.0]),
        suns: vec![Sun {
            azimuth_rad: 2.0,
            elevation_rad: 0.7,
            diameter_rad: 0.3,
            irradiance: [0.0, 3.0, 0.0],
        }],
        sphere_lights: vec![place],
        ..Lights::default()
    };
    let grey = |border| Surface { albedo: Albedo::Constant([0.7; 3]), border, specular: None };
    let cone =
        || field(9, 9, [1.0, 1.0], |r, c| 6.0 - 1.2 * (r as f64 - 4.0).hypot(c as f64 - 4.0));
    let environment = Environment::new(
        8,
        4,
        (0..32_u8).map(|i| [f32::from(i % 5), f32::from(i % 3), 1.0]).collect(),
        0.4,
    )
    .unwrap();
    let mountains = fractal(12, 3).unwrap();
    let steep =
        field(12, 12, [1.0, 1.0], |r, c| 3.0 * f64::from(mountains.heights_m()[r * 12 + c]));
    let map: Vec<[f32; 3]> = (0..144_u8).map(|i| [f32::from(i % 9) / 8.0; 3]).collect();
    vec![
        (
            "flat, plane",
            Scene {
                field: field(4, 5, [1.0, 2.0], |_, _| 7.0),
                surface: grey(Border::Plane),
                lights: apart(sphere_light(8.0, 3.0, 13.0)),
            },
        ),
        (
            "tilted plane, open",
            Scene {
                field: field(6, 6, [1.0, 1.0], |_, c| 0.8 * c as f64),
                surface: grey(Border::Open),
                lights: apart(sphere_light(0.0, 2.0, 4.0)),
            },
        ),
        (
            "wall, plane",
            Scene {
                field: field(9, 10, [1.0, 1.0], |_, c| if c == 6 { 3.0 } else { 0.0 }),
                surface: grey(Border::Plane),
                lights: apart(sphere_light(2.0, 4.0, 5.0)),
            },
        ),
        (
            "groove, periodic",
            Scene {
                field: field(6, 8, [1.0, 1.0], |_, c| (c as f64 - 4.0).abs()),
                surface: grey(Border::Periodic),
                lights: apart(sphere_light(4.0, 2.0, 4.0)),
            },
        ),
        (
            "cone, plane",
            Scene {
                field: cone(),
                surface: grey(Border::Plane),
                lights: apart(sphere_light(8.0, 8.0, 4.0)),
            },
        ),
        (
            "cone, open, environment and specular",
            Scene {
                field: cone(),
                surface: Surface {
                    specular: Some(Specular::Constant(PhongSpecular {
                        exponent: 12.0,
                        scale: 0.3,
                    })),
                    ..grey(Border::Open)
                },
                lights: Lights { environment: Some(environment), ..Lights::default() },
            },
        ),
        (
            "spherical pit, plane",
            Scene {
                field: field(13, 13, [1.0, 1.0], |r, c| {
                    let away = (r as f64 - 6.0).hypot(c as f64 - 6.0).min(4.5);
                    -(5.0_f64 * 5.0 - away * away).sqrt()
                }),
                surface: Surface { albedo: Albedo::Constant([0.9; 3]), ..grey(Border::Plane) },
                lights: apart(sphere_light(6.0, 6.0, -1.0)),
            },
        ),
        (
            "fractal, plane, albedo map",
            Scene {
                field: steep,
                surface: Surface { albedo: Albedo::Map(map), ..grey(Border::Plane) },
                lights: apart(sphere_light(6.0, 6.0, 12.0)),
            },
        ),
        (
            "spikes, periodic",
            Scene {
                field: field(6, 6, [1.0, 1.5], |r, c| if (r * 6 + c) % 7 == 0 { 3.0 } else { 0.0 }),
                surface: grey(Border::Periodic),
                lights: apart(sphere_light(2.5, 4.0, 9.0)),
            },
        ),
    ]
}

/// The agreement of a picture with standard errors and a reference with stated errors.
///
/// For each texel and channel, z = (|difference| - stated error, at least 0) / σ. σ is the standard error plus
/// an allowance for events so rare that few or none of the paths sampled one. Bernstein's inequality: N paths
/// of variance v with values of at most W have a mean beyond `off` with probability exp(-off² / 2σ²), σ² = v /
/// N + W·off / 3N. W is taken as the brightest texel.
#[derive(Clone, Copy, Debug)]
pub struct Agreement {
    /// √(mean z²); 1 or less where both errors are right.
    pub rms: f64,
    /// The largest z.
    pub worst: f64,
    /// z of the channel whose mean differs most: one shared bias appears here first.
    pub mean: f64,
    /// The number of z.
    pub count: usize,
}

impl Agreement {
    /// `paths` are those of a texel, infinitely many for noise without rare events; `rounding` is the
    /// arithmetic error of the picture as a share of a value.
    pub fn of<const N: usize>(
        [picture, standard_error]: [&[[f64; N]]; 2],
        [ground_truth, stated]: [&[[f64; N]]; 2],
        paths: f64,
        rounding: f64,
    ) -> Self {
        // NaN is not within what is allowed.
        let z = |off: f64, allowed: f64, sigma: f64| match off.abs() - allowed {
            within if within <= 0.0 => 0.0,
            beyond => beyond / sigma,
        };
        let (mut squares, mut worst, mut mean) = (0.0, 0.0_f64, 0.0_f64);
        for i in 0..N {
            let brightest = ground_truth.iter().fold(0.0_f64, |m, v| m.max(v[i]));
            let (mut off_sum, mut allowed_sum, mut variance) = (0.0, 0.0, 0.0);
            for (at, got) in picture.iter().enumerate() {
                let off = got[i] - ground_truth[at][i];
                let allowed = stated[at][i] + rounding * ground_truth[at][i].abs();
                let rare = brightest * off.abs() / (3.0 * paths);
                let here_variance = standard_error[at][i].powi(2) + rare;
                let here = z(off, allowed, here_variance.sqrt());
                squares += here * here;
                worst = worst.max(here);
                off_sum += off;
                allowed_sum += allowed;
                variance += here_variance;
            }
            mean = mean.max(z(off_sum, allowed_sum, variance.sqrt()));
        }
        let count = N * picture.len();
        Self { rms: (squares / count as f64).sqrt(), worst, mean, count }
    }

    /// Whether Monte Carlo noise explains the difference: rms within four of its own standard deviations 1/√(2·count)
    /// of 1 (noise whose standard error is itself an estimate), the mean within 4 and the worst within 6.
    pub fn holds(&self) -> bool {
        self.rms <= self.most_rms() && self.worst <= 6.0 && self.mean <= 4.0
    }

    /// The largest accepted `rms`.
    pub fn most_rms(&self) -> f64 {
        1.0 + 4.0 / (2.0 * self.count as f64).sqrt()
    }
}
