//! Coined words that tools/words.txt forbids.

use std::path::Path;
use std::process::Command;

use crate::source::{Outcome, read};

/// One line of tools/words.txt: a pattern, what to write instead, a pattern of lines in which it is right, and the
/// paths that it leaves out: those of the lines above it that begin with `!`.
struct Rule {
    pattern: String,
    instead: String,
    allowed: Option<String>,
    left_out: Vec<String>,
}

fn rules(text: &str) -> Result<Vec<Rule>, String> {
    let (mut all, mut left_out) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        if let Some(path) = line.strip_prefix('!') {
            left_out.push(format!(":!{}", path.trim()));
            continue;
        }
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let parts: Vec<&str> = line.split('\t').map(str::trim).collect();
        let (pattern, instead) = match parts.as_slice() {
            [pattern, instead] | [pattern, instead, _] => (pattern, instead),
            _ => {
                return Err(format!(
                    "tools/words.txt:{}: expected two or three columns",
                    number + 1
                ));
            }
        };
        let allowed = parts.get(2).map(|text| (*text).to_owned());
        all.push(Rule {
            pattern: (*pattern).to_owned(),
            instead: (*instead).to_owned(),
            allowed,
            left_out: left_out.clone(),
        });
    }
    Ok(all)
}

/// Lines that match a Perl pattern, of files that git tracks or would add, CHANGELOG.md and the table of old names aside.
fn grep(root: &Path, pattern: &str, left_out: &[String]) -> Result<Vec<String>, String> {
    let paths = [
        ".",
        ":!CHANGELOG.md",
        ":!tools/words.txt",
        ":!benches/results",
        ":!shaders_glsl/compiled",
        ":!Cargo.lock",
        ":!*/Cargo.lock",
        ":!crates/cli/src/args/renamed.rs",
    ];
    let mut git = Command::new("git");
    git.current_dir(root)
        .args(["grep", "--untracked", "--no-color", "-I", "-n", "-i", "-P", "-e", pattern, "--"])
        .args(paths)
        .args(left_out);
    let done = git.output().map_err(|e| format!("git: {e}"))?;
    match done.status.code() {
        Some(0 | 1) => {
            Ok(String::from_utf8_lossy(&done.stdout).lines().map(str::to_owned).collect())
        }
        _ => Err(format!("git grep {pattern}: {}", String::from_utf8_lossy(&done.stderr))),
    }
}

/// Fails with each place where a word is not allowed.
pub fn check(root: &Path) -> Outcome {
    let text = read(&root.join("tools/words.txt"))?;
    let rules = rules(&text)?;
    let mut wrong = String::new();
    let mut count = 0;
    for rule in &rules {
        let allowed = match &rule.allowed {
            Some(allowed) => grep(root, allowed, &rule.left_out)?,
            None => Vec::new(),
        };
        let found = grep(root, &rule.pattern, &rule.left_out)?;
        for line in found.iter().filter(|line| !allowed.contains(line)) {
            count += 1;
            wrong.push_str(&format!("{line}\n    write: {}\n", rule.instead));
        }
    }
    if count == 0 {
        let paths = rules.last().map_or(0, |rule| rule.left_out.len());
        return Ok(format!("words: none of {} patterns; {paths} paths left out\n", rules.len()));
    }
    Err(format!("{wrong}words: {count} places"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_have_two_or_three_columns() {
        let all = rules("# comment\n\nlamp\tsphere light\noff\terror\toff by one\n").unwrap();
        assert_eq!((all.len(), all[0].instead.as_str()), (2, "sphere light"));
        assert_eq!(all[1].allowed.as_deref(), Some("off by one"));
        assert!(rules("alone").is_err());
    }

    #[test]
    fn a_path_is_left_out_of_the_rules_below_it() {
        let all = rules("!old\nlamp\tsphere light\n!tests\nstretch\tinterval\n").unwrap();
        assert_eq!(all[0].left_out, [":!old"]);
        assert_eq!(all[1].left_out, [":!old", ":!tests"]);
    }
}
