use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::PhongSource;
use crate::passes::azimuths::Shape;
use crate::passes::batch::Batch;
use crate::passes::dirty_list;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::Lanes;
use crate::scene::Border;

/// Phong specular of a key light.
#[derive(Clone, Copy)]
pub(crate) struct KeySpecular {
    pub phong: PhongSource,
    pub radiance: [f32; 3],
    /// The eye over the field's base; the last number is 0 for a view from straight above.
    pub eye_m: [f32; 4],
    pub specular_sum: ResourceId,
    /// Whether the sum begins with it.
    pub begins: bool,
}

/// Light of one sun or key light through the horizons of its azimuths.
#[expect(clippy::too_many_arguments, reason = "a pass is its inputs")]
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    border: Border,
    cell_m: [f64; 2],
    batch: &Batch,
    part: &str,
    lanes: Lanes,
    shape: Shape,
    lattice: Option<ResourceId>,
    ([azimuths, sun_sum], light_vector): ([ResourceId; 2], Option<ResourceId>),
    specular: Option<KeySpecular>,
    edited: Option<[ResourceId; 2]>,
) {
    let axis = batch.axis;
    let mut bound =
        vec![("lane_heights", lanes.read()), ("azimuths", azimuths), ("sun_sum", sun_sum)];
    bound.extend(lattice.map(|l| (sweep.lattice_binding(), l)));
    bound.extend(light_vector.map(|vector| ("light_vector", vector)));
    let mut push = shaders::ShadePush::of(batch, cell_m);
    if let Some(KeySpecular { phong, radiance, eye_m, specular_sum, begins }) = specular {
        bound.push(("specular_sum", specular_sum));
        bound.extend(phong.map.map(|map| ("phong_map", map)));
        // A map has its own scales.
        let scale = if phong.map.is_some() { 1.0 } else { phong.constant.scale };
        let [r, g, b] = radiance.map(|channel| channel * scale);
        push.colour = [r, g, b, f32::from(u8::from(begins))];
        push.eye_m = eye_m;
        push.exponent = phong.constant.exponent;
    }
    if let Some([dirty, list]) = edited {
        push.relights = 1;
        bound.extend([("dirty_texels", dirty), ("edit_list", list)]);
    }
    let pass = builder.pass(
        shaders::SunShade {
            layer_shift: batch.layer_shift as i32,
            fuse: sweep.fuse_mode(),
            lattice: sweep.lattice_content(),
            line_shift: sweep.line_shift() as i32,
            border: border as u32,
            shape: shape as u32,
            marches_rows: axis.marches_rows,
            reads_lane_windows: lanes.windows.is_some(),
            has_specular: specular.is_some(),
            specular_is_map: specular.is_some_and(|s| s.phong.map.is_some()),
            has_vector: light_vector.is_some(),
        },
        part,
        match shape {
            Shape::Patch if specular.is_some() => {
                "the part of its elevations above the horizon, diffuse and in a slice of the lobe"
            }
            Shape::Disc => "the part of each chord of the disc above the horizon",
            Shape::Point => "a point: lit or not",
            Shape::Patch => "the part of its elevations above the horizon",
        },
        shaders::SUN_SHADE.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &push,
        &bound,
        axis.texels()
            * (12
                + if specular.is_some() { 2 * 16 } else { 0 }
                + if light_vector.is_some() { 16 } else { 0 }
                + u64::from(batch.count) * sweep.lattice_bytes()),
        axis.texels() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
    pass.indirect = edited.map(|[_, list]| (list, dirty_list::LIGHT_GROUPS_AT));
}
