//! Plans the passes of a picture, light by light.

use super::super::active_lights::{ActiveLights, Aimed, Colour};
use super::images::{Harmonics, Images, Tables};
use super::slices::SpecularSlices;
use crate::graph::{Builder, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::bounces::{Bouncing, WalkedOver, bounce_name};
use crate::passes::edits::Edits;
use crate::passes::shadows::Shadows;
use crate::passes::sphere_sh::SphereSh;
use crate::passes::sweeping::{Lists, Sweeping, part};
use crate::passes::{self, light_resolve};
use crate::scene::{Albedo, Border, NearLight, Quality, Scene};
use crate::{Error, Result};

/// A picture while its passes are added.
pub(super) struct Drawing<'a> {
    pub builder: Builder,
    pub scene: &'a Scene,
    pub active: ActiveLights<'a>,
    pub images: Images,
    pub tables: Option<Tables>,
    pub harmonics: Option<Harmonics>,
    pub slices: Option<SpecularSlices>,
    /// The eye over the field's base; the last is 0 for a view from straight above.
    pub eye_m: [f32; 4],
    /// None if there are only sphere lights, which trace their own occlusion.
    pub sweeping: Option<Sweeping>,
    /// Of suns by shadow heights.
    pub shadows: Option<Shadows>,
    /// Acceleration structure of rays, to sphere lights and of bounces.
    pub blocks: Option<Blocks>,
    pub bouncing: Option<Bouncing>,
    /// For sphere lights in spherical harmonics.
    pub soft: Option<SphereSh>,
    /// While the passes of an edit are added: marks of the texels to light, and their list.
    pub edited: Option<[ResourceId; 2]>,
    /// Whether the picture has its first light, which clears it.
    pub is_begun: bool,
    /// Whether the specular sum has its first light.
    pub specular_is_begun: bool,
}

impl Drawing<'_> {
    pub(super) fn border(&self) -> Border {
        self.scene.surface.border
    }

    pub(super) fn fill_tables(&mut self, quality: &Quality) {
        self.fill_matrices();
        self.fill_env_tables(quality);
        self.fill_specular(quality.azimuths);
    }

    fn fill_env_tables(&mut self, quality: &Quality) {
        let (Some(e), Some(image)) = (self.active.environment, self.images.environment) else {
            return;
        };
        let Some(azimuths) = self.sweeping.as_ref().map(|s| s.azimuths) else { return };
        let (border, count) = (self.border(), quality.azimuths);
        let builder = &mut self.builder;
        if let Some(Tables { wedge_rows, tables }) = self.tables {
            let of = (e, border);
            let wedges = [image, azimuths, wedge_rows];
            passes::env_wedges::plan(builder, "", of, count, wedges);
            let nodes = quality.table_elevations;
            passes::env_tables::plan(builder, of, nodes, count, [wedge_rows, azimuths, tables]);
        }
    }

    /// Passes from the field to the lit picture; for an edit, from its lattices.
    pub(super) fn light(&mut self, lists: &Lists, quality: &Quality) -> Result<()> {
        self.is_begun = false;
        self.specular_is_begun = false;
        self.sky_and_environment(lists);
        self.aimed(lists);
        self.sphere_lights(quality);
        self.bounces(lists);
        self.specular();
        self.sky_view();
        self.dark()
    }

    /// From here on passes are those of an edit. All horizons come first, as every batch lights the same texels.
    pub(super) fn edit(&mut self, size: [u32; 2], lists: &Lists, Edits { dirty, list }: Edits) {
        self.builder.begin_edits();
        let (border, ids) = (self.border(), [dirty, list]);
        self.edited = Some(ids);
        let Some(sweeping) = &self.sweeping else { return };
        let batches = lists.batches.iter().flatten();
        let has_others = batches.clone().any(|batch| !sweeping.is_shadow(batch));
        if has_others {
            passes::dirty_mark::plan(&mut self.builder, size, ids);
        }
        sweeping.plan_edit(&mut self.builder, border, batches, ids);
        if has_others {
            passes::dirty_list::plan(&mut self.builder, size, ids);
        }
    }

    fn sky_and_environment(&mut self, lists: &Lists) {
        let Some(sweeping) = self.sweeping.as_ref().filter(|_| self.images.need_circle()) else {
            return;
        };
        let (border, cell_m) = (self.border(), self.scene.field.cell_m());
        let Images { sky_sum, env_sum, sky_layer, env_layer, .. } = self.images;
        let batches = &lists.batches[0];
        let first: Vec<_> = batches.iter().map(|b| (*b, part("sky", b, batches))).collect();
        if self.edited.is_none() && sweeping.has_own_lattices {
            sweeping.plan_all(&mut self.builder, &first);
        }
        for (i, batch) in batches.iter().enumerate() {
            let part = first[i].1.clone();
            let builder = &mut self.builder;
            if self.edited.is_none() && !sweeping.has_own_lattices {
                sweeping.plan_all(builder, &first[i..=i]);
            }
            let lattice = sweeping.lattice(batch);
            let (azimuths, sweep) = (sweeping.azimuths, &sweeping.sweep);
            let specular = self.slices.as_ref().map(|slices| passes::sky_shade::Specular {
                tables: slices.first_swept().0,
                levels: slices.hidden.levels,
                blocked_sum: slices.hidden.blocked_sum,
                eye_m: self.eye_m,
            });
            if sky_sum.is_some() || self.tables.is_some() {
                let images = passes::sky_shade::Images {
                    lanes: sweeping.lanes(batch),
                    lattice,
                    azimuths,
                    sky_sum,
                    environment: env_sum.zip(self.tables.as_ref()).map(|(sum, t)| [sum, t.tables]),
                    specular,
                    edited: self.edited,
                };
                passes::sky_shade::plan(builder, sweep, border, cell_m, batch, &part, &images);
            }
            if let Some(harmonics) = &self.harmonics {
                let Harmonics { wedges, visibility, nodes, wedge_table, .. } = harmonics;
                if let Some((angles, _)) = wedge_table {
                    let ids = [azimuths, *angles];
                    let read = (sweeping.lanes(batch), lattice, None);
                    passes::sweep_fuse::plan(builder, sweep, border, batch, &part, ids, read);
                    continue;
                }
                let (visibility, nodes) = (*visibility, *nodes);
                let images = passes::sh_visibility::Images {
                    lanes: sweeping.lanes(batch),
                    lattice,
                    azimuths,
                    visibility,
                    nodes,
                };
                let sh = harmonics.sh();
                let (field, series) = ((border, cell_m), (sh, *wedges, sweeping.nodes));
                passes::sh_visibility::plan(builder, sweep, field, series, batch, &part, &images);
            }
        }
        let last_lanes = batches.last().map(|batch| sweeping.lane_heights(batch));
        if let (Some(h), Some(batch)) = (&self.harmonics, batches.last()) {
            let lane_heights = sweeping.lane_heights(batch);
            if let Some((angles, table)) = h.wedge_table {
                let (constants, visibility, nodes) = (h.constants, h.visibility, h.nodes);
                let images = passes::sh_wedges::Images {
                    lane_heights,
                    angles,
                    constants,
                    visibility,
                    nodes,
                };
                let field = (batch.axis, border, cell_m);
                passes::sh_wedges::plan(&mut self.builder, field, h.sh(), &table, &images);
            }
            let field = (batch.axis, border, cell_m);
            let specular = self.phong().map(|phong| (phong, self.eye_m));
            // Of slices, the series are for bounces alone.
            let specular_sum = self.images.specular_sum.filter(|_| self.slices.is_none());
            let lit = [(&h.diffuse, env_sum, None), (&h.specular, specular_sum, specular)];
            for (light, sum, specular) in lit {
                if let (Some(light), Some(sum)) = (light, sum) {
                    let ids = [lane_heights, h.visibility, light.light_matrix, sum];
                    passes::sh_shade::plan(
                        &mut self.builder,
                        field,
                        &light.sh,
                        ids,
                        h.nodes,
                        specular,
                    );
                }
            }
            self.specular_is_begun = h.specular.is_some() && self.slices.is_none();
            self.specular_around();
        }
        if let Some((batch, lane_heights)) = batches.last().zip(last_lanes) {
            self.slices_light(batch, lane_heights);
        }
        if let (Some(sum), Some(colour)) = (sky_sum, self.active.sky_colour()) {
            self.resolve("sky", sum, Some(colour), sky_layer);
        }
        if let Some(sum) = env_sum {
            self.resolve("env", sum, None, env_layer);
        }
    }

    fn aimed(&mut self, lists: &Lists) {
        let Some(sum) = self.images.sun_sum else { return };
        let (border, cell_m) = (self.border(), self.scene.field.cell_m());
        let batches_of_each = &lists.batches[usize::from(self.images.need_circle())..];
        let lights: Vec<Aimed> = self.active.aimed().collect();
        let resolves = self.resolves();
        for (i, (batches, Aimed { name, shape, colour })) in
            batches_of_each.iter().zip(lights).enumerate()
        {
            let sun = self.active.suns.get(i).map(|(_, sun)| sun);
            let is_wide = sun.is_some_and(|sun| self.active.needs_vector(sun));
            let light_vector = self.images.light_vector.filter(|_| is_wide);
            let mut walked = None;
            for batch in batches {
                let part = part(&name, batch, batches);
                let specular = self.key_specular(i);
                let Some(sweeping) = &self.sweeping else { return };
                let builder = &mut self.builder;
                let lanes = sweeping.lanes(batch);
                if let Some(shadows) = self.shadows.as_ref().filter(|_| sweeping.is_shadow(batch)) {
                    shadows.plan_sweep(builder, sweeping, batch, &part);
                    let field = &self.scene.field;
                    let of = (part.as_str(), shape);
                    let ids = [lanes.heights, sweeping.azimuths, sweeping.written(batch), sum];
                    let ids = (ids, light_vector);
                    passes::shadow_shade::plan(builder, shadows, (border, cell_m), batch, of, ids);
                    let lit = (field, border);
                    let walked = *walked.get_or_insert_with(|| {
                        let (aim, heights) = ((self.active.aim(i), cell_m), sweeping.heights());
                        shadows.plan_maxima(builder, (&name, i), aim, heights)
                    });
                    let shadows = (shadows, walked);
                    passes::shadow_settle::plan(builder, shadows, lit, batch, of, ids);
                    continue;
                }
                if self.edited.is_none() {
                    sweeping.plan_all(builder, &[(*batch, part.clone())]);
                }
                let ids = ([sweeping.azimuths, sum], light_vector);
                let lattice = sweeping.lattice(batch);
                let sweep = &sweeping.sweep;
                passes::sun_shade::plan(
                    builder, sweep, border, cell_m, batch, &part, lanes, shape, lattice, ids,
                    specular, resolves,
                );
                if let Some(specular) = specular {
                    self.key_arriving(batch, &part, specular);
                }
            }
            self.resolve(&name, sum, Some(colour), self.images.aimed_layers[i]);
            if let (Some(&(_, sun)), Some(batch)) = (self.active.suns.get(i), batches.last()) {
                self.sun_specular(&name, &sun, batch, (sum, light_vector));
            }
        }
    }

    /// Sphere lights share one sum; with layers, each starts its own.
    fn sphere_lights(&mut self, quality: &Quality) {
        let (Some(sum), Some(blocks)) = (self.images.sphere_sum, &self.blocks) else { return };
        let heights = self.images.heights;
        blocks.plan(&mut self.builder, &self.scene.field, heights, None);
        let names: Vec<String> = self.active.near.active.iter().map(NearLight::label).collect();
        for (index, name) in names.iter().enumerate() {
            let layer = self.images.sphere_layers[index];
            let begins = index == 0 || layer.is_some();
            let specular = self.sphere_specular();
            let Some(blocks) = &self.blocks else { return };
            let (spheres, builder) = (&self.active.near, &mut self.builder);
            if let Some(soft) = &self.soft {
                let lit = (self.scene, blocks, soft);
                spheres.plan_soft(builder, lit, heights, (index, begins), sum);
            } else {
                let (lit, of) = ((self.scene, blocks), (index, quality.sun_azimuths));
                spheres.plan(builder, lit, of, (begins, specular), sum);
            }
            if layer.is_some() {
                self.resolve(name, sum, None, layer);
            }
        }
        if self.images.sphere_layers.iter().all(Option::is_none) {
            self.resolve("lights", sum, None, None);
        }
    }

    /// Plans the bounces, each from the exit radiance of the previous one.
    fn bounces(&mut self, lists: &Lists) {
        let Some(bouncing) = self.bouncing.take() else { return };
        let batches = lists.batches.last().map(Vec::as_slice);
        let Images { heights, radiance, sphere_sum, .. } = self.images;
        // With sphere lights, their passes are in the plan.
        if let Some(blocks) = self.blocks.as_ref().filter(|_| sphere_sum.is_none()) {
            blocks.plan(&mut self.builder, &self.scene.field, heights, None);
        }
        bouncing.prepare(&mut self.builder, heights);
        self.plan_specular_exit(&bouncing, 0);
        for k in 1..=bouncing.count() {
            let ids = [heights, radiance];
            let over = self.sweeping.as_ref().zip(batches);
            let over = over.map(|(sweeping, batches)| WalkedOver { sweeping, batches });
            let traced = (self.blocks.as_ref(), over);
            let (sum, exit) = bouncing.plan(&mut self.builder, self.scene, traced, k, ids);
            self.resolve(&bounce_name(k), sum, None, exit);
            self.plan_specular_exit(&bouncing, k);
        }
        self.bounced_specular(&bouncing);
    }

    /// Adds a sum to the picture: of one channel times its colour, or of three colour channels.
    fn resolve(
        &mut self,
        name: &str,
        sum: ResourceId,
        colour: Option<Colour>,
        layer: Option<ResourceId>,
    ) {
        let albedo = match self.scene.surface.albedo {
            Albedo::Constant(c) => c,
            Albedo::Map(_) => [1.0; 3],
        };
        let (of_light, texel) = match colour {
            Some(Colour::Known(known)) => (known, None),
            Some(Colour::Texel(texel)) => ([1.0; 3], self.images.light_colours.zip(Some(texel))),
            None => ([1.0; 3], None),
        };
        let is_first = !std::mem::replace(&mut self.is_begun, true);
        let light = light_resolve::Light {
            sum,
            has_colour: colour.is_none(),
            colour: [0, 1, 2].map(|c| of_light[c] * albedo[c]),
            texel,
            albedo_map: self.images.albedo_map,
            radiance: Some((self.images.radiance, is_first)),
            layer,
            grey: self.active.is_grey,
            edited: self.resolves(),
        };
        self.light_resolve(name, &light);
    }

    /// The marks that limit what is summed after an edit. Suns by shadow heights are lit again everywhere, and then all
    /// sums are made again.
    fn resolves(&self) -> Option<[ResourceId; 2]> {
        self.edited.filter(|_| self.shadows.is_none())
    }

    pub(super) fn light_resolve(&mut self, name: &str, light: &light_resolve::Light) {
        let size = [self.scene.field.cols() as u32, self.scene.field.rows() as u32];
        light_resolve::plan(&mut self.builder, size, name, light);
    }

    fn sky_view(&mut self) {
        if let (Some(layer), Some(sum)) = (self.images.sky_view, self.images.sky_sum) {
            let light = light_resolve::Light {
                sum,
                has_colour: false,
                colour: [1.0; 3],
                texel: None,
                albedo_map: None,
                radiance: None,
                layer: Some(layer),
                grey: true,
                edited: self.edited,
            };
            self.light_resolve("sky_view", &light);
        }
    }

    /// Writes a black picture if no light is active.
    fn dark(&mut self) -> Result<()> {
        if self.is_begun {
            return Ok(());
        }
        match self.images.sky_sum {
            Some(sum) => self.resolve("dark", sum, Some(Colour::Known([0.0; 3])), None),
            None => {
                let expected = "at least one that shines";
                return Err(Error::setting("lights", "all of radiance 0", expected));
            }
        }
        Ok(())
    }
}
