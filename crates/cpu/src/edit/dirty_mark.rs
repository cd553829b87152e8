//! Grid points that an edited rectangle changes directly: its own and their neighbours, whose normals and first
//! crossings depend on it.

use ridgelight::plan::Rectangle;

/// Word and bit of a grid point, as `dirty.glsl`: a word is eight columns of four rows.
pub fn place([col, row]: [usize; 2], cols: usize) -> (usize, u32) {
    (row / 4 * cols.div_ceil(8) + col / 8, 1 << (row % 4 * 8 + col % 8))
}

/// The bitmap of a field of `cols` × `rows`: a bit per grid point.
pub fn dirty_mark([cols, rows]: [usize; 2], rectangle: Rectangle) -> Vec<u32> {
    let Rectangle { col, row, cols: wide, rows: high } = rectangle;
    let around = |first: u32, count: u32, all: usize| {
        let (first, count) = (first as usize, count as usize);
        first.saturating_sub(1)..(first + count + 1).min(all)
    };
    let mut words = vec![0; cols.div_ceil(8) * rows.div_ceil(4)];
    for r in around(row, high, rows) {
        for c in around(col, wide, cols) {
            let (word, bit) = place([c, r], cols);
            words[word] |= bit;
        }
    }
    words
}
