//! `--sky clear`: the sky around a sun, and the light of scenes without lights.
//!
//! Sky: A. J. Preetham, P. Shirley, B. Smits, A practical analytic model for daylight, SIGGRAPH 1999. Perez's
//! distribution of luminance and chromaticity, appendix A.2; the sun's transmittance, appendix A.1.

use std::f64::consts::PI;

use ridgelight::Result;
use ridgelight::scene::{Environment, Sun};

/// Aerosols of clear air.
const TURBIDITY: f64 = 2.5;
const WIDTH: usize = 128;
const HEIGHT: usize = 64;
/// The sun's illuminance outside the atmosphere, klx (IES: 127.5 to 133.8).
const OUTSIDE_KLX: f64 = 128.0;
/// Below this elevation the sky keeps its ratio to the sun: the transmittance goes to 0.
const LOWEST_DEG: f64 = 5.0;
/// Albedo of the ground beyond the horizon, and the angle below the horizontal over which haze fades.
const GROUND: f64 = 0.2;
const HAZE_DEG: f64 = 40.0;

/// Default elevation and diameter of the sun, degrees: the hillshading convention, and a soft shadow.
const SUN_DEG: [f64; 2] = [35.0, 3.0];
/// Default azimuth on maps, degrees: north-west, the hillshading convention.
const MAP_AZIMUTH_DEG: f64 = 315.0;
/// Between the directions to a camera and to the default sun, degrees.
const CAMERA_SIDE_DEG: f64 = 60.0;

/// Rec. 709 luminance of linear RGB.
pub fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// Words of the default `--sun`, for a map or a camera's compass azimuth.
///
/// Its colour is that of the model. Its strength gives level open ground of albedo 1 the radiance 1 together with the
/// sky: their irradiance is π.
pub fn default_sun(camera_deg: Option<f64>) -> String {
    let azimuth = camera_deg.map_or(MAP_AZIMUTH_DEG, |at| (at + CAMERA_SIDE_DEG).rem_euclid(360.0));
    let [elevation, diameter] = SUN_DEG;
    let colour = transmittance(elevation);
    let model = Sky::new(elevation);
    let level = luminance(colour) * elevation.to_radians().sin()
        + luminance(model.level_irradiance()) / OUTSIDE_KLX;
    let [r, g, b] = colour.map(|c| (100.0 * c * PI / level).round() / 100.0);
    format!("{azimuth},{elevation},{diameter},{r},{g},{b}")
}

/// The clear sky around a sun above the horizontal.
///
/// Its strength relative to the sun is that of air of turbidity 2.5; below 5 degrees it is the ratio at 5 degrees. Below
/// the horizontal it has level ground of albedo 0.2, which lights a field with an open border only.
pub fn clear(sun: &Sun) -> Result<Environment> {
    let elevation = sun.elevation_rad.to_degrees().clamp(0.0, 90.0);
    let colour = transmittance(elevation.max(LOWEST_DEG)).map(|t| t * OUTSIDE_KLX);
    let irradiance = sun.irradiance.map(f64::from);
    let scale = luminance(irradiance) / luminance(colour);
    let sky = Sky::new(elevation);
    let of_sky = sky.level_irradiance();
    let height = sun.elevation_rad.sin();
    let ground: [f64; 3] =
        std::array::from_fn(|c| GROUND / PI * (of_sky[c] * scale + irradiance[c] * height));
    let texels = (0..WIDTH * HEIGHT).map(|i| {
        let [above, around] = direction(i);
        let azimuth = PI - around;
        let lit = sky.radiance(above.max(0.0), azimuth - sun.azimuth_rad).map(|v| v * scale);
        let haze = (1.0 + above.to_degrees() / HAZE_DEG).clamp(0.0, 1.0);
        // Haze loses the horizon's colour within a few degrees.
        let (colour, grey) = (haze.powi(8), luminance(lit));
        std::array::from_fn(|c| {
            let haze_light = colour * lit[c] + (1.0 - colour) * grey;
            (haze * haze_light + (1.0 - haze) * ground[c]) as f32
        })
    });
    Environment::new(WIDTH, HEIGHT, texels.collect(), 0.0)
}

/// Elevation of a texel's centre, and its angle clockwise from column 0, radians.
fn direction(i: usize) -> [f64; 2] {
    let (row, col) = (i / WIDTH, i % WIDTH);
    let below = (row as f64 + 0.5) / HEIGHT as f64;
    [PI * (0.5 - below), 2.0 * PI * (col as f64 + 0.5) / WIDTH as f64]
}

/// Share of sunlight that reaches the ground, at 610, 550 and 465 nm.
fn transmittance(elevation_deg: f64) -> [f64; 3] {
    let sine = elevation_deg.to_radians().sin();
    let mass = 1.0 / (sine + 0.15 * (elevation_deg + 3.885).powf(-1.253));
    let beta = 0.046_08 * TURBIDITY - 0.045_86;
    // Wavelength, micrometres; absorption of 0.35 cm of ozone.
    [(0.61, 0.042), (0.55, 0.030), (0.465, 0.004)].map(|(wave, ozone): (f64, f64)| {
        let rayleigh = 0.008_735 * wave.powf(-4.08);
        let aerosols = beta * wave.powf(-1.3);
        (-(rayleigh + aerosols + ozone) * mass).exp()
    })
}

/// A coefficient per turbidity, and its constant part.
type Linear = (f64, f64);

/// Perez coefficients A to E of luminance and of the chromaticities x and y (table 2).
const PEREZ: [[Linear; 5]; 3] = [
    [(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)],
    [
        (-0.0193, -0.2592),
        (-0.0665, 0.0008),
        (-0.0004, 0.2125),
        (-0.0641, -0.8989),
        (-0.0033, 0.0452),
    ],
    [
        (-0.0167, -0.2608),
        (-0.0950, 0.0092),
        (-0.0079, 0.2102),
        (-0.0441, -1.6537),
        (-0.0109, 0.0529),
    ],
];

/// Chromaticities of the zenith: rows for turbidity², turbidity and 1; columns for powers 3 to 0 of the sun's zenith angle.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ],
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ],
];

/// The sky above a level horizon, in kcd/m² of linear sRGB.
struct Sky {
    /// The sun's zenith angle.
    sun_rad: f64,
    /// Luminance and chromaticity of the zenith.
    zenith: [f64; 3],
}

impl Sky {
    fn new(sun_deg: f64) -> Self {
        let sun_rad = (90.0 - sun_deg).to_radians();
        let chi = (4.0 / 9.0 - TURBIDITY / 120.0) * (PI - 2.0 * sun_rad);
        let bright = (4.0453 * TURBIDITY - 4.9710) * chi.tan() - 0.2155 * TURBIDITY + 2.4192;
        let [x, y] = ZENITH.map(|rows| {
            let [a, b, c] = rows.map(|row| row.iter().fold(0.0, |sum, k| sum * sun_rad + k));
            (a * TURBIDITY + b) * TURBIDITY + c
        });
        Self { sun_rad, zenith: [bright, x, y] }
    }

    /// Radiance at an elevation, 0 or more, and an azimuth from the sun's.
    fn radiance(&self, elevation_rad: f64, azimuth_rad: f64) -> [f64; 3] {
        let (up, sun) = (elevation_rad.sin(), self.sun_rad);
        let across = elevation_rad.cos() * sun.sin() * azimuth_rad.cos();
        let from_sun = (across + up * sun.cos()).clamp(-1.0, 1.0).acos();
        let [luminance, x, y] = std::array::from_fn(|k| {
            let here = perez(&PEREZ[k], up, from_sun);
            self.zenith[k] * here / perez(&PEREZ[k], 1.0, sun)
        });
        // CIE xyY to linear sRGB (IEC 61966-2-1); colours outside its gamut are clipped.
        let [cie_x, cie_z] = [x / y * luminance, (1.0 - x - y) / y * luminance];
        [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
            .map(|row| (row[0] * cie_x + row[1] * luminance + row[2] * cie_z).max(0.0))
    }

    /// Irradiance of level open ground, klx of linear sRGB.
    fn level_irradiance(&self) -> [f64; 3] {
        let texel = PI / HEIGHT as f64 * 2.0 * PI / WIDTH as f64;
        (0..WIDTH * HEIGHT / 2).map(direction).fold([0.0; 3], |sum, [above, around]| {
            let lit = self.radiance(above, around);
            let weight = texel * above.sin() * above.cos();
            std::array::from_fn(|c| sum[c] + weight * lit[c])
        })
    }
}

/// Perez's distribution (eq. 3), at the sine of the elevation and the angle from the sun.
fn perez(coefficients: &[Linear; 5], up: f64, from_sun: f64) -> f64 {
    let [a, b, c, d, e] = coefficients.map(|(of, constant)| of * TURBIDITY + constant);
    let gradient = 1.0 + a * (b / up.max(0.01)).exp();
    let aureole = 1.0 + c * (d * from_sun).exp() + e * from_sun.cos().powi(2);
    gradient * aureole
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::Lights;

    fn sun(words: &str) -> Sun {
        let mut lights = Lights::default();
        crate::setup::lights::light("sun").add(&mut lights, words).unwrap();
        lights.suns[0]
    }

    /// Irradiance of level ground from the upper half of an environment, by its texels.
    fn level(sky: &Environment) -> [f64; 3] {
        let upper = &sky.texels()[..WIDTH * HEIGHT / 2];
        upper.iter().enumerate().fold([0.0; 3], |sum, (i, texel)| {
            let [above, _] = direction(i);
            let weight = 2.0 * PI * PI / (WIDTH * HEIGHT) as f64 * above.sin() * above.cos();
            std::array::from_fn(|c| sum[c] + weight * f64::from(texel[c]))
        })
    }

    /// Two digits after the point of three colours: 0.005 of about 3.5.
    #[test]
    fn default_light_gives_level_ground_radiance_one() {
        for camera in [None, Some(170.0)] {
            let sun = sun(&default_sun(camera));
            let sky = level(&clear(&sun).unwrap());
            let direct = sun.irradiance.map(|c| f64::from(c) * sun.elevation_rad.sin());
            let all = luminance(sky) + luminance(direct);
            assert!((all / PI - 1.0).abs() < 0.003, "{all}");
            let share = luminance(sky) / all;
            assert!((0.25..0.4).contains(&share), "{share}");
        }
        assert!(default_sun(None).starts_with("315,35,3,"), "{}", default_sun(None));
        assert!(default_sun(Some(310.0)).starts_with("10,35,3,"));
    }

    /// The zenith at a sun of 35 degrees, by hand from the paper's formulas: chi = 0.4236 · 1.2217 = 0.5175,
    /// (4.0453 · 2.5 - 4.971) · 0.5693 - 0.5388 + 2.4192 = 4.808 kcd/m².
    #[test]
    fn zenith_is_that_of_the_paper() {
        let [luminance, x, y] = Sky::new(35.0).zenith;
        assert!((luminance - 4.808).abs() < 0.002, "{luminance}");
        // Bluer than D65 (0.3127, 0.3290).
        assert!((0.23..0.26).contains(&x) && (0.23..0.27).contains(&y), "{x} {y}");
    }

    #[test]
    fn sky_is_brightest_around_the_sun_and_blue_at_the_zenith() {
        for azimuth in [0.0, 77.0, 315.0] {
            let sun = sun(&format!("{azimuth},35,1"));
            let sky = clear(&sun).unwrap();
            let bright = |t: &[f32; 3]| t[1];
            let at = (0..WIDTH * HEIGHT / 2)
                .max_by(|a, b| bright(&sky.texels()[*a]).total_cmp(&bright(&sky.texels()[*b])));
            let [above, around] = direction(at.unwrap());
            let off = (PI - around - sun.azimuth_rad).cos().acos().to_degrees();
            assert!(
                off < 3.0 && (above.to_degrees() - 35.0).abs() < 4.0,
                "{azimuth} {off} {above}"
            );
            let [r, _, b] = sky.texels()[0];
            assert!(b > 1.5 * r, "{r} {b}");
        }
    }

    #[test]
    fn skies_are_finite_at_every_elevation() {
        for elevation in [0.0, 0.001, 1.0, 5.0, 45.0, 89.999, 90.0] {
            let sky = clear(&sun(&format!("10,{elevation},0.5"))).unwrap();
            let most = sky.texels().as_flattened().iter().fold(0.0_f32, |m, v| m.max(*v));
            assert!(most > 0.0 && most < 100.0, "{elevation} {most}");
        }
    }
}
