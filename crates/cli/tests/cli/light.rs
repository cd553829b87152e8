//! Lights whose sum overflows.

use crate::Folder;
use crate::needs_vulkan::{done, write_field};

/// Light beyond f32, 3.4e38, is refused: one sun of 1e36 renders, a thousand of them overhead reach 3.2e38, and a tenth more
/// are refused.
#[test]
fn gpu_light_that_is_no_number_is_refused() {
    let folder = Folder::new();
    write_field(&folder, 5, |_, _| 7.0);
    done(&folder, "render field.npy -o sun.exr --sun 0,90,0.53,1e36 --quiet");
    let suns = " --sun 0,90,0,1e36".repeat(1200);
    let before = folder.contents();
    for args in [
        "render field.npy -o out.exr",
        "render field.npy -o out.png --albedo 1 --json out.json",
        "trade field.npy -o out --evaluations 1",
    ] {
        let args = format!("{args}{suns}");
        let run = folder.run_str(&args);
        assert_eq!((run.status, run.err.lines().count()), (Some(2), 1), "{args}: {}", run.err);
        let said = "--sky, --env, --sun, --key, --sphere-light: found light of inf at row 0, column 0 of radiance";
        assert!(run.err.contains(said), "{args}: {}", run.err);
        assert!(folder.contents() == before, "{args}");
    }
}
