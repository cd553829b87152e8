//! NumPy arrays as planes, the reader that is this project's own from end to end.
//! Run with `cargo +nightly fuzz run npy`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ridgelight_io::parse_planes;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let _ = parse_planes(Path::new("a.npy"), bytes);
});
