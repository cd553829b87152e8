//! Previews: pictures that answer input before the full light is complete.

use super::{Display, Folder, LIT, apart, assert_same, code, colours, silent};

/// RMSE of a picture in some columns and rows, over its own mean there.
fn error(folder: &Folder, shown: &str, full: &str, [left, top, cols, rows]: [usize; 4]) -> f64 {
    let cut = |name: &str| {
        let picture = folder.picture(name);
        let within = |plane: &&[f32]| -> Vec<f32> {
            let rows = plane.chunks_exact(picture.cols).skip(top).take(rows);
            rows.flat_map(|row| &row[left..left + cols]).copied().collect()
        };
        colours(&picture).iter().map(within).collect::<Vec<_>>().concat()
    };
    let (a, b) = (cut(shown), cut(full));
    let pairs = || a.iter().zip(&b);
    let square: f64 = pairs().map(|(a, b)| f64::from(a - b).powi(2)).sum();
    let mean: f64 = pairs().map(|(_, b)| f64::from(*b)).sum();
    (square * pairs().count() as f64).sqrt() / mean
}

/// A field of 512 x 512, "large.asc".
fn write_large(folder: &Folder) {
    let side = 512;
    let height = |i: usize| {
        let [x, y] = [i % side, i / side].map(|n| n as f32 / 40.0);
        (60.0 * (x.sin() + (0.7 * y).cos() + 0.4 * (2.3 * x + y).sin())).to_string()
    };
    let heights: Vec<String> = (0..side * side).map(height).collect();
    let header = format!("ncols {side}\nnrows {side}\nxllcorner 0\nyllcorner 0\ncellsize 5\n");
    folder.write("large.asc", format!("{header}{}\n", heights.join(" ")).as_bytes());
}

/// The first pictures after each input are previews, on grids that the script fixes: near their own full light and far
/// from the old one. The picture at rest is that of `render`, to a code where it was summed in other parts.
#[test]
fn gpu_previews_show_the_new_light() {
    let (folder, display) = (Folder::new(), Display::new());
    write_large(&folder);
    let script = "key h\nkey h\npreview 3,2,1\nframes 1\nrest\nframes 1\nscreenshot before.png\n\
        key shift+right\nkey shift+right\nkey shift+right\nkey shift+right\nkey shift+right\nkey shift+right\n\
        screenshot preview.png\npicture saved.png\nscreenshot full.png\nscene full.json\n\
        key v\nframes 1\nscreenshot turned_before.png\nkey shift+left\nkey shift+left\nkey shift+left\nkey shift+left\n\
        screenshot turned.png\nrest\nscreenshot turned_full.png\n\
        key v\nkey 2\nkey 1\nscreenshot unedited.png\nkey 2\ndrag left 200,200 40,10\nkey 1\n\
        screenshot edit.png\nrest\nscreenshot edit_full.png\nkey 2\nrest\ndrag left 300,300 20,5\n\
        screenshot again.png\nrest\nscreenshot again_full.png\n\
        key z\nkey z\nkey w\nframes 2\nscene moved.json\nkey w\nrest\n\
        key tab\nkey tab\nkey tab\nkey tab\nkey tab\nkey ,\nkey ,\nkey ,\ntext refused.txt\nkey .\nkey .\nframes 1\nrest\n";
    folder.view(&display, "large.asc --size 512x512", script);
    folder.done("render --scene full.json -o render.png --quiet");
    let picture = |name: &str| folder.picture(name);
    // Requested with the preview shown, saved with the full light.
    for name in ["saved.png", "full.png"] {
        let at_rest = apart(&picture(name), &picture("render.png"));
        assert!(at_rest <= 1.0, "{name}: {at_rest} codes");
    }
    let whole = [0, 0, 512, 512];
    for (shown, full, old, at) in [
        ("preview.png", "full.png", "before.png", whole),
        ("turned.png", "turned_full.png", "turned_before.png", whole),
        ("edit.png", "edit_full.png", "unedited.png", [168, 168, 104, 74]),
        ("again.png", "again_full.png", "unedited.png", [268, 268, 84, 69]),
    ] {
        let [new, old] = [full, old].map(|other| error(&folder, shown, other, at));
        // 0: not a preview but the full light.
        assert!(0.0 < new && new < 0.05 && old > 2.0 * new, "{shown}: {new}, {old}");
    }
    // A stroke of radius 160 m from column 200, row 200, 40 right and 10 down. The light far from it is the same. Key 1 hides
    // the brush's ring, which is at the pointer.
    let (edit, unedited) = (picture("edit.png"), picture("unedited.png"));
    let reached = |from: usize, to: usize, margin: usize, at: usize| {
        (from - margin..to + margin).contains(&at)
    };
    let (mut inside, mut outside, mut farthest) = (0.0_f64, 0.0_f64, [0, 0]);
    for (a, b) in colours(&edit).iter().zip(colours(&unedited)) {
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            let off = (code(*a) - code(*b)).abs();
            let is_in =
                |margin| reached(168, 272, margin, i % 512) && reached(168, 242, margin, i / 512);
            if is_in(0) {
                inside = inside.max(off);
            } else if !is_in(96) && off > outside {
                (outside, farthest) = (off, [i % 512, i / 512]);
            }
        }
    }
    // Shown: more than twice what may differ elsewhere.
    assert!(outside <= 4.0 && inside > 8.0, "{inside}, {outside} codes at {farthest:?}");
    let refused = std::fs::read_to_string(folder.0.path().join("refused.txt")).unwrap();
    assert!(refused.contains("--lines"), "{refused}");
    // Without the strokes, which were undone, saved heights are those of the same frame without previews.
    folder.view(&display, "large.asc --size 512x512", "key w\nframes 2\nscene plain.json\n");
    let heights = |name: &str| std::fs::read(folder.0.path().join(name)).unwrap();
    assert!(heights("moved.npy") == heights("plain.npy"));
}

/// Strokes of the comparison, which has no previews, are in later previews.
#[test]
fn gpu_previews_have_the_strokes_of_the_comparison() {
    let (folder, display) = (Folder::new(), Display::new());
    write_large(&folder);
    let stroke = "key 2\nframes 1\ndrag left 50,100 30,5\nframes 1\n";
    let picture = |name: &str, stroke: &str| {
        let script = format!(
            "key h\nkey h\npreview 4,3,2\nframes 1\nkey c\nframes 1\n{stroke}key c\n\
             key shift+right\nscreenshot {name}\n"
        );
        folder.view(
            &display,
            "large.asc --sun 315,35 --sky 0.3 --azimuths 8 --size 512x512",
            &script,
        );
        folder.picture(name)
    };
    let (with, without) =
        (picture("with.png", stroke), picture("without.png", "key 2\nframes 1\n"));
    assert!(apart(&with, &without) > 32.0);
}

/// Grids that a thread has made since the full light was complete show the same preview as grids that are made at the input, and
/// another one than the grids before.
#[test]
fn gpu_grids_made_at_rest_show_the_same_preview() {
    let (folder, display) = (Folder::new(), Display::new());
    write_large(&folder);
    let (other, turn) = ("preview 6,4,2\n", "key shift+right\nkey shift+right\n");
    for (name, at_input, at_rest) in
        [("made_at_rest.png", "", other), ("made_at_input.png", other, ""), ("kept.png", "", "")]
    {
        let script = format!(
            "key h\nkey h\npreview 3,2,1\nframes 1\nrest\n{turn}frames 1\n{at_rest}rest\n{at_input}{turn}screenshot {name}\n"
        );
        folder.view(&display, &format!("large.asc {LIT} --size 512x512"), &script);
    }
    assert_same(&folder, "made_at_rest.png", "made_at_input.png");
    // The equality above can fail: other grids show another picture.
    let [other, kept] = ["made_at_rest.png", "kept.png"].map(|name| folder.picture(name));
    assert!(apart(&other, &kept) > 0.0);
}

/// The rest preview has finer grids and a smaller error than the drag preview. After a stroke its grids are made again, with the new
/// heights.
#[test]
fn gpu_rest_previews_are_finer() {
    let (folder, display) = (Folder::new(), Display::new());
    write_large(&folder);
    let turn = "key shift+right\n".repeat(6);
    // Tab shows the panel with azimuths as the chosen setting.
    let input = |name: &str| {
        format!(
            "{turn}screenshot {name}_drag.png\nrest-preview\nscreenshot {name}_rest.png\n\
             key tab\nframes 1\ntext {name}.txt\nkey h\nkey h\nrest\nscreenshot {name}_full.png\n"
        )
    };
    let stroke = "key 2\nframes 1\ndrag left 200,200 40,10\nrest\nkey 1\n";
    let script = [
        "key h\nkey h\npreview 8,6,4 4,3,2\nframes 1\nrest\n",
        &input("lit"),
        stroke,
        &input("edited"),
    ];
    folder.view(&display, &format!("large.asc {LIT} --size 512x512"), &script.concat());
    let text =
        |name: &str| std::fs::read_to_string(folder.0.path().join(format!("{name}.txt"))).unwrap();
    for name in ["lit", "edited"] {
        let of = |shown: &str| {
            let [shown, full] = [shown, "full"].map(|shown| format!("{name}_{shown}.png"));
            // Within the stroke, where there is one.
            let at = if name == "lit" { [0, 0, 512, 512] } else { [168, 168, 104, 74] };
            error(&folder, &shown, &full, at)
        };
        let [drag, rest] = ["drag", "rest"].map(of);
        assert!(0.0 < rest && rest < 0.7 * drag, "{name}: {drag}, {rest}");
        let text = text(name);
        assert!(text.contains("grids: sky 128 x 128, sun 171 x 171, slopes 256 x 256"), "{text}");
        // While a preview is shown, the panel does not report that a setting changes nothing.
        assert!(text.contains("> azimuths") && !text.contains("changes nothing"), "{text}");
    }
}

/// The rest preview is left out where it, the drag preview and the full light together exceed the memory budget, which the full light
/// alone does not. With four times the budget it is shown.
#[test]
fn gpu_rest_previews_stay_within_the_memory_budget() {
    let (folder, display) = (Folder::new(), Display::new());
    write_large(&folder);
    let script =
        "preview 8,6,4 4,3,2\nframes 1\nrest\nkey shift+right\nframes 1\nrest-preview\nrest\n";
    let window = |mib: u32| {
        let args = format!("large.asc {LIT} --size 512x512 --memory-budget {mib}MiB");
        folder.window(&display, &args, script)
    };
    let said = window(30).output().unwrap();
    let why = String::from_utf8(said.stderr).unwrap();
    assert!(!said.status.success() && why.contains("rest-preview: found none"), "{why}");
    silent(window(120));
}
