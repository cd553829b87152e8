//! `--tint`: albedo of heights or slopes, for pictures.
//!
//! Colours are in Oklch (B. Ottosson, A perceptual color space for image processing, 2020). Lightness runs evenly from one
//! end to the other, so equal steps look equal, and the order survives every kind of colour blindness.

use clap::ValueEnum;
use ridgelight::scene::{Albedo, HeightField, Specular};

use super::sky;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tint {
    /// No tint: --albedo
    None,
    /// Height, violet to yellow
    Elevation,
    /// Slope, light where level and dark from 60 degrees on
    Slope,
    /// Height, muted: blue-green lowland to sand and nearly white summits
    Land,
}

impl Tint {
    /// Its word on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// Chroma and hue (degrees) where lightness has covered a share of its range.
struct Palette {
    lightness: [f64; 2],
    stops: &'static [[f64; 3]],
}

const LAND: Palette = Palette {
    lightness: [0.36, 0.93],
    stops: &[
        [0.0, 0.035, 200.0],
        [0.35, 0.049, 130.0],
        [0.7, 0.05, 85.0],
        [0.8, 0.05, 82.0],
        [1.0, 0.02, 75.0],
    ],
};
const ELEVATION: Palette = Palette {
    lightness: [0.36, 0.93],
    stops: &[[0.0, 0.11, 300.0], [0.5, 0.09, 210.0], [1.0, 0.11, 100.0]],
};
const SLOPE: Palette = Palette {
    lightness: [0.93, 0.36],
    stops: &[[0.0, 0.02, 90.0], [0.5, 0.08, 60.0], [1.0, 0.06, 25.0]],
};
/// Slope of the palette's end, degrees.
const STEEPEST_DEG: f64 = 60.0;
/// Shares of grid points below the lowest and above the highest colour: single peaks and pits do not decide.
const TAILS: f64 = 0.02;

/// The albedo of a tint, so dark that its brightest channel and the scale of specular are at most 1 together: everywhere, or by
/// the scale of each texel. None for [`Tint::None`].
pub fn albedo(field: &HeightField, tint: Tint, specular: Option<&Specular>) -> Option<Albedo> {
    let mut colours = colours(field, tint)?;
    let brightest = colours.as_flattened().iter().copied().fold(0.0, f32::max);
    let scale = |i: usize| match specular {
        None => 0.0,
        Some(Specular::Constant(one)) => one.scale,
        Some(Specular::Map(map)) => map[i].scale,
    };
    for (i, colour) in colours.iter_mut().enumerate() {
        let left = (1.0 - scale(i)).max(0.0);
        if left < brightest {
            *colour = colour.map(|channel| channel * (left / brightest));
        }
    }
    Some(Albedo::Map(colours))
}

fn colours(field: &HeightField, tint: Tint) -> Option<Vec<[f32; 3]>> {
    match tint {
        Tint::None => None,
        Tint::Elevation => Some(of_heights(field, &ELEVATION)),
        Tint::Land => Some(of_heights(field, &LAND)),
        Tint::Slope => {
            let slopes = (0..field.rows() * field.cols()).map(|i| slope_deg(field, i));
            Some(slopes.map(|slope| SLOPE.at(slope / STEEPEST_DEG)).collect())
        }
    }
}

fn of_heights(field: &HeightField, palette: &Palette) -> Vec<[f32; 3]> {
    let [lowest, highest] = range(field);
    // Level ground is neither low nor high.
    let middle = (lowest + highest) / 2.0;
    let share = |h: &f32| 0.5 + (f64::from(*h) - middle) / (highest - lowest).max(1e-9);
    field.heights_m().iter().map(|h| palette.at(share(h))).collect()
}

/// The luminance that a share of a tinted field does not exceed, over that of the tint's lightest colour. It is 1 where
/// heights reach the upper tail; [`Tint::None`] has 1 too.
pub fn peak(field: &HeightField, tint: Tint, share: f64) -> f64 {
    let Some(colours) = colours(field, tint) else { return 1.0 };
    let lightest = match tint {
        Tint::Elevation => ELEVATION.at(1.0),
        Tint::Slope => SLOPE.at(0.0),
        Tint::Land | Tint::None => LAND.at(1.0),
    };
    let luminance = |colour: [f32; 3]| sky::luminance(colour.map(f64::from));
    let is_void = |i: usize| field.voids().is_some_and(|v| v[i]);
    let known = colours.into_iter().enumerate().filter(|(i, _)| !is_void(*i));
    let mut all: Vec<f64> = known.map(|(_, colour)| luminance(colour)).collect();
    at_share(&mut all, share).map_or(1.0, |bright| bright / luminance(lightest))
}

/// The quantile `share` of the values; `None` if there are none.
pub fn at_share(all: &mut [f64], share: f64) -> Option<f64> {
    let at = (share * all.len().checked_sub(1)? as f64).round() as usize;
    Some(*all.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// The heights where the tails begin; voids do not count.
fn range(field: &HeightField) -> [f64; 2] {
    let is_void = |i: usize| field.voids().is_some_and(|v| v[i]);
    let heights = field.heights_m().iter().enumerate().filter(|(i, _)| !is_void(*i));
    let mut all: Vec<f64> = heights.map(|(_, h)| f64::from(*h)).collect();
    [TAILS, 1.0 - TAILS].map(|share| at_share(&mut all, share).unwrap_or(0.0))
}

/// Slope at a grid point by central differences, one-sided at the edge.
pub fn slope_deg(field: &HeightField, i: usize) -> f64 {
    let (rows, cols) = (field.rows(), field.cols());
    let (row, col) = (i / cols, i % cols);
    let at = |row: usize, col: usize| f64::from(field.heights_m()[row * cols + col]);
    let across = |before: usize, after: usize, cell_m: f64, rise: f64| match after - before {
        0 => 0.0,
        cells => rise / (cells as f64 * cell_m),
    };
    let [west, east] = [col.saturating_sub(1), (col + 1).min(cols - 1)];
    let [north, south] = [row.saturating_sub(1), (row + 1).min(rows - 1)];
    let [cell_x, cell_y] = field.cell_m();
    let x = across(west, east, cell_x, at(row, east) - at(row, west));
    let y = across(north, south, cell_y, at(south, col) - at(north, col));
    x.hypot(y).atan().to_degrees()
}

impl Palette {
    /// Linear RGB at a share, clamped to 0..1.
    fn at(&self, share: f64) -> [f32; 3] {
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let end = self.stops.iter().position(|stop| stop[0] >= share).unwrap_or(1).max(1);
        let [from, to] = [self.stops[end - 1], self.stops[end]];
        let part = (share - from[0]) / (to[0] - from[0]);
        let between = |k: usize| from[k] + part * (to[k] - from[k]);
        let lightness = self.lightness[0] + share * (self.lightness[1] - self.lightness[0]);
        let (chroma, hue) = (between(1), between(2).to_radians());
        linear_rgb(lightness, chroma * hue.cos(), chroma * hue.sin())
    }
}

/// Oklab to linear sRGB, clipped to its gamut.
fn linear_rgb(lightness: f64, a: f64, b: f64) -> [f32; 3] {
    let [l, m, s] = [
        lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b,
        lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b,
        lightness - 0.089_484_177_5 * a - 1.291_485_548 * b,
    ]
    .map(|v: f64| v.powi(3));
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
    .map(|v| v.clamp(0.0, 1.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness of linear RGB, 0 to 1.
    fn lightness(rgb: [f32; 3]) -> f64 {
        let y = crate::setup::sky::luminance(rgb.map(f64::from));
        1.16 * y.cbrt() - 0.16
    }

    /// Specular takes its share first; a tint that fits beside it keeps its colours.
    #[test]
    fn a_tint_leaves_room_for_specular() {
        use ridgelight::scene::PhongSpecular;
        let heights: Vec<f64> = (0..64).map(f64::from).collect();
        let field = HeightField::new(8, 8, &heights, [1.0; 2], None).unwrap();
        let of = |scale: Option<f32>| {
            let specular =
                scale.map(|scale| Specular::Constant(PhongSpecular { exponent: 5.0, scale }));
            match albedo(&field, Tint::Land, specular.as_ref()) {
                Some(Albedo::Map(map)) => map.as_flattened().to_vec(),
                _ => panic!("a map"),
            }
        };
        let brightest = |all: &[f32]| all.iter().copied().fold(0.0, f32::max);
        let plain = of(None);
        let most = brightest(&plain);
        assert_eq!(of(Some(0.99 - most)), plain);
        let dim = of(Some(0.5));
        assert!((brightest(&dim) - 0.5).abs() <= f32::EPSILON);
        for (a, b) in dim.iter().zip(&plain) {
            assert!((a * most - b * 0.5).abs() <= 2.0 * f32::EPSILON, "{a} {b}");
        }
        assert_eq!(brightest(&of(Some(1.0))), 0.0);
        // Of a map, only the texels with specular.
        let phong =
            |i: usize| PhongSpecular { exponent: 5.0, scale: if i == 3 { 0.5 } else { 0.0 } };
        let map = Specular::Map((0..64).map(phong).collect());
        let Some(Albedo::Map(mixed)) = albedo(&field, Tint::Land, Some(&map)) else {
            panic!("a map")
        };
        let from = |all: &[f32], i: usize| [all[3 * i], all[3 * i + 1], all[3 * i + 2]];
        for (i, colour) in mixed.iter().enumerate() {
            assert_eq!(*colour, from(if i == 3 { &dim } else { &plain }, i), "texel {i}");
        }
    }

    /// Eleven colours: each step of CIE lightness is within a third of the mean step, in one direction.
    #[test]
    fn palettes_are_even() {
        for palette in [&LAND, &ELEVATION, &SLOPE] {
            let all: Vec<f64> =
                (0..=10).map(|i| lightness(palette.at(f64::from(i) / 10.0))).collect();
            let mean = (all[10] - all[0]) / 10.0;
            for pair in all.windows(2) {
                let step = (pair[1] - pair[0]) / mean;
                assert!((0.66..1.34).contains(&step), "{all:?}");
            }
        }
    }

    /// The same colours as people without one kind of cone see them (Machado, Oliveira & Fernandes 2009, table 1, severity 1; of
    /// linear RGB): lightness runs in one direction, each step above a just noticeable difference of CIELAB (2.3 of 100; Mahy et al. 1994).
    #[test]
    fn palettes_keep_their_order_without_a_kind_of_cone() {
        const WITHOUT: [[[f64; 3]; 3]; 3] = [
            [
                [0.152286, 1.052583, -0.204868],
                [0.114503, 0.786281, 0.099216],
                [-0.003882, -0.048116, 1.051998],
            ],
            [
                [0.367322, 0.860646, -0.227968],
                [0.280085, 0.672501, 0.047413],
                [-0.011820, 0.042940, 0.968881],
            ],
            [
                [1.255528, -0.076749, -0.178779],
                [-0.078411, 0.930809, 0.147602],
                [0.004733, 0.691367, 0.303900],
            ],
        ];
        for (palette, cones) in
            [&LAND, &ELEVATION, &SLOPE].into_iter().flat_map(|p| WITHOUT.map(|w| (p, w)))
        {
            let without = |share: f64| {
                let rgb = palette.at(share).map(f64::from);
                let row = |row: [f64; 3]| row.iter().zip(rgb).map(|(a, b)| a * b).sum::<f64>();
                lightness(cones.map(|of| row(of).clamp(0.0, 1.0) as f32))
            };
            let all: Vec<f64> = (0..=10).map(|i| without(f64::from(i) / 10.0)).collect();
            let direction = (all[10] - all[0]).signum();
            assert!(all.windows(2).all(|pair| direction * (pair[1] - pair[0]) > 0.023), "{all:?}");
        }
    }

    #[test]
    fn white_and_black_are_white_and_black() {
        for (lightness, want) in [(1.0, 1.0), (0.0, 0.0)] {
            let found = linear_rgb(lightness, 0.0, 0.0);
            assert!(found.iter().all(|v| (v - want).abs() < 1e-5), "{found:?}");
        }
    }

    /// A plane that rises 1 m a metre to the east: 45 degrees everywhere, edges too.
    #[test]
    fn slopes_are_those_of_a_plane() {
        let heights = (0..12).map(|i| f64::from(i % 4) * 2.0).collect::<Vec<_>>();
        let field = HeightField::new(3, 4, &heights, [2.0, 5.0], None).unwrap();
        for i in 0..12 {
            assert!((slope_deg(&field, i) - 45.0).abs() < 1e-6);
        }
        let Some(Albedo::Map(map)) = albedo(&field, Tint::Slope, None) else { panic!("a map") };
        assert_eq!(map, vec![SLOPE.at(0.75); 12]);
    }

    /// A ramp reaches the lightest colour. Level ground has the middle of heights, and the lightest colour of slopes.
    #[test]
    fn level_ground_is_half_as_light_as_summits() {
        let ramp: Vec<f64> = (0..100).map(f64::from).collect();
        let ramp = HeightField::new(10, 10, &ramp, [1.0; 2], None).unwrap();
        let level = HeightField::new(10, 10, &[7.0; 100], [1.0; 2], None).unwrap();
        for (tint, palette) in [(Tint::Land, &LAND), (Tint::Elevation, &ELEVATION)] {
            assert_eq!(peak(&ramp, tint, 0.99), 1.0);
            let Some(Albedo::Map(map)) = albedo(&level, tint, None) else { panic!("a map") };
            assert_eq!(map, vec![palette.at(0.5); 100]);
            let luminance = |share| sky::luminance(palette.at(share).map(f64::from));
            assert_eq!(peak(&level, tint, 0.99), luminance(0.5) / luminance(1.0));
        }
        assert_eq!(peak(&level, Tint::Slope, 0.99), 1.0);
        assert_eq!(peak(&level, Tint::None, 0.99), 1.0);
    }

    #[test]
    fn level_fields_and_voids_have_colours() {
        let field = HeightField::new(2, 2, &[7.0; 4], [1.0; 2], None).unwrap();
        for tint in [Tint::Land, Tint::Elevation, Tint::Slope] {
            let Some(Albedo::Map(map)) = albedo(&field, tint, None) else { panic!("a map") };
            assert!(map.as_flattened().iter().all(|v| (0.0..=1.0).contains(v)));
        }
        assert!(albedo(&field, Tint::None, None).is_none());
    }
}
