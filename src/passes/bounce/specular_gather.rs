use crate::graph::{Builder, MOST_TURNS, ResourceId, shaders};
use crate::passes::bounce_gather::Pyramids;
use crate::passes::bounced_specular::{BouncedSpecular, ExitLight, Vectors};
use crate::passes::bounces::Bounce;
use crate::scene::{HeightField, Levels};

/// Gathers bounced light from pyramids at every texel, for diffuse and for specular reflection.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    (of, specular): (&Pyramids, &BouncedSpecular),
    azimuths: u32,
    bounce: &Bounce,
    [heights, ground]: [ResourceId; 2],
) {
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let mut bound = vec![
        ("heights", heights),
        ("ground", ground),
        ("bounce_sum", bounce.sum),
        ("arriving", specular.arriving),
    ];
    bound.extend(of.height_bindings());
    match specular.outgoing {
        ExitLight::Vectors(Vectors { exit, levels, .. }) => {
            bound.push(("exit_vectors", exit));
            let of_levels =
                levels.into_iter().flat_map(|[l, t]| [("vector_levels", l), ("shade_table", t)]);
            bound.extend(of_levels);
        }
        ExitLight::Upward(exit) => {
            bound.push(("exit_radiance", exit));
            bound.extend(of.shade_bindings());
        }
    }
    let has_vectors = matches!(specular.outgoing, ExitLight::Vectors(_));
    // The march, and inside it pyramid samples that round to one distance; then for each visible one, and for
    // the end, the sums over its coefficients.
    let march_samples = of.heights.samples();
    // Beyond the last distance less than an octave more rounds to it, and two knots end the spline.
    let knots = march_samples + of.heights.level_step + 2;
    let layers = specular.layers();
    let of_each = specular.order * specular.order + if has_vectors { layers + layers } else { 0 };
    let turns = 3 * knots + 1 + (knots + 1) * of_each;
    let at_once = ((MOST_TURNS - 8 * layers) / turns).max(1);
    // Four texels of every layer at each march step.
    let vectors = if has_vectors { u64::from(4 * layers * march_samples) } else { 0 };
    for part in builder.parts(0..azimuths, [cols, rows], of.lookups() + vectors, at_once) {
        let (count, height) = (part.azimuths.len() as u32, part.rows.len() as u32);
        let grid_points = u64::from(cols) * u64::from(height);
        let rays = u64::from(march_samples) * u64::from(count);
        let ray_bytes =
            if has_vectors { 4 * specular.texel_bytes() * u64::from(layers) } else { 16 };
        builder.pass(
            shaders::SpecularGather {
                periodic: of.heights.periodic,
                stack: of.heights.stored == Levels::Stack,
                levels: of.heights.levels() as i32,
                shade_levels: of.shade.levels() as i32,
                grey: bounce.grey,
                vectors: has_vectors,
                order: specular.order as i32,
                most_knots: knots as i32,
            },
            &part.label(&bounce.name, "azimuths", &(0..azimuths), rows),
            format!(
                "{} along {count} azimuths, {march_samples} samples each, {}; also as a series",
                bounce.why,
                if has_vectors {
                    "radiance towards the texel"
                } else {
                    "radiance towards the zenith"
                }
            ),
            shaders::SPECULAR_GATHER.groups([cols, height, 1]),
            &shaders::GatherPush::of(field, of, azimuths, &part),
            &bound,
            grid_points * (2 * 16 + 2 * 16 * u64::from(layers) + rays * (4 + ray_bytes)),
            grid_points * u64::from(count),
        );
    }
}
