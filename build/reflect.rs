//! Reflects a SPIR-V module: bindings, push constants and specialisation constants.
//!
//! Numbers and layouts are those of the SPIR-V specification, section 3. They are read without a crate, so that a build from
//! the committed SPIR-V has no build dependency.

use std::collections::{BTreeMap, HashMap};

use super::fail;

/// Opcodes.
pub(crate) mod op {
    pub const NAME: u32 = 5;
    pub const MEMBER_NAME: u32 = 6;
    pub const EXECUTION_MODE: u32 = 16;
    pub const TYPE_VOID: u32 = 19;
    pub const TYPE_INT: u32 = 21;
    pub const TYPE_FLOAT: u32 = 22;
    pub const TYPE_VECTOR: u32 = 23;
    pub const TYPE_MATRIX: u32 = 24;
    pub const TYPE_IMAGE: u32 = 25;
    pub const TYPE_ARRAY: u32 = 28;
    pub const TYPE_STRUCT: u32 = 30;
    pub const TYPE_FUNCTION: u32 = 33;
    pub const CONSTANT_TRUE: u32 = 41;
    pub const CONSTANT: u32 = 43;
    pub const SPEC_CONSTANT_TRUE: u32 = 48;
    pub const SPEC_CONSTANT_FALSE: u32 = 49;
    pub const SPEC_CONSTANT: u32 = 50;
    pub const SPEC_CONSTANT_COMPOSITE: u32 = 51;
    pub const SPEC_CONSTANT_OP: u32 = 52;
    pub const FUNCTION: u32 = 54;
    pub const FUNCTION_END: u32 = 56;
    pub const VARIABLE: u32 = 59;
    pub const DECORATE: u32 = 71;
    pub const MEMBER_DECORATE: u32 = 72;
    pub const MODULE_PROCESSED: u32 = 330;
}

/// Decorations.
mod decoration {
    pub const SPEC_ID: u32 = 1;
    pub const ROW_MAJOR: u32 = 4;
    pub const ARRAY_STRIDE: u32 = 6;
    pub const MATRIX_STRIDE: u32 = 7;
    pub const BUILT_IN: u32 = 11;
    pub const NON_WRITABLE: u32 = 24;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const OFFSET: u32 = 35;
}

/// Storage class of push constants.
const PUSH_CONSTANT: u32 = 9;
/// `Dim` of texel buffers.
const DIM_BUFFER: u32 = 5;
/// Built-in of a workgroup's size.
const WORKGROUP_SIZE: u32 = 25;
/// Execution mode: invocations of a workgroup.
const LOCAL_SIZE: u32 = 17;
/// Image formats from number 1 on; 0 is unknown.
const FORMATS: &str = "Rgba32f Rgba16f R32f Rgba8 Rgba8Snorm Rg32f Rg16f R11fG11fB10f R16f Rgba16 \
    Rgb10A2 Rg16 Rg8 R16 R8 Rgba16Snorm Rg16Snorm Rg8Snorm R16Snorm R8Snorm Rgba32i Rgba16i Rgba8i \
    R32i Rg32i Rg16i Rg8i R16i R8i Rgba32ui Rgba16ui Rgba8ui R32ui Rgb10a2ui Rg32ui Rg16ui Rg8ui \
    R16ui R8ui";

/// One binding of a shader.
pub(crate) struct Binding {
    pub name: String,
    /// A `BindingKind` as Rust text.
    pub kind: String,
    pub written: bool,
}

/// Default of a specialisation constant, with its type.
pub(crate) enum Default {
    Bool(bool),
    Int(i32),
    Uint(u32),
    Float(f32),
}

/// One specialisation constant of a shader.
pub(crate) struct Constant {
    pub name: String,
    pub default: Default,
}

/// Reflection of a shader; bindings and constants by number.
pub(crate) struct Reflection {
    /// Struct of its push constants; `()` without any.
    pub push: String,
    pub bindings: BTreeMap<u32, Binding>,
    pub(crate) constants: BTreeMap<u32, Constant>,
    /// Invocations of a workgroup, unless constants set them.
    pub group_size: Option<[u32; 3]>,
}

/// One member of a struct of push constants.
#[derive(PartialEq)]
pub(crate) struct Member {
    pub offset: u32,
    pub name: String,
    /// As Rust text.
    pub of_type: String,
}

/// Structs of all shaders by name.
#[derive(Default)]
pub(crate) struct Layouts {
    /// Bytes and members of push constants, and of the structs in them.
    pub pushes: BTreeMap<String, (u32, Vec<Member>)>,
    /// Byte offsets by member, of all others.
    pub others: BTreeMap<String, BTreeMap<String, u32>>,
}

/// Reflects one shader and adds the layouts of its structs. Structs of one name must have one layout in all
/// shaders. The module must state the shader's name, as `compile::named` writes it.
pub(crate) fn reflect(name: &str, words: &[u32], layouts: &mut Layouts) -> Reflection {
    let d = Declarations::read(words).unwrap_or_else(|| {
        fail(&format!("{name}: the SPIR-V is cut off: found no OpFunctionEnd at its end"))
    });
    if d.shader != name {
        let found = &d.shader;
        fail(&format!(
            "{name}: found the SPIR-V of {found:?}, expected {name:?}; run tools/shaders"
        ));
    }
    let (push, bindings) = variables(name, &d, layouts);
    add_layouts(name, &d, layouts);
    Reflection { push, bindings, constants: constants(name, &d), group_size: d.group_size() }
}

/// Struct of the push constants, which it adds, and the bindings by number.
fn variables(
    name: &str,
    d: &Declarations<'_>,
    layouts: &mut Layouts,
) -> (String, BTreeMap<u32, Binding>) {
    let mut bindings = BTreeMap::new();
    let mut push = "()".to_owned();
    for (target, variable) in d.all(op::VARIABLE) {
        let [class, held] = *d.value(variable.of_type).operands else { continue };
        if class == PUSH_CONSTANT {
            (push, _) = push_type(name, d, (held, None), layouts);
            continue;
        }
        let Some(binding) = d.of(target, decoration::BINDING) else { continue };
        if d.of(target, decoration::DESCRIPTOR_SET).unwrap_or(0) != 0 {
            fail(&format!("{name}: only descriptor set 0 is used"));
        }
        let (kind, written) = match (d.value(held).code, d.value(held).operands) {
            (op::TYPE_STRUCT, members) => {
                let frozen = (0..members.len() as u32)
                    .all(|m| d.of_member(held, m, decoration::NON_WRITABLE).is_some());
                ("StorageBuffer".to_owned(), !frozen)
            }
            (op::TYPE_IMAGE, [_, DIM_BUFFER, ..]) => ("TexelBuffer".to_owned(), false),
            (op::TYPE_IMAGE, [texel, _, _, arrayed, _, sampled, format, ..]) => {
                let uint = d.value(*texel).code == op::TYPE_INT;
                let layered = *arrayed == 1;
                if *sampled == 2 {
                    let named = |before: usize| FORMATS.split_whitespace().nth(before);
                    let format = (*format as usize).checked_sub(1).and_then(named);
                    let Some(format) = format else {
                        fail(&format!(
                            "{name}: binding {binding}: a storage image without a format"
                        ))
                    };
                    let kind = format!(
                        "StorageImage {{ format: {format:?}, uint: {uint}, layered: {layered} }}"
                    );
                    (kind, d.of(target, decoration::NON_WRITABLE).is_none())
                } else {
                    (format!("SampledImage {{ uint: {uint}, layered: {layered} }}"), false)
                }
            }
            (code, _) => fail(&format!(
                "{name}: binding {binding} is a type of opcode {code}, which nothing here uses"
            )),
        };
        // A block without an instance name has the name of its type.
        let block = snake(&d.name(held));
        let name = Some(d.name(target)).filter(|n| !n.is_empty()).unwrap_or(block);
        bindings.insert(binding, Binding { name, kind, written });
    }
    (push, bindings)
}

/// Rust type and bytes of push constants or of a part of them, up to the end of its last member. Adds the structs.
///
/// `target` is a type, and where it holds matrices, the stride of their columns. Rust has neither gaps between elements
/// nor rows of matrices first: both are refused.
fn push_type(
    name: &str,
    d: &Declarations<'_>,
    (target, columns): (u32, Option<u32>),
    layouts: &mut Layouts,
) -> (String, u32) {
    let ty = d.value(target);
    let mut array = |element: u32, count: u32, stride: Option<(&str, Option<u32>)>| {
        let (element, bytes) = push_type(name, d, (element, columns), layouts);
        if let Some((what, found)) = stride
            && found != Some(bytes)
        {
            let found = found.map_or_else(|| "none".to_owned(), |n| n.to_string());
            fail(&format!("{name}: push constants: {what}: found {found}, expected {bytes}"));
        }
        (format!("[{element}; {count}]"), bytes * count)
    };
    match (ty.code, ty.operands) {
        (op::TYPE_FLOAT, _) => ("f32".to_owned(), 4),
        (op::TYPE_INT, [_, 1]) => ("i32".to_owned(), 4),
        (op::TYPE_INT, _) => ("u32".to_owned(), 4),
        (op::TYPE_VECTOR, [element, count]) => array(*element, *count, None),
        (op::TYPE_MATRIX, [column, count]) => {
            array(*column, *count, Some(("MatrixStride", columns)))
        }
        (op::TYPE_ARRAY, [element, count]) => {
            let size = d.value(*count);
            let (op::CONSTANT, [count]) = (size.code, size.operands) else {
                fail(&format!(
                    "{name}: push constants: the size of an array: expected an OpConstant of 32 bits"
                ))
            };
            array(*element, *count, Some(("ArrayStride", d.of(target, decoration::ARRAY_STRIDE))))
        }
        (op::TYPE_STRUCT, held) => {
            let structure = d.name(target);
            let mut end = 0;
            let member = |(m, held): (u32, &u32)| {
                let member = d.member_name(target, m);
                let of = |decoration| d.of_member(target, m, decoration);
                let Some(offset) = of(decoration::OFFSET) else {
                    fail(&format!("{name}: {structure}.{member}: found no Offset, expected one"))
                };
                if of(decoration::ROW_MAJOR).is_some() {
                    fail(&format!(
                        "{name}: {structure}.{member}: found RowMajor, expected ColMajor"
                    ));
                }
                let of_member = (*held, of(decoration::MATRIX_STRIDE));
                let (of_type, size) = push_type(name, d, of_member, layouts);
                end = end.max(offset + size);
                Member { offset, name: member, of_type }
            };
            let members: Vec<Member> = (0..).zip(held).map(member).collect();
            let layout = (end, members);
            if layouts.pushes.get(&structure).is_some_and(|known| *known != layout) {
                fail(&format!("{name}: {structure} has another layout than in an earlier shader"));
            }
            layouts.pushes.insert(structure.clone(), layout);
            (structure, end)
        }
        (code, _) => fail(&format!("{name}: a push constant holds a type of opcode {code}")),
    }
}

fn add_layouts(name: &str, d: &Declarations<'_>, layouts: &mut Layouts) {
    for (target, structure) in d.all(op::TYPE_STRUCT) {
        let type_name = d.name(target);
        let is_push = layouts.pushes.contains_key(&type_name);
        if type_name.is_empty() || type_name.starts_with("gl_") || is_push {
            continue;
        }
        for m in 0..structure.operands.len() as u32 {
            let Some(offset) = d.of_member(target, m, decoration::OFFSET) else { continue };
            let member = d.member_name(target, m);
            let known =
                layouts.others.entry(type_name.clone()).or_default().insert(member.clone(), offset);
            if known.is_some_and(|k| k != offset) {
                fail(&format!(
                    "{name}: {type_name}.{member} has another offset than in an earlier shader"
                ));
            }
        }
    }
}

/// The specialisation constants by number. GLSL does not name those of the workgroup size; they are
/// `LOCAL_SIZE_X`, `_Y` and `_Z`.
fn constants(name: &str, d: &Declarations<'_>) -> BTreeMap<u32, Constant> {
    let group_size = d.specialised_group_size();
    let axis_of = |target: u32| {
        let size = group_size?;
        let axis = size.operands.iter().position(|part| *part == target)?;
        Some(["LOCAL_SIZE_X", "LOCAL_SIZE_Y", "LOCAL_SIZE_Z"][axis].to_owned())
    };
    let mut constants = BTreeMap::new();
    for (&target, constant) in &d.values {
        let of_type = || d.value(constant.of_type);
        let default = match (constant.code, constant.operands) {
            (op::SPEC_CONSTANT_TRUE, _) => Default::Bool(true),
            (op::SPEC_CONSTANT_FALSE, _) => Default::Bool(false),
            (op::SPEC_CONSTANT, [word]) => match (of_type().code, of_type().operands) {
                (op::TYPE_FLOAT, _) => Default::Float(f32::from_bits(*word)),
                (_, [_, 1]) => Default::Int(word.cast_signed()),
                _ => Default::Uint(*word),
            },
            (op::SPEC_CONSTANT, _) => {
                fail(&format!("{name}: a specialisation constant of other than 32 bits"))
            }
            _ => continue,
        };
        let Some(number) = d.of(target, decoration::SPEC_ID) else { continue };
        let own_name = Some(d.name(target)).filter(|name| !name.is_empty());
        let Some(constant) = axis_of(target).or(own_name) else {
            fail(&format!("{name}: specialisation constant {number} has no name"))
        };
        if constants.insert(number, Constant { name: constant, default }).is_some() {
            fail(&format!("{name}: two specialisation constants have the number {number}"));
        }
    }
    constants
}

/// `SunShade` as `sun_shade`.
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

/// What a module declares before its functions.
struct Declarations<'m> {
    /// The name of the shader, empty where the module does not state it.
    shader: String,
    /// By id, and by member for those of members.
    names: HashMap<(u32, Option<u32>), String>,
    /// The first operand, 0 without any, by id, member and decoration.
    decorations: HashMap<(u32, Option<u32>, u32), u32>,
    /// Types, constants and variables by id.
    values: BTreeMap<u32, Value<'m>>,
    /// `LocalSize` of the entry point.
    local_size: Option<[u32; 3]>,
}

/// A type, a constant or a variable.
struct Value<'m> {
    code: u32,
    /// Id of its type; 0 for a type.
    of_type: u32,
    /// The operands after its id.
    operands: &'m [u32],
}

impl<'m> Declarations<'m> {
    /// `None` where the module does not end with the end of a function. The code of functions is walked, too: a module that
    /// is cut off there has all declarations.
    fn read(words: &'m [u32]) -> Option<Self> {
        let (mut names, mut decorations) = (HashMap::new(), HashMap::new());
        let (mut shader, mut values) = (String::new(), BTreeMap::new());
        let mut local_size = None;
        // After the header.
        let mut rest = words.get(5..)?;
        let (mut is_declared, mut last) = (false, 0);
        while let [first, ..] = *rest {
            let (instruction, others) = rest.split_at_checked((first >> 16) as usize)?;
            // An instruction of no words would be read for ever.
            let (_, body) = instruction.split_first()?;
            (rest, last) = (others, first & 0xffff);
            is_declared |= last == op::FUNCTION;
            if is_declared {
                continue;
            }
            let first_of = |operands: &[u32]| operands.first().copied().unwrap_or(0);
            match (last, body) {
                (op::NAME, [target, text @ ..]) => {
                    names.insert((*target, None), string(text));
                }
                (op::MEMBER_NAME, [target, member, text @ ..]) => {
                    names.insert((*target, Some(*member)), string(text));
                }
                (op::MODULE_PROCESSED, text) => shader = string(text),
                (op::EXECUTION_MODE, [_, LOCAL_SIZE, size @ ..]) => {
                    local_size = size.try_into().ok();
                }
                (op::DECORATE, [target, what, operands @ ..]) => {
                    decorations.insert((*target, None, *what), first_of(operands));
                }
                (op::MEMBER_DECORATE, [target, member, what, operands @ ..]) => {
                    decorations.insert((*target, Some(*member), *what), first_of(operands));
                }
                (code @ op::TYPE_VOID..=op::TYPE_FUNCTION, [id, operands @ ..]) => {
                    values.insert(*id, Value { code, of_type: 0, operands });
                }
                (
                    code @ (op::CONSTANT_TRUE..=op::SPEC_CONSTANT_OP | op::VARIABLE),
                    [of_type, id, operands @ ..],
                ) => {
                    values.insert(*id, Value { code, of_type: *of_type, operands });
                }
                _ => {}
            }
        }
        let found = Self { shader, names, decorations, values, local_size };
        (last == op::FUNCTION_END).then_some(found)
    }

    /// The constant that sets the invocations of a workgroup, if they are specialised.
    fn specialised_group_size(&self) -> Option<&Value<'m>> {
        let mut composites = self.all(op::SPEC_CONSTANT_COMPOSITE);
        let is_size = |target| self.of(target, decoration::BUILT_IN) == Some(WORKGROUP_SIZE);
        composites.find(|(target, _)| is_size(*target)).map(|(_, value)| value)
    }

    /// Invocations of a workgroup; `None` where they are specialised, and in graphics shaders.
    fn group_size(&self) -> Option<[u32; 3]> {
        self.local_size.filter(|_| self.specialised_group_size().is_none())
    }

    /// All values of an opcode, with their ids.
    fn all(&self, code: u32) -> impl Iterator<Item = (u32, &Value<'m>)> {
        let values = self.values.iter().map(|(id, value)| (*id, value));
        values.filter(move |(_, value)| value.code == code)
    }

    fn value(&self, id: u32) -> &Value<'m> {
        self.values.get(&id).unwrap_or_else(|| fail("SPIR-V: a type is missing"))
    }

    fn of(&self, target: u32, decoration: u32) -> Option<u32> {
        self.decorations.get(&(target, None, decoration)).copied()
    }

    fn of_member(&self, target: u32, member: u32, decoration: u32) -> Option<u32> {
        self.decorations.get(&(target, Some(member), decoration)).copied()
    }

    fn name(&self, target: u32) -> String {
        self.names.get(&(target, None)).cloned().unwrap_or_default()
    }

    fn member_name(&self, target: u32, member: u32) -> String {
        self.names.get(&(target, Some(member))).cloned().unwrap_or_default()
    }
}

/// A literal string, which ends with a byte 0.
fn string(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}
