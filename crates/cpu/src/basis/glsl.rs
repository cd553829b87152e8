//! Generated GLSL: visibility along an azimuth, and spherical harmonics of a direction.

use super::{from_nlp, occlusion_polynomials};
use ridgelight::basis::legendre::associated;
use ridgelight::basis::slice::{Above, Slices, parts};
use ridgelight::basis::{MAX_ORDER, index};
use std::collections::BTreeSet;
use std::f64::consts::FRAC_1_PI;
use std::fmt::Write as _;

/// NLP coefficients of visibility above an elevation of sine `sin_` and squared cosine `cos2` (NS09 eq. 11).
fn visibility_nlp(order: usize) -> Vec<String> {
    let half = number(std::f64::consts::FRAC_1_SQRT_2);
    let rest = occlusion_polynomials(order);
    let rest = rest.iter().map(|below| {
        let above: Vec<f64> = below.iter().map(|c| -c).collect();
        format!("cos2 * ({})", horner(&above))
    });
    std::iter::once(format!("{half} * (1.0 - sin_)")).chain(rest).collect()
}

/// One part of a slice.
fn above(part: &Above) -> String {
    let inner = horner(&part.polynomial);
    let whole = number(part.whole);
    match (part.odd, part.whole.abs() < 1e-14) {
        (true, true) => format!("cos_ * ({inner})"),
        (true, false) => format!("{whole} * rise + cos_ * ({inner})"),
        (false, true) => inner,
        (false, false) => format!("{whole} + {inner}"),
    }
}

/// A polynomial in `sin_`; coefficients that are rounding errors are omitted.
fn horner(polynomial: &[f64]) -> String {
    let mut text = String::new();
    for c in polynomial.iter().rev() {
        let inner = if text.is_empty() { text } else { format!("sin_ * ({text})") };
        text = match (c.abs() < 1e-14, inner.is_empty()) {
            (true, _) => inner,
            (false, true) => number(*c),
            (false, false) => format!("{} + {inner}", number(*c)),
        };
    }
    text
}

/// Shortest text of the nearest f32.
fn number(value: f64) -> String {
    format!("{:?}", value as f32)
}

/// `shaders_glsl/sh/visible.glsl`: adds the visibility along one azimuth to the array `series`, of one texel or four at a
/// time, for every value of `ORDER`.
///
/// `add_slices` uses the exact slices, `add_nlps` n NLP coefficients ([`from_nlp`]).
pub fn glsl_visible() -> String {
    let mut text = String::from(
        "// Made by ridgelight_cpu::basis::glsl::glsl_visible, and held to it by a test.\n//\n\
         // Adds the visibility along an azimuth above elevations of sine `sin_` and cosine `cos_`, `rise` from\n\
         // the zenith, to the series. VALUE is of one texel or of four. The including shader declares ORDER,\n\
         // the azimuth's weights float turn[11], of m at m + 5, and VALUE series[36].\n\n\
         // By exact integrals over elevation.\n\
         void add_slices(VALUE rise, VALUE sin_, VALUE cos_) {\n    VALUE t;\n",
    );
    let slices = Slices::new(MAX_ORDER);
    let exact: Vec<String> = slices.parts().iter().map(above).collect();
    add_parts(&mut text, &exact);
    text += "}\n\n// By ORDER coefficients of normalised Legendre polynomials (NS09 eq. 11).\n\
             void add_nlps(VALUE sin_, VALUE cos_) {\n    VALUE t;\n    VALUE cos2 = cos_ * cos_;\n";
    for (l, line) in visibility_nlp(MAX_ORDER).iter().enumerate() {
        let line = format!("VALUE nlp{l} = {line}");
        match l {
            0 | 1 => writeln!(text, "    {line};").unwrap(),
            _ => writeln!(text, "    {line} * (ORDER > {l} ? 1.0 : 0.0);").unwrap(),
        }
    }
    let kept: Vec<String> = from_nlp(MAX_ORDER)
        .iter()
        .map(|row| {
            let terms = row.iter().enumerate().filter(|(_, f)| f.abs() >= 1e-14);
            let sum: Vec<String> = terms.map(|(c, f)| format!("{} * nlp{c}", number(*f))).collect();
            sum.join(" + ")
        })
        .collect();
    add_parts(&mut text, &kept);
    text + "}\n"
}

/// `shaders_glsl/shared/harmonics.glsl`: Y_lm of four directions, for every value of `ORDER`.
pub fn glsl_harmonics() -> String {
    let mut text = String::from(
        "// Made by ridgelight_cpu::basis::glsl::glsl_harmonics, and held to it by a test.\n//\n\
         // Y_lm of four unit directions (x, y, z). The including shader declares ORDER and vec4 harmonics[36].\n\
         void find_harmonics(vec4 x, vec4 y, vec4 z) {\n    vec4 t;\n",
    );
    // cos mφ and sin mφ, times sinᵐθ: powers of x + iy.
    for m in 1..MAX_ORDER {
        let (c, s) = match m {
            1 => ("x".to_owned(), "y".to_owned()),
            _ => (format!("x * c{0} - y * s{0}", m - 1), format!("x * s{0} + y * c{0}", m - 1)),
        };
        writeln!(text, "    vec4 c{m} = {c};\n    vec4 s{m} = {s};").unwrap();
    }
    by_band(&mut text, |text, indent, l, m| {
        let norm = if m == 0 { 0.5 * FRAC_1_PI } else { FRAC_1_PI }.sqrt();
        let scaled: Vec<f64> = associated(l, m).iter().map(|c| c * norm).collect();
        let polynomial = horner(&scaled).replace("sin_", "z");
        if m == 0 {
            writeln!(text, "{indent}harmonics[{}] = vec4({polynomial});", index(l, 0)).unwrap();
        } else {
            let m = m as isize;
            writeln!(text, "{indent}t = vec4({polynomial});").unwrap();
            writeln!(text, "{indent}harmonics[{}] = s{m} * t;", index(l, -m)).unwrap();
            writeln!(text, "{indent}harmonics[{}] = c{m} * t;", index(l, m)).unwrap();
        }
    });
    text + "}\n"
}

/// Adds each part of a slice, times its weights, to its one or two coefficients.
fn add_parts(text: &mut String, slice: &[String]) {
    let mut slice = slice.iter();
    by_band(text, |text, indent, l, m| {
        writeln!(text, "{indent}t = {};", slice.next().expect("every part")).unwrap();
        for m in BTreeSet::from([-(m as isize), m as isize]) {
            writeln!(text, "{indent}series[{}] += turn[{}] * t;", index(l, m), 5 + m).unwrap();
        }
    });
}

/// Writes all parts (l, m), with an indent, bands above 1 for orders that have them.
fn by_band(text: &mut String, mut write: impl FnMut(&mut String, &str, usize, usize)) {
    for (l, m) in parts(MAX_ORDER) {
        if m == 0 && l >= 2 {
            writeln!(text, "    if (ORDER > {l}) {{").unwrap();
        }
        write(text, if l < 2 { "    " } else { "        " }, l, m);
        if m == l && l >= 2 {
            *text += "    }\n";
        }
    }
}
