//! What a user would do, from a file: for tests.

use std::path::{Path, PathBuf};
use std::time::Instant;

use ridgelight::{Error, Result};

/// One step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A key by its name, as [`State::key`](super::state::State::key) takes it.
    Key(String),
    /// A drag by a button: from where, by how much, pixels.
    Drag(Button, [f64; 2], [f64; 2]),
    /// Notches of the wheel, upwards, and where.
    Wheel(f64, [f64; 2]),
    /// So many frames are drawn.
    Frames(u32),
    /// The window's columns and rows; goes on when pictures have them.
    Size([u32; 2]),
    /// The window's surface is thrown away, as if it had been lost.
    Lose,
    Picture(PathBuf),
    Scene(PathBuf),
    /// The window's pixels.
    Screenshot(PathBuf),
    /// The text over them.
    Text(PathBuf),
    /// Frames are drawn until the reference beside has so many paths a sample.
    Paths(u32),
    /// Frames so far, and milliseconds of each since the last report; after some words.
    Report(String),
    /// Input is awaited until such a file exists, as without a script.
    Wait(PathBuf),
    /// Input that came before that file has been heard: it is drawn.
    Heard,
    /// How many seconds the window may show nothing, 600 at most, before the script gives up.
    Patience(f64),
    /// A size that has been asked for, and until when it may come.
    Resizing([u32; 2], Instant),
}

/// A mouse button's work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// What the tool at hand does: turns the view.
    Left,
    /// Moves the sun.
    Right,
    /// Moves the view.
    Middle,
}

/// Steps of a file, one a line; `#` begins a comment.
///
/// # Errors
/// A file that cannot be read, a line that is none of them.
pub fn read(path: &Path) -> Result<Vec<Step>> {
    let io = |source| Error::Io { path: path.to_owned(), source };
    let text = std::fs::read_to_string(path).map_err(io)?;
    let mut steps = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        steps.push(step(line).ok_or_else(|| {
            Error::File {
                path: path.to_owned(),
                place: format!("line {number}"),
                found: line.to_owned(),
                expected:
                    "key, drag, wheel, frames, size, lose, picture, scene, screenshot, text, paths, \
                       report, wait or patience, and what belongs to it"
                        .into(),
            }
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
        ["picture", file] => Step::Picture(file.into()),
        ["scene", file] => Step::Scene(file.into()),
        ["screenshot", file] => Step::Screenshot(file.into()),
        ["text", file] => Step::Text(file.into()),
        ["paths", count] => Step::Paths(count.parse().ok()?),
        ["report", ..] => Step::Report(words[1..].join(" ")),
        ["wait", file] => Step::Wait(file.into()),
        ["patience", seconds] => {
            let seconds = seconds.parse().ok()?;
            Step::Patience((0.0..=600.0).contains(&seconds).then_some(seconds)?)
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_steps_and_others_are_told_by_number() {
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
        std::fs::write(&path, "patience nan\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("found patience nan"));
    }
}
