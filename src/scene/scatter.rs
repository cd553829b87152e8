use std::ops::RangeInclusive;

use glam::DVec3;

use super::quality::within;
use super::{Bounces, Changed, Curvature, Scene};
use crate::{Error, Result};

/// Light that a field scatters, by paths that look up what samples see ([`VisiblePoints`](super::VisiblePoints)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Times that light is reflected on its way to a sample, at most, [1..64], default 3. Time grows in proportion.
    pub bounces: u32,
    /// Paths of every sample, [1..4096], default 100. Fewer: faster; samples alike are wrong alike, as all look along the same
    /// directions: no noise, but a tint of whole slopes. 40 to 100 in Heidrich et al. 2000.
    pub paths: u32,
    /// Paths that the output holds already, [0..2²⁴], default 0: these are added to them, as those that come next. Each
    /// sample's light is then the mean of all.
    pub first_path: u32,
    /// Share of the direct light's energy that may be left out, [0..1], default 1/65536. Of a surface that
    /// reflects at most the share a, all bounces from the k-th on carry at most aᵏ + aᵏ⁺¹ + …: the last
    /// ones are dropped. More: faster, darker hollows. 0: none is dropped.
    pub cutoff: f64,
    /// Which directions follow each other, any number, default 0: the same seed, the same light.
    pub seed: u32,
    /// Towards the view, of length 1: where lobes are looked at from; default above. Nothing to what is diffuse.
    pub view: DVec3,
    /// Whether views see what a sample's own lobe mirrors of suns, sky and environment, too, default not: that is direct light.
    /// With it `bounces` may be 0. The sky is that of the directions of the paths: lobes narrower than these are apart are
    /// rough.
    pub own_lobe: bool,
    /// Of the base that the field lies on, default flat. What samples see is that of the flat field; where they see it, and what
    /// each direction counts for, follow the base. Of what is diffuse alone. One of the whole field: a map of curvatures over it would
    /// say the same of all its repetitions over an object, which lie on different ones. There, mix linearly what is scattered
    /// on a few bases, as `CurvedEllipses` does with shadows: `examples/curved` tells what that errs by.
    pub curvature: Curvature,
}

impl Default for Scatter {
    fn default() -> Self {
        Self {
            bounces: 3,
            paths: 100,
            first_path: 0,
            cutoff: Bounces::NONE.cutoff,
            seed: 0,
            view: DVec3::Z,
            own_lobe: false,
            curvature: Curvature::FLAT,
        }
    }
}

impl Scatter {
    /// What [`bounces`](Self::bounces) may be.
    pub const BOUNCES: RangeInclusive<u32> = 1..=64;
    /// What [`paths`](Self::paths) may be.
    pub const PATHS: RangeInclusive<u32> = 1..=4096;
    /// What [`first_path`](Self::first_path) may be.
    pub const FIRST_PATH: RangeInclusive<u32> = 0..=1 << 24;

    /// Checks every range, and that the scene is one that can be scattered; what its base changes, nothing of a flat one.
    ///
    /// # Errors
    /// A setting out of range, by name; lobes beside key lights or balls, whose mirror images no path finds; lobes on a curved base;
    /// a base bent more than [`Curvature::check`] allows.
    pub fn check(&self, scene: &Scene) -> Result<Changed> {
        if !(self.own_lobe && self.bounces == 0) {
            within("--bounces", self.bounces, Self::BOUNCES)?;
        }
        within("--paths", self.paths, Self::PATHS)?;
        within("first path", self.first_path, Self::FIRST_PATH)?;
        Bounces { cutoff: self.cutoff, ..Bounces::NONE }.check()?;
        check_view(self.view)?;
        scene.lights.check()?;
        scene.surface.check(scene.field.rows() * scene.field.cols())?;
        let others = scene.lights.keys.len() + scene.lights.spheres.len();
        if scene.surface.phong.is_some() && others > 0 {
            return Err(Error::setting(
                "scattered light",
                format!("a lobe and {others} key lights and balls"),
                "lobes under sky, environment and suns alone",
            ));
        }
        if scene.surface.phong.is_some() && self.curvature != Curvature::FLAT {
            // Samples along one direction see a place from directions of their own there, and it has one light for all.
            return Err(Error::setting(
                "scattered light on a curved base",
                "a lobe",
                "diffuse surfaces alone",
            ));
        }
        self.curvature.check(&scene.field, scene.surface.border)
    }
}

/// Refuses what is no direction.
pub(crate) fn check_view(view: DVec3) -> Result<()> {
    if (1.0 - 1e-6..=1.0 + 1e-6).contains(&view.length()) {
        return Ok(());
    }
    Err(Error::setting("view", view.to_string(), "a vector of length 1"))
}
