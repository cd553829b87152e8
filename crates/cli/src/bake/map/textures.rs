//! The texels of a map's textures: mip levels, block compression and its measured error.

use ridgelight_bake::Bound;
use ridgelight_io::Block;

use super::{MapFiles, Wanted};

/// The difference of decompressed values to the computed ones, of each quantity that the encoding
/// bounds, over the first mip level without voids.
#[derive(Default)]
pub struct Measured {
    texels: u64,
    /// Largest, and sum of squares.
    of: Vec<[f64; 2]>,
}

impl Measured {
    fn add(&mut self, bounds: &[Bound], is: &[f64], was: &[f64]) {
        self.texels += 1;
        self.of.resize(bounds.len(), [0.0; 2]);
        for (own, bound) in self.of.iter_mut().zip(bounds) {
            let [error, _] = (bound.error)(is, was);
            *own = [own[0].max(error), own[1] + error * error];
        }
    }

    /// The largest and the RMS error of each quantity.
    pub fn worst_and_rms(&self) -> impl Iterator<Item = [f64; 2]> {
        let count = self.texels.max(1) as f64;
        self.of.iter().map(move |[worst, squares]| [*worst, (squares / count).sqrt()])
    }
}

/// Means over the texels of the next mip level: each covers `from / to` texels along a side, some
/// in part.
fn reduced(plane: &[f32], from: [usize; 2], to: [usize; 2]) -> Vec<f32> {
    let shares = |axis: usize| -> Vec<Vec<(usize, f64)>> {
        let step = from[axis] as f64 / to[axis] as f64;
        let of = |i: usize| {
            let (low, high) = (i as f64 * step, (i + 1) as f64 * step);
            let last = (high.ceil() as usize).min(from[axis]);
            let share = |k: usize| ((k + 1) as f64).min(high) - (k as f64).max(low);
            (low as usize..last).map(|k| (k, share(k) / step)).collect()
        };
        (0..to[axis]).map(of).collect()
    };
    let (across, down) = (shares(0), shares(1));
    let texel = |rows: &[(usize, f64)], cols: &[(usize, f64)]| {
        let row = |r: usize| -> f64 {
            cols.iter().map(|(c, share)| share * f64::from(plane[r * from[0] + c])).sum()
        };
        rows.iter().map(|(r, share)| share * row(*r)).sum::<f64>() as f32
    };
    down.iter().flat_map(|rows| across.iter().map(|cols| texel(rows, cols))).collect()
}

/// Rows that are coded at a time: whole blocks, and few enough that their f64 components need little memory.
const BAND: usize = 16;

impl Wanted {
    /// Bytes in which the texels of a layer are coded, besides the images themselves.
    pub fn coding_bytes(&self, [cols, rows]: [usize; 2]) -> u64 {
        let (cols, rows) = (cols as u64, rows as u64);
        let band = match self.block {
            // Of a texel, four components in f64 as given and as decompressed, and a padded copy of up to 16 bytes.
            Some(_) => (32 + 32 + 16) * cols.next_multiple_of(4) * rows.min(BAND as u64),
            None => 0,
        };
        // Means in f32 of each value and of the voids. A level has at most half of the texels of the one before, of
        // which all planes are held, and one more plane of the next level; the voids become f32 once.
        let means = match self.has_mips {
            true => (2 * (self.encoding.values as u64 + 1) + 1 + 4) * cols * rows,
            false => 0,
        };
        band + means
    }
}

impl MapFiles<'_> {
    /// The bytes of each mip level of a layer; none without a texture.
    pub fn levels(&mut self, planes: &[&[f32]]) -> Vec<Vec<u8>> {
        if !self.has_textures() {
            return Vec::new();
        }
        let sizes = self.wanted.level_sizes(self.size());
        let voids = self.voids();
        let is_void = |at: usize| voids.is_some_and(|v| v[at]);
        let mut levels = vec![self.coded(planes, &is_void, sizes[0], true)];
        // Means of the values, then the share of voids.
        let mut means: Vec<Vec<f32>> = Vec::new();
        for pair in sizes.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if means.is_empty() {
                means.extend(planes.iter().map(|plane| reduced(plane, from, to)));
                means.extend(voids.map(|all| {
                    let shares: Vec<f32> = all.iter().map(|v| f32::from(u8::from(*v))).collect();
                    reduced(&shares, from, to)
                }));
            } else {
                means.iter_mut().for_each(|plane| *plane = reduced(plane, from, to));
            }
            let (own, shares) = means.split_at(planes.len());
            let own: Vec<&[f32]> = own.iter().map(Vec::as_slice).collect();
            // A texel is void where only voids were averaged.
            let is_void = |at: usize| shares.first().is_some_and(|v| v[at] >= 1.0);
            levels.push(self.coded(&own, &is_void, to, false));
        }
        levels
    }

    /// A level's texels or blocks.
    fn coded(
        &mut self,
        planes: &[&[f32]],
        is_void: &dyn Fn(usize) -> bool,
        [cols, rows]: [usize; 2],
        is_measured: bool,
    ) -> Vec<u8> {
        let (encoding, block) = (self.wanted.encoding, self.wanted.block);
        let count = block.map_or(self.wanted.texels().count, Block::components);
        let (mut values, mut texel) = ([0.0; 4], [0.0; 4]);
        let stored = self.wanted.stored().image_bytes([cols, rows]).unwrap_or(0);
        let (mut bytes, mut parts) = (Vec::with_capacity(stored as usize), Vec::new());
        for first in (0..rows).step_by(BAND) {
            let own_rows = BAND.min(rows - first);
            let band = first * cols..(first + own_rows) * cols;
            parts.clear();
            for at in band.clone() {
                for (value, plane) in values.iter_mut().zip(planes) {
                    *value = f64::from(plane[at]);
                }
                texel[3] = if is_void(at) { 0.0 } else { 1.0 };
                self.encode(&mut values[..encoding.values], &mut texel[..encoding.components]);
                match block {
                    Some(_) => parts.extend_from_slice(&texel[..count]),
                    None => {
                        texel[..count].iter().for_each(|p| encoding.component.put(*p, &mut bytes));
                    }
                }
            }
            let Some(block) = block else { continue };
            let blocks = block.compress(&parts, [cols, own_rows]);
            if is_measured {
                let found = block.decompress(&blocks, [cols, own_rows]);
                let texels = band.zip(found.chunks_exact(count));
                for (at, texel) in texels.filter(|(at, _)| !is_void(*at)) {
                    self.measure(planes, at, texel);
                }
            }
            bytes.extend(blocks);
        }
        bytes
    }

    /// Adds the error of a decompressed texel.
    fn measure(&mut self, planes: &[&[f32]], at: usize, texel: &[f64]) {
        let encoding = self.wanted.encoding;
        let (mut was, mut is) = ([0.0; 4], [0.0; 4]);
        for (value, plane) in was.iter_mut().zip(planes) {
            *value = f64::from(plane[at]);
        }
        let (was, is) = (&was[..encoding.values], &mut is[..encoding.values]);
        (encoding.decode)(&texel[..encoding.components], is);
        if let Some(normals) = self.map.normals {
            is[1] *= normals.y();
        }
        self.measured.add(encoding.bounds, is, was);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each texel is the mean of the texels that it covers, weighted by the covered share: 3 texels to 1, 4 to 2, 5 to 2.
    #[test]
    fn levels_are_means() {
        assert_eq!(reduced(&[1.0, 2.0, 3.0], [3, 1], [1, 1]), [2.0]);
        assert_eq!(reduced(&[1.0, 2.0, 3.0, 6.0], [2, 2], [1, 1]), [3.0]);
        assert_eq!(reduced(&[1.0, 2.0, 3.0, 6.0], [4, 1], [2, 1]), [1.5, 4.5]);
        // Five texels in two: 1, 2 and half of 3; half of 3, 4 and 9.
        assert_eq!(reduced(&[1.0, 2.0, 3.0, 4.0, 9.0], [1, 5], [1, 2]), [1.8, 5.8]);
    }
}
