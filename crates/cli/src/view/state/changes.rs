//! What the panel changes.

use super::lights::compass;
use super::{State, Text, Wish, hundredths};

/// A change that the panel asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The same as a key.
    Key(&'static str),
    /// Opens one of the lists.
    Text(Text),
    /// Turns the first sun to a compass azimuth and an elevation, degrees.
    Sun([f64; 2]),
    Exposure(f32),
    /// Gives a setting a value, by its name.
    Setting(&'static str, String),
    /// Copies the command line.
    Copy,
}

impl State {
    /// Does it, as [`key`](Self::key) for a picture of a size.
    pub fn change(&mut self, change: Change, size: [u32; 2]) -> Wish {
        self.message = None;
        match change {
            Change::Key(name) => return self.key(name, size),
            Change::Text(text) => self.text = text,
            Change::Sun(to) => return self.point_sun(to),
            Change::Exposure(exposure) => self.set_exposure(exposure),
            Change::Setting(name, word) => {
                let changed = self.settings.set(name, word, &mut self.asked);
                return self.take_quality(changed);
            }
            Change::Copy => return Wish::Copy,
        }
        Wish::Show
    }

    /// The first sun's compass azimuth and elevation, degrees.
    pub fn sun(&self) -> Option<[f64; 2]> {
        self.scene.lights.suns.first().map(|sun| compass(sun).map(hundredths))
    }
}
