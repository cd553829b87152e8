//! Files by the validators of others, which `tools/test --part validators` installs into the folder that `VALIDATORS` names.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::process::{Command, Output};

use ridgelight_io::{HeightOptions, read_field};

use super::gdal_inputs::{absolute, tool};
use super::geotiff::{folder, gdal_values};
use crate::needs_vulkan::done;
use crate::{Folder, formats};

/// The folder of the validators.
fn validators() -> PathBuf {
    std::env::var_os("VALIDATORS")
        .map(PathBuf::from)
        .expect("VALIDATORS: run tools/test --part validators")
}

/// Runs a program in the folder; returns what it prints, or its error.
fn output(folder: &Folder, command: &mut Command) -> Result<String, String> {
    let Output { status, stdout, stderr } =
        command.current_dir(folder.path("")).output().expect("installed");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if status.success() { Ok(text(&stdout)) } else { Err(text(&stdout) + &text(&stderr)) }
}

fn rio_cogeo(folder: &Folder, file: &str) -> Result<String, String> {
    let program = "import sys\n\
        from rio_cogeo.cogeo import cog_validate\n\
        is_valid, errors, warnings = cog_validate(sys.argv[1], strict=True)\n\
        sys.exit(None if is_valid and not errors + warnings else str(errors + warnings))\n";
    let mut command = Command::new("/usr/bin/python3");
    command.env("PYTHONPATH", validators().join("pypi")).args(["-c", program, file]);
    output(folder, &mut command)
}

/// rio-cogeo finds no error and no warning, with one tile or several, and refuses the same values in strips.
#[test]
#[ignore = "needs rio-cogeo and GDAL: tools/test --part validators"]
fn rio_cogeo_accepts_maps() {
    let folder = folder();
    done(&folder, "hillshade utm.tif -o small.tif");
    done(&folder, "horizon utm.tif --azimuths 4 --distances far.tif -o horizon.tif");
    done(&folder, "bake utm.tif --what sky-view,bent-normal --azimuths 4 --format tif -o maps");
    tool(&folder, "gdal_translate -q -outsize 1031 521 utm.tif large_input.tif");
    done(&folder, "hillshade large_input.tif -o large.tif");
    for file in ["small", "horizon", "far", "maps/sky_view", "maps/bent_normal", "large"] {
        rio_cogeo(&folder, &format!("{file}.tif")).expect(file);
    }
    tool(&folder, "gdal_translate -q large.tif strips.tif");
    let error = rio_cogeo(&folder, "strips.tif").unwrap_err();
    assert!(error.contains("not tiled"), "{error}");
}

/// We read the values that the OpenEXR library reads: f16, f32 and u32, six compressions. Its reading is the reference because PXR24
/// rounds f32 to 24 bits. The library also reads the values of our `.exr` files.
#[test]
#[ignore = "needs OpenEXR of PyPI: tools/test --part validators"]
fn openexr_has_the_same_values() {
    let folder = Folder::new();
    let python = |program: &str| {
        let mut command = Command::new("/usr/bin/python3");
        command.env("PYTHONPATH", validators().join("openexr")).args(["-c", program]);
        output(&folder, &mut command).unwrap()
    };
    let names = python(
        "import OpenEXR, numpy\n\
        heights = 100.3 + numpy.sin(numpy.arange(70 * 45)).reshape(70, 45) * 40\n\
        for kind in ['NO', 'RLE', 'ZIPS', 'ZIP', 'PIZ', 'PXR24']:\n\
        \x20   for number in ['float16', 'float32', 'uint32']:\n\
        \x20       name = f'{kind}_{number}'\n\
        \x20       header = dict(compression=getattr(OpenEXR, kind + '_COMPRESSION'), type=OpenEXR.scanlineimage)\n\
        \x20       with OpenEXR.File(header, {'Z': heights.astype(number)}) as file:\n\
        \x20           file.write(name + '.exr')\n\
        \x20       with OpenEXR.File(name + '.exr') as file:\n\
        \x20           file.channels()['Z'].pixels.astype('<f4').tofile(name + '.raw')\n\
        \x20       print(name)\n",
    );
    let raw = |name: &str| -> Vec<f32> {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
    };
    for name in names.lines() {
        let file = folder.path(&format!("{name}.exr"));
        let field = read_field(&file, &HeightOptions::default()).unwrap().field;
        let expected = raw(&format!("{name}.raw"));
        assert_eq!(([field.rows(), field.cols()], expected.len()), ([70, 45], 70 * 45), "{name}");
        assert!(absolute(&field) == expected, "{name}");
    }
    assert_eq!(names.lines().count(), 18);

    done(&folder, "svf ZIP_float32.exr --cell 2 --azimuths 4 -o view.exr");
    done(&folder, "svf ZIP_float32.exr --cell 2 --azimuths 4 -o view.tif");
    python(
        "import OpenEXR\n\
        with OpenEXR.File('view.exr') as file:\n\
        \x20   (channel,) = file.channels().values()\n\
        \x20   channel.pixels.astype('<f4').tofile('view.raw')\n",
    );
    let found = raw("view.raw");
    assert!(found == gdal_values(&folder.path("view.tif")) && found.len() == 70 * 45);
}

/// QGIS shows maps, and a picture with the files beside it, at the position of the input and with its reference system. Maps have
/// named bands, and NaN for no data.
#[test]
#[ignore = "needs QGIS for Python: Debian's python3-qgis"]
fn qgis_shows_maps_where_the_input_is() {
    let folder = folder();
    done(&folder, "hillshade utm.tif -o hillshade.tif");
    done(&folder, "horizon utm.tif --azimuths 4 -o horizon.tif");
    done(&folder, "render utm.tif --azimuths 4 -o picture.png");
    let program = "import sys\n\
        from qgis.core import QgsApplication, QgsRasterLayer\n\
        app = QgsApplication([], False)\n\
        app.initQgis()\n\
        for name in sys.argv[1:]:\n\
        \x20   layer = QgsRasterLayer(name, name)\n\
        \x20   source = layer.dataProvider()\n\
        \x20   bands = [layer.bandName(band + 1).split(': ')[-1] for band in range(layer.bandCount())]\n\
        \x20   void = source.sourceNoDataValue(1) if source.sourceHasNoDataValue(1) else None\n\
        \x20   print(name, layer.isValid(), layer.crs().authid() or '-', layer.extent().toString(6), void, *bands, sep='|')\n";
    let mut command = Command::new("/usr/bin/python3");
    command.env("QT_QPA_PLATFORM", "offscreen").args(["-c", program]);
    command.args(["utm.tif", "hillshade.tif", "horizon.tif", "picture.png"]);
    let found = output(&folder, &mut command).unwrap();
    let rows: Vec<Vec<&str>> = found.lines().map(|line| line.split('|').collect()).collect();
    let [input, maps @ .., picture] = rows.as_slice() else { panic!("{found}") };
    assert_eq!(input[1..3], ["True", "EPSG:32633"]);
    for map in maps {
        assert_eq!((&map[1..4], map[4]), (&input[1..4], "nan"), "{found}");
    }
    assert_eq!(maps[0][5..], ["hillshade"]);
    let azimuths = ["azimuth_000.0", "azimuth_090.0", "azimuth_180.0", "azimuth_270.0"];
    assert_eq!(maps[1][5..], azimuths);
    assert_eq!(picture[1..4], input[1..4], "{found}");
}

/// ktx-parse reads the format, size and mip levels of each texture. Each level has the length that its blocks need. A truncated file
/// is refused.
#[test]
#[ignore = "needs ktx-parse: tools/test --part validators"]
fn ktx_parse_reads_textures() {
    let folder = Folder::new();
    let heights: Vec<u8> =
        (0..64 * 48_u32).flat_map(|i| ((i * 7919 % 97) as f32).to_le_bytes()).collect();
    folder.write("field.npy", &formats::npy("<f4", false, "(48, 64)", &heights));
    let maps = "bake field.npy --what sky-view,bent-normal --azimuths 4 --format ktx2";
    for flags in ["-o plain", "-o blocks --mips --compress --quiet"] {
        let run = folder.run_str(&format!("{maps} {flags}"));
        assert_eq!(run.status, Some(0), "{flags}: {}", run.err);
    }
    let program = format!(
        "import {{ readFileSync }} from 'node:fs';\n\
        import {{ read }} from '{}';\n\
        const found = read(new Uint8Array(readFileSync(process.argv[2])));\n\
        const sizes = found.levels.map(level => level.levelData.byteLength);\n\
        console.log(found.vkFormat, found.pixelWidth, found.pixelHeight, sizes.join(' '));\n",
        validators().join("node_modules/ktx-parse/dist/index.mjs").display()
    );
    folder.write("read.mjs", program.as_bytes());
    let read = |file: &str| output(&folder, Command::new("node").args(["read.mjs", file]));
    // Numbers of VkFormat: R16_UNORM, R16G16B16A16_UNORM, BC4_UNORM, BC7_UNORM. Texels along a block's side, and its bytes.
    for (file, format, block, bytes, levels) in [
        ("plain/sky_view", 70, 1, 2, 1),
        ("plain/bent_normal", 91, 1, 8, 1),
        ("blocks/sky_view", 139, 4, 8, 7),
        ("blocks/bent_normal", 145, 4, 16, 7),
    ] {
        let blocks = |level: u32| {
            [64_u32, 48].map(|side| (side >> level).max(1).div_ceil(block)).iter().product::<u32>()
        };
        let sizes = (0..levels).map(|level| (blocks(level) * bytes).to_string());
        let wanted = format!("{format} 64 48 {}\n", sizes.collect::<Vec<_>>().join(" "));
        assert_eq!(read(&format!("{file}.ktx2")), Ok(wanted), "{file}");
    }
    let whole = std::fs::read(folder.path("blocks/sky_view.ktx2")).unwrap();
    folder.write("cut.ktx2", &whole[..whole.len() - 100]);
    let error = read("cut.ktx2").unwrap_err();
    assert!(error.contains("RangeError"), "{error}");
}

/// GDAL finds in a GeoTIFF above 4 GiB, in windows of all bands, the values that the same command writes to an .npy: horizons of
/// noise, which deflate to little less. Needs 10 GB of disk.
#[test]
#[ignore = "writes 10 GB, and needs GDAL: tools/test --part validators"]
fn above_4_gib_all_bands_are_found() {
    const SIDE: usize = 6000;
    const AZIMUTHS: usize = 32;
    const WINDOW: usize = 40;
    let folder = Folder::new();
    let mut state = 1_u64;
    let mut noise = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 * 6e-6
    };
    let heights: Vec<u8> = (0..SIDE * SIDE).flat_map(|_| noise().to_le_bytes()).collect();
    let shape = format!("({SIDE}, {SIDE})");
    folder.write("field.npy", &formats::npy("<f4", false, &shape, &heights));
    drop(heights);
    let words = format!("field.npy --cell 1 --azimuths {AZIMUTHS} --lines 4 --fuse aimed-nearest");
    done(&folder, &format!("horizon {words} -o large.tif --quiet"));
    done(&folder, &format!("horizon {words} -o large.npy --quiet"));
    let mut plain = File::open(folder.path("large.npy")).unwrap();
    let values = (AZIMUTHS * SIDE * SIDE * 4) as u64;
    let header = plain.metadata().unwrap().len() - values;
    assert!(std::fs::metadata(folder.path("large.tif")).unwrap().len() > 1 << 32);
    for band in 0..AZIMUTHS {
        // Other tiles in each band, the last of all among them.
        let place = [SIDE - WINDOW - 97 * band, (SIDE - WINDOW) * (band + 1) / AZIMUTHS];
        let [row, col] = place;
        let window = [col, row, WINDOW, WINDOW].map(|n| n.to_string());
        let mut command = Command::new("gdal_translate");
        command.args(["-q", "-of", "ENVI", "-b", &(band + 1).to_string(), "-srcwin"]).args(window);
        output(&folder, command.args(["large.tif", "window.envi"])).unwrap();
        let found = std::fs::read(folder.path("window.envi")).unwrap();
        let mut expected = vec![0; 4 * WINDOW * WINDOW];
        for (i, line) in expected.chunks_exact_mut(4 * WINDOW).enumerate() {
            let first = (band * SIDE + row + i) * SIDE + col;
            plain.seek(SeekFrom::Start(header + 4 * first as u64)).unwrap();
            plain.read_exact(line).unwrap();
        }
        assert!(found == expected, "band {band}, {place:?}");
        assert!(found.chunks_exact(4).any(|value| value != &found[..4]), "band {band}: one value");
    }
}
