//! Lights whose sum is no picture.

use crate::Folder;
use crate::needs_vulkan::{done, write_field};

/// 3e38 of a sky and 3e38/π of a sun overhead are beyond f32, 3.4e38, together: nothing is written. Each alone
/// is a picture.
#[test]
fn gpu_light_that_is_no_number_is_refused() {
    let folder = Folder::new();
    write_field(&folder, 5, |_, _| 7.0);
    done(&folder, "render field.npy -o sun.exr --sun 0,90,0.53,3e38 --quiet");
    let before = folder.contents();
    for args in [
        "render field.npy -o out.exr",
        "render field.npy -o out.png --json out.json",
        "trade field.npy -o out --budget 1",
    ] {
        let args = format!("{args} --sky 3e38 --sun 0,90,0.53,3e38");
        let run = folder.run(&args.split(' ').collect::<Vec<_>>());
        assert_eq!((run.status, run.err.lines().count()), (Some(2), 1), "{args}: {}", run.err);
        let said = "--sky, --env, --sun, --key, --light: found light of inf at row 0, column 0 of radiance";
        assert!(run.err.contains(said), "{args}: {}", run.err);
        assert!(folder.contents() == before, "{args}");
    }
}
