//! `examples/ash_host.rs`, whose first half docs/embedding.md shows, in a process of its own, so that its engine and
//! this one share nothing.

use std::path::Path;
use std::process::Command;

use ridgelight_io as files;

#[expect(dead_code, reason = "its main, which prints")]
#[path = "../../../examples/ash_host.rs"]
mod program;

/// Set in the child process that runs the program: the file for its texels.
const CHILD: &str = "RIDGELIGHT_ASH_HOST";

/// Bits of the same scene by the command line.
fn by_command_line(folder: &Path) -> Vec<u32> {
    let heights: Vec<f32> =
        (0..48 * 64).map(|i| ((i / 64 * 31 + i % 64 * 17) % 7) as f32 - 3.0).collect();
    files::write_npy_f32(&folder.join("field.npy"), &[48, 64], [&heights[..]]).expect("a field");
    let done = Command::new(crate::program())
        .current_dir(folder)
        .args("render field.npy --sky 0.5 --sun 90,30,0.5,3 --quiet -o lit.exr".split(' '))
        .output()
        .expect("the binary");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let lit = files::read_planes(&folder.join("lit.exr")).expect("a picture");
    let red = lit.names.iter().position(|name| name == "R").expect("a channel R");
    lit.planes[red].iter().map(|v| v.to_bits()).collect()
}

#[test]
fn the_ash_host_gives_the_command_lines_bytes() {
    if let Some(path) = std::env::var_os(CHILD) {
        let lit = program::lit(2).expect("light");
        std::fs::write(path, bytemuck::cast_slice(&lit)).expect("a file");
        return;
    }
    let mut blocks = include_str!("../../../docs/embedding.md").split("```");
    let snippet = blocks.find(|block| block.starts_with("rust")).expect("a snippet");
    let shown = snippet.split_once('\n').expect("its lines").1.trim_end();
    let program = include_str!("../../../examples/ash_host.rs");
    assert!(program.contains(shown), "docs/embedding.md shows another program");

    let folder = tempfile::tempdir().expect("a folder");
    let texels = folder.path().join("texels");
    let mut child = Command::new(std::env::current_exe().expect("this test"));
    child.args([
        "--exact",
        "embedding::ash_host::the_ash_host_gives_the_command_lines_bytes",
        "--nocapture",
    ]);
    child.env(CHILD, &texels);
    let is_validated = std::env::var_os("RIDGELIGHT_VALIDATION").is_some_and(|v| v == "1");
    if is_validated {
        child
            .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
            .env("VK_LOADER_DEBUG", "layer");
    }
    let run = child.output().expect("this test again");
    let said = [run.stdout, run.stderr].map(|s| String::from_utf8_lossy(&s).into_owned()).concat();
    assert!(run.status.success(), "{said}");
    // Without a messenger the layer prints its messages; the loader prints that the layer is loaded.
    assert_eq!(said.contains("VK_LAYER_KHRONOS_validation"), is_validated, "{said}");
    assert!(!said.contains("VUID") && !said.contains("SYNC-HAZARD"), "{said}");
    let bytes = std::fs::read(texels).expect("texels");
    let bits: Vec<u32> =
        bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
    assert!(bits == by_command_line(folder.path()), "other light than the command line's");
    assert!(bits.iter().any(|b| *b != bits[0]), "light that differs");
}
