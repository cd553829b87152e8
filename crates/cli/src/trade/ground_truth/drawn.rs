//! A computed ground truth, as dense as the time budget allows.

use std::time::Instant;

use ridgelight::scene::{Fuse, Lights, Lines, Method, Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_cpu::lit::Lit;
use ridgelight_trade::auto::{Probes, unsure};

use super::super::rig::Rig;
use super::GroundTruth;
use crate::setup::terminal::percent;

/// Shares of the budget for computing the ground truth, and for probing it.
const DRAWING: f64 = 0.4;
const PROBING: f64 = 0.1;
/// Largest counts, halved until they fit: azimuths, slices of a sun, key light or sphere light,
/// elevations.
const MOST: [u32; 3] = [512, 64, 4096];
/// Largest number of halvings. Brute force with few azimuths is no ground truth and favours
/// settings with as many.
const BRUTE_HALVINGS: u32 = 1;
const HALVINGS: u32 = 3;
/// Fewest probes for the normal approximation of the bound.
const FEWEST_PROBES: usize = 64;
/// Makes probes reproducible.
const SEED: u64 = 0;
impl GroundTruth {
    /// Adds up separate frames: suns and key lights, sphere lights, then the rest. Each is brute
    /// force where that fits into its share of the budget, else the densest sweep. Sphere lights
    /// use as many slices as fit.
    pub fn draw(rig: &mut Rig) -> Result<Self> {
        let scene = rig.scene;
        let [near, _] = scene.lights.near_and_far();
        let is_near = near.near().next().is_some();
        let Lights { sky, environment, suns, keys, .. } = scene.lights.clone();
        let aimed = match (suns.is_empty(), keys.is_empty()) {
            (_, true) => "suns",
            (true, false) => "key lights",
            (false, false) => "suns and key lights",
        };
        let none = Lights::default();
        let has_sky = sky.is_some() || environment.is_some();
        let parts = [
            (!suns.is_empty() || !keys.is_empty(), aimed, Lights { suns, keys, ..none.clone() }),
            (is_near, "sphere lights", near),
            (has_sky, "sky", Lights { sky, environment, ..none }),
        ];
        let parts: Vec<(&str, Scene)> = parts
            .into_iter()
            .filter(|(is_there, ..)| *is_there)
            .map(|(_, name, lights)| (name, Scene { lights, ..scene.clone() }))
            .collect();
        let mut share = rig.share(DRAWING);
        let (mut whole, mut halved, mut about) = (Vec::new(), Vec::new(), Vec::new());
        let last = parts.len() - 1;
        for (i, (name, part)) in parts.iter().enumerate() {
            let begun = Instant::now();
            let seconds = if i < last { 0.5 * share } else { share };
            let [quality, half] = match part.lights.near().next().is_none() {
                true => affordable(rig, part, seconds)?,
                false => affordable_slices(rig, part, seconds)?,
            };
            add(&mut whole, rig.draw_once(part, &quality)?);
            add(&mut halved, rig.draw_once(part, &half)?);
            about.push(format!("{name} by {}", used(rig, part, &quality)?));
            share -= begun.elapsed().as_secs_f64();
        }
        let mut ground_truth = Self::new(whole, scene.field.cols(), about.join("; "));
        let steps = ground_truth.distance(&halved)?.relative_rmse;
        let unsure = unsure(scene, [&ground_truth.planes, &halved], None);
        let probes = probes(&Lit::of(scene), &unsure, rig.share(PROBING))?;
        let off = probes.error(&ground_truth.planes, None, Probes::ONE_BOUND);
        ground_truth.own_error = Some(steps.max(off.at_most));
        ground_truth.quality_of = format!(
            "with half its counts it changes by {} (RMSE), which bounds its own error where \
                doubling the counts at least halves it; at {} probes, two thirds of them where the two \
                differ most, its error against the f64 oracle is {}, {}; the larger of the two is used",
            percent(steps),
            probes.count(),
            percent(off.error),
            if probes.is_whole() {
                "at every grid point".to_owned()
            } else {
                let confidence = 100.0 * Probes::CONFIDENCE;
                format!("with {confidence:.0} % confidence at most {}", percent(off.at_most))
            }
        );
        Ok(ground_truth)
    }
}

/// Exact light at as many grid points as fit into a time, at least the fewest; two thirds of them are
/// drawn in proportion to the difference of two frames.
fn probes(lit: &Lit<'_>, unsure: &[f64], most_s: f64) -> Result<Probes> {
    let begun = Instant::now();
    let few = Probes::of(lit, FEWEST_PROBES, SEED, unsure)?;
    let each = begun.elapsed().as_secs_f64() / few.count() as f64;
    let left = (most_s - begun.elapsed().as_secs_f64()).max(0.0);
    let fit = ((left / each) as usize).min(Probes::affordable(lit));
    let enough = few.is_whole() || fit <= few.count();
    if enough { Ok(few) } else { Probes::of(lit, fit, SEED, unsure) }
}

/// All counts, halved so many times.
fn counts(quality: &Quality, halvings: u32) -> Quality {
    let [azimuths, sun_azimuths, table_elevations] = MOST.map(|m| m >> halvings);
    Quality { azimuths, sun_azimuths, table_elevations, ..*quality }
}

fn two(quality: &Quality, halvings: u32) -> [Quality; 2] {
    [halvings, halvings + 1].map(|h| counts(quality, h))
}

/// Settings, and the same with half the counts, that take at most so many seconds; the smallest
/// where none do.
fn affordable(rig: &mut Rig, scene: &Scene, seconds: f64) -> Result<[Quality; 2]> {
    let dense = Quality {
        method: Method::Sweep,
        lines: Lines::QuarterCell,
        fuse: Fuse::AimedAround,
        ..Quality::default()
    };
    let brute = Quality { method: Method::BruteForce, ..dense };
    for (quality, most) in [(brute, BRUTE_HALVINGS), (dense, HALVINGS)] {
        // Refused by devices that cannot do this at all.
        if rig.plan(scene, &counts(&quality, most)).is_err() {
            continue;
        }
        let each = rig.seconds_per_azimuth(scene, &quality)?;
        for halvings in 0..=most {
            let two = two(&quality, halvings);
            let [a, b] = two.map(|q| Ok::<_, Error>(rig.plan(scene, &q)?.azimuths.len() as f64));
            if each * (a? + b?) <= seconds {
                return Ok(two);
            }
        }
    }
    Ok(two(&dense, HALVINGS))
}

/// The same for sphere lights alone, with none culled.
fn affordable_slices(rig: &mut Rig, scene: &Scene, seconds: f64) -> Result<[Quality; 2]> {
    let all = Quality { light_cutoff: 0.0, ..Quality::default() };
    let few = counts(&all, HALVINGS + 1);
    rig.draw_once(scene, &few)?;
    let begun = Instant::now();
    rig.draw_once(scene, &few)?;
    let each = begun.elapsed().as_secs_f64() / f64::from(few.sun_azimuths);
    let fits = |two: &[Quality; 2]| {
        each * two.iter().map(|q| f64::from(q.sun_azimuths)).sum::<f64>() <= seconds
    };
    let each_two = (0..HALVINGS).map(|halvings| two(&all, halvings)).find(fits);
    Ok(each_two.unwrap_or_else(|| two(&all, HALVINGS)))
}

/// Adds planes to a sum of none, one or three.
fn add(sum: &mut Vec<Vec<f32>>, planes: Vec<Vec<f32>>) {
    if sum.is_empty() {
        *sum = planes;
        return;
    }
    while sum.len() < planes.len() {
        sum.push(sum[0].clone());
    }
    let last = planes.len() - 1;
    for (c, plane) in sum.iter_mut().enumerate() {
        plane.iter_mut().zip(&planes[c.min(last)]).for_each(|(s, v)| *s += v);
    }
}

/// The settings that a plan uses.
fn used(rig: &Rig, scene: &Scene, quality: &Quality) -> Result<String> {
    const NAMES: [&str; 6] =
        ["method", "lines", "fuse", "azimuths", "sun_azimuths", "table_elevations"];
    let all = rig.plan(scene, quality)?.settings;
    let stated = all.iter().filter(|(name, _)| NAMES.contains(&name.as_str()));
    Ok(stated.map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Surface};

    /// Without time there are 64 probes, with enough time all grid points.
    #[test]
    fn probes_fit_their_time() {
        let of = |side: usize, most_s: f64| {
            let field = HeightField::new(side, side, &vec![0.0; side * side], [1.0; 2], None);
            let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
            let scene = Scene { field: field.unwrap(), surface: Surface::default(), lights };
            probes(&Lit::of(&scene), &vec![0.0; side * side], most_s).unwrap()
        };
        assert_eq!(of(16, 0.0).count(), FEWEST_PROBES);
        assert!(of(12, f64::INFINITY).is_whole() && of(5, 0.0).is_whole());
    }

    #[test]
    fn grey_light_and_colour_add_up() {
        let mut sum = Vec::new();
        add(&mut sum, vec![vec![1.0, 2.0]]);
        add(&mut sum, vec![vec![0.5, 0.0], vec![0.0, 1.0], vec![2.0, 2.0]]);
        add(&mut sum, vec![vec![10.0, 10.0]]);
        assert_eq!(sum, [[11.5, 12.0], [11.0, 13.0], [13.0, 14.0]]);
    }
}
