use super::Plan;
use crate::graph::Rectangle;
use crate::{Error, Result};

impl Plan {
    /// Checks that the plan has passes for edits, and that `rectangle` is one of its field.
    ///
    /// # Errors
    /// What is not so, said in a sentence.
    pub fn check_edit(&self, rectangle: Rectangle) -> Result<()> {
        if self.edit_passes.is_empty() {
            return Err(Error::setting(
                "an edit",
                "a plan without passes for edits",
                "Picture::keeps_horizons, a sweep along lines with fuse own, aimed-nearest or \
                 aimed, and a border of plane or open",
            ));
        }
        let Rectangle { col, row, cols, rows } = rectangle;
        let fits = |first: u32, count: u32, all: u32| {
            count > 0 && first.checked_add(count).is_some_and(|end| end <= all)
        };
        if !(fits(col, cols, self.size[0]) && fits(row, rows, self.size[1])) {
            return Err(Error::setting(
                "an edit",
                format!("{cols} × {rows} samples from column {col}, row {row}"),
                format!("1 or more within {} × {}", self.size[0], self.size[1]),
            ));
        }
        Ok(())
    }
}
