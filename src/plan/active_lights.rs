use std::f64::consts::TAU;

use super::Picture;
use crate::passes::azimuths;
use crate::passes::azimuths::{Azimuth, Shape};
use crate::passes::shadows::{Aim, Shadows};
use crate::passes::spheres::Spheres;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::circle;
use crate::scene::{
    ANY_LIGHT, Albedo, Basis, Border, Environment, KeyLight, LightBasis, Lights, Quality, Scene,
    Specular, Sun,
};
use crate::{Error, Result};

/// Largest number of azimuths that specular sets across a key light: the maximum of the setting `sun_azimuths`.
const MOST_SPECULAR_AZIMUTHS: u32 = 256;

/// The lights that are not dark.
pub(super) struct ActiveLights<'a> {
    pub sky: Option<[f32; 3]>,
    pub environment: Option<&'a Environment>,
    /// With their positions in the scene, [clamped](Sun::clamped).
    pub suns: Vec<(usize, Sun)>,
    /// With their positions in the scene, [clamped](KeyLight::clamped).
    pub keys: Vec<(usize, KeyLight)>,
    pub near: Spheres,
    /// The surface's Phong specular, where its scale is above 0.
    pub specular: Option<&'a Specular>,
    /// Whether the sky-view factor is requested as an image.
    has_sky_view: bool,
    /// Whether every colour is grey, so one channel is enough.
    pub is_grey: bool,
    /// With colours on the device: the texels of the first sun and of the first key light. The sky's is texel 0. The scene's
    /// colours then do not count.
    texels: Option<[usize; 2]>,
}

/// A light's colour.
#[derive(Clone, Copy)]
pub(super) enum Colour {
    /// From the scene.
    Known([f32; 3]),
    /// From a texel of the caller's, by its column.
    Texel(u32),
}

impl<'a> ActiveLights<'a> {
    pub(super) fn of(
        scene: &'a Scene,
        quality: &Quality,
        wanted: Picture,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        let Scene { field, surface, lights } = scene;
        let has_texels = wanted.colours_on_device;
        if has_texels {
            Self::check_texels(scene)?;
        }
        let lit = |c: &[f32; 3]| has_texels || c.iter().any(|v| *v > 0.0);
        let sky = lights.sky.filter(lit);
        let environment = lights.environment.as_ref();
        let suns = lights.suns.iter().map(Sun::clamped).enumerate();
        let (suns, dark): (Vec<_>, Vec<_>) = suns.partition(|(_, s)| lit(&s.irradiance));
        if lights.sky.is_none()
            && environment.is_none()
            && lights.suns.is_empty()
            && lights.keys.is_empty()
            && lights.near().next().is_none()
            && !wanted.sky_view
        {
            return Err(Error::setting("lights", "none", ANY_LIGHT));
        }
        if lights.sky.is_some() && sky.is_none() {
            notes.push("sky dropped: its radiance is 0".into());
        }
        for (i, _) in dark {
            notes.push(format!("sun {} dropped: its irradiance is 0", i + 1));
        }
        let keys = Self::keys(scene, has_texels, notes);
        for (i, _) in suns.iter().filter(|(_, s)| s.is_point() && s.diameter_rad > 0.0) {
            notes.push(format!("sun {} is lit as a point: it is less than 0.01° wide", i + 1));
        }
        let (lit_near, dark): (Vec<_>, Vec<_>) =
            lights.near().partition(|light| lit(&light.sphere.radiance));
        for light in dark {
            notes.push(format!("{} dropped: its radiance is 0", light.name()));
        }
        let specular = surface.specular.as_ref().filter(|specular| specular.largest().scale > 0.0);
        if surface.specular.is_some() && specular.is_none() {
            notes.push("specular dropped: its scale is 0".into());
        }
        // The reach of diffuse light does not bound specular.
        let cutoff = if specular.is_some() { 0.0 } else { quality.light_cutoff };
        let near = Spheres::of(field, lit_near, cutoff, notes)?;
        if specular.is_some() && !near.active.is_empty() {
            notes.push("sphere lights: computed at all texels, as specular reaches farther".into());
        }
        let grey = |c: &[f32; 3]| c[0] == c[1] && c[1] == c[2];
        let is_grey = environment.is_none()
            && !has_texels
            && sky.is_none_or(|c| grey(&c))
            && suns.iter().all(|(_, s)| grey(&s.irradiance))
            && keys.iter().all(|(_, k)| grey(&k.radiance))
            && near.active.iter().all(|light| grey(&light.sphere.radiance))
            && matches!(&surface.albedo, Albedo::Constant(c) if grey(c));
        let has_sky_view = wanted.sky_view;
        if has_texels {
            notes.push("colours of sky, suns and key lights: the caller's, on the device".into());
        }
        let first_sun = usize::from(lights.sky.is_some());
        let texels = has_texels.then_some([first_sun, first_sun + lights.suns.len()]);
        Ok(Self { sky, environment, suns, keys, near, specular, has_sky_view, is_grey, texels })
    }

    /// Checks that colours can be on the device: each must be the factor of one light's sum. Sums of sphere lights and
    /// specular series contain their colours.
    fn check_texels(Scene { surface, lights, .. }: &Scene) -> Result<()> {
        let found = if let Some(light) = lights.near().next() {
            &format!("a {}", light.of.name)
        } else if surface.specular.is_some() {
            "specular"
        } else if Self::texels_of(lights) == 0 {
            "nothing that has one"
        } else {
            return Ok(());
        };
        let expected = "a sky, suns and key lights, on ground without specular";
        Err(Error::setting("picture: colours_on_device", found, expected))
    }

    /// Number of the caller's colours: the sky's, if any, then those of all suns, then those of all key lights.
    pub(super) fn texels_of(lights: &Lights) -> usize {
        usize::from(lights.sky.is_some()) + lights.suns.len() + lights.keys.len()
    }

    /// Colour of the sky.
    pub(super) fn sky_colour(&self) -> Option<Colour> {
        self.sky.map(|sky| self.texels.map_or(Colour::Known(sky), |_| Colour::Texel(0)))
    }

    /// Whether no light is active, so the picture is black.
    pub(super) fn is_dark(&self) -> bool {
        let has_sky = self.sky.is_some() || self.environment.is_some();
        !has_sky && self.aimed().next().is_none() && self.near.active.is_empty()
    }

    /// The settings with exact light near the field, if some of it has no series.
    pub(super) fn light_basis(&self, quality: &Quality, notes: &mut Vec<String>) -> Quality {
        let by_series = quality.light_basis == LightBasis::Sh;
        match self.near.active.iter().find(|light| by_series && !light.of.has_series) {
            Some(light) => {
                notes.push(format!("light_basis exact: a {} has no series", light.of.name));
                Quality { light_basis: LightBasis::Exact, ..*quality }
            }
            None => *quality,
        }
    }

    /// The key lights that can be visible.
    fn keys(scene: &Scene, has_texels: bool, notes: &mut Vec<String>) -> Vec<(usize, KeyLight)> {
        let has_ground = scene.surface.border != Border::Open;
        let why_dark = |key: &KeyLight| match key {
            k if k.radiance == [0.0; 3] && !has_texels => Some("its radiance is 0"),
            k if has_ground && k.elevations_rad[1] <= 0.0 => Some("all of it is below horizontal"),
            _ => None,
        };
        let mut keys = Vec::new();
        for (i, key) in scene.lights.keys.iter().enumerate() {
            match why_dark(key) {
                Some(why) => notes.push(format!("key {} dropped: {why}", i + 1)),
                None => keys.push((i, key.clamped())),
            }
        }
        keys
    }

    /// Whether specular reflects light from all directions.
    pub(super) fn has_specular_around(&self) -> bool {
        self.specular.is_some() && (self.sky.is_some() || self.environment.is_some())
    }

    /// The specular that reflects sky and environment by tables.
    pub(super) fn by_slices(&self, quality: &Quality) -> Option<&'a Specular> {
        self.specular.filter(|_| self.has_specular_around() && quality.basis != Basis::Sh)
    }

    /// Suns, then key lights: each uses azimuths of its own.
    pub(super) fn aimed(&self) -> impl Iterator<Item = Aimed> {
        let colour = |known, i: usize, of: usize| match self.texels {
            Some(firsts) => Colour::Texel((firsts[of] + i) as u32),
            None => Colour::Known(known),
        };
        let suns = self.suns.iter().map(move |(i, sun)| Aimed {
            name: format!("sun{}", i + 1),
            shape: if sun.is_point() { Shape::Point } else { Shape::Disc },
            colour: colour(sun.irradiance, *i, 0),
        });
        let keys = self.keys.iter().map(move |(i, key)| Aimed {
            name: format!("key{}", i + 1),
            shape: Shape::Patch,
            colour: colour(key.radiance, *i, 1),
        });
        suns.chain(keys)
    }

    /// Positions among the lights that are [aimed](Self::aimed), of suns and of key lights narrow enough for shadow heights.
    /// Specular of a key light needs the horizon in each azimuth instead.
    pub(super) fn by_shadow_heights(&self) -> Vec<usize> {
        let suits = |key: &KeyLight| self.specular.is_none() && Shadows::suits(key);
        let keys = self.keys.iter().enumerate().filter(|(_, (_, key))| suits(key));
        (0..self.suns.len()).chain(keys.map(|(k, _)| self.suns.len() + k)).collect()
    }

    /// Where one of them is.
    pub(super) fn aim(&self, index: usize) -> Aim {
        match self.suns.get(index) {
            Some((_, sun)) => Aim {
                azimuth_rad: sun.azimuth_rad,
                low_rad: sun.elevation_rad - sun.diameter_rad / 2.0,
            },
            None => {
                let key = self.keys[index - self.suns.len()].1;
                Aim { azimuth_rad: key.azimuth_rad, low_rad: key.elevations_rad[0] }
            }
        }
    }

    /// Azimuths to sweep: the circle's if a sky or an environment needs it, then those of each light that is
    /// [aimed](Self::aimed).
    pub(super) fn lists(
        &self,
        need_circle: bool,
        quality: &Quality,
        sweep: &Sweep,
        (border, cell_m): (Border, [f64; 2]),
        notes: &mut Vec<String>,
    ) -> Result<Vec<Vec<Azimuth>>> {
        let mut lists = Vec::new();
        if need_circle {
            let is_even = matches!(sweep, Sweep::Surface { .. }) || quality.basis == Basis::Sh;
            lists.push(match self.environment.filter(|_| !is_even) {
                Some(lit) => {
                    notes.push("azimuths: closest where the environment is brightest".into());
                    let (sky, count) = (self.sky_beside(lit), quality.azimuths);
                    azimuths::towards_light(lit, sky, border, count, cell_m)
                }
                None => circle(quality, sweep, cell_m)?,
            });
        } else if self.aimed().next().is_some() {
            let whose = match (self.suns.is_empty(), self.keys.is_empty()) {
                (_, true) => "suns'",
                (true, false) => "key lights'",
                (false, false) => "suns' and key lights'",
            };
            notes.push(format!("no sky, no environment: only the {whose} azimuths are swept"));
        }
        let across = |sun| azimuths::across_sun(sun, quality.sun_azimuths, cell_m);
        lists.extend(self.suns.iter().map(|(_, sun)| across(sun)));
        let across =
            |key| azimuths::across_key(key, self.key_azimuths(key, quality.sun_azimuths), cell_m);
        lists.extend(self.keys.iter().map(|(_, key)| across(key)));
        for (i, key) in &self.keys {
            let slices = key.slices(quality.sun_azimuths);
            // More for specular have a note of their own.
            if slices != quality.sun_azimuths
                && slices == self.key_azimuths(key, quality.sun_azimuths)
            {
                let (number, setting) = (i + 1, quality.sun_azimuths);
                let width = key.width_rad.to_degrees();
                notes.push(format!(
                    "key {number}: {slices} slices for its width of {width:.1}°; {setting} are for 25°"
                ));
            }
        }
        Ok(lists)
    }

    /// Azimuths across a key light: [`KeyLight::slices`], or more for specular, which sets at most
    /// [`MOST_SPECULAR_AZIMUTHS`].
    fn key_azimuths(&self, key: &KeyLight, setting: u32) -> u32 {
        key.slices(setting).max(self.half_deviations(key.width_rad).min(MOST_SPECULAR_AZIMUTHS))
    }

    /// Slices around a texel within a sphere light, each at most half as wide as the narrowest lobe, as for key lights. The largest
    /// exponent, 10,000, needs 1,257: fewer than the 2,048 of the largest `sun_azimuths`.
    pub(super) fn specular_slices_around(&self) -> u32 {
        self.half_deviations(TAU)
    }

    /// Whether specular depends on which part of a sun is visible.
    pub(super) fn needs_vector(&self, sun: &Sun) -> bool {
        self.specular
            .is_some_and(|specular| crate::passes::sun_specular::needs_vector(specular, sun))
    }

    /// A width in halves of the standard deviation of the surface's narrowest lobe, 1/√(n + 1) radians, rounded up. The
    /// lobe's slice in the middle of a wedge no wider represents the wedge. 0 without specular.
    fn half_deviations(&self, width_rad: f64) -> u32 {
        let narrowest = self.specular.map(|specular| f64::from(specular.largest().exponent));
        narrowest.map_or(0, |n| (2.0 * width_rad * (n + 1.0).sqrt()).ceil() as u32)
    }

    /// Notes on what specular changes for key lights.
    pub(super) fn key_notes(&self, quality: &Quality) -> Vec<String> {
        let mut notes = Vec::new();
        if self.keys.iter().any(|(_, key)| Shadows::suits(key)) {
            notes.push(
                "key lights without shadow heights: their specular needs the horizon in each azimuth"
                    .into(),
            );
        }
        for (i, key) in &self.keys {
            let (number, count) = (i + 1, self.key_azimuths(key, quality.sun_azimuths));
            let slices = key.slices(quality.sun_azimuths);
            if count < self.half_deviations(key.width_rad) {
                let n = (f64::from(count) / (2.0 * key.width_rad)).powi(2) - 1.0;
                notes.push(format!(
                    "key {number}: {count} slices; specular of exponents above {n:.0} needs more"
                ));
            } else if count > slices {
                notes.push(format!(
                    "key {number}: {count} slices, each at most half as wide as the lobe"
                ));
            }
        }
        notes
    }

    /// Radiance of the sky, mean over channels. If the sky-view factor is requested beside an environment, that of a sky as
    /// bright as the environment.
    fn sky_beside(&self, environment: &Environment) -> f64 {
        let mean = |c: &[f32; 3]| c.iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0;
        match self.sky {
            Some(sky) => mean(&sky),
            None if self.has_sky_view => {
                let texels = environment.texels();
                texels.iter().map(mean).sum::<f64>() / texels.len() as f64
            }
            None => 0.0,
        }
    }
}

/// A light that covers part of the sky.
pub(super) struct Aimed {
    /// Name in labels and layers: "sun1" is the scene's first sun.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Irradiance of a sun, radiance of a key light.
    pub colour: Colour,
}
