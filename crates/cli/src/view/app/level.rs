//! The grids of a preview: the light of coarse ones, and the slopes that show it.

use ridgelight::Result;
use ridgelight::gpu::{Frame, ImageArg, Work};
use ridgelight::plan::{self, Limits, Picture, Rectangle};
use ridgelight::scene::{
    Albedo, Bounces, Fuse, HeightField, Lights, Lines, Method, Quality, Scene, Sun, Surface,
};
use ridgelight_viewer::Screen;

use super::super::moving::Moving;
use super::super::smaller::Blocks;
use super::super::state::State;
use super::drawing::{after_new_heights, refilled, replan, whole};

/// Azimuths of a preview's sky. On a smooth field 8 change its light by 0.1 to 0.3 %, a coarser grid by some percent.
const AZIMUTHS: u32 = 8;
/// The grids of a preview: of all light, of which the sky is shown; of the sun alone; of the slopes.
pub const GRIDS: usize = 3;
pub const SKY: usize = 0;
pub const SUN: usize = 1;
pub const SLOPES: usize = 2;

/// What a grid needs of the heights, without a device.
pub struct Ground {
    blocks: Blocks,
    scene: Scene,
    normals: Vec<f32>,
}

impl Ground {
    pub fn new(scene: &Scene, of: usize, side: usize) -> Result<Self> {
        let blocks = Blocks::of(&scene.field, side);
        let mut coarse = blocks.scene(scene)?;
        if of == SUN {
            coarse.surface = Surface { border: coarse.surface.border, ..Surface::default() };
        }
        let normals = normals((of, &blocks), &coarse, Some(&scene.field));
        Ok(Self { blocks, scene: coarse, normals })
    }
}

/// The normals of a grid. Slopes have the means of the full field's normals, unless that field moves.
fn normals((of, blocks): (usize, &Blocks), own: &Scene, full: Option<&HeightField>) -> Vec<f32> {
    let border = own.surface.border;
    match full.filter(|_| of == SLOPES) {
        Some(field) => blocks.normals(field, border),
        None => Blocks::of(&own.field, 1).normals(&own.field, border),
    }
}

/// A scene on a coarser grid.
pub struct Level {
    /// Which of the grids.
    pub of: usize,
    pub blocks: Blocks,
    pub scene: Scene,
    pub lit: Option<Frame>,
    /// Texels of the normals that are shaded; whether the device has older ones, and older heights.
    normals: Vec<f32>,
    are_normals_new: bool,
    are_heights_new: bool,
    /// Whether lights or settings have changed since the device's light was computed.
    is_light_new: bool,
    /// Whether the last run had all passes.
    pub ran_all: bool,
    /// The field without movement, in movement.
    moving: Option<Moving>,
    /// How often it was lit. The time of the first run is not measured, as it does not predict later ones.
    pub runs: u32,
}

impl Level {
    pub fn new(of: usize, Ground { blocks, scene, normals }: Ground) -> Self {
        Self {
            of,
            blocks,
            scene,
            lit: None,
            normals,
            are_normals_new: true,
            are_heights_new: true,
            is_light_new: true,
            ran_all: true,
            moving: None,
            runs: 0,
        }
    }

    /// Whether it has light to show.
    pub fn is_used(&self) -> bool {
        self.of != SUN || !self.scene.lights.suns.is_empty()
    }

    /// Takes the state's lights and heights.
    pub fn take(
        &mut self,
        state: &State,
        (edited, has_new_light): (Option<Rectangle>, bool),
    ) -> Result<()> {
        self.is_light_new |= has_new_light;
        self.blocks.take_lights(&state.scene, &mut self.scene);
        if self.of == SUN {
            // The slopes apply its colour, so that its own images have one channel.
            let grey = |(_, sun): (usize, &Sun)| Sun { irradiance: [1.0; 3], ..*sun };
            let suns = first_sun(&self.scene).map(grey).into_iter().collect();
            self.scene.lights = Lights { suns, ..Lights::default() };
        }
        self.are_heights_new |= state.is_moving() || self.moving.is_some() || edited.is_some();
        match (&state.moving, &mut self.moving) {
            (Some(full), moving) => {
                if edited.is_some() || moving.as_ref().is_none_or(|moving| moving.kind != full.kind)
                {
                    let still = self.blocks.field(&full.still)?;
                    *moving = Some(full.over_other(still));
                }
                let moving = moving.as_mut().expect("made above");
                moving.follow(full);
                self.scene.field = moving.field()?;
                self.take_normals(None);
            }
            (None, moving) if moving.is_some() => {
                *moving = None;
                self.scene.field = self.blocks.field(&state.scene.field)?;
                self.take_normals(Some(&state.scene.field));
            }
            (None, _) => {
                if let Some(at) = edited {
                    let (field, border) = (&state.scene.field, self.scene.surface.border);
                    self.blocks.edit(field, &mut self.scene.field, at)?;
                    if self.of == SLOPES {
                        self.blocks.edit_normals((field, border), &mut self.normals, at);
                    } else {
                        let (own, at) = (&self.scene.field, self.blocks.within_blocks(at));
                        Blocks::of(own, 1).edit_normals((own, border), &mut self.normals, at);
                    }
                    self.are_normals_new = true;
                }
            }
        }
        Ok(())
    }

    fn take_normals(&mut self, full: Option<&HeightField>) {
        self.normals = normals((self.of, &self.blocks), &self.scene, full);
        self.are_normals_new = true;
    }

    /// Runs all passes, or those that the changes need. The slot, if there are any, holds their times.
    pub fn run(&mut self, screen: &mut Screen, borrowed: &[ImageArg]) -> Result<Option<usize>> {
        self.runs += 1;
        let lit = self.lit.as_mut().expect("planned");
        let count = lit.plan().passes.len();
        let passes = match (self.are_heights_new, self.is_light_new) {
            // The light that slopes borrow is new in each frame.
            (true, false) if borrowed.is_empty() => after_new_heights(lit),
            // Only what a new plan changed: a sun has no tables.
            (false, _) if self.of == SUN => lit.renderer().passes_after(&[]),
            _ => (0..count).collect(),
        };
        self.ran_all = passes.len() == count;
        if passes.is_empty() {
            self.is_light_new = false;
            return Ok(None);
        }
        let field = &self.scene.field;
        let heights = self.are_heights_new.then(|| (field.heights_m(), whole(field)));
        let slot = screen.light(lit, heights, (Work::Passes(&passes), borrowed))?;
        (self.are_heights_new, self.is_light_new) = (false, false);
        Ok(Some(slot))
    }

    /// Plans the light of a coarse grid.
    fn plan_light(&mut self, screen: &mut Screen, state: &State, limits: &Limits) -> Result<()> {
        let eye_m = state.eye_over(&self.blocks);
        let wanted = Picture { light_layers: self.of == SKY, eye_m, ..Picture::default() };
        let plan = plan::picture(&self.scene, &coarser(&state.quality, self.of), limits, wanted)?;
        self.is_light_new |= replan(screen, &mut self.lit, plan, &self.scene)?;
        Ok(())
    }

    /// The image of the plan's input or output of a name.
    fn image(&self, name: &str) -> Option<ImageArg> {
        let lit = self.lit.as_ref()?;
        let input = lit.plan().inputs().position(|(_, input)| input.name == name);
        let output = lit.plan().outputs().position(|(_, output)| output.name == name);
        let of_input = input.map(|at| lit.inputs()[at]);
        of_input.or_else(|| output.map(|at| lit.outputs()[at]))
    }

    /// Plans the coarse grids' light on the slopes of this one. Returns the images that it borrows.
    fn plan_slopes(
        &mut self,
        screen: &mut Screen,
        [sky, sun]: [&mut Level; 2],
        has_camera: bool,
        limits: &Limits,
    ) -> Result<Vec<ImageArg>> {
        let plan_of = |level: &Level| level.lit.as_ref().expect("lit before").plan().clone();
        let (of_sky, of_sun) = (plan_of(sky), sun.is_used().then(|| plan_of(sun)));
        let count_of_normals = 2 + usize::from(sun.is_used());
        let suns = of_sun.as_ref().map(|plan| (&sun.scene, plan));
        let plan = plan::preview(&self.scene, (&sky.scene, &of_sky), suns, limits)?;
        let mut borrowed = vec![sky.image("radiance")];
        if let Some((n, _)) = first_sun(&sky.scene) {
            borrowed.push(sky.image(&format!("direct.sun{n}")));
        }
        if matches!(sky.scene.surface.albedo, Albedo::Map(_)) {
            borrowed.push(sky.image("albedo"));
        }
        if sun.is_used() {
            borrowed.push(sun.image("radiance"));
        }
        let borrowed: Vec<ImageArg> = borrowed.into_iter().flatten().collect();
        let fits = self.lit.as_ref().is_some_and(|lit| lit.plan().resources == plan.resources);
        match self.lit.as_mut().filter(|_| fits) {
            Some(lit) => {
                screen.gpu().replace_plan(lit, plan)?;
                // Only for what is behind the ground: the ground's light comes from the coarse grid.
                if has_camera {
                    refilled(screen, lit, &self.scene)?;
                }
            }
            None => {
                if let Some(old) = self.lit.take() {
                    screen.end(old)?;
                }
                // Borrowed images need no contents.
                let mut contents = plan::picture_inputs(&self.scene);
                contents.truncate(plan.inputs().count() - borrowed.len() - count_of_normals);
                let rest = plan.inputs().skip(contents.len());
                let empty: Vec<Vec<f32>> =
                    rest.map(|(_, input)| vec![0.0; (input.bytes() / 4) as usize]).collect();
                contents.extend(empty);
                self.lit = Some(screen.frame(plan, &contents)?);
                [sky.are_normals_new, sun.are_normals_new, self.are_normals_new] = [true; 3];
            }
        }
        let lit = self.lit.as_ref().expect("made above");
        let first = lit.plan().inputs().count() - borrowed.len() - count_of_normals;
        let all = [
            (&self.normals, &mut self.are_normals_new),
            (&sky.normals, &mut sky.are_normals_new),
            (&sun.normals, &mut sun.are_normals_new),
        ];
        for (n, (normals, are_new)) in all.into_iter().take(count_of_normals).enumerate() {
            if *are_new {
                screen.gpu().refill(lit, first + n, normals)?;
                *are_new = false;
            }
        }
        Ok(borrowed)
    }
}

/// Plans a grid; the slopes come last, as they show the light of the other two. Returns the images that a grid borrows. New
/// environments and normals wait for the device.
pub fn plan_level(
    [sky, sun, slopes]: &mut [Level; GRIDS],
    of: usize,
    screen: &mut Screen,
    (state, limits): (&State, &Limits),
) -> Result<Vec<ImageArg>> {
    if of == SLOPES {
        return slopes.plan_slopes(screen, [sky, sun], state.has_camera(), limits);
    }
    let level = if of == SKY { sky } else { sun };
    level.plan_light(screen, state, limits).map(|()| Vec::new())
}

/// Plans the first of the grids that has no frame, so that input waits for one of them at most. Returns whether there was
/// one.
pub fn plan_next(
    [sky, sun, slopes]: &mut [Level; GRIDS],
    screen: &mut Screen,
    state: &State,
    limits: &Limits,
) -> Result<bool> {
    for coarse in [&mut *sky, &mut *sun] {
        if coarse.is_used() && coarse.lit.is_none() {
            return coarse.plan_light(screen, state, limits).map(|()| true);
        }
    }
    let lacks_slopes = slopes.lit.is_none();
    if lacks_slopes {
        slopes.plan_slopes(screen, [sky, sun], state.has_camera(), limits)?;
    }
    Ok(lacks_slopes)
}

/// The first sun with irradiance, and its number, from 1.
fn first_sun(scene: &Scene) -> Option<(usize, &Sun)> {
    let mut suns = (1..).zip(&scene.lights.suns);
    suns.find(|(_, sun)| sun.irradiance.iter().any(|e| *e > 0.0))
}

/// The user's settings with fewer azimuths and the default method, as the others are slow, and with the default lines,
/// as some need another method. The sun has one azimuth and no bounces; all other light uses `aimed-nearest`, which is faster.
fn coarser(quality: &Quality, of: usize) -> Quality {
    let (count, fuse) = match of {
        SUN => (0, quality.fuse),
        _ => (quality.bounces.count, Fuse::AimedNearest),
    };
    Quality {
        azimuths: quality.azimuths.min(AZIMUTHS),
        sun_azimuths: 1,
        bounces: Bounces { count, ..quality.bounces },
        method: Method::default(),
        lines: Lines::default(),
        fuse,
        ..*quality
    }
}

/// The work of a grid of blocks of `side` grid points, as its rate counts it.
pub fn grid_work(scene: &Scene, quality: &Quality, of: usize, side: usize) -> f64 {
    let texels = (scene.field.rows() * scene.field.cols()) as f64 / (side * side) as f64;
    match of {
        SKY => work(scene, &coarser(quality, SKY), side),
        // Heights, a sweep and a sun.
        SUN => 3.0 * texels,
        _ => texels,
    }
}

/// Texels times azimuths, with a sun or a sphere light as eight and key lights by their slices, on blocks of `side` grid points.
pub fn work(scene: &Scene, quality: &Quality, side: usize) -> f64 {
    let texels = (scene.field.rows() * scene.field.cols()) as f64 / (side * side) as f64;
    let lights = &scene.lights;
    let has_sky = lights.sky.is_some() || lights.environment.is_some() || quality.bounces.count > 0;
    let of_sky = if has_sky { f64::from(quality.azimuths) } else { 0.0 };
    let of_keys: u32 = lights.keys.iter().map(|key| key.slices(8)).sum();
    let others = 8 * (lights.suns.len() + lights.near().count() + 1) as u32 + of_keys;
    texels * (of_sky * f64::from(1 + 2 * quality.bounces.count) + f64::from(others))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Lights, SETTINGS, Surface, Values, setting};

    /// With every method: what the full light accepts, previews accept too.
    #[test]
    fn every_valid_setting_has_a_preview() {
        let field = HeightField::new(64, 64, &[0.0; 64 * 64], [1.0; 2], None).unwrap();
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let limits = Limits::boundless(true, 1 << 40);
        let words = |values: &Values| -> Vec<String> {
            match values {
                Values::Words(words) => words.iter().map(|word| word.name.to_owned()).collect(),
                Values::OneOf(all) => all.iter().map(u32::to_string).collect(),
                _ => Vec::new(),
            }
        };
        let method = setting("method").expect("a setting");
        let mut count = 0;
        for of_method in words(&method.values) {
            for other in SETTINGS {
                for word in words(&other.values) {
                    let mut quality = Quality::default();
                    method.set(&mut quality, &of_method).unwrap();
                    let is_full = other.set(&mut quality, &word).is_ok()
                        && plan::picture(&scene, &quality, &limits, Picture::default()).is_ok();
                    let wanted = Picture { light_layers: true, ..Picture::default() };
                    let sky = plan::picture(&scene, &coarser(&quality, SKY), &limits, wanted);
                    let sun = coarser(&quality, SUN);
                    let sun = plan::picture(&scene, &sun, &limits, Picture::default());
                    let is_well = sky.is_ok() && sun.is_ok();
                    assert!(!is_full || is_well, "{of_method}, {} {word}", other.name);
                    count += u32::from(is_full);
                }
            }
        }
        assert!(count > 20, "{count}");
    }
}
