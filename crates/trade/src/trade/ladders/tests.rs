use super::*;
use ridgelight::scene::{
    HeightField, KeyLight, PhongSpecular, Specular, SphereLight, Sun, Surface,
};

fn scene(lights: Lights) -> Scene {
    let field = HeightField::new(2, 2, &[0.0; 4], [1.0; 2], None).unwrap();
    Scene { field, surface: Surface::default(), lights }
}

fn sky() -> Lights {
    Lights { sky: Some([1.0; 3]), ..Lights::default() }
}

fn sun(diameter_rad: f64) -> Lights {
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: 0.5, diameter_rad, irradiance: [1.0; 3] };
    Lights { suns: vec![sun], ..Lights::default() }
}

#[test]
fn only_ladders_with_an_effect_are_listed() {
    let names = |lights| ladders(&scene(lights), 0).iter().map(|k| k.name).collect::<Vec<_>>();
    let always = ["sweep", "fuse", "precision", "level step", "level offset"];
    let with = |more: &[&'static str]| [&always, more].concat();
    assert_eq!(names(sky()), with(&["azimuths"]));
    assert_eq!(names(sun(0.01)), with(&["sun azimuths"]));
    assert_eq!(names(sun(0.0)), with(&[]));
    let light = SphereLight { position_m: [0.0; 3], radius_m: 1.0, radiance: [1.0; 3] };
    let spheres = vec![light];
    assert_eq!(
        names(Lights { sphere_lights: spheres.clone(), ..Lights::default() }),
        ["sun azimuths", "light basis"]
    );
    let with_spheres = with(&["sun azimuths", "light basis"]);
    assert_eq!(names(Lights { sphere_lights: spheres.clone(), ..sun(0.0) }), with_spheres);
    // A key light needs horizons as a sun does; a black sky and a black sun need none.
    let keys = vec![KeyLight {
        azimuth_rad: 0.0,
        width_rad: 1.0,
        elevations_rad: [0.1, 0.5],
        radiance: [1.0; 3],
    }];
    assert_eq!(names(Lights { keys, ..Lights::default() }), with(&["sun azimuths"]));
    let mut dark = Lights { sky: Some([0.0; 3]), sphere_lights: spheres, ..sun(0.01) };
    dark.suns[0].irradiance = [0.0; 3];
    assert_eq!(names(dark), ["sun azimuths", "light basis"]);
}

/// 5 spacings × (2 fuses × 3 precisions + 4 fuses × 2 precisions) and exact and brute force alone
/// and 25 pyramids, each with 6 numbers of azimuths. Every quality is valid, none occurs twice, the
/// default is among them.
#[test]
fn places_are_distinct_and_complete() {
    let ladders = ladders(&scene(sky()), 0);
    let start = start();
    let all = places(&ladders, &start);
    assert_eq!(all.len(), (5 * (2 * 3 + 4 * 2) + 2 + 5 * 5) * 6);
    for (i, place) in all.iter().enumerate() {
        place.quality.check().unwrap();
        assert!(!all[..i].iter().any(|p| p.quality == place.quality), "{place:?}");
    }
    let default = all.iter().find(|p| p.quality == start).unwrap();
    let flags = "`lines 1` `fuse aimed-around` `precision f32` `azimuths 32`";
    assert_eq!(default.flags(&ladders), flags);
    let brute: Vec<&Place> =
        all.iter().filter(|p| p.quality.method == Method::BruteForce).collect();
    assert_eq!(brute.len(), 6);
    assert_eq!(brute[0].flags(&ladders), "`method brute-force` `azimuths 8`");
    assert_eq!(brute[0].steps, [Some(7), None, None, None, None, Some(0)]);
}

/// Phong specular is lit by tables or harmonics, with bounces by pyramids at every texel and harmonics between them, and it needs
/// neither under a sun alone; a scale of 0 changes nothing.
#[test]
fn specular_has_its_own_ladders() {
    let names = |lights: Lights, scale: f32, bounces: u32| {
        let mut scene = scene(lights);
        scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale }));
        ladders(&scene, bounces).iter().map(|k| k.name).collect::<Vec<_>>()
    };
    let always = ["sweep", "fuse", "precision", "level step", "level offset"];
    let with = |more: &[&'static str]| [&always, more].concat();
    assert_eq!(names(sky(), 0.0, 0), with(&["azimuths"]));
    assert_eq!(names(sky(), 0.2, 0), with(&["azimuths", "basis"]));
    assert_eq!(names(sun(0.0), 0.2, 0), with(&[]));
    // Specular of sphere lights has no harmonics.
    let sphere = SphereLight { position_m: [1.0; 3], radius_m: 1.0, radiance: [1.0; 3] };
    let near = || Lights { sphere_lights: vec![sphere], ..Lights::default() };
    assert!(names(near(), 0.0, 0).contains(&"light basis"));
    assert!(!names(near(), 0.2, 0).contains(&"light basis"));
    let with_bounces = ["azimuths", "basis", "SH order", "bounce specular", "bounce azimuths"];
    assert_eq!(names(sky(), 0.2, 2), with(&with_bounces));
    let mut scene = scene(sky());
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 5.0, scale: 0.2 }));
    let all = ladders(&scene, 1);
    let found: Vec<&str> = all.iter().map(|k| k.steps[k.default].as_str()).collect();
    let [.., basis, order, bounce_specular, _] = found[..] else { panic!("{found:?}") };
    let expected = ["`basis table`", "`sh_order 4`", "`bounce_specular vector`"];
    assert_eq!([basis, order, bounce_specular], expected);
}

/// Steps rise within the range, differ, and the default is the command line's.
#[test]
fn ladders_have_their_range_and_default() {
    let light = Lights {
        environment: Some(
            ridgelight::scene::Environment::new(2, 1, vec![[1.0; 3]; 2], 0.0).unwrap(),
        ),
        ..sun(0.01)
    };
    let all = ladders(&scene(light), 1);
    let found: Vec<(&str, &str)> =
        all.iter().map(|k| (k.name, k.steps[k.default].as_str())).collect();
    let expected = [
        ("sweep", "`lines 1`"),
        ("fuse", "`fuse aimed-around`"),
        ("precision", "`precision f32`"),
        ("level step", "`level_step 4`"),
        ("level offset", "`level_offset 2`"),
        ("azimuths", "`azimuths 32`"),
        ("sun azimuths", "`sun_azimuths 8`"),
        ("table elevations", "`table_elevations 256`"),
        ("basis", "`basis table`"),
        ("sub-sampling", "`subsample 1`"),
        ("bounce engine", "`bounce_engine auto`"),
        ("bounce azimuths", "`bounce_azimuths 16`"),
    ];
    assert_eq!(found, expected);
    for ladder in &all {
        let Some(range) = &ladder.range else { continue };
        let count = |s: &String| {
            s.trim_end_matches('`').split(' ').next_back().unwrap().parse::<u32>().unwrap()
        };
        let counts: Vec<u32> = ladder.steps.iter().map(count).collect();
        assert!(counts.iter().all(|c| range.contains(c)), "{counts:?}");
        assert!(counts.windows(2).all(|two| two[0] < two[1]), "{counts:?}");
        for (step, count) in counts.iter().enumerate() {
            let mut quality = start();
            ladder.set(&mut quality, step);
            quality.check().unwrap();
            assert_eq!(quality == start(), step == ladder.default, "{count}");
        }
    }
}

/// Under a sky and a sun exact lines are refused, and here packed heights with the slopes' fuse:
/// every place with either, and no other, by few calls.
#[test]
fn refusals_cover_all_counts() {
    let ladders = ladders(&scene(Lights { sky: Some([1.0; 3]), ..sun(0.01) }), 0);
    let places = places(&ladders, &start());
    let why = |Place { quality, .. }: &Place| {
        let is_swept = !matches!(quality.method, Method::BruteForce | Method::Pyramid);
        let two = quality.fuse == Fuse::Slopes && quality.precision == Precision::Packed;
        let is_exact = quality.lines == Lines::Exact;
        let why = if is_exact { "exact" } else { "packed" };
        (is_swept && (is_exact || two)).then(|| why.to_owned())
    };
    let mut checked = 0;
    let found = refused(&ladders, &places, |place| {
        checked += 1;
        why(place)
    });
    let all = places.iter().enumerate();
    let expected: Vec<_> = all.filter_map(|(i, p)| Some((i, why(p)?))).collect();
    assert_eq!(found, expected);
    assert!(found.len() > 100 && checked < 60, "{} of {checked}", found.len());
}
