use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::nodes::Nodes;
use crate::passes::sh_layout::Sh;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::Lanes;
use crate::scene::{Border, Wedges};

/// How a batch's wedges become SH.
pub(crate) struct Images {
    pub lanes: Lanes,
    pub lattice: Option<ResourceId>,
    pub azimuths: ResourceId,
    pub visibility: ResourceId,
    pub nodes: Option<ResourceId>,
}

/// Visibility at texels, or at nodes, through the horizons of a batch, as an SH series.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    (border, cell_m): (Border, [f64; 2]),
    (sh, wedges, lattice_of): (&Sh, Wedges, Nodes),
    batch: &Batch,
    part: &str,
    images: &Images,
) {
    let axis = batch.axis;
    let mut bound = vec![
        ("lane_heights", images.lanes.read()),
        ("azimuths", images.azimuths),
        ("visibility", images.visibility),
    ];
    bound.extend(images.lattice.map(|l| (sweep.lattice_binding(), l)));
    bound.extend(images.nodes.map(|n| ("nodes", n)));
    let [lanes, steps] = sh.nodes.size([axis.lanes, axis.steps]);
    let nodes = u64::from(lanes) * u64::from(steps);
    let kept = sh.layers() as u64 * 16 * if batch.is_first { 1 } else { 2 };
    let pass = builder.pass(
        shaders::ShVisibility {
            layer_shift: batch.layer_shift as i32,
            fuse: sweep.fuse_mode(),
            lattice: sweep.lattice_content(),
            line_shift: sweep.line_shift() as i32,
            border: border as u32,
            order: sh.order as i32,
            by_nlp: wedges == Wedges::Nlp,
            marches_rows: axis.marches_rows,
            own_plane_hides: sh.own_plane_hides,
            lane_stride: sh.nodes.stride as i32,
            lattice_stride: lattice_of.stride as i32,
            reads_lane_windows: images.lanes.windows.is_some(),
        },
        part,
        match wedges {
            Wedges::Slices => "visibility as SH, by exact integrals over elevation",
            Wedges::Nlp => "visibility as SH, by Legendre coefficients",
            Wedges::Table => unreachable!("sh_wedges looks up two azimuths at once"),
        },
        shaders::SH_VISIBILITY.groups([steps, lanes.div_ceil(4), 1]),
        &shaders::ShadePush::of(batch, cell_m),
        &bound,
        nodes * (4 + kept + u64::from(batch.count) * sweep.lattice_bytes()),
        nodes * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}
