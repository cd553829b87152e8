//! Hashes that identify a scene, the same on every machine and in every version.

use ridgelight::scene::{Albedo, PhongSpecular, Scene, Specular};

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

/// Of heights, cells, voids and border, as in `manifest.json`.
pub fn field(scene: &Scene) -> u64 {
    scene.field.hash(scene.surface.border)
}

/// Of all lights.
pub fn lights(scene: &Scene) -> u64 {
    let (lights, mut hash) = (&scene.lights, Fnv::new());
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
    // Their positions are absolute; the field's heights, which are hashed, are relative to the base.
    if !lights.sphere_lights.is_empty() {
        hash.take(&scene.field.base_m().to_le_bytes());
    }
    hash.0
}

/// Of reflectance and border.
pub fn surface(scene: &Scene) -> u64 {
    let (surface, mut hash) = (&scene.surface, Fnv::new());
    hash.take(format!("{:?}", surface.border).as_bytes());
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
    use ridgelight::scene::{Border, Environment, HeightField, Lights, SphereLight, Sun, Surface};

    /// Every change changes the hash of its own part and no other.
    #[test]
    fn each_part_of_a_scene_has_a_hash() {
        let field_of = |last: f64, base: f64| {
            let heights = [0.0, 1.0, 2.0, last].map(|height| base + height);
            HeightField::new(2, 2, &heights, [1.0; 2], None).unwrap()
        };
        let sun =
            Sun { azimuth_rad: 1.0, elevation_rad: 0.5, diameter_rad: 0.01, irradiance: [1.0; 3] };
        let environment = |value: f32, turn: f64| {
            Some(Environment::new(2, 1, vec![[1.0; 3], [value; 3]], turn).unwrap())
        };
        let sphere = SphereLight { position_m: [0.0, 0.0, 9.0], radius_m: 1.0, radiance: [1.0; 3] };
        let lights_of = [
            Lights::default(),
            Lights { sky: Some([1.0; 3]), ..Lights::default() },
            Lights { sky: Some([1.0, 1.0, 0.5]), ..Lights::default() },
            Lights { environment: environment(2.0, 0.0), ..Lights::default() },
            Lights { environment: environment(3.0, 0.0), ..Lights::default() },
            Lights { environment: environment(3.0, 0.5), ..Lights::default() },
            Lights { suns: vec![sun], ..Lights::default() },
            Lights { suns: vec![Sun { elevation_rad: 0.6, ..sun }], ..Lights::default() },
            Lights { sphere_lights: vec![sphere], ..Lights::default() },
        ];
        let albedo = |last: f32| Albedo::Map(vec![[0.5; 3], [0.5; 3], [0.5; 3], [last; 3]]);
        let phong = |scale: f32| Some(Specular::Constant(PhongSpecular { exponent: 9.0, scale }));
        let surfaces = [
            Surface::default(),
            Surface { border: Border::Open, ..Surface::default() },
            Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() },
            Surface { albedo: albedo(0.5), ..Surface::default() },
            Surface { albedo: albedo(0.25), ..Surface::default() },
            Surface {
                albedo: Albedo::Constant([0.5; 3]),
                specular: phong(0.5),
                ..Default::default()
            },
            Surface {
                albedo: Albedo::Constant([0.5; 3]),
                specular: phong(0.4),
                ..Default::default()
            },
        ];
        let base = Scene {
            field: field_of(3.0, 0.0),
            surface: surfaces[0].clone(),
            lights: lights_of[0].clone(),
        };
        let higher = Scene { field: field_of(3.5, 0.0), ..base.clone() };
        assert_ne!(field(&base), field(&higher));
        assert_eq!([lights(&base), surface(&base)], [lights(&higher), surface(&higher)]);
        let lit = |lights: &Lights| Scene { lights: lights.clone(), ..base.clone() };
        let of = |surface: &Surface| Scene { surface: surface.clone(), ..base.clone() };
        let mut by_lights: Vec<u64> = lights_of.iter().map(|l| lights(&lit(l))).collect();
        // The same sphere light over ground at another height.
        by_lights.push(lights(&Scene { field: field_of(3.0, 64.0), ..lit(&lights_of[8]) }));
        let mut by_surface: Vec<u64> = surfaces.iter().map(|s| surface(&of(s))).collect();
        for hashes in [&mut by_lights, &mut by_surface] {
            let count = hashes.len();
            hashes.sort_unstable();
            hashes.dedup();
            assert_eq!(hashes.len(), count);
        }
        assert!(lights_of.iter().all(|l| surface(&lit(l)) == surface(&base)));
        assert!(surfaces.iter().all(|s| lights(&of(s)) == lights(&base)));
    }
}
