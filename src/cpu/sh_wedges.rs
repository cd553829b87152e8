//! What a sample sees through its horizons, two azimuths at once, from a table of wedges.

use crate::basis::harmonics::rotate_z;
use crate::basis::wedge::WedgeTable;
use crate::plan::Azimuth;

/// The series of what is free above these slopes along even azimuths, in any order, from a table of wedges.
pub fn sh_wedges(table: &WedgeTable, lowest: &[(Azimuth, f64)]) -> Vec<f64> {
    let phi = |a: &Azimuth| f64::from(a.sin_phi).atan2(a.cos_phi.into());
    let mut circle: Vec<(f64, f64)> = lowest.iter().map(|(a, s)| (phi(a), s.atan())).collect();
    circle.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sum = vec![0.0; table.texels[0].len()];
    for (k, (phi, first)) in circle.iter().enumerate() {
        let (_, last) = circle[(k + 1) % circle.len()];
        let turned = rotate_z(&table.look_up([*first, last]), *phi);
        sum.iter_mut().zip(turned).for_each(|(s, t)| *s += t);
    }
    sum
}
