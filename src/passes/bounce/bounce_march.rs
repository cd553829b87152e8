use crate::graph::{Builder, MOST_TURNS, Part, shaders};
use crate::passes::blocks::Blocks;
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounced_specular::{BouncedSpecular, ExitLight, Vectors};
use crate::passes::bounces::Bounce;
use crate::scene::Scene;

/// Gathers bounced light at every grid point, or at every node, by brute force; with specular also as a series.
pub(crate) fn plan(
    builder: &mut Builder,
    scene: &Scene,
    blocks: &Blocks,
    (azimuths, specular): (u32, Option<&BouncedSpecular>),
    bounce: &Bounce,
) {
    let field = &scene.field;
    let NodeSum { nodes, sum } = bounce.found_at();
    let [across, along] = nodes.size([field.cols() as u32, field.rows() as u32]);
    let [thin_rows, thin_cols] = blocks.thin(field);
    let [cells, maxima] = blocks.of_rays();
    let at_once = (MOST_TURNS / (blocks.levels.most_steps() + 1)).max(1);
    let vectors = match specular.map(|specular| specular.outgoing) {
        Some(ExitLight::Vectors(Vectors { exit, .. })) => Some(exit),
        _ => None,
    };
    let layers = specular.map_or(0, |specular| u64::from(specular.layers()));
    // A step that adds a visible piece reads four texels of every layer. Most steps add none: one texel per layer is counted.
    let each = blocks.levels.lookups() * if vectors.is_some() { 1 + layers } else { 1 };
    let mut bound = vec![
        ("cells", cells),
        ("maxima", maxima),
        ("ground", blocks.ground),
        ("bounce_sum", sum),
        match vectors {
            Some(vectors) => ("exit_vectors", vectors),
            None => ("exit_radiance", bounce.exit),
        },
    ];
    bound.extend(specular.map(|specular| ("arriving", specular.arriving)));
    for part in builder.parts(0..azimuths, [across, along], each, at_once) {
        let Part { azimuths: few, rows } = &part;
        let (count, height) = (few.len() as u32, rows.len() as u32);
        let grid_points = u64::from(across) * u64::from(height);
        builder.pass(
            shaders::BounceMarch {
                border: scene.surface.border as u32,
                thin_rows,
                thin_cols,
                most_steps: blocks.levels.most_steps() as i32,
                grey: bounce.grey,
                node_stride: nodes.stride as i32,
                order: specular.map_or(0, |specular| specular.order as i32),
                vectors: vectors.is_some(),
            },
            &part.label(&bounce.name, "azimuths", &(0..azimuths), along),
            format!("{}, every visible interval along {count} azimuths", bounce.why),
            shaders::BOUNCE_MARCH.groups([across, height, 1]),
            &shaders::BounceMarchPush {
                land: shaders::LandPush::of(field, &blocks.levels),
                azimuths: azimuths as i32,
                first_azimuth: few.start as i32,
                last_azimuth: few.end as i32,
                first_row: rows.start as i32,
            },
            &bound,
            grid_points * (3 * 16 + 2 * 16 * layers + if bounce.grey { 4 } else { 16 }),
            grid_points * u64::from(count),
        );
    }
}
