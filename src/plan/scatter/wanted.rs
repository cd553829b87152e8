//! What a scene needs of scattered light.

use super::towards;
use crate::Result;
use crate::passes::bounces::dropped;
use crate::scene::{Bounces, Directions, Lobe, Scatter, Scene, Sun};

/// What the scene and the settings leave to be done.
pub(super) struct Wanted<'a> {
    /// The surface's, where it reflects anything.
    pub lobe: Option<&'a Lobe>,
    /// Whether it mirrors sky or environment.
    pub mirrors_sky: bool,
    /// Those that it mirrors.
    pub suns: Vec<Sun>,
    /// 0 where nothing is scattered.
    pub bounces: u32,
    /// Whether views see what samples themselves mirror of lights.
    pub own_lobe: bool,
    /// 0 where there is nothing to look for.
    pub paths: u32,
}

impl<'a> Wanted<'a> {
    pub fn of(
        scene: &'a Scene,
        directions: usize,
        scatter: &Scatter,
        notes: &mut Vec<String>,
    ) -> Self {
        let Scene { field, surface, lights } = scene;
        let lit = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
        let lobe = surface.phong.as_ref().filter(|lobe| lobe.largest().scale > 0.0);
        if surface.phong.is_some() && lobe.is_none() {
            notes.push("lobe dropped: its scale is 0".into());
        }
        let mirrors_sky =
            lobe.is_some() && (lights.sky.is_some_and(|c| lit(&c)) || lights.environment.is_some());
        let suns = match lobe {
            Some(_) => lights.suns.iter().filter(|sun| lit(&sun.irradiance)).copied().collect(),
            None => Vec::new(),
        };
        let asked = Bounces { count: scatter.bounces, cutoff: scatter.cutoff, ..Bounces::NONE };
        let most = surface.most_reflected();
        let mut bounces = asked.worth_drawing(most);
        if bounces < asked.count {
            notes.push(dropped(&asked, bounces, most));
        }
        if bounces > 0 && field.is_concave(surface.border) {
            bounces = 0;
            notes.push("no paths: nothing rises above anything else, no place sees another".into());
        }
        let mut wanted = Self { lobe, mirrors_sky, suns, bounces, own_lobe: false, paths: 0 };
        wanted.own_lobe = scatter.own_lobe && wanted.mirrors_lights();
        if bounces > 0 || wanted.own_lobe {
            wanted.paths = scatter.paths;
            // Each direction once is the mean of all already.
            let all = directions as u32;
            if wanted.steps() == 1 && scatter.first_path == 0 && scatter.paths > all {
                wanted.paths = all;
                notes.push(format!(
                    "{} paths dropped: of one step, {all} have looked along all directions",
                    scatter.paths - all
                ));
            }
        }
        wanted
    }

    /// Whether what is seen mirrors lights that no sample shows.
    pub fn mirrors_lights(&self) -> bool {
        self.mirrors_sky || !self.suns.is_empty()
    }

    /// One more than bounces where what is met last, or the sample itself, mirrors lights.
    pub fn steps(&self) -> u32 {
        self.bounces + u32::from(self.mirrors_lights())
    }

    /// Where lobes look for suns: their middles.
    pub fn towards_suns(&self) -> Result<Option<Directions>> {
        if self.suns.is_empty() {
            return Ok(None);
        }
        Ok(Some(Directions::from_vectors(self.suns.iter().map(towards).collect(), -1.0)?))
    }
}
