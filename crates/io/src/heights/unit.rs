//! Units of length by the names that files give them.

/// Metres in a foot, and in a US survey foot.
pub(super) const FOOT_M: f64 = 0.3048;
pub(super) const US_SURVEY_FOOT_M: f64 = 1200.0 / 3937.0;

/// Metres in a unit of length, `None` for other names.
pub(super) fn metres(name: &str) -> Option<f64> {
    match name.trim().to_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "ft" | "foot" | "feet" | "foot (international)" | "international foot" => Some(FOOT_M),
        "us survey foot" | "us survey feet" | "us-ft" | "ftus" | "foot_us" => {
            Some(US_SURVEY_FOOT_M)
        }
        _ => None,
    }
}

/// What is wrong with the unit that a band has by its name, beside that of its vertical system.
pub(super) fn warning(name: &str, of_band: Option<f64>, of_system: Option<f64>) -> Option<String> {
    match (of_band, of_system) {
        (Some(band_m), Some(system_m)) if (band_m / system_m - 1.0).abs() > 1e-9 => Some(format!(
            "the band's unit is {name}, but that of the vertical system is {system_m} m: heights are read in {name}"
        )),
        (Some(_), _) => None,
        (None, Some(system_m)) => Some(format!(
            "the band's unit {name:?} is not known: heights are read in units of {system_m} m, that of the vertical system"
        )),
        (None, None) => Some(format!(
            "the band's unit {name:?} is not known: heights are read as metres; `z_scale` converts others"
        )),
    }
}

/// The warning of heights without a unit over cells in another unit than metres.
pub(super) fn of_cells(cell_m: f64) -> String {
    let is_unit = |unit_m: f64| (cell_m / unit_m - 1.0).abs() < 1e-9;
    let cells = if is_unit(FOOT_M) {
        "feet".to_owned()
    } else if is_unit(US_SURVEY_FOOT_M) {
        "US survey feet".to_owned()
    } else {
        format!("units of {cell_m} m")
    };
    format!(
        "heights are read as metres, but the cells are in {cells}: if the heights are too, use `z_scale {cell_m}`; if they are metres, `z_scale 1`"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_gdal_proj_and_esri() {
        for (name, unit_m) in [
            ("metre", Some(1.0)),
            (" Meter", Some(1.0)),
            ("ft", Some(0.3048)),
            ("foot (International)", Some(0.3048)),
            ("US survey foot", Some(1200.0 / 3937.0)),
            ("us-ft", Some(1200.0 / 3937.0)),
            ("ftUS", Some(1200.0 / 3937.0)),
            ("degrees", None),
            ("", None),
        ] {
            assert_eq!(metres(name), unit_m, "{name}");
        }
    }
}
