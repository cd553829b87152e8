//! Writes the shaders for the library: SPIR-V to `$OUT_DIR/shaders.spv`, and its reflection to `$OUT_DIR/shaders.rs`.
//!
//! With the feature `glslang` (default) or `shaderc`, the SPIR-V comes from the GLSL of `shaders_glsl/`. Without
//! either it is that of `shaders_glsl/compiled/shaders.spv`, which needs no C++ compiler. `tools/shaders` writes that
//! file from the GLSL; `tools/shaders --check` fails where the two differ. The shaders of tests are handled alike.

#[cfg(any(feature = "glslang", feature = "shaderc"))]
#[path = "build/compile.rs"]
mod compile;
#[path = "build/generate.rs"]
mod generate;
#[path = "build/reflect.rs"]
mod reflect;

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=build");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    generate::core(&out);
    generate::decoders(&out);
}

fn read(path: &Path) -> Vec<u8> {
    fs::read(path).unwrap_or_else(|e| fail(&format!("{}: {e}", path.display())))
}

fn write(path: &Path, bytes: &[u8]) {
    fs::write(path, bytes).unwrap_or_else(|e| fail(&format!("{}: {e}", path.display())));
}

fn fail(message: &str) -> ! {
    eprintln!("{message}");
    std::process::exit(1);
}
