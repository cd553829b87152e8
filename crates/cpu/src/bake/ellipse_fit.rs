//! The ellipse that best covers the directions with visible sky (Heidrich et al. 2000, §4), in f64.
//!
//! Directions above horizontal are projected onto the plane z = 0 of the field: that of the flat base, not of each
//! grid point's normal. A light then has the same position in it for all grid points, and the test needs no frame.
//! The sky is cut by the base's horizon, not by the tangent plane, below which N·e is negative anyway.
//!
//! The search starts from the mean and covariance of the lit directions over the plan's area, where a direction of
//! solid angle ω covers z ω. A filled ellipse of radius r along an axis has the variance r²/4 there, so an ellipse
//! fits itself. The score counts lit minus shadowed directions inside. All count alike, as all have the same solid
//! angle.

use glam::{DVec2, DVec3};
pub use ridgelight::scene::least_radius;

use ridgelight::scene::{VisiblePoint, VisiblePoints};

/// In the plan of the hemisphere, the disc of radius 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// East, north; may lie outside the disc.
    pub centre: DVec2,
    /// Of length 1.
    pub axis: DVec2,
    /// One over the radius along the axis and across it. 0, 0: the whole disc.
    pub inverse_radii: [f64; 2],
}

impl Ellipse {
    /// Everything is lit.
    pub const WHOLE: Self = Self { centre: DVec2::ZERO, axis: DVec2::X, inverse_radii: [0.0; 2] };
    /// Nothing is lit: an ellipse beyond the disc.
    pub const EMPTY: Self =
        Self { centre: DVec2::new(4.0, 0.0), axis: DVec2::X, inverse_radii: [1.0; 2] };

    /// From texels: centre and axis; 1 / radii.
    pub fn of_texels(axes: [f32; 4], radii: [f32; 2]) -> Self {
        let [x, y, along_x, along_y] = axes.map(f64::from);
        Self {
            centre: DVec2::new(x, y),
            axis: DVec2::new(along_x, along_y),
            inverse_radii: radii.map(f64::from),
        }
    }

    /// Visibility of a direction, a unit vector whose z is above 0: equations 2 to 4.
    pub fn holds(&self, direction: DVec3) -> bool {
        self.reach(direction) <= 1.0
    }

    /// The left-hand side less 1 of equation 4, negated: at most 1 inside.
    pub fn reach(&self, direction: DVec3) -> f64 {
        let from = direction.truncate() - self.centre;
        let [along, across] = self.inverse_radii;
        (self.axis.dot(from) * along).powi(2) + (self.axis.perp().dot(from) * across).powi(2)
    }

    /// With the ends along an axis (0) or across it (1) moved: the centre by `by`, the radius by `grow` to `least` or more.
    pub fn moved(&self, across: usize, (by, grow): (f64, f64), least: f64) -> Self {
        let mut moved = *self;
        moved.centre += by * [self.axis, self.axis.perp()][across];
        moved.inverse_radii[across] = 1.0 / (1.0 / self.inverse_radii[across] + grow).max(least);
        moved
    }
}

/// A direction above horizontal, and whether its sky is visible.
pub type SkyDirection = (DVec3, bool);

/// The search's first step, its last, and the largest step count; of radii and centre, in units of the disc's radius.
pub const FIRST_STEP: f64 = 0.25;
/// See [`FIRST_STEP`].
pub const LAST_STEP: f64 = 1.0 / 64.0;
/// See [`FIRST_STEP`].
pub const MOST_STEPS: usize = 48;

/// Sky visibility of a grid point above horizontal; `directions` are those of the points, or bent on a curved base
/// surface.
pub fn sky_directions(
    points: &VisiblePoints,
    directions: &[DVec3],
    grid_point: usize,
) -> Vec<SkyDirection> {
    let all = directions.iter().enumerate().filter(|(_, e)| e.z > 0.0);
    all.map(|(i, e)| (*e, points.point(i, grid_point) == VisiblePoint::Sky)).collect()
}

/// Lit minus shadowed directions inside.
pub fn score(ellipse: &Ellipse, sky: &[SkyDirection]) -> i64 {
    let within = sky.iter().filter(|(e, _)| ellipse.holds(*e));
    within.map(|(_, is_lit)| if *is_lit { 1 } else { -1 }).sum()
}

/// Mean and covariance (xx, xy, yy) of the lit directions over the plan's area; zeros where none is.
pub fn moments(sky: &[SkyDirection]) -> (DVec2, [f64; 3]) {
    let lit = || sky.iter().filter(|s| s.1).map(|(e, _)| (e.truncate(), e.z));
    let weight = lit().map(|(_, z)| z).sum::<f64>().max(1e-30);
    let mean = lit().map(|(p, z)| p * z).sum::<DVec2>() / weight;
    let mut spread = [0.0; 3];
    for (p, z) in lit() {
        let d = p - mean;
        for (sum, square) in spread.iter_mut().zip([d.x * d.x, d.x * d.y, d.y * d.y]) {
            *sum += z * square / weight;
        }
    }
    (mean, spread)
}

/// Where the search starts.
pub fn start(sky: &[SkyDirection]) -> Ellipse {
    let least = least_radius(sky.len());
    let (centre, [xx, xy, yy]) = moments(sky);
    let (half_sum, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let root = half_difference.hypot(xy);
    let axis = if half_difference >= 0.0 {
        DVec2::new(half_difference + root, xy)
    } else {
        DVec2::new(xy, root - half_difference) * if xy < 0.0 { -1.0 } else { 1.0 }
    };
    let axis = if root > 1e-6 * half_sum { axis.normalize() } else { DVec2::X };
    let inverse = |variance: f64| 1.0 / (2.0 * variance.max(0.0).sqrt()).max(least);
    Ellipse { centre, axis, inverse_radii: [inverse(half_sum + root), inverse(half_sum - root)] }
}

/// The ellipse and its [`score`]: from a start, moved to its best neighbour while that is better, then by half the
/// step. The whole disc where that is as good, nothing where no ellipse is better than that.
pub fn fit(sky: &[SkyDirection]) -> (Ellipse, i64) {
    let lit = sky.iter().filter(|s| s.1).count() as i64;
    let whole = 2 * lit - sky.len() as i64;
    if lit == 0 || lit == sky.len() as i64 {
        return if lit == 0 { (Ellipse::EMPTY, 0) } else { (Ellipse::WHOLE, whole) };
    }
    let least = least_radius(sky.len());
    let mut found = start(sky);
    let mut best = score(&found, sky);
    let mut step = FIRST_STEP;
    for _ in 0..MOST_STEPS {
        if step < LAST_STEP {
            break;
        }
        let mut next = None;
        for other in neighbours(&found, step, least) {
            let of_other = score(&other, sky);
            if of_other > best {
                (best, next) = (of_other, Some(other));
            }
        }
        match next {
            Some(next) => found = next,
            None => step *= 0.5,
        }
    }
    match () {
        () if whole.max(best) <= 0 => (Ellipse::EMPTY, 0),
        () if whole >= best => (Ellipse::WHOLE, whole),
        () => (found, best),
    }
}

/// One step away, in the order in which ties are resolved: along either axis every move of the centre, then of the
/// radius, by a step back, none or one on.
pub fn neighbours(of: &Ellipse, step: f64, least: f64) -> impl Iterator<Item = Ellipse> {
    let of = *of;
    let moves = (0..18).filter(|i| i % 9 != 4);
    moves.map(move |i: usize| {
        let [by, grow] = [i % 3, i % 9 / 3].map(|k| (k as f64 - 1.0) * step);
        of.moved(i / 9, (by, grow), least)
    })
}
