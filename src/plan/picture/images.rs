//! Resources of a picture's passes besides those of the sweeps.

use super::super::active_lights::ActiveLights;
use super::Picture;
use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::azimuths::Azimuth;
use crate::passes::sh_layout::{Sh, WedgeTexels};
use crate::scene::{Albedo, Border, Environment, Quality, Scene, Specular, Wedges};

/// Images of the field's size, and the environment.
pub(super) struct Images {
    pub heights: ResourceId,
    pub environment: Option<ResourceId>,
    pub albedo_map: Option<ResourceId>,
    /// Exponent and scale of each texel's Phong specular.
    pub specular_map: Option<ResourceId>,
    /// One texel per light, with colours on the device.
    pub light_colours: Option<ResourceId>,
    pub radiance: ResourceId,
    pub sky_layer: Option<ResourceId>,
    pub env_layer: Option<ResourceId>,
    /// In the order of [`ActiveLights::aimed`].
    pub aimed_layers: Vec<Option<ResourceId>>,
    /// In the order of the active sphere lights.
    pub sphere_layers: Vec<Option<ResourceId>>,
    pub sky_view: Option<ResourceId>,
    pub sky_sum: Option<ResourceId>,
    pub env_sum: Option<ResourceId>,
    pub sun_sum: Option<ResourceId>,
    /// Of a sun whose visible part decides its specular.
    pub light_vector: Option<ResourceId>,
    pub sphere_sum: Option<ResourceId>,
    /// Direct specular of all lights.
    pub specular_sum: Option<ResourceId>,
    pub specular_layer: Option<ResourceId>,
}

impl Images {
    pub(super) fn make(
        builder: &mut Builder,
        scene: &Scene,
        active: &ActiveLights<'_>,
        (wanted, need_share): (Picture, bool),
    ) -> Self {
        let flat = [scene.field.cols() as u32, scene.field.rows() as u32, 1];
        let mut image = |name: &str, owner: Owner, format: Format, extent: [u32; 3]| {
            builder.image(name, owner, format, extent, false)
        };
        let colour = if active.is_grey { Format::R32Float } else { Format::Rgba32Float };
        let heights = image("heights", Owner::Input, Format::R32Float, flat);
        let environment = active.environment.map(|e| {
            let extent = [e.width() as u32, e.height() as u32, 1];
            image("environment", Owner::Input, Format::Rgba32Float, extent)
        });
        let has_map = matches!(scene.surface.albedo, Albedo::Map(_));
        let albedo_map = has_map.then(|| image("albedo", Owner::Input, Format::Rgba32Float, flat));
        let has_specular_map = matches!(active.specular, Some(Specular::Map(_)));
        let specular_map =
            has_specular_map.then(|| image("phong", Owner::Input, Format::Rgba32Float, flat));
        let light_colours = wanted.colours_on_device.then(|| {
            let extent = [ActiveLights::texels_of(&scene.lights) as u32, 1, 1];
            image("light_colours", Owner::Input, Format::Rgba32Float, extent)
        });
        let radiance = image("radiance", Owner::Output, colour, flat);
        let mut layer = |is_lit: bool, light: &str| {
            let name = format!("direct.{light}");
            (is_lit && wanted.light_layers).then(|| image(&name, Owner::Output, colour, flat))
        };
        let sky_layer = layer(active.sky.is_some(), "sky");
        let env_layer = layer(environment.is_some(), "env");
        let aimed_layers = active.aimed().map(|light| layer(true, &light.name)).collect();
        let spheres = &active.near.active;
        let sphere_layers = spheres.iter().map(|light| layer(true, &light.label())).collect();
        let has_specular = active.specular.is_some();
        let specular_layer = layer(has_specular, "specular");
        let view = wanted.sky_view;
        let sky_view = view.then(|| image("sky_view", Owner::Output, Format::R32Float, flat));
        let mut sum = |needed: bool, name: &str, format: Format| {
            needed.then(|| image(name, Owner::Internal, format, flat))
        };
        let sky_sum = sum(active.sky.is_some() || view || need_share, "sky_sum", Format::R32Float);
        let env_sum = sum(environment.is_some(), "env_sum", Format::Rgba32Float);
        let sun_sum = sum(active.aimed().next().is_some(), "sun_sum", Format::R32Float);
        let needs_vector = active.suns.iter().any(|(_, sun)| active.needs_vector(sun));
        let light_vector = sum(needs_vector, "light_vector", Format::Rgba32Float);
        let sphere_sum = sum(!spheres.is_empty(), "sphere_sum", Format::Rgba32Float);
        let specular_sum = sum(has_specular, "specular_sum", Format::Rgba32Float);
        Self {
            heights,
            environment,
            albedo_map,
            specular_map,
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
            light_vector,
            sphere_sum,
            specular_sum,
            specular_layer,
        }
    }

    /// Whether light arrives from all directions.
    pub(super) fn need_circle(&self) -> bool {
        self.sky_sum.is_some() || self.env_sum.is_some()
    }
}

/// Tables of the environment by azimuth and elevation.
pub(super) struct Tables {
    pub wedge_rows: ResourceId,
    pub tables: ResourceId,
}

impl Tables {
    pub(super) fn make(
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

/// Visibility as spherical harmonics, and the lights that use it.
pub(super) struct Harmonics {
    /// An environment on diffuse ground.
    pub diffuse: Option<HarmonicLight>,
    /// Specular of an environment and a uniform sky.
    pub specular: Option<HarmonicLight>,
    pub wedges: Wedges,
    pub constants: ResourceId,
    pub visibility: ResourceId,
    /// The surface at the nodes, if not every texel is one.
    pub nodes: Option<ResourceId>,
    /// Horizons of all azimuths, and their wedge table.
    pub wedge_table: Option<(ResourceId, WedgeTexels)>,
}

/// A light in harmonics.
pub(super) struct HarmonicLight {
    pub sh: Sh,
    /// Buffer of a rotated environment.
    pub env_rotation: Option<ResourceId>,
    pub light_matrix: ResourceId,
}

impl HarmonicLight {
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
    /// For an environment on diffuse ground, for specular, or for both.
    pub(super) fn make(
        builder: &mut Builder,
        size: [u32; 2],
        (environment, border): (Option<&Environment>, Border),
        (quality, [has_diffuse, has_specular]): (&Quality, [bool; 2]),
        circle: &[Azimuth],
    ) -> Self {
        // Offsets count from the first constant of all.
        let (_, first) = builder.constants(&[]);
        let mut constants = vec![0.0; 4 * first];
        let mut of = |specular| Sh::of(environment, border, quality, specular, &mut constants);
        let diffuse = has_diffuse.then(|| of(false));
        let specular = has_specular.then(|| of(true));
        let sh = diffuse.or(specular).expect("an environment or specular");
        let by_table = quality.wedges == Wedges::Table;
        let table = by_table.then(|| WedgeTexels::of(border, quality, circle, &mut constants));
        let (constants, _) = builder.constants(&constants[4 * first..]);
        let diffuse =
            diffuse.map(|sh| HarmonicLight::make(builder, sh, ["env_rotation", "light_matrix"]));
        let specular = specular
            .map(|sh| HarmonicLight::make(builder, sh, ["specular_rotation", "specular_matrix"]));
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
        Self { diffuse, specular, wedges, constants, visibility, nodes, wedge_table }
    }

    /// Layout of the visibility, equal for all lights.
    pub(super) fn sh(&self) -> &Sh {
        let light = self.diffuse.as_ref().or(self.specular.as_ref());
        &light.expect("an environment or specular").sh
    }
}
