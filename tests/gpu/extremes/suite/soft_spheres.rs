//! Sphere lights by spherical harmonics at the extremes: the same scenes as exact ones. The expected values of the
//! series are known in f64, from the surface's own horizons or a pyramid's.

use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::{Border, Levels};
use ridgelight_cpu::height_expand::height_expand;
use ridgelight_cpu::height_reduce::height_levels;
use ridgelight_cpu::light::normal;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shared::levels::LevelTexels;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::soft_sphere::{SphereShError, device_pyramid_within, device_surface_within};
use ridgelight_cpu::sphere_sh_shade::SphereSh;
use ridgelight_cpu::tolerance::{
    EPSILON, SphereGeometry, device_pyramid_angle, device_pyramid_slope,
};

use super::{About, Case, Found, Method, Probe, sphere_lights};

pub fn cases() -> Vec<Case> {
    // Borders alone do not change the series.
    let is_other = |case: &Case| case.scene.surface.border != Border::Open;
    sphere_lights::cases().into_iter().filter(is_other).map(soft).collect()
}

fn soft(case: Case) -> Case {
    Case {
        name: format!("{}, by harmonics", case.name),
        about: About::SoftSpheres,
        expected: "what their order keeps of it, from the same series in f64, at least 0"
            .to_owned(),
        bound: "what f32 may do to the series (`crates/cpu/src/direct/soft_sphere.rs`), and 4 ε"
            .to_owned(),
        probes: Box::new(probes),
        // Over 64 cells a pyramid's levels may err by more than a sphere light's width.
        unjudged: match super::relief(&case.scene.field) > 16.0 {
            true => super::is_pyramid,
            false => super::none,
        },
        ..case
    }
}

fn probes(found: &Found) -> Vec<Probe> {
    let (field, border) = (&found.scene.field, found.scene.surface.border);
    let (quality, sphere_light) = (&found.method.quality, &found.scene.lights.sphere_lights[0]);
    let pyramid = Pyramid::new(quality, [field.cols() as u32, field.rows() as u32], border);
    let texels = height_levels(&Heights::of(field, border), &pyramid);
    let of = LevelTexels { pyramid: &pyramid, texels: &texels };
    let stack: Vec<f32> = (1..=pyramid.levels()).flat_map(|n| height_expand(&of, n)).collect();
    let stored = match quality.levels {
        Levels::Stack => Stored::Stack(&stack),
        Levels::Pyramid => Stored::Levels(&texels),
    };
    let levels = found.method.is_pyramid().then_some((pyramid, stored));
    let reference = SphereSh::new(Oracle::new(field, border), levels, *quality);
    let errors = SphereShError::new(quality);
    let (rows, cols) = (field.rows(), field.cols());
    let at = |[row, col]: [usize; 2]| {
        let soft = reference.at(sphere_light, row, col);
        let visible = SphereGeometry::of(field, sphere_light, row * cols + col);
        let slope = slope_error(&visible, found.method, super::largest(field));
        let off =
            errors.tolerance(&visible, slope, normal(field, border, row, col), &soft.visibility);
        let radiance = f64::from(sphere_light.radiance[0]);
        let light = soft.light.max(0.0);
        Probe {
            found: found.light("direct.sphere_light1", row, col),
            expected: [radiance * light; 2],
            bound: radiance * (off + 4.0 * EPSILON * light),
            at: [0, row, col],
        }
    };
    let places = [[0, 0], [rows / 2, cols / 2], [rows / 3, cols - 1], [rows / 2, cols / 4]];
    places.map(at).into()
}

/// The error of slopes towards a sphere light, where a pyramid's levels, too, are the CPU reference's.
fn slope_error(visible: &SphereGeometry, method: &Method, largest: f64) -> f64 {
    if !method.is_pyramid() {
        return device_surface_within(visible);
    }
    let (relief, step) = (visible.relief_m, visible.cell_m);
    let steepest = relief / step;
    let march = device_pyramid_slope(steepest, largest, relief, step)
        + (1.0 + steepest * steepest) * device_pyramid_angle(largest, relief, step);
    device_pyramid_within(visible, march, steepest, method.quality.level_step)
}
