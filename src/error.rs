use std::fmt;
use std::path::{Path, PathBuf};

/// All errors. Each displays as one sentence: what is wrong, where, and what was expected. So does `Debug`, which a `main` that returns
/// the error prints.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Wrong content of a file.
    #[error("{}: {place}: found {found}, expected {expected}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The place inside the file: "header", "row 3, column 7", "tag 33550".
        place: String,
        /// The content found.
        found: String,
        /// The content expected.
        expected: String,
    },
    /// A file that could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A setting or an argument out of its range.
    #[error("{name}: found {found}, expected {expected}")]
    Setting {
        /// The setting, as "azimuths" or "cell_m". Other parts of a message name settings in backticks, as "`lines exact`".
        name: String,
        /// The value given.
        found: String,
        /// The accepted range or kind.
        expected: String,
    },
    /// A scene that exceeds the device or the memory budget.
    #[error("{what}: needs {needs}, the limit is {limit}")]
    Limit {
        /// What exceeds the limit.
        what: String,
        /// How much it needs.
        needs: String,
        /// The limit.
        limit: String,
    },
    /// An error of Vulkan or the driver.
    #[error("{doing}: {reason}")]
    Device {
        /// The operation that failed.
        doing: String,
        /// The answer of the driver or loader, or what the device lacks.
        reason: String,
    },
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error {
    /// An [`Error::File`].
    pub fn file(
        path: &Path,
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Error::File {
            path: path.to_owned(),
            place: place.into(),
            found: found.into(),
            expected: expected.into(),
        }
    }

    /// An [`Error::Io`] for `path`.
    pub fn io(path: &Path, source: std::io::Error) -> Self {
        Error::Io { path: path.to_owned(), source }
    }

    /// An [`Error::Setting`].
    pub fn setting(
        name: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Error::Setting { name: name.into(), found: found.into(), expected: expected.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_main_that_returns_an_error_prints_a_sentence() {
        let error = Error::setting("azimuths", "3", "4 to 1024");
        assert_eq!(format!("{error:?}"), "azimuths: found 3, expected 4 to 1024");
    }
}
