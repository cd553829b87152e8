//! Reads earlier reports of `bench --json`.

use std::path::{Path, PathBuf};

use ridgelight::{Error, Result};
use serde::Deserialize;
use serde_json::Value;

/// Earlier reports of one device and one scene, at least one.
pub struct Earlier(pub Vec<Report>);

#[derive(Deserialize)]
pub struct Report {
    pub device: String,
    pub driver: String,
    #[serde(default)]
    pub commit: String,
    /// Hashes by part; none in reports of earlier versions.
    scene: Option<Value>,
    #[serde(default)]
    pub peaks: Vec<EarlierRow>,
    pub rows: Vec<EarlierRow>,
}

#[derive(Deserialize)]
pub struct EarlierRow {
    pass: String,
    #[serde(default)]
    part: String,
    mode: String,
    cols: u32,
    rows: u32,
    azimuths: u32,
    pub settings: serde_json::Map<String, Value>,
    pub median_ns: Option<f64>,
    pub p10_ns: Option<f64>,
    pub p90_ns: Option<f64>,
    pub median_low_ns: Option<f64>,
    pub median_high_ns: Option<f64>,
    #[serde(default)]
    pub bytes: u64,
}

/// Pass and part, mode, columns and rows, azimuths.
pub type Key<'a> = ((&'a str, &'a str), &'a str, [u32; 2], u32);

impl EarlierRow {
    pub fn key(&self) -> Key<'_> {
        ((&self.pass, &self.part), &self.mode, [self.cols, self.rows], self.azimuths)
    }
}

impl Report {
    /// # Errors
    /// A file that cannot be read, or is no report of `bench --json`.
    fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|e| Error::io(path, e))?;
        serde_json::from_slice(&text).map_err(|e| {
            let place = format!("line {}, column {}", e.line(), e.column());
            Error::file(path, place, e.to_string(), "a report of bench --json")
        })
    }

    /// The parts of the scene that differ in this report; none if it does not state its scene.
    fn other_parts(&self, scene: &Value) -> Vec<&'static str> {
        let mut parts = vec!["field", "lights", "surface"];
        parts.retain(|part| self.scene.as_ref().is_some_and(|then| then[*part] != scene[*part]));
        parts
    }
}

impl Earlier {
    /// Reads the reports, before anything is timed. Returns none without paths.
    ///
    /// # Errors
    /// A file that cannot be read, or is no report of `bench --json`; one of another device than the last file, or of
    /// another scene than this run.
    pub fn read_all(paths: &[PathBuf], scene: &Value) -> Result<Option<Self>> {
        let twice = paths.iter().enumerate().find(|(i, path)| paths[..*i].contains(path));
        if let Some((_, path)) = twice {
            let expected = "each report once: they show how much processes differ";
            return Err(Error::setting("--against", format!("{} twice", path.display()), expected));
        }
        let reports = paths.iter().map(|path| Report::read(path)).collect::<Result<Vec<_>>>()?;
        let Some(last) = reports.last() else { return Ok(None) };
        for (report, path) in reports.iter().zip(paths) {
            if report.device != last.device {
                let expected = format!("{}, as in the last file", last.device);
                return Err(Error::file(path, "device", &report.device, expected));
            }
            let parts = report.other_parts(scene);
            if !parts.is_empty() {
                let found = format!("another scene, with different {}", parts.join(" and "));
                let expected = "the field, lights and surface of this run";
                return Err(Error::file(path, "scene", found, expected));
            }
        }
        Ok(Some(Self(reports)))
    }

    pub fn last(&self) -> &Report {
        self.0.last().expect("at least one")
    }

    /// "2 earlier reports of commit 1a2b3c4d", with every commit once.
    pub fn text(&self) -> String {
        let mut commits: Vec<&str> = Vec::new();
        for Report { commit, .. } in &self.0 {
            if !commit.is_empty() && !commits.contains(&&**commit) {
                commits.push(commit);
            }
        }
        let reports = match self.0.len() {
            1 => "1 earlier report".to_owned(),
            count => format!("{count} earlier reports"),
        };
        match &commits[..] {
            [] => reports,
            [one] => format!("{reports} of commit {one}"),
            all => format!("{reports} of commits {}", all.join(", ")),
        }
    }

    /// Refuses a run of these columns, rows and azimuths if no report has a row of any of them.
    ///
    /// # Errors
    /// As above; the error lists what the reports of these paths have.
    pub fn check_any(&self, paths: &[PathBuf], wanted: &[([u32; 2], u32)]) -> Result<()> {
        let text = |all: &[([u32; 2], u32)]| {
            let of = |([cols, rows], azimuths): &([u32; 2], u32)| {
                format!("{cols}x{rows} texels with {azimuths} azimuths")
            };
            all.iter().map(of).collect::<Vec<_>>().join(", ")
        };
        let of = |row: &EarlierRow| ([row.cols, row.rows], row.azimuths);
        if self.0.iter().flat_map(|report| &report.rows).any(|row| wanted.contains(&of(row))) {
            return Ok(());
        }
        let mut has: Vec<_> = self.0.iter().flat_map(|report| &report.rows).map(of).collect();
        has.sort_unstable();
        has.dedup();
        let files: Vec<_> = paths.iter().map(|path| path.display().to_string()).collect();
        let found = format!("{} in {}", text(&has), files.join(", "));
        Err(Error::setting("--against", found, text(wanted)))
    }

    /// Whether a report does not state its scene.
    pub fn has_unknown_scene(&self) -> bool {
        self.0.iter().any(|report| report.scene.is_none())
    }

    /// This row in every report that has it, in their order.
    pub fn same(&self, key: Key<'_>, rows: fn(&Report) -> &[EarlierRow]) -> Vec<&EarlierRow> {
        let of = |report| rows(report).iter().find(|row| row.key() == key);
        self.0.iter().filter_map(of).collect()
    }
}

/// The least and the largest value of `number` over these rows; none if a row lacks it.
pub fn range(rows: &[&EarlierRow], number: fn(&EarlierRow) -> Option<f64>) -> Option<[f64; 2]> {
    let all: Vec<f64> = rows.iter().map(|row| number(row)).collect::<Option<_>>()?;
    let [least, most] = [f64::min, f64::max].map(|end| all.iter().copied().reduce(end));
    Some([least?, most?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::rows;
    use serde_json::json;

    fn written(folder: &Path, name: &str, change: impl Fn(&mut Value)) -> PathBuf {
        let mut report = rows::file("d", "v", &[], &[], &[]);
        change(&mut report);
        let path = folder.join(name);
        std::fs::write(&path, report.to_string()).unwrap();
        path
    }

    #[test]
    fn reports_of_different_devices_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|device| {
            written(folder.path(), device, |report| report["device"] = device.into())
        });
        let message = Earlier::read_all(&paths, &Value::Null).err().unwrap().to_string();
        assert!(message.contains("device: found a, expected b"), "{message}");
    }

    /// A report without a scene is compared, but counts as unknown.
    #[test]
    fn reports_of_another_scene_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let scene = |lights: &str| json!({ "field": "fractal", "lights": lights, "surface": "0" });
        let [same, other] = ["1", "2"]
            .map(|lights| written(folder.path(), lights, |report| report["scene"] = scene(lights)));
        let old = written(folder.path(), "old", |_| {});
        let read = |paths: &[&PathBuf]| {
            let paths: Vec<PathBuf> = paths.iter().copied().cloned().collect();
            Earlier::read_all(&paths, &scene("1")).map(|earlier| earlier.unwrap())
        };
        assert!(!read(&[&same]).unwrap().has_unknown_scene());
        assert!(read(&[&old, &same]).unwrap().has_unknown_scene());
        let message = read(&[&other, &same]).err().unwrap().to_string();
        let expected =
            format!("{}: scene: found another scene, with different lights", other.display());
        assert!(message.contains(&expected), "{message}");
    }

    #[test]
    fn what_is_no_report_is_refused_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("times.json");
        std::fs::write(&path, "{\n  \"device\": 1\n}").unwrap();
        let message = Report::read(&path).err().unwrap().to_string();
        assert!(
            message.contains("line 2") && message.contains("a report of bench --json"),
            "{message}"
        );
        assert!(Report::read(&folder.path().join("none.json")).is_err());
        assert!(Earlier::read_all(&[], &Value::Null).unwrap().is_none());
    }
}
