//! The fuzz targets' entry points for a few seconds with fixed seeds: no bytes may panic, hang or
//! take memory that they could not fill, and every refusal names the file.

#[path = "common/formats.rs"]
mod formats;

use exr::prelude::FlatSamples;
use formats::*;
use proptest::prelude::*;
use ridgelight_io::{HeightOptions, parse_environment, parse_heights, parse_planes};
use std::path::Path;

/// Mutations of each file.
const ROUNDS: usize = 1500;

/// xorshift64* (Marsaglia; Vigna 2016): small, seeded, the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() >> 33) as usize % n.max(1)
    }
}

/// One to eight edits of the kinds that find mistakes: bits, telling bytes, cuts, repeats, and
/// four-byte numbers at the edges of their types.
fn mutate(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=random.below(8) {
        if out.is_empty() {
            break;
        }
        // Headers decide more than data: every other edit falls into the first 200 bytes.
        let reach = if random.below(2) == 0 { out.len() } else { out.len().min(200) };
        let at = random.below(reach);
        match random.below(7) {
            0 => out[at] ^= 1 << random.below(8),
            1 => out[at] = [0, 1, 0x7f, 0x80, 0xff, b'9', b'-'][random.below(7)],
            2 => out[at] = random.next() as u8,
            3 => out.truncate(at),
            4 => {
                let end = (at + random.below(32)).min(out.len());
                let piece = out[at..end].to_vec();
                out.splice(at..at, piece);
            }
            5 => {
                out.drain(at..(at + random.below(16)).min(out.len()));
            }
            _ => {
                let number = [0_u32, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x0001_0000];
                let value = number[random.below(6)].to_le_bytes();
                out.iter_mut().skip(at).zip(value).for_each(|(b, v)| *b = v);
            }
        }
    }
    out
}

fn check<T>(name: &str, result: Result<T, ridgelight::Error>) {
    if let Err(error) = result {
        let message = error.to_string();
        assert!(message.contains(name) && !message.contains('\n'), "{message:?}");
    }
}

fn environment_files() -> Vec<(&'static str, Vec<u8>)> {
    let mut coded = hdr(16, 8, "EXPOSURE=2\n", &[]);
    for _ in 0..8 {
        coded.extend([2, 2, 0, 16]);
        for channel in [128, 64, 32, 129] {
            coded.extend([128 + 10, channel, 6]);
            coded.extend([channel; 6]);
        }
    }
    let plane = || FlatSamples::F32(vec![0.5; 48]);
    vec![
        ("e.hdr", hdr(4, 4, "", &[[3, 4, 5, 128]; 16])),
        ("e.hdr", coded),
        ("e.exr", exr(8, 6, &[("R", plane()), ("G", plane()), ("B", plane())])),
    ]
}

#[test]
fn mutated_heights_never_panic() {
    // Of a TIFF without the bytes of a tile, too.
    let sparse = ("a.tif", sparse_tiff(16, [2, 1], &[None, Some(7.0)], Some("-9999")));
    for (i, (name, bytes)) in height_files().into_iter().chain([sparse]).enumerate() {
        let mut random = Random(0x5eed + i as u64);
        for _ in 0..ROUNDS {
            let bytes = mutate(&bytes, &mut random);
            check(name, parse_heights(Path::new(name), &bytes, &HeightOptions::default()));
        }
    }
}

#[test]
fn mutated_environments_never_panic() {
    for (i, (name, bytes)) in environment_files().into_iter().enumerate() {
        let mut random = Random(0xe17 + i as u64);
        for _ in 0..ROUNDS {
            let bytes = mutate(&bytes, &mut random);
            check(name, parse_environment(Path::new(name), &bytes, 0.0));
        }
    }
}

#[test]
fn mutated_planes_never_panic() {
    let files: Vec<_> = height_files()
        .into_iter()
        .filter(|(name, _)| ["a.png", "a.exr", "a.npy"].contains(name))
        .collect();
    for (i, (name, bytes)) in files.into_iter().enumerate() {
        let mut random = Random(0x91a + i as u64);
        for _ in 0..ROUNDS {
            check(name, parse_planes(Path::new(name), &mutate(&bytes, &mut random)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..Default::default() })]

    /// Bytes that keep a format's signature, so that they come past the first check.
    #[test]
    fn random_bytes_never_panic(tail in proptest::collection::vec(any::<u8>(), 0..600)) {
        for (name, bytes) in height_files().into_iter().chain(environment_files()) {
            for keep in [0, 4, 8, 10, 60] {
                let mut mixed = bytes[..keep.min(bytes.len())].to_vec();
                mixed.extend(&tail);
                let path = Path::new(name);
                if name.starts_with('e') {
                    check(name, parse_environment(path, &mixed, 0.0));
                } else {
                    check(name, parse_heights(path, &mixed, &HeightOptions::default()));
                }
            }
        }
    }

    /// What was written as any shape of floats reads back as itself.
    #[test]
    fn npy_round_trips(rows in 1_usize..9, cols in 1_usize..9, seed in any::<u64>()) {
        let mut random = Random(seed | 1);
        let values: Vec<f64> =
            (0..rows * cols).map(|_| random.below(1 << 20) as f64 - 5e5).collect();
        let data: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let bytes = npy("<f8", false, &format!("({rows}, {cols})"), &data);
        let field = parse_heights(Path::new("a.npy"), &bytes, &HeightOptions::default()).unwrap();
        for (height, value) in field.heights_m().iter().zip(&values) {
            prop_assert_eq!(f64::from(*height) + field.base_m(), *value);
        }
    }
}
