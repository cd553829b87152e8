//! Compares sphere lights slice by slice with the same slices in f64 on the CPU. They may differ by
//! f32 rounding only.

use glam::DVec3;
use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Lights, Quality, Scene};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere_shade::sphere_at;
use ridgelight_cpu::tolerance::{EPSILON, SphereGeometry, device_resolved};

use super::sweeps::white;
use super::{colours, judge, percent};

/// The scene's sphere lights on white ground, at some texels; none where none has radiance.
pub(super) fn check(
    scene: &Scene,
    places: &[usize],
    gpu: &mut Headless,
    quality: &Quality,
    limits: &Limits,
) -> Result<Option<String>> {
    let mut spheres = scene.lights.sphere_lights.clone();
    spheres.retain(|sphere_light| sphere_light.radiance.iter().any(|v| *v > 0.0));
    if spheres.is_empty() {
        return Ok(None);
    }
    let scene =
        Scene { lights: Lights { sphere_lights: spheres, ..Lights::default() }, ..white(scene) };
    let plan = plan::picture(&scene, quality, limits, Picture::default())?;
    let picture = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        gpu.pixels(frame, 0)
    })?;
    let wanted = Wanted::of(&scene, places, quality);
    let (error, bound) = wanted.judge(&colours(&picture, places), quality)?;
    Ok(Some(format!(
        "sphere light error {} against f64 slices (RMSE; bound {})",
        percent(error),
        percent(bound)
    )))
}

/// Light of the CPU reference at each place, R, G, B, and its tolerance.
struct Wanted(Vec<[[f64; 2]; 3]>);

impl Wanted {
    fn of(scene: &Scene, places: &[usize], quality: &Quality) -> Self {
        let oracle = Oracle::new(&scene.field, scene.surface.border);
        let (cols, sphere_lights) = (scene.field.cols(), &scene.lights.sphere_lights);
        let at = |p: &usize| {
            let mut all = [[0.0; 2]; 3];
            for sphere_light in sphere_lights {
                let light =
                    sphere_at(&oracle, sphere_light, quality.sun_azimuths, p / cols, p % cols);
                let off =
                    SphereGeometry::of(&scene.field, sphere_light, *p).tolerance() + 4.0 * EPSILON;
                for ([want, bound], radiance) in all.iter_mut().zip(sphere_light.radiance) {
                    *want += f64::from(radiance) * light;
                    *bound += f64::from(radiance) * off;
                }
            }
            all.map(|[want, bound]| [want, bound + device_resolved(want, sphere_lights.len())])
        };
        Self(places.iter().map(at).collect())
    }

    fn judge(&self, found: &[DVec3], quality: &Quality) -> Result<(f64, f64)> {
        let found = found.iter().flat_map(|v| v.to_array());
        judge("sphere light at one place", found, self.0.as_flattened(), quality)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::fractal;
    use ridgelight::scene::{SphereLight, Surface};

    /// Wrong light is refused: 1 % too dark, of fewer slices, of a light a tenth of a cell aside or
    /// a tenth wider, without occlusion, of a neighbour, of other colours, and NaN.
    #[test]
    fn wrong_sphere_lights_are_refused() {
        let field = fractal(48, 1).unwrap();
        let cell = field.cell_m()[0];
        let highest = f64::from(field.heights_m().iter().fold(0.0_f32, |m, h| m.max(*h)));
        let places: Vec<usize> = (3..48 * 48).step_by(61).collect();
        let of = |aside: f64, wider: f64, quality: &Quality, is_flat: bool| {
            let z = field.base_m() + highest + 2.0 * cell;
            let radiance = [4.0, 2.0, 1.0];
            let position_m = [(20.0 + aside) * cell, 30.0 * cell, z];
            let sphere_light = SphereLight { position_m, radius_m: wider * cell, radiance };
            let lights = Lights { sphere_lights: vec![sphere_light], ..Lights::default() };
            let mut field = field.clone();
            if is_flat {
                let level = vec![field.base_m(); 48 * 48];
                field =
                    ridgelight::scene::HeightField::new(48, 48, &level, [cell; 2], None).unwrap();
            }
            let scene = Scene { field, surface: Surface::default(), lights };
            Wanted::of(&scene, &places, quality)
        };
        let quality = Quality { sun_azimuths: 8, ..Quality::default() };
        let wanted = of(0.0, 1.0, &quality, false);
        let values = |wanted: &Wanted| -> Vec<DVec3> {
            wanted.0.iter().map(|all| DVec3::from_array(all.map(|w| w[0]))).collect()
        };
        let right = values(&wanted);
        let (error, bound) = wanted.judge(&right, &quality).unwrap();
        println!("bound {bound:e}");
        assert!(error == 0.0 && bound < 0.005, "{bound}");
        let mut turned = right.clone();
        turned.rotate_left(1);
        let mut holed = right.clone();
        holed[3][1] = f64::NAN;
        let wrong = [
            ("dim", right.iter().map(|v| 0.99 * *v).collect()),
            (
                "of fewer slices",
                values(&of(0.0, 1.0, &Quality { sun_azimuths: 4, ..quality }, false)),
            ),
            ("from beside", values(&of(0.1, 1.0, &quality, false))),
            ("wider", values(&of(0.0, 1.1, &quality, false))),
            ("on level ground", values(&of(0.0, 1.0, &quality, true))),
            ("of a neighbour", turned),
            ("of other colours", right.iter().map(|v| DVec3::new(v.z, v.y, v.x)).collect()),
            ("NaN", holed),
        ];
        for (name, light) in wrong {
            assert!(wanted.judge(&light, &quality).is_err(), "{name} passes");
        }
    }
}
