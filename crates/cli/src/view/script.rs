//! User input from a file, for tests.

use std::path::{Path, PathBuf};
use std::time::Instant;

use ridgelight::{Error, Result};

/// One step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A key by its name, as [`State::key`](super::state::State::key) takes it.
    Key(String),
    /// A drag by a button: start and offset, pixels.
    Drag(Button, [f64; 2], [f64; 2]),
    /// Notches of the wheel, upwards, and where.
    Wheel(f64, [f64; 2]),
    /// Draws so many frames.
    Frames(u32),
    /// Sets the window's columns and rows, and waits until pictures have them.
    Size([u32; 2]),
    /// Drops the window's surface, as if it had been lost.
    Lose,
    Picture(PathBuf),
    Scene(PathBuf),
    /// Saves the window's pixels.
    Screenshot(PathBuf),
    /// Saves the panel's text.
    Text(PathBuf),
    /// Saves the command line that the panel copies.
    Command(PathBuf),
    /// Saves the places of the panel's parts.
    Places(PathBuf),
    /// Draws and waits for input until the panel has a part of a name and is settled; then saves the places.
    Shown(PathBuf, String),
    /// Draws until the reference has so many paths per texel.
    Paths(u32),
    /// Prints the frames so far and their milliseconds since the last report, after some words.
    Report(String),
    /// Turns previews on. `preview` alone: only for slow light, as without a script. `preview 8,6,4 [4,3,2]`: always, with these
    /// sides of blocks (sky, sun, slopes) for the drag preview and, if given, the rest preview.
    Preview(Option<([usize; 3], Option<[usize; 3]>)>),
    /// Waits for the rest preview.
    RestPreview,
    /// Draws until the light is the full one.
    Rest,
    /// Waits for input until this file exists, as without a script.
    Wait(PathBuf),
    /// Draws what the input before that file has changed.
    Heard,
    /// How many seconds the window may show nothing before the script gives up, 600 at most.
    Patience(f64),
    /// As the first step: saves the window's pixels while the field is read.
    Opening(PathBuf),
    /// A requested size, and its deadline.
    Resizing([u32; 2], Instant),
}

/// What a mouse button drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The active tool; by default it turns the view.
    Left,
    /// Moves the sun.
    Right,
    /// Moves the view.
    Middle,
}

/// Parses a file with one step per line; `#` begins a comment.
///
/// # Errors
/// A file that cannot be read, or an unknown line.
pub fn read(path: &Path) -> Result<Vec<Step>> {
    let text = std::fs::read_to_string(path).map_err(|source| Error::io(path, source))?;
    let mut steps = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        steps.push(step(line).ok_or_else(|| {
            let expected = "key, drag, wheel, frames, size, lose, picture, scene, screenshot, text, \
                command, places, shown, paths, preview, rest-preview, rest, report, wait, opening or patience, with its values";
            Error::file(path, format!("line {number}"), line, expected)
        })?);
    }
    Ok(steps)
}

fn step(line: &str) -> Option<Step> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let pair = |word: &str| {
        let (a, b) = word.split_once(',')?;
        Some([a.parse().ok()?, b.parse().ok()?])
    };
    let button = |word: &str| match word {
        "left" => Some(Button::Left),
        "right" => Some(Button::Right),
        "middle" => Some(Button::Middle),
        _ => None,
    };
    Some(match *words.as_slice() {
        ["key", name] => Step::Key(name.to_owned()),
        ["drag", by, from, way] => Step::Drag(button(by)?, pair(from)?, pair(way)?),
        ["wheel", notches, at] => Step::Wheel(notches.parse().ok()?, pair(at)?),
        ["frames", count] => Step::Frames(count.parse().ok()?),
        ["size", size] => Step::Size(pair(size)?.map(|v| v as u32)),
        ["lose"] => Step::Lose,
        ["preview"] => Step::Preview(None),
        ["preview", drag] => Step::Preview(Some((grids(drag)?, None))),
        ["preview", drag, rest] => Step::Preview(Some((grids(drag)?, Some(grids(rest)?)))),
        ["rest-preview"] => Step::RestPreview,
        ["rest"] => Step::Rest,
        ["picture", file] => Step::Picture(file.into()),
        ["scene", file] => Step::Scene(file.into()),
        ["screenshot", file] => Step::Screenshot(file.into()),
        ["text", file] => Step::Text(file.into()),
        ["command", file] => Step::Command(file.into()),
        ["places", file] => Step::Places(file.into()),
        ["shown", file, _, ..] => Step::Shown(file.into(), words[2..].join(" ")),
        ["paths", count] => Step::Paths(count.parse().ok()?),
        ["report", ..] => Step::Report(words[1..].join(" ")),
        ["wait", file] => Step::Wait(file.into()),
        ["opening", file] => Step::Opening(file.into()),
        ["patience", seconds] => {
            let seconds = seconds.parse().ok()?;
            Step::Patience((0.0..=600.0).contains(&seconds).then_some(seconds)?)
        }
        _ => return None,
    })
}

/// Sides of the blocks of sky, sun and slopes, of which the slopes are the finest.
fn grids(sides: &str) -> Option<[usize; 3]> {
    let sides: Vec<usize> = sides.split(',').map(|n| n.parse().ok()).collect::<Option<_>>()?;
    let &[sky, sun, slopes] = sides.as_slice() else { return None };
    (slopes > 0 && sky >= slopes && sun >= slopes).then_some([sky, sun, slopes])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_lines_are_refused_by_number() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("script");
        std::fs::write(&path, "# begin\nkey shift+left\n\ndrag right 1,2 -3,4 # sun\nsize 64,48\n")
            .unwrap();
        let steps = [
            Step::Key("shift+left".into()),
            Step::Drag(Button::Right, [1.0, 2.0], [-3.0, 4.0]),
            Step::Size([64, 48]),
        ];
        assert_eq!(read(&path).unwrap(), steps);
        std::fs::write(&path, "lose\njump\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("line 2: found jump"));
        std::fs::write(&path, "preview 4,1,2\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("found preview 4,1,2"));
        std::fs::write(&path, "patience nan\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("found patience nan"));
    }
}
