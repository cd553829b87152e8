//! Brush strokes, and marks of the brush and the lights on the picture.

use ridgelight::plan::Rectangle;

use super::{State, Tool, Wish};
use crate::view::brush::{Action, together};

/// Dots around a brush.
const RING: u32 = 24;

/// A square on the picture: its centre, half its side and its colour.
pub struct Mark {
    pub at: [f64; 2],
    pub half: u32,
    pub colour: [u8; 4],
    /// Whether it has a bright rim.
    pub is_chosen: bool,
}

impl State {
    pub(super) fn begin_stroke(&mut self, action: Action, at: [f64; 2], size: [u32; 2]) -> Wish {
        self.message = None;
        self.cursor = at;
        if self.is_moving() {
            return self.say("press W or G to stop the movement before you use a brush");
        }
        let Some([x, y, _]) = self.viewpoint.ground(&self.scene.field, size, at) else {
            return Wish::Show;
        };
        self.strokes.begin(&self.scene.field);
        self.stroke_m = [x, y];
        self.dab(action, [x, y])
    }

    /// Dabs a quarter of the radius apart, up to a pixel.
    pub(super) fn draw_stroke(&mut self, action: Action, to: [f64; 2], size: [u32; 2]) -> Wish {
        let ground = self.viewpoint.ground(&self.scene.field, size, to);
        let (Some([x, y, _]), true) = (ground, self.strokes.begun.is_some()) else {
            return Wish::Show;
        };
        let from = self.stroke_m;
        let length = (x - from[0]).hypot(y - from[1]);
        let spacing = self.brush.radius_m / 4.0;
        let mut wish = Wish::Show;
        for n in 1..=(length / spacing) as u32 {
            let share = f64::from(n) * spacing / length;
            self.stroke_m = [from[0] + share * (x - from[0]), from[1] + share * (y - from[1])];
            wish = self.dab(action, self.stroke_m);
        }
        wish
    }

    fn dab(&mut self, action: Action, at: [f64; 2]) -> Wish {
        match self.brush.dab(&mut self.scene.field, action, at) {
            Ok(Some(at)) => {
                self.strokes.reach(at);
                self.edit(at)
            }
            Ok(None) => Wish::Show,
            Err(why) => self.say(&why.to_string()),
        }
    }

    fn edit(&mut self, at: Rectangle) -> Wish {
        self.edited = together(self.edited, Some(at));
        Wish::Heights
    }

    /// Undoes or redoes a stroke.
    pub(super) fn undo(&mut self, is_back: bool) -> Wish {
        if self.is_moving() {
            return self.say("press W or G to stop the movement before you undo");
        }
        self.strokes.end(&self.scene.field);
        let field = &mut self.scene.field;
        let done = if is_back { self.strokes.undo(field) } else { self.strokes.redo(field) };
        match done {
            Ok(Some(at)) => self.edit(at),
            Ok(None) => self.say(if is_back { "nothing to undo" } else { "nothing to redo" }),
            Err(why) => self.say(&why.to_string()),
        }
    }

    /// Least and largest radius of a brush, m. At half a cell a stroke has at most eight dabs per
    /// cell that it crosses.
    pub(super) fn brush_radii_m(&self) -> [f64; 2] {
        let field = &self.scene.field;
        let [x, y] = field.cell_m();
        [0.5 * x.min(y), (field.cols() as f64 * x).max(field.rows() as f64 * y)]
    }

    pub(super) fn change_brush(&mut self, key: &str) -> Wish {
        let [least, most] = self.brush_radii_m();
        let brush = &mut self.brush;
        match key {
            "[" if brush.radius_m <= least => {
                return self.say("the brush is at its smallest, half a cell");
            }
            "]" if brush.radius_m >= most => {
                return self.say("the brush is at its largest, the field's longer side");
            }
            "[" => brush.radius_m = (brush.radius_m * 0.8).max(least),
            "]" => brush.radius_m = (brush.radius_m * 1.25).min(most),
            ";" => brush.strength *= 0.8,
            _ => brush.strength = (brush.strength * 1.25).min(1.0),
        }
        Wish::Show
    }

    /// Marks of the active tool in a picture of a size.
    pub fn marks(&self, size: [u32; 2]) -> Vec<Mark> {
        let field = &self.scene.field;
        match self.tool {
            Tool::Look => Vec::new(),
            Tool::Lights => {
                let sphere_lights = self.scene.lights.sphere_lights.iter().enumerate();
                let mark = |(n, sphere_light): (usize, &ridgelight::scene::SphereLight)| {
                    let (at, _) = self.viewpoint.pixel(
                        field,
                        size,
                        sphere_light.position_m,
                        sphere_light.radius_m,
                    )?;
                    let most = sphere_light.radiance.iter().copied().fold(1e-30, f32::max);
                    let [r, g, b] =
                        sphere_light.radiance.map(|v| (255.0 * (v / most).sqrt()) as u8);
                    let is_chosen = self.chosen_sphere_light() == Some(n);
                    Some(Mark { at, half: 3, colour: [r, g, b, 255], is_chosen })
                };
                sphere_lights.filter_map(mark).collect()
            }
            Tool::Brush(_) => {
                let Some([x, y, z]) = self.viewpoint.ground(field, size, self.cursor) else {
                    return Vec::new();
                };
                let dot = |n: u32| {
                    let (sin, cos) =
                        (std::f64::consts::TAU * f64::from(n) / f64::from(RING)).sin_cos();
                    let [x, y] = [x + self.brush.radius_m * cos, y + self.brush.radius_m * sin];
                    let at = self.on_ground([x, y]).unwrap_or(z);
                    let (at, _) = self.viewpoint.pixel(field, size, [x, y, at], 1.0)?;
                    Some(Mark { at, half: 1, colour: [255, 220, 80, 255], is_chosen: false })
                };
                (0..RING).filter_map(dot).collect()
            }
        }
    }
}
