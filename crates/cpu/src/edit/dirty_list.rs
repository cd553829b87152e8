//! The words of a map of marks that mark anything.

/// Their positions, in order; the shader's order is any.
pub fn dirty_list(dirty: &[u32]) -> Vec<u32> {
    (0..dirty.len() as u32).filter(|&word| dirty[word as usize] != 0).collect()
}
