//! The C ABI: its header, its symbols, and programs in C.

mod abi;
mod counterparts;
mod inputs;
#[path = "../../../../tests/common/target.rs"]
mod target;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use ridgelight::plan;
use ridgelight::scene::{HeightField, Sun};
use ridgelight_io as files;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A library that was built with this test: beside it.
fn library(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("this test");
    let found = test.with_file_name(name);
    assert!(found.exists(), "{} is not there: cargo build -p ridgelight-capi", found.display());
    found
}

fn run(command: &mut Command) -> (Output, String) {
    let done = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let output = [&done.stdout, &done.stderr].map(|s| String::from_utf8_lossy(s).into_owned());
    (done, output.concat())
}

/// `RIDGELIGHT_BLESS=1` writes it.
#[test]
fn the_header_is_what_the_source_says() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let config =
        cbindgen::Config::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("cbindgen.toml"));
    let mut builder = cbindgen::Builder::new().with_config(config.expect("cbindgen.toml"));
    for file in
        ["errors", "types", "allocator", "scene", "quality", "plan", "renderer", "view", "voids"]
    {
        builder = builder.with_src(source.join(file).with_extension("rs"));
    }
    let mut made = Vec::new();
    builder.generate().expect("a header").write(&mut made);
    let made = String::from_utf8(made).expect("text");
    let path = Path::new(ROOT).join("crates/capi/include/ridgelight.h");
    if std::env::var_os("RIDGELIGHT_BLESS").is_some() {
        std::fs::write(&path, &made).expect("written");
    }
    let kept = std::fs::read_to_string(&path).expect("crates/capi/include/ridgelight.h");
    assert!(kept == made, "include/ridgelight.h is another: RIDGELIGHT_BLESS=1 writes it");
    let mut cpp = Command::new("c++");
    cpp.args(["-x", "c++", "-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]);
    let (done, output) = run(cpp.args(["-include"]).arg(&path).arg("/dev/null"));
    assert!(done.status.success(), "{output}");
}

/// The one block of a language on a page of docs/.
fn block(page: &str, language: &str) -> String {
    let text = std::fs::read_to_string(Path::new(ROOT).join("docs").join(page)).expect(page);
    let begin = format!("\n```{language}\n");
    let blocks: Vec<&str> =
        text.split(begin.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 1, "{page}");
    blocks[0].to_owned()
}

/// Whether a compiler for a standard accepts a source, and its messages.
fn accepted([compiler, standard, ending]: [&str; 3], source: &str) -> (bool, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page").with_extension(ending);
    std::fs::write(&file, source).expect("written");
    let mut command = Command::new(compiler);
    command.args([standard, "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I"]);
    let (done, output) = run(command.arg(Path::new(ROOT).join("crates/capi/include")).arg(&file));
    (done.status.success(), output)
}

/// The C of the pages compiles, in a function that has its variables, and the C++ by itself.
#[test]
fn the_c_of_the_pages_compiles() {
    const ENGINE: &str = "#include <vulkan/vulkan.h>\n#include <ridgelight.h>\n\
        void engine(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device, uint32_t family,\n\
        VkImage heights_image, VkImageView heights_view, VkImage light_image, VkImageView light_view,\n\
        VkCommandBuffer commands, uint32_t frame_in_flight, RidgelightPlan *plan, RidgelightRenderer *renderer);\n\
        void engine(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device, uint32_t family,\n\
        VkImage heights_image, VkImageView heights_view, VkImage light_image, VkImageView light_view,\n\
        VkCommandBuffer commands, uint32_t frame_in_flight, RidgelightPlan *plan, RidgelightRenderer *renderer)\n{\n";
    let c = format!("{ENGINE}{}}}\n", block("embedding.md", "c"));
    let cpp = block("embedding/cpp.md", "cpp");
    for (by, source) in [(["cc", "-std=c11", "c"], c), (["c++", "-std=c++11", "cpp"], cpp)] {
        let (is_right, output) = accepted(by, &source);
        assert!(is_right, "{output}");
        // A member that the header lacks.
        let wrong = source.replace(".queue_family", ".family");
        assert!(wrong != source && !accepted(by, &wrong).0, "{by:?}");
    }
}

/// Every function of the header is exported, and no other symbol.
#[test]
fn the_shared_library_exports_the_header_alone() {
    let header = std::fs::read_to_string(Path::new(ROOT).join("crates/capi/include/ridgelight.h"))
        .expect("it");
    let mut declared: Vec<&str> = header
        .lines()
        .filter(|line| !line.trim_start().starts_with(['*', '/']))
        .flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '_')))
        .filter(|word| word.starts_with("ridgelight_"))
        .collect();
    declared.sort_unstable();
    declared.dedup();
    let library = library("libridgelight_c.so");
    let (done, output) = run(Command::new("nm").args(["-D", "--defined-only"]).arg(library));
    assert!(done.status.success(), "{output}");
    let mut exported: Vec<&str> = output.lines().filter_map(|l| l.split(' ').nth(2)).collect();
    exported.sort_unstable();
    assert_eq!(exported, declared);
    assert!(declared.len() > 10, "{declared:?}");
}

/// Each function that can fail documents its codes, by names that the header has.
#[test]
fn every_function_lists_its_codes() {
    let header = std::fs::read_to_string(Path::new(ROOT).join("crates/capi/include/ridgelight.h"))
        .expect("it");
    let codes = ["OK", "ARGUMENT", "SETTING", "LIMIT", "DEVICE"];
    let mut functions = 0;
    for (at, _) in header.match_indices("\nenum RidgelightResult ridgelight_") {
        let comment: Vec<&str> =
            header[..at].lines().rev().take_while(|line| line.starts_with("//")).collect();
        let name = header[at..].lines().nth(1).expect("its line");
        let returns = comment.iter().find_map(|line| line.strip_prefix("// Returns "));
        let returns = returns.unwrap_or_else(|| panic!("{name} says nothing of codes"));
        let named: Vec<&str> = returns
            .split(|c: char| !c.is_ascii_uppercase())
            .filter(|word| word.len() > 1)
            .collect();
        assert!(named.len() > 1 && named[0] == "OK", "{name}: {returns}");
        assert!(named.iter().all(|word| codes.contains(word)), "{name}: {returns}");
        functions += 1;
    }
    for code in codes {
        assert!(header.contains(&format!("RIDGELIGHT_RESULT_{code} =")), "{code}");
    }
    assert!(functions >= 12, "{functions}");
}

/// A library to link with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum With {
    Shared,
    Static,
    /// The shared library, with AddressSanitizer, which finds use after free and out-of-bounds accesses.
    Sanitizer,
}

/// Compiles a program in C against the header and a library.
fn compiled(folder: &Path, name: &str, source: &str, with: With) -> PathBuf {
    compiled_by(["cc", "-std=c11", "c"], folder, name, source, with)
}

/// By a compiler for a standard, from a file with an ending.
fn compiled_by(
    [compiler, standard, ending]: [&str; 3],
    folder: &Path,
    name: &str,
    source: &str,
    with: With,
) -> PathBuf {
    let (file, program) = (folder.join(name).with_extension(ending), folder.join(name));
    std::fs::write(&file, source).expect("a source");
    let shared = library("libridgelight_c.so");
    let mut cc = Command::new(compiler);
    cc.args([standard, "-Wall", "-Wextra", "-Werror", "-g", "-I"]);
    cc.arg(Path::new(ROOT).join("crates/capi/include")).arg(&file).arg("-o").arg(&program);
    if with == With::Sanitizer {
        cc.arg("-fsanitize=address");
    }
    if with == With::Static {
        cc.arg(library("libridgelight_c.a")).args(["-lpthread", "-ldl", "-lm", "-lgcc_s"]);
    } else {
        let folder = shared.parent().expect("a folder");
        cc.arg(&shared).arg(format!("-Wl,-rpath,{}", folder.display()));
    }
    let (done, output) = run(cc.arg("-lvulkan"));
    assert!(done.status.success(), "{output}");
    program
}

fn is_validated() -> bool {
    std::env::var_os("RIDGELIGHT_VALIDATION").is_some_and(|v| v == "1")
}

/// Enables the tests' validation layer for a command.
fn validated(command: &mut Command) -> &mut Command {
    // Drivers keep some allocations: their leaks are not checked.
    command.env("ASAN_OPTIONS", "detect_leaks=0");
    if is_validated() {
        command.env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation");
    }
    command
}

/// Without a messenger the layer prints its messages.
fn is_complaint(output: &str) -> bool {
    output.contains("VUID") || output.contains("SYNC-HAZARD")
}

/// The command line's result for the scene of host.c.
fn by_command_line(folder: &Path) -> Vec<u8> {
    let heights: Vec<f32> =
        (0..48 * 64).map(|i| ((i / 64 * 31 + i % 64 * 17) % 7) as f32 - 3.0).collect();
    files::write_npy_f32(&folder.join("field.npy"), &[48, 64], [&heights[..]]).expect("a field");
    let test = std::env::current_exe().expect("this test");
    let binary = test.parent().and_then(Path::parent).expect("a folder").join("ridgelight");
    assert!(binary.exists(), "{} is not there: cargo build", binary.display());
    let arguments = "render field.npy --sky 0.5 --sun 90,30,0.5,3 --quiet -o lit.exr";
    let (done, output) = run(Command::new(binary).current_dir(folder).args(arguments.split(' ')));
    assert!(done.status.success(), "{output}");
    let lit = files::read_planes(&folder.join("lit.exr")).expect("a picture");
    let red = lit.names.iter().position(|name| name == "R").expect("a channel R");
    lit.planes[red].iter().flat_map(|v| v.to_ne_bytes()).collect()
}

#[test]
fn a_c_program_gives_the_command_lines_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = include_str!("host.c");
    assert!(source.lines().count() <= 150, "an integrator's program");
    let right = by_command_line(folder.path());
    let mut is_different = right.chunks_exact(4).filter(|texel| *texel != &right[..4]);
    assert!(is_different.next().is_some(), "light that differs");
    let all = [("shared", With::Shared), ("static", With::Static), ("sane", With::Sanitizer)];
    for (name, with) in all {
        let program = compiled(folder.path(), name, source, with);
        let out = folder.path().join("texels");
        let (done, output) = run(validated(Command::new(program).arg(&out).arg("2")));
        assert!(done.status.success() && !is_complaint(&output), "{name}: {output}");
        assert!(std::fs::read(out).expect("texels") == right, "{name}: other light");
    }
    // Proof that validation is active: an image is copied from another layout than it is left in.
    if is_validated() {
        let from =
            "vkCmdCopyImageToBuffer(commands, light.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL";
        assert!(source.contains(from));
        let wrong = source.replace(from, &from.replace("TRANSFER_SRC_OPTIMAL", "GENERAL"));
        let program = compiled(folder.path(), "wrong", &wrong, With::Shared);
        let (_, output) =
            run(validated(Command::new(program).arg(folder.path().join("wrong.texels"))));
        assert!(is_complaint(&output), "validation reports nothing: {output}");
    }
}

/// The same by C++ with vulkan.hpp and an allocator of its own, under both of its common ways to link.
#[test]
fn a_cpp_program_gives_the_command_lines_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = include_str!("host.cpp");
    assert!(source.lines().count() <= 150, "an integrator's program");
    let right = by_command_line(folder.path());
    for (name, with) in [("static", With::Static), ("sane", With::Sanitizer)] {
        let cpp = ["c++", "-std=c++17", "cpp"];
        let program = compiled_by(cpp, folder.path(), name, source, with);
        let out = folder.path().join("texels");
        let (done, output) = run(validated(Command::new(program).arg(&out).arg("2")));
        assert!(done.status.success() && !is_complaint(&output), "{name}: {output}");
        assert!(std::fs::read(out).expect("texels") == right, "{name}: other light");
    }
    // The header is for older standards too, and refuses an allocator that may throw.
    let memory = "#include \"ridgelight.hpp\"\nstruct Memory { bool allocate(const RidgelightMemoryRequest &, \
                  RidgelightAllocation &) NOEXCEPT; void free(const RidgelightAllocation &) noexcept; };\n\
                  RidgelightAllocator made(Memory &memory) { return ridgelight::allocator(memory); }\n\
                  RidgelightResult planned(ridgelight::Plan &plan, const RidgelightHost &host, const RidgelightScene &scene) {\n\
                  return ridgelight::create_shadow_heights(plan, host, scene); }\n";
    let file = folder.path().join("allocator.cpp");
    std::fs::write(&file, memory).expect("a source");
    for (noexcept, is_taken) in [("noexcept", true), ("", false)] {
        let mut cpp = Command::new("c++");
        cpp.args(["-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I"]);
        cpp.arg(Path::new(ROOT).join("crates/capi/include")).arg(format!("-DNOEXCEPT={noexcept}"));
        let (done, output) = run(cpp.arg(&file));
        assert_eq!(done.status.success(), is_taken, "{output}");
        assert!(is_taken || output.contains("an exception must not leave a callback"), "{output}");
    }
}

/// The finest level of distant.c after its last cycle, computed from Rust, each level in one pass.
fn distant_by_rust() -> Vec<u8> {
    const SIDE: usize = 128;
    let (mut gpu, _) = abi::device();
    let limits = gpu.report().limits;
    let sun = Sun {
        azimuth_rad: 0.3 + 0.9 * 2.0,
        elevation_rad: 0.2,
        diameter_rad: 0.0093,
        irradiance: [1.0; 3],
    };
    let ridge = |at: i32, width: i32| (at.rem_euclid(width) - width / 2).abs();
    let mut outer: Option<(HeightField, Vec<Vec<f32>>)> = None;
    for level in [2, 1, 0] {
        let (step, cell) = (1 << level, f64::from(10 << level));
        let at = |i: usize| 64 - 64 * step + i as i32 * step;
        let heights: Vec<f32> = (0..SIDE * SIDE)
            .map(|i| (at(i % SIDE), at(i / SIDE)))
            .map(|(x, y)| (4 * ridge(3 * x + y, 100) + 3 * ridge(x - 2 * y, 140)) as f32)
            .collect();
        let field = HeightField::unknown(SIDE, SIDE, [cell; 2]).expect("a field");
        let around = outer.as_ref().map(|(field, _)| (field, [32.0, 32.0]));
        let plan = plan::shadow_heights(&field, &sun, around, 1, &limits).expect("a plan");
        let mut inputs = vec![&heights[..]];
        inputs.extend(outer.iter().flat_map(|(_, maps)| maps[..2].iter().map(Vec::as_slice)));
        let mut frame = gpu.frame(plan, &inputs).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        let maps = (0..3).map(|i| gpu.pixels(&frame, i).expect("pixels").values).collect();
        gpu.end(frame);
        outer = Some((field, maps));
    }
    let share = &outer.expect("three levels").1[2];
    let lit = share.iter().filter(|share| **share > 0.5).count();
    assert!((1000..15000).contains(&lit), "{lit} grid points are lit");
    share.iter().flat_map(|share| share.to_ne_bytes()).collect()
}

/// The maps equal Rust's bit for bit, however the parts are spread over frames. With a budget too small for any part, each frame records one.
/// With a budget large enough for all, each frame records a whole level, once the time of a part is known. With two and a half times
/// the shortest part's time, a frame records one part, or several that were predicted to stay within the budget. No check depends on
/// the times themselves: the program reports what it predicted.
#[test]
fn a_c_program_lights_levels_of_detail_within_a_budget() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = include_str!("distant.c");
    assert!(source.lines().count() <= 230, "an integrator's program");
    let right = distant_by_rust();
    let program = compiled(folder.path(), "distant", source, With::Sanitizer);
    let out = folder.path().join("texels");
    // Frames, the shortest time of a part, and the longest that was predicted for several, ms.
    let lit = |budget_ms: f64| {
        let mut command = Command::new(&program);
        command.arg(&out).env("BUDGET_MS", budget_ms.to_string());
        let (done, output) = run(validated(&mut command));
        assert!(done.status.success() && !is_complaint(&output), "{output}");
        assert!(std::fs::read(&out).expect("texels") == right, "{budget_ms} ms: other shadows");
        let numbers = |begin: &str| -> Vec<f64> {
            let line = output.lines().find(|line| line.starts_with(begin)).expect(begin);
            line.split([' ', ';']).filter_map(|word| word.parse().ok()).collect()
        };
        let [cycles, levels, frames, _] = numbers("3 cycles")[..] else { panic!("{output}") };
        let [shortest, predicted] = numbers("the shortest part")[..] else { panic!("{output}") };
        assert_eq!([cycles, levels], [3.0; 2], "{output}");
        (frames as usize, shortest, predicted)
    };
    let (frames, shortest, predicted) = lit(1e-6);
    assert_eq!((frames, predicted), (18, 0.0));
    let (frames, _, predicted) = lit(1e5);
    assert_eq!(frames, 12);
    assert!(predicted > 0.0 && predicted <= 1e5, "{predicted} ms");
    let budget_ms = 2.5 * shortest;
    let (frames, _, predicted) = lit(budget_ms);
    assert!((12..=18).contains(&frames), "{frames}");
    assert!(predicted <= budget_ms, "{predicted} of {budget_ms} ms");
    assert_eq!(predicted > 0.0, frames < 18, "{predicted} ms, {frames} frames");
}

/// The parts of a frame in distant.c, by its own function, for times that no clock has measured: one at least, also where it
/// exceeds the budget or its time is unknown; else as many as fit, up to all that are left.
#[test]
fn a_frame_of_the_c_program_records_the_parts_that_fit() {
    // Budget and time of a part in ms, parts left, and the parts of the frame.
    const CASES: [(f64, f64, usize, usize); 10] = [
        (1.0, 0.25, 8, 4),
        (1.0, 0.25, 3, 3),
        (1.0, 0.25, 1, 1),
        (0.875, 0.25, 8, 3),
        (0.5, 0.25, 8, 2),
        (0.4375, 0.25, 8, 1),
        (0.25, 0.25, 8, 1),
        (0.125, 0.25, 8, 1),
        (1.0, 0.0, 8, 1),
        (0.0, 0.0, 8, 1),
    ];
    let source = include_str!("distant.c");
    let main = "int main(int argc, char **argv) {";
    assert!(source.contains(main));
    let print = |(budget, part, left, _): &(f64, f64, usize, usize)| {
        format!("printf(\"%d\\n\", parts_within({budget:?}, {part:?}, {left}));\n")
    };
    let prints: String = CASES.iter().map(print).collect();
    let source = source.replace(main, "int distant(int argc, char **argv) {");
    let source = format!("{source}\nint main(void) {{\n{prints}return 0;\n}}\n");
    let folder = tempfile::tempdir().expect("a folder");
    let program = compiled(folder.path(), "parts", &source, With::Shared);
    let (done, output) = run(&mut Command::new(program));
    assert!(done.status.success(), "{output}");
    let found: Vec<usize> = output.lines().filter_map(|line| line.parse().ok()).collect();
    assert_eq!(found, CASES.map(|(.., parts)| parts), "{output}");
}

/// What the library refuses, by code and by a word of its sentence: from C, so that the header is tested.
#[test]
fn wrong_arguments_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = include_str!("wrong.c");
    let (done, output) =
        run(&mut Command::new(compiled(folder.path(), "wrong", source, With::Sanitizer)));
    assert!(done.status.success(), "{output}");
    // The sanitizer reports a struct that is shorter than its size.
    let beyond = format!("#define BEYOND\n{source}");
    let (done, output) =
        run(&mut Command::new(compiled(folder.path(), "beyond", &beyond, With::Sanitizer)));
    assert!(!done.status.success() && output.contains("heap-buffer-overflow"), "{output}");
}
