//! Tests that constants defined in both GLSL and Rust have equal values.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::azimuths::{self, Shape};
use super::bounce_walk::From;
use super::device_peak;
use super::facet_mask::DIRECTIONS_A_WORD;
use super::height_bounds;
use super::line_blocks::LONGEST;
use super::scatter_gather::Source;
use super::sh_layout::Lit;
use super::specular_tables::{LEVEL_TEXELS, SWEPT_EVERY};
use super::sphere_sh_shade::WITHIN_CELLS;
use super::sweep::{HullStorage, Sweep};
use super::sweeping::LANE_BUFFER_PAD;
use super::terrain_draw::TILE;
use crate::graph::{CELL, GROUP_LINES, shaders};
use crate::scene::{Border, Fuse, REACH_CELLS, Wedges, visible};

/// Numbers that shaders alone use: codes between their own functions, sizes of their own lists, strides of lanes. `FACET_LOST` is compared where the host reads it, in the crate of bakes.
const OF_SHADERS: [&str; 18] = [
    "BASE",
    "BEYOND",
    "BLOCK",
    "ENTRIES",
    "FACET_LOST",
    "GROUPS_ACROSS",
    "LANE_STRIDE",
    "LATTICE_STRIDE",
    "LEVEL_BITS",
    "MAX_COUNT",
    "MOST_STEPS",
    "NEVER",
    "POINTS",
    "RAY_FREE",
    "RAY_GROUND",
    "RAY_HIT",
    "RAY_LOST",
    "SHARE_BITS",
];

fn host() -> BTreeMap<&'static str, u32> {
    let fuse = Sweep::fuse_word;
    let part = |name| device_peak::PARTS.iter().position(|p| *p == name).expect("a part") as u32;
    let [occluders, slopes_f32, slopes_f16] = Sweep::CONTENTS;
    BTreeMap::from([
        ("AZIMUTH_FLIPS_LANES", azimuths::FLIPS_LANES),
        ("AZIMUTH_FLIPS_MARCH", azimuths::FLIPS_MARCH),
        ("AZIMUTH_MARCHES_ROWS", azimuths::MARCHES_ROWS),
        ("BORDER_OPEN", Border::Open as u32),
        ("BORDER_PERIODIC", Border::Periodic as u32),
        ("BORDER_PLANE", Border::Plane as u32),
        ("BY_NLP", Wedges::Nlp as u32),
        ("BY_TABLE", Wedges::Table as u32),
        ("CELL_SHIFT", CELL.trailing_zeros()),
        ("COPY", part("copy")),
        ("FETCH", part("fetch")),
        ("FILL", part("fill")),
        ("FMA", part("fma")),
        ("FROM_BETWEEN", From::Between as u32),
        ("FROM_BLOCKS", height_bounds::FROM_BLOCKS),
        ("FROM_CARRIED", Source::Carried as u32),
        ("FROM_CELLS", height_bounds::FROM_CELLS),
        ("FROM_DIRECT", Source::Direct as u32),
        ("FROM_HEIGHTS", height_bounds::FROM_HEIGHTS),
        ("FROM_KEPT", From::Kept as u32),
        ("FROM_NONE", Source::None as u32),
        ("FROM_REST", From::Rest as u32),
        ("FUSE_AIMED", fuse(Fuse::Aimed)),
        ("FUSE_AIMED_AROUND", fuse(Fuse::AimedAround)),
        ("FUSE_AIMED_NEAREST", fuse(Fuse::AimedNearest)),
        ("FUSE_CROSSINGS", Sweep::Crossings.fuse_mode()),
        ("FUSE_DIRECT", Sweep::March { distances: false }.fuse_mode()),
        ("FUSE_NEAREST", fuse(Fuse::Nearest)),
        ("FUSE_OWN", fuse(Fuse::Own)),
        ("FUSE_SLOPES", fuse(Fuse::Slopes)),
        ("FACET_DIRECTIONS", DIRECTIONS_A_WORD as u32),
        ("GROUP_LINES", GROUP_LINES),
        ("HULL_IN_OCCLUDERS", HullStorage::Occluders as u32),
        ("HULL_IN_PRIVATE", HullStorage::Private as u32),
        ("HULL_IN_SHARED", HullStorage::Shared as u32),
        ("LANE_BUFFER_PAD", LANE_BUFFER_PAD),
        ("LATTICE_OCCLUDERS", occluders),
        ("LATTICE_SLOPES_F16", slopes_f16),
        ("LATTICE_SLOPES_F32", slopes_f32),
        // A word of the mask is eight columns of four rows.
        ("LEVEL_TEXELS", LEVEL_TEXELS as u32),
        ("LIGHT_GROUP_WORDS", shaders::SKY_SHADE.group_size()[1]),
        ("MOST_LEVEL", LONGEST.trailing_zeros()),
        ("POINT_GROUND", visible::GROUND),
        ("POINT_LOST", visible::LOST),
        ("POINT_SKY", visible::SKY),
        ("REACH_CELLS", REACH_CELLS),
        ("RECEIVER_COSINE", Lit::Cosine as u32),
        ("RECEIVER_PLANE", Lit::Plane as u32),
        ("RECEIVER_SPECULAR", Lit::Specular as u32),
        ("RESOLVE_GROUP_WORDS", shaders::LIGHT_RESOLVE.group_size()[1] / 4),
        ("SHAPE_DISC", Shape::Disc as u32),
        ("SHAPE_PATCH", Shape::Patch as u32),
        ("SHAPE_POINT", Shape::Point as u32),
        ("SHARED", part("shared")),
        ("SIDE", TILE + 1),
        ("SLOPES_F16", slopes_f16),
        ("SLOPES_F32", slopes_f32),
        ("SWEPT_EVERY", SWEPT_EVERY as u32),
        ("WITHIN_CELLS", WITHIN_CELLS),
    ])
}

/// Names and numbers of `const TYPE NAME = NUMBER;`.
fn numbers(folder: &Path, found: &mut Vec<(String, String, u32)>) {
    for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path())
    {
        if path.is_dir() {
            numbers(&path, found);
        } else if path
            .extension()
            .is_some_and(|e| ["comp", "glsl", "frag", "vert"].iter().any(|x| e == *x))
        {
            for line in fs::read_to_string(&path).expect("text").lines() {
                let Some((of_type, rest)) =
                    line.trim().strip_prefix("const ").and_then(|rest| rest.split_once(' '))
                else {
                    continue;
                };
                let Some((name, value)) = rest.split_once(" = ") else { continue };
                let value = value.split(';').next().expect("a part").trim_end_matches('u');
                let number = match value.strip_prefix("0x") {
                    Some(hex) => u32::from_str_radix(hex, 16).ok(),
                    None => value.trim_end_matches(".0").parse().ok(),
                };
                found.extend(number.map(|n| (of_type.to_owned(), name.to_owned(), n)));
            }
        }
    }
}

/// Passes that share their workgroups, or their counts, have workgroups of one size.
#[test]
fn passes_that_share_groups_have_one_size() {
    let reductions = [shaders::SHADE_REDUCE.group_size(), shaders::VECTOR_REDUCE.group_size()];
    assert_eq!(reductions, [shaders::HEIGHT_REDUCE.group_size(); 2]);
    assert_eq!(shaders::SUN_SHADE.group_size(), shaders::SKY_SHADE.group_size());
}

/// A new `const uint` or `const int` with a number is in `host`, or in the list of those that shaders alone use.
#[test]
fn shaders_and_host_state_the_same_numbers() {
    let mut found = Vec::new();
    numbers(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders_glsl"), &mut found);
    let mut left = host();
    for (of_type, name, number) in found {
        match host().get(name.as_str()) {
            Some(stated) => {
                assert_eq!(number, *stated, "{name}: in a shader and on the host");
                left.remove(name.as_str());
            }
            None => assert!(
                of_type == "float" || OF_SHADERS.contains(&name.as_str()),
                "{name} = {number} in a shader: compare it here with the host's"
            ),
        }
    }
    assert!(left.is_empty(), "in no shader: {:?}", left.keys());
}
