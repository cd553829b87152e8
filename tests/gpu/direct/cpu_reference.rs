//! Everything that sums light.

pub(crate) mod light;
mod shadow;
pub(crate) mod shadow_height;
pub(crate) mod sphere_sh;

use ridgelight::plan::Picture;
use ridgelight::scene::{
    Albedo, Basis, Border, Environment, Fuse, KeyLight, Levels, LightBasis, Lights, Lines, Method,
    PhongSpecular, Quality, Receiver, Scene, Specular, SphereLight, Sun, Surface, Wedges, Window,
};

use crate::cpu_reference::{Case, Reference, Wanted, check_all, key, noisy_environment, rough};
use crate::random;

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[
    ("env_tables", light::env_tables),
    ("sky_shade", light::sky_shade),
    ("sun_shade", light::sun_shade),
    ("shadow_height", shadow_height::shadow_height),
    ("shadow_sweep", shadow::shadow_sweep),
    ("shadow_shade", shadow::shadow_shade),
    ("shadow_settle", shadow::shadow_settle),
    ("sphere_shade", light::sphere_shade),
    ("sphere_sh_shade", sphere_sh::sphere_sh_shade),
    ("light_resolve", light::light_resolve),
];

/// Everything that sums light: sky, environment, discs and a point; colours and a map, or all grey.
pub(crate) fn pictures() -> Vec<Case> {
    let sun = |azimuth_rad, diameter_rad, irradiance| Sun {
        azimuth_rad,
        elevation_rad: 0.4,
        diameter_rad,
        irradiance,
    };
    let quality = Quality { azimuths: 12, table_elevations: 33, ..Quality::default() };
    let colourful = {
        let field = rough(23, 30, 11);
        let mut next = random(12);
        let map = (0..23 * 30).map(|_| [next() as f32, next() as f32, 1.0]).collect();
        let surface =
            Surface { border: Border::Open, albedo: Albedo::Map(map), ..Surface::default() };
        let lights = Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(13)),
            suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0])],
            keys: vec![key(-0.4, 0.5, [1.0, 2.0, 0.5])],
            ..Lights::default()
        };
        Scene { field, surface, lights }
    };
    // For an odd number of rows the middle one lies on both sides of the ground.
    let on_a_plane = {
        let environment = noisy_environment(15);
        let lights = Lights { environment: Some(environment), ..Lights::default() };
        Scene { field: rough(13, 11, 16), surface: Surface::default(), lights }
    };
    let grey = {
        let surface = Surface {
            border: Border::Plane,
            albedo: Albedo::Constant([0.5; 3]),
            ..Surface::default()
        };
        let suns = vec![sun(-1.1, 0.0, [2.0; 3])];
        let keys = vec![key(0.1, 0.3, [2.0; 3])];
        let lights = Lights { sky: Some([1.0; 3]), suns, keys, ..Lights::default() };
        Scene { field: rough(12, 17, 14), surface, lights }
    };
    let sphere_light =
        |x, y, z, radius_m, radiance| SphereLight { position_m: [x, y, z], radius_m, radiance };
    // Over the ground; cut by it, with texels under and inside; beyond the edge.
    let sphere_lights = {
        let spheres = vec![
            sphere_light(20.0, 14.0, 920.0, 4.0, [3.0, 2.0, 1.0]),
            sphere_light(9.5, 6.1, 903.0, 5.0, [0.5, 1.0, 2.0]),
            sphere_light(-30.0, 50.0, 890.0, 12.0, [4.0, 0.0, 1.0]),
        ];
        let lights =
            Lights { sky: Some([0.3, 0.5, 0.9]), sphere_lights: spheres, ..Lights::default() };
        Scene { lights, ..colourful.clone() }
    };
    let sphere_lights_alone = {
        let spheres = vec![
            sphere_light(7.0, 4.0, 911.0, 2.0, [5.0; 3]),
            sphere_light(31.0, 9.0, 908.0, 1.0, [2.0; 3]),
        ];
        let surface = Surface { border: Border::Periodic, ..Surface::default() };
        let lights = Lights { sphere_lights: spheres, ..Lights::default() };
        Scene { field: rough(9, 8, 17), surface, lights }
    };
    let picture = |name, scene, quality, light_layers, sky_view| Case {
        name,
        scene,
        quality,
        wanted: Wanted::Picture(Picture {
            light_layers,
            sky_view,
            keeps_horizons: true,
            ..Picture::default()
        }),
        loses_lines: false,
    };
    let of_device = Case {
        wanted: Wanted::Picture(Picture { colours_on_device: true, ..Picture::default() }),
        ..picture("colours on the device", grey.clone(), quality, false, false)
    };
    let sh = |sh_order| Quality { basis: Basis::Sh, sh_order, ..quality };
    let nlp = Quality { wedges: Wedges::Nlp, receiver: Receiver::Cosine, ..sh(5) };
    let by_sh = |sh_order, sun_azimuths| Quality {
        light_basis: LightBasis::Sh,
        sh_order,
        sun_azimuths,
        ..quality
    };
    let sh_table = Quality { wedges: Wedges::Table, wedge_side: 17, ..by_sh(3, 6) };
    let soft_nlp = Quality {
        wedges: Wedges::Nlp,
        receiver: Receiver::Cosine,
        window: Window::Lanczos,
        ..by_sh(5, 7)
    };
    let soft_levels = Quality {
        method: Method::Pyramid,
        level_step: 3,
        level_offset: 0,
        levels: Levels::Pyramid,
        ..by_sh(2, 1)
    };
    let soft_stack = Quality {
        wedges: Wedges::Table,
        receiver: Receiver::Cosine,
        levels: Levels::Stack,
        level_step: 2,
        level_offset: 1,
        ..Quality { sun_azimuths: 8, sh_order: 6, ..soft_levels }
    };
    let windowed = Quality { window: Window::Hann, fuse: Fuse::Own, ..sh(4) };
    let phong_specular =
        Quality { receiver: Receiver::Cosine, window: Window::Nonnegative, ..sh(2) };
    let subsampled = |subsample, sh_order| Quality { subsample, ..sh(sh_order) };
    let by_table =
        Quality { wedges: Wedges::Table, method: Method::BruteForce, ..subsampled(2, 6) };
    let open_wedges = Quality { wedges: Wedges::Table, wedge_side: 9, ..sh(3) };
    let marched = Quality { method: Method::BruteForce, ..subsampled(4, 4) };
    let smoothed = Quality { method: Method::Pyramid, level_step: 2, ..subsampled(2, 3) };
    // Phong specular under all lights, and under a sky alone.
    let mirrored = {
        let lights = Lights {
            sky: Some([0.3, 0.5, 0.9]),
            environment: Some(noisy_environment(41)),
            suns: vec![sun(2.0, 0.2, [3.0, 2.5, 2.0]), sun(-1.1, 0.0, [2.0; 3])],
            ..Lights::default()
        };
        let surface = Surface {
            border: Border::Plane,
            albedo: Albedo::Constant([0.5; 3]),
            specular: Some(Specular::Constant(PhongSpecular { exponent: 20.0, scale: 0.4 })),
        };
        Scene { field: rough(14, 11, 42), surface, lights }
    };
    // Lobes that reach a part of the directions only.
    let narrow = |border, exponent, rotation_rad| {
        let mut scene = mirrored.clone();
        scene.surface.border = border;
        scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.4 }));
        let texels = noisy_environment(41).texels().to_vec();
        scene.lights.environment =
            Some(Environment::new(18, 9, texels, rotation_rad).expect("an environment"));
        scene
    };
    let mapped = {
        let phong = |i: usize| PhongSpecular { exponent: (7 * i % 50) as f32, scale: 0.4 };
        let mut scene = mirrored.clone();
        scene.surface.specular = Some(Specular::Map((0..14 * 11).map(phong).collect()));
        scene
    };
    let eye_m = Some([30.0, -40.0, 960.0]);
    let with_an_eye = |case: Case| Case {
        wanted: Wanted::Picture(Picture { eye_m, ..Picture::default() }),
        ..case
    };
    let mirrored_sky = {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let mut next = random(45);
        let map =
            (0..9 * 14).map(|i| PhongSpecular { exponent: (79 * i) as f32, scale: next() as f32 });
        let phong = Some(Specular::Map(map.collect()));
        let surface =
            Surface { border: Border::Open, albedo: Albedo::Constant([0.0; 3]), specular: phong };
        Scene { field: rough(9, 14, 43), surface, lights }
    };
    let mapped_sky = {
        let phong = |i: usize| PhongSpecular {
            exponent: (77 * i % 301) as f32,
            scale: (i % 4) as f32 * 0.2,
        };
        let mut scene = mirrored_sky.clone();
        scene.surface.specular = Some(Specular::Map((0..9 * 14).map(phong).collect()));
        scene
    };
    // Under a sky alone: one table for all azimuths.
    let shiny_sky = |exponent, border| {
        let suns = vec![sun(0.7, 0.1, [1.0, 2.0, 3.0])];
        let lights = Lights { sky: Some([1.0, 0.5, 2.0]), suns, ..Lights::default() };
        let phong = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.7 }));
        let albedo = Albedo::Constant([0.25; 3]);
        let surface = Surface { border, albedo, specular: phong };
        Scene { field: rough(13, 10, 44), surface, lights }
    };
    let mut without_suns = shiny_sky(300.0, Border::Plane);
    without_suns.lights.suns.clear();
    // Key lights from below horizontal up, and a narrow one, beside a sun.
    let under_keys = |border, specular| {
        let narrow = KeyLight { width_rad: 0.2, ..key(0.3, 0.36, [3.0, 0.0, 1.0]) };
        let keys = vec![key(-0.4, 0.9, [1.0, 2.0, 0.5]), narrow];
        let suns = vec![sun(0.7, 0.1, [1.0, 2.0, 3.0])];
        let surface =
            Surface { border, albedo: Albedo::Constant([0.25; 3]), specular: Some(specular) };
        let lights = Lights { suns, keys, ..Lights::default() };
        Scene { field: rough(11, 14, 47), surface, lights }
    };
    // Over the ground, and cut by it; and over a field that repeats.
    let spheres = sphere_lights.lights.sphere_lights.clone();
    let under_spheres = |specular| {
        let lights = Lights { sphere_lights: spheres.clone(), ..Lights::default() };
        let surface = Surface {
            border: Border::Open,
            albedo: Albedo::Constant([0.25; 3]),
            specular: Some(specular),
        };
        Scene { field: rough(23, 30, 11), surface, lights }
    };
    let repeated_spheres = {
        let mut scene = sphere_lights_alone.clone();
        scene.surface.albedo = Albedo::Constant([0.25; 3]);
        scene.surface.specular =
            Some(Specular::Constant(PhongSpecular { exponent: 300.0, scale: 0.6 }));
        scene
    };
    let one_phong = |exponent| Specular::Constant(PhongSpecular { exponent, scale: 0.6 });
    let phong_at =
        |i: usize| PhongSpecular { exponent: (3 * i) as f32, scale: (i % 7) as f32 * 0.1 };
    let phongs = Specular::Map((0..11 * 14).map(phong_at).collect());
    let phong_of_23 =
        |i: usize| PhongSpecular { exponent: (i % 90) as f32, scale: (i % 7) as f32 * 0.1 };
    let map_of_23 = Specular::Map((0..23 * 30).map(phong_of_23).collect());
    let with_keys = {
        let mut scene = mirrored.clone();
        scene.lights.keys = vec![key(0.1, 1.5, [2.0, 1.0, 1.0])];
        scene
    };
    let along_vectors = Quality { lines: Lines::Exact, ..quality };
    let nine = Quality { azimuths: 9, ..quality };
    // Low lights by shadow heights: a disc, a point and a narrow key light, in different octants.
    let low = |border| {
        let narrow = KeyLight { width_rad: 0.3, ..key(0.12, 0.2, [1.0, 2.0, 3.0]) };
        let suns = vec![sun(0.4, 0.1, [3.0, 2.5, 2.0]), sun(-1.9, 0.0, [2.0; 3])];
        let lights = Lights { suns, keys: vec![narrow], ..Lights::default() };
        Scene {
            field: rough(21, 18, 46),
            surface: Surface { border, ..Surface::default() },
            lights,
        }
    };
    let on_a_gpu = |name, border| Case {
        wanted: Wanted::GpuPicture,
        ..picture(name, low(border), quality, false, false)
    };
    // Twelve columns: the last is no multiple of 4 from the first; of a field that repeats.
    let repeated = {
        let lights = Lights { environment: Some(noisy_environment(17)), ..Lights::default() };
        let surface = Surface { border: Border::Periodic, ..Surface::default() };
        Scene { field: rough(19, 12, 18), surface, lights }
    };
    vec![
        on_a_gpu("low lights on a GPU", Border::Plane),
        on_a_gpu("low lights on a GPU, open", Border::Open),
        on_a_gpu("low lights on a GPU, periodic", Border::Periodic),
        picture("colours", colourful.clone(), quality, true, false),
        picture("environment on a plane", on_a_plane.clone(), quality, false, false),
        picture("low lights", low(Border::Plane), quality, true, false),
        picture("low lights, open", low(Border::Open), quality, false, false),
        picture("low lights, periodic", low(Border::Periodic), quality, false, false),
        of_device,
        picture(
            "grey",
            grey,
            Quality { method: Method::Sweep, fuse: Fuse::AimedNearest, ..quality },
            false,
            true,
        ),
        picture("sphere lights", sphere_lights.clone(), quality, true, false),
        picture(
            "sphere lights in one sum",
            sphere_lights.clone(),
            Quality { sun_azimuths: 5, ..quality },
            false,
            false,
        ),
        picture("sphere lights by harmonics", sphere_lights.clone(), by_sh(4, 8), true, false),
        picture(
            "sphere lights by harmonics of order 6",
            sphere_lights.clone(),
            by_sh(6, 4),
            false,
            false,
        ),
        picture(
            "sphere lights by a table of wedges",
            sphere_lights.clone(),
            sh_table,
            false,
            false,
        ),
        picture(
            "sphere lights by Legendre, periodic",
            sphere_lights_alone.clone(),
            soft_nlp,
            false,
            false,
        ),
        picture("sphere lights by a pyramid's levels", sphere_lights, soft_levels, false, false),
        picture(
            "sphere lights by a stack, periodic",
            sphere_lights_alone.clone(),
            soft_stack,
            true,
            false,
        ),
        picture("sphere lights alone, periodic", sphere_lights_alone, quality, false, false),
        picture("harmonics of order 6", on_a_plane.clone(), sh(6), false, false),
        picture("harmonics beside a sky", colourful.clone(), windowed, true, false),
        picture("harmonics by Legendre", colourful.clone(), nlp, false, false),
        picture("harmonics of order 3", on_a_plane.clone(), sh(3), false, true),
        picture(
            "harmonics at every second texel",
            on_a_plane.clone(),
            subsampled(2, 5),
            false,
            false,
        ),
        picture(
            "harmonics at every fourth texel",
            colourful.clone(),
            subsampled(4, 4),
            false,
            false,
        ),
        picture("harmonics by a table of wedges", on_a_plane.clone(), by_table, false, false),
        picture("harmonics by wedges of a sphere", colourful, open_wedges, false, false),
        picture("harmonics of marches from nodes", on_a_plane.clone(), marched, false, false),
        picture("harmonics of a pyramid's nodes", repeated, smoothed, false, false),
        picture("harmonics of order 2", on_a_plane, phong_specular, false, false),
        picture("a lobe by slices", mirrored.clone(), quality, true, false),
        picture(
            "a lobe under swept suns",
            mirrored.clone(),
            Quality { method: Method::Sweep, ..quality },
            true,
            false,
        ),
        with_an_eye(picture(
            "a lobe by slices, with an eye, open",
            shiny_sky(2.5, Border::Open),
            quality,
            false,
            false,
        )),
        picture(
            "a narrow lobe by slices, periodic",
            shiny_sky(300.0, Border::Periodic),
            quality,
            false,
            false,
        ),
        picture(
            "a narrow lobe by nine slices",
            shiny_sky(300.0, Border::Plane),
            nine,
            false,
            false,
        ),
        picture("a narrow lobe along grid vectors", without_suns, along_vectors, false, false),
        picture(
            "a lobe of an environment",
            narrow(Border::Plane, 25.0, 0.7),
            quality,
            false,
            false,
        ),
        picture(
            "a narrow lobe of an environment, open",
            narrow(Border::Open, 1000.0, -2.0),
            quality,
            false,
            false,
        ),
        picture("a lobe under all lights at infinity", with_keys, quality, true, false),
        picture(
            "a wide lobe under key lights, open",
            under_keys(Border::Open, one_phong(1.0)),
            quality,
            true,
            false,
        ),
        with_an_eye(picture(
            "a narrow lobe under key lights, with an eye",
            under_keys(Border::Plane, one_phong(1000.0)),
            quality,
            false,
            false,
        )),
        picture(
            "lobes of a map under key lights, periodic",
            under_keys(Border::Periodic, phongs),
            quality,
            false,
            false,
        ),
        with_an_eye(picture(
            "a lobe under sphere lights, with an eye",
            under_spheres(one_phong(20.0)),
            quality,
            false,
            false,
        )),
        picture(
            "lobes of a map under sphere lights",
            under_spheres(map_of_23),
            quality,
            true,
            false,
        ),
        picture(
            "a narrow lobe under sphere lights, periodic",
            repeated_spheres,
            quality,
            false,
            false,
        ),
        picture("a lobe", mirrored, sh(5), true, false),
        picture(
            "a specular at every second texel",
            mirrored_sky.clone(),
            subsampled(2, 3),
            false,
            false,
        ),
        with_an_eye(picture(
            "a specular at every second texel, with an eye",
            mirrored_sky,
            subsampled(2, 3),
            false,
            false,
        )),
        with_an_eye(picture("a map of lobes, with an eye", mapped, quality, false, false)),
        picture("a map of lobes under a sky, open", mapped_sky, quality, false, false),
    ]
}

#[test]
fn pictures_match_pass_by_pass() {
    let all = pictures();
    check_all(&all[..all.len() / 2]);
}

/// The other half of the pictures, which runs in parallel with the first.
#[test]
fn more_pictures_match_pass_by_pass() {
    let all = pictures();
    check_all(&all[all.len() / 2..]);
}
