//! A bake before anything runs: its files, memory, plans and settings.

use ridgelight::plan::{Limits, Plan};
use ridgelight::{Error, Result};

use super::kinds::{self, Lit, Making, OfDirections, Source};
use super::map::{Format, Wanted};
use super::{MANIFEST, request};
use crate::horizon;

/// What is known before anything runs.
pub struct Job<'a> {
    pub lit: Lit<'a>,
    pub wanted: Vec<Wanted>,
    pub making: Vec<Making>,
}

impl Job<'_> {
    fn grid_points(&self) -> usize {
        self.lit.scene.field.heights_m().len()
    }

    /// Every file and an upper bound of its bytes.
    pub fn files(&self) -> Vec<(String, u64)> {
        let pairs = self.wanted.iter().zip(&self.making);
        let mut all: Vec<_> =
            pairs.flat_map(|(w, m)| w.files(&m.map, self.grid_points())).collect();
        // The manifest: each file and its decoding, each plane's name, each direction's three
        // numbers.
        let planes: usize = self.making.iter().map(|m| m.map.planes.len()).sum();
        let directions = self.lit.around.count() + self.making.len() * self.lit.angles.count();
        let listed = 2048 * all.len() + 80 * planes + 160 * directions;
        all.push((MANIFEST.into(), 65_536 + listed as u64));
        all
    }

    /// Bytes in this process: sums, planes that wait for their files, normals, and azimuths read
    /// back.
    pub fn host_bytes(&self, limits: &Limits) -> u64 {
        let (grid_points, field) = (self.grid_points(), &self.lit.scene.field);
        let of = |(w, m): (&Wanted, &Making)| {
            m.source.bytes(&self.lit) + w.held_bytes(&m.map, grid_points)
        };
        let pairs = self.wanted.iter().zip(&self.making);
        let azimuths = u64::from(horizon::at_once(field, limits).min(self.lit.quality.azimuths));
        pairs.map(of).sum::<u64>() + (24 + 4 * azimuths) * grid_points as u64
    }

    /// Kinds that trace directions.
    fn of_directions(&self) -> impl Iterator<Item = OfDirections> {
        self.making.iter().filter_map(|m| match m.source {
            Source::Directions(of) => Some(of),
            Source::Horizons(_) | Source::Light(_) => None,
        })
    }

    /// Refuses a .ktx2 with more layers than an image of the device can have.
    pub fn check_layers(&self, limits: &Limits) -> Result<()> {
        for (wanted, making) in self.wanted.iter().zip(&self.making) {
            let layers = wanted.layers(&making.map);
            let is_read = wanted.formats.contains(&Format::Ktx2) && making.map.is_array;
            if !is_read || layers <= limits.image_layers as usize {
                continue;
            }
            let flag = match &making.source {
                Source::Horizons(_) => "--azimuths",
                Source::Directions(_) => "--directions",
                Source::Light(_) => "--angles",
            };
            let most = limits.image_layers;
            return Err(Error::Limit {
                what: format!("the .ktx2 of {}", wanted.kind.name),
                needs: format!("{layers} layers"),
                limit: format!("{most} on this device; use fewer {flag} or --format npy"),
            });
        }
        Ok(())
    }

    /// Why a flag changes nothing, where the kinds know better than the plans.
    pub fn idle_reason(&self, setting: &str) -> Option<String> {
        let names: Vec<&str> = self.wanted.iter().map(|w| w.kind.name).collect();
        let has_light = self.wanted.iter().any(|w| request::is_light(w.kind));
        let is_of_bounces = setting.starts_with("bounce");
        if is_of_bounces && !has_light {
            return Some(format!("without a kind that scatters light: {}", request::lights()));
        }
        if is_of_bounces {
            return Some("for these kinds: --paths scatter the light".into());
        }
        (!self.has_horizons() && !self.has_direct()).then(|| format!("for {}", names.join(", ")))
    }

    /// Kinds that the scene's lights illuminate.
    fn has_direct(&self) -> bool {
        self.wanted.iter().any(|w| request::is_lit(w.kind))
    }

    pub fn has_horizons(&self) -> bool {
        self.making.iter().any(|m| matches!(m.source, Source::Horizons(_)))
    }

    pub fn traces_directions(&self) -> bool {
        self.making.iter().any(|m| !matches!(m.source, Source::Horizons(_)))
    }

    /// Plans of one batch of azimuths, if any, then of each kind of directions and of light.
    pub fn plans(&self, limits: &Limits) -> Result<Vec<Plan>> {
        self.check_layers(limits)?;
        let (field, border) = (&self.lit.scene.field, self.lit.scene.surface.border);
        let mut all = Vec::new();
        if self.has_horizons() {
            let (most, quality) = (horizon::at_once(field, limits), self.lit.quality);
            all.push(horizon::plan_from(field, border, quality, limits, (0, most), false)?);
        }
        for of in self.of_directions() {
            let Lit { around, curvature, .. } = self.lit;
            all.push((of.plan)(field, border, around, curvature, limits)?);
        }
        for making in &self.making {
            if let Source::Light(of) = making.source {
                all.extend((of.plans)(&self.lit, limits)?);
            }
        }
        Ok(all)
    }

    /// Settings used: those of the first plan and those that its kinds add.
    pub fn used(&self, limits: &Limits) -> Result<Vec<(String, String)>> {
        let Lit { scene, quality, .. } = &self.lit;
        let mut used = match self.has_horizons() {
            true => horizon::used(&scene.field, scene.surface.border, quality, limits, false)?,
            false => first(self.plans(limits)?).settings,
        };
        let has = |of: fn(&str) -> bool| self.wanted.iter().any(|w| of(w.kind.name));
        if has(|name| name.starts_with("sh-") || name == "brdf-harmonics") {
            used.push(("sh_order".into(), quality.sh_order.to_string()));
        }
        let is_light = self.wanted.iter().any(|w| request::is_light(w.kind));
        if is_light {
            let bounces = self.lit.scatter.map_or(0, |scatter| scatter.bounces);
            used.retain(|(name, _)| name != "bounces");
            used.push(("bounces".into(), bounces.to_string()));
        }
        if let Some(scatter) = self.lit.scatter.filter(|_| is_light) {
            // A plan counts the directions of its part.
            used.retain(|(name, _)| !["paths", "seed"].contains(&name.as_str()));
            used.push(("paths".into(), scatter.paths.to_string()));
            used.push(("seed".into(), scatter.seed.to_string()));
            if has(|name| name == "scatter") {
                let traced = kinds::paths(&self.lit, limits)?;
                used.push(("paths_used".into(), traced.to_string()));
            }
        }
        if self.has_direct() {
            // The bounce engine of paths is not a horizon method.
            used.retain(|(name, _)| name != "method" || self.has_horizons());
            // Light fields find specular light along paths.
            let is_whole = has(|name| name == "scatter");
            let diffuse = if is_whole { None } else { Some(kinds::diffuse(&self.lit)) };
            let scene = diffuse.as_ref().unwrap_or(scene);
            let direct = kinds::direct_plan(&self.lit, scene, limits)?.settings;
            let is_new = |(name, _): &(String, String)| used.iter().all(|(n, _)| n != name);
            let more: Vec<_> = direct.into_iter().filter(is_new).collect();
            used.extend(more);
        }
        Ok(used)
    }
}

pub fn first(plans: Vec<Plan>) -> Plan {
    plans.into_iter().next().expect("--what has a kind")
}
