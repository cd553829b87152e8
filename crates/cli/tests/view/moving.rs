//! Waves and a ridge: frames of new heights leave out tables of the light, but have the same light as with all passes.

use super::lost::{OUT_OF_DEVICE_MEMORY, beset};
use super::{Display, Folder, apart, assert_same, colours, crop, silent};

/// An environment that turns with the sun.
const CLEAR: &str = "hills.asc --sun 315,30 --sky clear --azimuths 8 --tint none --size 64x48";

/// Eight steps of a shape, of which the last is shown and saved. In `late` the sun moves before the last step, whose frame then
/// computes everything. In `early` it moves before the second, and the frames after that compute no tables. Of three pictures side
/// by side, the second shows the same light as a single picture, and the first has no shadows.
#[test]
fn gpu_moving_frames_have_the_light_of_all_passes() {
    let (folder, display) = (Folder::new(), Display::new());
    for (key, split) in [("w", ""), ("g", ""), ("w", "key c\n")] {
        let begin = format!("{split}frames 3\ntext still.txt\nkey {key}\n");
        let turn = "key shift+right\nkey shift+right\nkey shift+up\nkey shift+up\n";
        for (name, light) in [
            ("early", format!("frames 1\n{turn}frames 6\n")),
            ("late", format!("frames 7\n{turn}")),
            ("never", "frames 7\n".to_owned()),
        ] {
            let end = format!(
                "text {name}.txt\nkey h\nkey h\nscreenshot {name}_shown.png\npicture {name}.png\n"
            );
            folder.view(&display, CLEAR, &format!("{begin}{light}{end}"));
        }
        // The path tracer's picture depends on time.
        let panes = if split.is_empty() { vec![[0, 64]] } else { vec![[0, 20], [22, 20]] };
        let names = ["early", "late", "never"];
        let shown = panes.iter().map(|[first, cols]| {
            names.map(|name| crop(&folder.picture(&format!("{name}_shown.png")), *first, *cols))
        });
        let saved = names.map(|name| folder.picture(&format!("{name}.png")));
        for (i, [early, late, never]) in shown.chain([saved]).enumerate() {
            assert!(colours(&early) == colours(&late), "{key}{split}: picture {i}");
            let far = apart(&late, &never);
            assert!(far > 2.0, "{key}{split}: picture {i}: {far} codes");
        }
        let text = |name: &str| std::fs::read_to_string(folder.0.path().join(name)).unwrap();
        assert!(text("still.txt").contains("env_tables"), "{}", text("still.txt"));
        let moving = text("early.txt");
        assert!(!moving.contains("env_tables") && moving.contains("sky_shade"), "{moving}");
    }
}

/// The device fails once, at the first frame of a movement or at the second, which computes no tables. The passes of a failed frame
/// do not count as recorded.
#[test]
fn gpu_failed_moving_frame_is_recomputed() {
    let (folder, display) = (Folder::new(), Display::new());
    let script =
        |count: u32, name: &str| format!("frames 2\nkey w\nframes {count}\npicture {name}.png\n");
    folder.view(&display, CLEAR, &script(4, "whole"));
    folder.view(&display, CLEAR, &script(3, "before"));
    for failed in [3, 4] {
        // The shape also moves in a frame that fails.
        let mut window = folder.window(&display, CLEAR, &script(3, "again"));
        beset(&folder, &mut window, ("vkQueueSubmit2", failed, 1, OUT_OF_DEVICE_MEMORY));
        silent(window);
        assert_same(&folder, "again.png", "whole.png");
    }
    assert!(apart(&folder.picture("before.png"), &folder.picture("whole.png")) > 2.0);
}
