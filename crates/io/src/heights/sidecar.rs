//! Files beside a raster that state where it lies: world files, and ESRI's `.prj`.

use super::{Cell, Raster, looks_like_degrees, projection, unit};
use crate::georeference::{GeoKeys, Georeference, is_named_web_mercator};
use std::path::{Path, PathBuf};

/// The files beside a raster: their names, and what they state where it is understood.
#[derive(Default)]
pub(super) struct Sidecar {
    world: Option<(String, Option<World>)>,
    crs: Option<(String, Option<Crs>)>,
    /// GDAL's own file: if it states a scale or an offset, and if it states a reference system.
    scale: Option<String>,
    srs: Option<String>,
}

/// A north-up grid.
struct World {
    cell: [f64; 2],
    /// East and north of the centre of the first grid point.
    first: [f64; 2],
}

/// A coordinate reference system.
struct Crs {
    name: String,
    is_geographic: bool,
    /// Its EPSG code, if the text has it or its name is one that ESRI gives.
    code: Option<u16>,
    /// Metres in its unit of length.
    unit_m: f64,
}

impl Sidecar {
    pub fn beside(path: &Path) -> Self {
        let named = |path: PathBuf| {
            let name = path.file_name()?.display().to_string();
            Some((name, read(&path)?))
        };
        let world = world_names(path).find_map(named);
        let crs = named(path.with_extension("prj"));
        let mut about = path.as_os_str().to_owned();
        about.push(".aux.xml");
        let about = named(about.into());
        let has_scale = |text: &str| text.contains("<Scale>") || text.contains("<Offset>");
        Self {
            world: world.map(|(name, text)| (name, World::of(&text))),
            crs: crs.map(|(name, text)| (name, Crs::of_wkt(&text))),
            srs: about
                .as_ref()
                .filter(|(_, text)| text.contains("<SRS"))
                .map(|about| about.0.clone()),
            scale: about.filter(|(_, text)| has_scale(text)).map(|(name, _)| name),
        }
    }

    /// Completes a raster: what its own file states comes first.
    pub fn complete(self, raster: &mut Raster) {
        let Self { world, crs, scale, srs } = self;
        let (notes, warnings) = (&mut raster.notes, &mut raster.warnings);
        if let Some(name) = scale {
            let text = format!("scale and offset in {name} are not read; `z_scale` scales heights");
            warnings.push(text);
        }
        let own = raster.georeference.take();
        let mut has_changed = false;
        let at = match (own, world) {
            (Some(at), _) => Some(at),
            (None, Some((name, Some(World { cell, first: [east, north] })))) => {
                notes.push(format!("position and cells are those of {name}"));
                has_changed = true;
                let corner = [east - cell[0] / 2.0, north + cell[1] / 2.0];
                Some(Georeference { corner, cell, keys: GeoKeys::default() })
            }
            (None, Some((name, None))) => {
                warnings.push(format!(
                    "{name} is not read: expected six numbers: no rotation, positive width, negative height"
                ));
                None
            }
            (None, None) => None,
        };
        let is_lost = |at: &Georeference| crs.is_none() && at.keys.crs().is_none();
        if let Some(name) = srs.filter(|_| at.as_ref().is_none_or(is_lost)) {
            let position = if at.is_none() { ", and neither is its position" } else { "" };
            warnings.push(format!(
                "the coordinate reference system in {name} is not read{position}: cells are in metres unless the \
                 file's own coordinates fit degrees; use `gdalwarp -t_srs` with an EPSG code to write a GeoTIFF with both"
            ));
        }
        let Some(mut at) = at else {
            warnings.extend(
                crs.map(|(name, _)| format!("{name} is not read: the field has no position")),
            );
            return;
        };
        let mut used = None;
        match crs.filter(|_| at.keys == GeoKeys::default()) {
            None => {}
            Some((name, None)) => warnings.push(format!(
                "{name} is not read: expected WKT of a projected system, or of a geographic system in degrees"
            )),
            Some((name, Some(crs))) => {
                match crs.code {
                    Some(code) => {
                        notes.push(format!("the coordinate reference system of {name} is EPSG:{code}"));
                    }
                    None => warnings.push(format!(
                        "{name} gives the cell unit but no EPSG code for {}; outputs have no coordinate reference system, and grid north is read as true north",
                        crs.name
                    )),
                }
                has_changed = true;
                at.keys = crs.code.map_or_else(GeoKeys::default, |code| {
                    GeoKeys::of_code(code, crs.is_geographic)
                });
                if !crs.is_geographic && crs.unit_m != 1.0 {
                    raster.cell_unit_m = crs.unit_m;
                    if raster.unit_m.is_none() {
                        raster.unit_warning.get_or_insert_with(|| unit::of_cells(crs.unit_m));
                    }
                }
                used = Some(crs);
            }
        }
        if has_changed {
            raster.cell = cell(&at, used.as_ref(), [raster.rows, raster.cols]);
        }
        raster.georeference = Some(at);
    }
}

/// The cells of a grid.
fn cell(at: &Georeference, crs: Option<&Crs>, [rows, cols]: [usize; 2]) -> Cell {
    let [west, south, east, north] = at.extent(rows, cols);
    let middle = (south + north) / 2.0;
    let degrees = |is_guess| Cell::Degrees { cell: at.cell, latitude: middle, is_guess };
    match crs {
        Some(Crs { is_geographic: true, .. }) => degrees(false),
        Some(Crs { code: Some(3857), .. }) => Cell::Mercator { cell: at.cell, northing_m: middle },
        Some(crs) => Cell::Metres(at.cell.map(|c| c * crs.unit_m)),
        None if looks_like_degrees([west, east], [south, north], at.cell) => degrees(true),
        None => Cell::Metres(at.cell),
    }
}

/// The longest sidecar that is read, bytes.
const LONGEST: u64 = 1 << 20;

fn read(path: &Path) -> Option<String> {
    let about = path.metadata().ok()?;
    (about.is_file() && about.len() <= LONGEST).then_some(())?;
    Some(String::from_utf8_lossy(&std::fs::read(path).ok()?).into_owned())
}

/// The usual names: `.tfw`, `.tifw` and `.wld` of a `.tif`.
fn world_names(path: &Path) -> impl Iterator<Item = PathBuf> {
    let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
    let ends: String =
        [extension.chars().next(), extension.chars().next_back()].into_iter().flatten().collect();
    let all = [format!("{ends}w"), format!("{extension}w"), "wld".to_owned()];
    all.map(|extension| path.with_extension(extension)).into_iter()
}

impl World {
    /// Six lines: width, two terms of rotation, height (negative), and the first grid point.
    fn of(text: &str) -> Option<Self> {
        let numbers = text.split_whitespace().map(|word| word.parse().ok());
        let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
        let [width, turn_x, turn_y, height, east, north] = numbers.try_into().ok()?;
        let is_upright = turn_x == 0.0 && turn_y == 0.0 && width > 0.0 && height < 0.0;
        let is_finite = [width, height, east, north].iter().all(|v: &f64| v.is_finite());
        let world = Self { cell: [width, -height], first: [east, north] };
        (is_upright && is_finite).then_some(world)
    }
}

impl Crs {
    /// The horizontal part of a WKT text: `PROJCS["WGS_1984_UTM_Zone_32N",...]`.
    fn of_wkt(text: &str) -> Option<Self> {
        let (word, rest) = text.trim_start().split_once('[')?;
        let is_geographic = match word.trim().to_ascii_uppercase().as_str() {
            "GEOGCS" | "GEOGCRS" | "GEODCRS" => true,
            "PROJCS" | "PROJCRS" => false,
            _ => return None,
        };
        let name = rest.split('"').nth(1)?.to_owned();
        let parts = parts(text)?;
        // Other meridians, origins or units are other systems.
        let is_zero = |part: &&str| {
            let value = part.rsplit(',').next().unwrap_or_default().trim_end_matches([']', ' ']);
            value.parse() == Ok(0.0) || part.to_ascii_lowercase().contains("scale_factor")
        };
        let mut parameters = parts.iter().filter(|part| part.starts_with("PARAMETER["));
        let is_plain = parameters.all(is_zero) && !text.to_ascii_lowercase().contains("foot");
        let is_mercator = !is_geographic && is_plain && is_named_web_mercator(text);
        let named = || if is_mercator { Some(3857) } else { code_named(&name) };
        let code = parts.iter().find_map(|part| code_of(part)).or_else(named);
        // The unit of a projected system comes after that of its geographic system.
        let with_unit = parts.iter().rev().find(|part| part.contains("UNIT["))?;
        let unit = with_unit.rsplit("UNIT[").next()?.split(',').nth(1)?;
        let unit = unit.trim().split(']').next()?.trim().parse::<f64>().ok();
        let unit_m = code.filter(|_| !is_geographic).and_then(projection::unit_m).or(unit)?;
        let is_unit = match is_geographic {
            true => (unit_m - 1_f64.to_radians()).abs() < 1e-6,
            false => unit_m.is_finite() && unit_m > 0.0,
        };
        is_unit.then_some(Self { name, is_geographic, code, unit_m })
    }
}

/// What is directly inside the first brackets of a WKT text: `"x"` and `UNIT["m",1]` of `PROJCS["x",UNIT["m",1]]`. What follows
/// them, as a vertical system, is left out.
fn parts(text: &str) -> Option<Vec<&str>> {
    let first = text.find('[')? + 1;
    let mut begin = first;
    let (mut depth, mut is_quoted, mut all) = (0, false, Vec::new());
    for (i, c) in text.char_indices().filter(|(i, _)| *i >= first) {
        match c {
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => {}
            '[' => depth += 1,
            ',' | ']' if depth == 0 => {
                all.push(text[begin..i].trim());
                begin = i + 1;
                if c == ']' {
                    return Some(all);
                }
            }
            ']' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// The code of a part that is an identifier: `AUTHORITY["EPSG","32632"]`, or `ID["EPSG",32632]`.
fn code_of(part: &str) -> Option<u16> {
    let is_identifier = part.starts_with("AUTHORITY[") || part.starts_with("ID[");
    let of = parts(part).filter(|_| is_identifier)?;
    let [authority, code, ..] = of[..] else { return None };
    let code = code.trim_matches('"').trim();
    code.parse().ok().filter(|_| authority == "\"EPSG\"")
}

/// ESRI's names, which its `.prj` has instead of codes.
fn code_named(name: &str) -> Option<u16> {
    if name == "GCS_WGS_1984" || name == "WGS 84" {
        return Some(4326);
    }
    let (datum, zone) = name.split_once("_UTM_Zone_")?;
    let (zone, side) = zone.split_at_checked(zone.len().checked_sub(1)?)?;
    let zone: u16 = zone.parse().ok().filter(|zone| (1..=60).contains(zone))?;
    let first = match (datum, side) {
        ("WGS_1984", "N") => 32600,
        ("WGS_1984", "S") => 32700,
        ("ETRS_1989", "N") if (28..=38).contains(&zone) => 25800,
        ("NAD_1983", "N") if zone <= 23 => 26900,
        _ => return None,
    };
    Some(first + zone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HeightOptions, read_field};

    /// What GDAL 3.6 writes beside an ESRI grid, and as WKT 1 and 2 (shortened in parts that are not read).
    const UTM: &str = r#"PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["Central_Meridian",9.0],UNIT["Meter",1.0]]"#;
    const WKT1: &str = r#"PROJCS["NAD83 / New York Long Island (ftUS)",GEOGCS["NAD83",UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4269"]],PROJECTION["Lambert_Conformal_Conic_2SP"],UNIT["US survey foot",0.304800609601219,AUTHORITY["EPSG","9003"]],AXIS["X",EAST],AUTHORITY["EPSG","2263"]]"#;
    const WKT2: &str = "GEOGCRS[\"ETRS89\",DATUM[\"ETRS\"],PRIMEM[\"Greenwich\",0],CS[ellipsoidal,2],\n ANGLEUNIT[\"degree\",0.0174532925199433],\n    ID[\"EPSG\",4258]]\n";
    const OWN: &str = r#"PROJCS["mine",GEOGCS["x",UNIT["Degree",0.0174532925199433]],PROJECTION["y"],UNIT["Foot",0.3048]]"#;

    /// ESRI's Web Mercator is EPSG:3857; about another meridian, or in feet, it is another system.
    #[test]
    fn only_plain_web_mercator_has_its_code() {
        let wkt = |meridian: &str, unit: &str| {
            format!(
                r#"PROJCS["WGS_1984_Web_Mercator_Auxiliary_Sphere",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Mercator_Auxiliary_Sphere"],PARAMETER["False_Easting",0.0],PARAMETER["Central_Meridian",{meridian}],PARAMETER["Auxiliary_Sphere_Type",0.0],UNIT[{unit}]]"#
            )
        };
        let code = |meridian, unit| Crs::of_wkt(&wkt(meridian, unit)).expect("a system").code;
        assert_eq!(code("0.0", r#""Meter",1.0"#), Some(3857));
        assert_eq!(code("180.0", r#""Meter",1.0"#), None);
        assert_eq!(code("0.0", r#""Foot_US",0.304800609601219"#), None);
    }

    #[test]
    fn systems_are_found_by_code_or_name() {
        let found = |text: &str| {
            Crs::of_wkt(text).map(|crs| (crs.code, crs.is_geographic, (crs.unit_m * 1e4).round()))
        };
        assert_eq!(found(UTM), Some((Some(32632), false, 1e4)));
        assert_eq!(found(WKT1), Some((Some(2263), false, 3048.0)));
        assert_eq!(found(WKT2), Some((Some(4258), true, 175.0)));
        assert_eq!(found(OWN), Some((None, false, 3048.0)));
        // A unit's code is not the system's, nor are code and unit of a vertical system.
        let of_unit = OWN.replace("0.3048]", "0.3048,AUTHORITY[\"EPSG\",\"9002\"]]");
        assert_eq!(found(&of_unit), Some((None, false, 3048.0)));
        let vertical = r#",VERTCS["NAVD88",UNIT["Foot_US",0.3],AUTHORITY["EPSG","6360"]]"#;
        assert_eq!(found(&format!("{OWN}{vertical}")), Some((None, false, 3048.0)));
        assert_eq!(found(&format!("{UTM}{vertical}")), Some((Some(32632), false, 1e4)));
        for text in
            ["", "[", "PROJCS", "PROJCS[\"x\"]", "LOCAL_CS[\"x\",UNIT[\"m\",1]]", "Projection UTM"]
        {
            assert_eq!(found(text), None, "{text}");
        }
        let grads = WKT2.replace("0.0174532925199433", "0.015707963267948967");
        assert_eq!(found(&grads), None);
        for (name, code) in [
            ("GCS_WGS_1984", Some(4326)),
            ("WGS_1984_UTM_Zone_60S", Some(32760)),
            ("WGS_1984_UTM_Zone_61S", None),
            ("ETRS_1989_UTM_Zone_32N", Some(25832)),
            ("NAD_1983_UTM_Zone_12N", Some(26912)),
            ("NAD_1927_UTM_Zone_12N", None),
            ("WGS_1984_UTM_Zone_é", None),
        ] {
            assert_eq!(code_named(name), code, "{name}");
        }
    }

    /// A PNG has the position, cells and system of the files beside it. Rotated and broken world files are noted.
    #[test]
    fn a_png_lies_where_the_files_beside_it_state() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dem.png");
        image::GrayImage::new(3, 2).save(&path).unwrap();
        let read = || read_field(&path, &HeightOptions::default()).unwrap();
        assert_eq!(read().georeference, None);
        std::fs::write(path.with_extension("prj"), UTM).unwrap();
        let has = |said: &str| {
            let read = read();
            read.notes.iter().chain(&read.warnings).any(|text| text.contains(said))
        };
        assert!(has("dem.prj is not read: the field has no position"));
        std::fs::write(path.with_extension("pgw"), "30\n0\n0\n-20\n500015\n5199990\n").unwrap();
        let placed = read();
        let at = placed.georeference.clone().unwrap();
        assert_eq!((at.corner, at.cell, at.keys.epsg()), ([5e5, 5.2e6], [30.0, 20.0], Some(32632)));
        assert_eq!(placed.field.cell_m(), [30.0, 20.0]);
        assert!(has("position and cells are those of dem.pgw") && has("dem.prj is EPSG:32632"));
        let part = HeightOptions {
            bbox: Some([500_030.0, 0.0, 500_060.0, 5.2e6]),
            ..HeightOptions::default()
        };
        assert_eq!(read_field(&path, &part).unwrap().field.cols(), 1);
        std::fs::write(path.with_extension("prj"), OWN).unwrap();
        assert!(has("no EPSG code for mine"));
        assert!((read().field.cell_m()[0] - 9.144).abs() < 1e-9);
        for text in ["30 1 0 -20 0 0", "30 0 0 -20 0", "30 0 0 20 0 0", "", "30 0 0 -20 x 0"] {
            std::fs::write(path.with_extension("pgw"), text).unwrap();
            assert!(has("dem.pgw is not read") && read().georeference.is_none(), "{text}");
        }
        std::fs::write(folder.path().join("dem.png.aux.xml"), "<PAM><Scale>0.1</Scale></PAM>")
            .unwrap();
        assert!(has("dem.png.aux.xml are not read"));
        // A system alone is not read, and neither is a position, unless a world file has one.
        std::fs::remove_file(path.with_extension("prj")).unwrap();
        std::fs::write(folder.path().join("dem.png.aux.xml"), "<PAM><SRS>EPSG:32632</SRS></PAM>")
            .unwrap();
        assert!(has("dem.png.aux.xml is not read, and neither is its position:"));
        std::fs::write(path.with_extension("pgw"), "30 0 0 -20 0 0").unwrap();
        assert!(has("dem.png.aux.xml is not read:"));
    }
}
