//! The first sun, and sphere lights: turn, place, drag, colour, delete.

use ridgelight::scene::{SphereLight, Sun};

use super::viewpoint::height;
use super::{State, Wish, hundredths};
use crate::scene_file::Request;
use crate::setup::lights::{LIGHTS, degrees, light};
use crate::setup::sky;
use crate::view::moving::side_m;

/// Colours that a sphere light cycles through; its brightest channel stays.
const COLOURS: [[f32; 3]; 6] = [
    [1.0, 1.0, 1.0],
    [1.0, 0.6, 0.3],
    [1.0, 0.25, 0.2],
    [0.3, 1.0, 0.4],
    [0.3, 0.5, 1.0],
    [0.8, 0.4, 1.0],
];

/// Radiance of a new sphere light. Its radius is a thirtieth of the field's shorter side and its
/// centre is three radii above the ground: 8/9 of white below it.
const RADIANCE: f32 = 8.0;
const SHARE: f64 = 1.0 / 30.0;

/// Distance at which a click takes hold of a sphere light, pixels, however small it is.
const GRIP: f64 = 8.0;

impl State {
    /// Turns the first sun by degrees; adds one where there is none.
    pub(super) fn turn_sun(&mut self, clockwise: f64, up: f64) -> Wish {
        let turned = |sun| {
            let [azimuth, elevation] = compass(sun);
            [azimuth + clockwise, elevation + up]
        };
        self.point_sun(self.scene.lights.suns.first().map_or([315.0, 30.0], turned))
    }

    /// Turns the first sun to a compass azimuth and an elevation, degrees; adds one where there is
    /// none.
    pub(super) fn point_sun(&mut self, [azimuth, elevation]: [f64; 2]) -> Wish {
        let lights = &mut self.scene.lights;
        if lights.suns.is_empty() {
            light("sun").add(lights, "315,30").expect("a sun");
        }
        let sun = &mut lights.suns[0];
        let azimuth = hundredths(azimuth.rem_euclid(360.0)) % 360.0;
        let elevation = hundredths(elevation.clamp(0.0, 90.0));
        sun.azimuth_rad = (90.0 - azimuth).to_radians();
        sun.elevation_rad = elevation.to_radians();
        if self.has_clear_sky {
            match sky::clear(sun) {
                Ok(sky) => lights.environment = Some(sky),
                Err(why) => return self.say(&why.to_string()),
            }
        }
        self.ask_for("sun")
    }

    /// Keeps the lights of a type as the user would write them.
    fn ask_for(&mut self, id: &str) -> Wish {
        // The first explicit light replaces the default of a scene without lights.
        let mut asked = self.asked.clone();
        self.write_default(&mut asked);
        asked.set(id, light(id).words(&self.scene.lights));
        self.asked = asked;
        Wish::Light
    }

    /// Writes the sky, and the sun of a clear one. The defaults depend on the viewpoint and on settings that may have
    /// changed.
    fn write_default(&self, asked: &mut Request) {
        if self.has_clear_sky {
            asked.set("sky", vec!["clear".to_owned()]);
            asked.set("sun", light("sun").words(&self.scene.lights));
        }
        if let Some([r, g, b]) = self.scene.lights.sky {
            asked.set("sky", vec![format!("{r},{g},{b}")]);
        }
    }

    /// Writes the lights in use where the user has given none.
    pub(super) fn write_lights(&self, asked: &mut Request) {
        let flags = LIGHTS.iter().map(|light| light.id).chain(["sky", "env"]);
        if flags.into_iter().all(|id| asked.first(id).is_none()) {
            self.write_default(asked);
        }
    }

    /// The chosen sphere light, if any.
    pub(super) fn chosen_sphere_light(&self) -> Option<usize> {
        self.sphere_light.filter(|n| *n < self.scene.lights.sphere_lights.len())
    }

    /// Adds a sphere light above the ground at a pixel.
    pub(super) fn place_light(&mut self, size: [u32; 2], at: [f64; 2]) -> Wish {
        let Some([x, y, ground]) = self.viewpoint.ground(&self.scene.field, size, at) else {
            return self.say("no ground there to place a light on");
        };
        let radius_m = SHARE * side_m(&self.scene.field);
        let position_m = [x, y, ground + 3.0 * radius_m];
        let radiance = [RADIANCE; 3];
        self.scene.lights.sphere_lights.push(SphereLight { position_m, radius_m, radiance });
        self.sphere_light = Some(self.scene.lights.sphere_lights.len() - 1);
        self.ask_for("sphere_light")
    }

    /// Takes hold of the sphere light at a pixel, or adds one there.
    pub(super) fn take_light(&mut self, size: [u32; 2], at: [f64; 2]) -> Wish {
        let off = |sphere_light: &SphereLight| {
            let on_screen = self.viewpoint.pixel(
                &self.scene.field,
                size,
                sphere_light.position_m,
                sphere_light.radius_m,
            );
            let ([x, y], radius) = on_screen?;
            let off = (x - at[0]).hypot(y - at[1]);
            (off <= radius.max(GRIP)).then_some(off)
        };
        let sphere_lights = self.scene.lights.sphere_lights.iter().enumerate();
        let near = sphere_lights.filter_map(|(n, sphere_light)| Some((n, off(sphere_light)?)));
        match near.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((n, _)) => {
                self.sphere_light = Some(n);
                Wish::Show
            }
            None => self.place_light(size, at),
        }
    }

    /// Moves the chosen sphere light with the pixel, at the same height above ground.
    pub(super) fn drag_light(&mut self, size: [u32; 2], from: [f64; 2], to: [f64; 2]) -> Wish {
        let ground = |at| self.viewpoint.ground(&self.scene.field, size, at);
        let (Some(n), Some(from), Some(to)) =
            (self.chosen_sphere_light(), ground(from), ground(to))
        else {
            return Wish::Nothing;
        };
        let [x, y, z] = self.scene.lights.sphere_lights[n].position_m;
        let moved = [x + to[0] - from[0], y + to[1] - from[1]];
        let heights = self.on_ground(moved).zip(self.on_ground([x, y]));
        let rise = heights.map_or(0.0, |(new, old)| new - old);
        self.scene.lights.sphere_lights[n].position_m = [moved[0], moved[1], z + rise];
        self.ask_for("sphere_light")
    }

    /// Changes the chosen sphere light by a key.
    pub(super) fn change_light(&mut self, key: &str) -> Wish {
        let Some(n) = self.chosen_sphere_light() else {
            return self.say("no light is chosen: press 5 and click one, or press O for a new one");
        };
        let sphere_lights = &mut self.scene.lights.sphere_lights;
        let sphere_light = &mut sphere_lights[n];
        let most = sphere_light.radiance.iter().copied().fold(0.0, f32::max);
        match key {
            "t" => {
                let is = |c: &[f32; 3]| c.map(|v| v * most) == sphere_light.radiance;
                let next = COLOURS.iter().position(is).map_or(0, |i| (i + 1) % COLOURS.len());
                sphere_light.radiance = COLOURS[next].map(|v| v * most);
            }
            "[" => sphere_light.radius_m *= 0.8,
            "]" => sphere_light.radius_m *= 1.25,
            ";" => sphere_light.radiance = sphere_light.radiance.map(|v| v * 0.8),
            "'" => sphere_light.radiance = sphere_light.radiance.map(|v| v * 1.25),
            "pageup" => sphere_light.position_m[2] += sphere_light.radius_m,
            "pagedown" => sphere_light.position_m[2] -= sphere_light.radius_m,
            _ => {
                sphere_lights.remove(n);
                self.sphere_light = sphere_lights.len().checked_sub(1);
            }
        }
        self.ask_for("sphere_light")
    }

    /// Absolute height of the ground at a place; none beyond it.
    pub(super) fn on_ground(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let field = &self.scene.field;
        let [cell_x, cell_y] = field.cell_m();
        height(field, [x / cell_x, (field.rows() - 1) as f64 - y / cell_y])
    }
}

/// Compass azimuth and elevation, degrees, without the rounding of radians.
pub fn compass(sun: &Sun) -> [f64; 2] {
    [(90.0 - degrees(sun.azimuth_rad)).rem_euclid(360.0), degrees(sun.elevation_rad)]
}
