//! The nonzero words of a bitmap.

/// Their indices, in order; the shader's order is arbitrary.
pub fn dirty_list(dirty: &[u32]) -> Vec<u32> {
    (0..dirty.len() as u32).filter(|&word| dirty[word as usize] != 0).collect()
}
