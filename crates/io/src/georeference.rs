//! Where a grid lies on the Earth: its coordinate reference system and the position of its pixels.

/// The vertical keys of GeoTIFF (OGC 19-008r4, §7.5): CRS, citation, datum and unit.
const VERTICAL_KEYS: std::ops::RangeInclusive<u16> = 4096..=4099;
pub(crate) const MODEL_TYPE: u16 = 1024;
pub(crate) const RASTER_TYPE: u16 = 1025;
const GEODETIC_CRS: u16 = 2048;
pub(crate) const PROJECTED_CRS: u16 = 3072;
/// The keys of a geographic and of a projected reference system, and the citations among them.
const HORIZONTAL_KEYS: [std::ops::RangeInclusive<u16>; 2] = [2048..=3071, 3072..=4095];
const CITATIONS: [u16; 2] = [2049, 3073];

pub(crate) const LINEAR_UNIT: u16 = 3076;
/// The tag of keys that are floats.
pub(crate) const KEY_DOUBLES: u16 = 34736;
/// The EPSG code of the metre.
const METRE: f64 = 9001.0;

/// Pseudo-Mercator on a sphere of the Earth's equatorial radius.
const WEB_MERCATOR: [u16; 2] = [3857, 3785];

/// Whether a name, or the WKT of a system, is that of Web Mercator.
pub(crate) fn is_named_web_mercator(text: &str) -> bool {
    let names = [
        "Pseudo-Mercator",
        "Pseudo_Mercator",
        "Web_Mercator",
        "Web Mercator",
        "Mercator_Auxiliary_Sphere",
    ];
    names.iter().any(|name| text.contains(name))
}

/// The position of a north-up grid, in the coordinates of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Georeference {
    /// East and north of the outer corner of the first pixel (row 0, column 0).
    pub corner: [f64; 2],
    /// Width and height of a pixel, both positive; rows run south.
    pub cell: [f64; 2],
    /// The coordinate reference system; empty where the file names none.
    pub keys: GeoKeys,
}

/// The GeoKeys of a GeoTIFF, as they were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeoKeys {
    /// Entries of the directory (tag 34735) without its header: key, location, count, value.
    pub entries: Vec<[u16; 4]>,
    /// Parameters that are floats (tag 34736).
    pub doubles: Vec<f64>,
    /// Parameters that are text (tag 34737).
    pub ascii: String,
}

impl GeoKeys {
    /// Longitude and latitude on WGS 84 (EPSG:4326), each value at the centre of its pixel.
    pub fn wgs84_points() -> Self {
        let entries =
            vec![[MODEL_TYPE, 0, 1, 2], [RASTER_TYPE, 0, 1, 2], [GEODETIC_CRS, 0, 1, 4326]];
        Self { entries, ..Self::default() }
    }

    /// A coordinate reference system of the EPSG registry.
    pub(crate) fn of_code(code: u16, is_geographic: bool) -> Self {
        let [model, key] = if is_geographic { [2, GEODETIC_CRS] } else { [1, PROJECTED_CRS] };
        let entries = vec![[MODEL_TYPE, 0, 1, model], [RASTER_TYPE, 0, 1, 1], [key, 0, 1, code]];
        Self { entries, ..Self::default() }
    }

    /// Whether positions in the file are those of pixel centres (PixelIsPoint).
    pub fn is_point(&self) -> bool {
        self.entries.contains(&[RASTER_TYPE, 0, 1, 2])
    }

    /// The EPSG code of the horizontal reference system, if the keys hold one.
    pub fn epsg(&self) -> Option<u16> {
        self.code(PROJECTED_CRS).or_else(|| self.code(GEODETIC_CRS))
    }

    /// The EPSG code in a key: 32767 is a system that other keys define; above are private codes.
    fn code(&self, key: u16) -> Option<u16> {
        self.short(key).filter(|code| (1..32767).contains(code))
    }

    /// The value of a key that is one short, held in the entry itself.
    pub(crate) fn short(&self, key: u16) -> Option<u16> {
        self.entries.iter().find(|e| e[0] == key && e[1] == 0).map(|e| e[3])
    }

    /// The code or the name of the horizontal reference system.
    pub fn crs(&self) -> Option<String> {
        let named = || {
            let name = self.ascii.split('|').next().unwrap_or_default().trim();
            (!name.is_empty()).then(|| name.to_owned())
        };
        self.defined_by_code().map(|code| format!("EPSG:{code}")).or_else(named)
    }

    /// [`epsg`](Self::epsg), but not of the geographic system below a projection without a code.
    fn defined_by_code(&self) -> Option<u16> {
        // Keys from PROJECTED_CRS to 4095 describe projections.
        let of_projection =
            |e: &[u16; 4]| *e == [MODEL_TYPE, 0, 1, 1] || (PROJECTED_CRS..4096).contains(&e[0]);
        let is_projected = self.entries.iter().any(of_projection);
        self.code(PROJECTED_CRS).or_else(|| self.code(GEODETIC_CRS).filter(|_| !is_projected))
    }

    /// Whether the system is Web Mercator: its codes (EPSG:3857, and 3785 before), or a system of one's own with its name or its
    /// projection's, as GDAL and ESRI write it.
    pub fn is_web_mercator(&self) -> bool {
        match self.defined_by_code() {
            Some(code) => WEB_MERCATOR.contains(&code),
            None => is_named_web_mercator(&self.ascii) && self.is_without_offsets(),
        }
    }

    /// Whether origins and false coordinates of the projection (keys 3080 to 3087) are 0, and the unit is the metre.
    fn is_without_offsets(&self) -> bool {
        self.parameters().iter().all(|(key, values)| match *key {
            3080..=3087 => values.iter().all(|value| *value == 0.0),
            LINEAR_UNIT => values[..] == [METRE],
            _ => true,
        })
    }

    /// Whether both state the same horizontal reference system, or none.
    pub fn is_same_crs(&self, other: &Self) -> bool {
        if let (Some(ours), Some(theirs)) = (self.defined_by_code(), other.defined_by_code()) {
            return ours == theirs;
        }
        self.parameters() == other.parameters()
    }

    /// Keys of the horizontal reference system with their numbers; texts are left out.
    fn parameters(&self) -> Vec<(u16, Vec<f64>)> {
        let number = |[key, location, count, value]: &[u16; 4]| {
            let is_one = HORIZONTAL_KEYS.iter().any(|keys| keys.contains(key));
            let at = usize::from(*value);
            let numbers = match *location {
                0 => vec![f64::from(*value)],
                KEY_DOUBLES => self.doubles.get(at..at + usize::from(*count))?.to_vec(),
                _ => return None,
            };
            (is_one && !CITATIONS.contains(key)).then_some((*key, numbers))
        };
        self.entries.iter().filter_map(number).collect()
    }

    /// Without the vertical reference: a map of light or angles holds no heights, and GDAL reports
    /// a vertical unit as the unit of each band.
    pub fn horizontal(&self) -> Self {
        let mut keys = self.clone();
        keys.entries.retain(|entry| !VERTICAL_KEYS.contains(&entry[0]));
        keys
    }
}

impl Georeference {
    /// The georeference of a file whose raster position (0, 0) is at `origin`: the first pixel's
    /// centre for PixelIsPoint, else its corner.
    pub fn at_origin(origin: [f64; 2], cell: [f64; 2], keys: GeoKeys) -> Self {
        let half = if keys.is_point() { 0.5 } else { 0.0 };
        let corner = [origin[0] - half * cell[0], origin[1] + half * cell[1]];
        Self { corner, cell, keys }
    }

    /// The inverse of [`at_origin`](Self::at_origin).
    pub fn origin(&self) -> [f64; 2] {
        let half = if self.keys.is_point() { 0.5 } else { 0.0 };
        [self.corner[0] + half * self.cell[0], self.corner[1] - half * self.cell[1]]
    }

    /// West, south, east and north of a grid's outer edges.
    pub fn extent(&self, rows: usize, cols: usize) -> [f64; 4] {
        let [west, north] = self.corner;
        [west, north - rows as f64 * self.cell[1], west + cols as f64 * self.cell[0], north]
    }

    /// The text of a world file, as ESRI defined it: six lines, the last two the centre of the
    /// first pixel.
    pub fn world_file(&self) -> String {
        let [width, height] = self.cell;
        let [east, north] = [self.corner[0] + 0.5 * width, self.corner[1] - 0.5 * height];
        format!("{width}\n0\n0\n{}\n{east}\n{north}\n", -height)
    }

    /// The text of GDAL's `.aux.xml` with the horizontal coordinate reference system, if it has an EPSG code.
    pub fn pam(&self) -> Option<String> {
        let code = self.keys.defined_by_code()?;
        Some(format!("<PAMDataset>\n  <SRS>EPSG:{code}</SRS>\n</PAMDataset>\n"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_the_centre_of_its_pixel() {
        let area = Georeference::at_origin([500.0, 900.0], [10.0, 20.0], GeoKeys::default());
        assert_eq!((area.corner, area.origin()), ([500.0, 900.0], [500.0, 900.0]));
        let point = Georeference::at_origin([7.0, 46.0], [0.5, 0.25], GeoKeys::wgs84_points());
        assert_eq!((point.corner, point.origin()), ([6.75, 46.125], [7.0, 46.0]));
        // The centre of the first pixel, whichever way the file states positions.
        assert_eq!(area.world_file(), "10\n0\n0\n-20\n505\n890\n");
        assert_eq!(point.world_file(), "0.5\n0\n0\n-0.25\n7\n46\n");
    }

    /// The geographic system below a projection without a code is not that of the positions.
    #[test]
    fn only_the_systems_own_code_is_stated() {
        let of = |more: &[[u16; 4]]| {
            let keys = GeoKeys { entries: more.to_vec(), ..GeoKeys::default() };
            Georeference { corner: [0.0; 2], cell: [1.0; 2], keys }.pam()
        };
        let (projected, geographic) = ([MODEL_TYPE, 0, 1, 1], [GEODETIC_CRS, 0, 1, 4326]);
        let code = |value: u16| [PROJECTED_CRS, 0, 1, value];
        for own in [
            &[projected, geographic][..],
            &[projected, code(54009), geographic],
            &[code(32767), geographic],
            &[[3075, 0, 1, 1], geographic],
        ] {
            assert_eq!(of(own), None, "{own:?}");
        }
        let stated =
            |code: u16| Some(format!("<PAMDataset>\n  <SRS>EPSG:{code}</SRS>\n</PAMDataset>\n"));
        assert_eq!(of(&[projected, code(32633), geographic]), stated(32633));
        assert_eq!(of(&[[MODEL_TYPE, 0, 1, 2], geographic]), stated(4326));
    }

    #[test]
    fn heights_leave_with_their_unit() {
        let mut keys = GeoKeys::wgs84_points();
        keys.entries.extend([[4096, 0, 1, 5703], [4099, 0, 1, 9002]]);
        assert_eq!(keys.horizontal(), GeoKeys::wgs84_points());
    }
}
