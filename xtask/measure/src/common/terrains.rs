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
pub const OF_A_FOLDER: [(&str, Ground); 3] = [
    (inputs::WHITE_MOUNTAINS, Ground::Real),
    (inputs::RAINIER, Ground::Real),
    (inputs::MOSS, Ground::Moss),
];

/// The kind of a field.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// Measured mountains.
    Real,
    /// One of them, three times as steep.
    Steeper,
    City,
    Dunes,
    /// A scan of moss.
    Moss,
}

impl Ground {
    pub const ALL: [Self; 5] = [Self::Real, Self::Steeper, Self::City, Self::Dunes, Self::Moss];

    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "real terrain",
            Self::Steeper => "relief x 3",
            Self::City => "city",
            Self::Dunes => "dunes",
            Self::Moss => "moss",
        }
    }
}

pub struct Terrain {
    /// With its side.
    pub name: String,
    pub ground: Ground,
    pub field: HeightField,
}

/// The middle of the bundled mountain, also three times as steep, and synthetic fields; the middles of real ones of a folder, with
/// their voids.
/// `mountain` and `side`: grid points along a side.
pub fn terrains(folder: Option<&Path>, [mountain, side]: [usize; 2]) -> Result<Vec<Terrain>> {
    let bundled = |steeper: f64| -> Result<HeightField> {
        inputs::middle(&inputs::mountain(steeper)?, mountain)
    };
    let of = |name: String, ground, field| Terrain { name, ground, field };
    let mut all = vec![
        of(format!("Mt Washington, {mountain}²"), Ground::Real, bundled(1.0)?),
        of("the same, relief x 3".to_owned(), Ground::Steeper, bundled(3.0)?),
        of(format!("synthetic city, {side}²"), Ground::City, terrain::city(side)?),
        of(format!("synthetic dunes, {side}²"), Ground::Dunes, terrain::dunes(side)?),
    ];
    let Some(folder) = folder else { return Ok(all) };
    for (name, ground) in OF_A_FOLDER {
        let field = inputs::cut(&inputs::field_of(folder, name)?, side)?;
        all.push(of(format!("{name}, {side}²"), ground, field));
    }
    Ok(all)
}

/// The value of `--border`.
pub fn border_name(border: Border) -> String {
    format!("{border:?}").to_lowercase()
}
