use super::{Border, HeightField};

/// FNV-1a of 64 bits (Fowler, Noll & Vo): the start, and what each byte multiplies by.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// A number that tells fields apart, the same on every machine and in every version: what is made of a field keeps it,
/// and what is loaded beside a field is held to it.
///
/// FNV-1a of, little-endian, rows, columns and border (0 plane, 1 open, 2 periodic), u64 each, cells (f64), and every
/// height above the base (f32, row-major, voids filled). Where the base lies is no part of it: nothing depends on that.
pub fn field_hash(field: &HeightField, border: Border) -> u64 {
    let border = match border {
        Border::Plane => 0,
        Border::Open => 1,
        Border::Periodic => 2,
    };
    let sizes = [field.rows() as u64, field.cols() as u64, border];
    let cells = field.cell_m().map(f64::to_bits);
    let head = sizes.iter().chain(&cells).flat_map(|v| v.to_le_bytes());
    let heights = field.heights_m().iter().flat_map(|h| h.to_le_bytes());
    head.chain(heights).fold(OFFSET, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_of_what_results_depend_on() {
        let field = |heights: &[f64], cell: f64| {
            HeightField::new(2, 3, heights, [cell, 1.0], None).unwrap()
        };
        let heights = [0.0, 1.0, 2.0, 3.0, 4.0, 5.5];
        let plain = field(&heights, 1.0);
        let hash = field_hash(&plain, Border::Plane);
        // Written down, so that another version would be seen to make another.
        assert_eq!(hash, KNOWN, "{hash:#x}");
        assert_eq!(hash, field_hash(&plain.clone(), Border::Plane));
        // A base elsewhere changes nothing.
        let above = field(&heights.map(|h| h + 1024.0), 1.0);
        assert_eq!(hash, field_hash(&above, Border::Plane));
        let mut other = heights;
        other[5] = 5.25;
        let tall = HeightField::new(3, 2, &heights, [1.0; 2], None).unwrap();
        let plane = |field: HeightField| field_hash(&field, Border::Plane);
        let differ = [
            field_hash(&plain, Border::Open),
            field_hash(&plain, Border::Periodic),
            plane(field(&other, 1.0)),
            plane(field(&heights, 2.0)),
            plane(tall),
        ];
        assert!(differ.iter().all(|h| *h != hash), "{differ:x?}");
    }

    const KNOWN: u64 = 0x869b_65f8_e1b3_1d44;
}
