//! Progress and numbers on a terminal.

/// A spinner, on a terminal.
pub fn progress(quiet: bool, what: &str) -> indicatif::ProgressBar {
    let bar = if quiet {
        indicatif::ProgressBar::hidden()
    } else {
        indicatif::ProgressBar::new_spinner()
    };
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

/// Three significant digits.
pub fn percent(share: f64) -> String {
    format!("{} %", digits(100.0 * share))
}

/// Three significant digits.
pub fn digits(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let places = (2 - x.abs().log10().floor() as i32).max(0) as usize;
    if places > 9 { format!("{x:.2e}") } else { format!("{x:.places$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_are_shown() {
        let shown = [0.0, 0.001_234_5, 0.5, 12.345, 999.4, 123_456.0, 1e-12].map(digits);
        assert_eq!(shown, ["0", "0.00123", "0.500", "12.3", "999", "123456", "1.00e-12"]);
    }
}
