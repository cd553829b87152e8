use crate::scene::{Border, Directions, HeightField};

/// FNV-1a of 64 bits (Fowler, Noll & Vo): offset basis and prime.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

impl HeightField {
    /// A hash that identifies a field, the same on every machine and in every version that fills its voids alike. Baked files store
    /// it; a load checks it.
    ///
    /// FNV-1a of, little-endian: the text "ridgelight field 1", rows and columns (u64), cells (f64), the border (0 plane,
    /// 1 open, 2 periodic; a byte), every height above the base (f32, row-major, voids filled, -0 as 0), and, where any
    /// texel is void, a byte per texel, 1 for a void. The base height does not enter: no result depends on it.
    pub fn hash(&self, border: Border) -> u64 {
        let mut state = OFFSET;
        let mut take = |bytes: &[u8]| {
            for byte in bytes {
                state = (state ^ u64::from(*byte)).wrapping_mul(PRIME);
            }
        };
        take(b"ridgelight field 1");
        take(&(self.rows() as u64).to_le_bytes());
        take(&(self.cols() as u64).to_le_bytes());
        self.cell_m().iter().for_each(|cell| take(&cell.to_le_bytes()));
        take(&[match border {
            Border::Plane => 0,
            Border::Open => 1,
            Border::Periodic => 2,
        }]);
        self.heights_m().iter().for_each(|height| take(&(height + 0.0).to_le_bytes()));
        for void in self.voids().unwrap_or_default() {
            take(&[u8::from(*void)]);
        }
        state
    }
}

impl Directions {
    /// A hash that identifies the set: FNV-1a of all vectors, in order, and the lowest height (f64, little-endian).
    pub(crate) fn hash(&self) -> u64 {
        let numbers = self.vectors().iter().flat_map(|v| v.to_array()).chain([self.lowest_z()]);
        let bytes = numbers.flat_map(f64::to_le_bytes);
        bytes.fold(OFFSET, |state, byte| (state ^ u64::from(byte)).wrapping_mul(PRIME))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_depends_on_all_that_results_depend_on() {
        let field = |heights: &[f64], cell: f64, voids: Option<Vec<bool>>| {
            HeightField::new(2, 3, heights, [cell, 1.0], voids).unwrap()
        };
        let heights = [0.0, 1.0, 2.0, 3.0, 4.0, 5.5];
        let plain = field(&heights, 1.0, None);
        let hash = plain.hash(Border::Plane);
        // Pinned: the hash must not change between versions.
        assert_eq!(hash, KNOWN, "{hash:#x}");
        assert_eq!(hash, plain.clone().hash(Border::Plane));
        // A base elsewhere changes nothing.
        assert_eq!(hash, field(&heights.map(|h| h + 1024.0), 1.0, None).hash(Border::Plane));
        let mut other = heights;
        other[5] = 5.25;
        let tall = HeightField::new(3, 2, &heights, [1.0; 2], None).unwrap();
        let differ = [
            plain.hash(Border::Open),
            plain.hash(Border::Periodic),
            field(&other, 1.0, None).hash(Border::Plane),
            field(&heights, 2.0, None).hash(Border::Plane),
            field(&heights, 1.0, Some(vec![false, true, false, false, false, false]))
                .hash(Border::Plane),
            tall.hash(Border::Plane),
        ];
        assert!(differ.iter().all(|h| *h != hash), "{differ:x?}");
    }

    const KNOWN: u64 = 0xc422_1978_b9d2_1d16;
}
