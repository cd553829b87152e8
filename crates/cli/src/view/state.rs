//! The viewer's state: the shown scene, its lights, and what keys and drags change.

mod changes;
mod figures;
mod lights;
mod painting;
mod settings;
mod viewpoint;

use std::borrow::Cow;

use ridgelight::plan::{self, Limits, Map, Picture, Plan, Rectangle, View};
use ridgelight::scene::Tone;
use ridgelight::scene::{BounceSpecular, Camera, HeightField, Lights, Quality, Scene};
use ridgelight::{Error, Result};

use super::brush::{Action, Brush};
use super::moving::{Kind, Moving, side_m};
use super::script::Button;
use super::smaller::Blocks;
use super::strokes::Strokes;
use crate::args::ViewArgs;
use crate::render::{NIGHT_SHARE, exposure, white};
use crate::scene_file::Request;
use crate::setup;
use settings::Settings;
use viewpoint::{FOV_DEG, Viewpoint};

pub use changes::Change;
pub use figures::{Figures, KEYS};
pub use painting::Mark;

/// The effect of a key or of the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    Nothing,
    /// The same light, displayed differently.
    Show,
    /// Other light or another field.
    Light,
    /// Other heights in a rectangle: [`State::edited`].
    Heights,
    /// Measures the error against the reference.
    Error,
    Picture,
    Scene,
    /// Copies the command line of `render`.
    Copy,
    End,
}

/// Settings and lights, and the words that they were given by.
pub type Light = (Quality, Lights, Request);

/// How much of the panel is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    Keys,
    Settings,
    Figures,
    Nothing,
}

/// The left button's tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tool {
    Look,
    Brush(Action),
    Lights,
}

pub struct State {
    pub scene: Scene,
    pub quality: Quality,
    asked: Request,
    /// The movement, if there is one.
    pub moving: Option<Moving>,
    pub exposure: f32,
    /// [`crate::render::white`] of the field as it was read.
    white: f64,
    /// Whether the window started with a sun below the horizontal and no other light.
    starts_at_night: bool,
    /// Whether the exposure is to be found from the picture.
    pub needs_exposure: bool,
    /// Whether the exposure is a preview's, to be found again from the full light.
    pub has_coarse_exposure: bool,
    /// Whether the environment is the clear sky around the first sun.
    has_clear_sky: bool,
    viewpoint: Viewpoint,
    pub text: Text,
    settings: Settings,
    tool: Tool,
    brush: Brush,
    strokes: Strokes,
    /// Where heights have changed since they were last taken.
    pub edited: Option<Rectangle>,
    /// The current end of the stroke that is being drawn, absolute.
    stroke_m: [f64; 2],
    /// The chosen sphere light.
    sphere_light: Option<usize>,
    cursor: [f64; 2],
    /// Whether the comparison pictures are shown.
    pub is_split: bool,
    /// A message, shown until the next key.
    pub message: Option<String>,
}

impl State {
    pub fn new(args: &ViewArgs, scene: Scene, quality: Quality) -> Self {
        let has_clear_sky = scene.lights.environment.is_some() && args.scene.lights.env.is_none();
        let white = white(&scene.field, setup::tint_of(&args.scene));
        let starts_at_night = setup::is_night(&args.scene.lights, &scene.lights);
        let mut default = Quality::default();
        if !args.quality.gives("azimuths") {
            default.azimuths = quality.azimuths;
        }
        let mut state = Self {
            scene,
            white,
            starts_at_night,
            quality,
            asked: args.asked.clone(),
            moving: None,
            exposure: args.exposure.unwrap_or(1.0),
            needs_exposure: args.exposure.is_none(),
            has_coarse_exposure: false,
            has_clear_sky,
            viewpoint: Viewpoint::default(),
            text: Text::Keys,
            settings: Settings::new(default),
            tool: Tool::Look,
            brush: Brush { radius_m: 0.0, strength: 0.1 },
            strokes: Strokes::default(),
            edited: None,
            stroke_m: [0.0; 2],
            sphere_light: None,
            cursor: [0.0; 2],
            is_split: false,
            message: None,
        };
        state.brush.radius_m = (side_m(&state.scene.field) / 16.0).max(state.brush_radii_m()[0]);
        state
    }

    /// The parts of the light that a key or a drag may change.
    pub fn light(&self) -> Light {
        (self.quality, self.scene.lights.clone(), self.asked.clone())
    }

    /// Whether nothing but suns and the environment differs from an earlier light, with as many suns.
    pub fn has_only_turned(&self, (quality, lights, _): &Light) -> bool {
        let now = &self.scene.lights;
        let rest = |all: &Lights| (all.sky, all.suns.len(), all.environment.is_some());
        *quality == self.quality
            && rest(lights) == rest(now)
            && lights.keys == now.keys
            && lights.near().eq(now.near())
    }

    /// Returns to the last light that could be drawn, and shows why.
    pub fn go_back(&mut self, light: Light, why: Error) {
        (self.quality, self.scene.lights, self.asked) = light;
        self.message = Some(setup::in_flags(why).to_string());
    }

    /// Takes the exposure that suits a picture, of coarse light or of the full one.
    pub fn expose(&mut self, picture: &[[f32; 3]], voids: Option<&[bool]>, is_coarse: bool) {
        let is_night = self.starts_at_night && setup::has_no_light_but_sky(&self.scene.lights);
        let white = if is_night { NIGHT_SHARE * self.white } else { self.white };
        (self.exposure, self.needs_exposure) = (exposure(picture, voids, white), false);
        self.has_coarse_exposure = is_coarse;
    }

    /// Takes the user's exposure.
    fn set_exposure(&mut self, exposure: f32) {
        (self.exposure, self.needs_exposure) = (exposure.clamp(1e-30, 1e30), false);
        self.has_coarse_exposure = false;
    }

    pub fn tone(&self) -> Tone {
        // The range of maps.
        Tone::picture(self.exposure.clamp(f32::MIN_POSITIVE, 1e34))
    }

    pub fn is_moving(&self) -> bool {
        self.moving.is_some()
    }

    /// The camera, if there is one.
    pub fn camera(&self) -> Option<Camera> {
        self.viewpoint.camera
    }

    /// Whether there is a camera.
    pub fn has_camera(&self) -> bool {
        self.viewpoint.camera.is_some()
    }

    /// Where specular is viewed from: the camera's eye, if there is a camera and the ground has specular.
    pub fn eye_m(&self) -> Option<[f64; 3]> {
        self.camera().filter(|_| self.has_specular()).map(|camera| camera.eye_m().to_array())
    }

    /// The same over a grid of blocks.
    pub fn eye_over(&self, blocks: &Blocks) -> Option<[f64; 3]> {
        let camera = self.camera().filter(|_| self.has_specular())?;
        Some(blocks.camera(&self.scene.field, &camera).eye_m().to_array())
    }

    fn has_specular(&self) -> bool {
        self.scene.surface.specular.is_some()
    }

    /// Whether heights differ from the file's.
    pub fn has_other_heights(&self) -> bool {
        self.is_moving() || self.strokes.have_changed()
    }

    fn say(&mut self, message: &str) -> Wish {
        self.message = Some(message.to_owned());
        Wish::Show
    }

    /// Arguments and changes for a scene file, for a picture of this size. `heights` is the file of
    /// changed heights.
    pub fn asked(
        &self,
        [width, height]: [u32; 2],
        limits: &Limits,
        heights: Option<&str>,
    ) -> Request {
        let mut asked = self.asked.clone();
        self.write_lights(&mut asked);
        self.settings.write_default(&mut asked);
        if let Some(heights) = heights {
            let field = &self.scene.field;
            let [x, y] = field.cell_m();
            asked.set("path", vec![heights.to_owned()]);
            asked.set("cell", vec![format!("{x},{y}")]);
            asked.clear("z_scale");
            asked.clear("nodata");
            if field.voids().is_some() {
                asked.set("nodata", vec!["nan".to_owned()]);
            }
        }
        // The window's, where there is no camera.
        asked.clear("size");
        let Some(camera) = &self.viewpoint.camera else { return asked };
        let Camera { target_m: [x, y, z], azimuth_rad, elevation_rad, distance_m, .. } = camera;
        let compass = hundredths(90.0 - azimuth_rad.to_degrees());
        let elevation = hundredths(elevation_rad.to_degrees());
        asked.set("camera", vec![format!("{compass},{elevation},{distance_m}")]);
        asked.set("look_at", vec![format!("{x},{y},{z}")]);
        let options = Viewpoint::options(&self.scene.field, [width, height], limits);
        asked.set("fov", vec![FOV_DEG.to_string()]);
        asked.set("size", vec![format!("{width}x{height}")]);
        asked.set("samples", vec![options.samples.to_string()]);
        asked.set("mesh_step", vec![options.mesh_step.to_string()]);
        asked
    }

    /// The light that `render` computes; while the field moves or a brush is active, the kind that
    /// edits continue from.
    pub fn plan(&self, limits: &Limits) -> Result<Plan> {
        let has_brush = matches!(self.tool, Tool::Brush(_));
        let still = !self.is_moving() && !has_brush;
        let wanted = Picture { still, eye_m: self.eye_m(), ..Picture::default() };
        let plan = |wanted| plan::picture(&self.scene, &self.quality, limits, wanted);
        if has_brush && !self.is_moving() {
            let kept = plan(Picture { keeps_horizons: true, ..wanted });
            if let Ok(kept) = kept.map(|kept| (!kept.edit_passes.is_empty()).then_some(kept))
                && let Some(kept) = kept
            {
                return Ok(kept);
            }
        }
        plan(wanted)
    }

    /// The same light without shadows and bounces.
    pub fn plan_off(&self, limits: &Limits) -> Result<Plan> {
        let wanted = Picture { unshadowed: true, eye_m: self.eye_m(), ..Picture::default() };
        plan::picture(&self.scene, &self.quality, limits, wanted)
    }

    /// Moves on by one frame, if the field moves. With `has_heights` the scene takes its heights; a preview moves its own
    /// grids.
    pub fn step(&mut self, has_heights: bool) -> Result<()> {
        if let Some(moving) = &mut self.moving {
            moving.step();
            if has_heights {
                self.scene.field = moving.field()?;
            }
        }
        Ok(())
    }

    /// The field as it is shown, on its full grid.
    pub fn field_shown(&self) -> Result<Cow<'_, HeightField>> {
        match &self.moving {
            Some(moving) => moving.field().map(Cow::Owned),
            None => Ok(Cow::Borrowed(&self.scene.field)),
        }
    }

    /// The map section in a picture of a size.
    pub fn map(&self, size: [u32; 2], swaps: bool, has_colour: bool) -> Map {
        self.viewpoint.map(&self.scene.field, (size, swaps, has_colour), self.tone())
    }

    /// A camera view of a plan's light, if there is a camera; of the full scene or of one in blocks; on the mesh of a moving
    /// view or on the full one.
    pub fn view(
        &self,
        (scene, blocks, is_coarse): (&Scene, Option<Blocks>, bool),
        lit: &Plan,
        size: [u32; 2],
        limits: &Limits,
    ) -> Result<Option<View>> {
        let mut viewpoint = self.viewpoint;
        if let (Some(camera), Some(blocks)) = (&mut viewpoint.camera, blocks) {
            *camera = blocks.camera(&self.scene.field, camera);
        }
        viewpoint.view((scene, is_coarse), lit, size, limits)
    }

    /// Handles a key by its name: a letter, `left`, `shift+left`, `escape`.
    pub fn key(&mut self, name: &str, size: [u32; 2]) -> Wish {
        self.message = None;
        let middle = size.map(|n| f64::from(n) / 2.0);
        let step = f64::from(size[0].min(size[1])) / 16.0;
        let field = &self.scene.field;
        match name {
            "left" => self.viewpoint.turn(field, size, [step, 0.0]),
            "right" => self.viewpoint.turn(field, size, [-step, 0.0]),
            "up" => self.viewpoint.turn(field, size, [0.0, step]),
            "down" => self.viewpoint.turn(field, size, [0.0, -step]),
            "j" => self.viewpoint.pan(field, size, [step, 0.0]),
            "l" => self.viewpoint.pan(field, size, [-step, 0.0]),
            "i" => self.viewpoint.pan(field, size, [0.0, step]),
            "k" => self.viewpoint.pan(field, size, [0.0, -step]),
            "+" | "=" => self.viewpoint.near(field, size, 1.25, middle),
            "-" => self.viewpoint.near(field, size, 0.8, middle),
            "home" => self.viewpoint.all(field, size),
            "v" if self.viewpoint.camera.is_some() => self.viewpoint.camera = None,
            "v" if field.rows().min(field.cols()) < 2 => {
                return self.say("a camera needs two rows and two columns");
            }
            "v" if self.has_specular()
                && self.quality.bounces.count > 0
                && self.quality.bounces.specular == BounceSpecular::Scalar =>
            {
                return self.say("a camera needs bounce_specular vector or vector-f16");
            }
            "v" => self.viewpoint.begin_camera(field, size),
            "e" | "d" if self.needs_exposure => {}
            "e" => self.set_exposure(self.exposure * 1.25),
            "d" => self.set_exposure(self.exposure * 0.8),
            "a" => self.needs_exposure = true,
            "h" => {
                self.text = match self.text {
                    Text::Keys | Text::Settings => Text::Figures,
                    Text::Figures => Text::Nothing,
                    Text::Nothing => Text::Keys,
                };
            }
            "c" if size[0] < 24 && !self.is_split => {
                return self.say("the window is too narrow for three pictures");
            }
            "c" => self.is_split = !self.is_split,
            _ => return self.key_of_light(name, size),
        }
        Wish::Show
    }

    /// Keys that change more than the view.
    fn key_of_light(&mut self, name: &str, size: [u32; 2]) -> Wish {
        match name {
            "shift+left" => self.turn_sun(-5.0, 0.0),
            "shift+right" => self.turn_sun(5.0, 0.0),
            "shift+up" => self.turn_sun(0.0, 2.0),
            "shift+down" => self.turn_sun(0.0, -2.0),
            "m" => self.turn_setting("method", true),
            "b" => self.turn_bounces(),
            "," | "." => {
                let chosen = self.settings.chosen().to_owned();
                self.turn_setting(&chosen, name == ".")
            }
            "tab" | "shift+tab" => {
                // The first press opens the list, the next ones move in it.
                if self.text == Text::Settings {
                    self.settings.choose(name == "tab");
                }
                self.text = Text::Settings;
                Wish::Show
            }
            "1" => self.take(Tool::Look),
            "2" => self.take(Tool::Brush(Action::Raise)),
            "3" => self.take(Tool::Brush(Action::Lower)),
            "4" => self.take(Tool::Brush(Action::Erode)),
            "5" => self.take(Tool::Lights),
            "[" | "]" | ";" | "'" if self.tool != Tool::Lights => self.change_brush(name),
            "[" | "]" | ";" | "'" | "t" | "x" | "delete" | "pageup" | "pagedown" => {
                self.change_light(name)
            }
            "o" => {
                self.tool = Tool::Lights;
                self.place_light(size, size.map(|n| f64::from(n) / 2.0))
            }
            "z" => self.undo(true),
            "y" => self.undo(false),
            "w" => self.move_by(Kind::Waves),
            "g" => self.move_by(Kind::Ridge),
            "r" => Wish::Error,
            "p" => Wish::Picture,
            "s" => Wish::Scene,
            "q" | "escape" => Wish::End,
            _ => Wish::Nothing,
        }
    }

    /// Switches tools. Brushes need another plan.
    fn take(&mut self, tool: Tool) -> Wish {
        self.strokes.end(&self.scene.field);
        self.tool = tool;
        Wish::Light
    }

    /// Starts or stops the movement.
    fn move_by(&mut self, kind: Kind) -> Wish {
        self.strokes.end(&self.scene.field);
        let before = self.moving.take().map(|moving| {
            self.scene.field = moving.still;
            moving.kind
        });
        if before != Some(kind) {
            self.moving = Some(Moving::over(self.scene.field.clone(), kind));
        }
        Wish::Light
    }

    fn turn_bounces(&mut self) -> Wish {
        // None, one, two, three, and none again.
        if self.quality.bounces.count >= 3 {
            self.asked.set("bounces", vec!["0".to_owned()]);
            self.quality.bounces.count = 0;
            return Wish::Light;
        }
        self.turn_setting("bounces", true)
    }

    fn turn_setting(&mut self, id: &str, ahead: bool) -> Wish {
        let changed = self.settings.turn(id, ahead, &mut self.asked);
        self.take_quality(changed)
    }

    /// Takes changed settings, or shows why they were refused.
    fn take_quality(&mut self, changed: std::result::Result<Quality, String>) -> Wish {
        match changed {
            Ok(quality) => {
                self.quality = quality;
                Wish::Light
            }
            Err(why) => self.say(&why),
        }
    }

    /// Presses a button at a pixel.
    pub fn press(&mut self, button: Button, at: [f64; 2], size: [u32; 2]) -> Wish {
        match (button, self.tool) {
            (Button::Left, Tool::Brush(action)) => self.begin_stroke(action, at, size),
            (Button::Left, Tool::Lights) => {
                self.message = None;
                self.take_light(size, at)
            }
            _ => Wish::Nothing,
        }
    }

    /// A drag by a button from a pixel, pixels.
    pub fn drag(&mut self, button: Button, from: [f64; 2], way: [f64; 2], size: [u32; 2]) -> Wish {
        let to = [from[0] + way[0], from[1] + way[1]];
        self.cursor = to;
        let field = &self.scene.field;
        match (button, self.tool) {
            (Button::Left, Tool::Brush(action)) => return self.draw_stroke(action, to, size),
            (Button::Left, Tool::Lights) => return self.drag_light(size, from, to),
            (Button::Left, Tool::Look) => self.viewpoint.turn(field, size, way),
            (Button::Middle, _) => self.viewpoint.pan(field, size, way),
            (Button::Right, _) => return self.turn_sun(way[0] / 2.0, -way[1] / 4.0),
        }
        Wish::Show
    }

    /// Releases the button.
    pub fn release(&mut self) -> Wish {
        self.strokes.end(&self.scene.field);
        Wish::Show
    }

    /// Moves the mouse without a button over a picture: brushes show where they are.
    pub fn point(&mut self, at: [f64; 2]) -> Wish {
        self.cursor = at;
        if matches!(self.tool, Tool::Brush(_)) { Wish::Show } else { Wish::Nothing }
    }

    /// Notches of the wheel, upwards, at a pixel.
    pub fn wheel(&mut self, notches: f64, at: [f64; 2], size: [u32; 2]) -> Wish {
        let factor = 1.25_f64.powf(notches.clamp(-20.0, 20.0));
        self.viewpoint.near(&self.scene.field, size, factor, at);
        Wish::Show
    }
}

fn hundredths(degrees: f64) -> f64 {
    (degrees * 100.0).round() / 100.0
}
