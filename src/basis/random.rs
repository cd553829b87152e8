//! Random numbers determined by a seed, the same on every machine.

/// Distance of consecutive states for [`mixed`]: 2⁶⁴ over the golden ratio, odd.
pub const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// Mixes all bits of a state: the finaliser of SplitMix64 (Steele, Lea & Flood 2014).
pub fn mixed(state: u64) -> u64 {
    let a = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let b = (a ^ (a >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    b ^ (b >> 31)
}

/// The upper 53 bits as a number in [0, 1): exact.
pub fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first words of SplitMix64 from 0, as Vigna's reference implementation gives them.
    #[test]
    fn words_are_those_of_splitmix64() {
        let words = [1, 2, 3].map(|k| mixed(STEP.wrapping_mul(k)));
        let expected = [0xE220_A839_7B1D_CDAF, 0x6E78_9E6A_A1B9_65F4, 0x06C4_5D18_8009_454F];
        assert_eq!(words, expected);
        assert_eq!([unit(0), unit(1 << 63), unit(u64::MAX)], [0.0, 0.5, 1.0 - f64::EPSILON / 2.0]);
    }
}
