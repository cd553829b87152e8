//! Visibility of a grid point above its horizons, from a table of wedges between two azimuths.

use crate::basis::rotate_z;
use crate::basis::wedge::look_up;
use ridgelight::basis::wedge::WedgeTable;
use ridgelight::plan::Azimuth;

/// The series of visibility above these slopes along even azimuths, in any order, from a table of wedges.
pub fn sh_wedges(table: &WedgeTable, lowest: &[(Azimuth, f64)]) -> Vec<f64> {
    let ray = |(a, s): &(Azimuth, f64)| [f64::from(a.sin_phi).atan2(a.cos_phi.into()), s.atan()];
    wedges_around(table, lowest.iter().map(ray).collect())
}

/// The same of even azimuths and elevations, radians.
pub fn wedges_around(table: &WedgeTable, mut circle: Vec<[f64; 2]>) -> Vec<f64> {
    circle.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut sum = vec![0.0; table.texels[0].len()];
    for (k, [phi, first]) in circle.iter().enumerate() {
        let [_, last] = circle[(k + 1) % circle.len()];
        let turned = rotate_z(&look_up(table, [*first, last]), *phi);
        sum.iter_mut().zip(turned).for_each(|(s, t)| *s += t);
    }
    sum
}
