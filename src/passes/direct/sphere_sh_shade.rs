use std::ops::Range;

use crate::graph::{Builder, MOST_TURNS, Part, Rectangle, ResourceId, shaders};
use crate::passes::blocks::Blocks;
use crate::passes::sphere_sh::SphereSh;
use crate::passes::sphere_shading::{SphereShading, beyond, place_of, rows_of};
use crate::scene::{Border, HeightField, Levels, Receiver, Scene, SphereLight, Wedges};
use crate::{Error, Result};

/// As in `within.glsl`.
pub(crate) const WITHIN_CELLS: u32 = 8192;

/// Light of one sphere light.
pub(crate) fn plan(
    builder: &mut Builder,
    (scene, blocks, soft): (&Scene, &Blocks, &SphereSh),
    heights: ResourceId,
    name: &str,
    light: &SphereLight,
    shading: &SphereShading,
    sum: ResourceId,
) {
    // A wedge of a table needs a ray at both of its ends.
    let more = u32::from(soft.wedges == Wedges::Table);
    let at_once =
        (MOST_TURNS / (most_turns(scene.surface.border, &scene.field, soft) + 1)).max(1 + more);
    let at_once = at_once - more;
    let size = [scene.field.cols(), scene.field.rows()].map(|n| n as u32);
    let all = 0..soft.azimuths;
    // Cuts the whole field, not the rectangle: then the passes are the same wherever the light is.
    for part in builder.parts(all.clone(), size, lookups(blocks, soft), at_once) {
        let label = part.label(name, "azimuths", &all, size[1]);
        let Part { azimuths, rows } = part;
        let rectangle = rows_of(shading.rectangle, &rows).unwrap_or(beyond(size));
        let shading = SphereShading { rectangle, ..*shading };
        dispatch(
            builder,
            (scene, blocks, soft),
            heights,
            (&label, &azimuths),
            light,
            &shading,
            sum,
        );
    }
}

/// Lookups per grid point and azimuth. A wedge of a table has a ray at both of its ends, as a part's last one does.
fn lookups(blocks: &Blocks, soft: &SphereSh) -> u64 {
    let rays = if soft.wedges == Wedges::Table { 2 } else { 1 };
    rays * match &soft.pyramid {
        Some((pyramid, _)) if pyramid.stored == Levels::Stack => 2 * u64::from(pyramid.samples()),
        Some((pyramid, _)) => 16 * u64::from(pyramid.samples()),
        None => blocks.levels.lookups(),
    }
}

/// Largest number of loop iterations per azimuth.
fn most_turns(border: Border, field: &HeightField, soft: &SphereSh) -> u32 {
    match &soft.pyramid {
        // A spline adds four rows at each texel.
        Some((pyramid, _)) => 5 * pyramid.samples() + 2,
        None => most_steps(border, field),
    }
}

/// As [`Blocks::most_steps`], for a ray that ends sooner where the field repeats.
fn most_steps(border: Border, field: &HeightField) -> u32 {
    let longest = field.cols().max(field.rows()) as u32;
    3 * if border == Border::Periodic { WITHIN_CELLS } else { longest } + 64
}

/// Refuses fields on which two rays of a wedge exceed the loop limit of some devices.
///
/// # Errors
/// More grid points per side than that.
pub(crate) fn check(border: Border, field: &HeightField, soft: &SphereSh) -> Result<()> {
    if soft.wedges == Wedges::Table && 2 * (most_turns(border, field, soft) + 1) > MOST_TURNS {
        let longest = field.cols().max(field.rows());
        return Err(Error::setting(
            "`wedges table` with `light_basis sh`",
            format!("a field of {longest} grid points per side"),
            "10,000 per side at most, `wedges slices` or `method pyramid`",
        ));
    }
    Ok(())
}

fn dispatch(
    builder: &mut Builder,
    (scene, blocks, soft): (&Scene, &Blocks, &SphereSh),
    heights: ResourceId,
    (part, azimuths): (&str, &Range<u32>),
    light: &SphereLight,
    shading: &SphereShading,
    sum: ResourceId,
) {
    let field = &scene.field;
    let (base, offset) = place_of(field, light);
    let Rectangle { col, row, cols, rows } = shading.rectangle;
    let grid_points = u64::from(cols) * u64::from(rows);
    let [thin_rows, thin_cols] = blocks.thin(field);
    let [r, g, b] = light.radiance;
    let begins = shading.begins && azimuths.start == 0;
    let mut bound =
        vec![("ground", blocks.ground), ("sphere_sum", sum), ("constants", soft.constants)];
    let levels = match &soft.pyramid {
        None => {
            let [cells, maxima] = blocks.of_rays();
            bound.extend([("cells", cells), ("maxima", maxima)]);
            None
        }
        Some((pyramid, images)) => {
            bound.push(("heights", heights));
            match images {
                Some(images) if pyramid.stored == Levels::Stack => {
                    bound.extend(images.stack.map(|stack| ("height_stack", stack)));
                }
                Some(images) => {
                    bound.extend([("height_levels", images.levels), ("level_table", images.table)]);
                }
                None => {}
            }
            Some(pyramid)
        }
    };
    builder.pass(
        shaders::SphereShShade {
            border: scene.surface.border as u32,
            thin_rows,
            thin_cols,
            most_steps: most_steps(scene.surface.border, field) as i32,
            order: soft.order as i32,
            wedges: soft.wedges as u32,
            own_plane_hides: soft.receiver == Receiver::Plane,
            by_pyramid: levels.is_some(),
            stack: levels.is_some_and(|p| p.stored == Levels::Stack),
            levels: levels.map_or(0, |p| p.levels()) as i32,
        },
        part,
        match soft.wedges {
            Wedges::Table => {
                "the sphere light times the visibility up to it, from a table of wedges"
            }
            Wedges::Slices | Wedges::Nlp => {
                "the sphere light times the visibility across and up to it"
            }
        },
        shaders::SPHERE_SH_SHADE.groups([cols, rows, 1]),
        &shaders::SphereShShadePush {
            land: shaders::LandPush::of(field, &blocks.levels),
            first: [col as i32, row as i32],
            base,
            offset,
            up_m: (light.position_m[2] - field.base_m()) as f32,
            radius_m: light.radius_m as f32,
            reach_m: shading.reach_m,
            azimuths: soft.azimuths as i32,
            first_azimuth: azimuths.start as i32,
            last_azimuth: azimuths.end as i32,
            entry_first: soft.entry_first as i32,
            entry_count: soft.entry_count as i32,
            table_first: soft.table_first as i32,
            side: soft.side as i32,
            fine_samples: levels.map_or(1, |p| p.fine_samples() as i32),
            width_shift: levels.map_or(0, |p| p.width_shift() as i32),
            growth: levels.map_or(1.0, |p| p.growth()),
            level_step: levels.map_or(1.0, |p| p.level_step as f32),
            radiance: [r, g, b, f32::from(u8::from(begins))],
        },
        &bound,
        grid_points * (3 * 16),
        grid_points * azimuths.len() as u64,
    );
}
