//! Visibility of every grid point above its horizons, as a series of spherical harmonics.

use crate::basis::azimuth::{assemble, assemble_nlp};
use crate::basis::occlusion;
use crate::shared::gather::Swept;
use ridgelight::basis::azimuth::around;
use ridgelight::basis::slice::Slices;
use ridgelight::plan::Azimuth;
use ridgelight::scene::{Receiver, Wedges};
use std::f64::consts::SQRT_2;

/// Settings of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Series {
    /// n² coefficients.
    pub order: usize,
    /// From slices along azimuths.
    pub wedges: Wedges,
    /// Whether the grid point's own plane hides directions below it: for [`Receiver::Plane`].
    pub receiver: Receiver,
}

/// The series of visibility above these slopes along azimuths, each independently.
///
/// # Panics
/// By a table: [`sh_wedges`](crate::sh_wedges::sh_wedges).
pub fn visibility_above(series: Series, lowest: &[(Azimuth, f64)]) -> Vec<f64> {
    let ray = |(azimuth, lowest): &(Azimuth, f64)| {
        let phi = f64::from(azimuth.sin_phi).atan2(azimuth.cos_phi.into());
        [phi, azimuth.wedge_rad.into(), *lowest]
    };
    visibility_along(series, &lowest.iter().map(ray).collect::<Vec<_>>())
}

/// The same for azimuths, their widths in radians, and slopes.
///
/// # Panics
/// By a table.
pub fn visibility_along(series: Series, rays: &[[f64; 3]]) -> Vec<f64> {
    let Series { order, wedges, .. } = series;
    let slices = Slices::new(order);
    let (mut weights, mut along) = (Vec::new(), Vec::new());
    for [phi, width, lowest] in rays {
        weights.push(around(order, *phi).iter().map(|w| w * width).collect::<Vec<_>>());
        along.push(match wedges {
            Wedges::Slices => slices.above(lowest.atan()),
            Wedges::Table => panic!("a table is looked up by two azimuths at once"),
            Wedges::Nlp => {
                let (sin, cos) = lowest.atan().sin_cos();
                let mut above: Vec<f64> =
                    occlusion(order, sin, cos).iter().map(|below| -below).collect();
                above[0] += SQRT_2;
                above
            }
        });
    }
    match wedges {
        Wedges::Slices => assemble(order, &weights, &along),
        Wedges::Nlp | Wedges::Table => assemble_nlp(order, &weights, &along),
    }
}

/// `visibility` of all azimuths: the series of every grid point, row-major.
pub fn sh_visibility(swept: &Swept, series: Series) -> Vec<Vec<f64>> {
    swept.per_grid_point(|col, row| {
        let mut lowest = Vec::new();
        swept.add_all([col, row], series.receiver == Receiver::Plane, |_, azimuth, slope, _| {
            lowest.push((*azimuth, slope));
        });
        visibility_above(series, &lowest)
    })
}
