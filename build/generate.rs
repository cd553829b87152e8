//! Writes `shaders.rs` and `shaders.spv`: each shader's place in the SPIR-V, its bindings and its specialisation
//! constants, as a `shader!` of src/graph/shaders.rs; then the structs of push constants, as its `layouts!`.
//!
//! A shader has the name of its file; a `.vert` is `NAME_VERT`, a `.frag` is `NAME_FRAG`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

#[cfg(any(feature = "glslang", feature = "shaderc"))]
use super::compile::{compile, named};
use super::reflect::{self, Layouts, Reflection, reflect};
use super::{fail, write};

/// Folders of `shaders_glsl/` without shaders: include files, and the output of `tools/shaders`.
const NOT_SHADERS: [&str; 2] = ["shared", "compiled"];

/// The library's shaders.
pub(crate) fn core(out: &Path) {
    let folder = Path::new("shaders_glsl");
    println!("cargo:rerun-if-changed={}", folder.display());
    let mut table = String::from(
        "// Written by build.rs from the SPIR-V of shaders_glsl/. Not edited by hand.\n\n",
    );
    let mut layouts = Layouts::default();
    let mut all_words = Vec::new();
    let (mut names, mut graphics) = (Vec::new(), Vec::new());
    let sources = shaders_in(folder);
    for (path, words) in sources.iter().zip(modules(&sources, "shaders_glsl/compiled/shaders.spv"))
    {
        let name = name_of(path);
        let found = reflect(&name, &words, &mut layouts);
        let source = path.to_string_lossy().replace('\\', "/");
        add_shader(&mut table, (&name, &source), [all_words.len(), words.len()], &found);
        all_words.extend(words);
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
        writeln!(table, "];\n").unwrap();
    }
    add_layouts(&mut table, &layouts);
    writeln!(table, "\n/// Words of all shaders together.").unwrap();
    writeln!(table, "const WORD_COUNT: usize = {};", all_words.len()).unwrap();
    write(&out.join("shaders.rs"), table.as_bytes());
    write_modules(&out.join("shaders.spv"), std::iter::once(&all_words[..]));
}

/// The SPIR-V of each shader, from its GLSL, with its name in it.
#[cfg(any(feature = "glslang", feature = "shaderc"))]
fn modules(sources: &[PathBuf], _: &str) -> Vec<Vec<u32>> {
    sources.iter().map(|path| named(compile(path), &name_of(path))).collect()
}

/// The SPIR-V of each shader, from the committed file: [`reflect`] refuses a module of another name.
#[cfg(not(any(feature = "glslang", feature = "shaderc")))]
fn modules(sources: &[PathBuf], committed: &str) -> Vec<Vec<u32>> {
    // The first word of a module. Elsewhere it would give one module too many, which is refused.
    const MAGIC: u32 = 0x0723_0203;
    println!("cargo:rerun-if-changed={committed}");
    let bytes = super::read(Path::new(committed));
    let words: Vec<u32> =
        bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let parts = words.split(|word| *word == MAGIC).skip(1);
    let modules: Vec<_> = parts.map(|rest| [&[MAGIC][..], rest].concat()).collect();
    if modules.len() != sources.len() {
        let (found, expected) = (modules.len(), sources.len());
        fail(&format!(
            "{committed}: found {found} modules, expected {expected}, one per shader; run tools/shaders"
        ));
    }
    modules
}

/// Modules one after the other, as `tools/shaders` commits them.
fn write_modules<'a>(path: &Path, modules: impl Iterator<Item = &'a [u32]>) {
    let bytes: Vec<u8> = modules.flatten().flat_map(|word| word.to_le_bytes()).collect();
    write(path, &bytes);
}

/// The shaders in a folder and in the folders inside it, sorted by file name.
fn shaders_in(folder: &Path) -> Vec<PathBuf> {
    let mut sources = Vec::new();
    find(folder, &mut sources);
    sources.sort_by(|a, b| a.file_name().cmp(&b.file_name()));
    sources
}

fn find(folder: &Path, sources: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder);
    let entries = entries.unwrap_or_else(|e| fail(&format!("{}: {e}", folder.display())));
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let is_other = NOT_SHADERS.iter().any(|name| path.ends_with(name));
        if path.is_dir() && !is_other {
            find(&path, sources);
        } else if stage(&path).is_some() {
            sources.push(path);
        }
    }
}

/// Shaders of tests, where the tests are present, as `NAME.spv`; the library does not contain them.
pub(crate) fn decoders(out: &Path) {
    let folder = Path::new("tests/gpu/bake/decoders/shaders");
    if !folder.is_dir() {
        return;
    }
    println!("cargo:rerun-if-changed={}", folder.display());
    let sources = shaders_in(folder);
    let modules = modules(&sources, "tests/gpu/bake/decoders/shaders.spv");
    for (path, words) in sources.iter().zip(&modules) {
        let file = out.join(name_of(path)).with_extension("spv");
        write_modules(&file, std::iter::once(&words[..]));
    }
    write_modules(&out.join("decoders.spv"), modules.iter().map(|words| &words[..]));
}

/// The shader stage of a file, by its extension.
pub(crate) fn stage(path: &Path) -> Option<&'static str> {
    let extension = path.extension()?;
    ["comp", "frag", "vert"].into_iter().find(|stage| extension == *stage)
}

fn name_of(path: &Path) -> String {
    let stem = path.file_stem().expect("a listed file has a name").to_string_lossy();
    match stage(path) {
        Some("comp") | None => stem.into_owned(),
        Some(stage) => format!("{stem}_{stage}"),
    }
}

/// A `shader!` of src/graph/shaders.rs.
fn add_shader(
    table: &mut String,
    (name, source): (&str, &str),
    [first, count]: [usize; 2],
    found: &Reflection,
) {
    let (constant, structure) = (name.to_uppercase(), pascal(name));
    writeln!(table, "shader! {{").unwrap();
    writeln!(table, "    /// `{source}`.").unwrap();
    writeln!(table, "    {constant}: {name:?}, push {}, words {first} {count},", found.push)
        .unwrap();
    for (binding, reflect::Binding { name, kind, written }) in &found.bindings {
        let access = if *written { "writes" } else { "reads" };
        writeln!(table, "    {binding} {access} {name:?} {kind},").unwrap();
    }
    if let Some([x, y, z]) = found.group_size {
        writeln!(table, "    [groups of {x} {y} {z}]").unwrap();
    }
    if found.constants.is_empty() {
        writeln!(table, "    {structure};\n}}\n").unwrap();
        return;
    }
    writeln!(table, "    {structure} {{").unwrap();
    for (id, constant) in &found.constants {
        let name = constant.name.to_lowercase();
        let (of_type, default) = match constant.default {
            reflect::Default::Bool(is) => ("bool", is.to_string()),
            reflect::Default::Int(n) => ("i32", n.to_string()),
            reflect::Default::Uint(n) => ("u32", n.to_string()),
            reflect::Default::Float(x) => ("f32", format!("{x:?}")),
        };
        writeln!(table, "        {id} {name}: {of_type} = {default},").unwrap();
    }
    writeln!(table, "    }}\n}}\n").unwrap();
}

/// The `layouts!` of src/graph/shaders.rs.
fn add_layouts(table: &mut String, layouts: &Layouts) {
    writeln!(table, "layouts! {{").unwrap();
    for (structure, (bytes, members)) in &layouts.pushes {
        writeln!(table, "    push {structure} {bytes} {{").unwrap();
        let fields = members.iter().map(|reflect::Member { offset, name, of_type }| {
            format!("{offset} {}: {of_type},", name.to_lowercase())
        });
        add_wrapped(table, fields);
        writeln!(table, "    }}").unwrap();
    }
    for (structure, members) in &layouts.others {
        writeln!(table, "    other {structure} {{").unwrap();
        let offsets = members.iter().map(|(name, at)| format!("{at} {},", name.to_lowercase()));
        add_wrapped(table, offsets);
        writeln!(table, "    }}").unwrap();
    }
    writeln!(table, "}}").unwrap();
}

/// Parts on lines of at most 100 columns.
fn add_wrapped(table: &mut String, parts: impl Iterator<Item = String>) {
    let mut column = 0;
    for part in parts {
        if column == 0 || column + 1 + part.len() > 100 {
            table.push_str(if column == 0 { "       " } else { "\n       " });
            column = 7;
        }
        write!(table, " {part}").unwrap();
        column += 1 + part.len();
    }
    table.push('\n');
}

/// `sun_shade` as `SunShade`.
fn pascal(name: &str) -> String {
    let words = name.split('_').map(|word| {
        let (first, rest) = word.split_at(1);
        first.to_uppercase() + rest
    });
    words.collect()
}
