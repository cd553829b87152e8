//! Indirect light at every grid point from pyramids of heights and of exit radiance: along each azimuth one lookup
//! per level. Each knot and midpoint of the B-spline over their elevations that rises above all before contributes
//! its radiance over the newly visible elevations (Nowrouzezahrai & Snyder 2009, eq. 6-17).

use crate::Rgb;
use crate::basis::nlp;
use crate::basis::occlusion;
use crate::light::{Receiver as Place, Slice, normal};
use crate::oracle::grid_direction;
use crate::pyramid_march::{LevelHeights, Stored};
use crate::shade_expand::shade_at;
use crate::shared::bounced::{Along, Cast, NEARLY_RAD, radiance};
use crate::shared::sweep::Heights;
use glam::DVec3;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::plan::sweep::warm_up;
use ridgelight::scene::{HeightField, Receiver};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Heights, levels and settings.
#[derive(Clone, Copy, Debug)]
pub struct BounceGather<'a> {
    /// The field, for its normals.
    pub field: &'a HeightField,
    /// Its heights.
    pub heights: Heights<'a>,
    /// Levels of heights; those of radiance have the same layout.
    pub pyramid: &'a Pyramid,
    /// Their storage.
    pub stored: Stored<'a>,
    /// Levels of exit radiance.
    pub shade: &'a Pyramid,
    /// Their texels.
    pub shade_texels: &'a [Rgb],
    /// Exit radiance of the grid points.
    pub exit: &'a [Rgb],
    /// Whether the cosine is exact, or three bands of it with four Legendre coefficients a slice.
    pub receiver: Receiver,
    /// Azimuths, at the middles of equal parts of the circle.
    pub azimuths: u32,
}

/// A march from a grid point: whole steps along columns or rows, interpolated along the other axis.
pub(crate) struct March {
    here: [f64; 2],
    pub(crate) by_x: bool,
    forward: f64,
    shear: f64,
    step_m: f64,
    reach: i32,
}

impl March {
    /// Column and row after that many steps.
    fn place(&self, steps: i32) -> [f64; 2] {
        let (along, across) = (self.forward * f64::from(steps), f64::from(steps) * self.shear);
        let [x, y] = if self.by_x { [along, across] } else { [across, along] };
        [self.here[0] + x, self.here[1] + y]
    }
}

/// Progress along a slice.
struct Gathered {
    slice: Slice,
    /// Contribution of Legendre coefficients to the bands of a [`Receiver::Cosine`].
    bands: Option<[f64; 4]>,
    top: f64,
    casts: Vec<Cast>,
}

impl Gathered {
    /// Weight of the elevations up to one, without the common factor.
    fn weight_of(bands: &[f64; 4], angle: f64) -> f64 {
        occlusion(4, angle.sin(), angle.cos()).iter().zip(bands).map(|(o, b)| o * b).sum()
    }

    fn cast(&mut self, angle: f64, distance: f64, radiance: impl Fn() -> Rgb) {
        if angle <= self.top - NEARLY_RAD {
            return;
        }
        let (low_rad, high_rad) = (self.top, angle.max(self.top));
        let (sin, cos) = high_rad.sin_cos();
        let (weight, facing) = match &self.bands {
            None => (self.slice.light(low_rad, high_rad), self.slice.at(high_rad) * cos),
            Some(bands) => {
                let polynomials = nlp(4, sin);
                let facing: f64 = bands.iter().zip(polynomials).map(|(b, p)| b * p).sum();
                let [low, high] = [low_rad, high_rad].map(|a| Self::weight_of(bands, a));
                (high - low, facing.abs() * cos)
            }
        };
        let radiance = radiance();
        let gathered =
            Cast { low_rad, high_rad, weight, facing, radiance, distance, ..Cast::default() };
        self.casts.push(gathered);
        self.top = high_rad;
    }
}

impl BounceGather<'_> {
    /// Light of one more bounce at a grid point, for albedo 1.
    pub fn light(&self, row: usize, col: usize) -> Rgb {
        radiance(&self.casts_along([row, col]))
    }

    /// Its parts, azimuth by azimuth; distances are the steps to the nearest lookup that contributes to an elevation.
    pub fn casts_along(&self, place: [usize; 2]) -> Vec<Along> {
        self.casts_of(place, |march, _, of| self.radiance(march, of))
    }

    /// The same from another radiance: a function of place, level, march and direction.
    pub(crate) fn casts_of(
        &self,
        [row, col]: [usize; 2],
        radiance: impl Fn(&March, DVec3, ([f64; 2], u32)) -> Rgb,
    ) -> Vec<Along> {
        let border = self.heights.border;
        let place = Place::diffuse(normal(self.field, border, row, col));
        let along = |k: u32| {
            let azimuth_rad = TAU * (f64::from(k) + 0.5) / f64::from(self.azimuths);
            let slice = place.slice(azimuth_rad);
            let (bands, whole) = match self.receiver {
                Receiver::Plane => (None, slice.light(-FRAC_PI_2, FRAC_PI_2)),
                Receiver::Cosine => (Some(three_bands(&slice)), 0.5),
            };
            let mut gathered = Gathered { slice, bands, top: slice.low, casts: Vec::new() };
            let march = self.march([col, row], azimuth_rad);
            self.cast(&mut gathered, &march, |angle, of| {
                let ((sin, cos), (s, c)) = (angle.sin_cos(), azimuth_rad.sin_cos());
                radiance(&march, DVec3::new(cos * c, cos * s, sin), of)
            });
            Along { azimuth_rad, low_rad: slice.low, whole, casts: gathered.casts }
        };
        (0..self.azimuths).map(along).collect()
    }

    fn march(&self, [col, row]: [usize; 2], azimuth: f64) -> March {
        let cells = grid_direction(self.field, azimuth);
        let by_x = cells[0].abs() >= cells[1].abs();
        let [along, across] = if by_x { cells } else { [cells[1], cells[0]] };
        let shear = across / along.abs();
        let of_axis = |x: bool| match x {
            true => (col as f64, self.pyramid.size[0]),
            false => (row as f64, self.pyramid.size[1]),
        };
        let room =
            |(at, n): (f64, u32), onward: bool| if onward { f64::from(n) - 1.0 - at } else { at };
        let ahead = room(of_axis(by_x), along > 0.0);
        let beside = room(of_axis(!by_x), shear > 0.0) / shear.abs().max(1e-9) + 1e-3;
        let reach = match self.pyramid.periodic {
            true => ahead + f64::from(warm_up(of_axis(by_x).1)),
            // Along the grid, along the field's edge too.
            false if shear == 0.0 => ahead,
            false => ahead.min(beside.floor()),
        };
        March {
            here: [col as f64, row as f64],
            by_x,
            forward: along.signum(),
            shear,
            step_m: 1.0 / along.abs(),
            reach: reach as i32,
        }
    }

    fn cast(
        &self,
        gathered: &mut Gathered,
        march: &March,
        radiance: impl Fn(f64, ([f64; 2], u32)) -> Rgb,
    ) {
        if march.reach <= 0 {
            return;
        }
        let (fine, levels) = (self.pyramid.fine_samples(), self.pyramid.levels());
        let (mut back, mut angle) = (1.0_f32, 0.0);
        // Elevations, and the distance of each.
        let mut angles: Option<[(f64, i32); 4]> = None;
        // Radiance lookup of a knot: place and level.
        let mut before = ([0.0; 2], 0);
        let (mut visited, mut at) = (0, 0);
        let mut take_in = |newest: (f64, i32), of: ([f64; 2], u32), gathered: &mut Gathered| {
            let four = angles.map_or([newest; 4], |[_, a, b, c]| [a, b, c, newest]);
            let [x, y, z, w] = four.map(|(angle, _)| angle);
            let knot_of = if angles.is_none() { of } else { before };
            let (middle, knot) = ((x + w + 23.0 * (y + z)) / 48.0, (y + 4.0 * z + w) / 6.0);
            // Both have the same radiance: the higher opens the elevations of both.
            let nearest = f64::from(four[0].1);
            let angle = middle.max(knot);
            gathered.cast(angle, nearest, || radiance(angle, knot_of));
            (angles, before) = (Some(four), of);
        };
        for next in 0_u32.. {
            let whole = (back + 0.5) as i32;
            if whole > visited {
                at = whole.min(march.reach);
                let level = (next + 1).saturating_sub(fine).min(levels);
                let height = |place| self.levels().height(level, march.by_x, place);
                let rise = height(march.place(at)) - height(march.here);
                angle = (rise / (f64::from(at) * march.step_m)).atan();
                visited = whole;
            }
            let (to, from) = (self.shade.level_step, self.pyramid.level_step);
            let shade =
                ((next * to + from / 2) / from + 1).saturating_sub(self.shade.fine_samples());
            let of = (march.place(at), shade.min(self.shade.levels()));
            take_in((angle, at), of, gathered);
            back *= self.pyramid.growth();
            // Lookups that round to one distance are combined.
            if whole >= march.reach && (back + 0.5) as i32 > whole {
                take_in((angle, at), of, gathered);
                take_in((angle, at), of, gathered);
                break;
            }
        }
    }

    pub(crate) fn levels(&self) -> LevelHeights<'_> {
        LevelHeights { field: self.field, pyramid: self.pyramid, stored: self.stored }
    }

    pub(crate) fn radiance(&self, march: &March, (place, level): ([f64; 2], u32)) -> Rgb {
        if let (Stored::Levels(_), 1..) = (self.stored, level) {
            return shade_at(self.shade, self.shade_texels, level, place);
        }
        let (two, t) = self.levels().beside(march.by_x, place);
        let cols = self.pyramid.size[0] as usize;
        let [low, high] = two.map(|i| match level {
            0 => self.exit[i],
            _ => {
                let at = [(i % cols) as f64, (i / cols) as f64];
                shade_at(self.shade, self.shade_texels, level, at)
            }
        });
        [0, 1, 2].map(|c| low[c] + t * (high[c] - low[c]))
    }
}

/// Contribution of each of four Legendre coefficients of a slice to three bands of the clamped cosine, 1/4 + c/2 +
/// 5/32 (3c² - 1) with c = N·e, by Simpson's rule in elevation: its fourth order leaves 1e-8.
fn three_bands(slice: &Slice) -> [f64; 4] {
    const STEPS: u32 = 200;
    let width = PI / f64::from(STEPS);
    let mut weights = [0.0; 4];
    for i in 0..=STEPS {
        let elevation = -FRAC_PI_2 + width * f64::from(i);
        let (z, s) = elevation.sin_cos();
        let c = slice.a * s + slice.b * z;
        let bands = 0.25 + 0.5 * c + 5.0 / 32.0 * (3.0 * c * c - 1.0);
        let polynomials = nlp(4, z);
        let share = match i {
            0 | STEPS => 1.0,
            _ if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..4).for_each(|l| weights[l] += bands * polynomials[l] * s * share * width / 3.0);
    }
    weights
}
