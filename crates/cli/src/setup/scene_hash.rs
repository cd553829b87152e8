//! Hashes that identify the parts of a scene, each from its own values alone.
//!
//! Equal values have equal hashes on every machine. A clear sky and a tint are computed with the platform's `sin`, `exp`
//! and `powf`, so their values may differ between machines.

use ridgelight::scene::{Albedo, Border, HeightField, Lights, PhongSpecular, Specular, Surface};

use super::lights::LIGHTS;

/// FNV-1a of 64 bits (Fowler, Noll & Vo), as [`HeightField::hash`](ridgelight::scene::HeightField::hash).
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn numbers<'a>(&mut self, numbers: impl IntoIterator<Item = &'a f32>) {
        numbers.into_iter().for_each(|number| self.take(&number.to_le_bytes()));
    }
}

/// Of heights above the base, cells and voids. The border is part of [`surface`].
pub fn field(field: &HeightField) -> u64 {
    field.hash(Border::Plane)
}

/// Of all lights. Heights of lights near the field are absolute, so `base_m`, that of the field, enters with them. It is
/// none where it is no part of the scene, as with a fractal, whose base depends on its size.
pub fn lights(lights: &Lights, base_m: Option<f64>) -> u64 {
    let mut hash = Fnv::new();
    if let Some(sky) = &lights.sky {
        hash.take(b"sky");
        hash.numbers(sky);
    }
    if let Some(environment) = &lights.environment {
        hash.take(format!("env {}", environment.width()).as_bytes());
        hash.take(&environment.rotation_rad().to_le_bytes());
        hash.numbers(environment.texels().as_flattened());
    }
    for light in &LIGHTS {
        for words in light.words(lights) {
            hash.take(format!("{} {words}\n", light.id).as_bytes());
        }
    }
    if let (Some(base_m), Some(_)) = (base_m, lights.near().next()) {
        hash.take(&base_m.to_le_bytes());
    }
    hash.0
}

/// Of reflectance and border.
pub fn surface(surface: &Surface) -> u64 {
    let mut hash = Fnv::new();
    // Numbered as in HeightField::hash.
    hash.take(&[match surface.border {
        Border::Plane => 0,
        Border::Open => 1,
        Border::Periodic => 2,
    }]);
    match &surface.albedo {
        Albedo::Constant(colour) => hash.numbers(colour),
        Albedo::Map(map) => hash.numbers(map.as_flattened()),
    }
    let texels: &[PhongSpecular] = match &surface.specular {
        None => &[],
        Some(Specular::Constant(one)) => std::slice::from_ref(one),
        Some(Specular::Map(map)) => map,
    };
    hash.take(b"specular");
    texels.iter().for_each(|texel| hash.numbers(&[texel.exponent, texel.scale]));
    hash.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Environment, Scene, SphereLight, Sun};

    const PLACES: [[f64; 3]; 2] = [[0.0, 0.0, 9.0], [0.0, 0.0, 8.0]];

    fn spheres(position_m: [f64; 3]) -> Lights {
        let sphere = SphereLight { position_m, radius_m: 1.0, radiance: [1.0; 3] };
        Lights { sphere_lights: vec![sphere], ..Lights::default() }
    }

    fn phong(scale: f32) -> Surface {
        let specular = Some(Specular::Constant(PhongSpecular { exponent: 9.0, scale }));
        Surface { albedo: Albedo::Constant([0.5; 3]), specular, ..Surface::default() }
    }

    /// 2 x 2 grid points. Without voids the base height is `base` + 2.
    fn ground(last: f64, base: f64, cell: f64, voids: Option<Vec<bool>>) -> HeightField {
        let heights = [0.0, 1.0, 2.0, last].map(|height| base + height);
        HeightField::new(2, 2, &heights, [cell, 1.0], voids).unwrap()
    }

    fn of(scene: &Scene) -> [u64; 3] {
        let base_m = Some(scene.field.base_m());
        [field(&scene.field), lights(&scene.lights, base_m), surface(&scene.surface)]
    }

    /// Every change changes the hash of its own part and no other.
    #[test]
    fn each_part_of_a_scene_has_a_hash() {
        let sun =
            Sun { azimuth_rad: 1.0, elevation_rad: 0.5, diameter_rad: 0.01, irradiance: [1.0; 3] };
        let environment = |value: f32, turn: f64| {
            Some(Environment::new(2, 1, vec![[1.0; 3], [value; 3]], turn).unwrap())
        };
        let albedo = |last: f32| Albedo::Map(vec![[0.5; 3], [0.5; 3], [0.5; 3], [last; 3]]);
        let is_void = Some(vec![false, false, false, true]);
        let fields = [
            ground(3.0, 0.0, 1.0, None),
            ground(3.5, 0.0, 1.0, None),
            ground(3.0, 0.0, 2.0, None),
            ground(3.0, 0.0, 1.0, is_void),
            HeightField::new(1, 4, &[0.0, 1.0, 2.0, 3.0], [1.0; 2], None).unwrap(),
        ];
        let lights = [
            Lights::default(),
            Lights { sky: Some([1.0; 3]), ..Lights::default() },
            Lights { sky: Some([1.0, 1.0, 0.5]), ..Lights::default() },
            Lights { environment: environment(2.0, 0.0), ..Lights::default() },
            Lights { environment: environment(3.0, 0.0), ..Lights::default() },
            Lights { environment: environment(3.0, 0.5), ..Lights::default() },
            Lights { suns: vec![sun], ..Lights::default() },
            Lights { suns: vec![Sun { elevation_rad: 0.6, ..sun }], ..Lights::default() },
            spheres(PLACES[0]),
            spheres(PLACES[1]),
        ];
        let surfaces = [
            Surface::default(),
            Surface { border: Border::Open, ..Surface::default() },
            Surface { border: Border::Periodic, ..Surface::default() },
            Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() },
            Surface { albedo: albedo(0.5), ..Surface::default() },
            Surface { albedo: albedo(0.25), ..Surface::default() },
            phong(0.5),
            phong(0.4),
        ];
        let base = Scene {
            field: fields[0].clone(),
            surface: surfaces[0].clone(),
            lights: lights[0].clone(),
        };
        let by_field = fields.map(|field| of(&Scene { field, ..base.clone() })).to_vec();
        let by_lights = lights.map(|lights| of(&Scene { lights, ..base.clone() })).to_vec();
        let by_surface = surfaces.map(|surface| of(&Scene { surface, ..base.clone() })).to_vec();
        for (own, all) in [by_field, by_lights, by_surface].into_iter().enumerate() {
            let others = (0..3).filter(|part| *part != own);
            for part in others {
                assert!(all.iter().all(|hashes| hashes[part] == all[0][part]), "{own} {part}");
            }
            let distinct: std::collections::BTreeSet<u64> =
                all.iter().map(|hashes| hashes[own]).collect();
            assert_eq!(distinct.len(), all.len(), "part {own}");
        }
    }

    /// The base is no part of the field. The same sphere light over a higher base is another one; a sky is not.
    #[test]
    fn the_base_enters_with_lights_near_the_field() {
        let [low, high] = [0.0, 64.0].map(|base| ground(3.0, base, 1.0, None));
        assert_eq!(field(&low), field(&high));
        let bases = [Some(low.base_m()), Some(high.base_m()), None];
        let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let [a, b, c] = bases.map(|base_m| lights(&sky, base_m));
        assert_eq!([a, a], [b, c]);
        let [a, b, c] = bases.map(|base_m| lights(&spheres(PLACES[0]), base_m));
        assert!(a != b && b != c && c != a, "{a:x} {b:x} {c:x}");
    }

    /// FNV-1a in Python, of the bytes that the functions above take.
    #[test]
    fn hashes_are_those_of_another_program() {
        assert_eq!(field(&ground(3.0, 0.0, 1.0, None)), 0xf3ae_b5c0_8876_ab69);
        assert_eq!(lights(&spheres(PLACES[0]), Some(2.0)), 0xae40_171d_f72f_ff22);
        assert_eq!(surface(&phong(0.5)), 0x9342_684f_6a0d_9725);
    }
}
