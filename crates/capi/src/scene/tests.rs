//! Every field of the scene and of the quality arrives.

use super::*;
use ridgelight::scene::SETTINGS;

/// A struct with one value in one field, all others 0.
fn with(field: &str, value: f64) -> RidgelightQuality {
    // SAFETY: plain numbers, of which 0 is valid.
    let mut q: RidgelightQuality = unsafe { std::mem::zeroed() };
    q.struct_size = size_of::<RidgelightQuality>() as u32;
    macro_rules! set {
        ($($name:ident)*) => {
            match field {
                $(stringify!($name) => q.$name = value as _,)*
                _ => panic!("no field {field}"),
            }
        };
    }
    each_field!(set);
    q
}

fn arrives(q: &RidgelightQuality) -> Done<Quality> {
    // SAFETY: the struct lives and states its size.
    unsafe { quality(q) }
}

/// A value of each setting but the default arrives from its field.
#[test]
fn every_setting_has_a_field() {
    for setting in SETTINGS {
        let default = setting.get(&Quality::default());
        let has_zero = matches!(&setting.values, Values::Whole(r) if *r.start() == 0);
        let is_shifted = has_zero && default != "0";
        let field = format!("{}{}", setting.name, if is_shifted { "_plus_1" } else { "" });
        let (value, wanted) = match &setting.values {
            Values::Words(words) => {
                let other = words.iter().position(|word| word.name != default).unwrap();
                (other as f64 + 1.0, words[other].name.to_owned())
            }
            Values::Share => (0.125, "0.125".to_owned()),
            Values::Whole(range) => {
                let other = range.clone().find(|n| n.to_string() != default).unwrap();
                let value = f64::from(other.max(1)) + f64::from(u8::from(is_shifted));
                (value, other.max(1).to_string())
            }
            Values::OneOf(numbers) => {
                let last = *numbers.last().unwrap();
                (f64::from(last), last.to_string())
            }
        };
        let found = arrives(&with(&field, value)).ok().unwrap();
        assert_eq!(setting.get(&found), wanted, "{field}");
        let changed = SETTINGS.iter().filter(|s| s.get(&found) != s.get(&Quality::default()));
        assert_eq!(changed.map(|s| s.name).collect::<Vec<_>>(), [setting.name]);
    }
}

/// A number means what ridgelight.h says, whatever the order of the library's words.
#[test]
fn constants_mean_what_their_words_say() {
    let header = include_str!("../../include/ridgelight.h").replace("\n    //", "");
    for setting in SETTINGS {
        let Values::Words(words) = &setting.values else { continue };
        let (before, _) = header.split_once(&format!("uint32_t {};", setting.name)).unwrap();
        let (_, says) = before.rsplit_once(';').unwrap();
        for (i, word) in words.iter().enumerate() {
            let found = arrives(&with(setting.name, i as f64 + 1.0));
            if setting.name == "precision" && word.name == "packed" {
                assert!(found.is_err());
                continue;
            }
            assert_eq!(setting.get(&found.ok().unwrap()), word.name);
            let said = match (setting.name, word.name) {
                ("lines", "1/4") => "a quarter of a cell",
                ("lines", "1/2") => "half a cell",
                ("lines", "1") => "a cell",
                ("lines", "2") => "two cells",
                ("lines", "4") => "four cells",
                (_, name) => name,
            };
            let is_end = |c: char| !c.is_alphanumeric() && c != '-';
            let wanted = format!("{} {said}", i + 1);
            let is_said = says.split(&wanted).skip(1).any(|rest| rest.starts_with(is_end));
            assert!(is_said, "{}: {} {} not in {says}", setting.name, i + 1, word.name);
        }
        assert!(arrives(&with(setting.name, words.len() as f64 + 1.0)).is_err());
    }
}

#[test]
fn shares_that_are_no_numbers_are_refused() {
    for field in ["light_cutoff", "bounce_cutoff"] {
        for value in [f64::NAN, f64::INFINITY, 1.5] {
            assert!(arrives(&with(field, value)).is_err(), "{field} {value}");
        }
        let none = arrives(&with(field, f64::NEG_INFINITY)).ok().unwrap();
        assert_eq!(setting(field).unwrap().get(&none), "0");
    }
}

/// All but `has_voids`, which the view reads: `voids_of_c_are_filled_and_masked`.
#[test]
fn every_field_of_a_scene_arrives() {
    let suns = [RidgelightSun {
        struct_size: size_of::<RidgelightSun>() as u32,
        irradiance: [1.0, 2.0, 3.0],
        azimuth_rad: 0.1,
        elevation_rad: 0.2,
        diameter_rad: 0.3,
    }; 2];
    let keys = [RidgelightKeyLight {
        struct_size: size_of::<RidgelightKeyLight>() as u32,
        radiance: [4.0, 5.0, 6.0],
        azimuth_rad: 0.4,
        width_rad: 0.5,
        elevations_rad: [0.6, 0.7],
    }; 3];
    let spheres = [RidgelightSphereLight {
        struct_size: size_of::<RidgelightSphereLight>() as u32,
        radiance: [7.0, 8.0, 9.0],
        position_m: [10.0, 11.0, 12.0],
        radius_m: 0.8,
    }; 4];
    let numbers: Vec<f32> = (1..=3 * 8 * 4).map(|i| i as f32 / 128.0).collect();
    let [albedo, environment] = [&numbers[..3 * 5 * 3], &numbers[..]];
    let given = RidgelightScene {
        struct_size: size_of::<RidgelightScene>() as u32,
        rows: 5,
        cols: 3,
        border: RIDGELIGHT_BORDER_PERIODIC,
        cell_m: [13.0, 14.0],
        sky: [0.11, 0.12, 0.13],
        albedo: [0.14, 0.15, 0.16],
        albedo_is_map: 1,
        has_environment: 1,
        albedo_map: albedo.as_ptr(),
        environment: environment.as_ptr(),
        environment_width: 8,
        environment_height: 4,
        environment_rotation_rad: 0.9,
        specular_exponent: 15.0,
        specular_scale: 0.17,
        suns: suns.as_ptr(),
        keys: keys.as_ptr(),
        spheres: spheres.as_ptr(),
        sun_count: 2,
        key_count: 3,
        sphere_count: 4,
        has_voids: 0,
        eye_m: [0.0; 3],
        has_eye: 0,
        reserved: 0,
    };
    // SAFETY: arrays of this function, of these sizes, or null.
    let of = |given: &RidgelightScene| unsafe { scene(given) }.ok().expect("a scene");
    let found = of(&given);
    let (field, surface, lights) = (&found.field, &found.surface, &found.lights);
    assert_eq!((field.rows(), field.cols(), field.cell_m()), (5, 3, [13.0, 14.0]));
    let map = albedo.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
    assert_eq!(surface.albedo, Albedo::Map(map));
    let phong = PhongSpecular { exponent: 15.0, scale: 0.17 };
    assert_eq!(surface.specular, Some(Specular::Constant(phong)));
    assert_eq!(lights.sky, Some([0.11, 0.12, 0.13]));
    let around = lights.environment.as_ref().expect("an environment");
    assert_eq!((around.width(), around.height(), around.rotation_rad()), (8, 4, 0.9));
    assert_eq!(around.texels().as_flattened(), environment);
    let sun = Sun {
        azimuth_rad: 0.1,
        elevation_rad: 0.2,
        diameter_rad: 0.3,
        irradiance: [1.0, 2.0, 3.0],
    };
    assert_eq!(lights.suns, [sun; 2]);
    let key = KeyLight {
        azimuth_rad: 0.4,
        width_rad: 0.5,
        elevations_rad: [0.6, 0.7],
        radiance: [4.0, 5.0, 6.0],
    };
    assert_eq!(lights.keys, [key; 3]);
    let sphere =
        SphereLight { position_m: [10.0, 11.0, 12.0], radius_m: 0.8, radiance: [7.0, 8.0, 9.0] };
    assert_eq!(lights.sphere_lights, [sphere; 4]);

    let constant = of(&RidgelightScene { albedo_is_map: 0, ..given });
    assert_eq!(constant.surface.albedo, Albedo::Constant([0.14, 0.15, 0.16]));
    let borders = [
        (0, Border::Plane),
        (RIDGELIGHT_BORDER_PLANE, Border::Plane),
        (RIDGELIGHT_BORDER_OPEN, Border::Open),
        (RIDGELIGHT_BORDER_PERIODIC, Border::Periodic),
    ];
    assert_eq!(borders.map(|(value, _)| value), [0, 1, 2, 3]);
    for (border, wanted) in borders {
        let found = of(&RidgelightScene { border, ..given });
        assert_eq!(found.surface.border, wanted, "{border}");
    }
}
