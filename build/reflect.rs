//! Reflects a SPIR-V module: bindings, push constants and specialisation constants.

use std::collections::BTreeMap;

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Dim, ImageFormat, Op, StorageClass};

use super::fail;

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
/// shaders.
pub(crate) fn reflect(name: &str, words: &[u32], layouts: &mut Layouts) -> Reflection {
    let module = rspirv::dr::load_words(words).unwrap_or_else(|e| fail(&format!("{name}: {e:?}")));
    let d = Decorations { module: &module };
    let (push, bindings) = variables(name, &d, layouts);
    add_layouts(name, &d, layouts);
    Reflection { push, bindings, constants: constants(name, &d) }
}

/// Struct of the push constants, which it adds, and the bindings by number.
fn variables(
    name: &str,
    d: &Decorations<'_>,
    layouts: &mut Layouts,
) -> (String, BTreeMap<u32, Binding>) {
    let mut bindings = BTreeMap::new();
    let mut push = "()".to_owned();
    for variable in &d.module.types_global_values {
        if variable.class.opcode != Op::Variable {
            continue;
        }
        let target = variable.result_id.expect("a variable has an id");
        let pointer = d.ty(variable.result_type.expect("a variable has a type"));
        let Operand::StorageClass(class) = pointer.operands[0] else { continue };
        let pointee = d.ty(id(&pointer.operands[1]));
        if class == StorageClass::PushConstant {
            (push, _) = push_type(name, d, (id(&pointer.operands[1]), None), layouts);
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
                    if format == ImageFormat::Unknown {
                        fail(&format!(
                            "{name}: binding {binding}: a storage image without a format"
                        ));
                    }
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
        // A block without an instance name has the name of its type.
        let block = snake(&d.name(pointee.result_id.expect("a type has an id")));
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
    d: &Decorations<'_>,
    (target, columns): (u32, Option<u32>),
    layouts: &mut Layouts,
) -> (String, u32) {
    let ty = d.ty(target);
    let mut array = |count: u32, stride: Option<(&str, Option<u32>)>| {
        let (element, bytes) = push_type(name, d, (id(&ty.operands[0]), columns), layouts);
        if let Some((what, found)) = stride
            && found != Some(bytes)
        {
            let found = found.map_or_else(|| "none".to_owned(), |n| n.to_string());
            fail(&format!("{name}: push constants: {what}: found {found}, expected {bytes}"));
        }
        (format!("[{element}; {count}]"), bytes * count)
    };
    match ty.class.opcode {
        Op::TypeFloat => ("f32".to_owned(), 4),
        Op::TypeInt if literal(&ty.operands[1]) == 1 => ("i32".to_owned(), 4),
        Op::TypeInt => ("u32".to_owned(), 4),
        Op::TypeVector => array(literal(&ty.operands[1]), None),
        Op::TypeMatrix => array(literal(&ty.operands[1]), Some(("MatrixStride", columns))),
        Op::TypeArray => {
            let count = literal(&d.ty(id(&ty.operands[1])).operands[0]);
            array(count, Some(("ArrayStride", d.of(target, Decoration::ArrayStride))))
        }
        Op::TypeStruct => {
            let structure = d.name(target);
            let mut end = 0;
            let member = |(m, operand)| {
                let member = d.member_name(target, m as u32);
                let of = |decoration| d.of_member(target, m as u32, decoration);
                let Some(offset) = of(Decoration::Offset) else {
                    fail(&format!("{name}: {structure}.{member}: found no Offset, expected one"))
                };
                if of(Decoration::RowMajor).is_some() {
                    fail(&format!(
                        "{name}: {structure}.{member}: found RowMajor, expected ColMajor"
                    ));
                }
                let of_member = (id(operand), of(Decoration::MatrixStride));
                let (of_type, size) = push_type(name, d, of_member, layouts);
                end = end.max(offset + size);
                Member { offset, name: member, of_type }
            };
            let members: Vec<Member> = ty.operands.iter().enumerate().map(member).collect();
            let layout = (end, members);
            if layouts.pushes.get(&structure).is_some_and(|known| *known != layout) {
                fail(&format!("{name}: {structure} has another layout than in an earlier shader"));
            }
            layouts.pushes.insert(structure.clone(), layout);
            (structure, end)
        }
        other => fail(&format!("{name}: a push constant holds a {other:?}")),
    }
}

fn add_layouts(name: &str, d: &Decorations<'_>, layouts: &mut Layouts) {
    for structure in &d.module.types_global_values {
        if structure.class.opcode != Op::TypeStruct {
            continue;
        }
        let target = structure.result_id.expect("a struct has an id");
        let type_name = d.name(target);
        let is_push = layouts.pushes.contains_key(&type_name);
        if type_name.is_empty() || type_name.starts_with("gl_") || is_push {
            continue;
        }
        for m in 0..structure.operands.len() as u32 {
            let Some(offset) = d.of_member(target, m, Decoration::Offset) else { continue };
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
fn constants(name: &str, d: &Decorations<'_>) -> BTreeMap<u32, Constant> {
    let values = &d.module.types_global_values;
    let group_size = values.iter().find(|i| {
        i.class.opcode == Op::SpecConstantComposite && d.is_group_size(i.result_id.unwrap_or(0))
    });
    let axis_of = |target: u32| {
        let parts = &group_size?.operands;
        let axis = parts.iter().position(|part| id(part) == target)?;
        Some(["LOCAL_SIZE_X", "LOCAL_SIZE_Y", "LOCAL_SIZE_Z"][axis].to_owned())
    };
    let mut constants = BTreeMap::new();
    for constant in values {
        let target = constant.result_id.unwrap_or(0);
        let default = match constant.class.opcode {
            Op::SpecConstantTrue => Default::Bool(true),
            Op::SpecConstantFalse => Default::Bool(false),
            Op::SpecConstant => {
                let of_type = d.ty(constant.result_type.expect("a constant has a type"));
                let [Operand::LiteralBit32(word)] = constant.operands[..] else {
                    fail(&format!("{name}: a specialisation constant of other than 32 bits"))
                };
                match (of_type.class.opcode, of_type.operands.get(1)) {
                    (Op::TypeFloat, _) => Default::Float(f32::from_bits(word)),
                    (_, Some(Operand::LiteralBit32(1))) => Default::Int(word as i32),
                    _ => Default::Uint(word),
                }
            }
            _ => continue,
        };
        let Some(number) = d.of(target, Decoration::SpecId) else { continue };
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

fn id(operand: &Operand) -> u32 {
    operand.id_ref_any().unwrap_or_else(|| fail("SPIR-V: an id was expected"))
}

fn literal(operand: &Operand) -> u32 {
    match operand {
        Operand::LiteralBit32(n) => *n,
        _ => fail("SPIR-V: a literal was expected"),
    }
}

/// Decorations of a module.
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

    /// Whether it is a dimension of the workgroup size.
    fn is_group_size(&self, target: u32) -> bool {
        self.module.annotations.iter().any(|a| {
            a.class.opcode == Op::Decorate
                && id(&a.operands[0]) == target
                && a.operands[1] == Operand::Decoration(Decoration::BuiltIn)
                && a.operands[2] == Operand::BuiltIn(BuiltIn::WorkgroupSize)
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
