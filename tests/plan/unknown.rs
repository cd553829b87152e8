//! Plans of heights that only the device knows.

use ridgelight::Result;
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{Border, Curvature, Directions, HeightField, Normals, Precision, Quality};

use super::{flat, under_sky};

type Planned<'a> = &'a dyn Fn(HeightField) -> Result<Plan>;

fn unknown() -> HeightField {
    HeightField::unknown(9, 14, [1.0; 2]).expect("a field")
}

/// Paths and rays end above the highest height. Packed heights are divided by the largest.
#[test]
fn plans_that_need_heights_refuse_unknown_ones() {
    let limits = Limits::lavapipe();
    let directions = Directions::fibonacci(8, -1.0, 0).expect("directions");
    let packed = Quality { azimuths: 8, precision: Precision::Packed, ..Quality::default() };
    let flat_normals = Normals::Flat;
    let plans: [(&str, Planned<'_>); 7] = [
        ("reference", &|field| {
            plan::reference(&under_sky(field), 1, flat_normals, None, 0, &limits)
        }),
        ("reference_at", &|field| {
            plan::reference_at(&under_sky(field), 1, flat_normals, None, 0, 2, &limits)
        }),
        ("reference_in_bands", &|field| {
            plan::reference_in_bands(&under_sky(field), 1, flat_normals, None, 0, &limits, 8)
        }),
        ("facet_mask", &|field| plan::facet_mask(&field, Border::Plane, &directions, &limits)),
        ("ellipses", &|field| plan::ellipses(&field, Border::Plane, &directions, &limits)),
        ("picture", &|field| {
            plan::picture(&under_sky(field), &packed, &limits, Picture::default())
        }),
        ("horizons", &|field| {
            plan::horizons(&field, Border::Plane, &packed, &limits, (0, 8), false)
        }),
    ];
    for (name, plan) in plans {
        assert!(plan(flat(9, 14)).is_ok(), "{name}");
        let refused = plan(unknown()).unwrap_err().to_string();
        assert!(refused.contains("found unknown heights, expected heights:"), "{name}: {refused}");
    }
}

/// A curved base changes occlusion by an amount that depends on the heights; a flat one changes nothing.
#[test]
fn a_curved_base_refuses_unknown_heights() {
    let curved = Curvature { per_m: [1e-3, 0.0] };
    let refused = curved.check(&unknown(), Border::Plane).unwrap_err().to_string();
    assert!(refused.contains("found unknown heights, expected heights:"), "{refused}");
    assert!(Curvature::FLAT.check(&unknown(), Border::Plane).is_ok());
}

/// A finer field would count as known, and its heights as 0.
#[test]
fn unknown_heights_are_not_refined() {
    let refused = unknown().finer(Border::Plane, 2).map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("found unknown heights, expected heights:"), "{refused}");
    assert!(flat(9, 14).finer(Border::Plane, 2).is_ok());
}

/// Level ground that stays level needs no sweep. Unknown heights may have valleys.
#[test]
fn unknown_heights_keep_their_sweep() {
    let wanted = Picture { still: true, ..Picture::default() };
    let quality = Quality { azimuths: 8, ..Quality::default() };
    let sweeps = |field| {
        let plan = plan::picture(&under_sky(field), &quality, &Limits::lavapipe(), wanted);
        let passes = plan.expect("a plan").passes;
        passes.iter().filter(|pass| pass.name() == "horizon_sweep").count()
    };
    assert_eq!(sweeps(flat(9, 14)), 0);
    assert!(sweeps(unknown()) > 0);
}
