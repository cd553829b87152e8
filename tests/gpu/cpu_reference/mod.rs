//! Every pass on the device against its CPU reference: the counterpart of the pass in `ridgelight_cpu`. The reference
//! takes the device's own inputs of the pass, so each pass is compared alone. Tolerances are the formulas of
//! `ridgelight_cpu::tolerance`.

mod case;
mod run;

use std::collections::BTreeMap;

use ridgelight::gpu::shaders;
use ridgelight::plan::{Limits, Pass};
use ridgelight::scene::Fuse;

use crate::Device;
use crate::bake::cpu_reference as bake;
use crate::bounce::cpu_reference as bounce;
use crate::device::cpu_reference as device;
use crate::direct::cpu_reference as direct;
use crate::edit::cpu_reference as edit;
use crate::horizon::cpu_reference as horizon;
use crate::rays::cpu_reference as rays;
use crate::reference::cpu_reference as reference;
use crate::sh::cpu_reference as sh;
use crate::specular::cpu_reference as specular;

pub(crate) use case::{Case, Wanted, bowl, key, noisy_environment, rough};
pub(crate) use run::Run;

/// A value of the device, the CPU reference's, and their tolerance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub got: f64,
    pub want: f64,
    pub tolerance: f64,
    /// Azimuth or layer, row, column; or their counterparts in a resource that has others.
    pub at: [usize; 3],
}

impl Pair {
    /// Error over tolerance: above 1 fails. NaN always fails.
    pub fn ratio(&self) -> f64 {
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

pub(crate) fn worst(pairs: &[Pair]) -> Option<&Pair> {
    pairs.iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
}

pub(crate) type CpuReference = fn(&mut Run, &Pass) -> Vec<Pair>;

/// A pass's name and its CPU reference.
pub(crate) type Reference = (&'static str, CpuReference);

/// Every room's passes.
const ROOMS: [&[Reference]; 10] = [
    device::REFERENCES,
    horizon::REFERENCES,
    edit::REFERENCES,
    rays::REFERENCES,
    reference::REFERENCES,
    bake::REFERENCES,
    sh::REFERENCES,
    direct::REFERENCES,
    specular::REFERENCES,
    bounce::REFERENCES,
];

fn references() -> impl Iterator<Item = &'static Reference> {
    ROOMS.into_iter().flatten()
}

/// Compared with their CPU references over whole pictures: [`crate::view`].
const ELSEWHERE: [&str; 3] = ["map_draw", "preview_gather", "preview_shade"];

fn reference_of(pass: &Pass) -> CpuReference {
    let reference = references().find(|t| t.0 == pass.name());
    reference.unwrap_or_else(|| panic!("{} has no test against a CPU reference", pass.name())).1
}

/// A specialisation constant of a pass.
pub(crate) fn constant(pass: &Pass, name: &str) -> u32 {
    pass.constant(name).expect("a constant of the pass")
}

/// A word of a pass's push constants.
pub(crate) fn pushed(pass: &Pass, offset: usize) -> u32 {
    u32::from_ne_bytes(pass.push[offset..offset + 4].try_into().expect("four bytes"))
}

/// FUSE and LINE_SHIFT, which the shaders that include `fuse.glsl` share.
pub(crate) fn fuse_of(pass: &Pass) -> (Option<Fuse>, u32) {
    use Fuse::{Aimed, AimedAround, AimedNearest, Nearest, Own, Slopes};
    let modes = [Nearest, Slopes, Own, AimedNearest, Aimed, AimedAround].map(Some);
    let fuse = (constant(pass, "fuse") as usize).checked_sub(1).and_then(|mode| modes[mode]);
    (fuse, constant(pass, "line_shift"))
}

/// Runs a case; prints the worst ratio of each pass and fails above 1. Returns the lines redone.
pub(crate) fn check(device: &mut Device, case: &Case) -> usize {
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

pub(crate) fn check_all(cases: &[Case]) {
    let mut device = Device::new();
    for case in cases {
        check(&mut device, case);
    }
}

#[test]
fn every_shader_has_a_cpu_reference_and_a_case() {
    let cases: Vec<Case> = [
        device::peaks(),
        horizon::sweeps(),
        horizon::one_line_sweeps(),
        horizon::texels(),
        horizon::pyramids(),
        direct::pictures(),
        direct::shadow_height::cases(),
        reference::references(),
        reference::paths(),
        bake::point_cases(),
        bake::scatter_cases(),
        bake::ellipse_cases(),
        bake::facet_cases(),
        bounce::walks(),
        bounce::bounced_light(),
        specular::cases(),
        bounce::node_cases(),
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
            references().any(|t| t.0 == shader.name),
            "{} has no test against a CPU reference",
            shader.name
        );
        assert!(planned.contains(&shader.name), "no case runs {}", shader.name);
    }
    assert_eq!(
        references().count() + ELSEWHERE.len(),
        shaders::ALL.len(),
        "a CPU reference of no shader"
    );
}

/// The comparison can fail: any value of any pass, moved by slightly more than its tolerance, fails.
#[test]
fn a_value_beyond_its_tolerance_fails() {
    let mut device = Device::new();
    let cases = direct::pictures();
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
            // For a tolerance of 0, the next f32; the f64 sum may round towards the CPU reference.
            let beyond = (pair.want as f32).next_up();
            pair.got = if pair.tolerance > 0.0 {
                pair.want + 1.01 * pair.tolerance
            } else {
                f64::from(beyond)
            };
            let found = worst(&spoiled).expect("values");
            assert!(found.ratio() > 1.0, "{label}: unchanged at {picked}: {found:?}");
        }
    }
}
