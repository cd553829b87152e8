use std::ops::RangeInclusive;

use glam::DVec3;

use super::{Bounces, Curvature, OcclusionChange, Quality, Scene};
use crate::{Error, Result};

/// Settings of scattered light: paths that look up visible points ([`VisiblePoints`](super::VisiblePoints)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Largest number of bounces, [1..64], default 3. Time grows in proportion.
    pub bounces: u32,
    /// Paths per texel, [1..4096], default 100. Fewer: faster. All texels share the directions, so the error is a tint of
    /// whole slopes, not noise. Heidrich et al. 2000 use 40 to 100.
    pub paths: u32,
    /// Paths that the output already holds, [0..2²⁴], default 0. The new paths follow them, and the result is the mean of all.
    pub first_path: u32,
    /// Share of the direct light's energy that may be dropped, [0..1], default 1/65536. With the largest reflectance a, all
    /// bounces from the k-th on carry at most aᵏ + aᵏ⁺¹ + …; the last ones are dropped. Higher: faster, darker hollows. 0
    /// drops none.
    pub cutoff: f64,
    /// Seed of the sequence of directions, any number, default 0. The same seed gives the same light.
    pub seed: u32,
    /// Unit vector towards the view of the Phong lobes; default up. Diffuse light ignores it.
    pub view: DVec3,
    /// Whether the result includes direct specular light: suns, sky and environment in each texel's own lobe. Default false.
    /// If true, `bounces` may be 0. The sky is sampled in the paths' directions, so narrower lobes appear rough.
    pub direct_specular: bool,
    /// Curvature of the base surface, default flat. Visibility is that of the flat field; positions and weights of visible
    /// points follow the base. Diffuse surfaces only. One value serves the whole field: repetitions of a tile over an object
    /// lie on different bases. For those, interpolate linearly between the results of a few curvatures, as `CurvedEllipses`
    /// does for shadows; `cargo measure curved` reports the error.
    pub curvature: Curvature,
}

impl Default for Scatter {
    fn default() -> Self {
        Self {
            bounces: 3,
            paths: 100,
            first_path: 0,
            cutoff: Bounces::DEFAULT.cutoff,
            seed: 0,
            view: DVec3::Z,
            direct_specular: false,
            curvature: Curvature::FLAT,
        }
    }
}

impl Scatter {
    /// Range of [`bounces`](Self::bounces).
    pub(crate) const BOUNCES: RangeInclusive<u32> = 1..=64;
    /// Range of [`paths`](Self::paths).
    pub const PATHS: RangeInclusive<u32> = 1..=4096;
    /// Range of [`first_path`](Self::first_path).
    pub(crate) const FIRST_PATH: RangeInclusive<u32> = 0..=1 << 24;

    /// Checks every range and the scene. Returns the estimated occlusion change of the curved base; that of a flat one is 0.
    ///
    /// # Errors
    /// A setting out of range, by name; specular with key lights or sphere lights, which paths cannot mirror; specular on a
    /// curved base; a base that [`Curvature::check`] rejects.
    pub(crate) fn check(&self, scene: &Scene) -> Result<OcclusionChange> {
        if !(self.direct_specular && self.bounces == 0) {
            within("bounces", self.bounces, Self::BOUNCES)?;
        }
        within("paths", self.paths, Self::PATHS)?;
        within("first path", self.first_path, Self::FIRST_PATH)?;
        let bounces = Bounces { cutoff: self.cutoff, ..Bounces::DEFAULT };
        Quality { bounces, ..Quality::DEFAULT }.check()?;
        check_view(self.view)?;
        scene.lights.check()?;
        scene.surface.check(scene.field.rows() * scene.field.cols())?;
        let others = scene.lights.keys.len() + scene.lights.near().count();
        if scene.surface.specular.is_some() && others > 0 {
            return Err(Error::setting(
                "scattered light",
                format!("specular and {others} key lights and sphere lights"),
                "specular under sky, environment and suns only",
            ));
        }
        if scene.surface.specular.is_some() && self.curvature != Curvature::FLAT {
            // On a curved base each texel has its own directions, but a visible point has one exit radiance for all.
            return Err(Error::setting(
                "scattered light on a curved base",
                "specular",
                "diffuse surfaces only",
            ));
        }
        self.curvature.check(&scene.field, scene.surface.border)
    }
}

/// Checks that a view is a unit vector.
pub(crate) fn check_view(view: DVec3) -> Result<()> {
    if (1.0 - 1e-6..=1.0 + 1e-6).contains(&view.length()) {
        return Ok(());
    }
    Err(Error::setting("view", view.to_string(), "a vector of length 1"))
}

fn within(name: &str, value: u32, range: RangeInclusive<u32>) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    Err(Error::setting(name, value.to_string(), expected))
}
