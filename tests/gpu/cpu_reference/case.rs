//! The cases of the comparison with CPU references: small fields of odd sizes, every form of every pass at least once.

use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::{
    Albedo, Directions, Environment, HeightField, KeyLight, Lights, Normals, Quality, Scatter,
    Scene, Specular, VisiblePoints,
};
use ridgelight_cpu::visible_points::visible_points;

use crate::bake::cpu_reference::towards;
use crate::{field, random};

/// The views of specular scattering.
const VIEWS: [glam::DVec3; 2] = [glam::DVec3::Z, glam::DVec3::new(0.6, 0.0, 0.8)];

pub(crate) enum Wanted {
    /// Within this memory budget.
    DevicePeak(u64),
    /// Horizons by a GPU's plan, on any device.
    GpuHorizons,
    Horizons {
        distances: bool,
    },
    Picture(Picture),
    /// A picture under suns and key lights by a GPU's plan, on any device.
    GpuPicture,
    /// Shadow heights of the scene's sun: number of parts; outer field and the place of this field in it.
    ShadowHeights(u32, Option<(HeightField, [f64; 2])>),
    /// Bounces.
    Reference(u32, Normals),
    /// Bounces; where specular is viewed from.
    ReferenceFrom(u32, Normals, [f64; 3]),
    /// Bounces; bounced light alone of so many texels.
    ReferenceAt(u32, Normals, usize),
    Points(Directions),
    Ellipses(Directions),
    Facets(Directions),
    /// Of five bases.
    CurvedEllipses(Directions, [f64; 2]),
    /// Whether images hold no more than two layers.
    Scatter(Directions, Scatter, bool),
}

pub(crate) struct Case {
    pub name: &'static str,
    pub scene: Scene,
    pub quality: Quality,
    pub wanted: Wanted,
    /// Whether some hull is deeper than its storage.
    pub loses_lines: bool,
}

impl Case {
    pub fn plan(&self, limits: &Limits) -> Plan {
        match &self.wanted {
            Wanted::DevicePeak(memory_budget) => {
                plan::device_peak(&Limits { memory_budget: *memory_budget, ..*limits })
            }
            Wanted::Horizons { distances } => plan::horizons(
                &self.scene.field,
                self.scene.surface.border,
                &self.quality,
                limits,
                (0, self.quality.azimuths),
                *distances,
            ),
            Wanted::GpuHorizons => plan::horizons(
                &self.scene.field,
                self.scene.surface.border,
                &self.quality,
                &crate::of_kind(false, *limits),
                (0, self.quality.azimuths),
                false,
            ),
            Wanted::Picture(wanted) => plan::picture(&self.scene, &self.quality, limits, *wanted),
            Wanted::GpuPicture => {
                let limits = crate::of_kind(false, *limits);
                plan::picture(&self.scene, &self.quality, &limits, Picture::default())
            }
            Wanted::ShadowHeights(parts, outer) => {
                let (field, sun) = (&self.scene.field, &self.scene.lights.suns[0]);
                let outer = outer.as_ref().map(|(field, place)| (field, *place));
                plan::shadow_heights(field, sun, outer, *parts, limits)
            }
            Wanted::Reference(bounces, normals) => {
                plan::reference(&self.scene, *bounces, *normals, None, 1, limits)
            }
            Wanted::ReferenceFrom(bounces, normals, eye_m) => {
                plan::reference(&self.scene, *bounces, *normals, Some(*eye_m), 1, limits)
            }
            Wanted::ReferenceAt(bounces, normals, count) => {
                plan::reference_at(&self.scene, *bounces, *normals, None, 1, *count, limits)
            }
            Wanted::Points(directions) => plan::visible_points(
                &self.scene.field,
                self.scene.surface.border,
                directions,
                limits,
            ),
            Wanted::Ellipses(directions) => {
                plan::ellipses(&self.scene.field, self.scene.surface.border, directions, limits)
            }
            Wanted::Facets(directions) => {
                plan::facet_mask(&self.scene.field, self.scene.surface.border, directions, limits)
            }
            Wanted::CurvedEllipses(directions, per_m) => {
                let (field, border) = (&self.scene.field, self.scene.surface.border);
                plan::curved_ellipses(field, border, directions, *per_m, limits)
            }
            Wanted::Scatter(directions, scatter, is_cut) => {
                let image_layers = if *is_cut { 2 } else { limits.image_layers };
                let limits = Limits { image_layers, ..*limits };
                match scatter.direct_specular {
                    true => plan::scatter_views(&self.scene, directions, scatter, &VIEWS, &limits),
                    false => plan::scatter(&self.scene, directions, scatter, &limits),
                }
            }
        }
        .expect("a plan")
    }

    pub fn directions(&self) -> Option<Directions> {
        match &self.wanted {
            Wanted::Points(directions)
            | Wanted::Ellipses(directions)
            | Wanted::Facets(directions)
            | Wanted::CurvedEllipses(directions, _) => Some(directions.clone()),
            Wanted::Scatter(..) => {
                let e = self.scene.lights.suns.iter().map(towards).collect();
                Directions::from_vectors(e, -1.0).ok()
            }
            _ => None,
        }
    }

    /// Texels of a list: every third from the last on, some twice.
    pub fn listed(&self) -> Option<Vec<usize>> {
        let Wanted::ReferenceAt(_, _, count) = self.wanted else { return None };
        let all = self.scene.field.heights_m().len();
        Some((1..=count).map(|i| (3 * all - 3 * i) % all).collect())
    }

    /// Visible points by the CPU reference.
    pub fn points(&self) -> Option<VisiblePoints> {
        let Wanted::Scatter(directions, ..) = &self.wanted else { return None };
        let (field, border) = (&self.scene.field, self.scene.surface.border);
        let visible = visible_points(field, border, directions);
        let points = VisiblePoints::from_points(field, border, directions.clone(), &visible);
        Some(points.expect("points of the field"))
    }

    /// Texels of the plan's inputs, in its order.
    pub fn contents(&self) -> Vec<Vec<f32>> {
        if let Wanted::Reference(..) | Wanted::ReferenceFrom(..) | Wanted::ReferenceAt(..) =
            self.wanted
        {
            let list = self.listed().map(|list| plan::listed_places(&self.scene, &list));
            let mut all = plan::reference_inputs(&self.scene);
            all.extend(list.map(|texels| texels.expect("of the field")));
            return all;
        }
        if let Wanted::Scatter(..) = self.wanted {
            let mut next = random(71);
            let grid_points = self.scene.field.heights_m().len();
            let direct: Vec<_> = (0..grid_points).map(|_| [next() as f32, 1.0, 0.2]).collect();
            let (plan, points) = (self.plan(&Limits::lavapipe()), self.points().expect("points"));
            return plan::scatter_inputs(&plan, &self.scene, &points, &direct).expect("inputs");
        }
        if let Wanted::DevicePeak(_) = self.wanted {
            return Vec::new();
        }
        let mut all = vec![self.scene.field.heights_m().to_vec()];
        if let Wanted::ShadowHeights(_, Some((outer, _))) = &self.wanted {
            // Shadows above rough ground, of ridges at all distances.
            let mut next = random(74);
            let lit: Vec<f32> = outer.heights_m().iter().map(|h| h + 9.0 * next() as f32).collect();
            let wide = lit.iter().map(|_| 4.0 * next() as f32).collect();
            all.extend([lit, wide]);
        }
        if let Wanted::Picture(_) = self.wanted {
            let four = |texels: &[[f32; 3]]| -> Vec<f32> {
                texels.iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect()
            };
            all.extend(self.scene.lights.environment.as_ref().map(|e| four(e.texels())));
            if let Albedo::Map(map) = &self.scene.surface.albedo {
                all.push(four(map));
            }
            if let Some(Specular::Map(map)) = &self.scene.surface.specular {
                all.push(map.iter().flat_map(|p| [p.exponent, p.scale, 0.0, 1.0]).collect());
            }
        }
        if let Wanted::Picture(Picture { colours_on_device: true, .. }) = self.wanted {
            let Lights { sky, suns, keys, .. } = &self.scene.lights;
            let (mut next, count) =
                (random(73), usize::from(sky.is_some()) + suns.len() + keys.len());
            all.push((0..4 * count).map(|_| 3.0 * next() as f32).collect());
        }
        all
    }
}

/// Heights over a few cells without ties, which could hide a wrong choice.
pub(crate) fn rough(rows: usize, cols: usize, seed: u64) -> HeightField {
    let mut next = random(seed);
    let noise: Vec<f64> = (0..rows * cols).map(|_| next()).collect();
    field(rows, cols, [3.0, 2.0], |r, c| 900.0 + 7.0 * noise[r * cols + c])
}

/// A paraboloid, smooth and without occlusion: rounding decides few of its bounces.
pub(crate) fn bowl(side: usize) -> HeightField {
    let middle = (side / 2) as f64;
    field(side, side, [1.0, 1.0], |r, c| {
        0.06 * ((r as f64 - middle).powi(2) + (c as f64 - middle).powi(2))
    })
}

pub(crate) fn noisy_environment(seed: u64) -> Environment {
    let mut next = random(seed);
    let texels = (0..18 * 9).map(|i| {
        let peak = if i == 40 { 30.0 } else { 0.0 };
        [next() as f32, next() as f32 + peak, 0.5]
    });
    Environment::new(18, 9, texels.collect(), 0.7).expect("an environment")
}

/// Across both axes of a field.
pub(crate) fn key(low: f64, high: f64, radiance: [f32; 3]) -> KeyLight {
    KeyLight { azimuth_rad: 2.6, width_rad: 1.7, elevations_rad: [low, high], radiance }
}
