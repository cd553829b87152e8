//! Light that the surface throws at itself: which bounces are drawn, and their passes.
//!
//! A bounce's engine reads the exit radiance of the one before, and whatever it needs of the heights, and
//! writes what arrives at every sample; `light_resolve` makes that the bounce's own exit radiance.

use crate::graph::{Builder, Format, Owner, ResourceId};
use crate::passes::batch::Batch;
use crate::passes::blocks::Blocks;
use crate::passes::bounce_nodes::{BounceNodes, NodeSum};
use crate::passes::glossy::{BouncedLight, Glossy, Vectors};
use crate::passes::nodes::Nodes;
use crate::passes::pyramid::Pyramid;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::{Sweeping, part};
use crate::passes::{
    bounce_gather, bounce_march, bounce_shade, bounce_walk, cache_gather, height_cells,
    pyramid_march, shade_expand, shade_reduce, sky_shade, specular_gather, vector_reduce,
};
use crate::scene::{Border, BounceEngine, Bounces, HeightField, Levels, Quality, Scene, Surface};

/// What an engine's passes are told of one bounce.
pub(crate) struct Bounce {
    /// As in labels: "bounce1" is the first.
    pub name: String,
    /// What it is, to begin a reason with.
    pub why: String,
    /// Exit radiance of all samples, albedo and all, to be thrown on: four channels, or one where `grey`.
    pub exit: ResourceId,
    pub grey: bool,
    /// To be written: exit radiance for albedo 1, R, G, B; the fourth channel is the engine's own.
    pub sum: ResourceId,
    /// Where the engine finds what arrives, in place of every sample.
    pub at_nodes: Option<NodeSum>,
}

impl Bounce {
    /// Where an engine finds what arrives, and what it writes there.
    pub fn found_at(&self) -> NodeSum {
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
    /// What lobes throw on, where there are any.
    pub glossy: Option<Glossy>,
    /// Exit radiance of each bounce: its layer where wanted, else one image, used in turn; the last one's goes
    /// into the picture alone.
    exits: Vec<Option<ResourceId>>,
}

/// How what a sample sees is found, with what that needs of its own.
enum Engine {
    Brute,
    Sweep,
    Pyramid(bounce_gather::Pyramids),
}

/// The settings with the engine that the planner takes where it is to choose.
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
            "the sweep's lines lead to what is seen, in a fraction of brute's time".to_owned(),
        ),
        Some(way) => (BounceEngine::BruteForce, format!("{way} has no lines to walk over")),
    };
    notes.push(format!("bounce engine {}: {why}", engine.name()));
    Quality { bounces: Bounces { engine, ..quality.bounces }, ..*quality }
}

/// How many bounces are worth drawing.
pub(crate) fn needed_bounces(scene: &Scene, quality: &Quality, notes: &mut Vec<String>) -> u32 {
    let albedo = scene.surface.max_reflectance();
    let count = quality.bounces.needed_bounces(albedo);
    if count < quality.bounces.count {
        notes.push(dropped(&quality.bounces, count, albedo));
    }
    count
}

impl Bouncing {
    /// So many bounces, 1 or more, at nodes or at every sample; `levels` are those that direct light has of heights.
    pub fn make(
        builder: &mut Builder,
        scene: &Scene,
        quality: &Quality,
        (count, at_nodes, levels): (u32, Option<BounceNodes>, Option<pyramid_march::Images>),
        (grey, layers): (bool, bool),
        gloss: Option<&mut Vec<String>>,
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
        let glossy = gloss
            .map(|notes| Glossy::make(builder, (size, &shade), quality, (grey, layers), notes));
        let engine = match bounces.engine {
            BounceEngine::BruteForce => Engine::Brute,
            BounceEngine::Sweep => Engine::Sweep,
            BounceEngine::Auto => unreachable!("settled before"),
            BounceEngine::Pyramid => {
                let has_numbers =
                    glossy.is_none_or(|g| matches!(g.outgoing, BouncedLight::Seen(_)));
                Engine::Pyramid(pyramids(builder, (shade, grey), quality, levels, has_numbers))
            }
        };
        Self { azimuths: bounces.azimuths, grey, sum, at_nodes, engine, glossy, exits }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.exits.len()
    }

    /// The passes before the first bounce; `is_recorded` says that the blocks' are there.
    pub fn prepare(
        &self,
        builder: &mut Builder,
        scene: &Scene,
        blocks: Option<&Blocks>,
        (heights, is_recorded): (ResourceId, bool),
    ) {
        let Some(blocks) = blocks else { return };
        let pyramids = match &self.engine {
            Engine::Brute if is_recorded => return,
            Engine::Brute => return blocks.record(builder, &scene.field, heights, None),
            Engine::Sweep if self.at_nodes.is_none() => return,
            Engine::Sweep => None,
            Engine::Pyramid(pyramids) => Some(pyramids),
        };
        if !is_recorded {
            let of = (&scene.field, scene.surface.border);
            let ids = [heights, blocks.images.cells, blocks.images.ground];
            height_cells::plan(builder, of, ids, None);
        }
        let Some(pyramids) = pyramids else { return };
        if let Some(images) = pyramids.height_images.as_ref().filter(|_| pyramids.fills_heights) {
            pyramids.heights.record(builder, heights, images);
        }
    }

    /// The passes of bounce `k`, the first is 1; of `heights` and `direct` light it begins with the latter. Returns
    /// what arrives, and where its exit radiance belongs.
    pub fn record(
        &self,
        builder: &mut Builder,
        scene: &Scene,
        (blocks, swept): (Option<&Blocks>, Option<(&Sweeping, &[Batch])>),
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
            exit: match self.glossy.map(|glossy| glossy.outgoing) {
                Some(BouncedLight::Seen(exit)) => exit,
                _ => before.unwrap_or(direct),
            },
            grey: self.grey,
            sum: self.sum,
            at_nodes: self.at_nodes.map(|at| at.later.filter(|_| k > 1).unwrap_or(at.first)),
        };
        let size = [scene.field.cols() as u32, scene.field.rows() as u32];
        let blocks = || blocks.expect("made for engines that read cells and ground");
        match &self.engine {
            Engine::Brute => bounce_march::plan(builder, scene, blocks(), self.azimuths, &bounce),
            Engine::Sweep => {
                let (sweeping, batches) = swept.expect("swept for walks");
                match self.at_nodes.and_then(|at| Some((at.first, at.casts?))) {
                    Some((walked, casts)) if k > 1 => {
                        let first = batches[0].first;
                        let circle = (sweeping.azimuths, first..first + self.azimuths);
                        let field = (size, scene.surface.border);
                        cache_gather::plan(builder, field, circle, (&walked, casts), &bounce);
                    }
                    _ => walk(builder, scene, k, (sweeping, batches), (&bounce, &self.at_nodes)),
                }
            }
            Engine::Pyramid(of) => {
                let ids = [heights, blocks().images.ground];
                let how = (of, self.glossy.as_ref(), self.azimuths);
                gather(builder, &scene.field, how, &bounce, ids);
            }
        }
        if let Some(at) = &self.at_nodes {
            let ids = [blocks().images.ground, at.sky_share];
            bounce_shade::plan(builder, &scene.field, &bounce, ids);
        }
        (self.sum, self.exits[k - 1])
    }

    /// What leaves the ground diffusely after bounce `k` of `direct` light, which is 0; none of the last.
    pub fn diffuse(&self, k: usize, direct: ResourceId) -> Option<ResourceId> {
        match k {
            0 => Some(direct),
            _ => self.exits[k - 1].filter(|_| k < self.exits.len()),
        }
    }

    /// The settings really used.
    pub fn used(&self) -> Vec<(String, String)> {
        let mut used = Vec::new();
        let mut add = |name: &str, value: String| used.push((name.to_owned(), value));
        add("bounce_azimuths", self.azimuths.to_string());
        add("subsample", self.at_nodes.map_or(1, |at| at.first.nodes.stride).to_string());
        let engine = match &self.engine {
            Engine::Brute => BounceEngine::BruteForce,
            Engine::Sweep => BounceEngine::Sweep,
            Engine::Pyramid(of) => {
                if let Some(glossy) = &self.glossy {
                    add("bounce_gloss", glossy.gloss().name().to_owned());
                    add("sh_order", glossy.order.to_string());
                }
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

/// The sweeps that a bounce walks over, and the walks.
fn walk(
    builder: &mut Builder,
    scene: &Scene,
    k: usize,
    (sweeping, batches): (&Sweeping, &[Batch]),
    (bounce, at_nodes): (&Bounce, &Option<BounceNodes>),
) {
    for (i, batch) in batches.iter().enumerate() {
        let part = part(&bounce.name, batch, batches);
        let occluders = sweeping.occluders(batch).expect("kept for walks");
        // A lattice of its own still holds what the first bounce has swept.
        let is_shared =
            batches.iter().filter(|b| sweeping.occluders(b) == Some(occluders)).count() > 1;
        if k == 1 || is_shared {
            sweeping.record(builder, batch, &part);
        }
        let field = (scene.surface.border, scene.field.cell_m());
        if let Some(at) = at_nodes.filter(|at| at.finds_share && k == 1) {
            let images = sky_shade::Images {
                lane_heights: sweeping.lane_heights(batch),
                lattice: sweeping.lattice(batch),
                azimuths: sweeping.azimuths,
                sky_sum: Some(at.sky_share),
                environment: None,
                edited: None,
            };
            let (border, cell_m) = field;
            // Where nothing is met there is no ground to share.
            let border = if border == Border::Plane { Border::Open } else { border };
            sky_shade::plan(builder, &sweeping.sweep, border, cell_m, batch, &part, &images);
        }
        let swept = bounce_walk::Swept {
            lane_heights: sweeping.lane_heights(batch),
            azimuths: sweeping.azimuths,
            occluders,
            line_shift: sweeping.sweep.line_shift(),
            begin: batches[0].first,
            is_last: i + 1 == batches.len(),
            casts: at_nodes.and_then(|at| at.casts),
        };
        bounce_walk::plan(builder, field, (batch, &part), &swept, bounce);
    }
}

/// Levels of what is thrown, and what is seen of them along so many azimuths.
fn gather(
    builder: &mut Builder,
    field: &HeightField,
    (of, glossy, azimuths): (&bounce_gather::Pyramids, Option<&Glossy>, u32),
    bounce: &Bounce,
    ids: [ResourceId; 2],
) {
    if let Some(glossy) = glossy
        && let BouncedLight::Vectors(Vectors { exit, levels: Some([levels, table]), .. }) =
            glossy.outgoing
    {
        for level in 1..=of.shade.levels() {
            let (of, ids) = ((&of.shade, level), [exit, levels, table]);
            vector_reduce::plan(builder, of, glossy, &bounce.name, ids);
        }
    }
    if let Some(bounce_gather::ShadeImages { levels, table, stack }) = of.shade_images {
        for level in 1..=of.shade.levels() {
            shade_reduce::plan(builder, &of.shade, level, bounce, [levels, table]);
        }
        if let Some(stack) = stack {
            shade_expand::plan(builder, &of.shade, bounce, [levels, table, stack]);
        }
    }
    match glossy {
        Some(glossy) => specular_gather::plan(builder, field, (of, glossy), azimuths, bounce, ids),
        None => bounce_gather::plan(builder, field, of, azimuths, bounce, ids),
    }
}

/// Levels of exit radiance.
fn shade(quality: &Quality, size: [u32; 2], scene: &Scene) -> Pyramid {
    let Bounces { level_step, level_offset, .. } = quality.bounces;
    Pyramid { level_step, level_offset, ..Pyramid::new(quality, size, scene.surface.border) }
}

/// Levels of heights as settings of pyramids say, and of exit radiance as bounces' own, with images where numbers are
/// stored; light follows the receiver.
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

/// As in labels.
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
