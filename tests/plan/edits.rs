//! Passes of an edit beside those of the whole frame.

use ridgelight::plan::{self, Limits, Picture, missing_barriers};
use ridgelight::scene::{Border, Method, Quality};

use crate::{flat, under_everything};

/// An edit's pass uses the whole frame's pipeline, so both round identically. The exception is light_resolve, in which
/// nothing may be contracted (tests/shader_modules.rs).
#[test]
fn edits_repeat_passes_with_the_same_pipelines() {
    let scene = under_everything(flat(40, 50), Border::Plane);
    for method in [Method::Auto, Method::Sweep] {
        let quality = Quality { method, ..Quality::default() };
        let wanted = Picture { keeps_horizons: true, ..Picture::default() };
        let plan = plan::picture(&scene, &quality, &Limits::lavapipe(), wanted);
        let plan = plan.expect("a plan");
        assert_eq!(missing_barriers(&plan.edit_passes), []);
        let mut names = Vec::new();
        for edit in &plan.edit_passes {
            let Some(whole) = plan.passes.iter().find(|pass| pass.label() == edit.label()) else {
                continue;
            };
            if edit.name() != "light_resolve" {
                assert_eq!(edit.constants, whole.constants, "{}", edit.label());
            }
            names.push(edit.name());
        }
        let expected: &[&str] = match method {
            Method::Auto => &["sky_shade", "shadow_shade", "shadow_settle", "light_resolve"],
            _ => &["sky_shade", "sun_shade", "light_resolve"],
        };
        for name in expected {
            assert!(names.contains(name), "{name} in {names:?}");
        }
    }
}
