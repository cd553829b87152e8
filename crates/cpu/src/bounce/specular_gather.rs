//! Indirect light at every grid point: for diffuse ground as [`bounce_gather`](crate::bounce_gather) with an exact
//! cosine, and as a series of spherical harmonics for the Phong specular.

use crate::Rgb;
use crate::bounce_gather::{BounceGather, March};
use crate::shared::bounced::{Along, radiance};
use crate::shared::levels::held_between;
use glam::DVec3;
use ridgelight::basis::azimuth::around;
use ridgelight::basis::bands;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::slice::{Slices, slice_index};
use std::f64::consts::TAU;

/// Coefficients of a series, R, G, B.
pub type Series = Vec<Rgb>;

/// Heights, levels and series.
#[derive(Clone, Copy, Debug)]
pub struct SpecularGather<'a> {
    /// Grid points and levels; radiance where there are no series.
    pub gather: BounceGather<'a>,
    /// Order of incident light.
    pub order: usize,
    /// Series of exit radiance of the grid points, and of the texels of all levels.
    pub vectors: Option<[&'a [Series]; 2]>,
}

/// Incident light at a grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Arriving {
    /// Light of one more bounce of a diffuse grid point, for albedo 1.
    pub diffuse: Rgb,
    /// n² coefficients.
    pub series: Series,
}

/// Incident light of `order` from the parts of all azimuths, which are equally wide.
pub fn arriving(order: usize, all: &[Along]) -> Arriving {
    let slices = Slices::new(order);
    let width = TAU / all.len() as f64;
    let mut series = vec![[0.0; 3]; order * order];
    for along in all {
        let turns = around(order, along.azimuth_rad);
        for cast in &along.casts {
            let between = slices.between(cast.low_rad, cast.high_rad);
            for ((l, m), coefficient) in bands(order).zip(&mut series) {
                let turn = turns[(order - 1).wrapping_add_signed(m)];
                let share = width * turn * between[slice_index(l, m.unsigned_abs())];
                *coefficient = [0, 1, 2].map(|c| coefficient[c] + share * cast.radiance[c]);
            }
        }
    }
    Arriving { diffuse: radiance(all), series }
}

impl SpecularGather<'_> {
    /// Incident light at a grid point.
    pub fn arriving(&self, place: [usize; 2]) -> Arriving {
        arriving(self.order, &self.casts_along(place))
    }

    /// Its parts, azimuth by azimuth, as [`BounceGather::casts_along`].
    pub fn casts_along(&self, place: [usize; 2]) -> Vec<Along> {
        self.gather.casts_of(place, |march, e, of| self.radiance(march, -e, of))
    }

    /// Exit radiance of a point in a direction, clamped at 0.
    fn radiance(&self, march: &March, towards: DVec3, of: ([f64; 2], u32)) -> Rgb {
        let Some([exit, levels]) = self.vectors else { return self.gather.radiance(march, of) };
        let values = evaluate(self.order, towards);
        let of_texel = |series: &Series| {
            let terms = series.iter().zip(&values);
            terms.fold([0.0; 3], |sum, (s, y)| [0, 1, 2].map(|c| sum[c] + s[c] * y))
        };
        let mut sum = [0.0; 3];
        for (texel, weight) in self.taps(march, of) {
            let series = if of.1 == 0 { &exit[texel] } else { &levels[texel] };
            let light = of_texel(series);
            sum = [0, 1, 2].map(|c| sum[c] + weight * light[c]);
        }
        sum.map(|v| v.max(0.0))
    }

    /// Texels of a level around a position, with their bilinear weights.
    fn taps(&self, march: &March, (place, number): ([f64; 2], u32)) -> Vec<(usize, f64)> {
        if number == 0 {
            let ([low, high], t) = self.gather.levels().beside(march.by_x, place);
            return vec![(low, 1.0 - t), (high, t)];
        }
        let shade = self.gather.shade;
        let level = shade.level(number);
        let [cols, rows] = level.size;
        let at = [0, 1].map(|i| place[i] as f32 * level.per_grid_point[i]);
        let (x, t) = held_between(at[0], cols, shade.periodic);
        let (y, u) = held_between(at[1], rows, shade.periodic);
        let texel = |i: usize, j: usize| level.first as usize + y[j] * cols as usize + x[i];
        let tap = |(i, j)| (texel(i, j), [1.0 - t, t][i] * [1.0 - u, u][j]);
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(tap).to_vec()
    }
}
