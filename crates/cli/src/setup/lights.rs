//! Lights of which a scene may have several. One table gives their flags, scene file keys, metadata and messages.

use ridgelight::scene::{KeyLight, Lights, SphereLight, Sun};

use crate::args::numbers as numbers_in;
use crate::scene_file::{Numbers, Part, or, part};

/// A light's numbers, and its colour.
type Placed = (Vec<f64>, [f32; 3]);

/// A light type.
pub struct Light {
    /// Id of its flag. Its metadata keys are numbered: `sun1`.
    pub id: &'static str,
    /// Its list in scene files.
    pub list: &'static str,
    /// Its numbers in the flag's help.
    pub value_name: &'static str,
    pub help: &'static str,
    pub long_help: &'static str,
    /// Its numbers in order: degrees and metres as the flag takes them. A colour comes last.
    pub parts: &'static [Part],
    /// Whether its first number is a compass azimuth.
    pub is_aimed: bool,
    add: fn(&mut Lights, &[f64], [f32; 3]),
    numbers: fn(&Lights) -> Vec<Placed>,
}

pub static LIGHTS: [Light; 3] = [
    Light {
        id: "sun",
        list: "suns",
        value_name: "AZ,EL[,DIAMETER[,IRRADIANCE]]",
        help: "Sun: compass azimuth, elevation (degrees)",
        long_help: "DIAMETER is the angular diameter in degrees, default 0.53; 0 casts hard shadows. IRRADIANCE is that of a \
                    surface facing the sun, one number or R,G,B, default 1. Repeat the flag for more suns.",
        parts: &[
            part("azimuth_deg", Numbers::One),
            part("elevation_deg", Numbers::One),
            or(part("diameter_deg", Numbers::One), "0.53"),
            or(part("irradiance", Numbers::Colour), "1"),
        ],
        is_aimed: true,
        add: |lights, n, irradiance| {
            lights.suns.push(Sun {
                azimuth_rad: compass(n[0]).to_radians(),
                elevation_rad: n[1].to_radians(),
                diameter_rad: n[2].to_radians(),
                irradiance,
            });
        },
        numbers: |lights| {
            let one = |sun: &Sun| {
                let angles = [sun.elevation_rad, sun.diameter_rad].map(degrees);
                ([vec![compass_of(sun.azimuth_rad)], angles.into()].concat(), sun.irradiance)
            };
            lights.suns.iter().map(one).collect()
        },
    },
    Light {
        id: "key",
        list: "keys",
        value_name: "AZ,EL,WIDTH,HEIGHT,RADIANCE",
        help: "Key light: bright sky patch (degrees)",
        long_help: "AZ and EL are the compass azimuth and the elevation of its centre; WIDTH and HEIGHT are angles, all in \
                    degrees. RADIANCE is one number or R,G,B. 90,45,360,90,1 is the whole sky; 180,30,60,20,4 is a window to \
                    the south. Repeat the flag for more.",
        parts: &[
            part("azimuth_deg", Numbers::One),
            part("elevation_deg", Numbers::One),
            part("width_deg", Numbers::One),
            part("height_deg", Numbers::One),
            part("radiance", Numbers::Colour),
        ],
        is_aimed: true,
        add: |lights, n, radiance| {
            let [elevation, height] = [n[1], n[3]];
            lights.keys.push(KeyLight {
                azimuth_rad: compass(n[0]).to_radians(),
                width_rad: n[2].to_radians(),
                // Added in degrees, so that 90° is exactly the zenith.
                elevations_rad: [elevation - height / 2.0, elevation + height / 2.0]
                    .map(f64::to_radians),
                radiance,
            });
        },
        numbers: |lights| {
            let one = |key: &KeyLight| {
                let ([low, high], width) =
                    (key.elevations_rad.map(degrees), degrees(key.width_rad));
                let place =
                    vec![compass_of(key.azimuth_rad), (low + high) / 2.0, width, high - low];
                (place, key.radiance)
            };
            lights.keys.iter().map(one).collect()
        },
    },
    Light {
        id: "sphere_light",
        list: "sphere_lights",
        value_name: "X,Y,Z,RADIUS,RADIANCE",
        help: "Sphere light: centre and radius (metres)",
        long_help: "X is east of the westernmost column, Y north of the southernmost row, Z above height 0. RADIANCE is that \
                    of the sphere's surface, one number or R,G,B. Repeat the flag for more.",
        parts: &[
            part("position_m", Numbers::Three),
            part("radius_m", Numbers::One),
            part("radiance", Numbers::Colour),
        ],
        is_aimed: false,
        add: |lights, n, radiance| {
            let position_m = [n[0], n[1], n[2]];
            lights.sphere_lights.push(SphereLight { position_m, radius_m: n[3], radiance });
        },
        numbers: |lights| {
            let one = |sphere: &SphereLight| {
                ([&sphere.position_m[..], &[sphere.radius_m]].concat(), sphere.radiance)
            };
            lights.sphere_lights.iter().map(one).collect()
        },
    },
];

/// The light type of an id.
pub fn light(id: &str) -> &'static Light {
    LIGHTS.iter().find(|light| light.id == id).expect("a light of the table")
}

impl Light {
    /// Adds the light that a flag's words describe; an error is what was expected.
    pub fn add(&self, lights: &mut Lights, words: &str) -> Result<(), String> {
        let wrong = || {
            let colour = self.parts.last().map_or("colour", |part| part.name).to_uppercase();
            format!("{}, numbers; {colour} is one number or R,G,B", self.value_name)
        };
        let found = numbers_in(words).ok_or_else(wrong)?;
        let mut left = found.as_slice();
        let (mut place, mut colour) = (Vec::new(), [1.0; 3]);
        for part in self.parts {
            let default = part.default.map(|text| text.parse().expect("a number of ours"));
            let default: Option<f64> = default.filter(|_| left.is_empty());
            match (part.numbers, left, default) {
                (Numbers::Colour, [grey], _) => (colour, left) = ([*grey as f32; 3], &[]),
                (Numbers::Colour, [r, g, b], _) => {
                    (colour, left) = ([r, g, b].map(|c| *c as f32), &[]);
                }
                (Numbers::Colour, [], Some(grey)) => colour = [grey as f32; 3],
                (Numbers::One, [], Some(one)) => place.push(one),
                (Numbers::One, [one, rest @ ..], _) => {
                    place.push(*one);
                    left = rest;
                }
                (Numbers::Three, [a, b, c, rest @ ..], _) => {
                    place.extend([a, b, c]);
                    left = rest;
                }
                _ => return Err(wrong()),
            }
        }
        match left {
            [] => {
                (self.add)(lights, &place, colour);
                Ok(())
            }
            _ => Err(wrong()),
        }
    }

    /// Its lights in a scene, as the flag takes them.
    pub fn words(&self, lights: &Lights) -> Vec<String> {
        let words = |(place, [r, g, b]): Placed| {
            let place: Vec<String> = place.iter().map(f64::to_string).collect();
            format!("{},{r},{g},{b}", place.join(","))
        };
        (self.numbers)(lights).into_iter().map(words).collect()
    }

    /// Whether this is the metadata key of one of them: `sun2`.
    pub fn is_key(&self, name: &str) -> bool {
        name.strip_prefix(self.id).is_some_and(|rest| rest.parse::<u32>().is_ok())
    }
}

/// The library counts from east, counter-clockwise; the compass from north, clockwise.
fn compass(degrees: f64) -> f64 {
    90.0 - degrees
}

/// Degrees without the rounding from degrees to radians and back.
pub fn degrees(rad: f64) -> f64 {
    (rad.to_degrees() * 1e9).round() / 1e9
}

fn compass_of(azimuth_rad: f64) -> f64 {
    degrees(std::f64::consts::FRAC_PI_2 - azimuth_rad)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Words become a light, and the light the same words with every default written out.
    #[test]
    fn lights_keep_their_numbers() {
        for (id, words, full) in [
            ("sun", "315,30", "315,30,0.53,1,1,1"),
            ("sun", "-90,30,1,2", "-90,30,1,2,2,2"),
            ("sun", "90,0.1,0,0.1,2,1e6", "90,0.1,0,0.1,2,1000000"),
            ("key", "90,45,360,90,1", "90,45,360,90,1,1,1"),
            ("key", "180,30,60,20,1,2,3", "180,30,60,20,1,2,3"),
            ("sphere_light", "1,-2,30.5,4,5", "1,-2,30.5,4,5,5,5"),
        ] {
            let light = LIGHTS.iter().find(|light| light.id == id).unwrap();
            let mut lights = Lights::default();
            light.add(&mut lights, words).unwrap();
            assert_eq!(light.words(&lights), [full]);
            let mut again = Lights::default();
            light.add(&mut again, full).unwrap();
            assert_eq!(light.words(&again), [full]);
            lights.check().unwrap();
            for wrong in ["", "1", "a,b", "1,2,3,4,5,6,7,8,9", &format!("{full},1")] {
                assert!(light.add(&mut lights, wrong).is_err(), "{id} {wrong}");
            }
        }
    }
}
