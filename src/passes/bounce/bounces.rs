//! Indirect light: which bounces are computed, and their passes.
//!
//! A bounce engine reads the exit radiance of the previous bounce and the heights it needs. It writes
//! irradiance for albedo 1 at every grid point; `light_resolve` turns that into this bounce's exit radiance.

use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::batch::Batch;
use crate::passes::blocks::Blocks;
use crate::passes::bounce_ground::BounceGround;
use crate::passes::bounce_nodes::{BounceNodes, NodeSum};
use crate::passes::bounced_specular::{BouncedSpecular, ExitLight, Vectors};
use crate::passes::line_blocks::LineBlocks;
use crate::passes::nodes::Nodes;
use crate::passes::pyramid::{Octave, Pyramid};
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::{Sweeping, part};
use crate::passes::{
    bounce_gather, bounce_march, bounce_shade, bounce_walk, cache_gather, pyramid_march,
    shade_expand, shade_reduce, sky_shade, specular_gather, vector_reduce,
};
use crate::scene::{Border, BounceEngine, Bounces, HeightField, Levels, Quality, Scene, Surface};

/// Inputs of an engine's passes for one bounce.
pub(crate) struct Bounce {
    /// Label: "bounce1" is the first.
    pub name: String,
    /// Begins the reason of each pass.
    pub why: String,
    /// Exit radiance that this bounce reflects, albedo applied: four channels, or one where `grey`.
    pub exit: ResourceId,
    pub grey: bool,
    /// Output: exit radiance for albedo 1, R, G, B. The fourth channel is the engine's own.
    pub sum: ResourceId,
    /// Nodes at which the engine computes, in place of every grid point.
    pub at_nodes: Option<NodeSum>,
}

impl Bounce {
    /// Nodes at which an engine computes, and its output there.
    pub(crate) fn found_at(&self) -> NodeSum {
        self.at_nodes.unwrap_or(NodeSum { nodes: Nodes { stride: 1 }, sum: self.sum })
    }
}

/// The bounces of a picture, and what their passes read and write.
pub(crate) struct Bouncing {
    azimuths: u32,
    grey: bool,
    sum: ResourceId,
    at_nodes: Option<BounceNodes>,
    engine: Engine,
    /// Bounced specular reflection, where there is any.
    pub specular: Option<BouncedSpecular>,
    /// Exit radiance of each bounce: its own layer where requested, else one image used in turn. The last
    /// bounce's goes only into the picture.
    exits: Vec<Option<ResourceId>>,
}

/// How bounced light is found, with the engine's own images.
enum Engine {
    Brute,
    Sweep(BounceGround, LineBlocks),
    Pyramid(bounce_gather::Pyramids),
}

/// The settings with the engine that the planner chooses for `auto`.
pub(crate) fn settled(
    quality: &Quality,
    surface: &Surface,
    sweep: &Sweep,
    notes: &mut Vec<String>,
) -> Quality {
    let albedo = surface.max_reflectance();
    if quality.bounces.engine != BounceEngine::Auto || quality.bounces.needed_bounces(albedo) == 0 {
        return *quality;
    }
    let (engine, why) = match sweep.why_no_lines() {
        None => (
            BounceEngine::Sweep,
            "walks along the sweep's lines take a fraction of brute-force's time".to_owned(),
        ),
        Some(way) => (BounceEngine::BruteForce, format!("{way} has no lines to walk over")),
    };
    notes.push(format!("bounce engine {}: {why}", engine.name()));
    Quality { bounces: Bounces { engine, ..quality.bounces }, ..*quality }
}

/// How many bounces the planner computes.
pub(crate) fn needed_bounces(scene: &Scene, quality: &Quality, notes: &mut Vec<String>) -> u32 {
    let albedo = scene.surface.max_reflectance();
    let count = quality.bounces.needed_bounces(albedo);
    if count < quality.bounces.count {
        notes.push(dropped(&quality.bounces, count, albedo));
    }
    count
}

impl Bouncing {
    /// `count` bounces, 1 or more, at nodes or at every grid point. `levels` are the height levels that direct
    /// light uses.
    pub(crate) fn make(
        builder: &mut Builder,
        scene: &Scene,
        quality: &Quality,
        (count, at_nodes): (u32, Option<BounceNodes>),
        (levels, walked): (Option<pyramid_march::Images>, Option<(BounceGround, LineBlocks)>),
        (grey, layers): (bool, bool),
        specular_notes: Option<&mut Vec<String>>,
    ) -> Self {
        let bounces = &quality.bounces;
        let extent = [scene.field.cols() as u32, scene.field.rows() as u32, 1];
        let colour = if grey { Format::R32Float } else { Format::Rgba32Float };
        let mut image = |name: &str, owner: Owner, format: Format| {
            builder.image(name, owner, format, extent, false)
        };
        let exits = if layers {
            let layer = |k| image(&format!("indirect.{k}"), Owner::Output, colour);
            (1..=count).map(layer).map(Some).collect()
        } else {
            let exit = (count > 1).then(|| image("exit_radiance", Owner::Internal, colour));
            (1..=count).map(|k| exit.filter(|_| k < count)).collect()
        };
        let sum = image("bounce_sum", Owner::Internal, Format::Rgba32Float);
        let size = [extent[0], extent[1]];
        let shade = shade(quality, size, scene);
        let specular = specular_notes.map(|notes| {
            // Brute force needs no levels.
            let shade = (bounces.engine == BounceEngine::Pyramid).then_some(&shade);
            BouncedSpecular::make(builder, (size, shade), quality, (grey, layers), notes)
        });
        let engine = match bounces.engine {
            BounceEngine::BruteForce => Engine::Brute,
            BounceEngine::Sweep => {
                let (ground, line_blocks) = walked.expect("made for walks");
                Engine::Sweep(ground, line_blocks)
            }
            BounceEngine::Auto => unreachable!("settled before"),
            BounceEngine::Pyramid => {
                let has_numbers =
                    specular.is_none_or(|g| matches!(g.outgoing, ExitLight::Upward(_)));
                Engine::Pyramid(pyramids(builder, (shade, grey), quality, levels, has_numbers))
            }
        };
        Self { azimuths: bounces.azimuths, grey, sum, at_nodes, engine, specular, exits }
    }

    /// How many bounces there are.
    pub(crate) fn count(&self) -> usize {
        self.exits.len()
    }

    /// The passes before the first bounce, besides those of the blocks.
    pub(crate) fn prepare(&self, builder: &mut Builder, heights: ResourceId) {
        let Engine::Pyramid(pyramids) = &self.engine else { return };
        if let Some(images) = pyramids.height_images.as_ref().filter(|_| pyramids.fills_heights) {
            pyramids.heights.plan(builder, heights, images);
        }
    }

    /// The passes of bounce `k`, from 1; bounce 1 reads `direct`. Returns the irradiance, and the image for its
    /// exit radiance.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        scene: &Scene,
        (blocks, swept): (Option<&Blocks>, Option<WalkedOver>),
        k: usize,
        [heights, direct]: [ResourceId; 2],
    ) -> (ResourceId, Option<ResourceId>) {
        let before = k.checked_sub(2).and_then(|i| self.exits[i]);
        let bounce = Bounce {
            name: bounce_name(k),
            why: match k {
                1 => "direct light off the surface".to_owned(),
                _ => format!("light of bounce {} off the surface", k - 1),
            },
            exit: match self.specular.map(|specular| specular.outgoing) {
                Some(ExitLight::Upward(exit)) => exit,
                _ => before.unwrap_or(direct),
            },
            grey: self.grey,
            sum: self.sum,
            at_nodes: self.at_nodes.and_then(|at| at.of_bounce(k)),
        };
        let size = [scene.field.cols() as u32, scene.field.rows() as u32];
        let blocks = || blocks.expect("made for engines that read the ground");
        match &self.engine {
            Engine::Brute => {
                let how = (self.azimuths, self.specular.as_ref());
                bounce_march::plan(builder, scene, blocks(), how, &bounce);
            }
            Engine::Sweep(ground, line_blocks) => {
                let over = swept.expect("swept for walks");
                let WalkedOver { sweeping, batches } = over;
                match self.at_nodes.and_then(|at| at.cached()) {
                    Some((visibility_cache, _)) if k > 1 => {
                        let before = self.found_at(k - 1);
                        let first = batches[0].first;
                        let circle = (sweeping.azimuths, first..first + self.azimuths);
                        let field = (size, scene.surface.border);
                        cache_gather::plan(
                            builder,
                            field,
                            circle,
                            (&before, visibility_cache),
                            &bounce,
                        );
                    }
                    _ => {
                        ground.plan(builder, heights, &bounce);
                        let made = (ground, line_blocks);
                        walk(builder, scene, k, (&over, made), (&bounce, &self.at_nodes));
                    }
                }
            }
            Engine::Pyramid(of) => {
                let ids = [heights, blocks().ground];
                let how = (of, self.specular.as_ref(), self.azimuths);
                gather(builder, &scene.field, how, &bounce, ids);
            }
        }
        if let Some(at) = self.at_nodes.filter(|_| bounce.at_nodes.is_some()) {
            let ids = [blocks().ground, at.sky_share];
            bounce_shade::plan(builder, &scene.field, &bounce, ids);
        }
        (self.sum, self.exits[k - 1])
    }

    /// Where bounce `k` is found, from 1.
    fn found_at(&self, k: usize) -> NodeSum {
        let every = NodeSum { nodes: Nodes { stride: 1 }, sum: self.sum };
        self.at_nodes.and_then(|at| at.of_bounce(k)).unwrap_or(every)
    }

    /// The diffuse exit radiance after bounce `k`; 0 is direct light. None after the last bounce.
    pub(crate) fn diffuse(&self, k: usize, direct: ResourceId) -> Option<ResourceId> {
        match k {
            0 => Some(direct),
            _ => self.exits[k - 1].filter(|_| k < self.exits.len()),
        }
    }

    /// The settings in use, for metadata.
    pub(crate) fn used(&self) -> Vec<(String, String)> {
        let mut used = Vec::new();
        let mut add = |name: &str, value: String| used.push((name.to_owned(), value));
        add("bounce_azimuths", self.azimuths.to_string());
        let first = self.at_nodes.and_then(|at| at.first);
        add("subsample", first.map_or(1, |first| first.nodes.stride).to_string());
        if let Some(specular) = &self.specular {
            add("bounce_specular", specular.mode().name().to_owned());
            add("sh_order", specular.order.to_string());
        }
        let engine = match &self.engine {
            Engine::Brute => BounceEngine::BruteForce,
            Engine::Sweep(..) => BounceEngine::Sweep,
            Engine::Pyramid(of) => {
                add("bounce_level_step", of.shade.level_step.to_string());
                add("bounce_level_offset", of.shade.level_offset.to_string());
                add("level_step", of.heights.level_step.to_string());
                add("level_offset", of.heights.level_offset.to_string());
                add("levels", of.heights.stored.name().to_owned());
                add("receiver", of.receiver.name().to_owned());
                BounceEngine::Pyramid
            }
        };
        add("bounce_engine", engine.name().to_owned());
        used
    }
}

/// What a bounce walks over.
pub(crate) struct WalkedOver<'a> {
    pub sweeping: &'a Sweeping,
    pub batches: &'a [Batch],
}

/// The sweeps that a bounce walks over, and the walks.
fn walk(
    builder: &mut Builder,
    scene: &Scene,
    k: usize,
    (over, (ground, line_blocks)): (&WalkedOver, (&BounceGround, &LineBlocks)),
    (bounce, at_nodes): (&Bounce, &Option<BounceNodes>),
) {
    let WalkedOver { sweeping, batches } = *over;
    let (begin, end) = (batches[0].first, batches[batches.len() - 1].azimuths().end);
    let first: Vec<_> = batches.iter().map(|b| (*b, part(&bounce.name, b, batches))).collect();
    if k == 1 && sweeping.has_own_lattices {
        sweeping.plan_all(builder, &first);
    }
    let [shaded, walked] = at_nodes.map_or([None; 2], |at| at.own_share());
    for (batch, part) in &first {
        let occluders = sweeping.occluders(batch).expect("kept for walks");
        // A lattice of its own still holds the first bounce's sweep.
        let is_shared =
            batches.iter().filter(|b| sweeping.occluders(b) == Some(occluders)).count() > 1;
        if k == 1 && !sweeping.has_own_lattices || is_shared {
            sweeping.plan_all(builder, &[(*batch, part.clone())]);
        }
        let field = (scene.surface.border, scene.field.cell_m());
        if let Some(share) = shaded.filter(|_| k == 1) {
            let images = sky_shade::Images {
                lanes: sweeping.lanes(batch),
                lattice: sweeping.lattice(batch),
                azimuths: sweeping.azimuths,
                sky_sum: Some(share),
                environment: None,
                specular: None,
                edited: None,
            };
            let (border, cell_m) = field;
            // Without relief there is no ground to be visible.
            let border = if border == Border::Plane { Border::Open } else { border };
            sky_shade::plan(builder, &sweeping.sweep, border, cell_m, batch, part, &images);
        }
        let swept = bounce_walk::Swept {
            azimuths: sweeping.azimuths,
            occluders,
            line_blocks: *line_blocks,
            ground: *ground,
            line_shift: sweeping.sweep.line_shift(),
            begin,
            end,
            visibility_cache: at_nodes.and_then(|at| at.cached()),
            sky_share: walked.filter(|_| k == 1),
        };
        let groups = line_blocks.groups(batch);
        for azimuths in &groups {
            let part = match groups.len() {
                1 => part.clone(),
                _ => {
                    let [from, to] = [azimuths.start, azimuths.end].map(|k| k - batch.first);
                    format!("{part} azimuths {from}..{to}")
                }
            };
            let of = (batch, azimuths, part.as_str());
            line_blocks.plan(builder, scene.surface.border, of, &swept, bounce);
            bounce_walk::plan(builder, field, of, &swept, bounce);
        }
    }
}

/// Fills the levels of exit radiance, then gathers from them along `azimuths`.
fn gather(
    builder: &mut Builder,
    field: &HeightField,
    (of, specular, azimuths): (&bounce_gather::Pyramids, Option<&BouncedSpecular>, u32),
    bounce: &Bounce,
    ids: [ResourceId; 2],
) {
    if let Some(specular) = specular
        && let ExitLight::Vectors(Vectors { exit, levels: Some([levels, table]), .. }) =
            specular.outgoing
    {
        let constants = builder.constants(&of.shade.reductions());
        for octave in of.shade.octaves() {
            let octave = Octave::new(&of.shade, octave, constants);
            let ids = [exit, levels, table];
            vector_reduce::plan(builder, &octave, specular, &bounce.name, ids);
        }
    }
    if let Some(bounce_gather::ShadeImages { levels, table, stack }) = of.shade_images {
        let constants = builder.constants(&of.shade.reductions());
        for octave in of.shade.octaves() {
            let octave = Octave::new(&of.shade, octave, constants);
            shade_reduce::plan(builder, &octave, bounce, [levels, table]);
        }
        if let Some(stack) = stack {
            shade_expand::plan(builder, &of.shade, bounce, [levels, table, stack]);
        }
    }
    match specular {
        Some(specular) => {
            specular_gather::plan(builder, field, (of, specular), azimuths, bounce, ids)
        }
        None => bounce_gather::plan(builder, field, of, azimuths, bounce, ids),
    }
}

/// Levels of exit radiance.
fn shade(quality: &Quality, size: [u32; 2], scene: &Scene) -> Pyramid {
    let Bounces { level_step, level_offset, .. } = quality.bounces;
    Pyramid { level_step, level_offset, ..Pyramid::new(quality, size, scene.surface.border) }
}

/// Height levels by the pyramid settings and exit radiance levels by the bounce settings, with images where
/// levels are stored. Light follows the receiver.
fn pyramids(
    builder: &mut Builder,
    (shade, grey): (Pyramid, bool),
    quality: &Quality,
    levels: Option<pyramid_march::Images>,
    has_numbers: bool,
) -> bounce_gather::Pyramids {
    let size = shade.size;
    let Quality { level_step, level_offset, .. } = *quality;
    let heights = Pyramid { level_step, level_offset, ..shade };
    let shade_images = (has_numbers && shade.levels() > 0).then(|| {
        let width = 1 << shade.width_shift();
        let height = shade.all_texels().div_ceil(u64::from(width)) as u32;
        let count = shade.levels();
        let mut image = |name: &str, format: Format, extent: [u32; 3], layered: bool| {
            builder.image(name, Owner::Internal, format, extent, layered)
        };
        let colour = if grey { Format::R32Float } else { Format::Rgba32Float };
        bounce_gather::ShadeImages {
            levels: image("shade_levels", Format::Rgba32Float, [width, height, 1], false),
            table: image("shade_table", Format::Rgba32Uint, [count, 1, 1], false),
            stack: (shade.stored == Levels::Stack)
                .then(|| image("shade_stack", colour, [size[0], size[1], count], true)),
        }
    });
    let fills_heights = levels.is_none();
    let height_images = levels.or_else(|| heights.images(builder));
    let receiver = quality.receiver;
    bounce_gather::Pyramids { heights, height_images, fills_heights, shade, shade_images, receiver }
}

/// The bounce's label.
pub(crate) fn bounce_name(k: usize) -> String {
    format!("bounce{k}")
}

/// Why bounces are left out.
pub(crate) fn dropped(bounces: &Bounces, count: u32, albedo: f64) -> String {
    if albedo == 0.0 {
        return "no bounces: the surface reflects nothing".into();
    }
    let first = count + 1;
    let all: f64 = (first..=bounces.count).map(|k| albedo.powi(k as i32)).sum();
    format!(
        "bounces {first} to {} dropped: of a surface that reflects at most {albedo} they carry at most {all:.3e} of \
         the direct light, within the bounce cutoff of {}",
        bounces.count, bounces.cutoff
    )
}
