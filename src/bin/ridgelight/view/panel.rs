//! Text as pixels: 8 × 8 dots a letter, plain ASCII.

use font8x8::legacy::BASIC_LEGACY;

const INK: [u8; 4] = [0xe8, 0xe8, 0xe0, 0xff];
const PAPER: [u8; 4] = [0x18, 0x1a, 0x20, 0xff];
/// Around the text, and a letter's and a line's room, dots.
const MARGIN: usize = 6;
const LETTER: usize = 8;
const LINE: usize = 11;

/// Pixels of some lines.
pub struct Drawn {
    pub size: [u32; 2],
    pub pixels: Vec<[u8; 4]>,
}

/// `scale` pixels a side of a dot.
pub fn draw(lines: &[String], scale: usize) -> Drawn {
    let longest = lines.iter().map(String::len).max().unwrap_or(0);
    let dots = [2 * MARGIN + longest * LETTER, 2 * MARGIN + lines.len() * LINE];
    let [width, height] = dots.map(|d| d * scale);
    let mut pixels = vec![PAPER; width * height];
    for (row, line) in lines.iter().enumerate() {
        for (col, letter) in line.bytes().enumerate() {
            let glyph = BASIC_LEGACY[usize::from(letter.min(127))];
            let at = [MARGIN + col * LETTER, MARGIN + row * LINE];
            for (y, bits) in glyph.iter().enumerate() {
                for x in (0..LETTER).filter(|x| bits >> x & 1 == 1) {
                    for i in 0..scale * scale {
                        let px = (at[0] + x) * scale + i % scale;
                        let py = (at[1] + y) * scale + i / scale;
                        pixels[py * width + px] = INK;
                    }
                }
            }
        }
    }
    Drawn { size: [width as u32, height as u32], pixels }
}
