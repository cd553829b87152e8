//! Writes `shaders.rs` and `shaders.spv`: each shader's place in the SPIR-V, its bindings, and a struct of its
//! specialisation constants. The host dispatches it only through that struct.
//!
//! A shader has the name of its file; a `.vert` is `NAME_VERT`, a `.frag` is `NAME_FRAG`. `same_layout!`
//! (src/graph/shaders.rs) checks the host's structs against the offsets at compile time.

use std::fmt::Write as _;
use std::path::Path;

use super::compile::{compile, shaders_in, stage};
use super::reflect::{self, Constant, Layouts, Reflection, reflect};
use super::write;

/// The library's shaders.
pub(crate) fn core(out: &Path) {
    let folder = Path::new("shaders_glsl");
    println!("cargo:rerun-if-changed={}", folder.display());
    let mut table = String::from(
        "// Written by build.rs from the SPIR-V of shaders_glsl/; committed by tools/shaders. Not edited by hand.\n\n",
    );
    let mut layouts = Layouts::new();
    let mut all_words = Vec::new();
    let (mut names, mut graphics) = (Vec::new(), Vec::new());
    for path in shaders_in(folder) {
        let name = name_of(&path);
        let words = compile(&path);
        let found = reflect(&name, &words, &mut layouts);
        let source = path.to_string_lossy().replace('\\', "/");
        add_shader(&mut table, (&name, &source), [all_words.len(), words.len()], &found);
        add_constants(&mut table, &name, &source, &found);
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

fn add_shader(
    table: &mut String,
    (name, source): (&str, &str),
    [first, count]: [usize; 2],
    found: &Reflection,
) {
    writeln!(table, "/// `{source}`.").unwrap();
    writeln!(table, "pub const {}: Shader = Shader {{", name.to_uppercase()).unwrap();
    writeln!(table, "    name: {name:?},\n    push_bytes: {},", found.push_bytes).unwrap();
    writeln!(table, "    bindings: &[").unwrap();
    for (binding, reflect::Binding { name, kind, written }) in &found.bindings {
        writeln!(
            table,
            "        Binding {{ binding: {binding}, name: {name:?}, kind: BindingKind::{kind}, written: {written} }},"
        )
        .unwrap();
    }
    writeln!(table, "    ],\n    constants: &[").unwrap();
    for (id, constant) in &found.constants {
        let name = constant.name.to_lowercase();
        writeln!(table, "        Constant {{ id: {id}, name: {name:?} }},").unwrap();
    }
    writeln!(table, "    ],\n    words: words_at({first}, {count}),\n}};\n").unwrap();
}

/// The struct of a shader's specialisation constants, its defaults, and its words in the order of their
/// numbers.
fn add_constants(table: &mut String, name: &str, source: &str, found: &Reflection) {
    let (shader, structure) = (name.to_uppercase(), pascal(name));
    let all: Vec<Field> = found.constants.values().map(Field::of).collect();
    writeln!(table, "/// `{source}` with its specialisation constants.").unwrap();
    let derives = match all.iter().all(|field| field.is_zero) {
        true => "Clone, Copy, Debug, Default",
        false => "Clone, Copy, Debug",
    };
    writeln!(table, "#[derive({derives})]").unwrap();
    if all.is_empty() {
        writeln!(table, "pub(crate) struct {structure};\n").unwrap();
    } else {
        writeln!(table, "pub(crate) struct {structure} {{").unwrap();
        for Field { name, of_type, default, .. } in &all {
            writeln!(table, "    /// `{}`, by default {default}.", name.to_uppercase()).unwrap();
            writeln!(table, "    pub {name}: {of_type},").unwrap();
        }
        writeln!(table, "}}\n").unwrap();
    }
    if !all.iter().all(|field| field.is_zero) {
        writeln!(table, "impl Default for {structure} {{\n    fn default() -> Self {{").unwrap();
        writeln!(table, "        Self {{").unwrap();
        for Field { name, default, .. } in &all {
            writeln!(table, "            {name}: {default},").unwrap();
        }
        writeln!(table, "        }}\n    }}\n}}\n").unwrap();
    }
    let given = if all.is_empty() { "_" } else { "of" };
    writeln!(table, "impl From<{structure}> for Specialised {{").unwrap();
    writeln!(table, "    fn from({given}: {structure}) -> Self {{").unwrap();
    writeln!(table, "        Self {{ shader: &{shader}, constants: vec![").unwrap();
    for Field { word, .. } in &all {
        writeln!(table, "            {word},").unwrap();
    }
    writeln!(table, "        ] }}\n    }}\n}}\n").unwrap();
}

/// A specialisation constant as a field of Rust.
struct Field {
    name: String,
    of_type: &'static str,
    default: String,
    is_zero: bool,
    /// The word passed to Vulkan.
    word: String,
}

impl Field {
    fn of(constant: &Constant) -> Self {
        let name = constant.name.to_lowercase();
        let (of_type, default, is_zero, word) = match constant.default {
            reflect::Default::Bool(is) => {
                ("bool", is.to_string(), !is, format!("u32::from(of.{name})"))
            }
            reflect::Default::Int(n) => ("i32", n.to_string(), n == 0, format!("of.{name} as u32")),
            reflect::Default::Uint(n) => ("u32", n.to_string(), n == 0, format!("of.{name}")),
            reflect::Default::Float(x) => {
                ("f32", format!("{x:?}"), x == 0.0, format!("of.{name}.to_bits()"))
            }
        };
        Self { name, of_type, default, is_zero, word }
    }
}

fn add_layouts(table: &mut String, layouts: &Layouts) {
    writeln!(table, "/// Byte offsets of struct members as the shaders see them.").unwrap();
    writeln!(table, "pub mod offsets {{").unwrap();
    for (structure, members) in layouts {
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
}

pub(crate) fn snake(name: &str) -> String {
    let mut out = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// `sun_shade` as `SunShade`.
fn pascal(name: &str) -> String {
    let words = name.split('_').map(|word| {
        let (first, rest) = word.split_at(1);
        first.to_uppercase() + rest
    });
    words.collect()
}
