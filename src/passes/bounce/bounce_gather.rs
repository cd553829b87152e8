use crate::graph::{Builder, MOST_TURNS, Part, ResourceId, shaders};
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounces::Bounce;
use crate::passes::pyramid::Pyramid;
use crate::passes::pyramid_march;
use crate::passes::sweep::warm_up;
use crate::scene::{HeightField, Levels, Receiver};

/// Of this pass and of `specular_gather`.
impl shaders::GatherPush {
    /// Push constants for a part of `azimuths`.
    pub(crate) fn of(field: &HeightField, of: &Pyramids, azimuths: u32, part: &Part) -> Self {
        let [cell_x, cell_y] = field.cell_m();
        let [warm_up_cols, warm_up_rows] =
            of.heights.size.map(|n| if of.heights.periodic { warm_up(n) as i32 } else { 0 });
        Self {
            cols: field.cols() as i32,
            rows: field.rows() as i32,
            cell_x_m: cell_x as f32,
            cell_y_m: cell_y as f32,
            azimuths: azimuths as i32,
            first_azimuth: part.azimuths.start as i32,
            last_azimuth: part.azimuths.end as i32,
            first_row: part.rows.start as i32,
            warm_up_cols,
            warm_up_rows,
            fine_samples: of.heights.fine_samples() as i32,
            width_shift: of.heights.width_shift() as i32,
            growth: of.heights.growth(),
            shade_fine: of.shade.fine_samples() as i32,
            shade_shift: of.shade.width_shift() as i32,
            step_shade: of.shade.level_step as i32,
            step_height: of.heights.level_step as i32,
        }
    }
}

#[derive(Clone, Copy)]
pub(crate) struct ShadeImages {
    pub levels: ResourceId,
    pub table: ResourceId,
    pub stack: Option<ResourceId>,
}

/// The pyramids that a gather reads: heights and exit radiance. No images where there are no levels.
pub(crate) struct Pyramids {
    pub heights: Pyramid,
    pub height_images: Option<pyramid_march::Images>,
    /// Whether this pass must fill them.
    pub fills_heights: bool,
    pub shade: Pyramid,
    pub shade_images: Option<ShadeImages>,
    pub receiver: Receiver,
}

impl Pyramids {
    /// Lookups per node and azimuth: a height and a radiance at every march step. Each takes the 16 texels of a spline, or two of
    /// a stack.
    pub(crate) fn lookups(&self) -> u64 {
        let texels = if self.heights.stored == Levels::Stack { 2 } else { 16 };
        2 * texels * u64::from(self.heights.samples())
    }

    /// Bindings of the height levels.
    pub(crate) fn height_bindings(&self) -> Vec<(&'static str, ResourceId)> {
        self.height_images.map_or_else(Vec::new, |images| images.bindings())
    }

    /// Bindings of the levels of exit radiance.
    pub(crate) fn shade_bindings(&self) -> Vec<(&'static str, ResourceId)> {
        match self.shade_images {
            Some(ShadeImages { stack: Some(stack), .. }) => vec![("shade_stack", stack)],
            Some(ShadeImages { levels, table, stack: None }) => {
                vec![("shade_levels", levels), ("shade_table", table)]
            }
            None => Vec::new(),
        }
    }
}

/// Gathers bounced light at every grid point, or at every node, from pyramids.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    of: &Pyramids,
    azimuths: u32,
    bounce: &Bounce,
    [heights, ground]: [ResourceId; 2],
) {
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let NodeSum { nodes, sum } = bounce.found_at();
    let [across, along] = nodes.size([cols, rows]);
    let is_stack = of.heights.stored == Levels::Stack;
    let mut bound = vec![
        ("heights", heights),
        ("ground", ground),
        ("exit_radiance", bounce.exit),
        ("bounce_sum", sum),
    ];
    bound.extend(of.height_bindings());
    bound.extend(of.shade_bindings());
    // The march, and inside it pyramid samples that round to one distance.
    let at_once = (MOST_TURNS / (2 * of.heights.samples() + 3)).max(1);
    for part in builder.parts(0..azimuths, [across, along], of.lookups(), at_once) {
        let (count, height) = (part.azimuths.len() as u32, part.rows.len() as u32);
        let grid_points = u64::from(across) * u64::from(height);
        // Per azimuth: the height of every pyramid sample, and at most as many radiances.
        let march_samples = u64::from(of.heights.samples()) * u64::from(count);
        builder.pass(
            shaders::BounceGather {
                periodic: of.heights.periodic,
                stack: is_stack,
                levels: of.heights.levels() as i32,
                shade_levels: of.shade.levels() as i32,
                grey: bounce.grey,
                is_plane: of.receiver == Receiver::Plane,
                node_stride: nodes.stride as i32,
            },
            &part.label(&bounce.name, "azimuths", &(0..azimuths), along),
            format!(
                "{} along {count} azimuths, {} samples each, {}",
                bounce.why,
                of.heights.samples(),
                match of.receiver {
                    Receiver::Plane => "the cosine exact",
                    Receiver::Cosine => "in Legendre coefficients and three bands of the cosine",
                }
            ),
            shaders::BOUNCE_GATHER.groups([across, height, 1]),
            &shaders::GatherPush::of(field, of, azimuths, &part),
            &bound,
            grid_points * (2 * 16 + march_samples * (4 + 16)),
            grid_points * u64::from(count),
        );
    }
}
