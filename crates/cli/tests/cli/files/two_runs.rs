//! Two runs of each command that writes files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::Folder;

/// 7 columns and 5 rows in UTM zone 33 north: see tests/files/gdal/write.sh.
const UTM: &[u8] = include_bytes!("../../../../../tests/files/gdal/utm.tif");

/// A command without its output, and outputs. They cover each command that writes files, each type of file and each format
/// of `bake`. `bench`, `trade`, `tune` and the `--json` of runs are left out: their files contain times.
const COMMANDS: &[(&str, &[&str])] = &[
    (
        "render utm.tif --sky 0.5 --sun 200,30 --azimuths 8 --layers lights,sky-view,horizon -o",
        &["render.tif", "render.exr"],
    ),
    ("render utm.tif --sky 0.5 --sun 200,30 --azimuths 8 -o", &["render.png"]),
    ("render utm.tif --azimuths 8 --camera south --size 32x18 -o", &["camera.png", "camera.exr"]),
    ("horizon utm.tif --azimuths 8 -o", &["horizon.tif", "horizon.exr"]),
    ("horizon utm.tif --azimuths 8 --distances distances.npy -o", &["horizon.npy"]),
    ("horizon utm.tif --azimuths 4 -o", &["stellarium.png"]),
    ("horizon utm.tif --azimuths 8 --fourier 4,100 -o", &["fourier.ktx2"]),
    ("hillshade utm.tif -o", &["hillshade.tif", "hillshade.exr", "hillshade.npy", "hillshade.png"]),
    ("hillshade utm.tif --sun 100,20 -o", &["other_sun.npy"]),
    ("shadow utm.tif --sun 200,30 -o", &["shadow.tif", "shadow.png"]),
    ("ao utm.tif --azimuths 8 -o", &["ao.npy", "ao.png"]),
    ("svf utm.tif --azimuths 8 -o", &["svf.exr"]),
    ("openness utm.tif --azimuths 8 -o", &["openness.tif"]),
    ("openness utm.tif --azimuths 8 --negative -o", &["negative.png"]),
    ("reference utm.tif --spp 128 -o", &["reference.tif", "reference.exr"]),
    (
        "compare hillshade.npy other_sun.npy --diff",
        &["difference.exr", "difference.npy", "difference.tif"],
    ),
    ("info utm.tif --json", &["info.json"]),
    (
        "bake utm.tif --what horizon,bent-normal,ellipse,scatter --directions 16 --azimuths 8 \
            --paths 8 --method sweep --format exr,npy,ktx2,tif -o",
        &["maps"],
    ),
    (
        "bake utm.tif --what horizon,sky-view,visible-sky,bent-normal --azimuths 4 \
            --format png,dds -o",
        &["textures"],
    ),
    (
        "bake utm.tif --what horizon,sky-view,bent-normal,scatter --albedo 0.5 --azimuths 4 \
            --directions 16 --paths 8 --compress --mips --format ktx2,dds -o",
        &["blocks"],
    ),
    ("bake utm.tif --what sh-visibility,sh-transfer --sh-order 2 --azimuths 8 -o", &["harmonics"]),
    ("bake utm.tif --what brdf --border periodic --angles 2x4 --bounces 0 -o", &["far_field"]),
];

/// Every file that the commands write in a new folder.
fn written() -> BTreeMap<PathBuf, Vec<u8>> {
    let folder = Folder::new();
    folder.write("utm.tif", UTM);
    let before = folder.contents();
    for (command, outputs) in COMMANDS {
        for output in *outputs {
            let run = folder.run_str(&format!("{command} {output}"));
            assert_eq!(run.status, Some(0), "{command} {output}: {}", run.err);
            assert!(folder.path(output).exists(), "{command} {output}");
        }
    }
    let root = folder.path("");
    let mut files = BTreeMap::new();
    for (path, bytes) in folder.contents() {
        let name = path.strip_prefix(&root).unwrap();
        // The folder of XDG_CACHE_HOME holds no outputs.
        let is_output = !before.contains_key(&path) && !name.starts_with("cache");
        if let Some(bytes) = bytes.filter(|_| is_output) {
            files.insert(name.to_owned(), bytes);
        }
    }
    files
}

/// Files name the input, the settings, the commit and the device, but no time, process or folder.
#[test]
fn gpu_two_runs_write_the_same_bytes() {
    let [first, second] = [written(), written()];
    assert!(first.keys().eq(second.keys()), "{:?} and {:?}", first.keys(), second.keys());
    let differing = first.iter().filter(|(path, bytes)| second[*path] != **bytes);
    let names: Vec<_> = differing.map(|(path, _)| path).collect();
    assert!(names.is_empty(), "{names:?}");
    // Other settings write other bytes.
    let of = |name: &str| &first[Path::new(name)];
    assert!(of("hillshade.npy") != of("other_sun.npy"));
    // The types of docs/command-line.md and docs/baking.md.
    let types = first.keys().filter_map(|path| path.extension()?.to_str());
    let all = ["dds", "exr", "glsl", "json", "ktx2", "npy", "pgw", "png", "tif", "xml"];
    assert_eq!(types.collect::<BTreeSet<_>>(), BTreeSet::from(all));
}
