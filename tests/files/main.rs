//! Readers against files built here byte by byte and against real ones; writers by reading back.

#[path = "../common/formats.rs"]
mod formats;
mod heights;
mod ktx2;
mod light;
mod malformed;
mod notes;
mod real;
mod sparse;
mod visible;
mod write;

use formats::HEIGHTS;
use ridgelight::Error;
use ridgelight::scene::HeightField;
use ridgelight_io::{HeightOptions, parse_heights};
use std::path::Path;

/// Asserts that a message is one sentence about a file: its name, no line break, found and
/// expected where the file is to blame.
fn one_sentence(message: &str, name: &str) {
    assert!(message.contains(name), "{message:?} does not name {name}");
    assert!(!message.contains(['\n', '\r']), "{message:?} has several lines");
    assert!(!message.trim_end_matches('.').contains(". "), "{message:?} is several sentences");
    assert!(message.contains(": found ") && message.contains(", expected "), "{message:?}");
    assert!(message.len() < 400, "{message:?} is long");
}

fn parse(name: &str, bytes: &[u8]) -> Result<HeightField, Error> {
    parse_heights(Path::new(name), bytes, &HeightOptions::default())
}

/// Absolute heights; exact for the small integers used here.
fn absolute(field: &HeightField) -> Vec<f64> {
    field.heights_m().iter().map(|h| f64::from(*h) + field.base_m()).collect()
}

fn expected() -> Vec<f64> {
    HEIGHTS.iter().map(|h| f64::from(*h)).collect()
}
