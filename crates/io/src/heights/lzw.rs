//! LZW strips and tiles of TIFFs.
//!
//! `tiff` 0.11 cannot read some that GDAL writes: where the image ends inside a tile it asks its decoder for bytes in small
//! parts, and finds no end code (image-tiff, issue 395). Decoded whole, they are read.

use tiff::decoder::DecodingResult;
use weezl::{BitOrder, LzwStatus, decode::Configuration};

/// The values of a strip or tile.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Columns, padding included.
    pub width: usize,
    /// Columns and rows inside the image.
    pub inside: [usize; 2],
    /// Interleaved samples per column.
    pub samples: usize,
    pub bits: u8,
    /// By its TIFF number: unsigned, signed, float.
    pub format: u16,
    /// By its TIFF number: none, differences, differences of the bytes of floats.
    pub predictor: u16,
    pub is_big_endian: bool,
}

impl Layout {
    fn sample_bytes(&self) -> usize {
        usize::from(self.bits / 8)
    }

    /// Bytes of the rows inside the image, `None` where they exceed the address space.
    pub fn needed(&self) -> Option<usize> {
        self.width
            .checked_mul(self.samples)?
            .checked_mul(self.sample_bytes())?
            .checked_mul(self.inside[1])
    }

    /// The values inside the image, through a buffer of [`needed`](Self::needed) bytes.
    ///
    /// # Errors
    /// What was found instead of them.
    pub fn decode(&self, compressed: &[u8], mut buffer: Vec<u8>) -> Result<DecodingResult, String> {
        let found = unpack(compressed, &mut buffer)?;
        if found < buffer.len() {
            return Err(format!("{found} bytes in a strip or tile of {}", buffer.len()));
        }
        let pixel = self.samples * self.sample_bytes();
        let (pitch, kept) = (self.width * pixel, self.inside[0].min(self.width) * pixel);
        for row in 0..self.inside[1] {
            let from = row * pitch;
            self.restore(&mut buffer[from..from + pitch]);
            buffer.copy_within(from..from + kept, row * kept);
        }
        self.values(&buffer[..self.inside[1] * kept])
    }

    /// Undoes predictor and byte order of a row.
    fn restore(&self, row: &mut [u8]) {
        let (wide, stride) = (self.sample_bytes(), self.samples);
        if self.predictor == 3 {
            for i in stride..row.len() {
                row[i] = row[i].wrapping_add(row[i - stride]);
            }
            // The most significant bytes of all samples come first.
            let (apart, count) = (row.to_vec(), row.len() / wide);
            for (i, sample) in row.chunks_exact_mut(wide).enumerate() {
                let bytes = (0..wide).map(|b| apart[b * count + i]);
                let place = |b: usize| if cfg!(target_endian = "big") { b } else { wide - 1 - b };
                bytes.enumerate().for_each(|(b, byte)| sample[place(b)] = byte);
            }
            return;
        }
        if self.is_big_endian != cfg!(target_endian = "big") {
            row.chunks_exact_mut(wide).for_each(<[u8]>::reverse);
        }
        if self.predictor == 2 {
            macro_rules! summed {
                ($t:ty) => {
                    for i in (stride * wide..row.len()).step_by(wide) {
                        let at = |from: usize| {
                            <$t>::from_ne_bytes(std::array::from_fn(|b| row[from + b]))
                        };
                        let sum = at(i).wrapping_add(at(i - stride * wide));
                        row[i..i + wide].copy_from_slice(&sum.to_ne_bytes());
                    }
                };
            }
            match wide {
                1 => summed!(u8),
                2 => summed!(u16),
                4 => summed!(u32),
                _ => summed!(u64),
            }
        }
    }

    fn values(&self, bytes: &[u8]) -> Result<DecodingResult, String> {
        use DecodingResult::{F16, F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
        use bytemuck::pod_collect_to_vec as cast;
        Ok(match (self.format, self.bits) {
            (1, 8) => U8(bytes.to_vec()),
            (1, 16) => U16(cast(bytes)),
            (1, 32) => U32(cast(bytes)),
            (1, 64) => U64(cast(bytes)),
            (2, 8) => I8(cast(bytes)),
            (2, 16) => I16(cast(bytes)),
            (2, 32) => I32(cast(bytes)),
            (2, 64) => I64(cast(bytes)),
            (3, 16) => {
                let words: Vec<u16> = cast(bytes);
                F16(words.into_iter().map(half::f16::from_bits).collect())
            }
            (3, 32) => F32(cast(bytes)),
            (3, 64) => F64(cast(bytes)),
            (format, bits) => return Err(format!("sample format {format} of {bits} bits")),
        })
    }
}

/// Fills a buffer; returns how many bytes there were for it.
fn unpack(compressed: &[u8], buffer: &mut [u8]) -> Result<usize, String> {
    let mut decoder = Configuration::with_tiff_size_switch(BitOrder::Msb, 8).build();
    let (mut read, mut written) = (0, 0);
    while written < buffer.len() {
        let part = decoder.decode_bytes(&compressed[read..], &mut buffer[written..]);
        read += part.consumed_in;
        written += part.consumed_out;
        match part.status {
            Ok(LzwStatus::Ok) if part.consumed_in + part.consumed_out > 0 => {}
            Ok(_) => break,
            Err(_) => return Err("an invalid LZW code".into()),
        }
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weezl::encode;

    fn decode(layout: &Layout, compressed: &[u8]) -> Result<DecodingResult, String> {
        layout.decode(compressed, vec![0; layout.needed().unwrap()])
    }

    /// Rows of two samples, with each predictor by its definition (TIFF 6.0 §14; Adobe TIFF technical note 3).
    #[test]
    fn predictors_are_undone() {
        let compress = |bytes: &[u8]| {
            let mut encoder = encode::Encoder::with_tiff_size_switch(BitOrder::Msb, 8);
            encoder.encode(bytes).unwrap()
        };
        let layout = Layout {
            width: 3,
            inside: [2, 2],
            samples: 2,
            bits: 16,
            format: 2,
            predictor: 2,
            is_big_endian: true,
        };
        // Columns (5, -7), (6, -9), padding; then (300, 0), (0, 300), padding.
        let rows: [i16; 12] = [5, -7, 1, -2, 9, 9, 300, 0, -300, 300, 9, 9];
        let bytes: Vec<u8> = rows.iter().flat_map(|v| v.to_be_bytes()).collect();
        let values = decode(&layout, &compress(&bytes)).unwrap();
        assert!(matches!(values, DecodingResult::I16(v) if v == [5, -7, 6, -9, 300, 0, 0, 300]));

        let floats = [1.5_f32, -2.25, 1e-3, 7.0];
        let mut apart: Vec<u8> = (0..4).flat_map(|b| floats.map(|f| f.to_be_bytes()[b])).collect();
        for i in (1..apart.len()).rev() {
            apart[i] = apart[i].wrapping_sub(apart[i - 1]);
        }
        let layout = Layout {
            width: 4,
            inside: [4, 1],
            samples: 1,
            bits: 32,
            format: 3,
            predictor: 3,
            is_big_endian: false,
        };
        let values = decode(&layout, &compress(&apart)).unwrap();
        assert!(matches!(values, DecodingResult::F32(v) if v == floats));
        assert!(decode(&layout, &compress(&apart[..9])).is_err());
        assert!(decode(&layout, &[0xff; 40]).is_err());
    }
}
