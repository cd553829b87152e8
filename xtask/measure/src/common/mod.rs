//! What the programs share: arguments, scenes, frames with their times and errors, tables, pictures.

pub mod args;
pub mod frames;
pub mod inputs;
pub mod plot;
pub mod terrains;

/// What a program returns.
pub type Outcome = Result<(), Box<dyn std::error::Error>>;

/// The upper median, NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The head of a table in Markdown.
pub fn head(columns: &str) {
    println!("{columns}\n{}|", "|---".repeat(columns.matches('|').count() - 1));
}

/// Cells of a row, of as many decimals.
pub fn cells(decimals: usize, values: impl IntoIterator<Item = f64>) -> String {
    let all: Vec<String> = values.into_iter().map(|v| format!("{v:.decimals$}")).collect();
    all.join(" | ")
}

/// Marsaglia's xorshift (2003), its upper 53 bits.
pub fn xorshift(mut state: u64) -> impl FnMut() -> usize {
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as usize
    }
}
