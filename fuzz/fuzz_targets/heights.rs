//! Height fields of every format; the first byte chooses it.
//! Run with `cargo +nightly fuzz run heights -- -rss_limit_mb=4096`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ridgelight_io::{HeightOptions, parse_heights};
use std::path::Path;

const NAMES: [&str; 7] = ["a.png", "a.exr", "a.tif", "N44W072.hgt", "a.asc", "a.npy", "a.npz"];

fuzz_target!(|bytes: &[u8]| {
    if let Some((first, rest)) = bytes.split_first() {
        let name = NAMES[usize::from(*first) % NAMES.len()];
        let _ = parse_heights(Path::new(name), rest, &HeightOptions::default());
    }
});
