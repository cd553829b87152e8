//! Compares an environment by tables through swept horizons with the same tables and sweeps in f64
//! on the CPU. They may differ by f32 rounding only.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::{Azimuth, Plan};
use ridgelight::scene::{Border, Environment, Lights, Quality, Scene};
use ridgelight_cpu::env_tables::{bottom_sine, env_tables};
use ridgelight_cpu::env_wedges::env_wedges;
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::tolerance::{
    EPSILON, ShadeError, device_resolved, device_table, device_wedge_row,
};

use super::sweeps::{lit, white};
use super::{Device, Wanted, colours, sentence};

/// The scene's environment on white ground, at some texels; none without an environment.
pub(super) fn check(
    scene: &Scene,
    places: &[usize],
    device: &mut Device,
    lines: u32,
) -> Result<Option<String>> {
    let is_lit = |e: &&Environment| e.texels().iter().flatten().any(|v| *v > 0.0);
    let Some(environment) = scene.lights.environment.as_ref().filter(is_lit) else {
        return Ok(None);
    };
    let lights = Lights { environment: Some(environment.clone()), ..Lights::default() };
    let scene = white(scene, lights);
    let (plan, layers) = device.layers(&scene, false)?;
    let wanted = wanted_of(&scene, &plan, places, device.quality, lines);
    let found = colours(&layers[0], places);
    let errors = wanted.judge("the environment at one place", &found, device.quality)?;
    Ok(Some(sentence("environment", "the CPU reference", errors)))
}

/// Light of the CPU reference at each place, and its tolerance. Uses the plan's azimuths, which are denser where the environment is bright.
fn wanted_of(
    scene: &Scene,
    plan: &Plan,
    places: &[usize],
    quality: &Quality,
    line_shift: u32,
) -> Wanted {
    let environment = scene.lights.environment.as_ref().expect("an environment");
    let azimuths = plan.azimuths[..quality.azimuths as usize].to_vec();
    let nodes = quality.table_elevations as usize;
    let (cols, border) = (scene.field.cols(), scene.surface.border);
    let all = lit(scene, azimuths, quality.fuse, line_shift, |swept, error| {
        let rows = env_wedges(environment, border, swept.azimuths);
        let wedges = (environment.height(), swept.azimuths);
        let tables = env_tables(&rows, wedges, nodes, bottom_sine(border));
        let off: Vec<([DVec3; 3], DVec3)> = (0..swept.azimuths.len())
            .map(|k| tables_off(environment, border, swept, &rows, (k, nodes)))
            .collect();
        let at = |p: &usize| {
            let (mut light, mut bound) = (DVec3::ZERO, DVec3::ZERO);
            swept.add_all([p % cols, p / cols].map(|i| i as i32), true, |k, _, lowest, normal| {
                light += tables.light(k, lowest, normal);
                bound += ShadeError::wedge_looked_up(error, &tables, (k, lowest, normal), &off[k]);
            });
            [light, bound + light.map(|v| device_resolved(v, 1))]
        };
        places.iter().map(at).collect()
    });
    Wanted(all)
}

/// Tolerance of one azimuth's tables, per moment: their own ([`device_table`]), and that of the
/// wedge's rows by the brightest of their texels ([`device_wedge_row`]). A table holds moments of
/// elevations: at most a row's height of each, over π. And of the part between two nodes.
fn tables_off(
    environment: &Environment,
    border: Border,
    swept: &Swept,
    rows: &[[DVec3; 3]],
    (k, nodes): (usize, usize),
) -> ([DVec3; 3], DVec3) {
    let azimuth = &swept.azimuths[k];
    let (width, height) = (environment.width(), environment.height());
    let kept = environment.rows_above_ground(border);
    let columns = f64::from(azimuth.wedge_rad) / TAU * width as f64 + 2.0;
    let brightest = |row: usize| {
        let texels = columns_of(environment, azimuth);
        let brightest = texels.map(|x| environment.texels()[row * width + x].map(f64::from));
        brightest.fold(DVec3::ZERO, |m, t| m.max(DVec3::from_array(t)))
    };
    let of_row =
        |row| brightest(row).map(|b| device_wedge_row(b, azimuth.wedge_rad.into(), columns));
    let of_rows: DVec3 = (0..kept).map(of_row).sum();
    let of_worst = (0..kept).map(of_row).fold(DVec3::ZERO, DVec3::max);
    let own = &rows[k * kept..(k + 1) * kept];
    let brightest_row = own.iter().fold(DVec3::ZERO, |most, row| most.max(row[2].abs()));
    // Rows of one step, at two ends that err by ε each and as much in rounding.
    let step = (1.0 - bottom_sine(border)) / (nodes - 1) as f64;
    let part = (of_worst * step + 4.0 * EPSILON * brightest_row) / PI;
    let moments = [0, 1, 2].map(|moment| {
        let all = own.iter().map(|row| row[moment].abs());
        let largest = all.clone().fold(DVec3::ZERO, DVec3::max);
        let sum: DVec3 = all.sum();
        let table = |c| device_table(sum[c], largest[c], (kept + nodes) as f64);
        DVec3::new(table(0), table(1), table(2)) + of_rows / height as f64
    });
    (moments, part)
}

/// Columns of texels that overlap a wedge, and one more on either side.
fn columns_of(environment: &Environment, azimuth: &Azimuth) -> impl Iterator<Item = usize> {
    let width = environment.width() as f64;
    let middle = (PI + environment.rotation_rad() - f64::from(azimuth.centre_rad)) / TAU * width;
    let half = 0.5 * f64::from(azimuth.wedge_rad) / TAU * width + 1.0;
    let (first, last) = ((middle - half).floor() as i64, (middle + half).ceil() as i64);
    let width = environment.width() as i64;
    (first..last).map(move |x| x.rem_euclid(width) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::verify::tests::{places, scene};
    use ridgelight::plan::{self, Limits, Picture};
    use ridgelight::scene::Fuse;

    /// Wrong light is refused, with and without a peak in an even environment: of another fuse, of
    /// 8 elevations, rotated by a column.
    #[test]
    fn wrong_environments_are_refused() {
        for peak in [0.0, 3000.0] {
            let texel = |i: usize| {
                let peak = if i == 700 { peak } else { 0.0 };
                [1.0 + (i % 64) as f32 / 64.0 + peak, 0.5 + (i / 64) as f32 / 8.0, 0.25]
            };
            let of = |turn: f64, quality: &Quality| {
                let texels = (0..64 * 32).map(texel).collect();
                let environment = Environment::new(64, 32, texels, turn).unwrap();
                let lights = Lights { environment: Some(environment), ..Lights::default() };
                let scene = scene(48, lights);
                let limits = Limits::lavapipe();
                let plan = plan::picture(&scene, quality, &limits, Picture::default()).unwrap();
                wanted_of(&scene, &plan, &places(), quality, quality.lines.shift().unwrap())
            };
            let quality = Quality { azimuths: 16, ..Quality::default() };
            let wrong = [
                ("fuse", of(0.0, &Quality { fuse: Fuse::Nearest, ..quality }).light()),
                ("coarse", of(0.0, &Quality { table_elevations: 8, ..quality }).light()),
                ("turned", of(TAU / 64.0, &quality).light()),
            ];
            of(0.0, &quality).refuses(&quality, [0.005, 0.99], &wrong);
        }
    }
}
