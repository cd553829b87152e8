//! Azimuths as files have them: compass degrees, clockwise from north.

/// Decimals of an azimuth in a name. There are at most 1024 azimuths, and 360°/1024 is 0.3515625°.
const DECIMALS: usize = 7;

/// The layers of a file, one for each azimuth, in compass order.
pub struct Compass {
    /// Compass azimuths in the order of layers, degrees, 0 to below 360.
    pub degrees: Vec<f64>,
    /// The layer of each azimuth of the library.
    pub layer_of: Vec<usize>,
}

/// Compass degrees of a library azimuth, which is in radians counter-clockwise from east.
fn compass_deg(azimuth_rad: f64) -> f64 {
    // Rounded first: 90° less the degrees of π/2 must not be -1e-14, which is almost 360.
    let degrees = ((90.0 - azimuth_rad.to_degrees()) * 1e9).round() / 1e9;
    let turned = degrees.rem_euclid(360.0);
    if turned < 360.0 { turned } else { 0.0 }
}

impl Compass {
    pub fn of(azimuths_rad: &[f64]) -> Self {
        let all: Vec<f64> = azimuths_rad.iter().map(|azimuth| compass_deg(*azimuth)).collect();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| all[*a].total_cmp(&all[*b]));
        let mut layer_of = vec![0; all.len()];
        for (layer, k) in order.iter().enumerate() {
            layer_of[*k] = layer;
        }
        Self { degrees: order.iter().map(|k| all[*k]).collect(), layer_of }
    }

    /// Names of the layers: "azimuth_000.0", "azimuth_005.625". Each has as many decimals as its azimuth, at least 1 and at
    /// most [`DECIMALS`], or more where two names would be equal.
    pub fn names(&self) -> Vec<String> {
        let named = |decimals: usize| -> Vec<String> {
            let name = |degrees: &f64| {
                let all = format!("{degrees:0w$.decimals$}", w = 4 + decimals);
                let short = all.trim_end_matches('0');
                let zero = if short.ends_with('.') { "0" } else { "" };
                format!("azimuth_{short}{zero}")
            };
            self.degrees.iter().map(name).collect()
        };
        let is_distinct = |names: &Vec<String>| names.windows(2).all(|pair| pair[0] != pair[1]);
        (DECIMALS..9).map(named).find(is_distinct).unwrap_or_else(|| named(9))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn circle(count: u32) -> Vec<f64> {
        (0..count).map(|k| TAU * f64::from(k) / f64::from(count)).collect()
    }

    #[test]
    fn layers_turn_clockwise_from_north() {
        let compass = Compass::of(&circle(8));
        assert_eq!(compass.degrees, [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]);
        // East, north-east, north, north-west, west, south-west, south, south-east.
        assert_eq!(compass.layer_of, [2, 1, 0, 7, 6, 5, 4, 3]);
        assert_eq!(compass.names()[1], "azimuth_045.0");
        // Five azimuths from east miss the north.
        assert_eq!(Compass::of(&circle(5)).degrees, [18.0, 90.0, 162.0, 234.0, 306.0]);
    }

    /// A name states its azimuth exactly where 7 decimals do, else to 7 decimals.
    #[test]
    fn names_have_the_decimals_of_their_azimuths() {
        for (count, starts) in [
            (8, ["000.0", "045.0", "090.0"]),
            (16, ["000.0", "022.5", "045.0"]),
            (64, ["000.0", "005.625", "011.25"]),
            (100, ["000.0", "003.6", "007.2"]),
            (1024, ["000.0", "000.3515625", "000.703125"]),
            // 360/28 is 12.857 142 857...
            (28, ["000.0", "012.8571429", "025.7142857"]),
        ] {
            let names = Compass::of(&circle(count)).names();
            assert_eq!(names[..3], starts.map(|degrees| format!("azimuth_{degrees}")), "{count}");
        }
    }

    #[test]
    fn names_are_distinct_and_sorted() {
        // The last two azimuths differ by 5.7e-9 degrees.
        for azimuths in
            [circle(1024), circle(5000), vec![0.0, 1e-4, 1.0], vec![0.0, 1.0, 1.0 + 1e-10]]
        {
            let compass = Compass::of(&azimuths);
            let names = compass.names();
            assert!(names.windows(2).all(|pair| pair[0] < pair[1]), "{names:?}");
            // Names are read as degrees.
            for (name, degrees) in names.iter().zip(&compass.degrees) {
                let found: f64 = name.strip_prefix("azimuth_").unwrap().parse().unwrap();
                assert!((found - degrees).abs() <= 0.500_001e-7, "{name} for {degrees}");
            }
        }
    }
}
