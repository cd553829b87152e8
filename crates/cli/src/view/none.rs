//! In the place of the window, where the program was built without.

use ridgelight::{Error, Result};

use crate::args::ViewArgs;
use crate::setup::Outcome;

pub fn run(_: &ViewArgs) -> Result<Outcome> {
    let expected = "one built with --features window";
    Err(Error::setting("view", "a program without windows", expected))
}
