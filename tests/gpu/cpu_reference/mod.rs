//! Every pass on the device against its CPU reference: the counterpart of the pass in `ridgelight_cpu`.
//! The reference gets what the device itself handed to the pass, so that each is judged alone. Tolerances are the formulas of `measure::tolerance`.

mod bend;
mod bounce;
mod cases;
mod edit;
mod ellipses;
mod facets;
mod light;
mod nodes;
mod paths;
mod points;
mod pyramid;
mod run;
mod scatter;
mod sh;
pub(crate) mod soft;
mod specular;
mod sweep;

use std::collections::BTreeMap;

use ridgelight::gpu::shaders;
use ridgelight::plan::{Limits, Pass};
use ridgelight::scene::Fuse;

use crate::Device;
use cases::Case;
use run::Run;

/// One value of the device, the CPU reference's, and how far apart they may be.
#[derive(Clone, Copy, Debug)]
struct Pair {
    got: f64,
    want: f64,
    tolerance: f64,
    /// Azimuth or layer, row, column; or what stands for them in a resource that has others.
    at: [usize; 3],
}

impl Pair {
    /// Error over tolerance: above 1 is too far. What is no number is never near.
    fn ratio(&self) -> f64 {
        let error = (self.got - self.want).abs();
        if self.got == self.want {
            0.0
        } else if error.is_nan() || self.tolerance == 0.0 {
            f64::INFINITY
        } else {
            error / self.tolerance
        }
    }
}

fn worst(pairs: &[Pair]) -> Option<&Pair> {
    pairs.iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
}

type CpuReference = fn(&mut Run, &Pass) -> Vec<Pair>;

/// Every pass's name and its CPU reference.
const REFERENCES: &[(&str, CpuReference)] = &[
    ("dirty_list", edit::dirty_list),
    ("dirty_mark", edit::dirty_mark),
    ("height_expand", pyramid::height_expand),
    ("height_reduce", pyramid::height_reduce),
    ("pyramid_march", pyramid::pyramid_march),
    ("height_transpose", sweep::height_transpose),
    ("horizon_resweep", edit::horizon_resweep),
    ("height_cells", paths::height_cells),
    ("height_bounds", paths::height_bounds),
    ("path_trace", paths::path_trace),
    ("visible_points", points::visible_points),
    ("bent_directions", bend::bent_directions),
    ("fan_weights", bend::fan_weights),
    ("ellipse_fit", ellipses::ellipse_fit),
    ("facet_mask", facets::facet_mask),
    ("scatter_gather", scatter::scatter_gather),
    ("horizon_sweep", sweep::horizon_sweep),
    ("surface_sweep", sweep::surface_sweep),
    ("horizon_march", sweep::horizon_march),
    ("sweep_fuse", sweep::sweep_fuse),
    ("env_wedges", light::env_wedges),
    ("env_tables", light::env_tables),
    ("env_rotation", sh::env_rotation),
    ("light_matrix", sh::light_matrix),
    ("sh_visibility", sh::sh_visibility),
    ("sh_shade", sh::sh_shade),
    ("sh_wedges", sh::sh_wedges),
    ("sky_shade", light::sky_shade),
    ("sun_shade", light::sun_shade),
    ("sun_specular", light::sun_specular),
    ("sphere_shade", light::sphere_shade),
    ("sphere_sh_shade", soft::sphere_sh_shade),
    ("light_resolve", light::light_resolve),
    ("bounce_gather", bounce::bounce_gather),
    ("specular_exit", specular::specular_exit),
    ("specular_gather", specular::specular_gather),
    ("specular_visibility", specular::specular_visibility),
    ("vector_reduce", specular::vector_reduce),
    ("bounce_march", bounce::bounce_march),
    ("bounce_shade", nodes::bounce_shade),
    ("bounce_walk", bounce::bounce_walk),
    ("cache_gather", nodes::cache_gather),
    ("shade_expand", bounce::shade_expand),
    ("shade_reduce", bounce::shade_reduce),
];

/// Held to the CPU reference where whole pictures are, byte by byte: [`crate::map`].
const ELSEWHERE: [&str; 1] = ["map_draw"];

fn reference_of(pass: &Pass) -> CpuReference {
    let reference = REFERENCES.iter().find(|t| t.0 == pass.name());
    reference.unwrap_or_else(|| panic!("{} has no test against a CPU reference", pass.name())).1
}

/// A specialisation constant of a pass.
fn constant(pass: &Pass, name: &str) -> u32 {
    pass.constant(name).expect("a constant of the pass")
}

/// A word of a pass's push constants.
fn pushed(pass: &Pass, offset: usize) -> u32 {
    u32::from_ne_bytes(pass.push[offset..offset + 4].try_into().expect("four bytes"))
}

/// FUSE and LINE_SHIFT, which the shaders that include `fuse.glsl` share.
fn fuse_of(pass: &Pass) -> (Option<Fuse>, u32) {
    use Fuse::{Aimed, AimedAround, AimedNearest, Nearest, Own, Slopes};
    let modes = [Nearest, Slopes, Own, AimedNearest, Aimed, AimedAround].map(Some);
    let fuse = (constant(pass, "fuse") as usize).checked_sub(1).and_then(|mode| modes[mode]);
    (fuse, constant(pass, "line_shift"))
}

/// Runs a case; prints the worst ratio of each pass and fails above 1. Returns the lines redone.
fn check(device: &mut Device, case: &Case) -> usize {
    let mut run = Run::new(device.gpu.as_mut().expect("alive"), case);
    let all = run.pairs();
    let lost = run.lost;
    run.gpu.end(run.frame);
    let mut by_pass: BTreeMap<&str, Vec<Pair>> = BTreeMap::new();
    for (label, pairs) in &all {
        by_pass.entry(label.as_str()).or_default().extend(pairs);
    }
    let mut failed = Vec::new();
    for (label, pairs) in by_pass {
        let Some(worst) = worst(&pairs) else { continue };
        println!("{}: {label}: {:.3} of {} values", case.name, worst.ratio(), pairs.len());
        if worst.ratio() > 1.0 {
            let Pair { got, want, tolerance, at } = worst;
            let ratio = worst.ratio();
            failed
                .push(format!("{label} at {at:?}: {got} against {want}, {ratio} of {tolerance:e}"));
        }
    }
    assert!(failed.is_empty(), "{}:\n{}", case.name, failed.join("\n"));
    lost
}

#[test]
fn every_shader_has_a_cpu_reference_and_a_case() {
    let cases: Vec<Case> = [
        cases::sweeps(),
        cases::samples(),
        cases::pyramids(),
        cases::pictures(),
        cases::references(),
        cases::paths(),
        cases::points(),
        cases::scatters(),
        cases::ellipses(),
        cases::facets(),
        cases::walks(),
        cases::bounced_light(),
        cases::specular(),
        cases::nodes(),
    ]
    .into_iter()
    .flatten()
    .collect();
    let planned: Vec<&str> = cases
        .iter()
        .map(|case| case.plan(&Limits::lavapipe()))
        .flat_map(|plan| plan.passes.into_iter().chain(plan.edit_passes))
        .map(|pass| pass.name())
        .collect();
    for shader in shaders::ALL.iter().filter(|s| !ELSEWHERE.contains(&s.name)) {
        assert!(
            REFERENCES.iter().any(|t| t.0 == shader.name),
            "{} has no test against a CPU reference",
            shader.name
        );
        assert!(planned.contains(&shader.name), "no case runs {}", shader.name);
    }
    assert_eq!(
        REFERENCES.len() + ELSEWHERE.len(),
        shaders::ALL.len(),
        "a CPU reference of no shader"
    );
}

#[test]
fn sweeps_in_every_form_match() {
    let mut device = Device::new();
    for case in cases::sweeps() {
        let lost = check(&mut device, &case);
        assert_eq!(lost > 0, case.loses_lines, "{}: {lost} groups of lines redone", case.name);
    }
}

#[test]
fn sweeps_of_one_value_a_sample_match() {
    let mut device = Device::new();
    for case in cases::samples() {
        check(&mut device, &case);
    }
}

#[test]
fn pyramids_match() {
    let mut device = Device::new();
    for case in cases::pyramids() {
        check(&mut device, &case);
    }
}

#[test]
fn pictures_match_pass_by_pass() {
    let mut device = Device::new();
    for case in cases::pictures() {
        check(&mut device, &case);
    }
}

#[test]
fn walks_match_pass_by_pass() {
    let mut device = Device::new();
    for case in cases::walks() {
        check(&mut device, &case);
    }
}

#[test]
fn bounces_match() {
    let mut device = Device::new();
    for case in cases::bounced_light() {
        check(&mut device, &case);
    }
}

#[test]
fn bounced_specular_matches() {
    let mut device = Device::new();
    for case in cases::specular() {
        check(&mut device, &case);
    }
}

#[test]
fn bounces_at_nodes_match() {
    let mut device = Device::new();
    for case in cases::nodes() {
        check(&mut device, &case);
    }
}

#[test]
fn paths_match_pass_by_pass() {
    let mut device = Device::new();
    for case in cases::references().into_iter().chain(cases::paths()) {
        check(&mut device, &case);
    }
}

#[test]
fn paths_are_the_quadrature() {
    let mut device = Device::new();
    for case in cases::references() {
        let mut run = Run::new(device.gpu.as_mut().expect("alive"), &case);
        let last = run.plan.passes.last().expect("paths").clone();
        let pairs = paths::quadrature(&mut run, &last);
        run.gpu.end(run.frame);
        let worst = worst(&pairs).expect("values");
        assert!(worst.ratio() <= 1.0, "{}: {worst:?}", case.name);
    }
}

/// The comparison is not deaf: any value of any pass, moved by a bit more than its tolerance, fails.
#[test]
fn a_value_beyond_its_tolerance_is_seen() {
    let mut device = Device::new();
    let cases = cases::pictures();
    let mut all = Vec::new();
    for case in cases.iter().filter(|c| {
        ["environment on a plane", "harmonics of order 3", "sphere lights by harmonics"]
            .contains(&c.name)
    }) {
        let mut run = Run::new(device.gpu.as_mut().expect("alive"), case);
        all.extend(run.pairs());
        run.gpu.end(run.frame);
    }
    for (label, pairs) in all.iter().filter(|a| !a.1.is_empty()) {
        for picked in [0, pairs.len() / 2, pairs.len() - 1] {
            let mut spoiled = pairs.clone();
            let pair = &mut spoiled[picked];
            // Where nothing is tolerated, the next f32; the f64 sum may round towards the CPU reference.
            let beyond = (pair.want as f32).next_up();
            pair.got = if pair.tolerance > 0.0 {
                pair.want + 1.01 * pair.tolerance
            } else {
                f64::from(beyond)
            };
            let found = worst(&spoiled).expect("values");
            assert!(found.ratio() > 1.0, "{label}: deaf at {picked}: {found:?}");
        }
    }
}

#[test]
fn points_match() {
    let mut device = Device::new();
    for case in cases::points() {
        check(&mut device, &case);
    }
}

#[test]
fn scattered_light_matches() {
    let mut device = Device::new();
    for case in cases::scatters() {
        check(&mut device, &case);
    }
}

#[test]
fn ellipses_match() {
    let mut device = Device::new();
    for case in cases::ellipses() {
        check(&mut device, &case);
    }
}

#[test]
fn triangles_match() {
    let mut device = Device::new();
    for case in cases::facets() {
        check(&mut device, &case);
    }
}
