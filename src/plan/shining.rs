use super::Picture;
use super::azimuths::{self, Azimuth};
use super::spheres::Spheres;
use super::sweep::Sweep;
use super::sweeping::circle;
use crate::scene::{Albedo, Environment, Quality, Scene, Sun};
use crate::{Error, Result};

/// The lights that give any light.
pub(super) struct Shining<'a> {
    pub sky: Option<[f32; 3]>,
    pub environment: Option<&'a Environment>,
    /// With their positions in the scene.
    pub suns: Vec<(usize, &'a Sun)>,
    pub spheres: Spheres<'a>,
    /// Whether every colour is grey: one channel does.
    pub is_grey: bool,
}

impl<'a> Shining<'a> {
    pub fn of(
        scene: &'a Scene,
        quality: &Quality,
        wanted: Picture,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        let Scene { field, surface, lights } = scene;
        let lit = |c: &[f32; 3]| c.iter().any(|v| *v > 0.0);
        let sky = lights.sky.filter(lit);
        let environment = lights.environment.as_ref();
        let (suns, dark): (Vec<_>, Vec<_>) =
            lights.suns.iter().enumerate().partition(|(_, s)| lit(&s.irradiance));
        if lights.sky.is_none()
            && environment.is_none()
            && lights.suns.is_empty()
            && lights.spheres.is_empty()
            && !wanted.sky_view
        {
            let expected = "at least one of sky, environment, sun and local light";
            return Err(Error::setting("lights", "none", expected));
        }
        if lights.sky.is_some() && sky.is_none() {
            notes.push("sky dropped: its radiance is 0".into());
        }
        for (i, _) in dark {
            notes.push(format!("sun {} dropped: its irradiance is 0", i + 1));
        }
        for (i, _) in suns.iter().filter(|(_, s)| s.is_point() && s.diameter_rad > 0.0) {
            notes.push(format!("sun {} is lit as a point: it is less than 0.01° wide", i + 1));
        }
        let (balls, dark): (Vec<_>, Vec<_>) =
            lights.spheres.iter().enumerate().partition(|(_, s)| lit(&s.radiance));
        for (i, _) in dark {
            notes.push(format!("light {} dropped: its radiance is 0", i + 1));
        }
        let spheres = Spheres::of(field, balls, quality.light_cutoff, notes);
        let grey = |c: &[f32; 3]| c[0] == c[1] && c[1] == c[2];
        let is_grey = environment.is_none()
            && sky.is_none_or(|c| grey(&c))
            && suns.iter().all(|(_, s)| grey(&s.irradiance))
            && spheres.shining.iter().all(|(_, s)| grey(&s.radiance))
            && matches!(&surface.albedo, Albedo::Constant(c) if grey(c));
        Ok(Self { sky, environment, suns, spheres, is_grey })
    }

    /// Azimuths to sweep: the circle's where a sky or an environment needs it, then each sun's.
    pub fn lists(
        &self,
        need_circle: bool,
        quality: &Quality,
        sweep: &Sweep,
        cell_m: [f64; 2],
        notes: &mut Vec<String>,
    ) -> Result<Vec<Vec<Azimuth>>> {
        let mut lists = Vec::new();
        if need_circle {
            lists.push(circle(quality, sweep, cell_m)?);
        } else if !self.suns.is_empty() {
            notes.push("no sky, no environment: only the suns' azimuths are swept".into());
        }
        let across = |sun| azimuths::across_sun(sun, quality.sun_azimuths, cell_m);
        lists.extend(self.suns.iter().map(|(_, sun)| across(sun)));
        Ok(lists)
    }
}

/// As in labels and layers: "sun1" is the scene's first.
pub(super) fn sun_name(position: usize) -> String {
    format!("sun{}", position + 1)
}
