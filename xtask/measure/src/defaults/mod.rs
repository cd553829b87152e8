//! The default settings beside others: errors against exact horizons and times, on terrains of each ground, with all borders and under
//! each kind of light; whether the default meets its goals, and whether another setting is both faster and at least as accurate.
//!
//! Most of the time is that of brute force with border `periodic`, whose rays are the longest: there the program has fewer fields and
//! settings.

mod light;
mod summary;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::scene::{Albedo, Border, Quality, Scene};

use crate::common::args::Args;
use crate::common::frames::{device, new_heights_in_turn};
use crate::common::terrains::{BORDERS, OF_A_FOLDER, border_name, terrains};
use crate::common::{Outcome, head, inputs, median};
use light::{
    BOUNCED_ALBEDO, BOUNCES, FINE_AZIMUTHS, FINE_BOUNCE_AZIMUTHS, FINER, Kind, LOW_SUN, Light,
    PERIODIC_AZIMUTHS, PICKS, TURNS, modes,
};
use summary::Summary;

/// Of light: the relative RMSE, %, and 0. Of horizons: mean and 99.9th percentile, degrees.
pub type Errors = [f64; 2];

/// One setting over one terrain, with one border, under one light.
pub struct Row {
    flags: &'static str,
    errors: Errors,
    ms: f64,
    /// Its time over that of the default.
    time: f64,
}

impl Row {
    /// Errors and time in the decimals that are printed: smaller differences are rounding and noise.
    fn printed(&self) -> ([i64; 2], i64) {
        (self.errors.map(|e| (1000.0 * e).round() as i64), (100.0 * self.time).round() as i64)
    }

    /// Whether it is faster than another row and at least as accurate.
    fn beats(&self, other: &Row) -> bool {
        let ((errors, time), (others, others_time)) = (self.printed(), other.printed());
        time < others_time && errors[0] <= others[0] && errors[1] <= others[1]
    }
}

/// Errors and times of all settings, the default first.
fn compare(gpu: &mut Headless, light: &Light, scene: &Scene) -> Result<Vec<Row>> {
    let modes = modes(light.kind, scene.surface.border);
    let exact = light.exact(gpu, scene, &modes)?;
    let mut frames = Vec::new();
    for mode in &modes {
        frames.push(light.frame(gpu, scene, &mode.quality)?);
    }
    let turns: Vec<usize> = modes.iter().map(|mode| mode.turns).collect();
    let times = new_heights_in_turn(gpu, &mut frames, &turns)?;
    let times: Vec<f64> = times.into_iter().map(median).collect();
    let mut rows = Vec::new();
    for ((mode, frame), ms) in modes.iter().zip(frames).zip(&times) {
        let errors = exact.errors(gpu, (scene, &mode.quality), &frame)?;
        gpu.end(frame);
        rows.push(Row { flags: mode.flags, errors, ms: *ms, time: ms / times[0] });
    }
    Ok(rows)
}

pub fn run(mut args: Args) -> Outcome {
    let (side, folder) = (args.number("--side", 128_usize)?, args.path("--data")?);
    let (terrains, lights) =
        (terrains(folder.as_deref(), [side; 2])?, light::all(folder.as_deref())?);
    let mut gpu = args.open()?;
    let Quality { azimuths, sun_azimuths, .. } = Quality::default();
    println!(
        "{}: frames of new heights of {side}², {azimuths} azimuths, {sun_azimuths} slices for a key light 25° wide, other widths in proportion, from half to four times as many; medians of {TURNS}, drawn in \
         turn (exact lines and brute force once)\n\
         Error of light: RMSE relative to the mean, %, against brute force in {FINE_AZIMUTHS} azimuths (border periodic: \
         {PERIODIC_AZIMUTHS}) and tables of 1024 elevations, without voids; key lights: against brute force in {FINER} times as many slices as the default; `--lines exact` refuses key lights\n\
         Bounces: {BOUNCES}, albedo {BOUNCED_ALBEDO}; the error is of direct and indirect light together, against brute force in {FINE_AZIMUTHS} azimuths, its \
         bounces in {FINE_BOUNCE_AZIMUTHS} at every grid point\n\
         Error of horizons: mean, °, against brute force in the same azimuths, so that brute force has none; exact lines: against the \
         f64 oracle in theirs at {PICKS} grid points\n\
         Borders: plane with all settings, the others with fewer; periodic on the first field of each ground\n\
         Frontier: yes where no faster setting of this table has errors that are at most as large, in the printed decimals",
        device(&gpu),
    );
    if folder.is_none() {
        println!(
            "Left out without --data FOLDER: {} fields and 1 environment ({}, {LOW_SUN})",
            OF_A_FOLDER.len(),
            OF_A_FOLDER.map(|(name, _)| name).join(", ")
        );
    }
    println!();
    head(
        "| field | border | light | settings | error % or mean ° | 99.9 % ° | ms | time over the default | frontier |",
    );
    let mut summary = Summary::default();
    for (k, terrain) in terrains.iter().enumerate() {
        let is_first = terrains[..k].iter().all(|earlier| earlier.ground != terrain.ground);
        let borders = BORDERS.into_iter().filter(|b| is_first || *b != Border::Periodic);
        for (border, light) in borders.flat_map(|b| lights.iter().map(move |l| (b, l))) {
            let mut scene = inputs::lit_by(terrain.field.clone(), light.lights.clone());
            scene.surface.border = border;
            if light.kind == Kind::Bounces {
                scene.surface.albedo = Albedo::Constant([BOUNCED_ALBEDO; 3]);
            }
            let rows = compare(&mut gpu, light, &scene)?;
            let place = format!("{} | {} | {}", terrain.name, border_name(border), light.name);
            for row in &rows {
                let [error, high] = row.errors;
                let high = match light.kind {
                    Kind::Horizons => format!("{high:.3}"),
                    _ => "-".to_owned(),
                };
                let is_best = !rows.iter().any(|other| other.beats(row));
                println!(
                    "| {place} | {} | {error:.3} | {high} | {:.2} | {:.2} | {} |",
                    row.flags,
                    row.ms,
                    row.time,
                    if is_best { "yes" } else { "no" }
                );
            }
            summary.add(light, terrain.ground, &rows);
        }
    }
    println!();
    summary.print();
    Ok(())
}
