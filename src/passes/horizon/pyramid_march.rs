use crate::graph::{Builder, Part, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::nodes::Nodes;
use crate::passes::pyramid::Pyramid;
use crate::scene::Levels;

/// Output of a pyramid's passes; nothing where every sample reads the field itself.
#[derive(Clone, Copy)]
pub(crate) struct Images {
    pub levels: ResourceId,
    pub table: ResourceId,
    pub stack: Option<ResourceId>,
}

impl Images {
    pub(crate) fn bindings(&self) -> Vec<(&'static str, ResourceId)> {
        match self.stack {
            Some(stack) => vec![("height_stack", stack)],
            None => vec![("height_levels", self.levels), ("level_table", self.table)],
        }
    }
}

/// Horizons from the levels, one sample per level.
pub(crate) fn plan(
    builder: &mut Builder,
    (pyramid, nodes): (&Pyramid, Nodes),
    batch: &Batch,
    part: &str,
    [heights, azimuths, slopes]: [ResourceId; 3],
    images: Option<&Images>,
) {
    let axis = batch.axis;
    let mut bound = vec![("heights", heights), ("azimuths", azimuths), ("slopes", slopes)];
    bound.extend(images.into_iter().flat_map(Images::bindings));
    let is_stack = pyramid.stored == Levels::Stack;
    // An own height at every level, once; then one per level and azimuth.
    let (own, far) = if is_stack { (1, 2) } else { (16, 16) };
    let fine = pyramid.fine_samples().min(pyramid.samples());
    let march_samples = u64::from(2 * fine + far * pyramid.levels());
    let own = u64::from(1 + own * pyramid.levels());
    let [lanes, steps] = nodes.size([axis.lanes, axis.steps]);
    let all = batch.azimuths();
    let each = march_samples + own / u64::from(batch.count);
    for cut in builder.parts(all.clone(), [lanes, steps], each, u32::MAX) {
        let Part { azimuths: few, rows } = &cut;
        let (count, height) = (few.len() as u32, rows.len() as u32);
        let places = u64::from(lanes) * u64::from(height);
        let horizons = places * u64::from(count);
        let pass = builder.pass(
            shaders::PyramidMarch {
                periodic: pyramid.periodic,
                stack: is_stack,
                levels: pyramid.levels() as i32,
                node_stride: nodes.stride as i32,
            },
            &cut.label(part, "azimuths", &all, steps),
            format!("horizons of {count} azimuths, {} samples each", pyramid.samples()),
            shaders::PYRAMID_MARCH.groups([lanes, height, 1]),
            &shaders::PyramidMarchPush {
                lanes: axis.lanes as i32,
                steps: axis.steps as i32,
                warm_up: axis.warm_up as i32,
                first_azimuth: few.start,
                azimuth_count: count,
                first_row: rows.start as i32,
                fine_samples: pyramid.fine_samples() as i32,
                width_shift: pyramid.width_shift() as i32,
                growth: pyramid.growth(),
            },
            &bound,
            4 * (horizons * (1 + march_samples) + places * own),
            horizons,
        );
        pass.azimuths = few.clone();
    }
}
