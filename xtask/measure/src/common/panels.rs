//! Pictures side by side in rows, as one PNG.

use std::path::Path;

use ridgelight::Result;
use ridgelight::scene::Tone;
use ridgelight_io as files;

/// White pixels between pictures.
const GAP: usize = 4;

pub type Panel = Vec<[f32; 3]>;

/// All panels have `cols` columns and one size; `zoom` pixels a texel.
pub fn write(
    path: &Path,
    rows: &[Vec<Panel>],
    cols: usize,
    zoom: usize,
    exposure: f32,
) -> Result<()> {
    let size = [rows[0][0].len() / cols * zoom, cols * zoom];
    let across = rows.iter().map(Vec::len).max().unwrap_or(0);
    let [height, width] = [rows.len() * (size[0] + GAP) - GAP, across * (size[1] + GAP) - GAP];
    let mut texels = vec![[1.0 / exposure; 3]; width * height];
    for (j, row) in rows.iter().enumerate() {
        for (i, panel) in row.iter().enumerate() {
            for (y, x) in (0..size[0]).flat_map(|y| (0..size[1]).map(move |x| (y, x))) {
                let at = (j * (size[0] + GAP) + y) * width + i * (size[1] + GAP) + x;
                texels[at] = panel[y / zoom * cols + x / zoom];
            }
        }
    }
    files::write_png(path, height, width, &texels, None, Tone { exposure }, &[])
}
