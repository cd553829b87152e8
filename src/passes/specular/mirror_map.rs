use super::specular_tables::SpecularTables;
use crate::graph::{Builder, ResourceId, shaders};

/// A slice in which the lobe reaches less than this share of its largest one counts as dark.
const LEAST_SHARE: f32 = 1e-7;

/// Fills a map from the whole slices of tables, of `count` azimuths.
pub(crate) fn plan(
    builder: &mut Builder,
    tables: &SpecularTables,
    (part, why): (&str, &str),
    count: u32,
    ([azimuths, map], is_swept): ([ResourceId; 2], bool),
    [width, height]: [u32; 2],
) {
    let texels = u64::from(width) * u64::from(height);
    let pass = builder.pass(
        shaders::MirrorMap {},
        part,
        why,
        [width.div_ceil(8), height.div_ceil(8), 1],
        &shaders::MirrorMapPush {
            width: width as i32,
            height: height as i32,
            azimuth_count: count as i32,
            node: (tables.nodes - 1) as i32,
            first_rad: tables.first_rad(),
            per_rad: (tables.peaks - 1) as f32 / tables.range_rad(),
            exponent: tables.exponent,
            least: LEAST_SHARE * tables.nearest_share,
        },
        &[("azimuths", azimuths), ("specular_tables", tables.tables), ("mirror_map", map)],
        texels * 16 + u64::from(count) * u64::from(tables.peaks) * 16,
        texels,
    );
    if is_swept {
        pass.azimuths = 0..count;
    }
}
