//! Environments: Radiance where the first byte is even, OpenEXR where it is odd.
//! Run with `cargo +nightly fuzz run environment -- -rss_limit_mb=4096`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ridgelight_io::parse_environment;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Some((first, rest)) = bytes.split_first() {
        let name = if first % 2 == 0 { "a.hdr" } else { "a.exr" };
        let _ = parse_environment(Path::new(name), rest, 0.0);
    }
});
