//! `cargo xtask install --prefix DIR`: the program, the C library and what CMake and pkg-config look for.

use std::fs;
use std::path::Path;

/// Where each file goes. Those of the build come from target/release.
const BUILT: [(&str, &str); 3] =
    [("ridgelight", "bin"), ("libridgelight_c.so", "lib"), ("libridgelight_c.a", "lib")];
const KEPT: [(&str, &str); 4] = [
    ("include/ridgelight.h", "include"),
    ("include/ridgelight.hpp", "include"),
    ("packaging/ridgelight-config.cmake", "lib/cmake/ridgelight"),
    ("packaging/ridgelight.pc", "lib/pkgconfig"),
];

/// Builds the release profile and copies its files, and lists them.
pub fn install(root: &Path, prefix: &Path) -> Result<String, String> {
    let packages = ["--package", "ridgelight-cli", "--package", "ridgelight-capi"];
    crate::cargo(root, &[&["build", "--release", "--locked"], packages.as_slice()].concat())?;
    let release = crate::target(root).join("release");
    let capi = root.join("crates/capi");
    let built = BUILT.iter().map(|(file, folder)| (release.join(file), folder));
    let kept = KEPT.iter().map(|(file, folder)| (capi.join(file), folder));
    let mut text = String::new();
    for (from, folder) in built.chain(kept) {
        let folder = prefix.join(folder);
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let to = folder.join(from.file_name().expect("a file"));
        // A library in use keeps its old file.
        let new = to.with_extension("new");
        fs::copy(&from, &new).map_err(|e| format!("{}: {e}", from.display()))?;
        fs::rename(&new, &to).map_err(|e| format!("{}: {e}", to.display()))?;
        text += &format!("{}\n", to.display());
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    /// pkg-config gives the version of the library.
    #[test]
    fn the_kept_version_is_this_one() {
        let kept = include_str!("../../crates/capi/packaging/ridgelight.pc");
        let version = kept.lines().find_map(|line| line.strip_prefix("Version: "));
        assert_eq!(version, Some(env!("CARGO_PKG_VERSION")));
    }
}
