//! What is shown and by what it is lit, and what keys and drags change of it.

mod figures;

use ridgelight::Result;
use ridgelight::files::Tone;
use ridgelight::plan::{self, Limits, Map, Picture, Plan, View, ViewOptions};
use ridgelight::scene::{Camera, Lens, Lights, Method, Quality, Scene, Sun};

use super::script::Button;
use super::waves::Waves;
use crate::args::{ViewArgs, sun};
use crate::scene_file::Asked;

/// Angle between the lower and the upper edge of what a camera sees, degrees.
const FOV_DEG: f64 = 40.0;

/// Cells of the mesh along a side, at most: larger fields are drawn through fewer samples.
const MOST_CELLS: u32 = 1024;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    Nothing,
    /// The same light, shown otherwise.
    Show,
    /// Other light or another field.
    Light,
    Picture,
    Scene,
    End,
}

/// Settings, lights, and the words that they were given by.
pub type Light = (Quality, Lights, Asked);

/// How much text is shown.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Text {
    Keys,
    Figures,
    Nothing,
}

/// What of the field is seen.
#[derive(Clone, Copy)]
struct Place {
    /// Column and row in the middle of the picture.
    middle: [f64; 2],
    samples_per_pixel: f64,
}

pub struct State {
    pub scene: Scene,
    pub quality: Quality,
    asked: Asked,
    waves: Option<Waves>,
    exposure: f32,
    /// None: all of the field.
    place: Option<Place>,
    /// None: from straight above.
    camera: Option<Camera>,
    text: Text,
    /// Said until the next key.
    pub message: Option<String>,
}

impl State {
    pub fn new(args: &ViewArgs, scene: Scene, quality: Quality) -> Self {
        Self {
            scene,
            quality,
            asked: args.asked.clone(),
            waves: None,
            exposure: args.exposure,
            place: None,
            camera: None,
            text: Text::Keys,
            message: None,
        }
    }

    /// What a key or a drag may change of the light.
    pub fn light(&self) -> Light {
        (self.quality, self.scene.lights.clone(), self.asked.clone())
    }

    /// Goes back to light that could be drawn, and says why.
    pub fn go_back(&mut self, light: Light, why: &ridgelight::Error) {
        (self.quality, self.scene.lights, self.asked) = light;
        self.message = Some(why.to_string());
    }

    pub fn tone(&self) -> Tone {
        Tone { exposure: self.exposure }
    }

    pub fn is_moving(&self) -> bool {
        self.waves.is_some()
    }

    /// What was given and what has been changed since, for a scene file; of a picture of this size.
    pub fn asked(&self, [width, height]: [u32; 2], limits: &Limits) -> Asked {
        let mut asked = self.asked.clone();
        // The window's, where there is no camera.
        asked.clear("size");
        let Some(camera) = &self.camera else { return asked };
        let Camera { target_m: [x, y, z], azimuth_rad, elevation_rad, distance_m, .. } = camera;
        let compass = hundredths(90.0 - azimuth_rad.to_degrees());
        let elevation = hundredths(elevation_rad.to_degrees());
        asked.set("camera", vec![format!("{compass},{elevation},{distance_m}")]);
        asked.set("look_at", vec![format!("{x},{y},{z}")]);
        let options = self.options([width, height], limits);
        asked.set("fov", vec![FOV_DEG.to_string()]);
        asked.set("size", vec![format!("{width}x{height}")]);
        asked.set("samples", vec![options.samples.to_string()]);
        asked.set("mesh_step", vec![options.mesh_step.to_string()]);
        asked
    }

    /// As `render` would, while nothing moves.
    pub fn plan(&self, limits: &Limits) -> Result<Plan> {
        let wanted = Picture { still: self.waves.is_none(), ..Picture::default() };
        plan::picture(&self.scene, &self.quality, limits, wanted)
    }

    /// The field of the next frame, where it moves.
    pub fn step(&mut self) -> Result<()> {
        if let Some(waves) = &mut self.waves {
            self.scene.field = waves.next()?;
        }
        Ok(())
    }

    /// What is seen in a picture of a size.
    pub fn map(&self, size: [u32; 2], swaps: bool, has_colour: bool) -> Map {
        let Place { middle, samples_per_pixel } = self.place(size);
        let corner = std::array::from_fn(|i| {
            // Whole pixels, so that samples of one side look alike.
            let pixels = middle[i] / samples_per_pixel - f64::from(size[i]) / 2.0;
            (pixels.round() * samples_per_pixel) as f32
        });
        Map {
            field: [self.scene.field.cols() as u32, self.scene.field.rows() as u32],
            has_colour,
            has_voids: self.scene.field.voids().is_some(),
            size,
            corner,
            samples_per_pixel: samples_per_pixel as f32,
            swaps,
        }
    }

    fn place(&self, size: [u32; 2]) -> Place {
        self.place.unwrap_or_else(|| {
            let field = [self.scene.field.cols(), self.scene.field.rows()].map(|n| n as f64);
            let needed = (field[0] / f64::from(size[0])).max(field[1] / f64::from(size[1]));
            // Whole pixels a sample where there are as many.
            let samples_per_pixel =
                if needed <= 1.0 { 1.0 / (1.0 / needed).floor() } else { needed };
            Place { middle: field.map(|n| n / 2.0), samples_per_pixel }
        })
    }

    fn shift(&mut self, size: [u32; 2], pixels: [f64; 2]) -> Wish {
        let mut place = self.place(size);
        let field = [self.scene.field.cols(), self.scene.field.rows()];
        for i in 0..2 {
            let moved = place.middle[i] - pixels[i] * place.samples_per_pixel;
            place.middle[i] = moved.clamp(0.0, field[i] as f64);
        }
        self.place = Some(place);
        Wish::Show
    }

    /// Nearer by a factor; what is at a pixel stays there.
    fn zoom(&mut self, size: [u32; 2], factor: f64, at: [f64; 2]) -> Wish {
        let mut place = self.place(size);
        let finer = (place.samples_per_pixel / factor).clamp(1.0 / 64.0, 64.0);
        for i in 0..2 {
            let off = at[i] - f64::from(size[i]) / 2.0;
            place.middle[i] += off * (place.samples_per_pixel - finer);
        }
        place.samples_per_pixel = finer;
        self.place = Some(place);
        Wish::Show
    }

    /// Turns the first sun, degrees; makes one where there is none.
    fn turn_sun(&mut self, clockwise: f64, up: f64) -> Wish {
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
        // The default of a scene without lights goes with the first light.
        if let Some([r, g, b]) = lights.sky {
            self.asked.set("sky", vec![format!("{r},{g},{b}")]);
        }
        self.asked.set("sun", all);
        Wish::Light
    }

    /// What a camera sees, where there is one.
    pub fn view(&self, lit: &Plan, size: [u32; 2], limits: &Limits) -> Result<Option<View>> {
        let Some(camera) = &self.camera else { return Ok(None) };
        let options = self.options(size, limits);
        View::new(&self.scene, lit, camera, &options, limits).map(Some)
    }

    fn options(&self, size: [u32; 2], limits: &Limits) -> ViewOptions {
        let longest = self.scene.field.rows().max(self.scene.field.cols()) as u32;
        ViewOptions {
            size,
            // Processors pay for each.
            samples: if limits.is_cpu { 1 } else { 4 },
            mesh_step: longest.div_ceil(MOST_CELLS).min(1024),
            ..ViewOptions::default()
        }
    }

    /// From the south, all of the field in the picture.
    fn begin_camera(&mut self, size: [u32; 2]) -> Wish {
        let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
        let lens = Lens::Perspective { fov_rad: FOV_DEG.to_radians() };
        let angles = [-90_f64, 45.0].map(f64::to_radians);
        if self.scene.field.rows().min(self.scene.field.cols()) < 2 {
            self.message = Some("a camera needs two rows and two columns".into());
            return Wish::Show;
        }
        self.camera = Some(Camera::around(&self.scene.field, None, angles, lens, aspect));
        Wish::Show
    }

    /// Moves what is seen by pixels.
    fn pan(&mut self, size: [u32; 2], pixels: [f64; 2]) -> Wish {
        let Some(camera) = &mut self.camera else { return self.shift(size, pixels) };
        let [right, up, _] = camera.axes();
        let half =
            if let Lens::Perspective { fov_rad } = camera.lens { fov_rad / 2.0 } else { 0.0 };
        let metres = 2.0 * camera.distance_m * half.tan() / f64::from(size[1].max(1));
        let moved = right * (-pixels[0] * metres) + up * (pixels[1] * metres);
        for (place, by) in camera.target_m.iter_mut().zip(moved.to_array()) {
            *place += by;
        }
        Wish::Show
    }

    /// Turns the camera, degrees; moves the map where there is none.
    fn turn(&mut self, size: [u32; 2], pixels: [f64; 2]) -> Wish {
        let Some(camera) = &mut self.camera else { return self.shift(size, pixels) };
        let per_pixel = 180.0 / f64::from(size[1].max(1));
        // Hundredths of degrees, which files keep.
        let azimuth = camera.azimuth_rad.to_degrees() - pixels[0] * per_pixel;
        camera.azimuth_rad = (90.0 - hundredths(90.0 - azimuth) % 360.0).to_radians();
        let elevation = camera.elevation_rad.to_degrees() + pixels[1] * per_pixel;
        camera.elevation_rad = hundredths(elevation).clamp(1.0, 90.0).to_radians();
        Wish::Show
    }

    /// Nearer by a factor.
    fn near(&mut self, size: [u32; 2], factor: f64, at: [f64; 2]) -> Wish {
        match &mut self.camera {
            Some(camera) => {
                camera.distance_m = (camera.distance_m / factor).clamp(1e-6, 1e12);
                Wish::Show
            }
            None => self.zoom(size, factor, at),
        }
    }

    /// A key by its name: a letter, `left`, `shift+left`, `escape`.
    pub fn key(&mut self, name: &str, size: [u32; 2]) -> Wish {
        self.message = None;
        let middle = size.map(|n| f64::from(n) / 2.0);
        let step = f64::from(size[0].min(size[1])) / 16.0;
        match name {
            "left" => self.turn(size, [step, 0.0]),
            "right" => self.turn(size, [-step, 0.0]),
            "up" => self.turn(size, [0.0, step]),
            "down" => self.turn(size, [0.0, -step]),
            "j" => self.pan(size, [step, 0.0]),
            "l" => self.pan(size, [-step, 0.0]),
            "i" => self.pan(size, [0.0, step]),
            "k" => self.pan(size, [0.0, -step]),
            "v" if self.camera.is_some() => {
                self.camera = None;
                Wish::Show
            }
            "v" => self.begin_camera(size),
            "home" if self.camera.is_some() => self.begin_camera(size),
            "shift+left" => self.turn_sun(-5.0, 0.0),
            "shift+right" => self.turn_sun(5.0, 0.0),
            "shift+up" => self.turn_sun(0.0, 2.0),
            "shift+down" => self.turn_sun(0.0, -2.0),
            "+" | "=" => self.near(size, 1.25, middle),
            "-" => self.near(size, 0.8, middle),
            "home" => {
                self.place = None;
                Wish::Show
            }
            "e" | "d" => {
                let factor = if name == "e" { 1.25 } else { 0.8 };
                self.exposure = (self.exposure * factor).clamp(1e-30, 1e30);
                Wish::Show
            }
            "h" => {
                self.text = match self.text {
                    Text::Keys => Text::Figures,
                    Text::Figures => Text::Nothing,
                    Text::Nothing => Text::Keys,
                };
                Wish::Show
            }
            "m" | "," | "." | "b" => self.turn_quality(name),
            "w" => {
                match self.waves.take() {
                    Some(waves) => self.scene.field = waves.end(),
                    None => self.waves = Some(Waves::over(self.scene.field.clone())),
                }
                Wish::Light
            }
            "p" => Wish::Picture,
            "s" => Wish::Scene,
            "q" | "escape" => Wish::End,
            _ => Wish::Nothing,
        }
    }

    fn turn_quality(&mut self, key: &str) -> Wish {
        let quality = &mut self.quality;
        match key {
            "m" => {
                quality.method = match quality.method {
                    Method::Auto => Method::Sweep,
                    Method::Sweep => Method::Pyramid,
                    Method::Pyramid => Method::Brute,
                    Method::Brute => Method::Auto,
                };
                self.asked.set("method", vec![method(quality).to_owned()]);
            }
            "b" => {
                quality.bounces.count = (quality.bounces.count + 1) % 4;
                self.asked.set("bounces", vec![quality.bounces.count.to_string()]);
            }
            _ => {
                let asked = quality.azimuths;
                let other = if key == "." { asked * 2 } else { asked / 2 };
                quality.azimuths = other.clamp(4, 1024);
                self.asked.set("azimuths", vec![quality.azimuths.to_string()]);
            }
        }
        Wish::Light
    }

    /// A drag by a button, pixels.
    pub fn drag(&mut self, button: Button, way: [f64; 2], size: [u32; 2]) -> Wish {
        match button {
            Button::Left => self.turn(size, way),
            Button::Middle => self.pan(size, way),
            Button::Right => self.turn_sun(way[0] / 2.0, -way[1] / 4.0),
        }
    }

    /// Notches of the wheel, upwards, at a pixel.
    pub fn wheel(&mut self, notches: f64, at: [f64; 2], size: [u32; 2]) -> Wish {
        self.near(size, 1.25_f64.powf(notches.clamp(-20.0, 20.0)), at)
    }
}

fn method(quality: &Quality) -> &'static str {
    match quality.method {
        Method::Auto => "auto",
        Method::Sweep => "sweep",
        Method::Pyramid => "pyramid",
        Method::Brute => "brute",
    }
}

/// Compass azimuth and elevation, degrees, less the rounding of radians.
fn compass(sun: &Sun) -> (f64, f64) {
    let degrees = |rad: f64| (rad.to_degrees() * 1e9).round() / 1e9;
    ((90.0 - degrees(sun.azimuth_rad)).rem_euclid(360.0), degrees(sun.elevation_rad))
}

fn hundredths(degrees: f64) -> f64 {
    (degrees * 100.0).round() / 100.0
}

/// As `--sun` takes it.
fn sun_words(sun: &Sun, azimuth: f64, elevation: f64) -> String {
    let diameter = (sun.diameter_rad.to_degrees() * 1e9).round() / 1e9;
    let [r, g, b] = sun.irradiance;
    format!("{azimuth},{elevation},{diameter},{r},{g},{b}")
}
