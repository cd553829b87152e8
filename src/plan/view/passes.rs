//! Passes and memory of a view, known without a device.

use std::fmt;

use super::View;
use crate::graph::Owner;
use crate::graph::bytes_text;
use crate::passes::plinth_draw;
use crate::passes::terrain_draw::{TILE, tile_indices};

/// A graphics pass of a [`View`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewPass {
    /// Name of its shaders, its debug label and its timing row.
    pub pass: &'static str,
    /// Why the view contains it.
    pub why: String,
    /// Vertex shader invocations.
    pub vertices: u64,
    /// Bytes read and written if it fills the picture, each once.
    pub bytes: u64,
    /// Images read, by name.
    pub reads: Vec<&'static str>,
    /// Images written, by name.
    pub writes: Vec<&'static str>,
}

/// An image or a buffer of a [`View`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewResource {
    /// Named by content.
    pub name: &'static str,
    /// Its owner: the caller, or [`ViewRenderer`](crate::gpu::ViewRenderer).
    pub owner: Owner,
    /// Bytes on the device.
    pub bytes: u64,
}

/// Bytes of an RGBA32F pixel.
const COLOUR_BYTES: u64 = 16;
/// Bytes of a D32 depth.
const DEPTH_BYTES: u64 = 4;

impl View {
    fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Passes in order; `for_screen` adds the tone curve that makes 8-bit codes.
    pub fn passes(&self, for_screen: bool) -> Vec<ViewPass> {
        let (pixels, samples) = (self.pixels(), u64::from(self.samples));
        let field = u64::from(self.field[0]) * u64::from(self.field[1]);
        let side = u64::from(TILE) + 1;
        let vertices = u64::from(self.tiles) * side * side;
        let step = self.terrain.mesh_step;
        let mesh = match step {
            1 => "the ground: a vertex at every grid point, two triangles a cell".to_owned(),
            _ => format!("the ground: a vertex at every {step}th grid point, two triangles a cell"),
        };
        let why_samples = match samples {
            1 => String::new(),
            _ => format!("; {samples} samples a pixel, whose mean is kept"),
        };
        let mut ground = vec!["heights", "radiance"];
        let mut texels = vertices * 4 + field * self.radiance.bytes();
        if self.has_voids {
            ground.push("voids");
            texels += field * 4;
        }
        let drawn = if for_screen { "picture_radiance" } else { "picture" };
        let written = if samples > 1 {
            vec![drawn, "picture_samples", "picture_depth"]
        } else {
            vec![drawn, "depth"]
        };
        let terrain = ViewPass {
            pass: "terrain_draw",
            why: mesh + &why_samples,
            vertices,
            bytes: texels + pixels * samples * (COLOUR_BYTES + DEPTH_BYTES),
            reads: ground.clone(),
            writes: written.clone(),
        };
        let colours = written.iter().copied().filter(|name| !name.contains("depth")).collect();
        let plinth = self.plinth.as_ref().map(|push| {
            let vertices = u64::from(plinth_draw::FACES * plinth_draw::vertices(push));
            ViewPass {
                pass: "plinth_draw",
                why: "below the field's edges: walls and a base, without depths".to_owned(),
                vertices,
                bytes: vertices * 4 + pixels * samples * COLOUR_BYTES,
                reads: ground,
                writes: colours,
            }
        });
        let [width, height] = self.environment.unwrap_or([0, 0]);
        let sky = ViewPass {
            pass: "sky_draw",
            why: match self.environment {
                Some(_) => "behind the ground: sky and environment, where no ground is visible",
                None => "behind the ground: the sky, or the background, where no ground is visible",
            }
            .to_owned(),
            vertices: 3,
            bytes: u64::from(width) * u64::from(height) * COLOUR_BYTES
                + pixels * samples * (COLOUR_BYTES + DEPTH_BYTES)
                + if samples > 1 { pixels * COLOUR_BYTES } else { 0 },
            reads: self.environment.map(|_| "environment").into_iter().collect(),
            writes: written,
        };
        let depth = (samples > 1).then(|| ViewPass {
            pass: "depth_resolve",
            why: "the first sample's depth of each pixel, where depth is requested".to_owned(),
            vertices: 3,
            bytes: pixels * 2 * DEPTH_BYTES,
            reads: vec!["picture_depth"],
            writes: vec!["depth"],
        });
        let tone = for_screen.then(|| ViewPass {
            pass: "picture_tone",
            why: "the picture is of codes: exposure, tone curve, sRGB".to_owned(),
            vertices: 3,
            bytes: pixels * (COLOUR_BYTES + 4),
            reads: vec!["picture_radiance"],
            writes: vec!["picture"],
        });
        [terrain, sky].into_iter().chain(plinth).chain(depth).chain(tone).collect()
    }

    /// Images and buffers besides "heights", "radiance" and "environment", which the plan of the lit field provides.
    pub fn memory(&self, for_screen: bool) -> Vec<ViewResource> {
        let (pixels, samples) = (self.pixels(), u64::from(self.samples));
        let own = |name, bytes| ViewResource { name, owner: Owner::Internal, bytes };
        let given = |name, owner, bytes| ViewResource { name, owner, bytes };
        let mut all = Vec::new();
        if self.has_voids {
            let field = u64::from(self.field[0]) * u64::from(self.field[1]);
            all.push(given("voids", Owner::Input, field * 4));
        }
        let picture_bytes = if for_screen { 4 } else { COLOUR_BYTES };
        all.push(given("picture", Owner::Output, pixels * picture_bytes));
        all.push(given("depth", Owner::Output, pixels * DEPTH_BYTES));
        if samples > 1 {
            all.push(own("picture_samples", pixels * samples * COLOUR_BYTES));
        }
        all.push(own("picture_depth", pixels * samples * DEPTH_BYTES));
        if for_screen {
            all.push(own("picture_radiance", pixels * COLOUR_BYTES));
        }
        all.push(own("tile_indices", 2 * tile_indices().len() as u64));
        all
    }

    /// Note on why a picture for a file has no pass `picture_tone`, and its memory.
    pub fn tone_note(&self) -> String {
        let bytes = COLOUR_BYTES * self.pixels();
        let text = bytes_text(bytes);
        format!(
            "no picture_tone: a file's picture is of radiance; a window's takes {text} more for it"
        )
    }
}

/// A table of passes and of memory, for a picture in a file.
impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "before a camera, {width} × {height}, after the passes above")?;
        for (name, value) in &self.settings {
            writeln!(f, "  {name} {value}")?;
        }
        writeln!(f, "\n{:<34} {:>18} {:>11}  why", "pass", "vertices", "traffic")?;
        for draw in self.passes(false) {
            let (vertices, traffic) = (draw.vertices, bytes_text(draw.bytes));
            writeln!(f, "  {:<32} {vertices:>18} {traffic:>11}  {}", draw.pass, draw.why)?;
        }
        writeln!(f, "\n{:<24} {:>9} {:>26} {:>12}", "image or buffer", "whose", "", "memory")?;
        let mut row = |name: &str, whose: &str, bytes: u64| {
            writeln!(f, "{name:<24} {whose:>9} {:>26} {:>12}", "", bytes_text(bytes))
        };
        let memory = self.memory(false);
        for resource in &memory {
            let whose = match resource.owner {
                Owner::Internal => "ours",
                Owner::Input | Owner::InputBuffer => "input",
                Owner::Output => "output",
            };
            row(resource.name, whose, resource.bytes)?;
        }
        row("all", "", memory.iter().map(|resource| resource.bytes).sum())?;
        writeln!(f, "\nnote: {}", self.tone_note())
    }
}
