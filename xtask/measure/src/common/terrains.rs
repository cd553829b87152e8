//! Terrains and borders on which programs compare methods.

use std::path::Path;

use ridgelight::Result;
use ridgelight::scene::{Border, HeightField};
use ridgelight_testing::terrain;

use super::inputs;

pub const BORDERS: [Border; 3] = [Border::Plane, Border::Open, Border::Periodic];

/// The side of the bundled mountain, whole, and that of the other fields.
pub const SIDES: [usize; 2] = [256, 384];

/// Files of a folder's `height/`.
pub const OF_A_FOLDER: [&str; 3] = [inputs::WHITE_MOUNTAINS, inputs::RAINIER, inputs::MOSS];

pub struct Terrain {
    /// With its side.
    pub name: String,
    pub field: HeightField,
}

/// The middle of the bundled mountain, also three times as steep, and synthetic fields; the middles of real ones of a folder.
/// `mountain` and `side`: grid points along a side.
pub fn terrains(folder: Option<&Path>, [mountain, side]: [usize; 2]) -> Result<Vec<Terrain>> {
    let bundled = |steeper: f64| -> Result<HeightField> {
        inputs::middle(&inputs::mountain(steeper)?, mountain)
    };
    let of = |name: String, field| Terrain { name, field };
    let mut all = vec![
        of(format!("Mt Washington, {mountain}²"), bundled(1.0)?),
        of("the same, relief x 3".to_owned(), bundled(3.0)?),
        of(format!("synthetic city, {side}²"), terrain::city(side)?),
        of(format!("synthetic dunes, {side}²"), terrain::dunes(side)?),
    ];
    let Some(folder) = folder else { return Ok(all) };
    for name in OF_A_FOLDER {
        let field = inputs::middle(&inputs::field_of(folder, name)?, side)?;
        all.push(of(format!("{name}, {side}²"), field));
    }
    Ok(all)
}

/// As flags have it.
pub fn border_name(border: Border) -> String {
    format!("{border:?}").to_lowercase()
}
