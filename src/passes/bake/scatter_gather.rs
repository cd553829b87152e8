use std::ops::Range;

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Albedo, Curvature, HeightField, PhongSpecular, Specular, VisiblePoints};

/// Where the light of visible points comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    None,
    Direct,
    Carried,
}

/// Inputs that are equal in all steps.
pub(crate) struct Steps<'a> {
    pub field: &'a HeightField,
    pub albedo: &'a Albedo,
    /// None where the surface has no specular reflection.
    pub specular: Option<&'a Specular>,
    /// Suns that the specular reflection mirrors.
    pub suns: usize,
    /// First texel of the first path's first step, of the first sun, and of the first view.
    pub texels: [usize; 3],
    /// Steps of a path.
    pub count: u32,
    /// Paths that the output already holds.
    pub first_path: u32,
    /// Solid angle of all directions, sr.
    pub weight_sr: f64,
    /// Views that the last step scatters towards, one layer each.
    pub views: u32,
    /// Whether views include the specular reflection of the lights at the grid point itself.
    pub direct_specular: bool,
    pub curvature: Curvature,
}

/// Step `step` of some paths. They read one image of visible points, whose first direction is
/// `first_direction`.
pub(crate) fn plan(
    builder: &mut Builder,
    steps: &Steps,
    (step, paths, source): (u32, Range<u32>, Source),
    first_direction: u32,
    bound: &[(&str, ResourceId)],
) {
    let field = steps.field;
    let [cols, rows] = [field.cols() as u32, field.rows() as u32];
    let count = paths.end - paths.start;
    let sums = step == 0;
    let (albedo, is_map) = match *steps.albedo {
        Albedo::Constant([r, g, b]) => ([r, g, b, 1.0], false),
        Albedo::Map(_) => ([0.0; 4], true),
    };
    let specular = match steps.specular {
        Some(Specular::Constant(phong)) => *phong,
        _ => PhongSpecular { exponent: 0.0, scale: 0.0 },
    };
    let is_small = VisiblePoints::is_small(field.rows(), field.cols());
    let part = match sums {
        true => format!("paths {}..{}", paths.start, paths.end),
        false => format!("paths {}..{} step {step}", paths.start, paths.end),
    };
    let why = match sums {
        true if steps.views > 1 => {
            "the light of visible points along its paths, scattered towards each view"
        }
        true => "the light of visible points along its paths, scattered",
        false => "the radiance that leaves back along its paths",
    };
    let views = if sums { steps.views } else { 1 };
    let rays = u64::from(cols) * u64::from(rows) * u64::from(count) * u64::from(views);
    builder.pass(
        shaders::ScatterGather {
            source: source as u32,
            sums,
            small: is_small,
            albedo_is_map: is_map,
            has_specular: steps.specular.is_some(),
            specular_is_map: matches!(steps.specular, Some(Specular::Map(_))),
            bent: steps.curvature != Curvature::FLAT,
            direct_specular: sums && steps.direct_specular,
        },
        &part,
        why,
        shaders::SCATTER_GATHER.groups([cols, rows, if sums { views } else { count }]),
        &shaders::ScatterGatherPush {
            cols: cols as i32,
            rows: rows as i32,
            first_link: steps.texels[0] as i32 + (2 * paths.start * steps.count) as i32,
            steps: steps.count as i32,
            step: step as i32,
            first_path: (steps.first_path + paths.start) as i32,
            paths: count as i32,
            first_direction: first_direction as i32,
            first_sun: steps.texels[1] as i32,
            suns: steps.suns as i32,
            weight_sr: steps.weight_sr as f32,
            exponent: specular.exponent,
            specular_scale: specular.scale,
            first_view: steps.texels[2] as i32,
            curvature_x: steps.curvature.per_m[0] as f32,
            curvature_y: steps.curvature.per_m[1] as f32,
            albedo,
        },
        bound,
        rays * (4 + 16 + 16 + 16),
        rays,
    );
}

/// No light, where nothing is scattered.
pub(crate) fn plan_nothing(
    builder: &mut Builder,
    field: &HeightField,
    (scattered, views): (ResourceId, u32),
) {
    let [cols, rows] = [field.cols() as u32, field.rows() as u32];
    let grid_points = u64::from(cols) * u64::from(rows);
    builder.pass(
        shaders::ScatterGather { source: Source::None as u32, sums: true, ..Default::default() },
        "nothing",
        "no light: nothing is scattered",
        shaders::SCATTER_GATHER.groups([cols, rows, views]),
        &shaders::ScatterGatherPush {
            cols: cols as i32,
            rows: rows as i32,
            ..bytemuck::Zeroable::zeroed()
        },
        &[("scattered", scattered)],
        16 * grid_points * u64::from(views),
        grid_points * u64::from(views),
    );
}
