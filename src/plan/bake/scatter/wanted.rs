//! The part of the requested scattering that the scene needs.

use super::towards;
use crate::Result;
use crate::passes::bounces::dropped;
use crate::scene::{Bounces, Directions, Scatter, Scene, Specular, Sun};

/// The effective settings.
pub(super) struct Wanted<'a> {
    /// The surface's specular, if its scale is above 0.
    pub specular: Option<&'a Specular>,
    /// Whether specular reflects sky or environment.
    pub mirrors_sky: bool,
    /// Suns that specular reflects.
    pub suns: Vec<Sun>,
    /// 0 if nothing scatters.
    pub bounces: u32,
    /// Whether the result includes direct specular light.
    pub direct_specular: bool,
    /// 0 if there is nothing to trace.
    pub paths: u32,
}

impl<'a> Wanted<'a> {
    pub(super) fn of(
        scene: &'a Scene,
        directions: usize,
        scatter: &Scatter,
        notes: &mut Vec<String>,
    ) -> Self {
        let Scene { field, surface, lights } = scene;
        let lit = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
        let specular = surface.specular.as_ref().filter(|s| s.largest().scale > 0.0);
        if surface.specular.is_some() && specular.is_none() {
            notes.push("specular dropped: its scale is 0".into());
        }
        let mirrors_sky = specular.is_some()
            && (lights.sky.is_some_and(|c| lit(&c)) || lights.environment.is_some());
        let suns = match specular {
            Some(_) => {
                lights.suns.iter().filter(|sun| lit(&sun.irradiance)).map(Sun::clamped).collect()
            }
            None => Vec::new(),
        };
        let requested =
            Bounces { count: scatter.bounces, cutoff: scatter.cutoff, ..Bounces::DEFAULT };
        let most = surface.max_reflectance();
        let mut bounces = requested.needed_bounces(most);
        if bounces < requested.count {
            notes.push(dropped(&requested, bounces, most));
        }
        if bounces > 0 && field.is_concave(surface.border) {
            bounces = 0;
            notes.push("no paths: nothing rises above anything else, no ground is visible from other ground".into());
        }
        let mut wanted =
            Self { specular, mirrors_sky, suns, bounces, direct_specular: false, paths: 0 };
        wanted.direct_specular = scatter.direct_specular && wanted.mirrors_lights();
        if bounces > 0 || wanted.direct_specular {
            wanted.paths = scatter.paths;
            // Each direction once already gives the mean of all.
            let all = directions as u32;
            if wanted.steps() == 1 && scatter.first_path == 0 && scatter.paths > all {
                wanted.paths = all;
                notes.push(format!(
                    "{} paths dropped: of one step, {all} cover all directions",
                    scatter.paths - all
                ));
            }
        }
        wanted
    }

    /// Whether visible points reflect lights by specular.
    pub(super) fn mirrors_lights(&self) -> bool {
        self.mirrors_sky || !self.suns.is_empty()
    }

    /// One more than bounces if the last visible point, or the texel itself, reflects lights by specular.
    pub(super) fn steps(&self) -> u32 {
        self.bounces + u32::from(self.mirrors_lights())
    }

    /// Directions of the suns' centres, for specular.
    pub(super) fn towards_suns(&self) -> Result<Option<Directions>> {
        if self.suns.is_empty() {
            return Ok(None);
        }
        Ok(Some(Directions::from_vectors(self.suns.iter().map(towards).collect(), -1.0)?))
    }
}
