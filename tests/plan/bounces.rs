//! Which passes bounces have.

use ridgelight::plan::{self, Limits, Pass, Picture, Plan};
use ridgelight::scene::{Albedo, Border, BounceEngine, Bounces, Lights, Quality, Scene, Surface};

use crate::flat;

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Brute, BounceEngine::Sweep, BounceEngine::Pyramid];

fn planned(albedo: [f32; 3], count: u32, engine: BounceEngine) -> Plan {
    let surface = Surface { albedo: Albedo::Constant(albedo), border: Border::Plane, phong: None };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field: flat(9, 14), surface, lights };
    let bounces = Bounces { count, engine, azimuths: 8, cutoff: 0.0, ..Bounces::default() };
    let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
}

fn labels(plan: &Plan) -> Vec<String> {
    plan.passes.iter().map(Pass::label).collect()
}

/// Ground that reflects nothing has the passes, images and outputs of a picture without bounces, and says why; ground
/// that reflects the least there is in one colour has them all.
#[test]
fn black_ground_drops_every_pass_of_bounces() {
    for engine in ENGINES {
        let [black, none, faint] = [([0.0; 3], 3), ([0.0; 3], 0), ([0.0, 1e-30, 0.0], 3)]
            .map(|(albedo, count)| planned(albedo, count, engine));
        assert_eq!(labels(&black), labels(&none), "{engine:?}");
        let names = |plan: &Plan| -> Vec<String> {
            plan.resources.iter().map(|r| r.name.clone()).collect()
        };
        assert_eq!(names(&black), names(&none), "{engine:?}");
        assert!(black.notes.contains(&"no bounces: the surface reflects nothing".to_owned()));
        let of_bounces = |plan: &Plan| {
            let is_one = |l: &&String| l.contains("bounce") || l.contains("shade_reduce");
            labels(plan).iter().filter(is_one).count()
        };
        assert_eq!(of_bounces(&black), 0, "{engine:?}");
        let faint_ones = labels(&faint).join(" ");
        for k in 1..=3 {
            assert!(faint_ones.contains(&format!("bounce{k}")), "{engine:?}: {faint_ones}");
        }
        assert!(of_bounces(&faint) >= 6, "{engine:?}: {faint_ones}");
    }
}
