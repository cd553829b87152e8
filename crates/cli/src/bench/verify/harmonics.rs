//! Verifies light by harmonics: the device's horizons against the oracle, and the light from them
//! against the same series in f64, within f32 rounding. The error of the series itself is reported,
//! not bounded.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};
use ridgelight::Result;
use ridgelight::plan::{self, Azimuth, Nodes};
use ridgelight::scene::{Border, Quality, Receiver, Scene};
use ridgelight_cpu::harmonics::{Harmonics, Visibility};
use ridgelight_cpu::sh_shade::nodes_around;
use ridgelight_cpu::shared::field::{field_slope, normal_of};
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::sky_shade::wedge_of_sky;
use ridgelight_cpu::tolerance::{
    ARC_TANGENT, ShadeError, device_fused_slope, device_resolved, two_devices,
};

use super::{
    Device, Verifier, Wanted, albedo_of, bounds, colours, heights_m, percent, rms, sentence, within,
};

/// A place before it is lit.
pub(super) struct Place {
    pub index: usize,
    pub normal: DVec3,
    /// Slopes towards east and north.
    gradient: DVec2,
    /// Slopes of the horizons along azimuths.
    horizons: Vec<(Azimuth, f64)>,
}

impl Place {
    pub fn of(scene: &Scene, index: usize) -> Self {
        let cols = scene.field.cols();
        let heights = Heights::of(&scene.field, scene.surface.border);
        let gradient = field_slope(&heights, (index % cols) as i32, (index / cols) as i32);
        Self { index, normal: normal_of(gradient), gradient, horizons: Vec::new() }
    }

    /// Slopes of the lowest directions above the horizon, the ground and, if requested, the own
    /// plane.
    fn lowest(&self, border: Border, own_plane_hides: bool) -> Vec<(Azimuth, f64)> {
        let ground = if border == Border::Open { f64::NEG_INFINITY } else { 0.0 };
        let free = |(azimuth, horizon): &(Azimuth, f64)| {
            let towards = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
            let own = if own_plane_hides { self.gradient.dot(towards) } else { *horizon };
            (*azimuth, horizon.max(own).max(ground))
        };
        self.horizons.iter().map(free).collect()
    }

    /// Exit radiance under a sky of radiance 1.
    fn sky(&self, border: Border) -> f64 {
        let lowest = self.lowest(border, true);
        lowest.iter().map(|(azimuth, slope)| wedge_of_sky(azimuth, *slope, self.normal)).sum()
    }
}

/// Lights the piece of a verifier by harmonics. Returns a sentence with the error.
pub(super) fn check(verifier: &Verifier, device: &mut Device) -> Result<String> {
    let (Verifier { scene, ground_truth }, quality) = (verifier, device.quality);
    let border = scene.surface.border;
    let all = with_nodes(scene, &ground_truth.places, device)?;
    let (places, nodes) = all.split_at(ground_truth.places.len());
    let sky =
        rms(places.iter().zip(&ground_truth.open).map(|(place, open)| place.sky(border) - open));
    let open = rms(ground_truth.open.iter().copied());
    let [of_sky, _, of_suns, of_sphere_lights] = bounds(scene, ground_truth.dark(), quality);
    let what = "a uniform sky through the horizons";
    let (sky, sky_bound) = within(what, "the oracle", sky / open, of_sky, quality)?;

    let (_, layers) = device.layers(scene, true)?;
    let own = layers.iter().find(|p| p.name == "direct.env").expect("an environment");
    let wanted = Wanted::of(scene, quality, places, nodes);
    let what = format!("light of order {} at one place", quality.sh_order);
    let series = wanted.judge(&what, &colours(own, &ground_truth.places), quality)?;

    let [whole_means, own_means] = [&layers[0], own].map(|p| ground_truth.means(p));
    let rest = whole_means.iter().zip(&own_means).zip(&ground_truth.expected);
    let rest = rms(rest.map(|((whole, own), [sky, _, suns, sphere_lights])| {
        whole - own - sky - suns - sphere_lights
    }));
    let scales = ground_truth.scales();
    let aimed = scales[2] * of_suns + scales[3] * of_sphere_lights;
    let bound = (scales[0] * of_sky + aimed) / ground_truth.scale();
    within("other light", "the oracle", rest / ground_truth.scale(), bound, quality)?;
    Ok(format!(
        "{}, {}; including truncation at order {}, the light's error is {} against the oracle",
        sentence("sky through the horizons", "the oracle", (sky, sky_bound)),
        sentence("harmonics", "f64", series),
        quality.sh_order,
        percent(ground_truth.error(&layers[0])),
    ))
}

/// The lattice nodes of a place as places, and their weights.
fn around(heights: &Heights, quality: &Quality, index: usize) -> [(usize, f64); 4] {
    let nodes = Nodes { stride: quality.subsample };
    let at = [(index % heights.cols) as i32, (index / heights.cols) as i32];
    nodes_around(heights, nodes, at).map(|(node, weight)| {
        let col = nodes.place(node[0], heights.cols as u32) as usize;
        let row = nodes.place(node[1], heights.rows as u32) as usize;
        (row * heights.cols + col, weight)
    })
}

/// Places followed by their nodes, with the device's horizons.
pub(super) fn with_nodes(scene: &Scene, of: &[usize], device: &mut Device) -> Result<Vec<Place>> {
    let (field, border, quality) = (&scene.field, scene.surface.border, device.quality);
    let heights = Heights::of(field, border);
    let around = |p: &usize| around(&heights, quality, *p).map(|(node, _)| node);
    let nodes = match quality.subsample {
        1 => of.to_vec(),
        _ => of.iter().flat_map(around).collect::<BTreeSet<_>>().into_iter().collect(),
    };
    let mut all: Vec<Place> = of.iter().chain(&nodes).map(|p| Place::of(scene, *p)).collect();
    let limits = device.limits;
    let mut take = |k: u32, angles: &[f32], _: &[f32]| {
        let azimuth = plan::horizons(field, border, quality, limits, (k, 1), false)?.azimuths[0];
        for place in &mut all {
            // π/2 as f32 is more than π/2.
            let angle = f64::from(angles[place.index]).clamp(-FRAC_PI_2, FRAC_PI_2);
            place.horizons.push((azimuth, angle.tan()));
        }
        Ok(())
    };
    crate::horizon::for_each(device.gpu, field, border, quality, limits, false, &mut take)?;
    Ok(all)
}

impl Wanted {
    /// The environment's light at the places, from the visibility of their nodes.
    fn of(scene: &Scene, quality: &Quality, places: &[Place], nodes: &[Place]) -> Self {
        let environment = scene.lights.environment.as_ref().expect("an environment");
        let harmonics = Harmonics::of(Some(environment), None, scene.surface.border, quality);
        Self::lit(scene, quality, [places, nodes], &harmonics, |place, visibility, error| {
            let albedo = DVec3::from_array(albedo_of(scene, place.index));
            let [light, off] = harmonics.light(place.normal, visibility, error);
            let light = albedo * light;
            [light, albedo * off + light.map(|v| device_resolved(v, 1))]
        })
    }

    /// Applies `light` to the visibility at the places, interpolated from nodes whose horizons the
    /// device has found; the lattice is rebuilt from them.
    pub fn lit(
        scene: &Scene,
        quality: &Quality,
        [places, nodes]: [&[Place]; 2],
        harmonics: &Harmonics,
        light: impl Fn(&Place, &Visibility, &ShadeError) -> [DVec3; 2],
    ) -> Self {
        let (field, border) = (&scene.field, scene.surface.border);
        let [low, high] = heights_m(field);
        let cell = field.cell_m()[0].min(field.cell_m()[1]);
        // A march step is a cell or longer.
        let slope = two_devices(device_fused_slope(low.abs().max(high.abs()), cell)) + ARC_TANGENT;
        let error = ShadeError::new(slope, high - low, cell, quality.azimuths as usize);
        let own_plane_hides = quality.receiver == Receiver::Plane;
        let visibility: BTreeMap<usize, Visibility> = nodes
            .iter()
            .map(|n| (n.index, harmonics.visibility(&n.lowest(border, own_plane_hides), &error)))
            .collect();
        let shader_heights = Heights::of(field, border);
        let of = |place: &Place| {
            let visibility = if quality.subsample == 1 {
                visibility[&place.index].clone()
            } else {
                let around = around(&shader_heights, quality, place.index);
                Visibility::between(
                    around.iter().map(|(node, weight)| (&visibility[node], *weight)),
                    &error,
                )
            };
            light(place, &visibility, &error)
        };
        Self(places.iter().map(of).collect())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use ridgelight::plan::Limits;
    use ridgelight::scene::{Basis, Environment, Lights, Wedges, Window};

    /// A sunlit sky: 60 times brighter in the sun's texels.
    pub fn scene() -> Scene {
        let texel = |i: usize| {
            let sun =
                if (5..7).contains(&(i / 32)) && (9..11).contains(&(i % 32)) { 60.0 } else { 0.0 };
            [1.0 + sun, 0.8 + 0.9 * sun, 0.5 + (i % 7) as f32 / 10.0 + 0.7 * sun]
        };
        let environment = Environment::new(32, 16, (0..32 * 16).map(texel).collect(), 0.4).unwrap();
        let lights = Lights { environment: Some(environment), ..Lights::default() };
        crate::bench::verify::tests::scene(64, lights)
    }

    /// Some places with the oracle's horizons.
    pub fn places(scene: &Scene, quality: &Quality) -> Vec<Place> {
        let (field, border) = (&scene.field, scene.surface.border);
        let oracle = ridgelight_cpu::oracle::Oracle::new(field, border);
        let limits = Limits::lavapipe();
        let all = (0, quality.azimuths);
        let azimuths =
            plan::horizons(field, border, quality, &limits, all, false).unwrap().azimuths;
        let towards = |index: usize, a: &Azimuth| {
            let phi = f64::from(a.sin_phi).atan2(a.cos_phi.into());
            (*a, oracle.elevation_rad(index / 64, index % 64, phi).tan())
        };
        let of = |index: usize| {
            let horizons = azimuths.iter().map(|a| towards(index, a)).collect();
            Place { horizons, ..Place::of(scene, index) }
        };
        (7..64 * 64).step_by(397).map(of).collect()
    }

    /// Wrong light is refused for every order and form: of the next order, of the other receiver,
    /// without shadows.
    #[test]
    fn wrong_harmonics_are_refused() {
        let scene = scene();
        let base = Quality { basis: Basis::Sh, azimuths: 16, ..Quality::default() };
        let known = places(&scene, &base);
        let free = |p: &Place| {
            let horizons = p.horizons.iter().map(|(a, _)| (*a, -1e9)).collect();
            Place { horizons, ..Place::of(&scene, p.index) }
        };
        let free: Vec<Place> = known.iter().map(free).collect();
        for sh_order in 2..=6 {
            for (wedges, receiver, window) in [
                (Wedges::Slices, Receiver::Plane, Window::None),
                (Wedges::Nlp, Receiver::Plane, Window::Lanczos),
                (Wedges::Slices, Receiver::Cosine, Window::Hann),
                (Wedges::Nlp, Receiver::Cosine, Window::Nonnegative),
                (Wedges::Table, Receiver::Plane, Window::None),
            ] {
                let quality = Quality { sh_order, wedges, receiver, window, ..base };
                let of = |quality: &Quality, places: &[Place]| {
                    Wanted::of(&scene, quality, places, places)
                };
                let other = match receiver {
                    Receiver::Plane => Receiver::Cosine,
                    Receiver::Cosine => Receiver::Plane,
                };
                let next = if sh_order == 6 { 5 } else { sh_order + 1 };
                let wrong = [
                    ("order", of(&Quality { sh_order: next, ..quality }, &known).light()),
                    ("receiver", of(&Quality { receiver: other, ..quality }, &known).light()),
                    ("without shadows", of(&quality, &free).light()),
                ];
                // f32 cancellation of the fits' weights, 60 and 100 times their light.
                let most = if sh_order > 4 { [0.05, 0.9] } else { [0.01, 0.98] };
                of(&quality, &known).refuses(&quality, most, &wrong);
            }
        }
    }
}
