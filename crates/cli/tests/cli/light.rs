//! Lights whose sum is no picture.

use crate::Folder;
use crate::needs_vulkan::{done, write_field};

/// What is beyond f32, 3.4e38, is neither asked for nor written: 1e36 is a picture, and a thousand suns of it overhead
/// are 3.2e38; a tenth more are none.
#[test]
fn gpu_light_that_is_no_number_is_refused() {
    let folder = Folder::new();
    write_field(&folder, 5, |_, _| 7.0);
    done(&folder, "render field.npy -o sun.exr --sun 0,90,0.53,1e36 --quiet");
    let suns = " --sun 0,90,0,1e36".repeat(1200);
    let before = folder.contents();
    for args in [
        "render field.npy -o out.exr",
        "render field.npy -o out.png --json out.json",
        "trade field.npy -o out --evaluations 1",
    ] {
        let args = format!("{args}{suns}");
        let run = folder.run(&args.split(' ').collect::<Vec<_>>());
        assert_eq!((run.status, run.err.lines().count()), (Some(2), 1), "{args}: {}", run.err);
        let said = "--sky, --env, --sun, --key, --light: found light of inf at row 0, column 0 of radiance";
        assert!(run.err.contains(said), "{args}: {}", run.err);
        assert!(folder.contents() == before, "{args}");
    }
}
