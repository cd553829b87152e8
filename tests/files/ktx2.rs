//! KTX2 files, read by another reader and checked by the rules of the specification.

use ::ktx2::Reader;
use ::ktx2::dfd::{Basic, Block};
use ridgelight_io::Component;
use ridgelight_io::{Ktx2Writer, TexelFormat};
use std::path::Path;

fn write(
    path: &Path,
    format: TexelFormat,
    size: [usize; 2],
    layers: Option<usize>,
    texts: &[(String, String)],
) -> Vec<u8> {
    let bytes = format.bytes() * size[0] * size[1] * layers.unwrap_or(1);
    let texels: Vec<u8> = (0..bytes).map(|i| (i * 37 + 11) as u8).collect();
    let mut writer = Ktx2Writer::create(path, format, size, layers, texts).unwrap();
    for piece in texels.chunks(7) {
        writer.write(piece).unwrap();
    }
    writer.finish().unwrap();
    texels
}

fn texts(all: &[(&str, &str)]) -> Vec<(String, String)> {
    all.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

const COMPONENTS: [Component; 6] = [
    Component::Unorm8,
    Component::Snorm8,
    Component::Unorm16,
    Component::Snorm16,
    Component::F16,
    Component::F32,
];

/// For every format the reader finds sides, layers, texels and texts, and describes the texels alike (but for colour
/// primaries, which plain numbers lack).
#[test]
fn another_reader_finds_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    let kept =
        texts(&[("ridgelight.kind", "horizon"), ("a", ""), ("ridgelight.decoding", "r π/2")]);
    for component in COMPONENTS {
        for count in [1, 2, 4] {
            let format = TexelFormat { component, count };
            let (number, name) = format.vulkan().unwrap();
            for layers in [None, Some(1), Some(3)] {
                // Sides whose bytes are not multiples of 4.
                let texels = write(&path, format, [5, 3], layers, &kept);
                let bytes = std::fs::read(&path).unwrap();
                let reader = Reader::new(&bytes).unwrap_or_else(|e| panic!("{name}: {e:?}"));
                let header = reader.header();
                let vulkan = header.format.expect("a format");
                assert_eq!(vulkan.value(), number);
                assert!(format!("{vulkan:?}").contains(name), "{vulkan:?} is not {name}");
                assert_eq!(
                    [header.pixel_width, header.pixel_height, header.pixel_depth],
                    [5, 3, 0]
                );
                assert_eq!(header.layer_count, layers.unwrap_or(0) as u32);
                assert_eq!([header.face_count, header.level_count], [1, 1]);
                assert_eq!(header.supercompression_scheme, None);
                let levels: Vec<_> = reader.levels().collect();
                assert_eq!(levels.len(), 1);
                assert!(levels[0].data == texels, "{name}: other texels");
                assert_eq!(levels[0].uncompressed_byte_length, texels.len() as u64);

                let (mut expected, type_size) = Basic::from_format(vulkan).expect("a known format");
                expected.color_primaries = None;
                assert_eq!(header.type_size, type_size);
                let [Block::Basic(found)] = reader.dfd_blocks() else {
                    panic!("{name}: one block")
                };
                assert_eq!(found.to_vec(), expected.to_vec(), "{name}: {found:?}");

                let all: Vec<_> = reader.key_value_data().collect();
                let writer = format!("ridgelight {}\0", env!("CARGO_PKG_VERSION"));
                let expected: [(&str, &[u8]); 5] = [
                    ("KTXorientation", b"rd\0"),
                    ("KTXwriter", writer.as_bytes()),
                    ("a", b"\0"),
                    ("ridgelight.decoding", "r π/2\0".as_bytes()),
                    ("ridgelight.kind", b"horizon\0"),
                ];
                assert_eq!(all, expected);
            }
        }
    }
}

/// Blocks and mip levels: the reader describes each format alike, and finds each level's bytes, the smallest level first in the
/// file (§3.9).
#[test]
fn blocks_and_levels_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    use ridgelight_io::Block::{Bc4, Bc6h, Bc7};
    for block in [Bc4, Bc6h, Bc7] {
        // 13 × 6, 6 × 3, 3 × 1 and 1 × 1 texels: 8, 2, 1 and 1 blocks.
        let (size, layers, blocks) = ([13, 6], 3, [8, 2, 1, 1]);
        let create = |levels: usize| {
            let count = (Some(layers), levels);
            Ktx2Writer::with_levels(&path, block.into(), size, count, &[])
        };
        assert!(create(0).is_err() && create(5).is_err());
        let mut writer = create(4).unwrap();
        let level = |n: usize, k: usize| vec![(16 * n + k) as u8; blocks[n] * block.bytes()];
        for layer in 0..layers {
            (0..4).for_each(|n| writer.write_level(n, &level(n, layer)).unwrap());
        }
        assert!(writer.write_level(3, &[0]).is_err() && writer.write_level(4, &[]).is_err());
        writer.finish().unwrap();
        let reader = Reader::new(std::fs::read(&path).unwrap()).unwrap();
        let header = reader.header();
        let vulkan = header.format.unwrap();
        assert_eq!((vulkan.value(), header.level_count), (block.vulkan().0, 4));
        let (mut expected, type_size) = Basic::from_format(vulkan).expect("a known format");
        expected.color_primaries = None;
        assert_eq!(header.type_size, type_size);
        let [Block::Basic(found)] = reader.dfd_blocks() else { panic!("{block:?}: one block") };
        assert_eq!(found.to_vec(), expected.to_vec(), "{block:?}: {found:?}");
        let levels: Vec<_> = reader.levels().collect();
        for (n, found) in levels.iter().enumerate() {
            let expected: Vec<u8> = (0..layers).flat_map(|k| level(n, k)).collect();
            assert!(found.data == expected, "{block:?}, level {n}");
        }
        let places: Vec<*const u8> = levels.iter().map(|level| level.data.as_ptr()).collect();
        assert!(places.iter().rev().is_sorted(), "the smallest level first");
    }
}

/// Places and order by the specification, which readers need not check: §3.4 and §3.8 (sections follow each other, at
/// multiples of 4), §3.9.7 (a level at a multiple of both a texel and 4), §3.11 (keys by code point).
#[test]
fn sections_lie_where_they_must() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    for component in COMPONENTS {
        for length in 0..9 {
            let format = TexelFormat { component, count: 4 };
            let kept = texts(&[("b", &"x".repeat(length))]);
            let texels = write(&path, format, [3, 1], Some(2), &kept);
            let bytes = std::fs::read(&path).unwrap();
            let reader = Reader::new(&bytes).unwrap();
            let index = reader.header().index;
            assert_eq!(index.dfd_byte_offset, 80 + 24);
            assert_eq!(index.kvd_byte_offset, index.dfd_byte_offset + index.dfd_byte_length);
            assert_eq!((index.dfd_byte_length % 4, index.kvd_byte_length % 4), (0, 0));
            assert_eq!([index.sgd_byte_offset, index.sgd_byte_length], [0, 0]);
            let total = u32::from_le_bytes(bytes[104..108].try_into().unwrap());
            assert_eq!(total, index.dfd_byte_length, "the first word of the descriptor");
            let at = u64::from_le_bytes(bytes[80..88].try_into().unwrap()) as usize;
            assert!(at.is_multiple_of(4) && at.is_multiple_of(format.bytes()), "{at}");
            let end = (index.kvd_byte_offset + index.kvd_byte_length) as usize;
            assert!((0..16).contains(&(at - end)), "{end} {at}");
            assert!(bytes[end..at].iter().all(|b| *b == 0), "padding is 0");
            assert_eq!(bytes.len(), at + texels.len());
            let keys: Vec<&str> = reader.key_value_data().map(|(key, _)| key).collect();
            assert!(keys.is_sorted(), "{keys:?}");
        }
    }
}

#[test]
fn what_is_no_texture_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    let format = TexelFormat { component: Component::F32, count: 1 };
    let create = |format, size, layers, kept: &[(&str, &str)]| {
        Ktx2Writer::create(&path, format, size, layers, &texts(kept))
    };
    let three = TexelFormat { count: 3, ..format };
    for (made, says) in [
        (create(three, [2, 2], None, &[]), "1, 2 or 4 components"),
        (create(format, [0, 2], None, &[]), "columns: found 0"),
        (create(format, [2, 1 << 33], None, &[]), "rows: found 8589934592"),
        (create(format, [2, 2], Some(0), &[]), "layers: found 0"),
        (create(format, [2, 2], None, &[("KTXwriter", "me")]), "the key \"KTXwriter\""),
        (create(format, [2, 2], None, &[("", "me")]), "the key \"\""),
        (create(format, [2, 2], None, &[("a", "1"), ("a", "2")]), "the key \"a\""),
    ] {
        let said = made.unwrap_err().to_string();
        assert!(said.contains(says), "{said}");
    }
    let mut many = create(format, [2, 2], None, &[]).unwrap();
    assert!(many.write(&[0; 17]).is_err());
    let mut few = create(format, [2, 2], None, &[]).unwrap();
    few.write(&[0; 12]).unwrap();
    assert!(few.finish().is_err());
    drop(many);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
