use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

use crate::graph::{Builder, MOST_TURNS, Part, Rectangle, ResourceId, shaders};
use crate::passes::blocks::Blocks;
use crate::passes::sphere_shading::{SphereShading, beyond, place_of, rows_of, texels_within};
use crate::scene::{Scene, SphereLight};

/// Light of one sphere light.
pub(crate) fn plan(
    builder: &mut Builder,
    scene: &Scene,
    blocks: &Blocks,
    name: &str,
    light: &SphereLight,
    shading: &SphereShading,
    sum: ResourceId,
) {
    let [narrow, around] = shading.counts(light, &scene.field);
    let at_once = (MOST_TURNS / (blocks.levels.most_steps() + 1)).max(1);
    let size = [scene.field.cols(), scene.field.rows()].map(|n| n as u32);
    let each = blocks.levels.lookups();
    // Beyond this distance a light subtends fewer slices.
    let within = |slice: u32| {
        let half_width = PI * f64::from(slice) / f64::from(around);
        1.001 * light.radius_m / half_width.min(FRAC_PI_2).sin()
    };
    // Cuts as many texels as there may be, not the rectangle: then the passes are the same wherever the light is.
    let all = u64::from(size[0]) * u64::from(size[1]) * u64::from(around) * each;
    let parts = if all <= builder.lookups {
        builder.parts(0..around, size, each, at_once)
    } else {
        let [cell_x, cell_y] = scene.field.cell_m();
        let side = |cell: f64, count: u32| {
            (2.0 * within(narrow) / cell).ceil().min(f64::from(count - 1)) as u32 + 1
        };
        let near = [side(cell_x, size[0]), side(cell_y, size[1])];
        let mut parts = builder.parts(0..narrow.min(around), size, each, at_once);
        parts.extend(builder.parts(narrow.min(around)..around, near, each, at_once));
        parts
    };
    for part in parts {
        let label = part.label(name, "slices", &(0..around), size[1]);
        let Part { azimuths: slices, rows } = part;
        let mut lit = Some(shading.rectangle);
        if slices.start >= narrow {
            let near = texels_within(&scene.field, light, within(slices.start));
            lit = near.and_then(|near| common(near, shading.rectangle));
        }
        let rectangle = lit.and_then(|lit| rows_of(lit, &rows)).unwrap_or(beyond(size));
        let shading = SphereShading { rectangle, ..*shading };
        dispatch(builder, scene, blocks, &label, light, &shading, slices, sum);
    }
}

/// The intersection, if there is any.
fn common(a: Rectangle, b: Rectangle) -> Option<Rectangle> {
    let along = |[a, n]: [u32; 2], [b, m]: [u32; 2]| {
        let [first, end] = [a.max(b), (a + n).min(b + m)];
        (first < end).then(|| [first, end - first])
    };
    let [col, cols] = along([a.col, a.cols], [b.col, b.cols])?;
    let [row, rows] = along([a.row, a.rows], [b.row, b.rows])?;
    Some(Rectangle { col, row, cols, rows })
}

#[expect(clippy::too_many_arguments, reason = "a pass is its inputs")]
fn dispatch(
    builder: &mut Builder,
    scene: &Scene,
    blocks: &Blocks,
    part: &str,
    light: &SphereLight,
    shading: &SphereShading,
    slices: Range<u32>,
    sum: ResourceId,
) {
    let field = &scene.field;
    let [narrow, around] = shading.counts(light, field);
    let (base, offset) = place_of(field, light);
    let Rectangle { col, row, cols, rows } = shading.rectangle;
    let grid_points = u64::from(cols) * u64::from(rows);
    let [thin_rows, thin_cols] = blocks.thin(field);
    let [cells, maxima] = blocks.of_rays();
    let [r, g, b] = light.radiance;
    let begins = shading.begins && slices.start == 0;
    let specular = shading.specular;
    let specular_begins = specular.is_some_and(|s| s.begins) && slices.start == 0;
    let phong = specular.map(|s| s.phong.constant);
    let mut bound =
        vec![("cells", cells), ("maxima", maxima), ("ground", blocks.ground), ("sphere_sum", sum)];
    bound.extend(specular.map(|s| ("specular_sum", s.specular_sum)));
    bound.extend(specular.and_then(|s| s.phong.map).map(|map| ("phong_map", map)));
    let outgoing = specular.and_then(|s| s.outgoing);
    bound.extend(outgoing.map(|outgoing| ("arriving", outgoing.arriving)));
    let layers = outgoing.map_or(0, |outgoing| u64::from(outgoing.layers()));
    builder.pass(
        shaders::SphereShade {
            border: scene.surface.border as u32,
            thin_rows,
            thin_cols,
            most_steps: blocks.levels.most_steps() as i32,
            has_specular: specular.is_some(),
            specular_is_map: specular.is_some_and(|s| s.phong.map.is_some()),
            order: outgoing.map_or(0, |outgoing| outgoing.order) as i32,
            grey: outgoing.is_some_and(|outgoing| outgoing.grey),
        },
        part,
        shading.why,
        shaders::SPHERE_SHADE.groups([cols, rows, 1]),
        &shaders::SphereShadePush {
            land: shaders::LandPush::of(field, &blocks.levels),
            first: [col as i32, row as i32],
            base,
            offset,
            up_m: (light.position_m[2] - field.base_m()) as f32,
            radius_m: light.radius_m as f32,
            reach_m: shading.reach_m,
            slices: narrow as i32,
            slices_around: around as i32,
            first_slice: slices.start as i32,
            last_slice: slices.end as i32,
            exponent: phong.map_or(0.0, |phong| phong.exponent),
            scale: phong.map_or(0.0, |phong| phong.scale),
            specular_begins: f32::from(u8::from(specular_begins)),
            radiance: [r, g, b, f32::from(u8::from(begins))],
            eye_m: specular.map_or([0.0; 4], |s| s.eye_m),
        },
        &bound,
        grid_points * 16 * (2 * layers + if specular.is_some() { 5 } else { 3 }),
        grid_points * slices.len() as u64,
    );
}
