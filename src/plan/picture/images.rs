//! What a picture's passes read and write besides the sweeps' own.

use super::super::active_lights::ActiveLights;
use super::Picture;
use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::azimuths::Azimuth;
use crate::passes::sh_layout::{Sh, WedgeTexels};
use crate::passes::spheres::light_name;
use crate::scene::{Albedo, Border, Environment, Lobe, Quality, Scene, Wedges};

/// Images of the field's size, and the environment.
pub(super) struct Images {
    pub heights: ResourceId,
    pub environment: Option<ResourceId>,
    pub albedo_map: Option<ResourceId>,
    /// Exponent and scale of each sample's lobe.
    pub phong_map: Option<ResourceId>,
    /// A texel a light, where colours are the caller's.
    pub light_colours: Option<ResourceId>,
    pub radiance: ResourceId,
    pub sky_layer: Option<ResourceId>,
    pub env_layer: Option<ResourceId>,
    /// In the order of [`ActiveLights::aimed`].
    pub aimed_layers: Vec<Option<ResourceId>>,
    /// In the order of the balls of light that shine.
    pub sphere_layers: Vec<Option<ResourceId>>,
    pub sky_view: Option<ResourceId>,
    pub sky_sum: Option<ResourceId>,
    pub env_sum: Option<ResourceId>,
    pub sun_sum: Option<ResourceId>,
    pub sphere_sum: Option<ResourceId>,
    /// What a lobe reflects of all lights that it is lit by.
    pub gloss_sum: Option<ResourceId>,
    pub gloss_layer: Option<ResourceId>,
}

impl Images {
    pub fn make(
        builder: &mut Builder,
        scene: &Scene,
        shining: &ActiveLights<'_>,
        (wanted, need_share): (Picture, bool),
    ) -> Self {
        let flat = [scene.field.cols() as u32, scene.field.rows() as u32, 1];
        let mut image = |name: &str, owner: Owner, format: Format, extent: [u32; 3]| {
            builder.image(name, owner, format, extent, false)
        };
        let colour = if shining.is_grey { Format::R32Float } else { Format::Rgba32Float };
        let heights = image("heights", Owner::Input, Format::R32Float, flat);
        let environment = shining.environment.map(|e| {
            let extent = [e.width() as u32, e.height() as u32, 1];
            image("environment", Owner::Input, Format::Rgba32Float, extent)
        });
        let has_map = matches!(scene.surface.albedo, Albedo::Map(_));
        let albedo_map = has_map.then(|| image("albedo", Owner::Input, Format::Rgba32Float, flat));
        let has_lobes = matches!(shining.gloss, Some(Lobe::Map(_)));
        let phong_map = has_lobes.then(|| image("phong", Owner::Input, Format::Rgba32Float, flat));
        let light_colours = wanted.colours_on_device.then(|| {
            let extent = [ActiveLights::texels_of(&scene.lights) as u32, 1, 1];
            image("light_colours", Owner::Input, Format::Rgba32Float, extent)
        });
        let radiance = image("radiance", Owner::Output, colour, flat);
        let mut layer = |shines: bool, light: &str| {
            let name = format!("direct.{light}");
            (shines && wanted.light_layers).then(|| image(&name, Owner::Output, colour, flat))
        };
        let sky_layer = layer(shining.sky.is_some(), "sky");
        let env_layer = layer(environment.is_some(), "env");
        let aimed_layers = shining.aimed().map(|light| layer(true, &light.name)).collect();
        let spheres = &shining.spheres.shining;
        let sphere_layers = spheres.iter().map(|(i, _)| layer(true, &light_name(*i))).collect();
        let has_gloss = shining.gloss.is_some();
        let gloss_layer = layer(has_gloss, "glossy");
        let view = wanted.sky_view;
        let sky_view = view.then(|| image("sky_view", Owner::Output, Format::R32Float, flat));
        let mut sum = |needed: bool, name: &str, format: Format| {
            needed.then(|| image(name, Owner::Internal, format, flat))
        };
        let sky_sum = sum(shining.sky.is_some() || view || need_share, "sky_sum", Format::R32Float);
        let env_sum = sum(environment.is_some(), "env_sum", Format::Rgba32Float);
        let sun_sum = sum(shining.aimed().next().is_some(), "sun_sum", Format::R32Float);
        let sphere_sum = sum(!spheres.is_empty(), "sphere_sum", Format::Rgba32Float);
        let gloss_sum = sum(has_gloss, "gloss_sum", Format::Rgba32Float);
        Self {
            heights,
            environment,
            albedo_map,
            phong_map,
            light_colours,
            radiance,
            sky_layer,
            env_layer,
            aimed_layers,
            sphere_layers,
            sky_view,
            sky_sum,
            env_sum,
            sun_sum,
            sphere_sum,
            gloss_sum,
            gloss_layer,
        }
    }

    /// Whether anything is lit from all around.
    pub fn need_circle(&self) -> bool {
        self.sky_sum.is_some() || self.env_sum.is_some()
    }
}

/// The environment by azimuth and elevation.
pub(super) struct Tables {
    pub wedge_rows: ResourceId,
    pub tables: ResourceId,
}

impl Tables {
    pub fn make(
        builder: &mut Builder,
        (environment, border): (&Environment, Border),
        quality: &Quality,
    ) -> Self {
        let rows = environment.rows_above_ground(border) as u64;
        let rows_bytes = u64::from(quality.azimuths) * rows * 48;
        let wedge_rows = builder.buffer("wedge_rows", rows_bytes, false);
        let extent = [quality.table_elevations, 3, quality.azimuths];
        let format = Format::Rgba32Float;
        let tables = builder.image("env_tables", Owner::Internal, format, extent, true);
        Self { wedge_rows, tables }
    }
}

/// What samples see as spherical harmonics, and the lights that are seen so.
pub(super) struct Harmonics {
    /// An environment's on diffuse ground.
    pub diffuse: Option<Seen>,
    /// An environment's and a uniform sky's in a lobe.
    pub gloss: Option<Seen>,
    pub wedges: Wedges,
    pub constants: ResourceId,
    pub visibility: ResourceId,
    /// The surface at the nodes, where not every sample is one.
    pub nodes: Option<ResourceId>,
    /// Horizons of all azimuths, and the table that they are looked up in.
    pub wedge_table: Option<(ResourceId, WedgeTexels)>,
}

/// A light as harmonics.
pub(super) struct Seen {
    pub sh: Sh,
    /// Of an environment.
    pub env_rotation: Option<ResourceId>,
    pub light_matrix: ResourceId,
}

impl Seen {
    fn make(builder: &mut Builder, sh: Sh, [turns, matrix]: [&str; 2]) -> Self {
        let count = sh.rows * (2 * sh.light_order - 1);
        let env_rotation = (count > 0).then(|| builder.buffer(turns, count as u64 * 16, false));
        let extent = [(sh.order * sh.order) as u32, sh.receivers as u32, 1];
        let light_matrix =
            builder.image(matrix, Owner::Internal, Format::Rgba32Float, extent, false);
        Self { sh, env_rotation, light_matrix }
    }
}

impl Harmonics {
    /// For an environment, for a lobe, or for both.
    pub fn make(
        builder: &mut Builder,
        size: [u32; 2],
        (environment, border): (Option<&Environment>, Border),
        (quality, has_gloss): (&Quality, bool),
        circle: &[Azimuth],
    ) -> Self {
        let mut constants = Vec::new();
        let diffuse =
            environment.map(|_| Sh::of(environment, border, quality, false, &mut constants));
        let gloss = has_gloss.then(|| Sh::of(environment, border, quality, true, &mut constants));
        let sh = diffuse.or(gloss).expect("an environment or a lobe");
        let by_table = quality.wedges == Wedges::Table;
        let table = by_table.then(|| WedgeTexels::of(border, quality, circle, &mut constants));
        // The first: they lie where they count from.
        let (constants, _) = builder.constants(&constants);
        let diffuse = diffuse.map(|sh| Seen::make(builder, sh, ["env_rotation", "light_matrix"]));
        let gloss = gloss.map(|sh| Seen::make(builder, sh, ["gloss_turns", "gloss_matrix"]));
        let wedge_table = table.map(|table| {
            let extent = [size[0], size[1], table.azimuths as u32];
            let format = Format::R32Float;
            (builder.image("horizon_angles", Owner::Internal, format, extent, true), table)
        });
        let mut image = |name: &str, extent: [u32; 3], layered: bool| {
            builder.image(name, Owner::Internal, Format::Rgba32Float, extent, layered)
        };
        let [cols, rows] = sh.nodes.size(size);
        let visibility = image("visibility", [cols, rows, sh.layers() as u32], true);
        let nodes = (sh.nodes.stride > 1).then(|| image("nodes", [cols, rows, 1], false));
        let wedges = quality.wedges;
        Self { diffuse, gloss, wedges, constants, visibility, nodes, wedge_table }
    }

    /// Sizes of what is seen, which all lights see alike.
    pub fn sh(&self) -> &Sh {
        let seen = self.diffuse.as_ref().or(self.gloss.as_ref());
        &seen.expect("an environment or a lobe").sh
    }
}
