use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::PhongSource;
use crate::passes::bounced_specular::{BouncedSpecular, ExitLight, Vectors};

/// The light that leaves a surface.
pub(crate) struct ExitRadiance {
    /// As in labels: "direct", "bounce1".
    pub name: String,
    /// How often it was reflected before it arrived: 0 is direct light.
    pub bounce: usize,
    /// Its diffuse part; none after the last bounce.
    pub diffuse: Option<ResourceId>,
    /// Specular reflection of direct light.
    pub specular_direct: ResourceId,
    /// The eye over the field's base; the last number is 0 for a view from straight above.
    pub eye_m: [f32; 4],
}

/// Specular reflection of incoming light.
pub(crate) fn plan(
    builder: &mut Builder,
    ([cols, rows], cell_m): ([u32; 2], [f64; 2]),
    (specular, phong): (&BouncedSpecular, PhongSource),
    ground: ResourceId,
    outgoing: &ExitRadiance,
) {
    let grid_points = u64::from(cols) * u64::from(rows);
    let is_direct = outgoing.bounce == 0;
    let is_bounced = outgoing.diffuse.is_some();
    let vectors = match specular.outgoing {
        ExitLight::Vectors(vectors) if is_bounced => Some(vectors),
        _ => None,
    };
    let has_vectors = matches!(specular.outgoing, ExitLight::Vectors(_));
    let mut bound = vec![("ground", ground)];
    if has_vectors || !is_direct {
        bound.push(("arriving", specular.arriving));
    }
    if is_direct {
        bound.push(("specular_direct", outgoing.specular_direct));
    } else {
        bound.push(("specular_bounced", specular.bounced));
    }
    bound.extend(outgoing.diffuse.map(|diffuse| ("exit_radiance", diffuse)));
    bound.extend(phong.map.map(|map| ("phong_map", map)));
    match (specular.outgoing, vectors) {
        (_, Some(Vectors { exit, constants, halves, .. })) => {
            let name = if halves { "exit_vectors_f16" } else { "exit_vectors" };
            bound.extend([("constants", constants), (name, exit)]);
        }
        (ExitLight::Upward(exit), _) if is_bounced => {
            bound.push((if specular.grey { "exit_upward_grey" } else { "exit_upward" }, exit));
        }
        _ => {}
    }
    let why = match (is_bounced, has_vectors) {
        (true, true) => "exit radiance by direction: diffuse, and specular about the normal",
        (true, false) => "exit radiance towards the zenith: diffuse and specular",
        (false, _) => "specular reflection towards the view",
    };
    let layers = u64::from(specular.layers());
    let written = vectors.map_or(16, |_| specular.texel_bytes() * layers);
    builder.pass(
        shaders::SpecularExit {
            order: specular.order as i32,
            grey: specular.grey,
            specular_is_map: phong.map.is_some(),
            is_direct,
            is_bounced,
            vectors: has_vectors,
            halves: vectors.is_some_and(|v| v.halves),
        },
        &outgoing.name,
        why,
        shaders::SPECULAR_EXIT.groups([cols, rows, 1]),
        &shaders::SpecularExitPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            eye_m: outgoing.eye_m,
            begins: u32::from(outgoing.bounce == 1),
            first_texel: vectors.map_or(0, |v| v.first_texel as i32),
            fours: vectors.map_or(0, |v| v.fours as i32),
            exponent: phong.constant.exponent,
            scale: phong.constant.scale,
        },
        &bound,
        grid_points * (3 * 16 + 16 * layers + written),
        grid_points,
    );
}
