use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Builder, ResourceId};
use crate::passes::Lobes;
use crate::passes::glossy::{BouncedLight, Glossy, Vectors};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SpecularExitPush {
    cols: i32,
    rows: i32,
    begins: u32,
    first_texel: i32,
    fours: i32,
    exponent: f32,
    scale: f32,
}

same_layout!(
    SpecularExitPush,
    specular_exit_push,
    cols = COLS,
    rows = ROWS,
    begins = BEGINS,
    first_texel = FIRST_TEXEL,
    fours = FOURS,
    exponent = EXPONENT,
    scale = SCALE,
);

/// The light that leaves a surface.
pub(crate) struct ExitRadiance {
    /// As in labels: "direct", "bounce1".
    pub name: String,
    /// How often it has been reflected before it arrived: 0 is direct light.
    pub bounce: usize,
    /// What of it is diffuse; none where it is not thrown on.
    pub diffuse: Option<ResourceId>,
    /// What the lobes make of direct light.
    pub gloss_direct: ResourceId,
}

/// What the lobes make of what arrives.
pub(crate) fn plan(
    builder: &mut Builder,
    [cols, rows]: [u32; 2],
    (glossy, lobes): (&Glossy, Lobes),
    ground: ResourceId,
    leaving: &ExitRadiance,
) {
    let samples = u64::from(cols) * u64::from(rows);
    let is_direct = leaving.bounce == 0;
    let throws = leaving.diffuse.is_some();
    let vectors = match glossy.outgoing {
        BouncedLight::Vectors(vectors) if throws => Some(vectors),
        _ => None,
    };
    let has_vectors = matches!(glossy.outgoing, BouncedLight::Vectors(_));
    let mut bound = vec![("ground", ground)];
    if has_vectors || !is_direct {
        bound.push(("arriving", glossy.arriving));
    }
    if is_direct {
        bound.push(("gloss_direct", leaving.gloss_direct));
    } else {
        bound.push(("gloss_bounced", glossy.bounced));
    }
    bound.extend(leaving.diffuse.map(|diffuse| ("exit_radiance", diffuse)));
    bound.extend(lobes.map.map(|map| ("phong_map", map)));
    match (glossy.outgoing, vectors) {
        (_, Some(Vectors { exit, constants, .. })) => {
            bound.extend([("constants", constants), ("exit_vectors", exit)]);
        }
        (BouncedLight::Seen(exit), _) if throws => bound.push(("exit_seen", exit)),
        _ => {}
    }
    let why = match (throws, has_vectors) {
        (true, true) => "what leaves by direction: diffuse, and mirrored about the normal by lobes",
        (true, false) => "what leaves as seen from above: diffuse, and by lobes",
        (false, _) => "what lobes mirror straight upwards",
    };
    let layers = u64::from(glossy.layers());
    let written = vectors.map_or(16, |_| glossy.texel_bytes() * layers);
    builder.pass(
        shaders::SpecularExit {
            order: glossy.order as i32,
            grey: glossy.grey,
            lobe_is_map: lobes.map.is_some(),
            is_direct,
            throws,
            vectors: has_vectors,
            halves: vectors.is_some_and(|v| v.halves),
        },
        &leaving.name,
        why,
        [cols.div_ceil(8), rows.div_ceil(8), 1],
        &SpecularExitPush {
            cols: cols as i32,
            rows: rows as i32,
            begins: u32::from(leaving.bounce == 1),
            first_texel: vectors.map_or(0, |v| v.first_texel as i32),
            fours: vectors.map_or(0, |v| v.fours as i32),
            exponent: lobes.constant.exponent,
            scale: lobes.constant.scale,
        },
        &bound,
        samples * (3 * 16 + 16 * layers + written),
        samples,
    );
}
