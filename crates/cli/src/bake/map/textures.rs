//! The texels of a map's textures: mip levels, block compression and its measured error.

use ridgelight_bake::Bound;
use ridgelight_io::Block;

use super::MapFiles;

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

impl MapFiles<'_> {
    /// The bytes of each mip level of a layer; none without a texture.
    pub fn levels(&mut self, planes: &[&[f32]]) -> Vec<Vec<u8>> {
        if !self.wanted.formats.iter().any(|format| format.is_texture()) {
            return Vec::new();
        }
        let sizes = self.wanted.level_sizes(self.size());
        let voids: Option<Vec<f32>> =
            self.voids().map(|all| all.iter().map(|v| f32::from(u8::from(*v))).collect());
        // The last plane is the share of voids.
        let mut own: Vec<Vec<f32>> = planes.iter().map(|plane| plane.to_vec()).collect();
        own.extend(voids);
        let mut levels = Vec::new();
        for (level, size) in sizes.iter().enumerate() {
            if level > 0 {
                let from = sizes[level - 1];
                own.iter_mut().for_each(|plane| *plane = reduced(plane, from, *size));
            }
            let (own, voids) = own.split_at(planes.len());
            levels.push(self.coded(own, voids.first().map(Vec::as_slice), *size, level == 0));
        }
        levels
    }

    /// A level's texels or blocks. A texel is void where only voids were averaged.
    fn coded(
        &mut self,
        planes: &[Vec<f32>],
        voids: Option<&[f32]>,
        size: [usize; 2],
        is_measured: bool,
    ) -> Vec<u8> {
        let (encoding, block) = (self.wanted.encoding, self.wanted.block);
        let count = block.map_or(self.wanted.texels().count, Block::components);
        let is_void = |at: usize| voids.is_some_and(|v| v[at] >= 1.0);
        let (mut values, mut texel) = ([0.0; 4], [0.0; 4]);
        let mut all = Vec::with_capacity(count * size[0] * size[1]);
        for at in 0..size[0] * size[1] {
            for (value, plane) in values.iter_mut().zip(planes) {
                *value = f64::from(plane[at]);
            }
            texel[3] = if is_void(at) { 0.0 } else { 1.0 };
            self.encode(&mut values[..encoding.values], &mut texel[..encoding.components]);
            all.extend_from_slice(&texel[..count]);
        }
        let Some(block) = block else {
            let mut bytes = Vec::with_capacity(all.len() * encoding.component.bytes());
            all.iter().for_each(|part| encoding.component.put(*part, &mut bytes));
            return bytes;
        };
        let blocks = block.compress(&all, size);
        if is_measured {
            let found = block.decompress(&blocks, size);
            let mut back = [0.0; 4];
            for (at, texel) in found.chunks_exact(count).enumerate().filter(|(at, _)| !is_void(*at))
            {
                for (value, plane) in values.iter_mut().zip(planes) {
                    *value = f64::from(plane[at]);
                }
                let back = &mut back[..encoding.values];
                (encoding.decode)(&texel[..encoding.components], back);
                if let Some(normals) = self.map.normals {
                    back[1] *= normals.y();
                }
                self.measured.add(encoding.bounds, back, &values[..encoding.values]);
            }
        }
        blocks
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
