//! Light scattered by what samples see of each other, in f64: one step of a path, and what all paths give in the mean.

use crate::light::normal;
use glam::DVec3;
use ridgelight::scene::{Albedo, Curvature, Phong, Scene, VisiblePoint, VisiblePoints};
use std::f64::consts::{PI, TAU};

/// What a sample scatters of what arrives from one direction that stands for some solid angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Radiance, R, G, B.
    pub light: [f64; 3],
    /// That of what is diffuse for a cosine of 1.
    pub facing: [f64; 3],
    /// That of the lobe in its middle.
    pub mirrored: [f64; 3],
    /// Cosine to the lobe's middle.
    pub along: f64,
}

/// Reflectances and normals of a field's samples.
pub struct Samples<'a> {
    scene: &'a Scene,
    normals: Vec<DVec3>,
}

impl<'a> Samples<'a> {
    /// Of a scene's field.
    pub fn of(scene: &'a Scene) -> Self {
        let (field, border) = (&scene.field, scene.surface.border);
        let of = |at: usize| normal(field, border, at / field.cols(), at % field.cols());
        Self { scene, normals: (0..field.rows() * field.cols()).map(of).collect() }
    }

    /// On a curved base, in each sample's own frame: at a height h over it the field is drawn apart by 1 + curvature h, its
    /// slopes are as many times less.
    #[must_use]
    pub fn on(mut self, curvature: Curvature) -> Self {
        let heights = self.scene.field.heights_m();
        for (n, height) in self.normals.iter_mut().zip(heights) {
            let [east, north] = curvature.per_m.map(|k| 1.0 + k * f64::from(*height));
            *n = DVec3::new(n.x / east, n.y / north, n.z).normalize();
        }
        self
    }

    /// A sample's.
    pub fn normal(&self, at: usize) -> DVec3 {
        self.normals[at]
    }

    /// A sample's.
    pub fn albedo(&self, at: usize) -> [f64; 3] {
        match &self.scene.surface.albedo {
            Albedo::Constant(colour) => colour.map(f64::from),
            Albedo::Map(map) => map[at].map(f64::from),
        }
    }

    /// A sample's, where there are lobes.
    pub fn lobe(&self, at: usize) -> Option<Phong> {
        self.scene.surface.phong.as_ref().map(|lobe| lobe.at(at))
    }

    /// What sample `at` scatters of `diffuse` radiance, and of `mirrored` by its lobe, that arrive along `e` from
    /// `solid_sr`, towards `back`.
    pub fn scattered(
        &self,
        at: usize,
        (e, solid_sr): (DVec3, f64),
        back: DVec3,
        [diffuse, mirrored]: [[f64; 3]; 2],
    ) -> Gathered {
        let (n, albedo) = (self.normals[at], self.albedo(at));
        let cosine = n.dot(e).max(0.0);
        let facing = [0, 1, 2].map(|c| solid_sr * albedo[c] / PI * diffuse[c]);
        let light = facing.map(|f| f * cosine);
        let mut of = Gathered { light, facing, ..Gathered::default() };
        if let Some(Phong { exponent, scale }) = self.lobe(at) {
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

/// The mean of all paths' scattered light: what the estimate tends to with their number, for a field without lobes. All
/// directions in turn at every bounce; `direct` is each sample's own light.
pub fn expected(
    scene: &Scene,
    points: &VisiblePoints,
    direct: &[[f64; 3]],
    bounces: u32,
) -> Vec<[f64; 3]> {
    let samples = Samples::of(scene);
    let share = points.directions().share_sr();
    let mut leaving = direct.to_vec();
    let mut sums = vec![[0.0; 3]; direct.len()];
    for _ in 0..bounces {
        for (at, sum) in sums.iter_mut().enumerate() {
            *sum = [0.0; 3];
            for (i, e) in points.directions().vectors().iter().enumerate() {
                if let VisiblePoint::Sample(there) = points.seen(i, at) {
                    let arrives = [leaving[there], [0.0; 3]];
                    let more = samples.scattered(at, (*e, share), DVec3::Z, arrives).light;
                    *sum = [0, 1, 2].map(|c| sum[c] + more[c]);
                }
            }
        }
        leaving =
            direct.iter().zip(&sums).map(|(own, sum)| [0, 1, 2].map(|c| own[c] + sum[c])).collect();
    }
    sums
}
