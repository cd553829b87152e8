use super::{Builder, Format, Limits, Owner, Plan};
use crate::{Error, Result, passes};

/// What part of a lit field a screen shows from above, north up, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// Columns and rows of the field.
    pub field: [u32; 2],
    /// Whether the radiance has four channels; else it has one.
    pub has_colour: bool,
    /// Whether there is an image of samples without data, which are not shown.
    pub has_voids: bool,
    /// Columns and rows of the picture, pixels.
    pub size: [u32; 2],
    /// Column and row of the field at the picture's upper left corner; 0, 0 is the field's. Within ±1e6.
    pub corner: [f32; 2],
    /// Side of a pixel, [1e-3..1e3] samples: a pixel shows the sample that its middle is in.
    pub samples_per_pixel: f32,
    /// Whether blue comes first in a pixel's four bytes, not red.
    pub swaps: bool,
}

impl Map {
    /// The four bytes of pixels where there is no field.
    pub const BEYOND: [u8; 4] = [0x20, 0x20, 0x20, 0xff];

    /// # Errors
    /// What is out of range, by name.
    pub fn check(&self) -> Result<()> {
        if !self.corner.iter().all(|v| v.abs() <= 1e6) {
            let found = format!("{},{}", self.corner[0], self.corner[1]);
            return Err(Error::setting("map: corner", found, "numbers within ±1e6"));
        }
        if !(1e-3..=1e3).contains(&self.samples_per_pixel) {
            let found = self.samples_per_pixel.to_string();
            return Err(Error::setting(
                "map: samples a pixel",
                found,
                "a number from 0.001 to 1000",
            ));
        }
        Ok(())
    }
}

/// The pass that draws a [`Map`].
///
/// Inputs, in order: "radiance", "tone_steps" ([`Tone::steps`](crate::scene::Tone)), "voids" where there are
/// any: 0 where there is ground, 1 where there is none. Output: "picture", the four bytes of each pixel as one word,
/// the first lowest, the last 255. Without voids and from samples inside the field they are the codes of
/// `write_png`.
///
/// # Errors
/// What is out of range, or a picture beyond the limits.
pub fn map(map: &Map, limits: &Limits) -> Result<Plan> {
    map.check()?;
    let mut builder = Builder::new();
    let mut image = |name: &str, owner: Owner, format: Format, [width, height]: [u32; 2]| {
        builder.image(name, owner, format, [width, height, 1], false)
    };
    let format = if map.has_colour { Format::Rgba32Float } else { Format::R32Float };
    let mut bound = vec![
        ("radiance", image("radiance", Owner::Input, format, map.field)),
        ("tone_steps", image("tone_steps", Owner::Input, Format::R32Float, [256, 1])),
    ];
    if map.has_voids {
        bound.push(("voids", image("voids", Owner::Input, Format::R32Float, map.field)));
    }
    bound.push(("picture", image("picture", Owner::Output, Format::R32Uint, map.size)));
    passes::map_draw::plan(&mut builder, map, &bound);
    let none = Vec::new();
    Plan::finish(builder, map.field, Vec::new(), Vec::new(), none, Vec::new(), limits)
}
