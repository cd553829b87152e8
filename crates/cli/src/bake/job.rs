//! A bake before anything runs: its scene, files, memory, plans and settings.

use std::cell::OnceCell;

use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Limits, Plan};
use ridgelight::scene::{
    Border, Directions, HeightField, Method, Quality, Scatter, Scene, VisiblePoints,
};
use ridgelight::{Error, Result};
use ridgelight_bake::{Angles, HorizonSums};

use super::kinds::{self, Kind, Map, Normals, Source, Table, stage};
use super::map::Wanted;
use super::stages::{FILES, Stage};
use super::{MANIFEST, request};
use crate::{horizon, maps};

/// The stage that finds the horizons of all kinds that read them.
pub const HORIZONS: &str = "horizons";

/// What is known before anything runs.
pub struct Job<'a> {
    pub scene: &'a Scene,
    pub quality: &'a Quality,
    /// `quality` with the scene's default azimuths, for pictures with specular.
    pub specular_quality: Quality,
    pub limits: Limits,
    /// Scattered light; none without bounces.
    pub scatter: Option<Scatter>,
    /// Directions in which texels find visible points.
    pub around: &'a Directions,
    /// Of lights and views.
    pub angles: Angles,
    /// Outward and inward curvature of the base surface, 1/m.
    pub curvature: Option<[f64; 2]>,
    /// The axes of normals in textures and pictures.
    pub normals: Normals,
    /// Light and view pairs at which a table is tested between its angles.
    pub pairs: usize,
    /// Of these pairs.
    pub seed: u32,
    /// The table that `brdf`, `brdf-factors` and `brdf-harmonics` share, made on first use.
    pub table: OnceCell<Table>,
    pub maps: Vec<(Wanted, Map)>,
}

impl<'a> Job<'a> {
    pub fn field(&self) -> &'a HeightField {
        &self.scene.field
    }

    /// The field's hash, as the manifest and the textures state it.
    pub fn hash(&self) -> String {
        format!("{:016x}", self.field().hash(self.border()))
    }

    /// Lays out a map for each kind.
    pub fn lay_out(&mut self, wanted: Vec<Wanted>) -> Result<()> {
        let maps = wanted.into_iter().map(|wanted| {
            let map = (wanted.kind.map)(self, &wanted)?;
            Ok((wanted, map))
        });
        self.maps = maps.collect::<Result<_>>()?;
        Ok(())
    }

    /// The least number of angles that the kinds can store.
    pub fn least_angles(&self) -> usize {
        let least = self.kinds().map(|kind| match kind.name {
            "brdf-factors" => kinds::FACTORS,
            "brdf-harmonics" => self.sh_order().pow(2),
            _ => 1,
        });
        least.max().unwrap_or(1)
    }

    /// The stages, with their work, in the order in which they first run.
    pub fn stages(&self) -> Result<Vec<Stage>> {
        let texels = self.grid_points() as f64;
        // A brute-force march is as long as the field.
        let (across, unit) = match self.quality.method {
            Method::BruteForce => {
                let side = self.field().rows().max(self.field().cols());
                (side as f64, "texels x azimuths x cells of the longer side")
            }
            _ => (1.0, "texels x azimuths"),
        };
        let horizons = texels * f64::from(self.quality.azimuths) * across;
        let mut all = Vec::new();
        if self.has(Kind::reads_horizons) {
            all.push(Stage::new(HORIZONS, horizons, unit));
        }
        let mut has_table = false;
        for kind in self.kinds() {
            let name = kind.name;
            match kind.source {
                Source::Horizons | Source::Sums(_) => {}
                Source::SkyView => all.push(Stage::new(name, horizons, unit)),
                Source::Directions(of) => {
                    let rays = texels * self.around.count() as f64;
                    all.push(Stage::new(name, rays, "texels x directions"));
                    if of.probe.is_some() {
                        // The number of probes does not depend on the field.
                        all.push(Stage::new(format!("{name}: {}", stage::PROBES), 1.0, "fields"));
                    }
                }
                Source::Light(of) => {
                    let own = (of.stages)(self, kind.is_table() && has_table)?;
                    has_table |= kind.is_table();
                    let named = own.into_iter();
                    all.extend(named.map(|s| Stage { name: format!("{name}: {}", s.name), ..s }));
                }
            }
        }
        let maps = self.maps.iter();
        let values =
            maps.map(|(_, map)| (map.planes.len() * map.texels(self.grid_points())) as f64);
        all.push(Stage::new(FILES, values.sum(), "values"));
        Ok(all)
    }

    pub fn border(&self) -> Border {
        self.scene.surface.border
    }

    pub fn grid_points(&self) -> usize {
        self.field().heights_m().len()
    }

    pub fn sh_order(&self) -> usize {
        self.quality.sh_order as usize
    }

    /// Plans the visible points of scattered light.
    pub fn points_plan(&self, limits: &Limits) -> Result<Plan> {
        plan::visible_points(self.field(), self.border(), self.around, limits)
    }

    /// Visible points of scattered light.
    pub fn points(&self, gpu: &mut Headless) -> Result<VisiblePoints> {
        gpu.visible_points((self.field(), self.border()), self.around, &self.limits)
    }

    pub fn kinds(&self) -> impl Iterator<Item = &'static Kind> {
        self.maps.iter().map(|(wanted, _)| wanted.kind)
    }

    /// Every file and an upper bound of its bytes.
    pub fn files(&self) -> Vec<(String, u64)> {
        let maps = self.maps.iter();
        let mut all: Vec<_> = maps
            .flat_map(|(wanted, map)| wanted.files(map, [self.field().cols(), self.field().rows()]))
            .collect();
        // The manifest: each file and its decoding, each plane's name (of the map, and of files that name
        // their own), each direction's three numbers.
        let names = |(wanted, map): &(Wanted, Map)| {
            let own = wanted.formats.iter().filter(|format| wanted.names_planes(**format));
            map.planes.len() * (1 + own.count())
        };
        let planes: usize = self.maps.iter().map(names).sum();
        let directions = self.around.count() + self.maps.len() * self.angles.count();
        let listed = 2048 * all.len() + 80 * planes + 160 * directions;
        all.push((MANIFEST.into(), 65_536 + listed as u64));
        all
    }

    /// Bytes in this process: sums, planes that wait for their files, normals, and azimuths read
    /// back.
    pub fn host_bytes(&self, limits: &Limits) -> u64 {
        let grid_points = self.grid_points();
        let of_kind = |kind: &Kind| match kind.source {
            Source::Horizons => 0,
            Source::Sums(map) => HorizonSums::bytes(&*map(self), grid_points),
            // The layer, and its copy without voids.
            Source::SkyView => 8 * grid_points as u64,
            Source::Directions(of) => (of.bytes)(self) * grid_points as u64,
            Source::Light(of) => (of.bytes)(self),
        };
        let maps = self.maps.iter();
        let field = [self.field().cols(), self.field().rows()];
        let maps = maps.map(|(w, map)| of_kind(w.kind).saturating_add(w.held_bytes(map, field)));
        let azimuths = horizon::at_once(self.field(), limits).min(self.quality.azimuths);
        let own = (24 + 4 * u64::from(azimuths)) * grid_points as u64;
        maps.fold(own, u64::saturating_add)
    }

    /// Refuses a .ktx2 with more layers than an image of the device can have.
    pub fn check_layers(&self, limits: &Limits) -> Result<()> {
        let most = limits.image_layers;
        for (wanted, map) in &self.maps {
            let layers = wanted.layers(map);
            let is_read = wanted.formats.iter().any(|f| f.is_texture()) && map.is_array;
            if !is_read || layers <= most as usize {
                continue;
            }
            let flag = match wanted.kind.source {
                Source::Horizons | Source::Sums(_) | Source::SkyView => "--azimuths",
                Source::Directions(_) => "--directions",
                Source::Light(_) => "--angles",
            };
            return Err(Error::Limit {
                what: format!("the texture of {}", wanted.kind.name),
                needs: format!("{layers} layers"),
                limit: format!("{most} on this device; use fewer {flag} or --format npy"),
            });
        }
        Ok(())
    }

    /// Why a flag changes nothing, where the kinds know better than the plans.
    pub fn idle_reason(&self, setting: &str) -> Option<String> {
        if setting.starts_with("bounce") {
            return Some(match self.has(Kind::is_light) {
                false => format!("without a kind that scatters light: {}", request::lights()),
                true => "for these kinds: --paths scatter the light".into(),
            });
        }
        let names: Vec<&str> = self.kinds().map(|kind| kind.name).collect();
        (!self.has(Kind::has_horizons) && !self.has(Kind::is_lit))
            .then(|| format!("for {}", names.join(", ")))
    }

    /// Whether any kind is so.
    pub fn has(&self, of: fn(&Kind) -> bool) -> bool {
        self.kinds().any(of)
    }

    /// Plans of one batch of azimuths, if any, then of each kind of directions and of light.
    pub fn plans(&self, limits: &Limits) -> Result<Vec<Plan>> {
        self.check_layers(limits)?;
        let mut all = Vec::new();
        if self.has(Kind::reads_horizons) {
            let batch = (0, horizon::at_once(self.field(), limits));
            let (field, border) = (self.field(), self.border());
            all.push(horizon::plan_from(field, border, self.quality, limits, batch, false)?);
        }
        if self.has(|kind| matches!(kind.source, Source::SkyView)) {
            all.push(maps::sky_view_plan(self.field(), self.border(), self.quality, limits)?);
        }
        for kind in self.kinds() {
            if let Source::Directions(of) = kind.source {
                all.push((of.plan)(self, limits)?);
            }
        }
        for kind in self.kinds() {
            if let Source::Light(of) = kind.source {
                all.extend((of.plans)(self, limits)?);
            }
        }
        Ok(all)
    }

    /// Settings used: those of the first plan and those that its kinds add.
    pub fn used(&self, limits: &Limits) -> Result<Vec<(String, String)>> {
        let has_horizons = self.has(Kind::has_horizons);
        let mut used = match has_horizons {
            true => horizon::used(self.field(), self.border(), self.quality, limits, false)?,
            false => first(self.plans(limits)?).settings,
        };
        let has_scatter = self.has(|kind| kind.name == "scatter");
        if self.has(|kind| kind.name.starts_with("sh-") || kind.name == "brdf-harmonics") {
            used.push(("sh_order".into(), self.quality.sh_order.to_string()));
        }
        let is_light = self.has(Kind::is_light);
        if is_light {
            let bounces = self.scatter.map_or(0, |scatter| scatter.bounces);
            used.retain(|(name, _)| name != "bounces");
            used.push(("bounces".into(), bounces.to_string()));
        }
        if let Some(scatter) = self.scatter.filter(|_| is_light) {
            // A plan counts the directions of its part.
            used.retain(|(name, _)| !["paths", "seed"].contains(&name.as_str()));
            used.push(("paths".into(), scatter.paths.to_string()));
            used.push(("seed".into(), scatter.seed.to_string()));
            if has_scatter {
                used.push(("paths_used".into(), kinds::paths(self, limits)?.to_string()));
            }
        }
        if self.has(Kind::is_lit) {
            // The bounce engine of paths is not a horizon method.
            used.retain(|(name, _)| name != "method" || has_horizons);
            // Light fields find specular light along paths.
            let diffuse = (!has_scatter).then(|| kinds::diffuse(self));
            let scene = diffuse.as_ref().unwrap_or(self.scene);
            let direct = kinds::direct_plan(self, scene, limits)?.settings;
            // Specular may need more azimuths than horizons.
            let azimuths = direct.iter().find(|(name, _)| name == "azimuths");
            let differing =
                azimuths.filter(|own| used.iter().any(|o| o.0 == own.0 && o.1 != own.1));
            used.extend(differing.map(|(_, count)| ("direct_azimuths".to_owned(), count.clone())));
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
