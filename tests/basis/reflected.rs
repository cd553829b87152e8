//! The constants with which `bounce_gather` projects the light of a slice into three bands of a clamped cosine: the
//! shader's own text, against integrals. On the device some of them change a case by less than its tolerance.

use crate::glsl::Machine;
use ridgelight_cpu::basis::nlp;
use ridgelight_cpu::basis::occlusion;
use std::f64::consts::{FRAC_PI_2, PI};

const SHADER: &str = include_str!("../../shaders_glsl/bounce/bounce_gather.comp");

/// The statements of a function, as the reader of sums takes them: the components of its result are `out[0]` to
/// `out[3]`.
fn body(name: &str) -> String {
    let begin = SHADER.find(&format!("vec4 {name}(")).expect("a function");
    let text = &SHADER[begin..];
    let text = &text[text.find('{').expect("a body") + 1..text.find("\n}").expect("an end")];
    let (lines, returned) = text.split_once("return vec4(").expect("four numbers");
    let mut all: Vec<String> = lines
        .split(';')
        .map(|line| line.trim().trim_start_matches("float ").to_owned())
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
        .collect();
    let (mut depth, mut part, mut parts) = (0, String::new(), Vec::new());
    for c in returned.trim_end().trim_end_matches(';').chars() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        match c {
            ',' if depth == 0 => parts.push(std::mem::take(&mut part)),
            // The bracket that closes the function.
            _ if depth < 0 => break,
            c => part.push(if c.is_whitespace() { ' ' } else { c }),
        }
    }
    parts.push(part);
    assert_eq!(parts.len(), 4, "{parts:?}");
    for (i, part) in parts.iter().enumerate() {
        let part = part.trim();
        // Signs of names; numbers have their own.
        let part = match part.strip_prefix('-') {
            Some(rest) if rest.starts_with(char::is_alphabetic) => format!("0 - {rest}"),
            _ => part.to_owned(),
        };
        all.push(format!("out[{i}] = {part}"));
    }
    all.into_iter().map(|line| line + ";\n").collect::<String>()
}

/// The results of the statements for given values.
fn run(text: &str, given: &[(&str, f64)]) -> [f64; 4] {
    let mut machine = Machine::default();
    for (name, value) in given {
        machine.set(name, *value);
    }
    machine.run(&format!("{{\n{text}"));
    machine.read("out", 4).try_into().expect("four")
}

fn occluded(text: &str) -> f64 {
    let off = |elevation: f64| {
        let (s, c) = elevation.sin_cos();
        let found = run(text, &[("s", s), ("direction.y", s), ("direction.x", c)]);
        let right = occlusion(4, s, c);
        found.iter().zip(right).map(|(f, r)| (f - r).abs()).fold(0.0, f64::max)
    };
    [-1.4, -0.9, -0.3, 0.0, 0.4, 0.9, 1.2].into_iter().map(off).fold(0.0, f64::max)
}

/// ∫ (1/4 + c/2 + 5/32 (3c² - 1)) P̂_l(z) dz with c = f cos ω + u sin ω, by Simpson's rule in elevation.
fn integrals(f: f64, u: f64) -> [f64; 4] {
    const STEPS: u32 = 400;
    let width = PI / f64::from(STEPS);
    let mut all = [0.0; 4];
    for i in 0..=STEPS {
        let (z, s) = (-FRAC_PI_2 + width * f64::from(i)).sin_cos();
        let c = f * s + u * z;
        let bands = 0.25 + 0.5 * c + 5.0 / 32.0 * (3.0 * c * c - 1.0);
        let share = match i {
            0 | STEPS => 1.0,
            _ if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let polynomials = nlp(4, z);
        (0..4).for_each(|l| all[l] += bands * polynomials[l] * s * share * width / 3.0);
    }
    all
}

fn weighed(text: &str) -> f64 {
    let off = |(f, u): (f64, f64)| {
        let found = run(text, &[("facing.flat_part", f), ("facing.up", u)]);
        let right = integrals(f, u);
        found.iter().zip(right).map(|(f, r)| (f - r).abs()).fold(0.0, f64::max)
    };
    [(0.0, 1.0), (0.6, 0.8), (-0.6, 0.8), (0.9, 0.1), (-0.7, 0.3)]
        .into_iter()
        .map(off)
        .fold(0.0, f64::max)
}

/// The text with each number in turn a ten-thousandth larger.
fn each_changed(text: &str) -> Vec<(String, String)> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let mut all = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let begins = text[at..].starts_with(|c: char| c.is_ascii_digit());
        let is_name = at > 0 && text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '[');
        let length = text[at..].find(|c| !is_part(c)).unwrap_or(text.len() - at);
        if begins && !is_name {
            let number = &text[at..at + length];
            // The difference's 0 is no constant of the shader.
            if let Some(value) = number.parse::<f64>().ok().filter(|v| *v != 0.0) {
                let changed = format!("{}{}{}", &text[..at], value * 1.0001, &text[at + length..]);
                all.push((number.to_owned(), changed));
            }
        }
        at += if begins { length } else { 1 };
    }
    all
}

/// As f32, in sums of terms of 2 in all: 8 ε. A ten-thousandth of any constant is more, wherever it stands.
#[test]
fn each_constant_of_a_reflected_slice_is_right_and_tested() {
    const TOLERANCE: f64 = 8.0 / (1 << 24) as f64;
    let polynomials = body("occlusion");
    let weights = body("three_bands");
    for (name, text, least) in [("occlusion", &polynomials, 7), ("three_bands", &weights, 16)] {
        let off = |text: &str| if name == "occlusion" { occluded(text) } else { weighed(text) };
        let right = off(text);
        println!("{name}: {right:e} of {TOLERANCE:e}");
        assert!(right <= TOLERANCE, "{name}: {right}");
        let changed = each_changed(text);
        assert!(changed.len() >= least, "{name}: {} numbers", changed.len());
        for (number, text) in changed {
            let off = off(&text);
            println!("{name}: {number}: {off:e}");
            assert!(off > 2.0 * TOLERANCE, "{name}: passes with another {number}: {off:e}");
        }
    }
}
