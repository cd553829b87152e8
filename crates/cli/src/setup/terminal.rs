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

/// A word as a POSIX shell takes it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_=+,./:@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_shell_are_quoted() {
        assert_eq!(quoted("--sun=315,30"), "--sun=315,30");
        assert_eq!(quoted("my dem.tif"), "'my dem.tif'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }

    #[test]
    fn three_digits_are_shown() {
        let shown = [0.0, 0.001_234_5, 0.5, 12.345, 999.4, 123_456.0, 1e-12].map(digits);
        assert_eq!(shown, ["0", "0.00123", "0.500", "12.3", "999", "123456", "1.00e-12"]);
    }
}
