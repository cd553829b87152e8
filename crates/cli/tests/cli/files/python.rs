//! Files that Python libraries write and read: arrays by NumPy, textures by Pillow.

use std::process::Command;

use ridgelight_io::{HeightOptions, read_field};

use super::gdal_inputs::absolute;
use super::geotiff::gdal_values;
use crate::{Folder, formats};

/// Runs a program in Debian's own Python, in the folder; returns what it prints.
fn python(folder: &Folder, program: &str) -> String {
    let mut command = Command::new("/usr/bin/python3");
    command.current_dir(folder.path("")).args(["-c", program]);
    let output = command.output().expect("/usr/bin/python3: run tools/setup --tests");
    assert!(output.status.success(), "{program}{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// NumPy finds the values that GDAL finds in the GeoTIFF of the same command.
#[test]
#[ignore = "needs NumPy and GDAL: Debian's gdal-bin"]
fn numpy_reads_the_values_of_geotiffs() {
    let folder = Folder::new();
    // 30 grid points, one of them a void.
    let head =
        "ncols 6\nnrows 5\nxllcorner 500000\nyllcorner 4900000\ncellsize 30\nNODATA_value -9\n";
    let height = |i: i32| if i == 8 { -9 } else { i * 7919 % 250 };
    let cells: String = (0..30).map(|i| format!("{} ", height(i))).collect();
    folder.write("dem.asc", (head.to_owned() + &cells).as_bytes());
    for command in [
        "hillshade dem.asc -o shade.npy",
        "hillshade dem.asc -o shade.tif",
        "horizon dem.asc --azimuths 8 --distances far.npy -o horizon.npy",
        "horizon dem.asc --azimuths 8 --distances far.tif -o horizon.tif",
        "bake dem.asc --what horizon,sky-view,bent-normal --azimuths 8 --format npy,tif -o maps",
    ] {
        let run = folder.run_str(command);
        assert_eq!(run.status, Some(0), "{command}: {}", run.err);
    }
    let mut all = Vec::new();
    for (name, shape) in [
        ("shade", "5 6"),
        ("horizon", "8 5 6"),
        ("far", "8 5 6"),
        ("maps/horizon", "8 5 6"),
        ("maps/sky_view", "5 6"),
        ("maps/bent_normal", "4 5 6"),
    ] {
        let program = format!(
            "import numpy\n\
            a = numpy.load('{name}.npy')\n\
            assert a.dtype == numpy.dtype('<f4') and a.flags.c_contiguous, (a.dtype, a.flags)\n\
            a.tofile('values')\n\
            print(*a.shape)\n"
        );
        let found = python(&folder, &program);
        // An array of one plane may have an axis for it.
        assert!([shape, &format!("1 {shape}")].contains(&found.trim_end()), "{name}: {found}");
        let bytes = std::fs::read(folder.path("values")).unwrap();
        let values: Vec<f32> =
            bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        let expected = gdal_values(&folder.path(&format!("{name}.tif")));
        assert_eq!(values.len(), expected.len(), "{name}");
        for (i, (value, expected)) in values.iter().zip(&expected).enumerate() {
            let is_same = value == expected || value.is_nan() && expected.is_nan();
            assert!(is_same, "{name}: {value} is {expected} at {i}");
        }
        // The void is NaN in each plane, and nothing else is.
        let voids = values.iter().filter(|value| value.is_nan()).count();
        assert_eq!(voids, values.len() / 30, "{name}");
        all.push(values);
    }
    // Another map has other values, voids aside.
    let known = |i: usize| -> Vec<f32> { all[i].iter().copied().filter(|v| !v.is_nan()).collect() };
    assert!(known(1) != known(2) && known(0) != known(4));
}

/// Arrays of every number type that heights can have, in both byte orders and both orders of axes; one plane of several; archives.
#[test]
#[ignore = "needs NumPy: Debian's gdal-bin"]
fn numpy_arrays_are_read() {
    let folder = Folder::new();
    let kinds = "f2 f4 f8 i1 i2 i4 i8 u1 u2 u4 u8";
    let program = format!(
        "import numpy\n\
        a = numpy.arange(12).reshape(3, 4) * 10\n\
        for kind in '{kinds}'.split():\n \
            for order, name in ('<', 'little'), ('>', 'big'):\n  \
                for axes in 'CF':\n   \
                    of = numpy.array(a, dtype=order + kind, order=axes)\n   \
                    numpy.save(kind + name + axes, of)\n\
        numpy.save('planes', numpy.stack([0 * a, a]).astype('f4'))\n\
        numpy.savez('stored', elevation=a.astype('f4'), dx=30.0, dy=20.0)\n\
        numpy.savez_compressed('packed', elevation=a.astype('>i2'), dx=30.0, dy=20.0)\n"
    );
    python(&folder, &program);
    let expected: Vec<f32> = (0_u8..12).map(|i| 10.0 * f32::from(i)).collect();
    let read = |name: &str, band| {
        let options = HeightOptions { band, ..HeightOptions::default() };
        let read = read_field(&folder.path(name), &options);
        let field = read.unwrap_or_else(|error| panic!("{error}")).field;
        assert_eq!([field.rows(), field.cols()], [3, 4], "{name}");
        assert_eq!(absolute(&field), expected, "{name}");
        field.cell_m()
    };
    let mut files = 0;
    for kind in kinds.split(' ') {
        for order in ["little", "big"] {
            for axes in ["C", "F"] {
                assert_eq!(read(&format!("{kind}{order}{axes}.npy"), None), [1.0, 1.0]);
                files += 1;
            }
        }
    }
    assert_eq!(files, 44);
    read("planes.npy", Some(2));
    for name in ["stored.npz", "packed.npz"] {
        assert_eq!(read(name, None), [30.0, 20.0], "{name}");
    }
}

/// Pillow opens a PNG with all settings in its text chunks. It gives some keywords, such as `bbox`, a meaning of its own.
#[test]
#[ignore = "needs Pillow: Debian's python3-pil"]
fn pillow_reads_pictures_with_all_settings() {
    let folder = Folder::new();
    let head = "ncols 6\nnrows 5\nxllcorner 500000\nyllcorner 4900000\ncellsize 30\n";
    let cells: String = (0..30).map(|i| format!("{} ", i * 7919 % 250)).collect();
    folder.write("dem.asc", (head.to_owned() + &cells).as_bytes());
    let more = "--bbox 500030,4900000,500150,4900120 --z-scale 2 --nodata 7";
    let run = folder.run_str(&format!("hillshade dem.asc {more} -o shade.png"));
    assert_eq!(run.status, Some(0), "{}", run.err);
    let program = "from PIL import Image\n\
        image = Image.open('shade.png')\n\
        image.load()\n\
        print(image.mode, *image.size, image.text['crop'])\n";
    assert_eq!(python(&folder, program), "L 4 4 500030,4900000,500150,4900120\n");
}

/// Pillow finds the sides of a DDS, and in its first image the texels of the KTX2: plain, and in blocks that another decoder
/// decodes. Behind the header are the images of all mip levels.
#[test]
#[ignore = "needs Pillow: Debian's python3-pil"]
fn pillow_reads_the_texels_of_textures() {
    const COLS: usize = 22;
    const ROWS: usize = 13;
    let folder = Folder::new();
    let height = |row: usize, col: usize| ((row * row + 3 * col) % 11) as f32 * 0.4;
    let heights: Vec<u8> =
        (0..ROWS * COLS).flat_map(|i| height(i / COLS, i % COLS).to_le_bytes()).collect();
    folder.write("field.npy", &formats::npy("<f4", false, &format!("({ROWS}, {COLS})"), &heights));
    let words = "--what bent-normal --azimuths 4 --mips --format ktx2,dds";
    // The numbers of DXGI_FORMAT_R8G8B8A8_UNORM and DXGI_FORMAT_BC7_UNORM.
    for (name, more, format) in
        [("plain", "--encoding bent-normal=unorm8-octahedral", 28), ("blocks", "--compress", 98)]
    {
        let run = folder.run_str(&format!("bake field.npy -o {name} {words} {more}"));
        assert_eq!(run.status, Some(0), "{name}: {}", run.err);
        let program = format!(
            "from PIL import Image\n\
            image = Image.open('{name}/bent_normal.dds')\n\
            open('texels', 'wb').write(image.tobytes())\n\
            print(image.format, image.mode, *image.size)\n"
        );
        assert_eq!(python(&folder, &program), format!("DDS RGBA {COLS} {ROWS}\n"), "{name}");
        let found = std::fs::read(folder.path("texels")).unwrap();
        let read =
            |end: &str| std::fs::read(folder.path(&format!("{name}/bent_normal.{end}"))).unwrap();
        let reader = ktx2::Reader::new(read("ktx2")).unwrap();
        let levels: Vec<Vec<u8>> = reader.levels().map(|level| level.data.to_vec()).collect();
        let texels = if name == "plain" {
            levels[0].clone()
        } else {
            let mut words = vec![0_u32; ROWS * COLS];
            texture2ddecoder::decode_bc7(&levels[0], COLS, ROWS, &mut words).unwrap();
            // Blue, green, red and alpha from the lowest byte on.
            let rgba = |word: &u32| {
                let [b, g, r, a] = word.to_le_bytes();
                [r, g, b, a]
            };
            words.iter().flat_map(rgba).collect()
        };
        assert!(found == texels, "{name}");
        assert!(found.chunks_exact(4).any(|texel| texel != &found[..4]), "{name}: texels differ");

        // DDS_HEADER and DDS_HEADER_DXT10 in Microsoft's documentation: bytes of the header, height, width, mip levels;
        // format, a texture of two dimensions (3), layers.
        let dds = read("dds");
        let word = |at: usize| u32::from_le_bytes(dds[at..at + 4].try_into().unwrap());
        let header = [4, 12, 16, 28, 128, 132, 140].map(word);
        assert_eq!(header, [124, ROWS as u32, COLS as u32, 5, format, 3, 1], "{name}");
        assert_eq!((&dds[..4], &dds[84..88]), (&b"DDS "[..], &b"DX10"[..]), "{name}");
        assert!(dds[148..] == levels.concat(), "{name}");
    }
}
