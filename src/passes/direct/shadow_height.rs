use crate::graph::{Axis, Builder, CELL, Limits, ResourceId, shaders};
use crate::passes::azimuths::{across_sun, slope};
use crate::passes::sweep::line_segments;
use crate::scene::{Border, HeightField, Sun};

/// Lines of a workgroup whose grid points it writes. It also sweeps the first line of the next workgroup.
pub(crate) const GROUP_LINES: u32 = 63;
const GROUP_SIZE: u32 = GROUP_LINES + 1;

/// A coarser field, the column and row of its grid at the first grid point of the finer one, and its shadow heights.
pub(crate) struct Outer<'a> {
    pub field: &'a HeightField,
    pub place: [f64; 2],
    pub images: [ResourceId; 2],
}

/// Shadow heights of a whole field, in `parts` dispatches. Each covers some of its lines.
pub(crate) fn plan(
    builder: &mut Builder,
    (field, sun): (&HeightField, &Sun),
    outer: Option<&Outer>,
    (parts, limits): (u32, &Limits),
    heights: ResourceId,
    written: [ResourceId; 3],
) {
    let size = [field.cols() as u32, field.rows() as u32];
    let cell_m = field.cell_m();
    let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..*sun }, 1, cell_m)[0];
    let axis = Axis::of(azimuth.marches_rows(), size, Border::Plane);
    let diameter_rad = if sun.is_point() { 0.0 } else { sun.diameter_rad };
    let edges = [-0.5, 0.5].map(|half| slope(sun.elevation_rad + half * diameter_rad));
    let push = shaders::ShadowHeightPush {
        size: size.map(|n| n as i32),
        outer_size: outer.map_or([0; 2], |o| [o.field.cols() as i32, o.field.rows() as i32]),
        outer_origin: outer.map_or([0.0; 2], |o| o.place.map(|p| p as f32)),
        outer_step: outer
            .map_or([0.0; 2], |o| [0, 1].map(|i| (cell_m[i] / o.field.cell_m()[i]) as f32)),
        edges,
        diameter_rad: diameter_rad as f32,
        step_m: azimuth.step_m,
        outer_base: outer.map_or(0.0, |o| (o.field.base_m() - field.base_m()) as f32),
        shear: azimuth.shear,
        flags: azimuth.flags,
        first_group: 0,
    };
    // Per invocation: two buffers of one step, 16 bytes each, and 16 bytes for the highest ground.
    let segments =
        line_segments(axis.lanes + axis.steps, GROUP_SIZE, (2 + 1) * 16 * GROUP_SIZE, limits);
    let at_once = if segments > 1 { 1 } else { 4 };
    let groups = groups(axis, azimuth.shear);
    let all: u64 = groups.iter().sum();
    let mut first = 0;
    let mut done = 0;
    for number in 0..parts {
        // Groups in the corners have fewer steps. Each part, and each that follows, has a group.
        let most = groups.len() - (parts - 1 - number) as usize;
        let until = all * u64::from(number + 1) / u64::from(parts);
        let mut next = first;
        while next < most
            && (next == first || number + 1 == parts || done + groups[next] / 2 < until)
        {
            done += groups[next];
            next += 1;
        }
        let part = if parts == 1 { String::new() } else { format!("part {}", number + 1) };
        let texels = axis.texels() * groups[first..next].iter().sum::<u64>() / all;
        let mut bound = vec![("heights", heights)];
        if let Some(outer) = outer {
            let [lit_above, penumbra] = outer.images;
            bound.extend([("outer_lit_above", lit_above), ("outer_penumbra", penumbra)]);
        }
        bound.extend(["lit_above", "penumbra", "sun_share"].into_iter().zip(written));
        builder.pass(
            shaders::ShadowHeight {
                has_outer: outer.is_some(),
                local_size_y: segments,
                at_once: at_once as i32,
                line_words: (2 * at_once * segments * GROUP_SIZE) as i32,
                segment_words: (segments * GROUP_SIZE) as i32,
            },
            &part,
            "shadow heights of the sun at each grid point",
            [(next - first) as u32, 1, 1],
            &shaders::ShadowHeightPush { first_group: first as i32, ..push },
            &bound,
            texels * (2 * 4 + 3 * 4),
            texels,
        );
        first = next;
    }
}

/// Steps of each group of lines, as in the shader, at least one.
fn groups(axis: Axis, shear: i32) -> Vec<u64> {
    let (lanes, steps) = (i64::from(axis.lanes), i64::from(axis.steps));
    let (shear, cell) = (i64::from(shear), i64::from(CELL));
    let lead = ((steps - 1) * shear + cell - 1) / cell;
    let group = i64::from(GROUP_LINES);
    let of = |number: i64| {
        if shear == 0 {
            return steps as u64;
        }
        let lowest = (number * group - lead) * cell;
        let begin = ((-cell - lowest - group * cell) / shear).max(0);
        let end = ((lanes * cell - lowest) / shear + 1).clamp(begin, begin.max(steps));
        (end - begin).max(1) as u64
    };
    (0..(lanes + lead + group - 1) / group).map(of).collect()
}
