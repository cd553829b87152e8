use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::dirty_list;
use crate::passes::specular_tables::{MapLevels, SpecularTables};
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::Lanes;
use crate::scene::Border;

/// What the shading of a batch reads and writes.
pub(crate) struct Images {
    pub lanes: Lanes,
    pub lattice: Option<ResourceId>,
    pub azimuths: ResourceId,
    pub sky_sum: Option<ResourceId>,
    /// The sum, and the tables.
    pub environment: Option<[ResourceId; 2]>,
    /// Phong specular: the light that horizons hide from its specular.
    pub specular: Option<Specular>,
    /// Texels that an edit changes: their mask and their list. Only these are lit.
    pub edited: Option<[ResourceId; 2]>,
}

/// What a Phong lobe about the mirror direction needs.
#[derive(Clone, Copy)]
pub(crate) struct Specular {
    /// Of the first level.
    pub tables: SpecularTables,
    pub levels: MapLevels,
    pub blocked_sum: ResourceId,
    /// The eye over the field's base; the last is 0 for a view from straight above.
    pub eye_m: [f32; 4],
}

/// Light below this share of a lobe's largest value in an azimuth counts as 0.
const LEAST_SHARE: f32 = 1e-4;

/// Cosine to a lobe's axis below which light counts as 0.
pub(crate) fn least_cosine(tables: &SpecularTables) -> f32 {
    let least = LEAST_SHARE * tables.nearest_share;
    least.powf(1.0 / tables.exponent.max(1e-3))
}

/// Light of a uniform sky and of an environment through the horizons of a batch.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    border: Border,
    cell_m: [f64; 2],
    batch: &Batch,
    part: &str,
    images: &Images,
) {
    let axis = batch.axis;
    let mut bound = vec![("lane_heights", images.lanes.read()), ("azimuths", images.azimuths)];
    if let Some(buffer) = images.lanes.buffer {
        bound.extend([("lane_buffer", buffer), ("azimuth_buffer", images.azimuths)]);
    }
    bound.extend(images.lattice.map(|l| (sweep.lattice_binding(), l)));
    bound.extend(images.sky_sum.map(|s| ("sky_sum", s)));
    if let Some([sum, tables]) = images.environment {
        bound.extend([("env_sum", sum), ("env_tables", tables)]);
    }
    let mut push = shaders::ShadePush::of(batch, cell_m);
    if let Some(Specular { tables, levels, blocked_sum, eye_m }) = images.specular {
        bound.extend([("specular_tables", tables.tables), ("blocked_sum", blocked_sum)]);
        push.eye_m = eye_m;
        push.exponent = tables.exponent;
        push.least_cosine = least_cosine(&tables);
        if let Some(map_images) = levels.map_images {
            bound.extend(map_images.bound());
            bound.push(("constants", levels.constants));
            push.first_level = levels.first_texel as i32;
            push.level_count = levels.count as i32;
            push.levels_per_log = levels.per_log;
        }
    }
    if let Some([dirty, list]) = images.edited {
        push.relights = 1;
        bound.extend([("dirty_texels", dirty), ("edit_list", list)]);
    }
    let map_images = images.specular.and_then(|specular| specular.levels.map_images);
    let sums = if images.sky_sum.is_some() { 8 } else { 0 }
        + if images.environment.is_some() { 32 } else { 0 }
        + if images.specular.is_some() { 32 } else { 0 }
        + if map_images.is_some() { 48 } else { 0 };
    let pass = builder.pass(
        shaders::SkyShade {
            layer_shift: batch.layer_shift as i32,
            fuse: sweep.fuse_mode(),
            lattice: sweep.lattice_content(),
            line_shift: sweep.line_shift() as i32,
            border: border as u32,
            has_sky: images.sky_sum.is_some(),
            has_environment: images.environment.is_some(),
            marches_rows: axis.marches_rows,
            has_specular: images.specular.is_some(),
            reads_lane_buffer: images.lanes.buffer.is_some(),
            reads_lane_windows: images.lanes.windows.is_some(),
            specular_is_map: map_images.is_some(),
            specular_is_shared: images.specular.is_some_and(|s| s.tables.is_shared()),
        },
        part,
        match (images.sky_sum, images.environment) {
            (Some(_), Some(_)) => "uniform sky in closed form; environment from its tables",
            (Some(_), None) => "uniform sky in closed form: no table",
            _ => "environment from its tables",
        },
        shaders::SKY_SHADE.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &push,
        &bound,
        axis.texels() * (4 + sums + u64::from(batch.count) * sweep.lattice_bytes()),
        axis.texels() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
    pass.indirect = images.edited.map(|[_, list]| (list, dirty_list::LIGHT_GROUPS_AT));
}
