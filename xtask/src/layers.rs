//! Crates, modules of the core and rooms of its passes, with what each imports.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::source::{FILES, Outcome, after, code, crowded, files, read};

/// Modules of the core, lowest first: each imports only what stands before it.
const MODULES: [&str; 7] = ["error", "basis", "scene", "graph", "passes", "plan", "gpu"];
/// Crates, lowest first: each depends only on what stands before it.
const CRATES: [&str; 9] = [
    "ridgelight",
    "ridgelight-cpu",
    "ridgelight-io",
    "ridgelight-bake",
    "ridgelight-trade",
    "ridgelight-testing",
    "ridgelight-viewer",
    "ridgelight-cli",
    "ridgelight-capi",
];

/// Rooms of the core's passes, lowest first.
const ROOMS: [&str; 11] = [
    "device",
    "rays",
    "horizon",
    "edit",
    "sh",
    "specular",
    "direct",
    "bounce",
    "bake",
    "reference",
    "view",
];

/// What each node imports, and how often.
type Arrows = BTreeMap<String, BTreeMap<String, usize>>;

const PAGE: &str = "docs/architecture.md";
const MARKS: [&str; 2] = ["<!-- begin layers -->\n", "<!-- end layers -->"];

/// Prints every layer with its arrows and their counts, and writes the arrows into the page.
pub fn print(root: &Path) -> Outcome {
    let [before, _, after] = page(root)?;
    let text = [before, fenced(&arrows(root, false)?), after].concat();
    fs::write(root.join(PAGE), text).map_err(|e| format!("{PAGE}: {e}"))?;
    arrows(root, true)
}

fn arrows(root: &Path, is_counted: bool) -> Outcome {
    let mut text = String::new();
    for (what, names, arrows) in [
        ("crates", &CRATES[..], crates(root)?),
        ("modules of ridgelight", &MODULES[..], modules(root)?),
        ("rooms of passes", &ROOMS[..], rooms(root)?),
    ] {
        writeln!(text, "{what}, lowest first").expect("to a string");
        for name in names {
            let used = listed(arrows.get(*name), is_counted && what != "crates");
            writeln!(text, "  {name:<20} {used}").expect("to a string");
        }
    }
    Ok(text)
}

/// The page before, between and after its marks.
fn page(root: &Path) -> Result<[String; 3], String> {
    let text = read(&root.join(PAGE))?;
    let parts = text.split_once(MARKS[0]).and_then(|(before, rest)| {
        let (kept, after) = rest.split_once(MARKS[1])?;
        Some([format!("{before}{}", MARKS[0]), kept.to_owned(), format!("{}{after}", MARKS[1])])
    });
    parts.ok_or_else(|| format!("{PAGE}: no marks {MARKS:?}"))
}

fn fenced(text: &str) -> String {
    format!("```text\n{text}```\n")
}

/// Fails on an import or a dependency that points upward, which every circle has, and on a folder with many files.
pub fn check(root: &Path) -> Outcome {
    let many = crowded(root)?;
    if !many.is_empty() {
        return Err(format!("layers: folders with more than {FILES} files: {}", many.join(", ")));
    }
    let mut wrong = upward(&CRATES, &crates(root)?);
    wrong.extend(upward(&MODULES, &modules(root)?));
    wrong.extend(upward(&ROOMS, &rooms(root)?));
    if wrong.is_empty() && page(root)?[1] != fenced(&arrows(root, false)?) {
        return Err(format!("layers: {PAGE} is out of date; cargo xtask layers writes it"));
    }
    if wrong.is_empty() {
        return Ok(format!(
            "layers: no circle, no import that points upward, no folder with more than {FILES} files\n"
        ));
    }
    Err(format!("layers: imports that point upward:\n  {}", wrong.join("\n  ")))
}

fn listed(used: Option<&BTreeMap<String, usize>>, is_counted: bool) -> String {
    let used = used.into_iter().flatten().map(|(name, count)| match is_counted {
        true => format!("{name} {count}"),
        false => name.clone(),
    });
    let all: Vec<_> = used.collect();
    if all.is_empty() { "-".to_owned() } else { format!("-> {}", all.join(", ")) }
}

/// Arrows from a name to one that does not stand before it. A name that is not listed is wrong, too.
fn upward(order: &[&str], arrows: &Arrows) -> Vec<String> {
    let place = |name: &str| order.iter().position(|known| *known == name);
    let mut wrong = Vec::new();
    for (from, used) in arrows {
        if place(from).is_none() {
            wrong.push(format!("{from} has no place in the order"));
            continue;
        }
        for (to, count) in used {
            if to != from && place(to) >= place(from) {
                wrong.push(format!("{from} -> {to} ({count} times)"));
            }
        }
    }
    wrong
}

/// Dependencies between the workspace's crates, without those of tests.
fn crates(root: &Path) -> Result<Arrows, String> {
    let mut manifests = vec![root.join("Cargo.toml")];
    let folder = root.join("crates");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    manifests.extend(entries.flatten().map(|entry| entry.path().join("Cargo.toml")));
    let mut arrows = Arrows::new();
    for path in manifests.iter().filter(|path| path.exists()) {
        let text = read(path)?;
        let (mut section, mut name, mut used) = ("", String::new(), BTreeMap::new());
        for line in text.lines().map(str::trim) {
            if line.starts_with('[') {
                section = line;
            } else if let Some(value) =
                line.strip_prefix("name = ").filter(|_| section == "[package]")
            {
                name = value.trim_matches('"').to_owned();
            } else if section == "[dependencies]" && line.starts_with("ridgelight") {
                let end = line.find(['.', ' ', '=']).unwrap_or(line.len());
                used.insert(line[..end].to_owned(), 1);
            }
        }
        arrows.insert(name, used);
    }
    Ok(arrows)
}

/// Imports between the core's modules.
fn modules(root: &Path) -> Result<Arrows, String> {
    let src = root.join("src");
    let mut arrows = Arrows::new();
    for path in files(&src, &["rs"]) {
        let inside = path.strip_prefix(&src).expect("below it");
        let first = inside.iter().next().expect("a file").to_string_lossy();
        let module = first.trim_end_matches(".rs").to_owned();
        if module == "lib" || inside.ends_with("tests.rs") {
            continue;
        }
        let used = arrows.entry(module.clone()).or_default();
        let known: BTreeSet<&str> = MODULES.into_iter().collect();
        for name in after(&code(&read(&path)?), "crate::") {
            if name != module && (known.contains(name.as_str()) || src.join(&name).is_dir()) {
                *used.entry(name).or_default() += 1;
            }
        }
    }
    Ok(arrows)
}

/// What the rooms of passes take from each other.
fn rooms(root: &Path) -> Result<Arrows, String> {
    let passes = root.join("src/passes");
    let all = files(&passes, &["rs"]);
    let mut room_of = BTreeMap::new();
    for path in &all {
        let inside = path.strip_prefix(&passes).expect("below it");
        let names: Vec<_> = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if let [room, file, ..] = names.as_slice() {
            room_of.insert(file.trim_end_matches(".rs").to_owned(), room.clone());
        }
    }
    let mut arrows = Arrows::new();
    for path in &all {
        let inside = path.strip_prefix(&passes).expect("below it");
        let room = inside.iter().next().expect("a file").to_string_lossy().into_owned();
        if !passes.join(&room).is_dir() {
            continue;
        }
        let used = arrows.entry(room.clone()).or_default();
        for name in after(&code(&read(path)?), "crate::passes::") {
            let target = room_of.get(&name).unwrap_or(&name);
            if *target != room && passes.join(target).is_dir() {
                *used.entry(target.clone()).or_default() += 1;
            }
        }
    }
    Ok(arrows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::root;

    #[test]
    fn no_import_points_upward() {
        check(root()).unwrap();
        // Something was read at all.
        let all = modules(root()).unwrap();
        assert!(all["plan"]["passes"] > 10 && all["gpu"].contains_key("plan"), "{all:?}");
        assert!(crates(root()).unwrap()["ridgelight-cli"].contains_key("ridgelight-io"));
    }

    #[test]
    fn an_import_that_points_upward_is_found() {
        let arrow = |from: &str, to: &str| {
            Arrows::from([(from.to_owned(), BTreeMap::from([(to.to_owned(), 1)]))])
        };
        assert!(upward(&MODULES, &arrow("plan", "passes")).is_empty());
        assert_eq!(upward(&MODULES, &arrow("passes", "plan")), ["passes -> plan (1 times)"]);
        assert_eq!(upward(&MODULES, &arrow("fresh", "plan")).len(), 1);
        assert_eq!(upward(&CRATES, &arrow("ridgelight-cpu", "ridgelight-io")).len(), 1);
    }
}
