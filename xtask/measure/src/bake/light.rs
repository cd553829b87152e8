//! Maps of directions, and of light.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Plan};
use ridgelight::scene::{
    Border, Directions, HeightField, Lights, Quality, Scatter, Scene, Sun, VisiblePoint,
    VisiblePoints,
};
use ridgelight_bake as bake;
use ridgelight_bake::{
    Angles, Brdf, BrdfHarmonics, CurvedEllipses, Ellipse, ExitRadiance, Facets, Factors,
};

use super::Baked;
use crate::common::frames::{drawn, to_f32};
use crate::common::inputs;

const DIRECTIONS: usize = 64;
/// Points are whole numbers, whatever the direction.
const POINTS: usize = 8;
/// Of radii of 100 and 400 km.
const CURVATURES: [f64; 2] = [1e-5, 2.5e-6];
const ANGLES: Angles = Angles { zeniths: 3, azimuths: 8 };
/// As `bake --what brdf-factors` keeps.
const FACTORS: usize = 8;
/// As many harmonics as 3 × 8 angles can distinguish.
const ORDER: usize = 4;

/// Texels of all outputs of a plan whose only input is a field's heights.
pub fn outputs(gpu: &mut Headless, plan: Plan, field: &HeightField) -> Result<Vec<Vec<f32>>> {
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

/// Radiance of all triangles under each of the first `lights` in turn. Diffuse ground: no views.
pub fn lit_from_each(
    gpu: &mut Headless,
    scene: &Scene,
    (facets, lights): (&Facets, usize),
    scatter: Option<(&VisiblePoints, &Scatter)>,
    mut take: impl FnMut(usize, &ExitRadiance),
) -> Result<()> {
    let limits = gpu.report().limits;
    let of = (facets, 0..lights, &(|_| 0_usize..0) as &dyn Fn(usize) -> _);
    bake::lit_from(gpu, scene, of, scatter, &limits, &mut |light, radiance| {
        take(light, &radiance);
        Ok(())
    })
}

/// Ellipses, those of curved bases, visible points.
pub fn of_directions(gpu: &mut Headless, field: &HeightField) -> Result<Vec<Baked>> {
    let (limits, border) = (gpu.report().limits, Border::Plane);
    let above = Directions::fibonacci(DIRECTIONS, 0.0, 0)?;
    let ellipses = outputs(gpu, plan::ellipses(field, border, &above, &limits)?, field)?;
    let part = |image: usize, part: usize| {
        ellipses[image].chunks_exact(4).map(move |t| t[part]).collect::<Vec<f32>>()
    };
    let planes = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 1)].map(|(i, p)| part(i, p));
    let ellipse = Baked::of("ellipse", "ellipse", "a texel", &bake::ELLIPSE, planes.into());

    let around = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let five = five_ellipses(gpu, field, border, &around, CURVATURES)?;
    let all: Vec<_> =
        five.iter().map(|five| CurvedEllipses::of(five, CURVATURES).numbers).collect();
    // Four numbers of each base, then the fifth of each.
    let of = |i: usize| if i < 20 { (i / 4, i % 4) } else { (i - 20, 4) };
    let plane = |(base, number): (usize, usize)| -> Vec<f32> {
        all.iter().map(|five| five[base][number] as f32).collect()
    };
    let planes = (0..25).map(|i| plane(of(i))).collect();
    let curved =
        Baked::of("curved-ellipse", "five ellipses", "a texel", &bake::CURVED_ELLIPSE, planes);

    let few = Directions::fibonacci(POINTS, -1.0, 0)?;
    let points = gpu.visible_points((field, border), &few, &limits)?;
    let place = |i: usize, at: usize| match points.point(i / 2, at) {
        VisiblePoint::GridPoint(there) => {
            [there / field.cols(), there % field.cols()][i % 2] as f32
        }
        VisiblePoint::Sky => -1.0,
        VisiblePoint::Ground => -2.0,
    };
    let plane = |i: usize| (0..field.heights_m().len()).map(|at| place(i, at)).collect();
    let planes = (0..2 * POINTS).map(plane).collect();
    let points = Baked::of("visible-points", "row, column", "a direction", &bake::POINTS, planes);
    Ok(vec![ellipse, curved, points])
}

/// One plane each of red, green and blue.
fn planes_of<T: Copy + Into<f64>>(all: &[[T; 3]]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|c| all.iter().map(|t| t[c].into() as f32).collect())
}

/// Under a sky and a sun: scattered light, a table of reflected light, its factors and harmonics,
/// pictures of all pairs and views.
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
    let mut light = to_f32(&drawn(gpu, &scene, &Quality::default(), 0)?.light);
    let around = Directions::fibonacci(DIRECTIONS, -1.0, 0)?;
    let points = gpu.visible_points((&scene.field, scene.surface.border), &around, &limits)?;
    let scatter = Scatter { paths: 64, ..Scatter::default() };
    let more = gpu.scattered(&scene, &points, &light, &scatter, &limits)?;
    light.as_flattened_mut().iter_mut().zip(more.as_flattened()).for_each(|(l, m)| *l += m);

    let directions = ANGLES.directions()?;
    let facets = bake::facets(gpu, &scene, 1, &directions, &limits)?;
    facets.check()?;
    let (mut values, mut pictures) = (Vec::new(), Vec::new());
    lit_from_each(gpu, &scene, (&facets, ANGLES.count()), None, |i, radiance| {
        let z = directions.vectors()[i].z;
        values.extend(facets.radiance_from_all(radiance).into_iter().map(|m| m.map(|v| v / z)));
        for texels in facets.texels_from_all(radiance) {
            let plane = |c: usize| texels.iter().map(|t| t[c] as f32).collect::<Vec<f32>>();
            pictures.extend([0, 1, 2, 3].map(plane));
        }
    })?;
    let of_view = |view: usize| {
        let share = &pictures[4 * view + 3];
        let plane = |c: usize| {
            let texels = light.iter().zip(share);
            texels.map(|(l, s)| if *s > 0.0 { l[c] } else { 0.0 }).collect()
        };
        [plane(0), plane(1), plane(2), share.clone()]
    };
    let field = (0..ANGLES.count()).flat_map(of_view).collect();
    let table = Brdf::from_values(directions.vectors().to_vec(), values.clone())?;
    let factors = Factors::of(&table, ANGLES, FACTORS, false)?;
    let factors = factors.values().iter().flat_map(|of_k| planes_of(of_k)).collect();
    let harmonics = BrdfHarmonics::of(&table, ANGLES, ORDER, false)?;
    let harmonics = planes_of(harmonics.coefficients()).into();
    let (reflected, weights) = (&bake::REFLECTED, &bake::HARMONIC_WEIGHTS);
    let (scattered, values) = (planes_of(&light).into(), planes_of(&values).into());
    Ok(vec![
        Baked::of("scatter", "radiance, error", "a layer", &bake::RADIANCE, scattered),
        Baked::of("brdf", "R, G, B", "a pair of directions", reflected, values),
        Baked::of("brdf-factors", "R, G, B", "a direction and factor", reflected, factors),
        Baked::of("brdf-harmonics", "R, G, B", "a pair of harmonics", weights, harmonics),
        Baked::of("btf", "R, G, B, share", "a texel and pair", &bake::TEXELS, pictures),
        Baked::of("light-field", "R, G, B, share", "a texel and view", &bake::TEXELS, field),
    ])
}
