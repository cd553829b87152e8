//! Phong specular of a picture.

use super::super::active_lights::ActiveLights;
use super::drawing::Drawing;
use super::slices::SpecularLevel;
use crate::graph::ResourceId;
use crate::passes::batch::Batch;
use crate::passes::bounced_specular::{BouncedSpecular, ExitLight};
use crate::passes::bounces::{Bouncing, bounce_name};
use crate::passes::specular_tables;
use crate::passes::sphere_shading::SphereSpecular;
use crate::passes::sun_shade::KeySpecular;
use crate::passes::{self, PhongSource, light_resolve, specular_exit, sun_specular};
use crate::scene::{
    BounceEngine, BounceSpecular, LightBasis, PhongSpecular, Quality, Receiver, Specular, Sun,
};
use crate::{Error, Result};

/// Adapts the quality to a scene with specular.
///
/// # Errors
/// A light that specular does not support.
pub(super) fn quality(
    quality: &Quality,
    active: &ActiveLights<'_>,
    notes: &mut Vec<String>,
) -> Result<Quality> {
    if active.specular.is_none() {
        return Ok(*quality);
    }
    let refuse = |found: &str, expected: &str| Err(Error::setting("specular", found, expected));
    if let Some(light) = active.near.active.iter().find(|light| !light.of.has_specular) {
        let name = light.of.name;
        return refuse(&format!("specular under a {name}"), &format!("no specular, or no {name}s"));
    }
    let sphere = active.near.active.first().map(|light| light.of.name);
    if let Some(name) = sphere.filter(|_| quality.light_basis == LightBasis::Sh) {
        return refuse(
            &format!("specular under a {name} by `light_basis sh`"),
            "`light_basis exact`",
        );
    }
    for (i, sun) in &active.suns {
        let narrow = active.specular.and_then(|specular| sun_specular::widened(specular, sun));
        notes.extend(narrow.map(|n| {
            format!("specular of sun {}: exponents above {n:.0} become {n:.0}, a lobe a seventh of its radius wide", i + 1)
        }));
    }
    let quality = bounced(*quality, notes)?;
    notes.extend(active.key_notes(&quality));
    if let Some(specular) = active.by_slices(&quality) {
        let of = match specular_tables::levels(specular).len() {
            1 => String::new(),
            count => format!(" of {count} exponents"),
        };
        notes.push(format!("specular: each azimuth's slice of the lobe, from tables{of}"));
    }
    Ok(quality)
}

/// Chooses the engine that supports specular bounces.
///
/// # Errors
/// Settings that support no specular bounces.
fn bounced(mut quality: Quality, notes: &mut Vec<String>) -> Result<Quality> {
    if quality.bounces.count == 0 {
        return Ok(quality);
    }
    let refuse = |name: &str, found: &str, expected: &str| {
        Err(Error::setting(format!("`{name}` with `bounces` and specular"), found, expected))
    };
    if quality.bounces.engine == BounceEngine::Auto {
        notes.push("bounce engine pyramid: sweep keeps no exit radiance by direction, as specular needs; brute-force has a smaller error and takes longer".into());
        quality.bounces.engine = BounceEngine::Pyramid;
    }
    if quality.bounces.engine == BounceEngine::Sweep {
        let expected = "pyramid or brute-force, which keep exit radiance by direction";
        return refuse("bounce_engine", quality.bounces.engine.name(), expected);
    }
    if quality.receiver != Receiver::Plane {
        return refuse("receiver", quality.receiver.name(), "plane");
    }
    if quality.subsample != 1 {
        let found = quality.subsample.to_string();
        return refuse("subsample", &found, "1: arriving light is a series at every texel");
    }
    if quality.bounces.specular != BounceSpecular::Scalar {
        let order = quality.sh_order;
        notes.push(format!(
            "specular between bounces: harmonics of order {order}, which blur the lobe"
        ));
    }
    Ok(quality)
}

/// Checks that bounced specular can be viewed from an eye.
///
/// # Errors
/// One number per texel, which holds light towards the zenith only.
pub(super) fn check_viewed(quality: &Quality) -> Result<()> {
    if quality.bounces.specular != BounceSpecular::Scalar {
        return Ok(());
    }
    Err(Error::setting(
        "`bounce_specular` with `bounces`, specular and an eye",
        "scalar, the radiance towards the zenith",
        "vector or vector-f16, or a view from straight above, without a camera",
    ))
}

impl Drawing<'_> {
    /// The light matrices of visibility in harmonics.
    pub(super) fn fill_matrices(&mut self) {
        let Some(h) = &self.harmonics else { return };
        let builder = &mut self.builder;
        let lit = [(&h.diffuse, None), (&h.specular, self.active.sky)];
        for (light, sky) in lit {
            let Some(light) = light else { continue };
            let environment = self.active.environment.zip(self.images.environment);
            if let (Some((e, image)), Some(turns)) = (environment, light.env_rotation) {
                passes::env_rotation::plan(builder, e, &light.sh, [image, h.constants, turns]);
            }
            let ids = [h.constants, light.light_matrix];
            passes::light_matrix::plan(builder, &light.sh, sky, light.env_rotation, ids);
        }
    }

    /// Tables and maps of a lobe.
    pub(super) fn fill_specular(&mut self, count: u32) {
        let (Some(slices), Some(sweeping)) = (&self.slices, &self.sweeping) else { return };
        let (sky, builder) = (self.active.sky, &mut self.builder);
        let lit = self.active.environment.zip(self.images.environment);
        let swept_rows = lit.zip(self.tables.as_ref()).map(|((e, _), t)| (e, t.wedge_rows));
        let fine_rows = lit.zip(slices.fine_rows).map(|((e, image), rows)| {
            let ids = [image, slices.fine_azimuths, rows];
            let of = (e, self.scene.surface.border);
            passes::env_wedges::plan(builder, "fine", of, slices.fine_count, ids);
            (e, rows)
        });
        for SpecularLevel { swept, fine: (fine, unoccluded) } in &slices.levels {
            // Of a map, each level has its own passes.
            let part = |name: &str| match slices.levels.len() {
                1 => name.to_owned(),
                _ => format!("{name} exponent {:.3}", fine.exponent).trim_start().to_owned(),
            };
            fine.plan(builder, &part("fine"), sky, fine_rows, (slices.fine_azimuths, false));
            unoccluded.plan(
                builder,
                fine,
                (&part("unoccluded"), "the reflection without occlusion, by mirror direction"),
                (slices.fine_azimuths, slices.fine_count),
                Some(slices.fine_first_rad),
            );
            let Some((tables, swept)) = swept else { continue };
            tables.plan(builder, &part(""), sky, swept_rows, (sweeping.azimuths, true));
            let why = "the same from the swept azimuths, as occlusion is a share of them";
            let of = (sweeping.azimuths, count);
            swept.plan(builder, tables, (&part("swept"), why), of, None);
        }
    }

    /// Specular of sky and environment by tables of the lobe.
    pub(super) fn slices_light(&mut self, batch: &Batch, lane_heights: ResourceId) {
        let (Some(slices), Some(sum)) = (&self.slices, self.images.specular_sum) else { return };
        let Some(phong) = self.phong() else { return };
        let field = (batch.axis, self.scene.surface.border, self.scene.field.cell_m());
        let maps = [&slices.levels[0].fine.1, &slices.first_swept().1];
        let ids = (&slices.hidden, [lane_heights, sum]);
        passes::specular_light::plan(&mut self.builder, field, (phong, self.eye_m), maps, ids);
        self.specular_is_begun = true;
    }

    /// Specular of a sun, from its diffuse irradiance.
    pub(super) fn sun_specular(
        &mut self,
        name: &str,
        sun: &Sun,
        batch: &Batch,
        (sum, light_vector): (ResourceId, Option<ResourceId>),
    ) {
        let Some((specular, phong)) = self.images.specular_sum.zip(self.phong()) else { return };
        let (border, cell_m) = (self.border(), self.scene.field.cell_m());
        let Some(sweeping) = &self.sweeping else { return };
        let ids = ([sweeping.lane_heights(batch), sum, specular], light_vector);
        let begins = !std::mem::replace(&mut self.specular_is_begun, true);
        let field = (batch.axis, border, cell_m);
        let bounced = self.bounced_by_direction();
        passes::sun_specular::plan(
            &mut self.builder,
            field,
            name,
            (sun, phong, self.eye_m),
            ids,
            (begins, bounced),
        );
    }

    /// Specular of the light at this position among the [aimed](ActiveLights::aimed) ones, if it is a key light.
    pub(super) fn key_specular(&mut self, index: usize) -> Option<KeySpecular> {
        let (_, key) = self.active.keys.get(index.checked_sub(self.active.suns.len())?)?;
        let (specular_sum, phong) = self.images.specular_sum.zip(self.phong())?;
        let (radiance, eye_m) = (key.radiance, self.eye_m);
        let begins = !std::mem::replace(&mut self.specular_is_begun, true);
        Some(KeySpecular { phong, radiance, eye_m, specular_sum, begins })
    }

    /// Specular of the next sphere light.
    pub(super) fn sphere_specular(&mut self) -> Option<SphereSpecular> {
        let (specular_sum, phong) = self.images.specular_sum.zip(self.phong())?;
        let (slices_around, eye_m) = (self.active.specular_slices_around(), self.eye_m);
        let begins = !std::mem::replace(&mut self.specular_is_begun, true);
        let outgoing = self.bounced_by_direction();
        Some(SphereSpecular { phong, slices_around, eye_m, specular_sum, begins, outgoing })
    }

    /// Light that arrives from a batch of a key light's azimuths, after its [specular](Self::key_specular), if specular bounces keep
    /// directions.
    pub(super) fn key_arriving(
        &mut self,
        batch: &Batch,
        part: &str,
        KeySpecular { radiance, begins, .. }: KeySpecular,
    ) {
        let (Some(outgoing), Some(sweeping)) = (self.bounced_by_direction(), &self.sweeping) else {
            return;
        };
        let field = (&sweeping.sweep, self.scene.surface.border, self.scene.field.cell_m());
        let ids = (sweeping.lanes(batch), sweeping.lattice(batch), sweeping.azimuths);
        let light = (radiance, begins);
        passes::key_arriving::plan(&mut self.builder, field, (batch, part), ids, light, &outgoing);
    }

    /// Light that arrives from sky and environment, if specular bounces keep directions.
    pub(super) fn specular_around(&mut self) {
        let Some((specular, h)) = self.bounced_by_direction().zip(self.harmonics.as_ref()) else {
            return;
        };
        let Some(light) = &h.specular else { return };
        let size = [self.scene.field.cols() as u32, self.scene.field.rows() as u32];
        let ids = [h.visibility, light.light_matrix];
        passes::specular_visibility::plan(&mut self.builder, size, &specular, ids);
    }

    /// The specular bounces, if stored as series.
    fn bounced_by_direction(&self) -> Option<BouncedSpecular> {
        let specular = self.bouncing.as_ref().and_then(|bouncing| bouncing.specular);
        specular.filter(|specular| matches!(specular.outgoing, ExitLight::Vectors(_)))
    }

    /// Specular exit radiance of bounce `k`; 0 is direct light.
    pub(super) fn plan_specular_exit(&mut self, bouncing: &Bouncing, k: usize) {
        let (Some(specular), Some(phong)) = (bouncing.specular, self.phong()) else { return };
        let (Some(blocks), Some(specular_direct)) = (&self.blocks, self.images.specular_sum) else {
            return;
        };
        let size = [self.scene.field.cols() as u32, self.scene.field.rows() as u32];
        let exit = specular_exit::ExitRadiance {
            name: if k == 0 { "direct".to_owned() } else { bounce_name(k) },
            bounce: k,
            diffuse: bouncing.diffuse(k, self.images.radiance),
            specular_direct,
            eye_m: self.eye_m,
        };
        let field = (size, self.scene.field.cell_m());
        let ground = blocks.ground;
        specular_exit::plan(&mut self.builder, field, (&specular, phong), ground, &exit);
    }

    /// Adds the specular of all bounces.
    pub(super) fn bounced_specular(&mut self, bouncing: &Bouncing) {
        let Some(specular) = bouncing.specular else { return };
        self.resolve_specular("bounces specular", specular.bounced, specular.layer);
    }

    /// The specular as passes take it.
    pub(super) fn phong(&self) -> Option<PhongSource> {
        let constant = match self.active.specular? {
            Specular::Constant(specular) => *specular,
            Specular::Map(_) => PhongSpecular { exponent: 0.0, scale: 0.0 },
        };
        Some(PhongSource { constant, map: self.images.specular_map })
    }

    /// Adds the direct specular.
    pub(super) fn specular(&mut self) {
        let Some(sum) = self.images.specular_sum else { return };
        if self.specular_is_begun {
            self.resolve_specular("specular", sum, self.images.specular_layer);
        }
    }

    fn resolve_specular(&mut self, name: &str, sum: ResourceId, layer: Option<ResourceId>) {
        let is_first = !std::mem::replace(&mut self.is_begun, true);
        let light = light_resolve::Light {
            sum,
            has_colour: true,
            colour: [1.0; 3],
            texel: None,
            albedo_map: None,
            radiance: Some((self.images.radiance, is_first)),
            layer,
            grey: self.active.is_grey,
            edited: self.edited,
        };
        self.light_resolve(name, &light);
    }
}

#[cfg(test)]
mod tests {
    use super::ActiveLights;
    use crate::Result;
    use crate::graph::Limits;
    use crate::graph::shaders::offset;
    use crate::plan;
    use crate::plan::{Picture, Plan};
    use crate::scene::fractal;
    use crate::scene::{
        Albedo, Basis, Border, BounceSpecular, Bounces, Environment, KeyLight, LightBasis, Lights,
        NearType, PhongSpecular, Quality, SPHERE_LIGHT, Scene, Specular, SphereLight, Sun, Surface,
    };

    fn plan(lights: Lights, basis: Basis, scale: f32) -> Result<Plan> {
        plan_of(lights, basis, PhongSpecular { exponent: 9.0, scale })
    }

    fn scene(lights: Lights, specular: Specular) -> Scene {
        let (albedo, border) = (Albedo::Constant([0.5; 3]), Border::Plane);
        let surface = Surface { albedo, border, specular: Some(specular) };
        Scene { field: fractal(32, 1).unwrap(), surface, lights }
    }

    fn plan_of(lights: Lights, basis: Basis, phong: PhongSpecular) -> Result<Plan> {
        let scene = scene(lights, Specular::Constant(phong));
        let quality = Quality { azimuths: 8, basis, ..Quality::default() };
        let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
        plan::picture(&scene, &quality, &Limits::lavapipe(), wanted)
    }

    fn sky() -> Lights {
        Lights { sky: Some([1.0; 3]), ..Lights::default() }
    }

    fn sun() -> Lights {
        let sun =
            Sun { azimuth_rad: 0.0, elevation_rad: 0.5, diameter_rad: 0.01, irradiance: [1.0; 3] };
        Lights { suns: vec![sun], ..Lights::default() }
    }

    fn key() -> KeyLight {
        KeyLight {
            azimuth_rad: 0.0,
            width_rad: 1.0,
            elevations_rad: [0.1, 0.5],
            radiance: [1.0; 3],
        }
    }

    fn names(plan: &Plan) -> Vec<String> {
        plan.passes.iter().map(crate::graph::Pass::label).collect()
    }

    fn sphere() -> SphereLight {
        SphereLight { position_m: [1.0; 3], radius_m: 1.0, radiance: [1.0; 3] }
    }

    /// What a scene with specular of this scale gives with a setting.
    fn planned(lights: Lights, scale: f32, quality: Quality) -> Result<Plan> {
        let scene = scene(lights, Specular::Constant(PhongSpecular { exponent: 9.0, scale }));
        plan::picture(&scene, &quality, &Limits::lavapipe(), Picture::default())
    }

    /// Specular of sphere lights has no harmonics. Dark lights, or a surface without specular, raise no error.
    #[test]
    fn specular_names_the_lights_and_settings_it_rejects() {
        let base = Quality { azimuths: 8, ..Quality::default() };
        let soft = Quality { light_basis: LightBasis::Sh, ..base };
        let of = |radiance| Lights {
            sphere_lights: vec![SphereLight { radiance, ..sphere() }],
            ..sky()
        };
        let message = planned(of([1.0; 3]), 0.5, soft).unwrap_err().to_string();
        assert!(message.contains("specular under a sphere light by `light_basis sh`"), "{message}");
        assert!(planned(of([1.0; 3]), 0.5, base).is_ok());
        assert!(planned(of([1.0; 3]), 0.0, soft).is_ok());
        assert!(planned(of([0.0; 3]), 0.5, soft).is_ok());
        assert!(plan(sun(), Basis::Table, 0.5).is_ok());
    }

    /// All lights that specular reflects are part of the light that bounces: by direction as a series, to which each adds, and which the
    /// first begins; as one number a texel, without it.
    #[test]
    fn key_lights_and_sphere_lights_arrive_by_direction() {
        let lights = Lights {
            keys: vec![key(), key()],
            sphere_lights: vec![sphere(), sphere()],
            ..Lights::default()
        };
        for specular in [BounceSpecular::Vector, BounceSpecular::Scalar] {
            let bounces = Bounces { count: 2, specular, ..Bounces::default() };
            let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
            let plan = planned(lights.clone(), 0.5, quality).expect("a plan");
            let writes = |pass: &&crate::graph::Pass| {
                let place = pass.shader.bindings.iter().position(|b| b.name == "arriving");
                place.is_some_and(|i| pass.bindings[i].is_some())
            };
            let labels: Vec<String> =
                plan.passes.iter().filter(writes).map(crate::graph::Pass::label).collect();
            let direct: Vec<&str> =
                labels.iter().map(String::as_str).take_while(|l| !l.contains("exit")).collect();
            let by_direction = [
                "key_arriving key1",
                "key_arriving key2",
                "sphere_shade sphere_light1",
                "sphere_shade sphere_light2",
            ];
            match specular {
                BounceSpecular::Scalar => assert!(direct.iter().all(|l| l.contains("gather"))),
                _ => assert_eq!(direct, by_direction),
            }
        }
    }

    /// Only a sun across which the lobe varies has a light vector: n r² > 0.01.
    #[test]
    fn only_suns_that_are_wide_for_the_lobe_have_a_light_vector() {
        let has_vector = |diameter_rad: f64, exponent: f32| {
            let sun = Sun { diameter_rad, ..sun().suns[0] };
            let lights = Lights { suns: vec![sun], ..Lights::default() };
            let phong = PhongSpecular { exponent, scale: 0.5 };
            let plan = plan_of(lights, Basis::Auto, phong).expect("a plan");
            let is_read = plan.passes.iter().any(|pass| {
                let place = pass.shader.bindings.iter().position(|b| b.name == "light_vector");
                pass.name() == "sun_specular" && place.is_some_and(|i| pass.bindings[i].is_some())
            });
            assert_eq!(plan.find("light_vector").is_some(), is_read);
            is_read
        };
        for (radius_rad, exponent) in [(0.04_f64, 6.2), (0.01, 99.0), (0.0, 1e4)] {
            assert!(!has_vector(2.0 * radius_rad, exponent), "{radius_rad} {exponent}");
        }
        for (radius_rad, exponent) in [(0.04_f64, 6.3), (0.01, 101.0)] {
            assert!(has_vector(2.0 * radius_rad, exponent), "{radius_rad} {exponent}");
        }
    }

    /// A light type without specular is refused by name, and one without series is exact.
    #[test]
    fn a_light_type_says_what_supports_it() {
        static PLAIN: NearType = NearType {
            name: "plain light",
            has_specular: false,
            has_series: false,
            ..SPHERE_LIGHT
        };
        let quality = Quality { light_basis: LightBasis::Sh, ..Quality::default() };
        let settled = |of: &'static NearType, scale| {
            let lights = Lights { sphere_lights: vec![sphere()], ..Lights::default() };
            let scene = scene(lights, Specular::Constant(PhongSpecular { exponent: 9.0, scale }));
            let mut notes = Vec::new();
            let mut active =
                ActiveLights::of(&scene, &quality, Picture::default(), &mut notes).unwrap();
            active.near.active[0].of = of;
            let settled = active.light_basis(&quality, &mut notes);
            let checked = super::quality(&settled, &active, &mut notes);
            (settled.light_basis, checked.map_err(|e| e.to_string()).err(), notes)
        };
        let (basis, refused, notes) = settled(&PLAIN, 0.5);
        assert_eq!(basis, LightBasis::Exact);
        assert!(refused.is_some_and(|said| said.contains("specular under a plain light")));
        assert!(notes.iter().any(|n| n == "light_basis exact: a plain light has no series"));
        assert_eq!(settled(&PLAIN, 0.0).1, None);
        let (basis, refused, notes) = settled(&SPHERE_LIGHT, 0.0);
        assert_eq!((basis, refused), (LightBasis::Sh, None));
        assert!(notes.iter().all(|n| !n.starts_with("light_basis")), "{notes:?}");
    }

    /// The pass that computes a sphere light's diffuse light also reflects it, at all texels; the first one begins the sum. Narrow
    /// lobes need more slices around a texel: 4π √(99 + 1) = 126 instead of 64.
    #[test]
    fn sphere_lights_are_reflected_by_their_slices() {
        let lights = Lights { sphere_lights: vec![sphere(); 2], ..Lights::default() };
        let around = |exponent, scale| {
            let phong = PhongSpecular { exponent, scale };
            let plan = plan_of(lights.clone(), Basis::Auto, phong).unwrap();
            let shading = plan.passes.iter().filter(|pass| pass.name() == "sphere_shade");
            let pushed = |pass: &crate::graph::Pass, at: usize| {
                u32::from_ne_bytes(pass.push[at..at + 4].try_into().unwrap())
            };
            let begun = offset("SphereShadePush", "specular_begins");
            let count = shading.clone().filter(|&p| f32::from_bits(pushed(p, begun)) > 0.0).count();
            assert_eq!(count > 0, scale > 0.0);
            let has_specular =
                |pass: &&crate::graph::Pass| pass.constant("has_specular") == Some(1);
            let expected = if scale > 0.0 { shading.clone().count() } else { 0 };
            assert_eq!(shading.clone().filter(has_specular).count(), expected);
            let last = shading.clone().next_back().unwrap();
            assert_eq!(f32::from_bits(pushed(last, begun)), 0.0);
            pushed(last, offset("SphereShadePush", "slices_around"))
        };
        assert_eq!([around(99.0, 0.0), around(9.0, 0.5), around(99.0, 0.5)], [64, 64, 126]);
    }

    /// Lobes that a sun widens are noted: 0.2² n is 40 at exponent 1,000, and 50 at 1,250.
    #[test]
    fn a_widened_lobe_is_noted() {
        let mut lights = sun();
        lights.suns.push(Sun { diameter_rad: 0.4, ..lights.suns[0] });
        let widened = |exponent| -> Vec<String> {
            let phong = PhongSpecular { exponent, scale: 0.5 };
            let plan = plan_of(lights.clone(), Basis::Auto, phong).unwrap();
            plan.notes.into_iter().filter(|n| n.starts_with("specular of sun")).collect()
        };
        assert_eq!(widened(1_000.0), [""; 0]);
        let noted = widened(1_250.0);
        assert!(noted.len() == 1 && noted[0].contains("sun 2: exponents above 1200 "), "{noted:?}");
    }

    /// Key lights have as many azimuths as the lobe needs, up to 256, and at least their own slices. At a width of 1 radian the lobe needs
    /// 2 √(99 + 1) = 20 for exponent 99, and for 9 fewer than the 18 slices: 8 × 57.3 / 25. Horizons cut the light, not shadow heights. There are no edits.
    #[test]
    fn key_lights_have_the_azimuths_that_a_lobe_needs() {
        let planned = |exponent, scale, elevations_rad| {
            let keys = vec![KeyLight { elevations_rad, ..key() }];
            let phong = PhongSpecular { exponent, scale };
            plan_of(Lights { keys, ..Lights::default() }, Basis::Auto, phong).unwrap()
        };
        let tall = [0.1, 0.5];
        for (exponent, scale, count) in [(99.0, 0.5, 20), (9.0, 0.5, 18), (99.0, 0.0, 18)] {
            let plan = planned(exponent, scale, tall);
            assert_eq!(plan.azimuths.len(), count, "{exponent} {scale}");
            assert_eq!(plan.edit_passes.is_empty(), scale > 0.0, "{exponent} {scale}");
            let noted = plan.notes.iter().any(|n| n.starts_with("key 1: 20 slices"));
            assert_eq!(noted, count == 20, "{:?}", plan.notes);
        }
        let low = planned(99.0, 0.5, [0.1, 0.15]);
        assert!(low.passes.iter().all(|pass| pass.name() != "shadow_shade"));
        assert!(low.notes.iter().any(|n| n.contains("without shadow heights")), "{:?}", low.notes);
        let wide = KeyLight { width_rad: 3.0, ..key() };
        let lights = Lights { keys: vec![wide], ..Lights::default() };
        let phong = PhongSpecular { exponent: 10_000.0, scale: 0.5 };
        let most = plan_of(lights, Basis::Auto, phong).unwrap();
        assert_eq!(most.azimuths.len(), 256);
        // (256 / 6)² - 1 = 1819.
        assert!(most.notes.iter().any(|n| n.contains("above 1819 ")), "{:?}", most.notes);
    }

    /// A map that only the device knows may have any exponent: 2 √(10,000 + 1) = 201 azimuths of a width of 1 radian, and
    /// 4π √(10,000 + 1) = 1,257 slices around a sphere light. A map of a smaller exponent takes as many as its lobe needs.
    #[test]
    fn unknown_maps_have_the_most_azimuths() {
        let known = Specular::Map(vec![PhongSpecular { exponent: 99.0, scale: 0.5 }; 32 * 32]);
        for (specular, counts) in
            [(Specular::unknown(32 * 32, 0.5), [201, 1257]), (known, [20, 126])]
        {
            let lights =
                Lights { keys: vec![key()], sphere_lights: vec![sphere()], ..Lights::default() };
            let scene = scene(lights, specular);
            let quality = Quality { azimuths: 8, ..Quality::default() };
            let limits = Limits::lavapipe();
            let plan = plan::picture(&scene, &quality, &limits, Picture::default()).unwrap();
            let shaded = plan.passes.iter().find(|pass| pass.name() == "sphere_shade").unwrap();
            let at = offset("SphereShadePush", "slices_around");
            let around = i32::from_ne_bytes(shaded.push[at..at + 4].try_into().unwrap());
            assert_eq!([plan.azimuths.len() as i32, around], counts);
        }
    }

    /// Sky and environment use tables of the lobe, without harmonics unless they are requested. Suns need neither, nor does
    /// specular of scale 0.
    #[test]
    fn specular_uses_tables_by_azimuth() {
        let of_sky = plan(sky(), Basis::Auto, 0.5).unwrap();
        assert!(of_sky.notes.iter().any(|n| n.contains("slice of the lobe")), "{:?}", of_sky.notes);
        let all = names(&of_sky);
        for name in
            ["specular_tables", "specular_tables fine", "mirror_map swept", "specular_light"]
        {
            assert!(all.iter().any(|n| n == name), "{name}: {all:?}");
        }
        assert!(of_sky.find("visibility").is_none() && of_sky.find("fine_rows").is_none());
        let by_sh = plan(sky(), Basis::Sh, 0.5).unwrap();
        assert!(by_sh.settings.contains(&("basis".into(), "sh".into())));
        assert!(names(&by_sh).contains(&"sh_shade specular".to_owned()), "{:?}", names(&by_sh));
        let environment = Environment::new(4, 2, vec![[1.0; 3]; 8], 0.0).unwrap();
        let lit = Lights { environment: Some(environment), ..sun() };
        let of_all = plan(lit, Basis::Auto, 0.5).unwrap();
        let all = names(&of_all);
        for name in ["env_wedges", "env_wedges fine", "specular_light", "sun_specular sun1"] {
            assert!(all.iter().any(|n| n == name), "{name}: {all:?}");
        }
        assert!(of_all.find("direct.specular").is_some() && of_all.edit_passes.is_empty());
        let of_sun = plan(sun(), Basis::Auto, 0.5).unwrap();
        assert!(of_sun.find("specular_tables").is_none() && of_sun.find("specular_sum").is_some());
        let none = plan(sky(), Basis::Auto, 0.0).unwrap();
        assert!(none.notes.iter().any(|n| n.starts_with("specular dropped")), "{:?}", none.notes);
        assert!(none.find("specular_sum").is_none() && none.find("visibility").is_none());
    }

    /// With bounces, tables reflect direct light, too. Harmonics hold the light that vectors of exit radiance reflect; the
    /// radiance towards the zenith needs none.
    #[test]
    fn bounces_keep_the_tables_of_direct_specular() {
        for (specular, has_series) in [
            (BounceSpecular::Vector, true),
            (BounceSpecular::VectorF16, true),
            (BounceSpecular::Scalar, false),
        ] {
            let bounces = Bounces { count: 1, specular, ..Bounces::default() };
            let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
            let plan = planned(sky(), 0.5, quality).unwrap();
            let all = names(&plan);
            assert!(all.iter().any(|name| name == "specular_light"), "{all:?}");
            assert!(!all.iter().any(|name| name.starts_with("sh_shade")), "{all:?}");
            assert_eq!(plan.find("visibility").is_some(), has_series, "{specular:?}");
            let is_noted = plan.notes.iter().any(|n| n.starts_with("specular between bounces"));
            assert_eq!(is_noted, has_series, "{:?}", plan.notes);
        }
    }
}
