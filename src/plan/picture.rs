mod images;

use super::azimuths::{self, Shape};
use super::blocks::Blocks;
use super::bounces::{self, Bouncing, bounce_name};
use super::edit::Edits;
use super::shining::{Aimed, Shining};
use super::spheres::light_name;
use super::sweep::Sweep;
use super::sweeping::{Lists, Sweeping, part, prepare, settings};
use super::{Builder, Limits, Nodes, Plan, ResourceId};
use crate::passes::{self, light_resolve};
use crate::scene::{Albedo, Basis, Border, Quality, Scene, Surface, Wedges};
use crate::{Error, Result};
use images::{Harmonics, Images, Tables};

/// What a picture should hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Besides the whole, an image for each light and each bounce.
    pub light_layers: bool,
    /// Besides, what a sky of radiance 1 gives to albedo 1: the sky-view factor of a tilted
    /// receiver, [0..1].
    pub sky_view: bool,
    /// Every batch's sweep keeps a lattice of its own, so that a frame whose light alone has changed
    /// needs no sweep ([`Plan::passes_after`]). Memory: the lattices of all azimuths at once, of suns'
    /// alone where an environment is by spherical harmonics: these keep what is seen instead.
    ///
    /// Sweeps along lines, with fuse own, aimed-nearest or aimed and a border that does not repeat,
    /// then also take edits ([`Plan::edit_passes`]), but not with an environment by spherical harmonics or
    /// with balls of light. Memory: a quarter of a byte a sample.
    pub keeps_horizons: bool,
    /// The heights will stay those of the scene: what these cannot show is left out.
    pub still: bool,
}

/// Passes that light a scene: [`Picture`] says what is wanted besides the whole.
///
/// Inputs, in order: "heights", "environment" and "albedo" where the scene has them. Outputs:
/// "radiance", then one "direct.*" image a light, "sky_view" and one "indirect.*" image a bounce where asked. All
/// are images of one channel where every colour is grey, else of four.
///
/// # Errors
/// Settings or lights out of range, nothing that shines, or a scene beyond the limits.
pub fn picture(scene: &Scene, quality: &Quality, limits: &Limits, wanted: Picture) -> Result<Plan> {
    let Scene { field, surface, lights } = scene;
    quality.check()?;
    lights.check()?;
    surface.check(field.rows() * field.cols())?;
    refuse_later(surface)?;
    let size = limits.check_size(field.rows(), field.cols())?;
    let mut notes = Vec::new();
    let shining = Shining::of(scene, quality, wanted, &mut notes)?;
    let mut sweep = Sweep::choose(field, surface.border, quality, limits, false, &mut notes)?;
    let is_walked = quality.bounces.walk_over(surface);
    if is_walked {
        sweep.keep_occluders()?;
    }
    if wanted.still && !is_walked && sweep.sees_own_crossings() && field.is_concave(surface.border)
    {
        notes.push("no sweep: nothing rises above anything else, the field is concave".into());
        sweep = Sweep::Crossings;
    }
    if matches!(sweep, Sweep::Surface { .. })
        && let Some(aimed) = shining.aimed().next()
    {
        let (flag, light) = match aimed.shape {
            Shape::Patch => ("--key", "a key light"),
            Shape::Disc | Shape::Point => ("--sun", "a sun"),
        };
        return Err(Error::setting(
            format!("--lines exact with {flag}"),
            format!("{light}, whose azimuths are no grid vectors"),
            "--method brute, which is exact in every azimuth",
        ));
    }
    if shining.is_grey {
        notes.push("one channel: every colour is grey".into());
    }
    let mut builder = Builder::new();
    let images = Images::make(&mut builder, scene, &shining, wanted);
    let bounces =
        if shining.is_dark() { 0 } else { bounces::worth_drawing(scene, quality, &mut notes) };
    let mut lists = shining.lists(
        images.need_circle(),
        quality,
        &sweep,
        (surface.border, field.cell_m()),
        &mut notes,
    )?;
    if is_walked && bounces > 0 {
        // Behind those of the lights.
        lists.push(azimuths::even(quality.bounces.azimuths, field.cell_m()));
    }
    let (mut tables, mut harmonics) = (None, None);
    match shining.environment.map(|e| (e, surface.border)) {
        Some(lit) if quality.basis == Basis::Sh => {
            if quality.wedges == Wedges::Table && matches!(sweep, Sweep::Surface { .. }) {
                return Err(Error::setting(
                    "--wedges table with --lines exact",
                    "wedges of uneven widths",
                    "--method brute, which is exact in every azimuth",
                ));
            }
            harmonics = Some(Harmonics::make(&mut builder, size, lit, quality, &lists[0]));
        }
        Some(lit) => tables = Some(Tables::make(&mut builder, lit, quality)),
        None if shining.sky.is_some() => notes.push("no environment: no table".into()),
        None => {}
    }
    let keeps = wanted.keeps_horizons;
    let is_editable = sweep.editable(surface.border).is_some()
        && harmonics.is_none()
        && images.sphere_sum.is_none()
        && bounces == 0;
    let takes_edits = keeps && !wanted.still && is_editable;
    let edits = takes_edits.then(|| Edits::make(&mut builder, size));
    // What is seen as harmonics is kept itself, and a sky's sum: no light of theirs needs the lattices.
    let kept_from = keeps.then_some(usize::from(harmonics.is_some()));
    let nodes = marched_nodes(&sweep, harmonics.as_ref(), &shining, wanted);
    let held = (limits, kept_from, nodes);
    let need_blocks = images.sphere_sum.is_some() || (bounces > 0 && !is_walked);
    let blocks = need_blocks.then(|| Blocks::make(&mut builder, size, surface.border));
    let (sweeping, lists) = if lists.is_empty() {
        (None, Lists::default())
    } else {
        let (sweeping, lists) =
            prepare(&mut builder, field, surface.border, sweep, images.heights, lists, held)?;
        (Some(sweeping), lists)
    };
    let levels = sweeping.as_ref().and_then(Sweeping::levels);
    let of_light = (shining.is_grey, wanted.light_layers);
    let bouncing = (bounces > 0)
        .then(|| Bouncing::make(&mut builder, scene, quality, (bounces, levels), of_light));
    let sweep = sweeping.as_ref().map(|s| &s.sweep);
    let mut used = used(quality, sweep, surface.border, &shining, &images);
    used.push(("bounces".into(), bouncing.as_ref().map_or(0, Bouncing::count).to_string()));
    let of_bounces = bouncing.iter().flat_map(Bouncing::used);
    let more: Vec<_> = of_bounces.filter(|(name, _)| used.iter().all(|u| u.0 != *name)).collect();
    used.extend(more);
    let mut drawing = Drawing {
        builder,
        scene,
        shining,
        images,
        tables,
        harmonics,
        sweeping,
        blocks,
        bouncing,
        edited: None,
        is_begun: false,
    };
    drawing.fill_tables(quality);
    drawing.light(&lists, quality)?;
    if let Some(edits) = edits {
        drawing.edit(size, &lists, edits);
        drawing.light(&lists, quality)?;
    }
    Plan::finish(drawing.builder, size, lists.lists.concat(), Vec::new(), notes, used, limits)
}

/// Texels of the inputs of a [`picture`](picture()), in its plan's order: "heights"; "environment" and
/// "albedo", opaque, where the scene has them.
pub fn picture_inputs(scene: &Scene) -> Vec<Vec<f32>> {
    let opaque =
        |texels: &[[f32; 3]]| texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let mut all = vec![scene.field.heights_m().to_vec()];
    if let Some(environment) = &scene.lights.environment {
        all.push(opaque(environment.texels()));
    }
    if let Albedo::Map(map) = &scene.surface.albedo {
        all.push(opaque(map));
    }
    all
}

/// Where methods that march from every sample do: at the nodes alone, where nothing else is lit through
/// their horizons.
fn marched_nodes(
    sweep: &Sweep,
    harmonics: Option<&Harmonics>,
    shining: &Shining<'_>,
    wanted: Picture,
) -> Nodes {
    let is_marched = matches!(sweep, Sweep::March { .. } | Sweep::Pyramid(_));
    let is_alone = shining.sky.is_none() && shining.aimed().next().is_none() && !wanted.sky_view;
    // A table is looked up by horizons of all samples.
    let nodes = harmonics.filter(|h| h.wedge_table.is_none() && is_marched && is_alone);
    let nodes = nodes.map(|h| h.sh.nodes);
    nodes.unwrap_or(Nodes { stride: 1 })
}

/// What only the reference can light so far.
fn refuse_later(surface: &Surface) -> Result<()> {
    let expected = "none: it is not yet there for pictures, only for the reference";
    if surface.phong.is_some() {
        return Err(Error::setting("phong", "a lobe", expected));
    }
    Ok(())
}

/// A picture while its passes are added.
struct Drawing<'a> {
    builder: Builder,
    scene: &'a Scene,
    shining: Shining<'a>,
    images: Images,
    tables: Option<Tables>,
    harmonics: Option<Harmonics>,
    /// None where balls of light are alone: each looks itself for what hides it.
    sweeping: Option<Sweeping>,
    /// What rays look at, towards balls of light and of bounces.
    blocks: Option<Blocks>,
    bouncing: Option<Bouncing>,
    /// Marks of the samples to be lit and their list, while passes of an edit are added.
    edited: Option<[ResourceId; 2]>,
    /// Whether a light has been resolved into the picture: the first clears it.
    is_begun: bool,
}

impl Drawing<'_> {
    fn border(&self) -> Border {
        self.scene.surface.border
    }

    fn fill_tables(&mut self, quality: &Quality) {
        let (Some(e), Some(image)) = (self.shining.environment, self.images.environment) else {
            return;
        };
        let Some(azimuths) = self.sweeping.as_ref().map(|s| s.azimuths) else { return };
        let (border, count) = (self.border(), quality.azimuths);
        let builder = &mut self.builder;
        if let Some(Tables { wedge_rows, tables }) = self.tables {
            let seen = (e, border);
            let wedges = [image, azimuths, wedge_rows];
            passes::env_wedges::plan(builder, seen, count, wedges);
            let nodes = quality.table_elevations;
            passes::env_tables::plan(builder, seen, nodes, count, [wedge_rows, tables]);
        }
        if let Some(Harmonics { sh, constants, env_turns, light_matrix, .. }) = &self.harmonics {
            passes::env_turns::plan(builder, e, sh, [image, *constants, *env_turns]);
            passes::light_matrix::plan(builder, sh, [*env_turns, *constants, *light_matrix]);
        }
    }

    /// Passes from the field to the lit picture; of an edit, from its lattices.
    fn light(&mut self, lists: &Lists, quality: &Quality) -> Result<()> {
        self.is_begun = false;
        self.sky_and_environment(lists);
        self.aimed(lists);
        self.spheres(quality);
        self.bounces(lists);
        self.sky_view();
        self.dark()
    }

    /// From here on passes are those of an edit: first all horizons, as every batch lights the same
    /// samples.
    fn edit(&mut self, size: [u32; 2], lists: &Lists, Edits { dirty, list }: Edits) {
        self.builder.begin_edits();
        let (border, ids) = (self.border(), [dirty, list]);
        self.edited = Some(ids);
        passes::dirty_mark::plan(&mut self.builder, size, ids);
        let batches = lists.batches.iter().flatten();
        if let Some(sweeping) = &self.sweeping {
            sweeping.record_edit(&mut self.builder, border, batches, ids);
        }
        passes::dirty_list::plan(&mut self.builder, size, ids);
    }

    fn sky_and_environment(&mut self, lists: &Lists) {
        let Some(sweeping) = self.sweeping.as_ref().filter(|_| self.images.need_circle()) else {
            return;
        };
        let (border, cell_m) = (self.border(), self.scene.field.cell_m());
        let Images { sky_sum, env_sum, sky_layer, env_layer, .. } = self.images;
        let batches = &lists.batches[0];
        for batch in batches {
            let part = part("sky", batch, batches);
            let builder = &mut self.builder;
            if self.edited.is_none() {
                sweeping.record(builder, batch, &part);
            }
            let (lane_heights, lattice) = (sweeping.lane_heights(batch), sweeping.lattice(batch));
            let (azimuths, sweep) = (sweeping.azimuths, &sweeping.sweep);
            if sky_sum.is_some() || self.tables.is_some() {
                let images = passes::sky_shade::Images {
                    lane_heights,
                    lattice,
                    azimuths,
                    sky_sum,
                    environment: env_sum.zip(self.tables.as_ref()).map(|(sum, t)| [sum, t.tables]),
                    edited: self.edited,
                };
                passes::sky_shade::plan(builder, sweep, border, cell_m, batch, &part, &images);
            }
            if let Some(Harmonics { sh, wedges, visibility, nodes, wedge_table, .. }) =
                &self.harmonics
            {
                if let Some((angles, _)) = wedge_table {
                    let ids = [lane_heights, azimuths, *angles];
                    let read = (lattice, None);
                    passes::sweep_fuse::plan(builder, sweep, border, batch, &part, ids, read);
                    continue;
                }
                let (visibility, nodes) = (*visibility, *nodes);
                let images = passes::sh_visibility::Images {
                    lane_heights,
                    lattice,
                    azimuths,
                    visibility,
                    nodes,
                };
                let (field, seen) = ((border, cell_m), (sh, *wedges, sweeping.nodes));
                passes::sh_visibility::plan(builder, sweep, field, seen, batch, &part, &images);
            }
        }
        if let (Some(h), Some(sum), Some(batch)) = (&self.harmonics, env_sum, batches.last()) {
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
                passes::sh_wedges::plan(&mut self.builder, field, &h.sh, &table, &images);
            }
            let ids = [lane_heights, h.visibility, h.light_matrix, sum];
            let field = (batch.axis, border, cell_m);
            passes::sh_shade::plan(&mut self.builder, field, &h.sh, ids, h.nodes);
        }
        if let (Some(sum), Some(colour)) = (sky_sum, self.shining.sky) {
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
        let lights: Vec<Aimed> = self.shining.aimed().collect();
        for (i, (batches, Aimed { name, shape, colour })) in
            batches_of_each.iter().zip(lights).enumerate()
        {
            for batch in batches {
                let part = part(&name, batch, batches);
                let Some(sweeping) = &self.sweeping else { return };
                let builder = &mut self.builder;
                if self.edited.is_none() {
                    sweeping.record(builder, batch, &part);
                }
                let lanes = sweeping.lane_heights(batch);
                let ids = [lanes, sweeping.azimuths, sum];
                let lattice = sweeping.lattice(batch);
                let sweep = &sweeping.sweep;
                passes::sun_shade::plan(
                    builder,
                    sweep,
                    border,
                    cell_m,
                    batch,
                    &part,
                    shape,
                    lattice,
                    ids,
                    self.edited,
                );
            }
            self.resolve(&name, sum, Some(colour), self.images.aimed_layers[i]);
        }
    }

    /// Balls add up in one sum; where layers are wanted each begins its own.
    fn spheres(&mut self, quality: &Quality) {
        let (Some(sum), Some(blocks)) = (self.images.sphere_sum, &self.blocks) else { return };
        blocks.record(&mut self.builder, &self.scene.field, self.images.heights, None);
        let names: Vec<String> =
            self.shining.spheres.shining.iter().map(|(i, _)| light_name(*i)).collect();
        for (index, name) in names.iter().enumerate() {
            let layer = self.images.sphere_layers[index];
            let Some(blocks) = &self.blocks else { return };
            let (lit, of) = ((self.scene, blocks), (index, quality.sun_azimuths));
            let begins = index == 0 || layer.is_some();
            self.shining.spheres.record(&mut self.builder, lit, of, begins, sum);
            if layer.is_some() {
                self.resolve(name, sum, None, layer);
            }
        }
        if self.images.sphere_layers.iter().all(Option::is_none) {
            self.resolve("lights", sum, None, None);
        }
    }

    /// Each bounce from the light of the one before.
    fn bounces(&mut self, lists: &Lists) {
        let Some(bouncing) = self.bouncing.take() else { return };
        let batches = lists.batches.last().map(Vec::as_slice);
        let Images { heights, radiance, sphere_sum, .. } = self.images;
        let begun = (heights, sphere_sum.is_some());
        bouncing.prepare(&mut self.builder, self.scene, self.blocks.as_ref(), begun);
        for k in 1..=bouncing.count() {
            let ids = [heights, radiance];
            let looked_at = (self.blocks.as_ref(), self.sweeping.as_ref().zip(batches));
            let (sum, exit) = bouncing.record(&mut self.builder, self.scene, looked_at, k, ids);
            self.resolve(&bounce_name(k), sum, None, exit);
        }
    }

    /// Adds the light of a sum to the picture: of one channel times `colour`, or of its own colour.
    fn resolve(
        &mut self,
        name: &str,
        sum: ResourceId,
        colour: Option<[f32; 3]>,
        layer: Option<ResourceId>,
    ) {
        let albedo = match self.scene.surface.albedo {
            Albedo::Constant(c) => c,
            Albedo::Map(_) => [1.0; 3],
        };
        let of_light = colour.unwrap_or([1.0; 3]);
        let is_first = !std::mem::replace(&mut self.is_begun, true);
        let light = light_resolve::Light {
            sum,
            has_colour: colour.is_none(),
            colour: [0, 1, 2].map(|c| of_light[c] * albedo[c]),
            albedo_map: self.images.albedo_map,
            radiance: Some((self.images.radiance, is_first)),
            layer,
            grey: self.shining.is_grey,
            edited: self.edited,
        };
        self.light_resolve(name, &light);
    }

    fn light_resolve(&mut self, name: &str, light: &light_resolve::Light) {
        let size = [self.scene.field.cols() as u32, self.scene.field.rows() as u32];
        light_resolve::plan(&mut self.builder, size, name, light);
    }

    fn sky_view(&mut self) {
        if let (Some(layer), Some(sum)) = (self.images.sky_view, self.images.sky_sum) {
            let light = light_resolve::Light {
                sum,
                has_colour: false,
                colour: [1.0; 3],
                albedo_map: None,
                radiance: None,
                layer: Some(layer),
                grey: true,
                edited: self.edited,
            };
            self.light_resolve("sky_view", &light);
        }
    }

    /// Where nothing shines the picture is black all the same.
    fn dark(&mut self) -> Result<()> {
        if self.is_begun {
            return Ok(());
        }
        match self.images.sky_sum {
            Some(sum) => self.resolve("dark", sum, Some([0.0; 3]), None),
            None => {
                let expected = "at least one that shines";
                return Err(Error::setting("lights", "all of radiance 0", expected));
            }
        }
        Ok(())
    }
}

/// The settings really used.
fn used(
    quality: &Quality,
    sweep: Option<&Sweep>,
    border: Border,
    shining: &Shining<'_>,
    images: &Images,
) -> Vec<(String, String)> {
    let mut used = settings(quality, sweep, border);
    if images.need_circle() {
        used.push(("azimuths".into(), quality.azimuths.to_string()));
    }
    let mut add = |name: &str, value: &str| used.push((name.into(), value.into()));
    match (shining.environment, quality.basis) {
        (Some(_), Basis::Sh) => {
            add("basis", "sh");
            add("sh_order", &quality.sh_order.to_string());
            add("wedges", quality.wedges.name());
            add("receiver", quality.receiver.name());
            add("window", quality.window.name());
            add("subsample", &quality.subsample.to_string());
            if quality.wedges == Wedges::Table {
                add("wedge_side", &quality.wedge_side.to_string());
            }
        }
        (Some(_), _) => {
            add("basis", "table");
            add("table_elevations", &quality.table_elevations.to_string());
        }
        (None, _) => {}
    }
    let has_balls = !shining.spheres.shining.is_empty();
    if has_balls || shining.aimed().any(|light| light.shape != Shape::Point) {
        used.push(("sun_azimuths".into(), quality.sun_azimuths.to_string()));
    }
    if has_balls {
        used.push(("light_cutoff".into(), quality.light_cutoff.to_string()));
    }
    used
}
