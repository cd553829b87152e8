//! Arrays that NumPy writes and reads.

use std::process::Command;

use ridgelight_io::{HeightOptions, read_field};

use super::gdal_inputs::absolute;
use super::geotiff::gdal_values;
use crate::Folder;

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
