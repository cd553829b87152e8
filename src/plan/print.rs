use std::fmt;

use super::Plan;
use crate::graph::bytes_text;
use crate::graph::{Kind, Owner};

/// A table of passes, a table of resources, and the notes.
impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "field {} × {}", self.size[0], self.size[1])?;
        for (name, value) in &self.settings {
            writeln!(f, "  {name} {value}")?;
        }
        writeln!(f, "\n{:<34} {:>18} {:>11}  why", "pass", "groups", "traffic")?;
        for (i, pass) in self.every_pass().enumerate() {
            if i == self.passes.len() {
                writeln!(f, "after an edit, at most:")?;
            }
            let groups = format!("{} × {} × {}", pass.groups[0], pass.groups[1], pass.groups[2]);
            let mark = if pass.barrier_before { "| " } else { "  " };
            let traffic = if pass.bytes == 0 { "-".to_owned() } else { bytes_text(pass.bytes) };
            writeln!(f, "{mark}{:<32} {groups:>18} {traffic:>11}  {}", pass.label(), pass.why)?;
        }
        writeln!(f, "(| a barrier stands before the pass)\n")?;
        writeln!(f, "{:<24} {:>9} {:>26} {:>12}", "image or buffer", "whose", "extent", "memory")?;
        for resource in &self.resources {
            let extent = match resource.kind {
                Kind::Image { format, width, height, layers, .. } => {
                    format!("{width} × {height} × {layers} {}", format.spirv())
                }
                Kind::Buffer { .. } => String::new(),
            };
            let whose = match resource.owner {
                Owner::Internal => "ours",
                Owner::Input => "input",
                Owner::InputBuffer => "buffer",
                Owner::Output => "output",
            };
            writeln!(
                f,
                "{:<24} {whose:>9} {extent:>26} {:>12}",
                resource.name,
                bytes_text(resource.bytes())
            )?;
        }
        writeln!(f, "{:<24} {:>9} {:>26} {:>12}", "all", "", "", bytes_text(self.bytes()))?;
        if !self.notes.is_empty() {
            writeln!(f)?;
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}
