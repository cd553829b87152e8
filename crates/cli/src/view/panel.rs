//! Text as pixels: 8 × 8 dots per letter, plain ASCII.

use font8x8::legacy::BASIC_LEGACY;

const INK: [u8; 4] = [0xe8, 0xe8, 0xe0, 0xff];
const PAPER: [u8; 4] = [0x18, 0x1a, 0x20, 0xff];
/// Padding of the text; width of a letter and height of a line, dots.
const MARGIN: usize = 6;
const LETTER: usize = 8;
const LINE: usize = 11;

/// Rim of the chosen mark, and of others.
const RIM: [[u8; 4]; 2] = [[0xff; 4], [0, 0, 0, 0xff]];

/// Pixels of some lines, or of a mark.
#[derive(Clone)]
pub struct Drawn {
    pub size: [u32; 2],
    pub pixels: Vec<[u8; 4]>,
}

/// Letters per line of a width in pixels.
pub fn letters(width: u32, scale: usize) -> usize {
    (width as usize / scale).saturating_sub(2 * MARGIN) / LETTER
}

/// A square with a rim, `half` pixels from its centre to each side, without the rim.
pub fn square(half: u32, colour: [u8; 4], is_chosen: bool) -> Drawn {
    let side = 2 * half + 3;
    let rim = RIM[usize::from(!is_chosen)];
    let is_rim = |i: u32| [i % side, i / side].iter().any(|v| *v == 0 || *v == side - 1);
    let pixels = (0..side * side).map(|i| if is_rim(i) { rim } else { colour }).collect();
    Drawn { size: [side, side], pixels }
}

/// `scale` pixels per side of a dot; none without lines.
pub fn draw(lines: &[String], scale: usize) -> Drawn {
    if lines.is_empty() {
        return Drawn { size: [0, 0], pixels: Vec::new() };
    }
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
