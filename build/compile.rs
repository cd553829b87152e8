//! GLSL to SPIR-V 1.3, which every Vulkan 1.1 device supports.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::generate::stage;
use super::reflect::op::MODULE_PROCESSED;
use super::{fail, read};

/// The SPIR-V of one shader. The first error stops the build with file and line.
pub(crate) fn compile(path: &Path) -> Vec<u32> {
    let (text, files) = include(path);
    translate(&text, &files)
}

/// A module with the name of its shader in it: an OpModuleProcessed after the other debug instructions (SPIR-V specification,
/// section 2.4). Drivers ignore it.
pub(crate) fn named(mut words: Vec<u32>, name: &str) -> Vec<u32> {
    // OpSourceContinued to OpString.
    const DEBUG: std::ops::RangeInclusive<u32> = 2..=7;
    let (mut next, mut end) = (5, 5);
    while let Some(first) = words.get(next) {
        next += (first >> 16) as usize;
        if DEBUG.contains(&(first & 0xffff)) {
            end = next;
        }
    }
    // A literal string ends with a byte 0.
    let mut text = name.as_bytes().to_vec();
    text.resize(text.len() / 4 * 4 + 4, 0);
    let text = text.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word));
    let first = (1 + text.len() as u32) << 16 | MODULE_PROCESSED;
    let instruction: Vec<u32> = std::iter::once(first).chain(text).collect();
    words.splice(end..end, instruction);
    words
}

/// Inlines `#include "x"` lines (relative to the shader's folder, each file once). Returns the text with
/// `#line` marks, and the files for their source numbers.
fn include(path: &Path) -> (String, Vec<PathBuf>) {
    let mut files = Vec::new();
    let mut text = String::new();
    splice(path, &mut files, &mut text);
    (text, files)
}

fn splice(path: &Path, files: &mut Vec<PathBuf>, text: &mut String) {
    println!("cargo:rerun-if-changed={}", path.display());
    let source = String::from_utf8(read(path));
    let source = source.unwrap_or_else(|e| fail(&format!("{}: {e}", path.display())));
    let number = files.len();
    files.push(path.to_owned());
    if number > 0 {
        writeln!(text, "#line 1 {number}").unwrap();
    }
    for (i, line) in source.lines().enumerate() {
        let Some(rest) = line.trim().strip_prefix("#include \"") else {
            text.push_str(line);
            text.push('\n');
            continue;
        };
        let Some(name) = rest.strip_suffix('"') else {
            fail(&format!("{}:{}: an #include without its closing quote", path.display(), i + 1));
        };
        let included = Path::new("shaders_glsl").join(name);
        if !files.contains(&included) {
            splice(&included, files, text);
        }
        writeln!(text, "#line {} {number}", i + 2).unwrap();
    }
}

/// Turns `ERROR: 1:20: …` (glslang) and `1:20: …` (shaderc) into `shaders_glsl/shared/x.glsl:20: …`.
fn located(log: &str, files: &[PathBuf]) -> String {
    log.lines()
        .map(|line| {
            let rest = line.strip_prefix("ERROR: ").unwrap_or(line);
            let mut parts = rest.splitn(3, ':');
            match (parts.next().and_then(|n| n.parse::<usize>().ok()), parts.next(), parts.next()) {
                (Some(n), Some(row), Some(what)) if n < files.len() => {
                    format!("{}:{row}:{what}", files[n].display())
                }
                _ => line.to_owned(),
            }
        })
        .collect::<Vec<_>>()
        .join("\n")
}

#[cfg(not(feature = "shaderc"))]
fn translate(text: &str, files: &[PathBuf]) -> Vec<u32> {
    use glslang::{Compiler, CompilerOptions, ShaderInput, ShaderSource, ShaderStage};
    let compiler = Compiler::acquire().unwrap_or_else(|| fail("glslang did not start"));
    let options = CompilerOptions {
        source_language: glslang::SourceLanguage::GLSL,
        target: glslang::Target::Vulkan {
            version: glslang::VulkanVersion::Vulkan1_1,
            spirv_version: glslang::SpirvVersion::SPIRV1_3,
        },
        ..CompilerOptions::default()
    };
    let source = ShaderSource::from(text);
    let stage = match stage(&files[0]) {
        Some("vert") => ShaderStage::Vertex,
        Some("frag") => ShaderStage::Fragment,
        _ => ShaderStage::Compute,
    };
    let words = ShaderInput::new(&source, stage, &options, None, None)
        .and_then(|input| compiler.create_shader(input))
        .and_then(|shader| shader.compile());
    words.unwrap_or_else(|e| fail(&located(&e.to_string(), files)))
}

#[cfg(feature = "shaderc")]
fn translate(text: &str, files: &[PathBuf]) -> Vec<u32> {
    let compiler =
        shaderc::Compiler::new().unwrap_or_else(|e| fail(&format!("shaderc did not start: {e}")));
    let mut options =
        shaderc::CompileOptions::new().unwrap_or_else(|e| fail(&format!("shaderc: {e}")));
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_1 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_3);
    let name = files[0].to_string_lossy();
    let kind = match stage(&files[0]) {
        Some("vert") => shaderc::ShaderKind::Vertex,
        Some("frag") => shaderc::ShaderKind::Fragment,
        _ => shaderc::ShaderKind::Compute,
    };
    compiler
        .compile_into_spirv(text, kind, &name, "main", Some(&options))
        .unwrap_or_else(|e| fail(&located(&e.to_string(), files)))
        .as_binary()
        .to_vec()
}
