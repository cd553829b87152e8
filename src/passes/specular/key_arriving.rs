use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::bounced_specular::BouncedSpecular;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::Lanes;
use crate::scene::Border;

/// Incident light of a key light as an SH series, through the horizons of a batch of its azimuths; `begins`: the series
/// begin with it.
pub(crate) fn plan(
    builder: &mut Builder,
    (sweep, border, cell_m): (&Sweep, Border, [f64; 2]),
    (batch, part): (&Batch, &str),
    (lanes, lattice, azimuths): (Lanes, Option<ResourceId>, ResourceId),
    (radiance, begins): ([f32; 3], bool),
    outgoing: &BouncedSpecular,
) {
    let axis = batch.axis;
    let mut bound = vec![
        ("lane_heights", lanes.read()),
        ("azimuths", azimuths),
        ("arriving", outgoing.arriving),
    ];
    bound.extend(lattice.map(|l| (sweep.lattice_binding(), l)));
    let [r, g, b] = radiance;
    let colour = [r, g, b, f32::from(u8::from(begins))];
    let pass = builder.pass(
        shaders::KeyArriving {
            layer_shift: batch.layer_shift as i32,
            fuse: sweep.fuse_mode(),
            lattice: sweep.lattice_content(),
            line_shift: sweep.line_shift() as i32,
            border: border as u32,
            marches_rows: axis.marches_rows,
            order: outgoing.order as i32,
            grey: outgoing.grey,
            reads_lane_windows: lanes.windows.is_some(),
        },
        part,
        "the harmonics' integral over each wedge above the horizon, for bounces",
        shaders::KEY_ARRIVING.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::ShadePush { colour, ..shaders::ShadePush::of(batch, cell_m) },
        &bound,
        axis.texels()
            * (4 + 2 * 16 * u64::from(outgoing.layers())
                + u64::from(batch.count) * sweep.lattice_bytes()),
        axis.texels() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}
