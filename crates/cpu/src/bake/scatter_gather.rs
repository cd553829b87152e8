//! Light scattered between mutually visible grid points, in f64: one step of a path, and the mean over all paths.

use crate::Rgb;
use crate::light::{albedo_at, normal};
use glam::DVec3;
use ridgelight::scene::{Curvature, PhongSpecular, Scene, VisiblePoint, VisiblePoints};
use std::f64::consts::{PI, TAU};

/// Scattered light of one grid point, from one incident direction with a solid angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Radiance, R, G, B.
    pub light: Rgb,
    /// The diffuse radiance for a cosine of 1.
    pub facing: Rgb,
    /// The Phong specular radiance at its peak.
    pub mirrored: Rgb,
    /// Cosine to the Phong lobe's axis.
    pub along: f64,
}

/// Reflectances and normals of a field's grid points.
pub struct GridPoints<'a> {
    scene: &'a Scene,
    normals: Vec<DVec3>,
}

impl<'a> GridPoints<'a> {
    /// Of a scene's field.
    pub fn of(scene: &'a Scene) -> Self {
        let (field, border) = (&scene.field, scene.surface.border);
        let of = |at: usize| normal(field, border, at / field.cols(), at % field.cols());
        Self { scene, normals: (0..field.rows() * field.cols()).map(of).collect() }
    }

    /// On a curved base surface, in each grid point's own frame: a field at a height h over it is widened by 1 +
    /// curvature h, and its slopes are reduced by the same factor.
    #[must_use]
    pub fn on(mut self, curvature: Curvature) -> Self {
        let heights = self.scene.field.heights_m();
        for (n, height) in self.normals.iter_mut().zip(heights) {
            let [east, north] = curvature.per_m.map(|k| 1.0 + k * f64::from(*height));
            *n = DVec3::new(n.x / east, n.y / north, n.z).normalize();
        }
        self
    }

    /// Of a grid point.
    pub fn normal(&self, at: usize) -> DVec3 {
        self.normals[at]
    }

    /// Of a grid point.
    pub fn albedo(&self, at: usize) -> Rgb {
        albedo_at(&self.scene.surface, at)
    }

    /// Of a grid point, where there is Phong specular.
    pub fn specular(&self, at: usize) -> Option<PhongSpecular> {
        self.scene.surface.specular.as_ref().map(|specular| specular.at(at))
    }

    /// Light scattered by grid point `at` towards `back`, from `diffuse` radiance and specular radiance `mirrored`
    /// that arrive along `e` from `solid_sr`.
    pub fn scattered(
        &self,
        at: usize,
        (e, solid_sr): (DVec3, f64),
        back: DVec3,
        [diffuse, mirrored]: [Rgb; 2],
    ) -> Gathered {
        let (n, albedo) = (self.normals[at], self.albedo(at));
        let cosine = n.dot(e).max(0.0);
        let facing = [0, 1, 2].map(|c| solid_sr * albedo[c] / PI * diffuse[c]);
        let light = facing.map(|f| f * cosine);
        let mut of = Gathered { light, facing, ..Gathered::default() };
        if let Some(PhongSpecular { exponent, scale }) = self.specular(at) {
            let (exponent, scale) = (f64::from(exponent), f64::from(scale));
            let mirror = 2.0 * n.dot(back) * n - back;
            let middle = scale * (exponent + 1.0) / TAU;
            of.mirrored = mirrored.map(|m| solid_sr * middle * m);
            of.along = mirror.dot(e);
            if cosine > 0.0 && of.along > 0.0 {
                let power = of.along.min(1.0).powf(exponent);
                of.light = [0, 1, 2].map(|c| of.light[c] + of.mirrored[c] * power);
            }
        }
        of
    }
}

/// The mean of all paths' scattered light, for a field without Phong specular: the limit of the estimate. Every
/// bounce sums over all directions; `direct` is each grid point's own light.
pub fn expected(scene: &Scene, points: &VisiblePoints, direct: &[Rgb], bounces: u32) -> Vec<Rgb> {
    let grid_points = GridPoints::of(scene);
    let share = points.directions().share_sr();
    let mut leaving = direct.to_vec();
    let mut sums = vec![[0.0; 3]; direct.len()];
    for _ in 0..bounces {
        for (at, sum) in sums.iter_mut().enumerate() {
            *sum = [0.0; 3];
            for (i, e) in points.directions().vectors().iter().enumerate() {
                if let VisiblePoint::GridPoint(there) = points.point(i, at) {
                    let arrives = [leaving[there], [0.0; 3]];
                    let more = grid_points.scattered(at, (*e, share), DVec3::Z, arrives).light;
                    *sum = [0, 1, 2].map(|c| sum[c] + more[c]);
                }
            }
        }
        leaving =
            direct.iter().zip(&sums).map(|(own, sum)| [0, 1, 2].map(|c| own[c] + sum[c])).collect();
    }
    sums
}
