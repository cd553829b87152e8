//! Replaces specialisation constants in SPIR-V by plain constants.
//!
//! A driver may do this first of all. SwiftShader does not: it compiles both sides of every branch on a
//! setting, which is most of its pipeline creation time.

use std::collections::HashMap;

use super::shaders::Shader;

/// Words before the first instruction.
const HEADER: usize = 5;

// SPIR-V 1.6, §3.52 and, of decorations, §3.20.
const TYPE_BOOL: u32 = 20;
const CONSTANT_TRUE: u32 = 41;
const CONSTANT_FALSE: u32 = 42;
const CONSTANT: u32 = 43;
const CONSTANT_COMPOSITE: u32 = 44;
const SPEC_CONSTANT_TRUE: u32 = 48;
const SPEC_CONSTANT_FALSE: u32 = 49;
const SPEC_CONSTANT: u32 = 50;
const SPEC_CONSTANT_COMPOSITE: u32 = 51;
const SPEC_CONSTANT_OP: u32 = 52;
const DECORATE: u32 = 71;
const COMPOSITE_EXTRACT: u32 = 81;
const SPEC_ID: u32 = 1;

/// A shader's module with `words` in place of its specialisation constants, in their order; the rest get their
/// defaults.
pub(crate) fn specialised(shader: &Shader, words: &[u32]) -> Vec<u32> {
    let numbered: Vec<_> =
        shader.constants.iter().map(|constant| constant.id).zip(words.iter().copied()).collect();
    with_constants(shader.words, &numbered)
}

/// A module with `constants`, (constant_id, word), in place of its specialisation constants; the others get
/// their defaults. Operations unknown to [`folded`] stay unchanged.
fn with_constants(words: &[u32], constants: &[(u32, u32)]) -> Vec<u32> {
    let mut out = words[..HEADER].to_vec();
    // By result id: the requested words; values of scalars and of vectors.
    let (mut requested, mut known) = (HashMap::new(), HashMap::new());
    let mut vectors: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut bool_type = None;
    let mut rest = &words[HEADER..];
    while let Some(first) = rest.first() {
        let (instruction, after) = rest.split_at((first >> 16) as usize);
        rest = after;
        match (first & 0xffff, instruction) {
            (DECORATE, [_, id, SPEC_ID, number]) => {
                let given = constants.iter().find(|c| c.0 == *number);
                requested.extend(given.map(|c| (*id, c.1)));
                continue;
            }
            (TYPE_BOOL, [_, id]) => bool_type = Some(*id),
            (SPEC_CONSTANT_COMPOSITE, [_, _, id, ids @ ..]) => {
                if let Some(values) = all_of(&known, ids) {
                    vectors.insert(*id, values);
                    out.push(first - SPEC_CONSTANT_COMPOSITE + CONSTANT_COMPOSITE);
                    out.extend(&instruction[1..]);
                    continue;
                }
            }
            (op @ CONSTANT_TRUE..=SPEC_CONSTANT_OP, [_, of_type, id, operands @ ..]) => {
                let value = match (op, operands) {
                    (SPEC_CONSTANT_OP, [COMPOSITE_EXTRACT, vector, place]) => {
                        vectors.get(vector).map(|values| values[*place as usize])
                    }
                    (SPEC_CONSTANT_OP, [op, ids @ ..]) => {
                        all_of(&known, ids).and_then(|values| folded(*op, &values))
                    }
                    (CONSTANT_TRUE | SPEC_CONSTANT_TRUE, []) => Some(1),
                    (CONSTANT_FALSE | SPEC_CONSTANT_FALSE, []) => Some(0),
                    (CONSTANT | SPEC_CONSTANT, [word]) => Some(*word),
                    _ => None,
                };
                if let Some(default) = value {
                    let value = requested.get(id).copied().unwrap_or(default);
                    known.insert(*id, value);
                    match (bool_type == Some(*of_type), value) {
                        (true, 0) => out.extend([3 << 16 | CONSTANT_FALSE, *of_type, *id]),
                        (true, _) => out.extend([3 << 16 | CONSTANT_TRUE, *of_type, *id]),
                        (false, _) => out.extend([4 << 16 | CONSTANT, *of_type, *id, value]),
                    }
                    continue;
                }
            }
            _ => {}
        }
        out.extend(instruction);
    }
    out
}

/// The values of these ids, where all are known.
fn all_of(known: &HashMap<u32, u32>, ids: &[u32]) -> Option<Vec<u32>> {
    ids.iter().map(|id| known.get(id).copied()).collect()
}

/// The result of an operation that the shaders have on constants, booleans as 0 and 1; none where it is undefined or
/// unknown here.
fn folded(op: u32, operands: &[u32]) -> Option<u32> {
    let signed = |v: u32| v as i32;
    Some(match (op, operands) {
        (128, &[a, b]) => a.wrapping_add(b),
        (130, &[a, b]) => a.wrapping_sub(b),
        (132, &[a, b]) => a.wrapping_mul(b),
        (135, &[a, b]) => signed(a).checked_div(signed(b))? as u32,
        (170, &[a, b]) => u32::from(a == b),
        (171, &[a, b]) => u32::from(a != b),
        (166, &[a, b]) => a | b,
        (167, &[a, b]) => a & b,
        (168, &[a]) => 1 - a,
        (169, &[c, a, b]) => [b, a][c as usize],
        (173, &[a, b]) => u32::from(signed(a) > signed(b)),
        (196, &[a, b]) => a.checked_shl(b)?,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::shaders;
    use crate::graph::shaders::Specialised;

    /// Opcodes and operands of a module.
    fn instructions(words: &[u32]) -> Vec<(u32, &[u32])> {
        let (mut all, mut rest) = (Vec::new(), &words[HEADER..]);
        while let Some(first) = rest.first() {
            let (instruction, after) = rest.split_at((first >> 16) as usize);
            all.push((first & 0xffff, &instruction[1..]));
            rest = after;
        }
        all
    }

    /// In every shader only the constants and the decorations that number them change.
    #[test]
    fn no_constant_is_left_to_the_driver() {
        let mut count = 0;
        for shader in shaders::ALL.iter().chain(shaders::GRAPHICS) {
            let made = specialised(shader, &[]);
            let is_number = |(op, o): &(u32, &[u32])| *op == DECORATE && o[1] == SPEC_ID;
            let before = instructions(shader.words).into_iter().filter(|i| !is_number(i));
            let (before, after): (Vec<_>, _) = (before.collect(), instructions(&made));
            assert_eq!(before.len(), after.len(), "{}", shader.name);
            for (old, new) in before.iter().zip(&after) {
                let is_spec = (SPEC_CONSTANT_TRUE..=SPEC_CONSTANT_OP).contains(&old.0);
                count += usize::from(is_spec);
                let is_plain = (CONSTANT_TRUE..=CONSTANT_COMPOSITE).contains(&new.0);
                let is_right =
                    if is_spec { is_plain && old.1[..2] == new.1[..2] } else { old == new };
                assert!(is_right, "{}: {old:?} became {new:?}", shader.name);
            }
        }
        assert!(count > 100, "{count}");
    }

    /// Words of the generated structs are in the order of the shader's constants, and their defaults are the
    /// module's.
    #[test]
    fn generated_defaults_are_the_modules() {
        let all: [Specialised; 4] = [
            shaders::HorizonSweep::default().into(),
            shaders::PathTrace::default().into(),
            shaders::PictureToneFrag::default().into(),
            shaders::SunShade::default().into(),
        ];
        for Specialised { shader, constants } in all {
            assert_eq!(constants.len(), shader.constants.len(), "{}", shader.name);
            let [given, own] = [specialised(shader, &constants), specialised(shader, &[])];
            assert_eq!(given, own, "{}", shader.name);
        }
    }

    /// bool, u32; a boolean and a number of 7 that are requested, a 5 that is not, their sum, the boolean's
    /// selection of it, a vector of both numbers and its second component, and an unknown operation.
    #[test]
    fn constants_become_the_requested_words() {
        let [boolean, uint, is, seven, five, sum, selected, pair, second, other] =
            [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
        let op = |code: u32, operands: &[u32]| {
            [&[(operands.len() as u32 + 1) << 16 | code], operands].concat()
        };
        let module = |all: &[Vec<u32>]| [&[0; HEADER][..], &all.concat()].concat();
        let given = module(&[
            op(DECORATE, &[is, SPEC_ID, 10]),
            op(DECORATE, &[seven, SPEC_ID, 11]),
            op(DECORATE, &[five, SPEC_ID, 12]),
            op(TYPE_BOOL, &[boolean]),
            op(21, &[uint, 32, 0]),
            op(SPEC_CONSTANT_FALSE, &[boolean, is]),
            op(SPEC_CONSTANT, &[uint, seven, 0]),
            op(SPEC_CONSTANT, &[uint, five, 5]),
            op(SPEC_CONSTANT_OP, &[uint, sum, 128, seven, five]),
            op(SPEC_CONSTANT_OP, &[uint, selected, 169, is, sum, five]),
            op(SPEC_CONSTANT_COMPOSITE, &[99, pair, seven, five]),
            op(SPEC_CONSTANT_OP, &[uint, second, COMPOSITE_EXTRACT, pair, 1]),
            op(SPEC_CONSTANT_OP, &[uint, other, 9999, five]),
        ]);
        let expected = module(&[
            op(TYPE_BOOL, &[boolean]),
            op(21, &[uint, 32, 0]),
            op(CONSTANT_TRUE, &[boolean, is]),
            op(CONSTANT, &[uint, seven, 7]),
            op(CONSTANT, &[uint, five, 5]),
            op(CONSTANT, &[uint, sum, 12]),
            op(CONSTANT, &[uint, selected, 12]),
            op(CONSTANT_COMPOSITE, &[99, pair, seven, five]),
            op(CONSTANT, &[uint, second, 5]),
            op(SPEC_CONSTANT_OP, &[uint, other, 9999, five]),
        ]);
        assert_eq!(with_constants(&given, &[(10, 1), (11, 7), (13, 1)]), expected);
    }

    #[test]
    fn operations_are_those_of_the_shaders() {
        let minus = |v: u32| v.wrapping_neg();
        for (op, operands, result) in [
            (128, &[minus(1), 3][..], Some(2)),
            (130, &[2, 5], Some(minus(3))),
            (132, &[minus(4), 3], Some(minus(12))),
            (135, &[minus(7), 2], Some(minus(3))),
            (135, &[7, 0], None),
            (166, &[0, 1], Some(1)),
            (167, &[0, 1], Some(0)),
            (168, &[0], Some(1)),
            (169, &[0, 8, 9], Some(9)),
            (170, &[4, 4], Some(1)),
            (171, &[4, 4], Some(0)),
            (173, &[minus(1), 1], Some(0)),
            (196, &[1, 15], Some(32768)),
            (196, &[1, 32], None),
            (9999, &[0], None),
        ] {
            assert_eq!(folded(op, operands), result, "{op} of {operands:?}");
        }
    }
}
