//! GLSL text made from the basis' constants: products of series that both change from place to place, and
//! the numbers of a slice.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::bands;
use super::legendre::occlusion_polynomials;
use super::product::{orders, triples};
use super::slice::{Slices, parts};

/// What is known of the second factor of a [`glsl_product`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// Any series.
    Any,
    /// A zonal function about an axis of azimuth 0, even in azimuth: only m ≥ 0 is read. Half of the
    /// products go: what is even and what is odd in azimuth no longer mix.
    Aligned,
}

/// `void sh_product(in float a[n²], in float b[n²], out float c[r²])`: the product of two series of
/// `order`, its bands below `receiver` only, `name` in place of `sh_product`.
///
/// The product with b is a symmetric matrix whose entries are sums over b. Each entry is made once, used in
/// two rows, and dropped. Straight-line code, no branches.
///
/// # Panics
/// When `receiver` is above `order`.
pub fn glsl_product(name: &str, order: usize, receiver: usize, factor: Factor) -> String {
    assert!((1..=order).contains(&receiver), "receiver {receiver} of order {order}");
    let (inner, outer) = (order * order, receiver * receiver);
    let known = bands(order).map(|(_, m)| factor == Factor::Any || m >= 0).collect::<Vec<_>>();
    // Entry (i, j), i ≤ j, of the matrix: Σ Γ_ijk b_k, wanted where row i or row j is.
    let mut entries: BTreeMap<(usize, usize), BTreeSet<(usize, u64)>> = BTreeMap::new();
    for triple in triples(order) {
        for [i, j, k] in orders(triple.places) {
            if i <= j && i < outer && known[k] {
                entries.entry((i, j)).or_default().insert((k, triple.value.to_bits()));
            }
        }
    }
    let mut text = format!(
        "void {name}(in float a[{inner}], in float b[{inner}], out float c[{outer}])\n{{\n    float t;\n"
    );
    let mut begun = vec![false; outer];
    for ((i, j), terms) in &entries {
        let sum: Vec<String> =
            terms.iter().map(|(k, g)| format!("{} * b[{k}]", number(f64::from_bits(*g)))).collect();
        writeln!(text, "    t = {};", sum.join(" + ")).unwrap();
        let mut row = |row: usize, column: usize| {
            let sign = if begun[row] { "+=" } else { "=" };
            begun[row] = true;
            writeln!(text, "    c[{row}] {sign} t * a[{column}];").unwrap();
        };
        row(*i, *j);
        if i != j && *j < outer {
            row(*j, *i);
        }
    }
    text + "}\n"
}

/// `void name(in float rise, in float sin_, in float cos_, out float slice[n(n+1)/2])`: [`Slices::above`]
/// an elevation ω of sine and cosine `sin_` and `cos_`, with `rise` = π/2 - ω, [0..π].
pub fn glsl_slice(name: &str, order: usize) -> String {
    let slices = Slices::new(order);
    let count = slices.parts().len();
    let mut text = format!(
        "void {name}(in float rise, in float sin_, in float cos_, out float slice[{count}])\n{{\n"
    );
    for (i, ((l, m), part)) in parts(order).zip(slices.parts()).enumerate() {
        let inner = horner(&part.polynomial);
        let whole = number(part.whole);
        let line = match (part.odd, part.whole.abs() < 1e-14) {
            (true, true) => format!("cos_ * ({inner})"),
            (true, false) => format!("{whole} * rise + cos_ * ({inner})"),
            (false, true) => inner,
            (false, false) => format!("{whole} + {inner}"),
        };
        writeln!(text, "    slice[{i}] = {line}; // l {l}, m {m}").unwrap();
    }
    text + "}\n"
}

/// `void name(in float sin_, in float cos2, out float nlp[n])`: NLP coefficients of what lies above an
/// elevation of sine `sin_` and squared cosine `cos2` (NS09 eq. 11).
pub fn glsl_visibility_nlp(name: &str, order: usize) -> String {
    let mut text =
        format!("void {name}(in float sin_, in float cos2, out float nlp[{order}])\n{{\n");
    let half = number(std::f64::consts::FRAC_1_SQRT_2);
    writeln!(text, "    nlp[0] = {half} * (1.0 - sin_);").unwrap();
    for (l, below) in occlusion_polynomials(order).iter().enumerate() {
        let above: Vec<f64> = below.iter().map(|c| -c).collect();
        writeln!(text, "    nlp[{}] = cos2 * ({});", l + 1, horner(&above)).unwrap();
    }
    text + "}\n"
}

/// A polynomial in `sin_`; coefficients that are rounding's are none.
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
