//! What software drivers do not show of the shaders, read from their SPIR-V and sources.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};

/// Of GLSL.std.450: float, unsigned and signed.
const MAXIMA: [u32; 3] = [40, 41, 42];
const CLAMPS: [u32; 3] = [43, 44, 45];

/// Name and module of each shader.
fn modules() -> Vec<(String, Module)> {
    let list = include_str!(concat!(env!("OUT_DIR"), "/shaders.rs"));
    let bytes = include_bytes!(concat!(env!("OUT_DIR"), "/shaders.spv"));
    let words: Vec<u32> = bytes
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes(b.try_into().expect("four bytes")))
        .collect();
    let modules: Vec<_> = list
        .lines()
        .filter_map(|line| {
            let (_, rest) = line.split_once(": \"")?;
            let (name, rest) = rest.split_once('"')?;
            let mut numbers = rest.split_once("words ")?.1.trim_end_matches(',').split(' ');
            let mut number = || numbers.next()?.parse::<usize>().ok();
            let (first, count) = (number()?, number()?);
            let module = rspirv::dr::load_words(&words[first..first + count]).expect("a module");
            Some((name.to_owned(), module))
        })
        .collect();
    assert!(modules.len() > 60, "{} modules", modules.len());
    modules
}

fn instructions(module: &Module) -> impl Iterator<Item = &Instruction> {
    module.all_inst_iter()
}

fn id(operand: &Operand) -> u32 {
    operand.id_ref_any().expect("an id")
}

/// Whether an instruction is one of these of GLSL.std.450.
fn is_glsl(instruction: &Instruction, ops: &[u32]) -> bool {
    instruction.class.opcode == Op::ExtInst
        && matches!(instruction.operands[1], Operand::LiteralExtInstInteger(n) if ops.contains(&n))
}

/// What makes each value of a module.
struct Sources<'a> {
    by_result: HashMap<u32, &'a Instruction>,
    /// All that is stored in each variable, also in parts of it.
    stored: HashMap<u32, Vec<u32>>,
    /// Arguments of all calls for each parameter, and what each function returns.
    given: HashMap<u32, Vec<u32>>,
}

impl<'a> Sources<'a> {
    fn of(module: &'a Module) -> Self {
        let by_result: HashMap<u32, &Instruction> =
            instructions(module).filter_map(|i| Some((i.result_id?, i))).collect();
        let (mut stored, mut given) = (HashMap::new(), HashMap::new());
        for store in instructions(module).filter(|i| i.class.opcode == Op::Store) {
            let [variable, value] = [0, 1].map(|at| id(&store.operands[at]));
            // A part beside others: the variable itself stands for them.
            let (whole, parts) = match by_result[&variable].class.opcode {
                Op::AccessChain => {
                    let whole = id(&by_result[&variable].operands[0]);
                    (whole, vec![whole, value])
                }
                _ => (variable, vec![value]),
            };
            stored.entry(whole).or_insert_with(Vec::new).extend(parts);
        }
        let mut parameters = HashMap::new();
        for function in &module.functions {
            let own = function.def.as_ref().and_then(|def| def.result_id).expect("a function");
            let all = function.parameters.iter().filter_map(|p| p.result_id);
            parameters.insert(own, all.collect::<Vec<u32>>());
            let code = function.blocks.iter().flat_map(|block| &block.instructions);
            for end in code.filter(|i| i.class.opcode == Op::ReturnValue) {
                given.entry(own).or_insert_with(Vec::new).push(id(&end.operands[0]));
            }
        }
        for call in instructions(module).filter(|i| i.class.opcode == Op::FunctionCall) {
            let arguments = call.operands[1..].iter().map(id);
            for (parameter, argument) in parameters[&id(&call.operands[0])].iter().zip(arguments) {
                given.entry(*parameter).or_insert_with(Vec::new).push(argument);
            }
        }
        Self { by_result, stored, given }
    }

    /// The value behind loads of variables that are stored once, as those of function arguments are; else the variable.
    fn id(&self, mut value: u32) -> u32 {
        while self.by_result[&value].class.opcode == Op::Load {
            let variable = id(&self.by_result[&value].operands[0]);
            match self.stored.get(&variable).map(Vec::as_slice) {
                Some([stored]) => value = *stored,
                _ => return variable,
            }
        }
        value
    }

    fn instruction(&self, value: u32) -> &'a Instruction {
        self.by_result[&self.id(value)]
    }

    /// Everything that can make a value: through variables and parts of them, parameters and results of functions, and
    /// what only moves values or changes their sign.
    fn makers(&self, value: u32) -> Vec<&'a Instruction> {
        let (mut open, mut visited, mut found) = (vec![value], Vec::new(), Vec::new());
        while let Some(value) = open.pop().filter(|value| self.by_result.contains_key(value)) {
            if !visited.contains(&value) {
                visited.push(value);
                let made = self.by_result[&value];
                found.push(made);
                open.extend(self.stored.get(&value).into_iter().flatten());
                open.extend(self.given.get(&value).into_iter().flatten());
                let moves = [
                    Op::Load,
                    Op::AccessChain,
                    Op::FunctionCall,
                    Op::CompositeExtract,
                    Op::CompositeConstruct,
                    Op::CompositeInsert,
                    Op::VectorShuffle,
                    Op::VectorExtractDynamic,
                    Op::CopyObject,
                    Op::Select,
                    Op::Phi,
                    Op::FNegate,
                ];
                if moves.contains(&made.class.opcode) {
                    open.extend(made.operands.iter().filter_map(Operand::id_ref_any));
                }
            }
        }
        found
    }

    /// As [`Self::id`], and of a vector of one number repeated that number.
    fn scalar(&self, value: u32) -> u32 {
        let made = self.instruction(value);
        let parts: Vec<u32> = made
            .operands
            .iter()
            .filter_map(Operand::id_ref_any)
            .map(|part| self.id(part))
            .collect();
        let is_repeated =
            made.class.opcode == Op::CompositeConstruct && parts.windows(2).all(|p| p[0] == p[1]);
        if is_repeated { parts[0] } else { self.id(value) }
    }
}

/// Clamps whose lower bound may exceed the upper: it is not constant, and the upper is not a maximum of it.
fn loose_clamps(module: &Module) -> usize {
    let sources = Sources::of(module);
    let is_constant =
        |id: u32| format!("{:?}", sources.by_result[&id].class.opcode).contains("Constant");
    instructions(module)
        .filter(|i| is_glsl(i, &CLAMPS))
        .filter(|clamp| {
            let [low, high] = [3, 4].map(|at| sources.scalar(id(&clamp.operands[at])));
            let upper = sources.by_result[&high];
            let is_maximum = is_glsl(upper, &MAXIMA)
                && upper.operands[2..].iter().any(|part| sources.scalar(id(part)) == low);
            !is_constant(low) && !is_maximum
        })
        .count()
}

/// The bounds of a clamp are in order: otherwise GLSL leaves the result undefined, and drivers differ. Constant lower
/// bounds are 0 or less than sizes and counts, which are at least 1.
#[test]
fn clamps_have_their_bounds_in_order() {
    let loose: Vec<_> = modules()
        .iter()
        .map(|(name, module)| (name.clone(), loose_clamps(module)))
        .filter(|(_, count)| *count > 0)
        .collect();
    assert!(loose.is_empty(), "{loose:?}");
}

/// Products that a compiler may contract into the sum that takes them: neither is marked NoContraction.
fn contractible(module: &Module) -> usize {
    let exact: Vec<u32> = module
        .annotations
        .iter()
        .filter(|i| i.operands.get(1) == Some(&Operand::Decoration(Decoration::NoContraction)))
        .map(|i| id(&i.operands[0]))
        .collect();
    let sources = Sources::of(module);
    let is_exact = |i: &Instruction| i.result_id.is_some_and(|id| exact.contains(&id));
    let products = [Op::FMul, Op::VectorTimesScalar, Op::Dot];
    instructions(module)
        .filter(|i| [Op::FAdd, Op::FSub].contains(&i.class.opcode) && !is_exact(i))
        .flat_map(|sum| sum.operands.iter().filter_map(Operand::id_ref_any))
        .filter(|part| {
            let mut made = sources.makers(*part).into_iter();
            made.any(|made| products.contains(&made.class.opcode) && !is_exact(made))
        })
        .count()
}

/// The radiance is the sum of the layers to the bit, and an edit's light and lattices, by other pipelines, those of a whole
/// frame: nothing is contracted. The other passes of an edit have the pipelines of the frame's.
#[test]
fn what_edits_repeat_in_other_pipelines_is_not_contracted() {
    let all = modules();
    let of =
        |wanted: &str| contractible(&all.iter().find(|(name, _)| name == wanted).expect("it").1);
    for name in ["light_resolve", "horizon_sweep", "horizon_resweep"] {
        assert_eq!(of(name), 0, "{name}");
    }
    assert!(of("sky_shade") > 0, "the check finds sums that may be contracted");
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| ["glsl", "comp"].iter().any(|known| e == *known))
        {
            found.push(path);
        }
    }
}

/// Only shared/half.glsl packs f16, rounded before. Drivers round packHalf2x16 as they like.
#[test]
fn f16_is_packed_in_one_place() {
    let mut all = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders_glsl"), &mut all);
    let packing: Vec<_> = all
        .iter()
        .filter(|path| {
            let text = std::fs::read_to_string(path).expect("text");
            text.lines().any(|line| {
                line.split("//")
                    .next()
                    .is_some_and(|code| code.replace("unpackHalf2x16", "").contains("packHalf2x16"))
            })
        })
        .filter_map(|path| path.file_name())
        .collect();
    // unpackHalf2x16 is exact for the numbers that are stored.
    assert_eq!(packing, ["half.glsl"]);
}
