//! The first sun, and balls of light: turned, placed, dragged, coloured, deleted.

use ridgelight::scene::{SphereLight, Sun};

use super::viewpoint::height;
use super::{State, Wish, hundredths};
use crate::args::sun;

/// What a ball's colour goes through; its brightest channel stays.
const COLOURS: [[f32; 3]; 6] = [
    [1.0, 1.0, 1.0],
    [1.0, 0.6, 0.3],
    [1.0, 0.25, 0.2],
    [0.3, 1.0, 0.4],
    [0.3, 0.5, 1.0],
    [0.8, 0.4, 1.0],
];

/// Radiance of a new ball, whose radius is a thirtieth of the field's shorter side and whose middle stands three radii
/// above the ground: 8/9 of white below it.
const RADIANCE: f32 = 8.0;
const SHARE: f64 = 1.0 / 30.0;

/// A ball is taken hold of from so far, pixels, however small it is.
const GRIP: f64 = 8.0;

impl State {
    /// Turns the first sun, degrees; makes one where there is none.
    pub(super) fn turn_sun(&mut self, clockwise: f64, up: f64) -> Wish {
        let lights = &mut self.scene.lights;
        let words = match lights.suns.first() {
            Some(sun) => {
                let (azimuth, elevation) = compass(sun);
                let azimuth = hundredths((azimuth + clockwise).rem_euclid(360.0)) % 360.0;
                sun_words(sun, azimuth, hundredths((elevation + up).clamp(0.0, 90.0)))
            }
            None => "315,30".to_owned(),
        };
        let Ok(sun) = sun(&words) else { return Wish::Nothing };
        let mut all: Vec<String> = vec![words];
        all.extend(lights.suns.iter().skip(1).map(|s| {
            let (azimuth, elevation) = compass(s);
            sun_words(s, azimuth, elevation)
        }));
        match lights.suns.first_mut() {
            Some(first) => *first = sun,
            None => lights.suns.push(sun),
        }
        self.ask_for_sky();
        self.asked.set("sun", all);
        Wish::Light
    }

    /// The default of a scene without lights goes with the first light that is written out.
    fn ask_for_sky(&mut self) {
        if let Some([r, g, b]) = self.scene.lights.sky {
            self.asked.set("sky", vec![format!("{r},{g},{b}")]);
        }
    }

    /// After any change of the balls.
    fn ask_for_balls(&mut self) -> Wish {
        let words = |ball: &SphereLight| {
            let ([x, y, z], [r, g, b]) = (ball.position_m, ball.radiance);
            format!("{x},{y},{z},{},{r},{g},{b}", ball.radius_m)
        };
        self.ask_for_sky();
        self.asked.set("light", self.scene.lights.spheres.iter().map(words).collect());
        Wish::Light
    }

    /// The ball that is chosen, where there are any.
    pub(super) fn chosen_ball(&self) -> Option<usize> {
        self.ball.filter(|n| *n < self.scene.lights.spheres.len())
    }

    /// A new ball above the ground at a pixel.
    pub(super) fn place_ball(&mut self, size: [u32; 2], at: [f64; 2]) -> Wish {
        let Some([x, y, ground]) = self.sight.ground(&self.scene.field, size, at) else {
            return self.say("no ground there for a light to stand on");
        };
        let radius_m = SHARE * self.side_m();
        let position_m = [x, y, ground + 3.0 * radius_m];
        let radiance = [RADIANCE; 3];
        self.scene.lights.spheres.push(SphereLight { position_m, radius_m, radiance });
        self.ball = Some(self.scene.lights.spheres.len() - 1);
        self.ask_for_balls()
    }

    /// Takes hold of the ball at a pixel, or makes one there.
    pub(super) fn take_ball(&mut self, size: [u32; 2], at: [f64; 2]) -> Wish {
        let off = |ball: &SphereLight| {
            let seen = self.sight.pixel(&self.scene.field, size, ball.position_m, ball.radius_m);
            let ([x, y], radius) = seen?;
            let off = (x - at[0]).hypot(y - at[1]);
            (off <= radius.max(GRIP)).then_some(off)
        };
        let balls = self.scene.lights.spheres.iter().enumerate();
        let near = balls.filter_map(|(n, ball)| Some((n, off(ball)?)));
        match near.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((n, _)) => {
                self.ball = Some(n);
                Wish::Show
            }
            None => self.place_ball(size, at),
        }
    }

    /// Moves the chosen ball so far over the ground as the pixel goes; as high above it as before.
    pub(super) fn drag_ball(&mut self, size: [u32; 2], from: [f64; 2], to: [f64; 2]) -> Wish {
        let ground = |at| self.sight.ground(&self.scene.field, size, at);
        let (Some(n), Some(from), Some(to)) = (self.chosen_ball(), ground(from), ground(to)) else {
            return Wish::Nothing;
        };
        let [x, y, z] = self.scene.lights.spheres[n].position_m;
        let moved = [x + to[0] - from[0], y + to[1] - from[1]];
        let heights = self.on_ground(moved).zip(self.on_ground([x, y]));
        let rise = heights.map_or(0.0, |(new, old)| new - old);
        self.scene.lights.spheres[n].position_m = [moved[0], moved[1], z + rise];
        self.ask_for_balls()
    }

    /// What a key does to the chosen ball.
    pub(super) fn change_ball(&mut self, key: &str) -> Wish {
        let Some(n) = self.chosen_ball() else {
            return self.say("no light is chosen: 5, then click one, or O for a new one");
        };
        let balls = &mut self.scene.lights.spheres;
        let ball = &mut balls[n];
        let most = ball.radiance.iter().copied().fold(0.0, f32::max);
        match key {
            "t" => {
                let is = |c: &[f32; 3]| c.map(|v| v * most) == ball.radiance;
                let next = COLOURS.iter().position(is).map_or(0, |i| (i + 1) % COLOURS.len());
                ball.radiance = COLOURS[next].map(|v| v * most);
            }
            "[" => ball.radius_m *= 0.8,
            "]" => ball.radius_m *= 1.25,
            ";" => ball.radiance = ball.radiance.map(|v| v * 0.8),
            "'" => ball.radiance = ball.radiance.map(|v| v * 1.25),
            "pageup" => ball.position_m[2] += ball.radius_m,
            "pagedown" => ball.position_m[2] -= ball.radius_m,
            _ => {
                balls.remove(n);
                self.ball = balls.len().checked_sub(1);
            }
        }
        self.ask_for_balls()
    }

    /// Absolute height of the ground at a place; none beyond it.
    pub(super) fn on_ground(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let field = &self.scene.field;
        let [cell_x, cell_y] = field.cell_m();
        height(field, [x / cell_x, (field.rows() - 1) as f64 - y / cell_y])
    }

    /// The field's shorter side.
    pub(super) fn side_m(&self) -> f64 {
        let field = &self.scene.field;
        let [x, y] = field.cell_m();
        (field.cols() as f64 * x).min(field.rows() as f64 * y)
    }
}

/// Compass azimuth and elevation, degrees, less the rounding of radians.
pub fn compass(sun: &Sun) -> (f64, f64) {
    let degrees = |rad: f64| (rad.to_degrees() * 1e9).round() / 1e9;
    ((90.0 - degrees(sun.azimuth_rad)).rem_euclid(360.0), degrees(sun.elevation_rad))
}

/// As `--sun` takes it.
fn sun_words(sun: &Sun, azimuth: f64, elevation: f64) -> String {
    let diameter = (sun.diameter_rad.to_degrees() * 1e9).round() / 1e9;
    let [r, g, b] = sun.irradiance;
    format!("{azimuth},{elevation},{diameter},{r},{g},{b}")
}
