use std::path::{Path, PathBuf};

/// Everything that can go wrong, each as one sentence for the person who has to act on it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file that does not hold what it should: where in it, what was there, what belongs there.
    #[error("{}: {place}: found {found}, expected {expected}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The place inside the file: "header", "row 3, column 7", "tag 33550".
        place: String,
        /// What is there.
        found: String,
        /// What belongs there.
        expected: String,
    },
    /// A file that could not be read or written at all.
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
        /// The setting as its user wrote it: "--azimuths", "cell_m".
        name: String,
        /// The value given.
        found: String,
        /// The range or the kind of value that is accepted.
        expected: String,
    },
    /// A scene that this device, or this memory budget, cannot hold.
    #[error("{what}: needs {needs}, the limit is {limit}")]
    Limit {
        /// What asks for it.
        what: String,
        /// How much it needs.
        needs: String,
        /// How much there is.
        limit: String,
    },
    /// Vulkan, or the driver behind it, said no.
    #[error("{doing}: {reason}")]
    Device {
        /// What was being done.
        doing: String,
        /// What the driver, the loader or the device lacks or answered.
        reason: String,
    },
}

impl Error {
    /// A [`Error::File`] from its four parts.
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

    /// A [`Error::Io`] for `path`.
    pub fn io(path: &Path, source: std::io::Error) -> Self {
        Error::Io { path: path.to_owned(), source }
    }

    /// A [`Error::Setting`] from its three parts.
    pub fn setting(
        name: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Error::Setting { name: name.into(), found: found.into(), expected: expected.into() }
    }
}
