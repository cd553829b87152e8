//! Writes `shaders.rs` and `shaders.spv`: each shader's place in the SPIR-V, its bindings and its specialisation
//! constants, as a `shader!` of src/graph/shaders.rs; then the structs of push constants, as its `layouts!`.
//!
//! A shader has the name of its file; a `.vert` is `NAME_VERT`, a `.frag` is `NAME_FRAG`.

use std::fmt::Write as _;
use std::path::Path;

use super::compile::{compile, shaders_in, stage};
use super::reflect::{self, Layouts, Reflection, reflect};
use super::write;

/// The library's shaders.
pub(crate) fn core(out: &Path) {
    let folder = Path::new("shaders_glsl");
    println!("cargo:rerun-if-changed={}", folder.display());
    let mut table = String::from(
        "// Written by build.rs from the SPIR-V of shaders_glsl/; committed by tools/shaders. Not edited by hand.\n\n",
    );
    let mut layouts = Layouts::default();
    let mut all_words = Vec::new();
    let (mut names, mut graphics) = (Vec::new(), Vec::new());
    for path in shaders_in(folder) {
        let name = name_of(&path);
        let words = compile(&path);
        let found = reflect(&name, &words, &mut layouts);
        let source = path.to_string_lossy().replace('\\', "/");
        add_shader(&mut table, (&name, &source), [all_words.len(), words.len()], &found);
        all_words.extend(words);
        if stage(&path) == Some("comp") { names.push(name) } else { graphics.push(name) }
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
    let bytes: Vec<u8> = all_words.iter().flat_map(|word| word.to_le_bytes()).collect();
    write(&out.join("shaders.spv"), &bytes);
}

/// Shaders of tests (`tests/gpu/bake/decoders/shaders/*.comp`, where present) as `NAME.spv`; the library does not contain
/// them.
pub(crate) fn decoders(out: &Path) {
    let folder = Path::new("tests/gpu/bake/decoders/shaders");
    if !folder.is_dir() {
        return;
    }
    println!("cargo:rerun-if-changed={}", folder.display());
    for path in shaders_in(folder) {
        let bytes: Vec<u8> = compile(&path).iter().flat_map(|word| word.to_ne_bytes()).collect();
        write(&out.join(name_of(&path)).with_extension("spv"), &bytes);
    }
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
