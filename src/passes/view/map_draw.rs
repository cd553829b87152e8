use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::Tone;
use crate::{Error, Result};

/// The part of a lit field that a screen shows from above, north up, and its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// Columns and rows of the field.
    pub field: [u32; 2],
    /// Whether the radiance has four channels; else it has one.
    pub has_colour: bool,
    /// Whether there is a mask of voids, which are not shown.
    pub has_voids: bool,
    /// Columns and rows of the picture, pixels.
    pub size: [u32; 2],
    /// Column and row of the field at the picture's upper left corner, within ±1e6; 0, 0 is the field's.
    pub corner: [f32; 2],
    /// Texels per pixel along a side, [1e-3..1e3]: up to 1 a pixel shows the texel at its middle, beyond that the mean
    /// of several.
    pub grid_points_per_pixel: f32,
    /// Whether pixels between the centres of texels have light between theirs (bilinear), below 2 texels per pixel.
    pub is_smooth: bool,
    /// Tone curve to 8-bit codes. The exposure is 0, or from 1.2e-38 to 1e34: thresholds and light are then no denormals.
    pub tone: Tone,
    /// Whether the order of a pixel's four bytes is B, G, R, A instead of R, G, B, A.
    pub swaps: bool,
}

impl Map {
    /// The four bytes of pixels beyond the field.
    pub const BEYOND: [u8; 4] = [0x20, 0x20, 0x20, 0xff];

    /// Places per pixel along a side: the power of two not below the texels per pixel, 8 at most.
    fn places(&self) -> u32 {
        if self.is_smooth && self.grid_points_per_pixel < 2.0 {
            return 1;
        }
        let needed = self.grid_points_per_pixel.clamp(1.0, 8.0).ceil();
        (needed as u32).next_power_of_two()
    }

    /// # Errors
    /// The value out of range, by name.
    pub(crate) fn check(&self) -> Result<()> {
        if !self.corner.iter().all(|v| v.abs() <= 1e6) {
            let found = format!("{},{}", self.corner[0], self.corner[1]);
            return Err(Error::setting("map: corner", found, "numbers within ±1e6"));
        }
        if !(1e-3..=1e3).contains(&self.grid_points_per_pixel) {
            let found = self.grid_points_per_pixel.to_string();
            return Err(Error::setting(
                "map: grid points per pixel",
                found,
                "a number from 0.001 to 1000",
            ));
        }
        let Tone { exposure, shoulder } = self.tone;
        let is_exposure = exposure == 0.0 || (f32::MIN_POSITIVE..=1e34).contains(&exposure);
        if !is_exposure || !(0.0..=1.0).contains(&shoulder) {
            let found = format!("exposure {exposure}, shoulder {shoulder}");
            let expected = "an exposure of 0 or from 1.2e-38 to 1e34, a shoulder from 0 to 1";
            return Err(Error::setting("map: tone", found, expected));
        }
        Ok(())
    }
}

/// One texel per pixel, or fewer or more.
pub(crate) fn plan(builder: &mut Builder, map: &Map, bound: &[(&str, ResourceId)]) {
    let [width, height] = map.size;
    let pixels = u64::from(width) * u64::from(height);
    builder.pass(
        shaders::MapDraw {
            grey: !map.has_colour,
            has_voids: map.has_voids,
            is_smooth: map.is_smooth && map.places() == 1,
            places: map.places() as i32,
        },
        "",
        "radiance, tone-mapped for a screen",
        shaders::MAP_DRAW.groups([width, height, 1]),
        &shaders::MapDrawPush {
            width: width as i32,
            height: height as i32,
            cols: map.field[0] as i32,
            rows: map.field[1] as i32,
            first_col: map.corner[0],
            first_row: map.corner[1],
            grid_points_per_pixel: map.grid_points_per_pixel,
            swaps: u32::from(map.swaps),
            beyond: u32::from_le_bytes(Map::BEYOND),
            exposure: map.tone.exposure,
            shoulder: map.tone.shoulder,
        },
        bound,
        pixels * if map.has_colour { 20 } else { 8 },
        pixels,
    );
}
