//! Choices of earlier runs, in the user's cache: the same question gets the same settings, at once.

use std::hash::Hasher;
use std::path::PathBuf;

use ridgelight::Result;
use ridgelight::gpu::DeviceReport;
use ridgelight::plan::{Limits, Picture};
use ridgelight::scene::{Quality, SETTINGS, Scene};
use ridgelight_trade::auto::{Chosen, Goal};
use serde::{Deserialize, Serialize};

use super::auto;
use crate::setup::{scene_hash, tuned};

/// What a run with a goal prints and writes about its choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The chosen settings, by name.
    settings: Vec<(String, String)>,
    /// Metadata for files and --json.
    pub metadata: Vec<(String, String)>,
    /// The settings that were tried, with times.
    pub tried: String,
    /// How many settings were tried.
    count: usize,
    sentences: Vec<String>,
    /// Whether an earlier run made the choice.
    #[serde(skip)]
    is_remembered: bool,
}

impl Choice {
    pub fn of((goal, seed): (Goal, u32), chosen: &Chosen, scene: &Scene) -> Self {
        let quality = &chosen.trial.quality;
        Self {
            settings: SETTINGS.iter().map(|s| (s.name.to_owned(), s.get(quality))).collect(),
            metadata: auto::metadata((goal, seed), chosen, scene),
            tried: auto::tried(goal, chosen, scene, true),
            count: chosen.trials.len(),
            sentences: auto::sentences(goal, chosen, scene),
            is_remembered: false,
        }
    }

    /// The choice in words.
    pub fn sentences(&self) -> Vec<String> {
        let when =
            if self.is_remembered { " in an earlier run, which made this choice" } else { "" };
        let mut all = self.sentences.clone();
        if let Some(first) = all.first_mut() {
            *first += &format!("; {} settings tried{when}", self.count);
        }
        all
    }

    /// # Errors
    /// Settings that this program does not have, in a file that another wrote.
    pub fn quality(&self) -> Result<Quality> {
        let mut quality = Quality::default();
        for (name, value) in &self.settings {
            let Some(setting) = SETTINGS.iter().find(|s| s.name == name) else {
                return Err(ridgelight::Error::setting(name, value, "a setting"));
            };
            setting.set(&mut quality, value)?;
        }
        quality.check()?;
        Ok(quality)
    }
}

/// A choice's place in the cache: a file named by everything that it depends on.
pub struct Place(Option<PathBuf>);

impl Place {
    /// The place for a scene, a goal and a seed, and the settings that stay the user's. `None` without a folder for
    /// caches.
    pub fn of(
        (device, limits): (&DeviceReport, &Limits),
        scene: &Scene,
        (goal, seed): (Goal, u32),
        quality: &Quality,
        wanted: Picture,
    ) -> Self {
        let mut hash = tuned::hash(device);
        let Scene { field, surface, lights } = scene;
        // The hash of the surface includes the border.
        let of_scene = [
            scene_hash::field(field),
            scene_hash::lights(lights, Some(field.base_m())),
            scene_hash::surface(surface),
        ];
        let all = (of_scene, goal, seed, quality, wanted, limits);
        hash.write(format!("{all:?}").as_bytes());
        let name = format!("choices/{:016x}.json", hash.finish());
        Self(tuned::caches().map(|folder| folder.join(name)))
    }

    /// What an earlier run chose. A file that cannot be read is none.
    pub fn find(&self) -> Option<Choice> {
        let text = std::fs::read(self.0.as_ref()?).ok()?;
        let choice: Choice = serde_json::from_slice(&text).ok()?;
        Some(Choice { is_remembered: true, ..choice })
    }

    /// Keeps a choice.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn keep(&self, choice: &Choice) -> Result<()> {
        let Some(path) = &self.0 else { return Ok(()) };
        tuned::write(path, &serde_json::json!(choice))
    }
}
