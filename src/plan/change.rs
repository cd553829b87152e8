use std::ops::Range;

use super::Plan;
use crate::graph::{Pass, Rectangle, ResourceId};
use crate::passes::azimuths::Azimuth;
use crate::{Error, Result};

impl Plan {
    /// Passes, by position, that must run after a frame of `before` for the same outputs as if all ran: those that differ
    /// from `before`'s or read changed data, and those that follow from them. `changed` are inputs with new contents.
    /// Returns all passes if the plans differ in their images, buffers or list of passes.
    ///
    /// With [`Picture::keeps_horizons`](super::Picture::keeps_horizons), a change of light alone needs no sweep, except for
    /// another environment, whose azimuths differ. A change of heights alone never needs an environment's tables.
    pub fn passes_after(&self, before: &Plan, changed: &[ResourceId]) -> Vec<usize> {
        let count = self.passes.len();
        if self.resources != before.resources || !self.has_passes_of(before) {
            return (0..count).collect();
        }
        let constants =
            (self.constants != before.constants).then(|| self.find("constants")).flatten();
        let is_new = |id: ResourceId| changed.contains(&id) || constants == Some(id);
        let mut runs: Vec<bool> = (0..count)
            .map(|i| {
                let (pass, old) = (&self.passes[i], &before.passes[i]);
                pass.push != old.push
                    || pass.groups != old.groups
                    || self.azimuths_of(pass) != before.azimuths_of(old)
                    || pass.reads().any(is_new)
            })
            .collect();
        self.add_followers(&mut runs);
        (0..count).filter(|i| runs[*i]).collect()
    }

    /// Checks that the plan has passes for edits, and that `rectangle` lies in its field.
    ///
    /// # Errors
    /// A plan without edit passes; a rectangle that is empty or beyond the field.
    pub fn check_edit(&self, rectangle: Rectangle) -> Result<()> {
        if self.edit_passes.is_empty() {
            return Err(Error::setting(
                "an edit",
                "a plan without passes for edits",
                "Picture::keeps_horizons, a sweep along lines with any fuse but nearest \
                 and slopes, a border of plane or open, and no SH, bounces, specular or sphere lights",
            ));
        }
        let Rectangle { col, row, cols, rows } = rectangle;
        let fits = |first: u32, count: u32, all: u32| {
            count > 0 && first.checked_add(count).is_some_and(|end| end <= all)
        };
        if !(fits(col, cols, self.size[0]) && fits(row, rows, self.size[1])) {
            return Err(Error::setting(
                "an edit",
                format!("{cols} × {rows} grid points from column {col}, row {row}"),
                format!("1 or more within {} × {}", self.size[0], self.size[1]),
            ));
        }
        Ok(())
    }

    fn azimuths_of(&self, pass: &Pass) -> Option<&[Azimuth]> {
        let Range { start, end } = pass.azimuths;
        self.azimuths.get(start as usize..end as usize)
    }

    /// Adds the passes that must run because of those that run: they read or write data that a running pass writes, or they write what a
    /// running pass reads and a later pass overwrote. The time is linear in the bindings of all passes.
    pub(crate) fn add_followers(&self, runs: &mut [bool]) {
        let of_resources = || vec![Vec::new(); self.resources.len()];
        let (mut users, mut writers) = (of_resources(), of_resources());
        for (p, pass) in self.passes.iter().enumerate() {
            pass.reads().for_each(|id| users[id.0].push(p));
            pass.writes().for_each(|id| users[id.0].push(p));
            pass.writes().for_each(|id| writers[id.0].push(p));
        }
        let last_writers: Vec<_> = writers.iter().map(|all| all.last().copied()).collect();
        let mut running: Vec<usize> = (0..runs.len()).filter(|p| runs[*p]).collect();
        while let Some(p) = running.pop() {
            let pass = &self.passes[p];
            // Each list is followed once.
            let mut followers = Vec::new();
            pass.writes().for_each(|id| followers.append(&mut users[id.0]));
            let overwritten = pass.reads().filter(|id| last_writers[id.0] > Some(p));
            overwritten.for_each(|id| followers.append(&mut writers[id.0]));
            followers.retain(|follower| !std::mem::replace(&mut runs[*follower], true));
            running.append(&mut followers);
        }
    }

    /// Whether both plans bind the same resources to the same shaders with the same constants.
    pub(crate) fn has_passes_of(&self, before: &Plan) -> bool {
        let same = |(a, b): (&Pass, &Pass)| {
            a.name() == b.name() && a.constants == b.constants && a.bindings == b.bindings
        };
        let alike = |a: &[Pass], b: &[Pass]| a.len() == b.len() && a.iter().zip(b).all(same);
        alike(&self.passes, &before.passes) && alike(&self.edit_passes, &before.edit_passes)
    }
}

#[cfg(test)]
mod tests {
    use crate::graph::{Limits, Resource};
    use crate::plan;
    use crate::plan::{Picture, Plan};
    use crate::scene::{Basis, Bounces, Environment, Lights, Method, Quality, Scene, Sun, Surface};
    use crate::scene::{HeightField, fractal};

    fn scene() -> Scene {
        let texels = (0..32 * 16).map(|i| [i as f32, 1.0, 2.0]).collect();
        let sun = Sun {
            azimuth_rad: 1.0,
            elevation_rad: 0.4,
            diameter_rad: 0.01,
            irradiance: [2.0, 1.5, 1.0],
        };
        Scene {
            field: fractal(64, 1).unwrap(),
            surface: Surface::default(),
            lights: Lights {
                sky: Some([1.0, 0.9, 0.8]),
                environment: Some(Environment::new(32, 16, texels, 0.0).unwrap()),
                suns: vec![sun],
                ..Lights::default()
            },
        }
    }

    fn plan(scene: &Scene, keeps_horizons: bool) -> Plan {
        let wanted = Picture { keeps_horizons, ..Picture::default() };
        let quality = Quality { azimuths: 16, ..Quality::default() };
        plan::picture(scene, &quality, &Limits::lavapipe(), wanted).unwrap()
    }

    fn names(plan: &Plan, passes: &[usize]) -> Vec<&'static str> {
        let mut names: Vec<_> = passes.iter().map(|i| plan.passes[*i].name()).collect();
        names.dedup();
        names
    }

    /// Names of the passes that follow a plan, if only these inputs have new contents.
    fn needed(after: &Plan, before: &Plan, changed: &[&str]) -> Vec<&'static str> {
        let changed: Vec<_> = changed.iter().map(|name| after.find(name).unwrap()).collect();
        names(after, &after.passes_after(before, &changed))
    }

    /// Whether pass `i` must run because of those that do.
    fn follows(plan: &Plan, i: usize, runs: &[bool]) -> bool {
        let pass = &plan.passes[i];
        let writes = |p: usize, id| plan.passes[p].writes().any(|w| w == id);
        let running = (0..runs.len()).filter(|p| runs[*p]);
        let is_recomputed = |id| running.clone().any(|p| writes(p, id));
        let is_overwritten = |id| {
            running.clone().any(|p| {
                let reads = plan.passes[p].reads().any(|r| r == id);
                reads && (p + 1..runs.len()).any(|later| writes(later, id))
            })
        };
        pass.reads().any(is_recomputed)
            || pass.writes().any(|id| is_recomputed(id) || is_overwritten(id))
    }

    /// Of each pass alone, by the rule for one pass until nothing is added.
    #[test]
    fn followers_are_those_of_the_rule() {
        let small = Limits { image_layers: 64, ..Limits::lavapipe() };
        let mut counts = Vec::new();
        for (basis, count, limits) in
            [(Basis::Table, 0, Limits::lavapipe()), (Basis::Table, 2, small), (Basis::Sh, 2, small)]
        {
            let bounces = Bounces { count, ..Bounces::default() };
            let quality = Quality { azimuths: 16, basis, bounces, ..Quality::default() };
            let wanted = Picture { keeps_horizons: count == 0, ..Picture::default() };
            let plan = plan::picture(&scene(), &quality, &limits, wanted).unwrap();
            let count = plan.passes.len();
            for first in 0..count {
                let mut expected = vec![false; count];
                expected[first] = true;
                let mut found = expected.clone();
                while let Some(next) =
                    (0..count).find(|i| !expected[*i] && follows(&plan, *i, &expected))
                {
                    expected[next] = true;
                }
                plan.add_followers(&mut found);
                assert!(found == expected, "{}", plan.passes[first].label());
                counts.push(found.iter().filter(|runs| **runs).count());
            }
        }
        // Some have few, others many.
        let [few, many] = [counts.iter().min(), counts.iter().max()];
        assert!(few < Some(&10) && many > Some(&20), "{counts:?}");
    }

    #[test]
    fn an_unchanged_plan_needs_no_passes() {
        let plan = plan(&scene(), true);
        assert!(plan.passes_after(&plan, &[]).is_empty());
    }

    /// Rotating an environment changes constants and no push constants.
    #[test]
    fn rotating_an_environment_recomputes_its_harmonics() {
        let mut scene = scene();
        let quality = Quality { azimuths: 16, basis: Basis::Sh, ..Quality::default() };
        let wanted = Picture { keeps_horizons: true, ..Picture::default() };
        let plan = |s: &Scene| plan::picture(s, &quality, &Limits::lavapipe(), wanted).unwrap();
        let before = plan(&scene);
        assert!(before.passes_after(&before, &[]).is_empty());
        let texels = scene.lights.environment.as_ref().unwrap().texels().to_vec();
        scene.lights.environment = Some(Environment::new(32, 16, texels, 0.1).unwrap());
        let after = plan(&scene);
        let needed = needed(&after, &before, &[]);
        assert_eq!(needed, ["env_rotation", "light_matrix", "sh_shade", "light_resolve"]);
    }

    /// Visibility is kept: new light of any kind needs no horizons of the circle, whose single lattice is reused. A new field
    /// needs everything except the light's own data.
    #[test]
    fn harmonics_keep_visibility() {
        let wanted = Picture { keeps_horizons: true, ..Picture::default() };
        for (method, subsample) in [(Method::Sweep, 1), (Method::Sweep, 2), (Method::Pyramid, 4)] {
            let quality =
                Quality { method, subsample, azimuths: 16, basis: Basis::Sh, ..Quality::default() };
            let limits = Limits { image_layers: 64, ..Limits::lavapipe() };
            let plan = |s: &Scene| plan::picture(s, &quality, &limits, wanted).unwrap();
            let mut scene = scene();
            let before = plan(&scene);
            let swept: Vec<_> =
                before.passes.iter().filter(|p| p.name() == "sh_visibility").collect();
            assert!(swept.len() > 1);
            let lattices = before.resources.iter().filter(|r| r.name.starts_with("lattice_"));
            let of_suns = |r: &&Resource| r.name.bytes().any(|b| b.is_ascii_digit());
            assert_eq!(lattices.filter(|r| !of_suns(r)).count(), 1);
            let of_environment = needed(&before, &before, &["environment"]);
            assert_eq!(
                of_environment,
                ["env_rotation", "light_matrix", "sh_shade", "light_resolve"]
            );
            scene.lights.sky = Some([9.0, 1.0, 0.5]);
            scene.lights.suns[0].irradiance = [0.5; 3];
            let after = plan(&scene);
            assert_eq!(needed(&after, &before, &[]), ["light_resolve"]);
            let needed = needed(&after, &after, &["heights"]);
            assert!(["sh_visibility", "sh_shade", "sun_shade"].iter().all(|n| needed.contains(n)));
            assert!(!needed.contains(&"env_rotation") && !needed.contains(&"light_matrix"));
        }
    }

    #[test]
    fn new_light_on_a_still_field_needs_no_sweep() {
        let mut scene = scene();
        let before = plan(&scene, true);
        scene.lights.suns[0].irradiance = [9.0; 3];
        let after = plan(&scene, true);
        // The picture is a sum that begins with its first light.
        assert_eq!(needed(&after, &before, &[]), ["light_resolve"]);
        let needed = needed(&after, &after, &["environment"]);
        assert_eq!(needed, ["env_wedges", "env_tables", "sky_shade", "light_resolve"]);
    }

    #[test]
    fn a_sun_that_moves_within_its_octant_is_swept_alone() {
        let mut scene = scene();
        let before = plan(&scene, true);
        scene.lights.suns[0].azimuth_rad += 0.01;
        let after = plan(&scene, true);
        assert!(after.azimuths != before.azimuths);
        let needed = after.passes_after(&before, &[]);
        assert_eq!(
            names(&after, &needed),
            [
                "light_resolve",
                "shadow_sweep",
                "shadow_shade",
                "height_bounds",
                "shadow_settle",
                "light_resolve"
            ]
        );
        for i in needed.iter().map(|i| &after.passes[*i]).filter(|p| p.name() == "shadow_sweep") {
            assert!(i.part.starts_with("sun1"), "{}", i.label());
        }
    }

    /// A quarter of the horizon in steps of half a degree. Another axis needs other passes while the slices of the sun cross the grid's
    /// diagonal.
    #[test]
    fn a_sun_that_moves_across_the_sky_keeps_its_renderer() {
        let mut scene = scene();
        scene.lights.environment = None;
        let crossing = 1 + (scene.lights.suns[0].diameter_rad.to_degrees() / 0.5).ceil() as usize;
        for limits in [Limits::lavapipe(), Limits::boundless(false, 8 << 30)] {
            for (rows, cols) in [(256, 256), (438, 433)] {
                scene.field = HeightField::unknown(rows, cols, [10.0; 2]).unwrap();
                let mut plan = |step: u32| {
                    scene.lights.suns[0].azimuth_rad = (0.5 * f64::from(step) - 44.0).to_radians();
                    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
                    plan::picture(&scene, &Quality::default(), &limits, wanted).unwrap()
                };
                let mut before = plan(0);
                let mut others = 0;
                for step in 1..180 {
                    let after = plan(step);
                    let is_other = after.passes_after(&before, &[]).len() == after.passes.len();
                    others += usize::from(is_other);
                    before = after;
                }
                assert!((1..=crossing).contains(&others), "{others} of 179, {rows} × {cols}");
            }
        }
    }

    #[test]
    fn reused_lattices_are_swept_again() {
        let before = plan(&scene(), false);
        let needed = needed(&before, &before, &["environment"]);
        assert!(needed.contains(&"horizon_sweep"), "{needed:?}");
    }

    #[test]
    fn a_new_field_under_still_light_keeps_its_tables() {
        let plan = plan(&scene(), true);
        let needed = needed(&plan, &plan, &["heights"]);
        assert!(!needed.iter().any(|n| n.starts_with("env_")), "{needed:?}");
        assert!(needed.contains(&"horizon_sweep") && needed.contains(&"shadow_shade"));
    }

    #[test]
    fn a_new_field_recomputes_its_pyramid() {
        let quality = Quality { method: Method::Pyramid, azimuths: 16, ..Quality::default() };
        let wanted = Picture { keeps_horizons: true, ..Picture::default() };
        let mut scene = scene();
        let before = plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).unwrap();
        let of_heights = needed(&before, &before, &["heights"]);
        for name in ["height_reduce", "height_expand", "pyramid_march"] {
            assert!(of_heights.contains(&name), "{name}: {of_heights:?}");
        }
        scene.lights.suns[0].irradiance = [9.0; 3];
        let after = plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).unwrap();
        assert_eq!(needed(&after, &before, &[]), ["light_resolve"]);
    }

    #[test]
    fn another_plan_is_run_whole() {
        let mut scene = scene();
        let before = plan(&scene, true);
        scene.lights.suns.clear();
        let after = plan(&scene, true);
        assert_eq!(after.passes_after(&before, &[]).len(), after.passes.len());
    }
}
