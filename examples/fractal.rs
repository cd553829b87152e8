//! Writes the fractal field of `ridgelight bench --size N` as a file that commands read.
//!
//! `cargo run --release --example fractal -- SIDE FIELD.npy`

use std::path::Path;

use ridgelight::scene::fractal;
use ridgelight::{Error, Result};
use ridgelight_io as files;

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [side, path] = args.as_slice() else {
        return Err(Error::setting("fractal", args.join(" "), "SIDE FIELD.npy"));
    };
    let side = side.parse().map_err(|_| Error::setting("SIDE", side, "a whole number"))?;
    files::write_npy_heights(Path::new(path), &fractal(side, 1)?)
}
