//! build/reflect.rs on modules that no shader of the library has: push constants whose Rust struct would lie otherwise.

#[path = "../../build/reflect.rs"]
#[allow(dead_code, reason = "the build script reads bindings and constants, too")]
mod reflect;

use reflect::{Layouts, Reflection};
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Operand};
use rspirv::spirv::{Decoration, StorageClass};

fn fail(message: &str) -> ! {
    panic!("{message}")
}

type Member = (u32, Option<u32>);

const FUNCTION: u32 = (1 << 16) | 54;
/// The last instruction of a whole module.
const FUNCTION_END: u32 = (1 << 16) | 56;
/// A module's first five words.
const HEADER: [u32; 5] = [0x0723_0203, 0, 0, 0, 0];
/// OpModuleProcessed: the name of the shader.
const NAMED_TEST: [u32; 3] = [(3 << 16) | 330, u32::from_le_bytes(*b"test"), 0];

/// Reflects push constants: `add` gives types and offsets of the members of `TestPush`.
fn reflected(add: impl FnOnce(&mut Builder) -> Vec<Member>) -> (Reflection, Layouts) {
    let mut builder = Builder::new();
    builder.module_processed("test");
    let members = add(&mut builder);
    let structure = builder.type_struct(members.iter().map(|(of_type, _)| *of_type));
    builder.name(structure, "TestPush");
    for (m, (_, offset)) in (0..).zip(&members) {
        builder.member_name(structure, m, format!("m{m}"));
        if let Some(offset) = offset {
            let offset = [Operand::LiteralBit32(*offset)];
            builder.member_decorate(structure, m, Decoration::Offset, offset);
        }
    }
    let pointer = builder.type_pointer(None, StorageClass::PushConstant, structure);
    builder.variable(pointer, None, StorageClass::PushConstant, None);
    let mut words = builder.module().assemble();
    words.push(FUNCTION_END);
    let mut layouts = Layouts::default();
    let found = reflect::reflect("test", &words, &mut layouts);
    (found, layouts)
}

fn types(layouts: &Layouts) -> Vec<&str> {
    layouts.pushes["TestPush"].1.iter().map(|member| member.of_type.as_str()).collect()
}

/// An array of `count` floats with a stride.
fn floats(builder: &mut Builder, count: u32, stride: Option<u32>) -> u32 {
    let (float, uint) = (builder.type_float(32, None), builder.type_int(32, 0));
    let count = builder.constant_bit32(uint, count);
    let array = builder.type_array(float, count);
    if let Some(stride) = stride {
        builder.decorate(array, Decoration::ArrayStride, [Operand::LiteralBit32(stride)]);
    }
    array
}

/// Two columns of two rows: the struct's member 0, in columns or rows.
fn matrix(builder: &mut Builder, stride: Option<u32>, order: Decoration) -> u32 {
    let float = builder.type_float(32, None);
    let column = builder.type_vector(float, 2);
    let matrix = builder.type_matrix(column, 2);
    // The struct is made next, after this matrix.
    let structure = matrix + 1;
    if let Some(stride) = stride {
        let stride = [Operand::LiteralBit32(stride)];
        builder.member_decorate(structure, 0, Decoration::MatrixStride, stride);
    }
    builder.member_decorate(structure, 0, order, []);
    matrix
}

/// Reflects a module of the shader `test` with these instructions.
fn read(instructions: &[u32]) {
    let words = [&HEADER[..], &NAMED_TEST, instructions].concat();
    reflect::reflect("test", &words, &mut Layouts::default());
}

/// The committed SPIR-V has modules in the order of their sources. If one is removed and another is added, later ones move.
#[test]
#[should_panic(expected = "other: found the SPIR-V of \"test\", expected \"other\"")]
fn modules_of_other_shaders_are_refused() {
    let words = [&HEADER[..], &NAMED_TEST, &[FUNCTION, FUNCTION_END]].concat();
    reflect::reflect("other", &words, &mut Layouts::default());
}

#[test]
#[should_panic(expected = "test: found the SPIR-V of \"\", expected \"test\"")]
fn modules_without_a_name_are_refused() {
    let words = [&HEADER[..], &[FUNCTION, FUNCTION_END]].concat();
    reflect::reflect("test", &words, &mut Layouts::default());
}

/// OpFunction, OpFunctionEnd: neither declares anything.
#[test]
fn modules_that_end_with_a_function_are_whole() {
    read(&[FUNCTION, FUNCTION_END]);
}

/// An instruction of two words, of which the module has one.
#[test]
#[should_panic(expected = "the SPIR-V is cut off")]
fn modules_that_end_in_an_instruction_are_refused() {
    read(&[FUNCTION, 2 << 16]);
}

#[test]
#[should_panic(expected = "the SPIR-V is cut off")]
fn modules_that_end_in_a_function_are_refused() {
    read(&[FUNCTION, FUNCTION_END, FUNCTION]);
}

#[test]
#[should_panic(expected = "the SPIR-V is cut off")]
fn instructions_of_no_words_are_refused() {
    read(&[0, FUNCTION_END]);
}

/// The last member ends before another one: 8 + 4·4 = 24 bytes.
#[test]
fn bytes_reach_to_the_farthest_member() {
    let (found, layouts) = reflected(|b| {
        let float = b.type_float(32, None);
        let array = floats(b, 4, Some(4));
        vec![(array, Some(8)), (float, Some(0))]
    });
    assert_eq!((found.push.as_str(), layouts.pushes["TestPush"].0), ("TestPush", 24));
    assert_eq!(types(&layouts), ["[f32; 4]", "f32"]);
}

#[test]
fn matrices_are_arrays_of_columns() {
    let (found, layouts) = reflected(|b| vec![(matrix(b, Some(8), Decoration::ColMajor), Some(0))]);
    assert_eq!((found.push.as_str(), layouts.pushes["TestPush"].0), ("TestPush", 16));
    assert_eq!(types(&layouts), ["[[f32; 2]; 2]"]);
}

#[test]
#[should_panic(expected = "ArrayStride: found 16, expected 4")]
fn arrays_with_gaps_are_refused() {
    reflected(|b| vec![(floats(b, 4, Some(16)), Some(0))]);
}

#[test]
#[should_panic(expected = "ArrayStride: found none, expected 4")]
fn arrays_without_a_stride_are_refused() {
    reflected(|b| vec![(floats(b, 4, None), Some(0))]);
}

/// Rust's array has one size, whatever the constant is specialised to.
#[test]
#[should_panic(expected = "the size of an array: expected an OpConstant")]
fn arrays_of_a_specialised_size_are_refused() {
    reflected(|b| {
        let (float, uint) = (b.type_float(32, None), b.type_int(32, 0));
        let count = b.spec_constant_bit32(uint, 4);
        let array = b.type_array(float, count);
        b.decorate(array, Decoration::ArrayStride, [Operand::LiteralBit32(4)]);
        vec![(array, Some(0))]
    });
}

#[test]
#[should_panic(expected = "MatrixStride: found 16, expected 8")]
fn matrices_with_gaps_are_refused() {
    reflected(|b| vec![(matrix(b, Some(16), Decoration::ColMajor), Some(0))]);
}

#[test]
#[should_panic(expected = "TestPush.m0: found RowMajor, expected ColMajor")]
fn matrices_by_rows_are_refused() {
    reflected(|b| vec![(matrix(b, Some(8), Decoration::RowMajor), Some(0))]);
}

#[test]
#[should_panic(expected = "TestPush.m1: found no Offset, expected one")]
fn members_without_an_offset_are_refused() {
    reflected(|b| {
        let float = b.type_float(32, None);
        vec![(float, Some(0)), (float, None)]
    });
}
