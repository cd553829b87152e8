//! Maps of directions, and of light.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{
    Border, Directions, HeightField, Lights, Quality, Scatter, Scene, Sun, VisiblePoint,
};
use ridgelight_bake as bake;
use ridgelight_bake::{Angles, Brdf, BrdfHarmonics, CurvedEllipses, Ellipse, Factors};

use super::Baked;
use crate::common::frames::{colours, to_f32, with_picture};
use crate::common::inputs;

const DIRECTIONS: usize = 64;
/// Points are whole numbers whatever the direction.
const POINTS: usize = 8;
/// Of radii of 100 and 400 km.
const CURVATURES: [f64; 2] = [1e-5, 2.5e-6];
const ANGLES: Angles = Angles { zeniths: 3, azimuths: 8 };
/// As `bake --what brdf-factors` keeps.
const FACTORS: usize = 8;
/// Of harmonics, as many as 3 × 8 angles can tell apart.
const ORDER: usize = 4;

/// Texels of all outputs of a plan whose one input are a field's heights.
fn outputs(gpu: &mut Headless, plan: Plan, field: &HeightField) -> Result<Vec<Vec<f32>>> {
    let count = plan.outputs().count();
    gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        (0..count).map(|output| Ok(gpu.pixels(frame, output)?.values)).collect()
    })
}

/// Five ellipses of each grid point.
pub fn five_ellipses(
    gpu: &mut Headless,
    field: &HeightField,
    border: Border,
    directions: &Directions,
    steps: [f64; 2],
) -> Result<Vec<[Ellipse; 5]>> {
    let plan = plan::curved_ellipses(field, border, directions, steps, &gpu.report().limits)?;
    let images = outputs(gpu, plan, field)?;
    let texel = |image: usize, at: usize| [0, 1, 2, 3].map(|p| images[image][4 * at + p]);
    let ellipse = |k: usize, at: usize| {
        let [along, across, ..] = texel(2 * k + 1, at);
        Ellipse::of_texels(texel(2 * k, at), [along, across])
    };
    let count = field.heights_m().len();
    Ok((0..count).map(|at| [0, 1, 2, 3, 4].map(|k| ellipse(k, at))).collect())
}

/// Ellipses, those of curved bases, visible points.
pub fn of_directions(gpu: &mut Headless, field: &HeightField) -> Result<Vec<Baked>> {
    let (limits, border) = (gpu.report().limits, Border::Plane);
    let above = Directions::fibonacci(DIRECTIONS, 0.0, 0)?;
    let ellipses = outputs(gpu, plan::ellipses(field, border, &above, &limits)?, field)?;
    let part = |image: &[f32], part: usize| image.chunks_exact(4).map(|t| t[part]).collect();
    let mut planes: Vec<Vec<f32>> = [0, 1, 2, 3].map(|p| part(&ellipses[0], p)).into();
    planes.extend([0, 1].map(|p| part(&ellipses[1], p)));
    let ellipse = Baked::of("ellipse", "ellipse", "a sample", &bake::ELLIPSE, planes);

    let around = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let five = five_ellipses(gpu, field, border, &around, CURVATURES)?;
    let all: Vec<_> =
        five.iter().map(|five| CurvedEllipses::of(five, CURVATURES).numbers).collect();
    let plane = |base: usize, number: usize| -> Vec<f32> {
        all.iter().map(|five| five[base][number] as f32).collect()
    };
    let mut planes: Vec<Vec<f32>> = (0..20).map(|i| plane(i / 4, i % 4)).collect();
    planes.extend([0, 1, 2, 3, 4].map(|base| plane(base, 4)));
    let curved =
        Baked::of("curved-ellipse", "five ellipses", "a sample", &bake::CURVED_ELLIPSE, planes);

    let few = Directions::fibonacci(POINTS, -1.0, 0)?;
    let points = gpu.visible_points((field, border), &few, &limits)?;
    let seen = |i: usize, at: usize| match points.point(i / 2, at) {
        VisiblePoint::GridPoint(seen) => [seen / field.cols(), seen % field.cols()][i % 2] as f32,
        VisiblePoint::Sky => -1.0,
        VisiblePoint::Ground => -2.0,
    };
    let plane = |i: usize| (0..field.heights_m().len()).map(|at| seen(i, at)).collect();
    let planes = (0..2 * POINTS).map(plane).collect();
    let points = Baked::of("visible-points", "row, column", "a direction", &bake::POINTS, planes);
    Ok(vec![ellipse, curved, points])
}

/// A plane each of red, green and blue.
fn planes_of<T: Copy + Into<f64>>(all: &[[T; 3]]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|c| all.iter().map(|t| t[c].into() as f32).collect())
}

/// Under a sky and a sun: scattered light, a table of what is reflected, its factors, pictures of all pairs and views.
pub fn lit(gpu: &mut Headless, field: HeightField) -> Result<Vec<Baked>> {
    let limits = gpu.report().limits;
    let sun = Sun {
        azimuth_rad: 1.2,
        elevation_rad: 0.6,
        diameter_rad: 0.01,
        irradiance: [3.0, 2.8, 2.4],
    };
    let lights = Lights { sky: Some([0.3, 0.4, 0.6]), suns: vec![sun], ..Lights::default() };
    let surface = inputs::matte([0.6, 0.5, 0.3], Border::Periodic);
    let scene = Scene { field, surface, lights };
    let still = Picture { still: true, ..Picture::default() };
    let direct = with_picture(gpu, &scene, &Quality::default(), still, |gpu, frame| {
        gpu.draw(frame)?;
        Ok(colours(&gpu.pixels(frame, 0)?))
    })?;
    let mut light = to_f32(&direct);
    let around = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let points = gpu.visible_points((&scene.field, scene.surface.border), &around, &limits)?;
    let scatter = Scatter { paths: 64, ..Scatter::default() };
    let more = gpu.scattered(&scene, &points, &light, &scatter, &limits)?;
    light.as_flattened_mut().iter_mut().zip(more.as_flattened()).for_each(|(l, m)| *l += m);
    let planes = planes_of(&light).into();
    let scattered = Baked::of("scatter", "radiance, error", "a layer", &bake::RADIANCE, planes);

    let directions = ANGLES.directions()?;
    let facets = bake::facets(gpu, &scene, 1, &directions, &limits)?;
    facets.check()?;
    let (mut values, mut pictures) = (Vec::new(), Vec::new());
    bake::lit_from(
        gpu,
        &scene,
        (&facets, 0..ANGLES.count(), &(|_| 0_usize..0) as &dyn Fn(usize) -> _),
        None,
        &limits,
        &mut |i, radiance| {
            let z = directions.vectors()[i].z;
            values
                .extend(facets.radiance_from_all(&radiance).into_iter().map(|m| m.map(|v| v / z)));
            for texels in facets.texels_from_all(&radiance) {
                pictures.extend(
                    [0, 1, 2, 3]
                        .map(|c| -> Vec<f32> { texels.iter().map(|t| t[c] as f32).collect() }),
                );
            }
            Ok(())
        },
    )?;
    let of_lit = |view: usize| {
        let share = &pictures[4 * view + 3];
        let shown = |c: usize| {
            let texels = light.iter().zip(share);
            texels.map(|(l, s)| if *s > 0.0 { l[c] } else { 0.0 }).collect()
        };
        [shown(0), shown(1), shown(2), share.clone()]
    };
    let field = (0..ANGLES.count()).flat_map(of_lit).collect();
    let table = Brdf::from_values(directions.vectors().to_vec(), values.clone())?;
    let factors = Factors::of(&table, ANGLES, FACTORS, false)?;
    let of_factors = factors.values().iter().flat_map(|of_k| planes_of(of_k)).collect();
    let harmonics = BrdfHarmonics::of(&table, ANGLES, ORDER, false)?;
    let of_harmonics = planes_of(harmonics.coefficients()).into();
    let reflected = &bake::REFLECTED;
    Ok(vec![
        scattered,
        Baked::of("brdf", "R, G, B", "a pair of angles", reflected, planes_of(&values).into()),
        Baked::of("brdf-factors", "R, G, B", "an angle and factor", reflected, of_factors),
        Baked::of(
            "brdf-harmonics",
            "R, G, B",
            "a pair of harmonics",
            &bake::HARMONIC_WEIGHTS,
            of_harmonics,
        ),
        Baked::of("btf", "R, G, B, share", "a sample and pair", &bake::TEXELS, pictures),
        Baked::of("light-field", "R, G, B, share", "a sample and view", &bake::TEXELS, field),
    ])
}
