//! Block compression of texels: BC4, BC6H and BC7, in blocks of 4 × 4.

use block_compression::encode::{compress_rgba8, compress_rgba16};
use block_compression::{BC6HSettings, BC7Settings, CompressionVariant};
use half::f16;

use crate::Component;

/// Sides of a block in texels.
const SIDE: usize = 4;

/// A format of blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// One component, 0..1: eight levels between two codes of 8 bits.
    Bc4,
    /// Three components, 0 or more, up to 65504.
    Bc6h,
    /// Four components, 0..1.
    Bc7,
}

impl Block {
    /// The format for so many components; none where no format fits.
    pub fn of(component: Component, count: usize) -> Option<Self> {
        match (component, count) {
            (Component::Unorm8, 1) => Some(Block::Bc4),
            (Component::Unorm8, 3 | 4) => Some(Block::Bc7),
            (Component::F16, 3) => Some(Block::Bc6h),
            _ => None,
        }
    }

    /// The components that it stores.
    pub fn components(self) -> usize {
        match self {
            Block::Bc4 => 1,
            Block::Bc6h => 3,
            Block::Bc7 => 4,
        }
    }

    /// Bytes of a block.
    pub fn bytes(self) -> usize {
        if self == Block::Bc4 { 8 } else { 16 }
    }

    /// Bytes of an image.
    pub fn image_bytes(self, [cols, rows]: [usize; 2]) -> usize {
        cols.div_ceil(SIDE) * rows.div_ceil(SIDE) * self.bytes()
    }

    /// The Vulkan format's number and its name without `VK_FORMAT_`.
    pub fn vulkan(self) -> (u32, &'static str) {
        match self {
            Block::Bc4 => (139, "BC4_UNORM_BLOCK"),
            Block::Bc6h => (143, "BC6H_UFLOAT_BLOCK"),
            Block::Bc7 => (145, "BC7_UNORM_BLOCK"),
        }
    }

    fn variant(self) -> CompressionVariant {
        match self {
            Block::Bc4 => CompressionVariant::BC4,
            Block::Bc6h => CompressionVariant::BC6H(BC6HSettings::basic()),
            Block::Bc7 => CompressionVariant::BC7(BC7Settings::alpha_basic()),
        }
    }

    /// Compresses an image, row by row from the top, [`components`](Self::components) values a
    /// texel. Blocks at the right and the bottom repeat the last texels.
    ///
    /// # Panics
    /// Another number of values.
    pub fn compress(self, values: &[f64], [cols, rows]: [usize; 2]) -> Vec<u8> {
        let count = self.components();
        assert_eq!(values.len(), cols * rows * count, "values of an image");
        let [across, down] = [cols, rows].map(|n| n.next_multiple_of(SIDE));
        let at = |i: usize| (i / across).min(rows - 1) * cols + (i % across).min(cols - 1);
        // The encoder takes four components; those that a format lacks are not read.
        let padded = (0..across * down).flat_map(|i| {
            let own = &values[at(i) * count..][..count];
            [0, 1, 2, 3].map(|c| own.get(c).copied().unwrap_or(0.0))
        });
        let mut blocks = vec![0; self.image_bytes([cols, rows])];
        let (width, height) = (across as u32, down as u32);
        if self == Block::Bc6h {
            let padded: Vec<f16> = padded.map(|v| f16::from_f64(v.clamp(0.0, 65_504.0))).collect();
            compress_rgba16(self.variant(), &padded, &mut blocks, width, height, 4 * width);
        } else {
            let padded: Vec<u8> = padded.map(|v| Component::Unorm8.code(v) as u8).collect();
            compress_rgba8(self.variant(), &padded, &mut blocks, width, height, 4 * width);
        }
        blocks
    }

    /// The values of a compressed image, as [`compress`](Self::compress) takes them.
    ///
    /// # Panics
    /// Another number of bytes.
    pub fn decompress(self, blocks: &[u8], [cols, rows]: [usize; 2]) -> Vec<f64> {
        assert_eq!(blocks.len(), self.image_bytes([cols, rows]), "bytes of an image");
        let (count, across) = (self.components(), cols.div_ceil(SIDE));
        let mut values = vec![0.0; cols * rows * count];
        for (i, block) in blocks.chunks_exact(self.bytes()).enumerate() {
            let texels = self.decoded(block);
            let (left, top) = (SIDE * (i % across), SIDE * (i / across));
            for row in top..rows.min(top + SIDE) {
                for col in left..cols.min(left + SIDE) {
                    let from = ((row - top) * SIDE + col - left) * count;
                    let to = (row * cols + col) * count;
                    values[to..to + count].copy_from_slice(&texels[from..from + count]);
                }
            }
        }
        values
    }

    /// The values of a block, row by row.
    fn decoded(self, block: &[u8]) -> Vec<f64> {
        const TEXELS: usize = SIDE * SIDE;
        let pitch = SIDE * self.components();
        match self {
            Block::Bc4 => {
                let mut texels = [0.0_f32; TEXELS];
                bcdec_rs::bc4_float(block, &mut texels, pitch, false);
                texels.map(f64::from).into()
            }
            Block::Bc6h => {
                let mut texels = [0_u16; 3 * TEXELS];
                bcdec_rs::bc6h_half(block, &mut texels, pitch, false);
                texels.map(|bits| f16::from_bits(bits).to_f64()).into()
            }
            Block::Bc7 => {
                let mut texels = [0_u8; 4 * TEXELS];
                bcdec_rs::bc7(block, &mut texels, pitch);
                texels.map(|code| f64::from(code) / 255.0).into()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [10, 7];

    /// A smooth image in 0..1, of another slope in each component.
    fn image(count: usize) -> Vec<f64> {
        let at = |i: usize, c: usize| {
            let (x, y) = ((i % SIZE[0]) as f64, (i / SIZE[0]) as f64);
            0.5 + 0.4 * (0.21 * x + 0.5 * c as f64).sin() * (0.3 * y + c as f64).cos()
        };
        (0..SIZE[0] * SIZE[1]).flat_map(|i| (0..count).map(move |c| at(i, c))).collect()
    }

    /// Range of each component over each block, at every texel.
    fn ranges(values: &[f64], count: usize) -> Vec<f64> {
        let of = |i: usize| {
            let (texel, c) = (i / count, i % count);
            let (left, top) = (texel % SIZE[0] / SIDE * SIDE, texel / SIZE[0] / SIDE * SIDE);
            let rows = top..SIZE[1].min(top + SIDE);
            let own = rows.flat_map(|y| (left..SIZE[0].min(left + SIDE)).map(move |x| (x, y)));
            let own = own.map(|(x, y)| values[(y * SIZE[0] + x) * count + c]);
            let (low, high) = own.fold((1.0_f64, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        };
        (0..values.len()).map(of).collect()
    }

    /// BC4 has eight levels from the least to the largest code of a block, so that a code is at most half of a seventh of
    /// their difference away. Codes of 8 bits add half a step to the value, and to both ends.
    #[test]
    fn one_component_is_within_half_a_level() {
        let block = Block::Bc4;
        let values = image(1);
        let found = block.decompress(&block.compress(&values, SIZE), SIZE);
        let half_step = Component::Unorm8.half_step();
        let ranges = ranges(&values, 1);
        let is_within = |found: &[f64]| {
            values.iter().zip(found).zip(&ranges).all(|((value, found), range)| {
                (value - found).abs() <= (range + 2.0 * half_step) / 14.0 + half_step
            })
        };
        assert!(is_within(&found));
        // The values of the texels beside them are not.
        let mut beside = found;
        beside.rotate_left(1);
        assert!(!is_within(&beside));
    }

    /// A block of BC7 is at most as wrong as one line between the extremes of its components, whose ends have at least 7 bits,
    /// so that a value is within the range of its block and a code of 127. BC6H: the same, in levels of unequal length.
    #[test]
    fn colours_are_within_the_range_of_their_block() {
        for block in [Block::Bc7, Block::Bc6h] {
            let values = image(block.components());
            let mut blocks = block.compress(&values, SIZE);
            let ranges = ranges(&values, block.components());
            let is_within = |blocks: &[u8]| {
                let found = block.decompress(blocks, SIZE);
                values
                    .iter()
                    .zip(&found)
                    .zip(&ranges)
                    .all(|((value, found), range)| (value - found).abs() <= range + 1.0 / 127.0)
            };
            assert!(is_within(&blocks), "{block:?}");
            // The blocks in the places of others are not.
            blocks.rotate_left(block.bytes());
            assert!(!is_within(&blocks), "{block:?}");
        }
    }

    /// Another decoder finds the same values, but for its rounding to codes of 8 bits. (On noise, where ends of BC6H lie far
    /// outside the values, it clamps some to 1 that are near 0.4. The decoder of the encoder's crate, version 0.11, is wrong in
    /// all of BC6H.)
    #[test]
    fn another_decoder_finds_the_same() {
        type Decode = fn(&[u8], usize, usize, &mut [u32]) -> Result<(), &'static str>;
        let all: [(Block, Decode); 3] = [
            (Block::Bc4, texture2ddecoder::decode_bc4),
            (Block::Bc6h, texture2ddecoder::decode_bc6_unsigned),
            (Block::Bc7, texture2ddecoder::decode_bc7),
        ];
        for (block, decode) in all {
            let count = block.components();
            let blocks = block.compress(&image(count), SIZE);
            let mut words = vec![0; SIZE[0] * SIZE[1]];
            decode(&blocks, SIZE[0], SIZE[1], &mut words).unwrap();
            // Blue, green, red and alpha from the lowest byte on.
            let code = |i: usize| words[i / count].to_le_bytes()[[2, 1, 0, 3][i % count]];
            for (i, found) in block.decompress(&blocks, SIZE).into_iter().enumerate() {
                let other = f64::from(code(i)) / 255.0;
                assert!((found - other).abs() <= 1.0 / 255.0, "{block:?}: {found} is {other}");
            }
        }
    }
}
