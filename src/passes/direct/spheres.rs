//! Balls of light: which samples each is looked for at, and the passes that do it.

use crate::graph::{Builder, Rectangle, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::sphere_sh::SphereSh;
use crate::passes::sphere_sh_shade;
use crate::passes::sphere_shade::{self, Look};
use crate::scene::{HeightField, Scene, SphereLight};
use crate::{Error, Result};

/// Parts of the field, along either side, whose loss is bounded together.
const PARTS: usize = 16;
/// Halvings of the threshold's logarithm: 2⁻³² of 60 octaves.
const HALVINGS: u32 = 32;
/// The threshold lies at most this far below what may be lost: more lights are in no plan.
const MOST_LIGHTS: f64 = 1e18;

/// The least radius over the distance to the nearest sample: both limbs' elevations err by 6e-8, an eighth of it.
const NARROWEST: f64 = 5e-7;

/// Balls that any sample is to get light from.
pub(crate) struct Spheres<'a> {
    /// With their positions in the scene.
    pub shining: Vec<(usize, &'a SphereLight)>,
    looks: Vec<(Rectangle, f32)>,
}

impl<'a> Spheres<'a> {
    /// Of `lit` balls those that reach the field, each as far as it gives more than a threshold, whatever
    /// the heights.
    ///
    /// A ball of radiance L and radius r gives a sample at distance d at most L (r/d)². The threshold T
    /// is the largest at which no sample of the field can lose more than `cutoff` times the brightest
    /// light that one ball may give to the sample nearest to its foot: the sum over balls of
    /// min(T, what it gives at most), anywhere.
    pub fn of(
        field: &HeightField,
        lit: Vec<(usize, &'a SphereLight)>,
        cutoff: f64,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        for (i, ball) in &lit {
            let seems = (on_nearest(field, ball) / strongest(ball)).sqrt();
            if seems < NARROWEST {
                return Err(Error::setting(
                    format!("light {}: radius", i + 1),
                    ball.radius_m.to_string(),
                    format!("{} at least: half a millionth of the way to the nearest sample", {
                        ball.radius_m * NARROWEST / seems
                    }),
                ));
            }
        }
        let brightest = lit.iter().map(|(_, ball)| on_nearest(field, ball)).fold(0.0, f64::max);
        let most = cutoff * brightest;
        let threshold = threshold(field, &lit, most);
        let mut spheres = Self { shining: Vec::new(), looks: Vec::new() };
        let mut is_cut = false;
        for (i, ball) in lit {
            let reach = if threshold > 0.0 {
                ball.radius_m * (strongest(ball) / threshold).sqrt()
            } else {
                f64::INFINITY
            };
            match samples_within(field, ball, reach) {
                Some(seen) => {
                    is_cut |= seen != whole(field);
                    spheres.shining.push((i, ball));
                    // A hair more, so that no rounding drops what counts.
                    spheres
                        .looks
                        .push((seen, (reach * (1.0 + 1e-6)).min(f64::from(f32::MAX)) as f32));
                }
                None => notes
                    .push(format!("light {} dropped: it gives less than {threshold:.3e}", i + 1)),
            }
        }
        if is_cut {
            notes.push(format!(
                "balls of light end where they give less than {threshold:.3e}: no sample loses more than \
                 {most:.3e}, {cutoff} of the brightest"
            ));
        }
        Ok(spheres)
    }

    /// As [`record`](Self::record), by spherical harmonics.
    pub fn record_soft(
        &self,
        builder: &mut Builder,
        lit: (&Scene, &Blocks, &SphereSh),
        heights: ResourceId,
        (index, begins): (usize, bool),
        sum: ResourceId,
    ) {
        let (position, ball) = self.shining[index];
        let look = self.look(&lit.0.field, index, lit.2.azimuths, begins);
        sphere_sh_shade::plan(builder, lit, heights, &light_name(position), ball, &look, sum);
    }

    /// The passes of the ball at `index` of those that shine; `begins` the sum with it.
    pub fn record(
        &self,
        builder: &mut Builder,
        (scene, blocks): (&Scene, &Blocks),
        (index, slices): (usize, u32),
        begins: bool,
        sum: ResourceId,
    ) {
        let (position, ball) = self.shining[index];
        let look = self.look(&scene.field, index, slices, begins);
        sphere_shade::plan(builder, scene, blocks, &light_name(position), ball, &look, sum);
    }

    fn look(&self, field: &HeightField, index: usize, slices: u32, begins: bool) -> Look {
        let (rectangle, reach_m) = self.looks[index];
        // What begins the sum writes all of it.
        let rectangle = if begins { whole(field) } else { rectangle };
        Look { slices, rectangle, reach_m, begins }
    }
}

/// As in labels and layers: "light1" is the scene's first.
pub(crate) fn light_name(position: usize) -> String {
    format!("light{}", position + 1)
}

fn whole(field: &HeightField) -> Rectangle {
    Rectangle::whole([field.cols() as u32, field.rows() as u32])
}

fn strongest(ball: &SphereLight) -> f64 {
    f64::from(ball.radiance.iter().fold(0.0, |m: f32, v| m.max(*v)))
}

/// What a ball gives at most so far away.
fn at(ball: &SphereLight, distance: f64) -> f64 {
    strongest(ball) * (ball.radius_m / distance.max(ball.radius_m)).powi(2)
}

/// The same to the sample nearest to the ball's foot.
fn on_nearest(field: &HeightField, ball: &SphereLight) -> f64 {
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, z] = ball.position_m;
    let (rows, cols) = (field.rows(), field.cols());
    let col = (x / cell_x).round().clamp(0.0, (cols - 1) as f64);
    let up = (y / cell_y).round().clamp(0.0, (rows - 1) as f64);
    let row = rows - 1 - up as usize;
    let height = field.base_m() + f64::from(field.heights_m()[row * cols + col as usize]);
    let [east, north] = [x - col * cell_x, y - up * cell_y];
    at(ball, (east * east + north * north + (z - height).powi(2)).sqrt())
}

/// The largest threshold with which no sample loses more than `most`.
fn threshold(field: &HeightField, lit: &[(usize, &SphereLight)], most: f64) -> f64 {
    if most <= 0.0 {
        return 0.0;
    }
    let given: Vec<Vec<f64>> = (0..PARTS * PARTS)
        .map(|part| {
            lit.iter().map(|(_, ball)| in_part(field, ball, [part / PARTS, part % PARTS])).collect()
        })
        .collect();
    let lost = |threshold: f64| {
        let of = |part: &Vec<f64>| part.iter().map(|v| v.min(threshold)).sum::<f64>();
        given.iter().map(of).fold(0.0, f64::max)
    };
    // Between its nth part and the whole.
    let (mut low, mut high) = ((most / MOST_LIGHTS).ln(), most.ln());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if lost(middle.exp()) <= most { low = middle } else { high = middle }
    }
    low.exp()
}

/// What a ball may give at most anywhere in a part of the field, at whatever height.
fn in_part(field: &HeightField, ball: &SphereLight, part: [usize; 2]) -> f64 {
    let [x, y, _] = ball.position_m;
    let beside = |place: f64, cell: f64, count: usize, part: usize| {
        let side = (count - 1) as f64 * cell / PARTS as f64;
        let [low, high] = [part as f64 * side, (part + 1) as f64 * side];
        (low - place).max(place - high).max(0.0)
    };
    let [cell_x, cell_y] = field.cell_m();
    let east = beside(x, cell_x, field.cols(), part[1]);
    let north = beside(y, cell_y, field.rows(), part[0]);
    at(ball, east.hypot(north))
}

/// The samples within so much of a ball's middle in the plane; none where the field has none.
pub(crate) fn samples_within(
    field: &HeightField,
    ball: &SphereLight,
    reach: f64,
) -> Option<Rectangle> {
    let within = |place: f64, reach: f64, count: usize| {
        let last = count as f64 - 1.0;
        let [low, high] = [(place - reach).ceil().max(0.0), (place + reach).floor().min(last)];
        (low <= high).then_some((low as u32, (high - low) as u32 + 1))
    };
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, _] = ball.position_m;
    let (col, cols) = within(x / cell_x, reach / cell_x, field.cols())?;
    let from_north = (field.rows() - 1) as f64 - y / cell_y;
    let (row, rows) = within(from_north, reach / cell_y, field.rows())?;
    Some(Rectangle { col, row, cols, rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Limits;
    use crate::plan;
    use crate::plan::{Picture, Plan};
    use crate::scene::fractal;
    use crate::scene::{Lights, Quality, Surface};

    fn ball(x: f64, y: f64, radius_m: f64) -> SphereLight {
        SphereLight { position_m: [x, y, 30.0], radius_m, radiance: [1.0; 3] }
    }

    fn plan(sphere_lights: Vec<SphereLight>, light_cutoff: f64, wanted: Picture) -> Plan {
        let lights = Lights { sphere_lights, ..Lights::default() };
        let scene = Scene { field: fractal(64, 1).unwrap(), surface: Surface::default(), lights };
        let quality = Quality { light_cutoff, ..Quality::default() };
        plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).unwrap()
    }

    /// Of one ball alone all may be lost that it gives beyond a share of its brightest; many together lose
    /// no more; what nobody may lose is no threshold.
    #[test]
    fn the_threshold_is_what_may_be_lost() {
        let field = fractal(64, 1).unwrap();
        let balls = [ball(10.0, 20.0, 1.0), ball(40.0, 40.0, 1.0), ball(11.0, 21.0, 1.0)];
        let lit = |n: usize| balls[..n].iter().enumerate().collect::<Vec<_>>();
        let one = threshold(&field, &lit(1), 1e-3);
        assert!((one / 1e-3 - 1.0).abs() < 1e-6, "{one}");
        let three = threshold(&field, &lit(3), 1e-3);
        assert!((three / one - 1.0 / 3.0).abs() < 1e-6, "{three}");
        assert_eq!(threshold(&field, &lit(3), 0.0), 0.0);
    }

    #[test]
    fn balls_alone_need_no_sweep_and_take_no_edits() {
        let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
        let plan = plan(vec![ball(10.0, 20.0, 1.0), ball(40.0, 40.0, 1.0)], 0.0, wanted);
        let mut names: Vec<&str> = plan.passes.iter().map(|p| p.name()).collect();
        names.dedup();
        let each = ["sphere_shade", "light_resolve"];
        assert_eq!(names, [&["height_cells", "height_bounds"][..], &each, &each].concat());
        assert!(plan.edit_passes.is_empty() && plan.find("direct.light2").is_some());
        assert!(plan.notes.iter().all(|n| !n.contains("light")), "{:?}", plan.notes);
    }

    /// Wherever a ball goes, the passes are the same, and a still field needs no other than the balls'.
    #[test]
    fn a_ball_that_moves_is_lit_alone() {
        let at = |x: f64| plan(vec![ball(x, 20.0, 1.0)], 0.0, Picture::default());
        let (before, after) = (at(10.0), at(-500.0));
        assert!(after.has_passes_of(&before));
        let run = after.passes_after(&before, &[]);
        let names: Vec<&str> = run.iter().map(|i| after.passes[*i].name()).collect();
        assert_eq!(names, ["sphere_shade", "light_resolve"]);
    }

    #[test]
    fn a_ball_too_narrow_for_f32_is_refused() {
        let field = fractal(64, 1).unwrap();
        let of = |radius: f64| {
            let far = ball(10.0, 20.0, radius);
            let far = SphereLight { position_m: [10.0, 20.0, 1e6], ..far };
            Spheres::of(&field, vec![(0, &far)], 0.0, &mut Vec::new()).map(drop)
        };
        assert!(of(0.51).is_ok());
        let said = of(0.49).unwrap_err().to_string();
        assert!(said.starts_with("light 1: radius: found 0.49, expected 0.4999"), "{said}");
    }

    #[test]
    fn a_ball_that_reaches_nothing_is_dropped() {
        let far = plan(vec![ball(10.0, 20.0, 1.0), ball(1e6, 0.0, 1.0)], 1e-3, Picture::default());
        assert!(far.notes.iter().any(|n| n.starts_with("light 2 dropped")), "{:?}", far.notes);
        assert!(far.passes.iter().all(|p| !p.part.starts_with("light2")));
    }
}
