//! What the programs share.

pub mod args;
pub mod frames;
pub mod inputs;
pub mod panels;
pub mod plot;

/// What a program returns.
pub type Outcome = Result<(), Box<dyn std::error::Error>>;

/// The median, NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The head of a table in Markdown.
pub fn head(columns: &str) {
    println!("{columns}\n{}|", "|---".repeat(columns.matches('|').count() - 1));
}
