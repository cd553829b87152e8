//! Compiles or copies the shaders for the library: SPIR-V in `$OUT_DIR/shaders.spv`, and its reflection in
//! `$OUT_DIR/shaders.rs`.
//!
//! With the feature `glslang` (default) or `shaderc`, both files come from the GLSL of `shaders_glsl/`. Without
//! either they are copies of `shaders_glsl/compiled/`, which needs no C++ compiler. `tools/shaders` writes that
//! folder from the GLSL; `tools/shaders --check` fails where the two differ.

#[cfg(any(feature = "glslang", feature = "shaderc"))]
#[path = "build/compile.rs"]
mod compile;
#[cfg(any(feature = "glslang", feature = "shaderc"))]
#[path = "build/generate.rs"]
mod generate;
#[cfg(any(feature = "glslang", feature = "shaderc"))]
#[path = "build/reflect.rs"]
mod reflect;

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    #[cfg(any(feature = "glslang", feature = "shaderc"))]
    {
        println!("cargo:rerun-if-changed=build");
        generate::core(&out);
        generate::decoders(&out);
    }
    #[cfg(not(any(feature = "glslang", feature = "shaderc")))]
    copy(&out);
}

/// Copies the committed files instead of compiling.
#[cfg(not(any(feature = "glslang", feature = "shaderc")))]
fn copy(out: &Path) {
    for name in ["shaders.rs", "shaders.spv"] {
        let from = Path::new("shaders_glsl/compiled").join(name);
        println!("cargo:rerun-if-changed={}", from.display());
        write(&out.join(name), &read(&from));
    }
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
