//! CPU references, the f64 oracle and quadrature, and bakes, against closed forms and each other: a module is a room.

mod bake;
mod bounce;
mod direct;
mod edit {
    mod resweep;
}
#[path = "../common/brute_force_paths.rs"]
mod brute_force_paths;
#[path = "../common/fields.rs"]
mod fields;
mod horizon;
#[path = "../common/reference_page.rs"]
mod reference_page;
#[path = "../common/scenes.rs"]
mod scenes;
#[path = "../common/v_grooves.rs"]
mod v_grooves;

use fields::field;
use ridgelight::scene::Border;

const BORDERS: [Border; 3] = [Border::Plane, Border::Open, Border::Periodic];
