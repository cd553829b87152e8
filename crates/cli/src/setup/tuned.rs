//! The form of the sweep that `ridgelight tune` found for a device, in the user's cache.

use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};

use ridgelight::gpu::DeviceReport;
use ridgelight::plan::{Limits, SweepForm};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use serde_json::{Value, json};

use crate::bench::tune;

/// The folder for caches, as the user's system names it.
pub fn caches() -> Option<PathBuf> {
    let var = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|p| p.is_absolute());
    let folder = var("XDG_CACHE_HOME").or_else(|| var("HOME").map(|home| home.join(".cache")));
    Some(folder?.join("ridgelight"))
}

/// Hashes this program's version and commit, and a device with its driver.
pub fn hash(device: &DeviceReport) -> DefaultHasher {
    let mut hash = DefaultHasher::new();
    for text in [env!("CARGO_PKG_VERSION"), env!("RIDGELIGHT_COMMIT"), &device.name, &device.driver]
    {
        hash.write(text.as_bytes());
        hash.write_u8(0);
    }
    hash
}

fn place(device: &DeviceReport) -> Option<PathBuf> {
    Some(caches()?.join(format!("tuned/{:016x}.json", hash(device).finish())))
}

/// A form; `azimuths` is null where all azimuths are swept together.
pub fn json(form: &SweepForm) -> Value {
    json!({
        "lines_each": form.lines_each, "group_size": form.group_size, "shares_hull": form.shares_hull,
        "hull_depth": form.hull_depth, "private_depth": form.private_depth,
        "azimuths": (form.azimuths != u32::MAX).then_some(form.azimuths),
    })
}

/// The form that [`json`] wrote; none for other JSON.
fn read(kept: &Value) -> Option<SweepForm> {
    let number = |key: &str| kept[key].as_u64().and_then(|n| u32::try_from(n).ok());
    Some(SweepForm {
        lines_each: number("lines_each")?,
        group_size: number("group_size")?,
        shares_hull: kept["shares_hull"].as_bool()?,
        hull_depth: number("hull_depth")?,
        private_depth: number("private_depth")?,
        azimuths: if kept["azimuths"].is_null() { u32::MAX } else { number("azimuths")? },
    })
}

/// A device's limits, with the form of an earlier `tune` and the user's memory budget.
pub fn limits(device: &DeviceReport, memory_budget: Option<u64>) -> Limits {
    let sweep = find(device).unwrap_or(device.limits.sweep);
    let memory_budget = memory_budget.unwrap_or(device.limits.memory_budget);
    Limits { sweep, memory_budget, ..device.limits }
}

/// The form of an earlier `tune`. A file that cannot be read, or with a form that `tune` does not try, is none.
fn find(device: &DeviceReport) -> Option<SweepForm> {
    let kept: Value = serde_json::from_slice(&std::fs::read(place(device)?).ok()?).ok()?;
    let form = read(&kept)?;
    tune::is_tried(form, device.limits.sweep).then_some(form)
}

/// Keeps a form for later commands.
///
/// # Errors
/// A folder that cannot be written to, or none for caches.
pub fn keep(device: &DeviceReport, form: &SweepForm) -> Result<()> {
    let Some(path) = place(device) else {
        let expected = "an absolute path in XDG_CACHE_HOME or HOME";
        return Err(Error::setting("XDG_CACHE_HOME", "none, and no HOME", expected));
    };
    write(&path, &json(form))
}

/// Writes a file of the cache, whose folder may be missing.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write(path: &Path, value: &Value) -> Result<()> {
    let folder = path.parent().expect("it was joined");
    std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
    files::write_json(path, value)
}

/// Forgets the form of an earlier `tune`; whether there was one.
///
/// # Errors
/// A file that cannot be removed.
pub fn forget(device: &DeviceReport) -> Result<bool> {
    let Some(path) = place(device) else { return Ok(false) };
    match std::fs::remove_file(&path) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(Error::io(&path, error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All azimuths together are null and no number; both are read back.
    #[test]
    fn a_form_is_read_back() {
        let untuned = Limits::lavapipe().sweep;
        for azimuths in [u32::MAX, 16] {
            let form = SweepForm { azimuths, ..untuned };
            let json = json(&form);
            assert_eq!(json["azimuths"].as_u64(), (azimuths == 16).then_some(16), "{json}");
            assert_eq!(read(&json).map(|form| form.azimuths), Some(azimuths));
            assert!(json.get("azimuths").is_some() && read(&json!({})).is_none());
        }
    }
}
