//! Visibility of a flat field on curved base surfaces (Heidrich et al. 2000, §5), against real
//! geometry.
//!
//! Three grooves of 16 by 8 cells, walls of 45°, are bent across their length into a cylinder, outwards
//! and inwards, as a mesh that rays intersect. Compared are visible points of the flat field, unchanged
//! and adapted to the curvature. Shadows: 200 lights of each grid point's own hemisphere. Scattered
//! light: walls that face east emit, all walls scatter it, once and up to three times.

#[path = "../../../../tests/common/bent_light.rs"]
mod light;
#[path = "../../../../tests/common/bent_mesh.rs"]
mod mesh;
mod report;

use glam::DVec3;
use light::{ALBEDO, BOUNCES, BentDirections, RAYS};
use mesh::Mesh;
use report::{Row, Scattered, picture, table};
use ridgelight::Result;
use ridgelight::basis::triangles::Triangles;
use ridgelight::gpu::Headless;
use ridgelight::scene::{
    Border, Curvature, Directions, Lights, Scatter, Scene, VisiblePoint, VisiblePoints,
};
use ridgelight_bake::CurvedEllipses;
use ridgelight_cpu::bent_directions::{Draped, Fans};
use ridgelight_cpu::ellipse_fit::{Ellipse, fit, sky_directions};
use ridgelight_cpu::fan_weights::weight;

use crate::bake::light::five_ellipses;
use crate::common::args::Args;
use crate::common::frames::{device, error_of};
use crate::common::{Outcome, inputs, plot};

const LIGHTS: usize = 200;
const DIRECTIONS: usize = 1024;
/// Of the device's light that has been scattered several times.
const PATHS: u32 = 1024;
const PERIOD: usize = 16;
const GROOVES: usize = 3;
const ROWS: usize = 33;
/// Compared rows: all rows are alike but for the grooves' ends.
const COMPARED: [usize; 3] = [8, 16, 24];
const RADII: [f64; 9] = [100.0, 70.0, 50.0, 35.0, 25.0, 18.0, 12.0, 8.0, 5.0];
/// Where four of five ellipses are fitted, outwards and inwards, 1/m.
const STEPS: [f64; 2] = [1.0 / 25.0, 1.0 / 100.0];
/// No ray within a groove leaves by its end; it would leave the field.
const BORDER: Border = Border::Open;

/// What is the same on every base.
struct Flat {
    scene: Scene,
    points: VisiblePoints,
    fans: Fans,
    net: Triangles,
    lights: Directions,
    five: Vec<[Ellipse; 5]>,
    emitted: Vec<f64>,
    /// The compared grid points, in the order of everything below.
    all: Vec<usize>,
    /// The sum of path-traced scattered light.
    scattered: [f64; 2],
}

impl Flat {
    fn of(gpu: &mut Headless) -> Result<Self> {
        let cols = GROOVES * PERIOD + 1;
        let field = inputs::field(ROWS, cols, |_, c| (c % PERIOD).abs_diff(PERIOD / 2) as f64)?;
        let limits = gpu.report().limits;
        let directions = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
        let points = gpu.visible_points((&field, BORDER), &directions, &limits)?;
        let net = directions.triangles()?;
        let all: Vec<usize> =
            COMPARED.iter().flat_map(|row| row * cols..(row + 1) * cols).collect();
        let level = light::path_traced(&Mesh::bent(&field, 0.0), &field, &all)?;
        Ok(Self {
            points,
            fans: Fans::of(&net, directions.vectors()),
            net,
            lights: Directions::fibonacci(LIGHTS, 0.0, 7)?,
            five: five_ellipses(gpu, &field, BORDER, &directions, STEPS)?,
            emitted: (0..ROWS * cols).map(|at| light::emitted(at % cols, PERIOD)).collect(),
            all,
            scattered: [0, 1].map(|k| level.iter().map(|light| light[k]).sum()),
            scene: Scene {
                field,
                surface: inputs::matte([ALBEDO as f32; 3], BORDER),
                lights: Lights::default(),
            },
        })
    }

    /// The lights that arrive at compared grid points, by rays against the mesh.
    fn lit(&self, mesh: &Mesh) -> Vec<Vec<bool>> {
        let of = |at: &usize| {
            let arrives = |l: &DVec3| mesh.met(mesh.over(*at), mesh.frames[*at].out(*l)).is_none();
            self.lights.vectors().iter().map(arrives).collect()
        };
        self.all.iter().map(of).collect()
    }

    /// Share of lights for which a test of the index of a compared grid point is wrong, percent.
    fn wrong(&self, lit: &[Vec<bool>], holds: impl Fn(usize, DVec3) -> bool) -> f64 {
        let lights = self.lights.vectors();
        let of = |(n, lit): (usize, &Vec<bool>)| {
            lights.iter().zip(lit).filter(|(light, lit)| holds(n, **light) != **lit).count()
        };
        let wrong: usize = lit.iter().enumerate().map(of).sum();
        100.0 * wrong as f64 / (lit.len() * lights.len()) as f64
    }

    /// By the triangles of these directions, cut at a half; the nearest direction where no triangle
    /// holds a light.
    fn by_directions(&self, draped: &Draped, bent: &[DVec3], at: usize, light: DVec3) -> bool {
        let share = draped.lit_share(&self.net, bent, at, light).unwrap_or_else(|| {
            let near = |i: &usize| bent[*i].dot(light);
            let above = (0..DIRECTIONS).filter(|i| bent[*i].z > 0.0);
            let nearest = above.max_by(|a, b| near(a).total_cmp(&near(b)));
            let is_sky = nearest.is_some_and(|i| self.points.point(i, at) == VisiblePoint::Sky);
            f64::from(u8::from(is_sky))
        });
        share >= 0.5
    }

    /// The device's light; once scattered light is by each direction in turn, without noise.
    fn by_device(
        &self,
        gpu: &mut Headless,
        curvature: Curvature,
        bounces: usize,
    ) -> Result<Vec<f64>> {
        let paths = if bounces == 1 { DIRECTIONS as u32 } else { PATHS };
        let bounces = bounces as u32;
        let scatter = Scatter { bounces, paths, curvature, cutoff: 0.0, ..Scatter::default() };
        let direct: Vec<[f32; 3]> = self.emitted.iter().map(|own| [*own as f32; 3]).collect();
        let limits = gpu.report().limits;
        let light = gpu.scattered(&self.scene, &self.points, &direct, &scatter, &limits)?;
        Ok(self.all.iter().map(|at| f64::from(light[*at][0])).collect())
    }

    fn row(&self, gpu: &mut Headless, per_m: f64) -> Result<Row> {
        let Self { points, fans, all, five, .. } = self;
        let field = &self.scene.field;
        let curvature = Curvature { per_m: [per_m, 0.0] };
        let refused = curvature.check(field, BORDER).err().map(|error| error.to_string());
        let mesh = Mesh::bent(field, per_m);
        let lit = self.lit(&mesh);
        let draped = |curvature| Draped { field, border: BORDER, points, fans, curvature };
        let (unchanged, adapted) = (draped(Curvature::FLAT), draped(curvature));
        let vectors = points.directions().vectors();
        let grid_points = 0..field.heights_m().len();
        let bent: Vec<Vec<DVec3>> = grid_points.map(|at| adapted.bent(at)).collect();
        let fitted: Vec<Ellipse> =
            all.iter().map(|at| fit(&sky_directions(points, &bent[*at], *at)).0).collect();
        let between: Vec<CurvedEllipses> =
            all.iter().map(|at| CurvedEllipses::of(&five[*at], STEPS)).collect();
        let shadows = [
            self.wrong(&lit, |n, l| self.by_directions(&unchanged, vectors, all[n], l)),
            self.wrong(&lit, |n, l| self.by_directions(&adapted, &bent[all[n]], all[n], l)),
            self.wrong(&lit, |n, l| five[all[n]][0].holds(l)),
            self.wrong(&lit, |n, l| between[n].holds(curvature, l)),
            self.wrong(&lit, |n, l| fitted[n].holds(l)),
        ];
        // The CPU reference, which refuses nothing; the device where it does not refuse.
        let weigh = |bent: &Vec<DVec3>| (0..DIRECTIONS).map(|i| weight(fans, bent, i)).collect();
        let weights = Some(bent.iter().map(weigh).collect());
        let on_cpu = |curvature: Curvature, directions: &BentDirections| {
            let found = light::scattered(&self.scene, points, curvature, directions, &self.emitted);
            found.map(|light| all.iter().map(|at| light[*at]).collect::<Vec<f64>>())
        };
        let flat = BentDirections { bent: vec![vectors.to_vec(); bent.len()], weights: None };
        let rotated = BentDirections { bent, weights: None };
        let kinds = [on_cpu(Curvature::FLAT, &flat), on_cpu(curvature, &rotated)];
        let reweighted = on_cpu(curvature, &BentDirections { weights, ..rotated });
        let reference = light::path_traced(&mesh, field, all)?;
        let reference = [0, 1].map(|k| reference.iter().map(|l| l[k]).collect::<Vec<f64>>());
        let mut device = None;
        if refused.is_none() {
            for (k, bounces) in BOUNCES.into_iter().enumerate() {
                let found = self.by_device(gpu, curvature, bounces)?;
                let error = error_of(&found, &reweighted[k])?;
                assert!(
                    bounces > 1 || error < 0.1,
                    "the device differs by {error} % from its CPU reference"
                );
                device = Some(error_of(&found, &reference[k])?);
            }
        }
        let scattered = |k: usize| -> Result<Scattered> {
            let [flat, rotated] = kinds.each_ref().map(|found| error_of(&found[k], &reference[k]));
            Ok(Scattered {
                over_flat: reference[k].iter().sum::<f64>() / self.scattered[k],
                errors: [flat?, rotated?, error_of(&reweighted[k], &reference[k])?],
                reference: reference[k].clone(),
                reweighted: reweighted[k].clone(),
            })
        };
        let count = lit.iter().flatten().filter(|lit| **lit).count();
        Ok(Row {
            curvature: per_m,
            lit: 100.0 * count as f64 / (all.len() * LIGHTS) as f64,
            shadows,
            light: [scattered(0)?, scattered(1)?],
            device,
            changed: curvature.occlusion_change(field, BORDER),
            refused,
        })
    }
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.path("-o")?;
    let mut gpu = args.open()?;
    let flat = Flat::of(&mut gpu)?;
    println!(
        "{}\n\n{GROOVES} grooves of {PERIOD} by {} cells, {ROWS} long; {DIRECTIONS} directions over the sphere, {LIGHTS} lights over each \
         grid point's hemisphere, {RAYS} rays. A radius above 0: valleys widen. Predicted: about the shares of a hemisphere's lights \
         and light that change by the base, of light at most {} % (`Curvature::MAX_CHANGE`); beyond, the rows are those of the CPU \
         reference, as the renderer refuses. Five: fitted at radii of {} outwards and {} inwards. Error: relative RMSE; between three: \
         light of these and the flat base, linear as ellipses are; device: {PATHS} paths.\n",
        device(&gpu),
        PERIOD / 2,
        100.0 * Curvature::MAX_CHANGE,
        1.0 / STEPS[0],
        1.0 / STEPS[1]
    );
    let outwards = RADII.iter().rev().map(|r| 1.0 / r);
    let inwards = RADII.iter().map(|r| -1.0 / r);
    let all = outwards.chain([0.0]).chain(inwards);
    let rows = all.map(|curvature| flat.row(&mut gpu, curvature)).collect::<Result<Vec<_>>>()?;
    table(&rows)?;
    println!();
    for row in &rows {
        if let Some(reason) = &row.refused {
            println!("radius {:+.0}: {reason}", 1.0 / row.curvature);
        }
    }
    Ok(plot::write(output.as_deref(), &picture(&rows))?)
}
