use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::passes::PhongSource;
use crate::passes::bounced_specular::BouncedSpecular;
use crate::scene::{Border, Specular, Sun};

/// Specular reflection of a sun, scaled by the visible part that diffuse shading found. `begins`: the sum
/// begins with it.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    name: &str,
    (sun, phong, eye_m): (&Sun, PhongSource, [f32; 4]),
    ([lane_heights, sun_sum, specular_sum], light_vector): ([ResourceId; 3], Option<ResourceId>),
    (begins, outgoing): (bool, Option<BouncedSpecular>),
) {
    let [cols, rows] = axis.size();
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    let [east, north, up] = [cos * along, sin * along, up].map(|v| v as f32);
    let radius = if sun.is_point() { 0.0 } else { 0.5 * sun.diameter_rad };
    // 1 - cos without its cancellation.
    let depth = 2.0 * (0.5 * radius).sin().powi(2);
    let [r, g, b] = sun.irradiance;
    let mut bound =
        vec![("lane_heights", lane_heights), ("sun_sum", sun_sum), ("specular_sum", specular_sum)];
    bound.extend(light_vector.map(|vector| ("light_vector", vector)));
    bound.extend(phong.map.map(|map| ("phong_map", map)));
    bound.extend(outgoing.map(|specular| ("arriving", specular.arriving)));
    let layers = outgoing.map_or(0, |specular| specular.layers());
    builder.pass(
        shaders::SunSpecular {
            border: border as u32,
            marches_rows: axis.marches_rows,
            specular_is_map: phong.map.is_some(),
            order: outgoing.map_or(0, |specular| specular.order) as i32,
            grey: outgoing.is_some_and(|specular| specular.grey),
            has_vector: light_vector.is_some(),
        },
        name,
        match light_vector {
            Some(_) => {
                "the mean of the Phong lobe over the visible part of the sun, times its share"
            }
            None => "the mean of the Phong lobe over the sun's disc, times its visible part",
        },
        shaders::SUN_SPECULAR.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::SunSpecularPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            towards: [east, north, up, (radius * radius) as f32],
            level: [-sin as f32, cos as f32, 0.0, depth as f32],
            colour: [r, g, b, f32::from(u8::from(begins))],
            eye_m,
            specular: [phong.constant.exponent, phong.constant.scale],
        },
        &bound,
        axis.texels() * (4 + 4 + 2 * 16 * (1 + u64::from(layers))),
        axis.texels(),
    );
}

/// Whether the lobe varies enough over the sun that it matters which part is visible: n r² > 0.01. Without the light vector the
/// error on steep ground is about 3 % at exponent 20 under a sun 5° wide, 20° high, and 0.03 % at exponent 100 under one 1° wide.
pub(crate) fn needs_vector(specular: &Specular, sun: &Sun) -> bool {
    let radius = 0.5 * sun.diameter_rad;
    !sun.is_point() && f64::from(specular.largest().exponent) * radius * radius > 0.01
}

/// The exponent to which a sun widens the lobes of a surface, where it widens any: 48 over its radius squared, as the
/// shader's rings need.
pub(crate) fn widened(specular: &Specular, sun: &Sun) -> Option<f64> {
    let radius = 0.5 * sun.diameter_rad;
    let widest = 48.0 / (radius * radius);
    (!sun.is_point() && f64::from(specular.largest().exponent) > widest).then_some(widest)
}
