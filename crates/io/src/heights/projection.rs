//! Projected coordinate reference systems of the EPSG registry: their unit, and where true north is.

use crate::georeference::{GeoKeys, Georeference, PROJECTED_CRS};
use proj4rs::{Proj, transform::transform};

/// A smaller angle gets no note: a fifth of the sun's diameter.
const NOTED_DEG: f64 = 0.1;
/// Half the length of the line to grid north whose direction is measured. Its curvature cancels to second order.
const HALF_LINE_M: f64 = 500.0;

/// The system of a code, without a shift to another datum, and longitudes and latitudes on its ellipsoid.
fn systems(code: u16) -> Option<[Proj; 2]> {
    let text = crs_definitions::from_code(code)?.proj4;
    // Other directions of axes are not those of a raster.
    if text.contains("+proj=longlat") || text.contains("+axis") {
        return None;
    }
    let with = |first: &str, is_kept: &dyn Fn(&str) -> bool| {
        let terms = text.split_whitespace().filter(|term| is_kept(term));
        let terms: Vec<&str> = std::iter::once(first).chain(terms).collect();
        Proj::from_proj_string(&terms.join(" ")).ok()
    };
    let name = |term: &str| term.split('=').next().unwrap_or_default().to_owned();
    let is_shift = |term: &str| ["+towgs84", "+nadgrids"].contains(&name(term).as_str());
    let is_figure =
        |term: &str| ["+datum", "+ellps", "+a", "+b", "+rf", "+pm"].contains(&name(term).as_str());
    let projected = with("", &|term| !is_shift(term))?;
    Some([projected, with("+proj=longlat", &is_figure)?])
}

/// Metres in the horizontal unit of a projected system.
pub(super) fn unit_m(code: u16) -> Option<f64> {
    let [projected, _] = systems(code)?;
    Some(projected.to_meter()).filter(|unit| unit.is_finite() && *unit > 0.0)
}

/// A position on the WGS84 ellipsoid, metres from its centre: through longitude 0 and 90 degrees on the equator, and the pole.
fn position_m([longitude, latitude]: [f64; 2]) -> [f64; 3] {
    const EQUATOR_M: f64 = 6_378_137.0;
    const SQUARED_ECCENTRICITY: f64 = 0.006_694_379_990_141_3;
    let (sin_long, cos_long) = longitude.to_radians().sin_cos();
    let (sin_lat, cos_lat) = latitude.to_radians().sin_cos();
    let radius = EQUATOR_M / (1.0 - SQUARED_ECCENTRICITY * sin_lat * sin_lat).sqrt();
    [
        radius * cos_lat * cos_long,
        radius * cos_lat * sin_long,
        radius * (1.0 - SQUARED_ECCENTRICITY) * sin_lat,
    ]
}

/// Two lines of 2 [`HALF_LINE_M`] through a position in the units of the system, one along x and one along y: east and north
/// components of each, in metres on the ground.
fn lines_m(code: u16, [x, y]: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let [projected, geographic] = systems(code)?;
    let half = HALF_LINE_M / projected.to_meter();
    let at = |x: f64, y: f64| {
        let mut point = (x, y, 0.0);
        transform(&projected, &geographic, &mut point).ok()?;
        Some([point.0.to_degrees(), point.1.to_degrees()])
    };
    // The chord, on the plane that touches the ellipsoid in the middle: near a pole, longitudes tell no distance.
    let [longitude, latitude] = at(x, y)?.map(f64::to_radians);
    let (sin_long, cos_long) = longitude.sin_cos();
    let (sin_lat, cos_lat) = latitude.sin_cos();
    let line = |dx: f64, dy: f64| {
        let [from, to] = [position_m(at(x - dx, y - dy)?), position_m(at(x + dx, y + dy)?)];
        let [i, j, k] = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let right = cos_long * j - sin_long * i;
        let up = cos_lat * k - sin_lat * (cos_long * i + sin_long * j);
        (right.is_finite() && up.is_finite()).then_some([right, up])
    };
    Some([line(half, 0.0)?, line(0.0, half)?])
}

/// The angle from true north to grid north, clockwise, at a position in the units of the system.
fn convergence_deg(code: u16, at: [f64; 2]) -> Option<f64> {
    let [_, [right, up]] = lines_m(code, at)?;
    Some(right.atan2(up).to_degrees())
}

/// A cell whose size on the ground differs by less gets no warning.
const SCALE_NOTED: f64 = 0.02;

/// Where a metre of the projection is no metre on the ground, in the middle of a field whose cells have this size in metres of the
/// projection.
pub(super) fn scale_warning(
    at: &Georeference,
    [rows, cols]: [usize; 2],
    cell_m: [f64; 2],
) -> Option<String> {
    let [west, south, east, north] = at.extent(rows, cols);
    let code = projected_code(&at.keys)?;
    let lines = lines_m(code, [(west + east) / 2.0, (south + north) / 2.0])?;
    let [across, along] = lines.map(|[x, y]| x.hypot(y) / (2.0 * HALF_LINE_M));
    let differs = [across, along].iter().any(|scale| (scale - 1.0).abs() > SCALE_NOTED);
    differs.then(|| {
        // Five digits.
        let text = |length: f64| {
            let decimals = (4.0 - length.log10().floor()).clamp(0.0, 12.0) as usize;
            format!("{length:.decimals$}")
        };
        let [read, are] = [cell_m, [cell_m[0] * across, cell_m[1] * along]].map(|cell| cell.map(text));
        format!(
            "metres of EPSG:{code} are not metres on the ground: cells are read as {} x {} m, and are {} x {} m at the \
             centre; `cell_m` {},{} sets that size",
            read[0], read[1], are[0], are[1], are[0], are[1]
        )
    })
}

/// A warning about a projected system whose convergence and scale are unknown. With `has_cell` the cells are the user's.
pub(super) fn unknown_warning(at: &Georeference, has_cell: bool) -> Option<String> {
    let states_projection = at.keys.entries.iter().any(|e| e[0] == PROJECTED_CRS);
    let code = projected_code(&at.keys);
    if !states_projection || at.keys.is_web_mercator() || code.and_then(systems).is_some() {
        return None;
    }
    let what = code.map_or_else(
        || "the projection has no EPSG code".to_owned(),
        |code| format!("EPSG:{code} is not supported"),
    );
    let lengths = if has_cell { "" } else { ", and lengths as lengths on the ground" };
    Some(format!(
        "{what}: grid north is read as true north{lengths}; for a field on the Earth, `gdalwarp -t_srs EPSG:CODE in.tif out.tif` with \
         the code of a UTM zone corrects that"
    ))
}

/// Where grid north is not true north, in the middle of a field.
pub(super) fn north_note(at: &Georeference, rows: usize, cols: usize) -> Option<String> {
    let [west, south, east, north] = at.extent(rows, cols);
    let code = projected_code(&at.keys)?;
    let angle = convergence_deg(code, [(west + east) / 2.0, (south + north) / 2.0])?;
    let (side, sign) = if angle > 0.0 { ("east", '+') } else { ("west", '-') };
    let size = angle.abs();
    (size >= NOTED_DEG).then(|| {
        format!(
            "azimuths are from grid north, {size:.2} degrees {side} of true north at the centre: \
             true azimuth = azimuth here {sign} {size:.2} degrees"
        )
    })
}

fn projected_code(keys: &GeoKeys) -> Option<u16> {
    keys.epsg().filter(|code| keys.entries.iter().any(|e| e[0] == PROJECTED_CRS && e[3] == *code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_from_codes() {
        // New York Long Island, US survey feet and metres; North Dakota North, international feet.
        let survey = 1200.0 / 3937.0;
        for (code, unit) in
            [(2263, survey), (32118, 1.0), (2265, 0.3048), (32618, 1.0), (2154, 1.0)]
        {
            assert!((unit_m(code).unwrap() / unit - 1.0).abs() < 1e-12, "{code}");
        }
        assert_eq!([unit_m(4326), unit_m(1)], [None, None]);
    }

    /// A system without a code, and one whose axes are not read, have a warning, which leaves out lengths where the cells are the
    /// user's; known systems, Web Mercator and files without a projection have none.
    #[test]
    fn unknown_systems_get_a_warning() {
        let of = |entries: Vec<[u16; 4]>, ascii: &str, has_cell| {
            let keys = GeoKeys { entries, doubles: Vec::new(), ascii: ascii.to_owned() };
            unknown_warning(&Georeference { corner: [0.0; 2], cell: [30.0; 2], keys }, has_cell)
        };
        let coded = |code| vec![[1024, 0, 1, 1], [3072, 0, 1, code]];
        let own = of(coded(32767), "mine|", false).unwrap();
        assert!(own.starts_with("the projection has no EPSG code: grid north"), "{own}");
        assert!(own.contains("lengths as lengths on the ground"), "{own}");
        assert!(!of(coded(32767), "mine|", true).unwrap().contains("lengths"));
        let turned = of(coded(2048), "", false).unwrap();
        assert!(turned.starts_with("EPSG:2048 is not supported: grid north"), "{turned}");
        for code in [32618, 5070, 3857] {
            assert_eq!(of(coded(code), "", false), None, "{code}");
        }
        assert_eq!(of(vec![[1024, 0, 1, 1]], "", false), None);
    }

    /// Polar stereographic: about the pole the scale is that of the standard parallel, (1 + sin 71°) / 2 and (1 + sin 70°) / 2 on a
    /// sphere, within the flattening of 1/298; EPSG:3996 has 75°.
    #[test]
    fn scales_at_the_pole_are_those_of_the_standard_parallel() {
        for (code, parallel, warns) in
            [(3031, 71.0_f64, true), (3413, 70.0, true), (3996, 75.0, false)]
        {
            let expected = 2.0 / (1.0 + parallel.to_radians().sin());
            let lines = lines_m(code, [0.0, 0.0]).unwrap();
            for [right, up] in lines {
                let found = right.hypot(up) / (2.0 * HALF_LINE_M);
                assert!(
                    (found / expected - 1.0).abs() < 1.0 / 298.0,
                    "{code}: {found} for {expected}"
                );
            }
            let keys = GeoKeys { entries: vec![[3072, 0, 1, code]], ..GeoKeys::default() };
            let at = Georeference { corner: [-100.0, 100.0], cell: [100.0; 2], keys };
            assert_eq!(scale_warning(&at, [2, 2], [100.0; 2]).is_some(), warns, "{code}");
        }
    }

    /// Of two points that lie true north of each other, the azimuth from the columns of the grid becomes 0 by the note.
    #[test]
    fn the_note_turns_azimuths_into_true_ones() {
        // East and west of the central meridian of a zone, in both hemispheres.
        for (code, longitude, latitude) in
            [(32618, -72.5_f64, 44.2_f64), (32618, -77.5, 44.2), (32718, -72.5, -44.2)]
        {
            let [projected, geographic] = systems(code).unwrap();
            let at = |latitude: f64| {
                let mut point = (longitude.to_radians(), latitude.to_radians(), 0.0);
                transform(&geographic, &projected, &mut point).unwrap();
                [point.0, point.1]
            };
            let [south, north] = [at(latitude - 0.001), at(latitude + 0.001)];
            let here = (north[0] - south[0]).atan2(north[1] - south[1]).to_degrees();
            let keys = GeoKeys { entries: vec![[3072, 0, 1, code]], ..GeoKeys::default() };
            let corner = [south[0] - 10.0, (south[1] + north[1]) / 2.0 + 10.0];
            let place = Georeference { corner, cell: [10.0, 10.0], keys };
            let note = north_note(&place, 2, 2).unwrap();
            let (_, change) = note.split_once("true azimuth = azimuth here ").unwrap();
            let change = change.strip_suffix(" degrees").unwrap().replace(' ', "");
            let change: f64 = change.parse().unwrap();
            assert!(change.abs() > 1.0, "{note}");
            // The note has two digits.
            assert!((here + change).abs() < 0.0051, "{code}: {here} and {note}");
        }
    }

    /// Lambert's conic: n times the longitude from the central meridian (Snyder 1987, eq. 15-4).
    #[test]
    fn a_lambert_conic_turns_by_n_times_the_longitude() {
        // Lambert-93: n of the parallels 44 and 49 degrees on GRS 80 is 0.7256077650 (IGN, NTG_71); PROJ puts this
        // position at 5.56464179202727 degrees east, and the central meridian is 3 degrees east.
        let expected = 0.725_607_765 * (5.564_641_792_027_27 - 3.0);
        let found = convergence_deg(2154, [900_000.0, 6_500_000.0]).unwrap();
        // The line of 1 km deviates to third order: (500 m / 6371 km)² of the angle, 6e-9.
        assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
        assert!(convergence_deg(2154, [700_000.0, 6_500_000.0]).unwrap().abs() < 1e-9);
    }

    /// The transverse Mercator of a sphere has tan γ = tan Δλ sin φ: the ellipsoid's differs by less
    /// than e² times Δλ² of it.
    #[test]
    fn utm_turns_as_the_closed_form() {
        // PROJ puts the position at these degrees.
        let (longitude, latitude) = (-72.495_936_223_768_f64, 44.225_784_263_498_1_f64);
        let away = (longitude + 75.0).to_radians();
        let expected = (away.tan() * latitude.to_radians().sin()).atan().to_degrees();
        let found = convergence_deg(32618, [700_000.0, 4_900_000.0]).unwrap();
        let bound = 0.0067 * away * away * expected;
        assert!((found - expected).abs() < bound + 1e-5, "{found} for {expected}");
        // South of the equator the sign changes.
        let found = convergence_deg(32718, [700_000.0, 5_100_000.0]).unwrap();
        assert!((found + expected).abs() < bound + 1e-5, "{found}");
    }
}
