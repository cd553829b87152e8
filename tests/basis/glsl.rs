//! A small reader of GLSL's sums and products evaluates the generated texts in f64.

use crate::{ORDERS, noise, within};
use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight_cpu::basis::glsl::{glsl_harmonics, glsl_visible};
use ridgelight_cpu::basis::{from_nlp, occlusion};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

#[derive(Default)]
pub struct Machine {
    values: HashMap<String, f64>,
}

impl Machine {
    pub fn set(&mut self, name: &str, value: f64) {
        self.values.insert(name.to_owned(), value);
    }

    /// Runs every statement of a function's body.
    pub fn run(&mut self, text: &str) {
        let body = text.split_once('{').expect("a body").1;
        for line in body.lines().map(|l| l.split("//").next().unwrap().trim()) {
            if line.is_empty() || line == "}" {
                continue;
            }
            let line = line.strip_suffix(';').unwrap_or_else(|| panic!("{line}"));
            let (to, from) = line.split_once('=').expect("an assignment");
            let added = to.trim_end().ends_with('+');
            let to = to.trim_end().trim_end_matches('+').trim().to_owned();
            let mut tokens = tokens(from);
            tokens.reverse();
            let mut value = self.sum(&mut tokens);
            assert!(tokens.is_empty(), "{line}");
            if added {
                value += self.values[&to];
            }
            self.values.insert(to, value);
        }
    }

    fn sum(&mut self, tokens: &mut Vec<String>) -> f64 {
        let mut value = self.term(tokens);
        while tokens.last().is_some_and(|t| t == "+" || t == "-") {
            let sign = tokens.pop().unwrap();
            let next = self.term(tokens);
            value += if sign == "+" { next } else { -next };
        }
        value
    }

    fn term(&mut self, tokens: &mut Vec<String>) -> f64 {
        let mut value = self.factor(tokens);
        while tokens.last().is_some_and(|t| t == "*") {
            tokens.pop();
            value *= self.factor(tokens);
        }
        value
    }

    fn factor(&mut self, tokens: &mut Vec<String>) -> f64 {
        let token = tokens.pop().expect("a value");
        if token == "(" {
            let value = self.sum(tokens);
            assert_eq!(tokens.pop().as_deref(), Some(")"));
            return value;
        }
        token
            .parse()
            .unwrap_or_else(|_| *self.values.get(&token).unwrap_or_else(|| panic!("{token}")))
    }

    pub fn read(&self, name: &str, count: usize) -> Vec<f64> {
        (0..count).map(|i| self.values[&format!("{name}[{i}]")]).collect()
    }
}

/// Tokens apart: names with their index, numbers with sign and exponent, operators between blanks, brackets.
fn tokens(text: &str) -> Vec<String> {
    text.replace('(', " ( ").replace(')', " ) ").split_whitespace().map(str::to_owned).collect()
}

/// The statements of a function of `visible.glsl` for one order.
fn statements(function: &str, order: usize) -> String {
    let text = glsl_visible();
    let body = text.split_once(&format!("void {function}(")).expect("the function").1;
    let body = body.split("\n}\n").next().expect("its body");
    let (mut statements, mut is_in) = (String::from("{\n"), true);
    for line in body.lines().skip(1).map(str::trim) {
        if let Some(rest) = line.strip_prefix("if (ORDER > ") {
            is_in = order > rest.split(')').next().unwrap().parse::<usize>().expect("a band");
        } else if line == "}" {
            is_in = true;
        } else if is_in && line != "VALUE t;" {
            let mut line = line.replace("VALUE ", "");
            for l in 2..6 {
                let factor = if order > l { "1.0" } else { "0.0" };
                line = line.replace(&format!("(ORDER > {l} ? 1.0 : 0.0)"), factor);
            }
            statements += &(line + "\n");
        }
    }
    statements
}

/// The series that a function of `visible.glsl` adds to 0, for weights of the azimuth from -1 to 1.
fn added(function: &str, order: usize, turn: &[f64], elevation: f64) -> Vec<f64> {
    let (sin, cos) = elevation.sin_cos();
    let mut machine = Machine::default();
    for (name, value) in [("rise", FRAC_PI_2 - elevation), ("sin_", sin), ("cos_", cos)] {
        machine.set(name, value);
    }
    turn.iter().enumerate().for_each(|(i, turn)| machine.set(&format!("turn[{i}]"), *turn));
    (0..36).for_each(|i| machine.set(&format!("series[{i}]"), 0.0));
    machine.run(&statements(function, order));
    machine.read("series", order * order)
}

/// The weighted slice as a series.
fn weighted(order: usize, turn: &[f64], slice: &[f64]) -> Vec<f64> {
    let of = |(l, m): (usize, isize)| {
        turn[5_usize.wrapping_add_signed(m)] * slice[slice_index(l, m.unsigned_abs())]
    };
    bands(order).map(of).collect()
}

#[test]
fn slices_are_slices() {
    let turn = noise(11, 11);
    for order in ORDERS {
        for elevation in [-FRAC_PI_2, -0.4, 0.0, 0.9, FRAC_PI_2] {
            let expected = weighted(order, &turn, &Slices::new(order).above(elevation));
            // Coefficients of at most 60 in size, each with an error of 2^-24, eight of them.
            let tolerance = 500.0 / f64::from(1 << 24);
            within(&added("add_slices", order, &turn, elevation), &expected, tolerance);
        }
    }
}

#[test]
fn visibility_is_what_is_not_occluded() {
    let turn = noise(12, 11);
    for order in ORDERS {
        for elevation in [-1.2_f64, 0.0, 0.3, 1.5] {
            let (sin, cos) = elevation.sin_cos();
            let mut visible: Vec<f64> = occlusion(order, sin, cos).iter().map(|b| -b).collect();
            visible[0] += SQRT_2;
            let rows = from_nlp(order);
            let slice =
                rows.iter().map(|row| row.iter().zip(&visible).map(|(e, v)| e * v).sum::<f64>());
            let expected = weighted(order, &turn, &slice.collect::<Vec<f64>>());
            // Six numbers of at most √2 with an error of 20 × 2^-24 each, times factors of at most 1, themselves as f32.
            let tolerance = 6.0 * 22.0 / f64::from(1 << 24);
            within(&added("add_nlps", order, &turn, elevation), &expected, tolerance);
        }
    }
}

/// Y_lm to order 6 by the text, anywhere on the sphere: sums of seven terms of at most 15 in all, each with an error
/// of 2^-24.
#[test]
fn harmonics_are_harmonics() {
    let text: Vec<String> = glsl_harmonics()
        .lines()
        .filter(|l| !l.contains("if (") && !matches!(l.trim(), "}" | "vec4 t;"))
        .map(|l| l.replace("= vec4(", "= (").replace("    vec4 ", "    "))
        .collect();
    for direction in crate::directions(40).chain([DVec3::Z, -DVec3::Z, DVec3::X]) {
        let mut machine = Machine::default();
        for (name, value) in [("x", direction.x), ("y", direction.y), ("z", direction.z)] {
            machine.values.insert(name.to_owned(), value);
        }
        machine.run(&text.join("\n"));
        let expected = evaluate(6, direction);
        within(&machine.read("harmonics", 36), &expected, 15.0 * 7.0 / f64::from(1 << 24));
    }
}

/// The shaders hold the generated texts. `RIDGELIGHT_BLESS=1` writes them again.
#[test]
fn the_shaders_copies_are_the_texts() {
    let shared = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders_glsl");
    for (name, text) in
        [("sh/visible.glsl", glsl_visible()), ("shared/harmonics.glsl", glsl_harmonics())]
    {
        let path = shared.join(name);
        if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
            std::fs::write(&path, &text).expect("written");
        }
        assert!(std::fs::read_to_string(&path).expect("kept") == text, "RIDGELIGHT_BLESS=1");
    }
}
