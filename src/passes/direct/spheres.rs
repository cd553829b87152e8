//! Lights near the field: the grid points that each may reach, and their passes.

use crate::graph::{Builder, Rectangle, ResourceId};
use crate::passes::blocks::Blocks;
use crate::passes::sphere_sh::SphereSh;
use crate::passes::sphere_sh_shade;
use crate::passes::sphere_shade;
use crate::passes::sphere_shading::{SphereShading, SphereSpecular, texels_within};
use crate::scene::{HeightField, NearLight, Scene, SphereLight};
use crate::{Error, Result};

/// Parts of the field along either side, whose loss is bounded together.
const PARTS: usize = 16;
/// Halvings of the threshold's logarithm: 2⁻³² of 60 octaves.
const HALVINGS: u32 = 32;
/// Largest number of lights in a plan: the threshold is at least the permitted loss divided by this.
const MOST_LIGHTS: f64 = 1e18;

/// Lights near the field that reach any grid point.
pub(crate) struct Spheres {
    pub active: Vec<NearLight>,
    regions: Vec<(Rectangle, f32)>,
}

impl Spheres {
    /// Of `lit`, the sphere lights that reach the field. Each reaches as far as it may give more than a
    /// threshold, whatever the heights.
    ///
    /// A sphere light of radiance L and radius r gives at most L (r/d)² at distance d. The threshold T is the
    /// largest at which no grid point loses more than `cutoff` times the brightest light that one sphere light
    /// may give to its nearest grid point. The loss is bounded by the sum over the lights of min(T, the most
    /// that each may give).
    pub(crate) fn of(
        field: &HeightField,
        lit: Vec<NearLight>,
        cutoff: f64,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        for light in &lit {
            let sphere = &light.sphere;
            if let Some(least_m) = sphere.too_narrow(on_nearest(field, sphere)) {
                return Err(Error::setting(
                    format!("{}: radius", light.name()),
                    sphere.radius_m.to_string(),
                    format!(
                        "{least_m} at least: half a millionth of the way to the nearest grid point"
                    ),
                ));
            }
        }
        let brightest = lit.iter().map(|l| on_nearest(field, &l.sphere)).fold(0.0, f64::max);
        let most = cutoff * brightest;
        let threshold = threshold(field, &lit, most);
        let mut spheres = Self { active: Vec::new(), regions: Vec::new() };
        let mut is_cut = false;
        for light in lit {
            let reach = light.sphere.reach_m(threshold);
            match texels_within(field, &light.sphere, reach) {
                Some(lit_texels) => {
                    is_cut |= lit_texels != whole(field);
                    spheres.active.push(light);
                    // Slightly more, so that no rounding drops a texel that counts.
                    spheres
                        .regions
                        .push((lit_texels, (reach * (1.0 + 1e-6)).min(f64::from(f32::MAX)) as f32));
                }
                None => notes
                    .push(format!("{} dropped: it gives less than {threshold:.3e}", light.name())),
            }
        }
        if is_cut {
            notes.push(format!(
                "sphere lights end where they give less than {threshold:.3e}: no texel loses more than \
                 {most:.3e}, {cutoff} of the brightest"
            ));
        }
        Ok(spheres)
    }

    /// As [`plan`](Self::plan), by spherical harmonics.
    pub(crate) fn plan_soft(
        &self,
        builder: &mut Builder,
        lit: (&Scene, &Blocks, &SphereSh),
        heights: ResourceId,
        (index, begins): (usize, bool),
        sum: ResourceId,
    ) {
        let light = &self.active[index];
        let shading = self.shading(&lit.0.field, (index, lit.2.azimuths), begins, None);
        sphere_sh_shade::plan(builder, lit, heights, &light.label(), &light.sphere, &shading, sum);
    }

    /// The passes of an active light, by its index and its slices; `begins`: the sum begins with it.
    pub(crate) fn plan(
        &self,
        builder: &mut Builder,
        (scene, blocks): (&Scene, &Blocks),
        of: (usize, u32),
        (begins, specular): (bool, Option<SphereSpecular>),
        sum: ResourceId,
    ) {
        let light = &self.active[of.0];
        let shading = self.shading(&scene.field, of, begins, specular);
        sphere_shade::plan(builder, scene, blocks, &light.label(), &light.sphere, &shading, sum);
    }

    fn shading(
        &self,
        field: &HeightField,
        (index, slices): (usize, u32),
        begins: bool,
        specular: Option<SphereSpecular>,
    ) -> SphereShading {
        let (rectangle, reach_m) = self.regions[index];
        // The first light writes all of the sum.
        let rectangle = if begins { whole(field) } else { rectangle };
        let why = self.active[index].of.shaded_by;
        SphereShading { why, slices, rectangle, reach_m, begins, specular }
    }
}

fn whole(field: &HeightField) -> Rectangle {
    Rectangle::whole([field.cols() as u32, field.rows() as u32])
}

/// The most that it gives to the nearest grid point in plan.
fn on_nearest(field: &HeightField, light: &SphereLight) -> f64 {
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, z] = light.position_m;
    let (rows, cols) = (field.rows(), field.cols());
    let col = (x / cell_x).round().clamp(0.0, (cols - 1) as f64);
    let up = (y / cell_y).round().clamp(0.0, (rows - 1) as f64);
    let row = rows - 1 - up as usize;
    let height = field.base_m() + f64::from(field.heights_m()[row * cols + col as usize]);
    let [east, north] = [x - col * cell_x, y - up * cell_y];
    light.most_at((east * east + north * north + (z - height).powi(2)).sqrt())
}

/// The largest threshold with which no grid point loses more than `most`.
fn threshold(field: &HeightField, lit: &[NearLight], most: f64) -> f64 {
    if most <= 0.0 {
        return 0.0;
    }
    let given: Vec<Vec<f64>> = (0..PARTS * PARTS)
        .map(|part| {
            lit.iter()
                .map(|light| in_part(field, &light.sphere, [part / PARTS, part % PARTS]))
                .collect()
        })
        .collect();
    let loss = |threshold: f64| {
        let of = |part: &Vec<f64>| part.iter().map(|v| v.min(threshold)).sum::<f64>();
        given.iter().map(of).fold(0.0, f64::max)
    };
    // Between its nth part and the whole.
    let (mut low, mut high) = ((most / MOST_LIGHTS).ln(), most.ln());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if loss(middle.exp()) <= most { low = middle } else { high = middle }
    }
    low.exp()
}

/// The most that a sphere light gives anywhere in a part of the field, at any height.
fn in_part(field: &HeightField, light: &SphereLight, part: [usize; 2]) -> f64 {
    let [x, y, _] = light.position_m;
    let beside = |place: f64, cell: f64, count: usize, part: usize| {
        let side = (count - 1) as f64 * cell / PARTS as f64;
        let [low, high] = [part as f64 * side, (part + 1) as f64 * side];
        (low - place).max(place - high).max(0.0)
    };
    let [cell_x, cell_y] = field.cell_m();
    let east = beside(x, cell_x, field.cols(), part[1]);
    let north = beside(y, cell_y, field.rows(), part[0]);
    light.most_at(east.hypot(north))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Limits;
    use crate::plan;
    use crate::plan::{Pass, Picture, Plan};
    use crate::scene::fractal;
    use crate::scene::{Lights, Quality, Surface};

    fn light(x: f64, y: f64, radius_m: f64) -> SphereLight {
        SphereLight { position_m: [x, y, 30.0], radius_m, radiance: [1.0; 3] }
    }

    fn plan(sphere_lights: Vec<SphereLight>, light_cutoff: f64, wanted: Picture) -> Plan {
        let lights = Lights { sphere_lights, ..Lights::default() };
        let scene = Scene { field: fractal(64, 1).unwrap(), surface: Surface::default(), lights };
        let quality = Quality { light_cutoff, ..Quality::default() };
        plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).unwrap()
    }

    /// One light alone may lose all that lies below a share of its brightest. Many together lose no more. No
    /// permitted loss is no threshold.
    #[test]
    fn the_threshold_follows_the_permitted_loss() {
        let field = fractal(64, 1).unwrap();
        let lights = [light(10.0, 20.0, 1.0), light(40.0, 40.0, 1.0), light(11.0, 21.0, 1.0)];
        let near = Lights { sphere_lights: lights.to_vec(), ..Lights::default() };
        let lit = |n: usize| near.near().take(n).collect::<Vec<_>>();
        let one = threshold(&field, &lit(1), 1e-3);
        assert!((one / 1e-3 - 1.0).abs() < 1e-6, "{one}");
        let three = threshold(&field, &lit(3), 1e-3);
        assert!((three / one - 1.0 / 3.0).abs() < 1e-6, "{three}");
        assert_eq!(threshold(&field, &lit(3), 0.0), 0.0);
    }

    #[test]
    fn sphere_lights_alone_need_no_sweep_and_take_no_edits() {
        let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
        let plan = plan(vec![light(10.0, 20.0, 1.0), light(40.0, 40.0, 1.0)], 0.0, wanted);
        let mut names: Vec<&str> = plan.passes.iter().map(|p| p.name()).collect();
        names.dedup();
        let each = ["sphere_shade", "light_resolve"];
        assert_eq!(names, [&["height_cells", "height_bounds"][..], &each, &each].concat());
        assert!(plan.edit_passes.is_empty() && plan.find("direct.sphere_light2").is_some());
        assert!(plan.notes.iter().all(|n| !n.contains("light")), "{:?}", plan.notes);
    }

    /// A moving light keeps the passes, and on an unchanged field only its own passes run again.
    #[test]
    fn a_moving_sphere_light_is_lit_alone() {
        let at = |x: f64| plan(vec![light(x, 20.0, 1.0)], 0.0, Picture::default());
        let (before, after) = (at(10.0), at(-500.0));
        assert!(after.has_passes_of(&before));
        let run = after.passes_after(&before, &[]);
        let names: Vec<&str> = run.iter().map(|i| after.passes[*i].name()).collect();
        assert_eq!(names, ["sphere_shade", "light_resolve"]);
    }

    /// Also where its dispatches are cut by rows, and the light leaves the field.
    #[test]
    fn a_moving_sphere_light_keeps_its_parts() {
        let limits = Limits { lookups: 100_000, ..Limits::lavapipe() };
        // 3 m over the ground, so that they reach little of it.
        let over = |field: &HeightField, x: f64, y: f64| {
            let height = field.heights_m()[(63 - y as usize) * 64 + x as usize];
            let up = field.base_m() + f64::from(height) + 3.0;
            SphereLight { position_m: [x, y, up], radius_m: 1.0, radiance: [1.0; 3] }
        };
        let at = |y: f64| {
            let field = fractal(64, 1).unwrap();
            let sphere_lights = vec![over(&field, 30.0, 20.0), over(&field, 40.0, y)];
            let lights = Lights { sphere_lights, ..Lights::default() };
            let scene = Scene { field, surface: Surface::default(), lights };
            let quality = Quality { light_cutoff: 0.3, ..Quality::default() };
            plan::picture(&scene, &quality, &limits, Picture::default()).unwrap()
        };
        let before = at(30.0);
        let cut = before.passes.iter().filter(|p| p.part.contains("rows"));
        assert!(cut.clone().count() > 16);
        // The rows below its rectangle are left out.
        let second = |p: &&Pass| p.part.starts_with("sphere_light2 slices 0..1 rows 56");
        assert_eq!(before.passes.iter().find(second).map(|p| p.groups), Some([1; 3]));
        let pushed = |plan: &Plan| plan.passes.iter().map(|p| p.push.clone()).collect::<Vec<_>>();
        for y in [3.0, 37.5, 61.0] {
            let after = at(y);
            assert!(after.has_passes_of(&before), "{y}");
            assert_ne!(pushed(&after), pushed(&before), "{y}");
        }
    }

    #[test]
    fn a_sphere_light_too_narrow_for_f32_is_refused() {
        let field = fractal(64, 1).unwrap();
        let of = |radius: f64| {
            let far = light(10.0, 20.0, radius);
            let far = SphereLight { position_m: [10.0, 20.0, 1e6], ..far };
            let lights = Lights { sphere_lights: vec![far], ..Lights::default() };
            Spheres::of(&field, lights.near().collect(), 0.0, &mut Vec::new()).map(drop)
        };
        assert!(of(0.51).is_ok());
        let message = of(0.49).unwrap_err().to_string();
        assert!(
            message.starts_with("sphere light 1: radius: found 0.49, expected 0.4999"),
            "{message}"
        );
    }

    #[test]
    fn a_sphere_light_that_reaches_nothing_is_dropped() {
        let far =
            plan(vec![light(10.0, 20.0, 1.0), light(1e6, 0.0, 1.0)], 1e-3, Picture::default());
        assert!(
            far.notes.iter().any(|n| n.starts_with("sphere light 2 dropped")),
            "{:?}",
            far.notes
        );
        assert!(far.passes.iter().all(|p| !p.part.starts_with("light2")));
    }
}
