//! Written files read back; a failed write leaves nothing.

use ridgelight::scene::Tone;
use ridgelight_io::*;
use std::path::Path;

/// Names in a folder, to show that no temporary file stays.
fn listing(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn exr_layers_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.exr");
    let (rows, cols) = (37, 23);
    let rgb: Vec<[f32; 3]> =
        (0..rows * cols).map(|i| [i as f32, 0.5 * i as f32, f32::MAX]).collect();
    let scalar: Vec<f32> =
        (0..rows * cols).map(|i| if i == 5 { f32::NAN } else { -(i as f32) }).collect();
    let layers = [
        Layer { name: String::new(), channels: Channels::Rgb(&rgb) },
        Layer { name: "direct.sky".into(), channels: Channels::Rgb(&rgb) },
        Layer { name: "error".into(), channels: Channels::Scalar("Y", &scalar) },
        Layer { name: "horizon".into(), channels: Channels::Scalar("", &scalar) },
    ];
    let metadata = [("device".to_owned(), "Größe".to_owned()), ("empty".to_owned(), String::new())];
    write_exr(&path, rows, cols, &layers, &metadata).unwrap();
    assert_eq!(listing(folder.path()), ["out.exr"]);

    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.rows, planes.cols), (rows, cols));
    let names =
        ["B", "G", "R", "direct.sky.B", "direct.sky.G", "direct.sky.R", "error.Y", "horizon"];
    assert_eq!(planes.names, names);
    for (i, value) in scalar.iter().enumerate() {
        assert_eq!([2, 1, 0].map(|p| planes.planes[p][i]), rgb[i]);
        assert_eq!([5, 4, 3].map(|p| planes.planes[p][i]), rgb[i]);
        assert!([6, 7].iter().all(|&p| planes.planes[p][i].to_bits() == value.to_bits()));
    }
    let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
    assert_eq!(meta.headers.len(), 1);
    let attributes = &meta.headers[0].own_attributes.other;
    assert!(attributes.iter().any(|(k, v)| k.eq("device")
        && matches!(v, exr::prelude::AttributeValue::Text(t) if t.bytes() == "Größe".as_bytes())));
    // Other readers: the exr crate's own, and the image crate's, which takes the main layer.
    let all = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
    let channel = |name: &str| {
        let found = all.layer_data.channel_data.list.iter().find(|c| c.name.eq(name)).unwrap();
        found.sample_data.values_as_f32().collect::<Vec<_>>()
    };
    assert_eq!(channel("direct.sky.G"), rgb.iter().map(|t| t[1]).collect::<Vec<_>>());
    assert_eq!(channel("horizon")[6], scalar[6]);
    let picture = image::open(&path).unwrap().into_rgb32f();
    assert_eq!(picture.dimensions(), (cols as u32, rows as u32));
    assert!(picture.pixels().zip(&rgb).all(|(p, t)| p.0 == *t));

    // A failed write leaves the old file and nothing else.
    let before = std::fs::read(&path).unwrap();
    let short = [Layer { name: String::new(), channels: Channels::Rgb(&rgb[1..]) }];
    let twice = [layers[0].clone(), layers[0].clone()];
    let nameless = [Layer { name: String::new(), channels: Channels::Scalar("", &scalar) }];
    let reserved = [("channels".to_owned(), "x".to_owned())];
    assert!(write_exr(&path, rows, cols, &short, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &twice, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &nameless, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &[], &[]).is_err());
    assert!(write_exr(&path, rows, cols, &layers, &reserved).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(listing(folder.path()), ["out.exr"]);
}

/// Another reader finds the texts in either chunk; a name that PNG does not allow leaves no file.
#[test]
fn png_texts_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.png");
    let text = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let metadata =
        [text("device", "Größe ꟻ"), text("tried", "--lines 1: 0.5 %"), text("empty", "")];
    let write = |metadata: &[(String, String)]| {
        write_png(&path, 1, 2, &[[0.5; 3]; 2], None, Tone::default(), metadata)
    };
    for name in [
        "",
        "a name of more than seventy-nine bytes, which is as long as PNG lets a keyword be at most",
    ] {
        assert!(write(&[text(name, "x")]).is_err(), "{name}");
        assert!(listing(folder.path()).is_empty());
    }
    write(&metadata).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let latin =
        reader.info().uncompressed_latin1_text.iter().map(|t| (t.keyword.clone(), t.text.clone()));
    let unicode =
        reader.info().utf8_text.iter().map(|t| (t.keyword.clone(), t.get_text().unwrap()));
    let all: Vec<_> = unicode.chain(latin).collect();
    assert_eq!(all, metadata);
    assert_eq!(read_planes(&path).unwrap().names, ["R", "G", "B"]);
}

#[test]
fn png_round_trips_to_the_step_of_eight_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.png");
    let (rows, cols) = (5, 51);
    let mut rgb: Vec<[f32; 3]> = (0..255).map(|i| [i as f32 / 255.0, 2.0, -1.0]).collect();
    write_png(&path, rows, cols, &rgb, None, Tone { exposure: 0.5, ..Tone::default() }, &[])
        .unwrap();
    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.names.join(""), planes.rows, planes.cols), ("RGB".into(), rows, cols));
    for (i, texel) in rgb.iter().enumerate() {
        // Half a code is at most 1/510 of encoded range; the curve's slope is at most 2.275 there
        // (at white, 2.4/1.055).
        let got = planes.planes[0][i];
        assert!((got - texel[0] * 0.5).abs() < 2.275 / 510.0 + 1e-6, "{got} for {}", texel[0]);
        assert_eq!((planes.planes[1][i], planes.planes[2][i]), (1.0, 0.0));
    }
    rgb[7] = [f32::NAN; 3];
    let error = write_png(&path, rows, cols, &rgb, None, Tone::default(), &[]).unwrap_err();
    assert!(error.to_string().contains("row 0, column 7"), "{error}");
    let transparent: Vec<bool> = (0..255).map(|i| i == 7).collect();
    write_png(&path, rows, cols, &rgb, Some(&transparent), Tone::default(), &[]).unwrap();
    assert_eq!(image::open(&path).unwrap().color(), image::ColorType::Rgba8);
    let planes = read_planes(&path).unwrap();
    assert_eq!(planes.names.join(""), "RGBA");
    assert!((0..255).all(|i| planes.planes[3][i] == if i == 7 { 0.0 } else { 1.0 }));
    assert!(write_png(&path, 5, 5, &rgb, None, Tone::default(), &[]).is_err());
    assert!(write_png(&path, rows, cols, &rgb, None, Tone::picture(f32::NAN), &[]).is_err());
    assert_eq!(listing(folder.path()), ["out.png"]);
}

#[test]
fn json_is_whole_and_indented() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    let value = serde_json::json!({ "rmse": 0.1, "names": ["sky", "Größe"], "none": null });
    write_json(&path, &value).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("\n  \"rmse\": 0.1") && text.ends_with("}\n"), "{text}");
    assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    assert_eq!(listing(folder.path()), ["a.json"]);
}

#[test]
fn npy_streams_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.npy");
    let values: Vec<f32> = (0..2 * 3 * 5).map(|i| i as f32).collect();
    write_npy_f32(&path, &[2, 3, 5], values.chunks(7)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!((bytes.len() - 30 * 4) % 64, 0);
    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.rows, planes.cols, planes.names.len()), (3, 5, 2));
    assert_eq!(planes.planes.concat(), values);
    assert!(write_npy_f32(&path, &[2, 3, 5], values[1..].chunks(7)).is_err());
    assert!(write_npy_f32(&path, &[2, 3, 4], values.chunks(7)).is_err());
    assert!(write_npy_f32(&path, &[usize::MAX, 2], values.chunks(7)).is_err());
    let mut writer = NpyWriter::create(&folder.path().join("dropped.npy"), &[30]).unwrap();
    writer.write(&values).unwrap();
    drop(writer);
    assert_eq!(listing(folder.path()), ["out.npy"]);
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    write_npy_f32(&path, &[4], [&[1.0, f32::NAN, 3.0, 4.0][..]]).unwrap();
    assert!(read_planes(&path).is_err(), "one dimension is no plane");
}

#[test]
fn text_replaces_text_through_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    write_text(&path, "{}").unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let plain = folder.path().join("plain");
        std::fs::write(&plain, "").unwrap();
        let mode = |p: &Path| std::fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain), "as readable as any new file");
        std::fs::remove_file(plain).unwrap();
        let link = folder.path().join("link.json");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_text(&link, "[1]").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "[1]");
    }
}
