//! GLSL to SPIR-V, and SPIR-V to a typed table of what each shader binds.
//!
//! Every `shaders_glsl/*.comp`, `.vert` and `.frag` is compiled (files of `shaders_glsl/shared/` are included, never
//! compiled alone), parsed back, and written to `$OUT_DIR/shaders.rs` as one constant a shader:
//! words, bindings, push constant size (of a `.vert` `NAME_VERT`, of a `.frag` `NAME_FRAG`), and the byte offsets of every struct with explicit layout,
//! against which `same_layout!` (src/gpu/shaders.rs) checks the host's structs at compile time. The first error of a
//! shader stops the build with file and line.
//!
//! Shaders of tests (`tests/gpu/decoders/*.comp`, where they are) become `$OUT_DIR/NAME.spv`, which no library holds.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Dim, Op, StorageClass};

fn main() {
    let folder = PathBuf::from("shaders_glsl");
    println!("cargo:rerun-if-changed={}", folder.display());
    println!("cargo:rerun-if-changed=build.rs");
    let sources = shaders_in(&folder);
    let mut table = String::new();
    let mut layouts: BTreeMap<String, BTreeMap<String, u32>> = BTreeMap::new();
    let (mut names, mut graphics) = (Vec::new(), Vec::new());
    for path in &sources {
        let stem = path.file_stem().expect("a listed file has a name").to_string_lossy();
        let name = match stage(path) {
            Some("comp") | None => stem.into_owned(),
            Some(stage) => format!("{stem}_{stage}"),
        };
        let (text, files) = include(path);
        let words = compile(&text, &files);
        let module = rspirv::dr::load_words(&words)
            .unwrap_or_else(|e| fail(&format!("{}: {e:?}", path.display())));
        let source = path.to_string_lossy();
        describe(&mut table, (&name, &source), &words, &module, &mut layouts);
        if stage(path) == Some("comp") { names.push(name) } else { graphics.push(name) }
    }
    for (what, list, names) in
        [("compute shader", "ALL", names), ("vertex and fragment shader", "GRAPHICS", graphics)]
    {
        writeln!(table, "/// Every {what}, by name.").unwrap();
        writeln!(table, "pub static {list}: &[Shader] = &[").unwrap();
        for name in &names {
            writeln!(table, "    {},", name.to_uppercase()).unwrap();
        }
        writeln!(table, "];").unwrap();
    }
    writeln!(table, "/// Byte offsets of struct members as the shaders see them.").unwrap();
    writeln!(table, "pub mod offsets {{").unwrap();
    for (structure, members) in &layouts {
        writeln!(table, "    /// `{structure}`.\n    pub mod {} {{", snake(structure)).unwrap();
        for (member, offset) in members {
            writeln!(
                table,
                "        /// Bytes.\n        pub const {}: usize = {offset};",
                member.to_uppercase()
            )
            .unwrap();
        }
        writeln!(table, "    }}").unwrap();
    }
    writeln!(table, "}}").unwrap();
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    write(&out.join("shaders.rs"), table.as_bytes());
    let of_tests = Path::new("tests/gpu/decoders");
    if of_tests.is_dir() {
        println!("cargo:rerun-if-changed={}", of_tests.display());
        for path in shaders_in(of_tests) {
            let (text, files) = include(&path);
            let words = compile(&text, &files);
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
            let stem = path.file_stem().expect("a listed file has a name");
            write(&out.join(stem).with_extension("spv"), &bytes);
        }
    }
}

/// Every shader in a folder that is compiled by itself, in order.
fn shaders_in(folder: &Path) -> Vec<PathBuf> {
    let mut sources: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap_or_else(|e| fail(&format!("{}: {e}", folder.display())))
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| stage(path).is_some())
        .collect();
    sources.sort();
    sources
}

fn write(path: &Path, bytes: &[u8]) {
    fs::write(path, bytes).unwrap_or_else(|e| fail(&format!("{}: {e}", path.display())));
}

/// What a file's extension says, where it is a shader's.
fn stage(path: &Path) -> Option<&'static str> {
    let extension = path.extension()?;
    ["comp", "frag", "vert"].into_iter().find(|stage| extension == *stage)
}

fn fail(message: &str) -> ! {
    eprintln!("{message}");
    std::process::exit(1);
}

/// Splices `#include "x"` lines (relative to the shader's folder, each file once) and returns the
/// text with `#line` marks, and the files that their source numbers stand for.
fn include(path: &Path) -> (String, Vec<PathBuf>) {
    let mut files = Vec::new();
    let mut text = String::new();
    splice(path, &mut files, &mut text);
    (text, files)
}

fn splice(path: &Path, files: &mut Vec<PathBuf>, text: &mut String) {
    println!("cargo:rerun-if-changed={}", path.display());
    let source =
        fs::read_to_string(path).unwrap_or_else(|e| fail(&format!("{}: {e}", path.display())));
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
fn compile(text: &str, files: &[PathBuf]) -> Vec<u32> {
    use glslang::{Compiler, CompilerOptions, ShaderInput, ShaderSource, ShaderStage};
    let compiler = Compiler::acquire().unwrap_or_else(|| fail("glslang did not start"));
    let options = CompilerOptions {
        source_language: glslang::SourceLanguage::GLSL,
        target: glslang::Target::Vulkan {
            version: glslang::VulkanVersion::Vulkan1_3,
            spirv_version: glslang::SpirvVersion::SPIRV1_5,
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
fn compile(text: &str, files: &[PathBuf]) -> Vec<u32> {
    let compiler =
        shaderc::Compiler::new().unwrap_or_else(|e| fail(&format!("shaderc did not start: {e}")));
    let mut options =
        shaderc::CompileOptions::new().unwrap_or_else(|e| fail(&format!("shaderc: {e}")));
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_3 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_5);
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

fn snake(name: &str) -> String {
    let mut out = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

fn id(operand: &Operand) -> u32 {
    operand.id_ref_any().unwrap_or_else(|| fail("SPIR-V: an id was expected"))
}

fn literal(operand: &Operand) -> u32 {
    match operand {
        Operand::LiteralBit32(n) => *n,
        _ => fail("SPIR-V: a literal was expected"),
    }
}

/// What the decorations of a module say.
struct Decorations<'m> {
    module: &'m Module,
}

impl Decorations<'_> {
    fn of(&self, target: u32, wanted: Decoration) -> Option<u32> {
        self.module.annotations.iter().find_map(|a| {
            (a.class.opcode == Op::Decorate
                && id(&a.operands[0]) == target
                && a.operands[1] == Operand::Decoration(wanted))
            .then(|| a.operands.get(2).map_or(0, literal))
        })
    }

    fn of_member(&self, target: u32, member: u32, wanted: Decoration) -> Option<u32> {
        self.module.annotations.iter().find_map(|a| {
            (a.class.opcode == Op::MemberDecorate
                && id(&a.operands[0]) == target
                && literal(&a.operands[1]) == member
                && a.operands[2] == Operand::Decoration(wanted))
            .then(|| a.operands.get(3).map_or(0, literal))
        })
    }

    fn name(&self, target: u32) -> String {
        self.module
            .debug_names
            .iter()
            .find(|n| n.class.opcode == Op::Name && id(&n.operands[0]) == target)
            .and_then(|n| match &n.operands[1] {
                Operand::LiteralString(s) => Some(s.clone()),
                _ => None,
            })
            .unwrap_or_default()
    }

    fn member_name(&self, target: u32, member: u32) -> String {
        self.module
            .debug_names
            .iter()
            .find(|n| {
                n.class.opcode == Op::MemberName
                    && id(&n.operands[0]) == target
                    && literal(&n.operands[1]) == member
            })
            .and_then(|n| match &n.operands[2] {
                Operand::LiteralString(s) => Some(s.clone()),
                _ => None,
            })
            .unwrap_or_default()
    }

    fn ty(&self, target: u32) -> &Instruction {
        self.module
            .types_global_values
            .iter()
            .find(|i| i.result_id == Some(target))
            .unwrap_or_else(|| fail("SPIR-V: a type is missing"))
    }
}

/// Writes one shader's constant and adds the offsets of its structs.
fn describe(
    table: &mut String,
    (name, source): (&str, &str),
    words: &[u32],
    module: &Module,
    layouts: &mut BTreeMap<String, BTreeMap<String, u32>>,
) {
    let d = Decorations { module };
    let mut bindings = BTreeMap::new();
    let mut push_bytes = 0;
    for variable in &module.types_global_values {
        if variable.class.opcode != Op::Variable {
            continue;
        }
        let target = variable.result_id.expect("a variable has an id");
        let pointer = d.ty(variable.result_type.expect("a variable has a type"));
        let Operand::StorageClass(class) = pointer.operands[0] else { continue };
        let pointee = d.ty(id(&pointer.operands[1]));
        if class == StorageClass::PushConstant {
            let structure = pointee.result_id.expect("a struct has an id");
            push_bytes = pointee.operands.iter().enumerate().fold(0, |end, (m, member)| {
                let offset = d.of_member(structure, m as u32, Decoration::Offset).unwrap_or(0);
                end.max(offset + size_of_type(&d, id(member)))
            });
            continue;
        }
        let Some(binding) = d.of(target, Decoration::Binding) else { continue };
        if d.of(target, Decoration::DescriptorSet).unwrap_or(0) != 0 {
            fail(&format!("{name}: only descriptor set 0 is used"));
        }
        let (kind, written) = match pointee.class.opcode {
            Op::TypeStruct => {
                let structure = pointee.result_id.expect("a struct has an id");
                let members = pointee.operands.len() as u32;
                let frozen = (0..members)
                    .all(|m| d.of_member(structure, m, Decoration::NonWritable).is_some());
                ("StorageBuffer".to_owned(), !frozen)
            }
            Op::TypeImage if pointee.operands[1] == Operand::Dim(Dim::DimBuffer) => {
                ("TexelBuffer".to_owned(), false)
            }
            Op::TypeImage => {
                let uint = d.ty(id(&pointee.operands[0])).class.opcode == Op::TypeInt;
                let layered = literal(&pointee.operands[3]) == 1;
                if literal(&pointee.operands[5]) == 2 {
                    let Operand::ImageFormat(format) = pointee.operands[6] else {
                        fail(&format!("{name}: a storage image without a format field"))
                    };
                    let kind = format!(
                        "StorageImage {{ format: {:?}, uint: {uint}, layered: {layered} }}",
                        format!("{format:?}")
                    );
                    (kind, d.of(target, Decoration::NonWritable).is_none())
                } else {
                    (format!("SampledImage {{ uint: {uint}, layered: {layered} }}"), false)
                }
            }
            other => {
                fail(&format!("{name}: binding {binding} is a {other:?}, which nothing here uses"))
            }
        };
        // A block without an instance is known by its own name.
        let block = snake(&d.name(pointee.result_id.expect("a type has an id")));
        let name = Some(d.name(target)).filter(|n| !n.is_empty()).unwrap_or(block);
        bindings.insert(binding, (name, kind, written));
    }
    for structure in &module.types_global_values {
        if structure.class.opcode != Op::TypeStruct {
            continue;
        }
        let target = structure.result_id.expect("a struct has an id");
        let type_name = d.name(target);
        if type_name.is_empty() || type_name.starts_with("gl_") {
            continue;
        }
        for m in 0..structure.operands.len() as u32 {
            let Some(offset) = d.of_member(target, m, Decoration::Offset) else { continue };
            let member = d.member_name(target, m);
            let known =
                layouts.entry(type_name.clone()).or_default().insert(member.clone(), offset);
            if known.is_some_and(|k| k != offset) {
                fail(&format!(
                    "{name}: {type_name}.{member} has another offset than in an earlier shader"
                ));
            }
        }
    }
    writeln!(table, "/// `{source}`.").unwrap();
    writeln!(table, "pub const {}: Shader = Shader {{", name.to_uppercase()).unwrap();
    writeln!(table, "    name: {name:?},\n    push_bytes: {push_bytes},\n    bindings: &[")
        .unwrap();
    for (binding, (variable, kind, written)) in &bindings {
        writeln!(
            table,
            "        Binding {{ binding: {binding}, name: {variable:?}, kind: BindingKind::{kind}, written: {written} }},"
        )
        .unwrap();
    }
    writeln!(table, "    ],\n    words: &{words:?},\n}};").unwrap();
}

fn size_of_type(d: &Decorations, target: u32) -> u32 {
    let ty = d.ty(target);
    match ty.class.opcode {
        Op::TypeInt | Op::TypeFloat => literal(&ty.operands[0]) / 8,
        Op::TypeVector => size_of_type(d, id(&ty.operands[0])) * literal(&ty.operands[1]),
        other => fail(&format!("a push constant holds a {other:?}: scalars and vectors only")),
    }
}
