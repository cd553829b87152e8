//! Textures for engines: mip levels, block compression, and the axes of normals.

use ddsfile::{Dds, DxgiFormat};
use ridgelight_bake::{BENT_NORMAL, Encoding, HORIZON, RADIANCE, SHARE, encoding_named};
use serde_json::Value;

use super::light::{load, write};
use crate::needs_vulkan::{done, json};
use crate::{Folder, refused, succeeded};

/// A field whose sides are no multiples of 4.
fn field(folder: &Folder) {
    write(folder, "field.npy", [13, 22], |r, c| ((r * r + 3 * c) % 11) as f32 * 0.4);
}

fn file<'a>(manifest: &'a Value, kind: &str, format: &str) -> &'a Value {
    let own = |list: &'a Value, key: &str, name: &str| {
        let mut all = list.as_array().unwrap().iter();
        all.find(|entry| entry[key] == name).unwrap_or_else(|| panic!("{name} in {list}"))
    };
    own(&own(&manifest["maps"], "kind", kind)["files"], "format", format)
}

fn levels(reader: &ktx2::Reader<Vec<u8>>) -> Vec<Vec<u8>> {
    reader.levels().map(|level| level.data.to_vec()).collect()
}

/// Both containers hold the same blocks, and another decoder finds the values within the error of the manifest.
#[test]
fn gpu_blocks_hold_the_stated_error() {
    let folder = Folder::new();
    field(&folder);
    let words = "--what horizon,sky-view,bent-normal,scatter --albedo 0.5 --azimuths 4 --paths 8 --directions 8";
    let run = succeeded_with_notes(
        &folder,
        &format!("bake field.npy -o out {words} --compress --mips --format ktx2,dds,npy"),
    );
    let manifest = json(&folder.path("out/manifest.json"));
    type Decode = fn(&[u8], usize, usize, &mut [u32]) -> Result<(), &'static str>;
    // What the decoder cuts off a component. BC4: a fraction of sevenths of a code; BC6H: a fraction of a code; BC7 has whole
    // codes.
    let (sevenths, none, code) = (6.0 / 7.0 / 255.0, 0.0, 1.0 / 255.0);
    type Row = (&'static str, &'static [Encoding], &'static str, DxgiFormat, usize, Decode, f64);
    let all: [Row; 4] = [
        (
            "horizon",
            &HORIZON,
            "BC4_UNORM",
            DxgiFormat::BC4_UNorm,
            4,
            texture2ddecoder::decode_bc4,
            sevenths,
        ),
        (
            "sky-view",
            &SHARE,
            "BC4_UNORM",
            DxgiFormat::BC4_UNorm,
            1,
            texture2ddecoder::decode_bc4,
            sevenths,
        ),
        (
            "bent-normal",
            &BENT_NORMAL,
            "BC7_UNORM",
            DxgiFormat::BC7_UNorm,
            1,
            texture2ddecoder::decode_bc7,
            none,
        ),
        (
            "scatter",
            &RADIANCE,
            "BC6H_UFLOAT",
            DxgiFormat::BC6H_UF16,
            2,
            texture2ddecoder::decode_bc6_unsigned,
            code,
        ),
    ];
    for (kind, encodings, format, dxgi, layers, decode, cut) in all {
        let stem = kind.replace('-', "_");
        let path = |end: &str| folder.path(&format!("out/{stem}.{end}"));
        let reader = ktx2::Reader::new(std::fs::read(path("ktx2")).unwrap()).unwrap();
        let dds = Dds::read(std::fs::File::open(path("dds")).unwrap()).unwrap();
        assert!(run.contains(&format!("note: {kind}: error of {format}: ")), "{run}");
        assert!(run.contains("multiples of 4, and these are 22 x 13"), "{run}");
        // 22, 11, 5, 2 and 1 texels.
        let header = reader.header();
        assert_eq!([header.level_count, dds.get_num_mipmap_levels()], [5, 5]);
        assert_eq!([header.pixel_width, dds.get_width()], [22, 22]);
        assert_eq!([header.pixel_height, dds.get_height()], [13, 13]);
        assert_eq!(dds.get_dxgi_format(), Some(dxgi));
        assert_eq!(dds.get_num_array_layers() as usize, layers);
        let name = format!("{:?}", header.format.unwrap());
        assert_eq!(name, format!("{format}_BLOCK"));
        let entry = file(&manifest, kind, "ktx2");
        assert_eq!([&entry["texels"], &entry["mip_levels"]], [&Value::from(name), &Value::from(5)]);
        let levels = levels(&reader);
        let of_layer = |level: &[u8], layer: usize| {
            let bytes = level.len() / layers;
            level[layer * bytes..][..bytes].to_vec()
        };
        for layer in 0..layers {
            let own: Vec<u8> = levels.iter().flat_map(|level| of_layer(level, layer)).collect();
            assert!(dds.get_data(layer as u32).unwrap() == own, "{kind}, layer {layer}");
        }
        let name = manifest_encoding(&manifest, kind);
        let encoding = encoding_named(encodings, name).unwrap();
        let (_, values) = load(&path("npy"));
        // Planes of an .npy begin in the north and go clockwise, layers begin in the east.
        let places = if kind == "horizon" { vec![1, 0, 3, 2] } else { (0..layers).collect() };
        let count = encoding.bounds.len();
        let (mut worst, mut squares) = (vec![0.0_f64; count], vec![0.0; count]);
        for (layer, place) in places.into_iter().enumerate() {
            let mut words = vec![0; TEXELS];
            decode(&of_layer(&levels[0], layer), 22, 13, &mut words).unwrap();
            for (at, word) in words.iter().enumerate() {
                // Blue, green, red and alpha from the lowest byte on.
                let [b, g, r, a] = word.to_le_bytes().map(|code| f64::from(code) / 255.0);
                let plane = |k: usize| place * encoding.values + k;
                let was: Vec<f64> = (0..encoding.values)
                    .map(|k| f64::from(values[plane(k) * TEXELS + at]))
                    .collect();
                let mut is = vec![0.0; encoding.values];
                (encoding.decode)(&[r, g, b, a][..encoding.components], &mut is);
                if format.starts_with("BC6H") {
                    // This decoder cuts off above 1.
                    assert!(was.iter().all(|v| *v < 0.9), "{was:?}");
                }
                for (i, bound) in encoding.bounds.iter().enumerate() {
                    let [error, _] = (bound.error)(&is, &was);
                    (worst[i], squares[i]) = (worst[i].max(error), squares[i] + error * error);
                }
            }
        }
        let stated = entry["error"].as_array().unwrap();
        assert_eq!(stated.len(), count);
        for (i, stated) in stated.iter().enumerate() {
            assert_eq!(stated["is"], "measured over the first mip level of this file");
            let [most, rms] = ["at_most", "rms"].map(|key| stated[key].as_f64().unwrap());
            let found_rms = (squares[i] / (TEXELS * layers) as f64).sqrt();
            // What the decoder cuts off a component, times the slope of the value. The RMS changes by no more.
            let scale = if kind == "horizon" { std::f64::consts::FRAC_PI_2 } else { 1.0 };
            let slack = scale * cut + 1e-12;
            assert!(0.0 < rms && rms <= most, "{stated}");
            assert!((worst[i] - most).abs() <= slack, "{kind}: {} of {stated}", worst[i]);
            assert!((found_rms - rms).abs() <= slack, "{kind}: {found_rms} of {stated}");
            if format.starts_with("BC4") {
                // Half of a seventh of a block's range, which is 1 at most; codes of 8 bits add half a step to the value
                // and to both ends of the range.
                assert!(most <= scale * ((1.0 + 1.0 / 255.0) / 14.0 + 0.5 / 255.0), "{stated}");
            }
        }
    }
}

const TEXELS: usize = 22 * 13;

/// The name of the encoding of a kind.
fn manifest_encoding<'a>(manifest: &'a Value, kind: &str) -> &'a str {
    let map = manifest["maps"].as_array().unwrap().iter().find(|map| map["kind"] == kind);
    map.unwrap()["encoding"].as_str().unwrap()
}

/// Standard error, with notes on errors.
fn succeeded_with_notes(folder: &Folder, args: &str) -> String {
    let run = folder.run_str(args);
    assert_eq!(run.status, Some(0), "{}", run.err);
    run.err
}

/// Without compression a .dds holds the texels of the .ktx2. The last mip level is the mean of all texels, to the rounding of its
/// 16 bits and of the f32 of each level.
#[test]
fn gpu_mip_levels_are_means() {
    let folder = Folder::new();
    field(&folder);
    done(&folder, "bake field.npy -o out --what sky-view --mips --format ktx2,dds,npy");
    let reader = ktx2::Reader::new(std::fs::read(folder.path("out/sky_view.ktx2")).unwrap());
    let levels = levels(&reader.unwrap());
    let dds = Dds::read(std::fs::File::open(folder.path("out/sky_view.dds")).unwrap()).unwrap();
    assert!(dds.get_data(0).unwrap() == levels.concat());
    assert_eq!(dds.get_dxgi_format(), Some(DxgiFormat::R16_UNorm));
    let (_, values) = load(&folder.path("out/sky_view.npy"));
    let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
    let last = f64::from(u16::from_le_bytes([levels[4][0], levels[4][1]])) / 65535.0;
    assert_eq!(levels[4].len(), 2);
    assert!((last - mean).abs() < 0.5 / 65535.0 + 5.0 * f64::from(f32::EPSILON), "{last}, {mean}");
    assert!((last - f64::from(values[0])).abs() > 0.01, "all texels are alike");
}

/// DirectX has the other sign of y, and nothing else; floats keep north.
#[test]
fn gpu_normals_have_the_axes_of_the_engine() {
    let folder = Folder::new();
    field(&folder);
    let words =
        "--what bent-normal --encoding bent-normal=snorm16-xyz --format ktx2,npy --azimuths 8";
    let of = |normals: &str| {
        done(&folder, &format!("bake field.npy -o {normals} {words} --normals {normals}"));
        let path = |name: &str| folder.path(&format!("{normals}/{name}"));
        let reader = ktx2::Reader::new(std::fs::read(path("bent_normal.ktx2")).unwrap()).unwrap();
        // The file alone has the convention, too.
        let key = reader.key_value_data().find(|(key, _)| *key == "ridgelight.normals");
        let stated = json(&path("manifest.json"))["maps"][0]["normals"]["convention"].clone();
        let text = String::from_utf8(key.expect("a key").1.to_vec()).unwrap();
        assert_eq!(text.trim_end_matches('\0'), stated.as_str().unwrap());
        let texels: Vec<i16> = levels(&reader)[0]
            .as_chunks::<2>()
            .0
            .iter()
            .map(|bytes| i16::from_le_bytes(*bytes))
            .collect();
        let normals = json(&path("manifest.json"))["maps"][0]["normals"].clone();
        let of = normals["of"].as_str().unwrap();
        assert!(of.starts_with("png, ktx2, dds, before the decoder"), "{of}");
        let normals = normals["convention"].clone();
        let glsl = std::fs::read_to_string(path("bent_normal.glsl")).unwrap();
        (texels, load(&path("bent_normal.npy")).1, normals, glsl)
    };
    let (up, values, convention, glsl) = of("opengl");
    let (down, same, other, turned) = of("directx");
    assert_eq!([convention, other], ["OpenGL, +Y", "DirectX, -Y"]);
    assert!(values == same);
    assert!(glsl.contains("BENT_Y = 1.0;") && turned.contains("BENT_Y = -1.0;"));
    let texels = values.len() / 4;
    assert!(up.iter().skip(1).step_by(4).any(|y| *y != 0));
    for (at, (up, down)) in up.as_chunks::<4>().0.iter().zip(down.as_chunks::<4>().0).enumerate() {
        assert_eq!([up[0], -up[1], up[2], up[3]], *down);
        // x is east, y north and z up, as the planes of the .npy.
        for (c, code) in up[..3].iter().enumerate() {
            let value = 32767.0 * values[c * texels + at];
            assert!((f32::from(*code) - value).abs() <= 0.51, "{code} is {value}");
        }
    }
}

#[test]
fn wrong_textures_are_refused() {
    let folder = Folder::new();
    let with = |rest: &str| format!("bake a.asc -o out {rest}");
    let all = [
        (
            with("--what ellipse --compress"),
            &["--compress: found with f16 of ellipse", "unorm8"][..],
        ),
        (with("--what visible-points --compress"), &["--compress", "visible-points"]),
        (
            with("--what sky-view --encoding sky-view=unorm16 --compress"),
            &["--compress: found with unorm16 of sky-view"],
        ),
        (with("--what sky-view --format npy --compress"), &["--compress: found no texture", "dds"]),
        (with("--what sky-view --format npy --mips"), &["--mips: found no texture"]),
        (with("--what ellipse --mips"), &["--mips: found with ellipse", "horizon, sky-view"]),
        (with("--what horizon --normals directx"), &["--normals: found directx", "bent-normal"]),
    ];
    let cases: Vec<_> = all.iter().map(|(words, says)| (words.as_str(), 2, *says)).collect();
    refused(&folder, &cases);
    // The bound of the plan has every level.
    let words = with("--what sky-view --compress --mips --format dds --plan");
    assert!(succeeded(&folder, &words).out.contains("sky_view.dds"));
}
