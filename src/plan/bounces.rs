//! Light that the surface throws at itself: which bounces are drawn, and their passes.
//!
//! A bounce's engine reads the exit radiance of the one before, and whatever it needs of the heights, and
//! writes what arrives at every sample; `light_resolve` makes that the bounce's own exit radiance.

use super::azimuths::{self, Azimuth};
use super::blocks::Blocks;
use super::sweeping::{Sweeping, part};
use super::{Batch, Builder, Format, Owner, ResourceId};
use crate::passes::{bounce_march, bounce_walk};
use crate::scene::{BounceEngine, Bounces, Scene};

/// What an engine's passes are told of one bounce.
pub(crate) struct Bounce {
    /// As in labels: "bounce1" is the first.
    pub name: String,
    /// What it is, to begin a reason with.
    pub why: String,
    /// Exit radiance of all samples, albedo and all, to be thrown on: four channels, or one where `grey`.
    pub exit: ResourceId,
    pub grey: bool,
    /// To be written: exit radiance for albedo 1, R, G, B; the fourth channel is the engine's own.
    pub sum: ResourceId,
}

/// The bounces of a picture, and what their passes read and write.
pub(super) struct Bouncing {
    engine: BounceEngine,
    azimuths: u32,
    grey: bool,
    sum: ResourceId,
    /// Exit radiance of each bounce: its layer where wanted, else one image, used in turn; the last one's goes
    /// into the picture alone.
    exits: Vec<Option<ResourceId>>,
}

impl Bouncing {
    /// None where no bounce is worth drawing.
    pub fn make(
        builder: &mut Builder,
        scene: &Scene,
        bounces: &Bounces,
        (grey, layers): (bool, bool),
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let albedo = f64::from(scene.surface.albedo.largest());
        let count = bounces.worth_drawing(albedo);
        if count < bounces.count {
            notes.push(dropped(bounces, count, albedo));
        }
        if count == 0 {
            return None;
        }
        let extent = [scene.field.cols() as u32, scene.field.rows() as u32, 1];
        let colour = if grey { Format::R32Float } else { Format::Rgba32Float };
        let mut image = |name: &str, owner: Owner, format: Format| {
            builder.image(name, owner, format, extent, false)
        };
        let exits = if layers {
            let layer = |k| image(&format!("indirect.{k}"), Owner::Output, colour);
            (1..=count).map(layer).map(Some).collect()
        } else {
            let exit = (count > 1).then(|| image("exit_radiance", Owner::Internal, colour));
            (1..=count).map(|k| exit.filter(|_| k < count)).collect()
        };
        let sum = image("bounce_sum", Owner::Internal, Format::Rgba32Float);
        let Bounces { engine, azimuths, .. } = *bounces;
        Some(Self { engine, azimuths, grey, sum, exits })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.exits.len()
    }

    /// Whether rays over the surface are needed.
    pub fn needs_blocks(&self) -> bool {
        self.engine == BounceEngine::Brute
    }

    /// Azimuths that are swept for bounces alone.
    pub fn circle(&self, cell_m: [f64; 2]) -> Option<Vec<Azimuth>> {
        (self.engine == BounceEngine::Sweep).then(|| azimuths::even(self.azimuths, cell_m))
    }

    /// The passes of bounce `k`, the first is 1; `direct` is what it begins with. Returns what arrives, and
    /// where its exit radiance belongs.
    pub fn record(
        &self,
        builder: &mut Builder,
        (scene, direct): (&Scene, ResourceId),
        k: usize,
        (blocks, swept): (Option<&Blocks>, Option<(&Sweeping, &[Batch])>),
    ) -> (ResourceId, Option<ResourceId>) {
        let before = k.checked_sub(2).and_then(|i| self.exits[i]);
        let bounce = Bounce {
            name: bounce_name(k),
            why: match k {
                1 => "direct light off the surface".to_owned(),
                _ => format!("light of bounce {} off the surface", k - 1),
            },
            exit: before.unwrap_or(direct),
            grey: self.grey,
            sum: self.sum,
        };
        match self.engine {
            BounceEngine::Brute => {
                let blocks = blocks.expect("rays have blocks");
                bounce_march::plan(builder, scene, blocks, self.azimuths, &bounce);
            }
            BounceEngine::Sweep => {
                let (sweeping, batches) = swept.expect("walks have sweeps");
                walk(builder, scene, k, (sweeping, batches), &bounce);
            }
        }
        (self.sum, self.exits[k - 1])
    }

    /// The settings really used.
    pub fn used(&self) -> Vec<(String, String)> {
        vec![
            ("bounce_engine".into(), self.engine.name().into()),
            ("bounce_azimuths".into(), self.azimuths.to_string()),
        ]
    }
}

/// The sweeps that a bounce walks over, and the walks.
fn walk(
    builder: &mut Builder,
    scene: &Scene,
    k: usize,
    (sweeping, batches): (&Sweeping, &[Batch]),
    bounce: &Bounce,
) {
    for (i, batch) in batches.iter().enumerate() {
        let part = part(&bounce.name, batch, batches);
        let occluders = sweeping.occluders(batch).expect("kept for walks");
        // A lattice of its own still holds what the first bounce has swept.
        let is_shared =
            batches.iter().filter(|b| sweeping.occluders(b) == Some(occluders)).count() > 1;
        if k == 1 || is_shared {
            sweeping.record(builder, batch, &part);
        }
        let swept = bounce_walk::Swept {
            lane_heights: sweeping.lane_heights(batch),
            azimuths: sweeping.azimuths,
            occluders,
            line_shift: sweeping.sweep.line_shift(),
            is_last: i + 1 == batches.len(),
        };
        let field = (scene.surface.border, scene.field.cell_m());
        bounce_walk::plan(builder, field, (batch, &part), &swept, bounce);
    }
}

/// As in labels.
pub(super) fn bounce_name(k: usize) -> String {
    format!("bounce{k}")
}

/// Why bounces are left out.
fn dropped(bounces: &Bounces, count: u32, albedo: f64) -> String {
    if albedo == 0.0 {
        return "no bounces: the surface reflects nothing".into();
    }
    let first = count + 1;
    let all: f64 = (first..=bounces.count).map(|k| albedo.powi(k as i32)).sum();
    format!(
        "bounces {first} to {} dropped: of a surface that reflects at most {albedo} they carry at most {all:.3e} of \
         the direct light, within --bounce-cutoff {}",
        bounces.count, bounces.cutoff
    )
}
