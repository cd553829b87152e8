//! Lights height fields in the render world, before Bevy's own passes.

use std::collections::HashMap;
use std::f32::consts::PI;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use bevy::camera::visibility::VisibilitySystems;
use bevy::ecs::entity::Entity;
use bevy::prelude::*;
use bevy::render::extract_resource::{ExtractResource, ExtractResourcePlugin};
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::sync_world::MainEntity;
use bevy::render::texture::GpuImage;
use bevy::render::{Extract, ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderSystems};
use bevy::transform::TransformSystems;
use ridgelight::plan::{self, Limits, Picture, Plan, Rectangle};
use ridgelight::scene::{self, Environment, Lights, Quality, Scene, Surface};
use ridgelight_wgpu::{Renderer, limits};

use crate::{FieldLight, HeightEdit, HeightField};

/// The scene's brightest visible directional light above the horizon.
#[derive(Resource, ExtractResource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sun {
    /// Unit vector to it; none where there is no light or it is below the horizon.
    direction: Option<Vec3>,
    /// Colour times illuminance, lux.
    pub colour: LinearRgba,
}

/// Changes of heights in this frame.
#[derive(Resource, Default)]
struct Changes {
    edits: Vec<HeightEdit>,
    /// Images whose assets changed. Bevy may keep their textures.
    images: Vec<AssetId<Image>>,
}

/// Submissions of light since the start, in both worlds. For tests: an edit that lights the whole field has the same bits as one
/// that does not.
#[derive(Resource, Clone, Default)]
pub struct Submissions(Arc<[AtomicU32; 3]>);

// Places of `Submissions`.
const WHOLE: usize = 0;
const PASSES: usize = 1;
const EDIT: usize = 2;

impl Submissions {
    /// Of all passes, of some passes, and of edits.
    pub fn counts(&self) -> [u32; 3] {
        [WHOLE, PASSES, EDIT].map(|kind| self.0[kind].load(Ordering::Relaxed))
    }

    fn count(&self, kind: usize) {
        self.0[kind].fetch_add(1, Ordering::Relaxed);
    }
}

/// What is lit, by entity of the main world. Made again with a new device.
#[derive(Resource, Default)]
struct Fields(Mutex<HashMap<Entity, Field>>);

/// The state that a field was last lit for, and its renderer; none after an error.
struct Field {
    state: State,
    renderer: Option<FieldRenderer>,
}

pub(crate) fn build(app: &mut App) {
    let submissions = Submissions::default();
    app.init_resource::<Sun>()
        .insert_resource(submissions.clone())
        .add_plugins(ExtractResourcePlugin::<Sun>::default())
        .add_systems(
            PostUpdate,
            follow_sun
                .after(TransformSystems::Propagate)
                .after(VisibilitySystems::VisibilityPropagate),
        );
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        render
            .insert_resource(submissions)
            .init_resource::<Changes>()
            .init_gpu_resource::<Fields>()
            .add_systems(ExtractSchedule, extract_changes)
            .add_systems(Render, light_fields.in_set(RenderSystems::PrepareResources));
    }
}

pub(crate) fn follow_sun(
    lights: Query<(&DirectionalLight, &GlobalTransform, &InheritedVisibility)>,
    mut sun: ResMut<Sun>,
) {
    let risen = lights.iter().filter_map(|(light, transform, visibility)| {
        // `GlobalTransform::back` panics for a NaN rotation. Such a sun counts as not risen.
        let direction = (transform.affine().matrix3 * Vec3::Z).normalize_or_zero();
        (visibility.get() && direction.y > 1e-4).then_some((light, direction))
    });
    let brightest = risen.max_by(|a, b| a.0.illuminance.total_cmp(&b.0.illuminance));
    let found = brightest.map(|(light, direction)| {
        let colour = light.color.to_linear() * light.illuminance;
        Sun { direction: Some(direction), colour }
    });
    sun.set_if_neq(found.unwrap_or_default());
}

fn extract_changes(
    mut edits: Extract<MessageReader<HeightEdit>>,
    mut assets: Extract<MessageReader<AssetEvent<Image>>>,
    entities: Extract<Query<(Has<HeightField>, Has<FieldLight>)>>,
    mut changes: ResMut<Changes>,
) {
    for edit in edits.read() {
        match entities.get(edit.field) {
            Ok((true, true)) => changes.edits.push(edit.clone()),
            Ok(_) => error!(
                "HeightEdit::field is {}, which lacks a HeightField or a FieldLight: set it to an entity with both",
                edit.field
            ),
            // Despawned since.
            Err(_) => {}
        }
    }
    changes.images.extend(assets.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    }));
}

/// The renderers of a field, and their own textures.
struct FieldRenderer {
    renderer: Renderer,
    horizons: Option<Renderer>,
    /// The total radiance, which the plugin does not use.
    total: wgpu::Texture,
    /// The sky of directions, where bent normals are computed.
    environment: Option<wgpu::Texture>,
    submissions: Submissions,
}

/// What to submit.
#[derive(Clone, Copy)]
enum Work<'a> {
    All,
    /// The passes that new heights need, and those of a new plan that have not been submitted yet. The tables of bent normals are
    /// left out.
    Heights,
    /// Passes of a new plan, over the same heights.
    Light(&'a [usize]),
}

/// What the light of a field depends on, besides events.
#[derive(Clone, PartialEq)]
struct State {
    settings: Settings,
    images: Images,
    revision: u32,
    /// While the sun is below the horizon, the direction before.
    sun: Option<Vec3>,
}

/// What needs other resources when it changes.
#[derive(Clone, Copy)]
struct Settings {
    size: UVec2,
    cell: Vec2,
    azimuths: u32,
    sun_diameter: f32,
    bent_normal: bool,
    horizon_azimuths: u32,
}

impl PartialEq for Settings {
    /// By bits, so that a NaN is refused once.
    fn eq(&self, other: &Self) -> bool {
        let all = |s: &Self| {
            let floats = [s.cell.x, s.cell.y, s.sun_diameter].map(f32::to_bits);
            (s.size, s.azimuths, s.bent_normal, s.horizon_azimuths, floats)
        };
        all(self) == all(other)
    }
}

impl Settings {
    fn of(field: &HeightField) -> Self {
        let HeightField {
            size, cell, azimuths, sun_diameter, bent_normal, horizon_azimuths, ..
        } = *field;
        Self { size, cell, azimuths, sun_diameter, bent_normal, horizon_azimuths }
    }

    fn field(&self) -> ridgelight::Result<scene::HeightField> {
        let [rows, cols] = [self.size.y as usize, self.size.x as usize];
        scene::HeightField::unknown(rows, cols, self.cell.to_array().map(f64::from))
    }

    /// The passes for light from that direction.
    fn plan(&self, limits: &Limits, sun: Vec3) -> ridgelight::Result<Plan> {
        let sun = scene::Sun {
            azimuth_rad: f64::from((-sun.z).atan2(sun.x)),
            // Rounding can make a component of a unit vector exceed 1.
            elevation_rad: f64::from(sun.y.min(1.0)).asin(),
            diameter_rad: f64::from(self.sun_diameter),
            irradiance: [1.0; 3],
        };
        let lights = Lights {
            sky: Some([1.0; 3]),
            environment: self.bent_normal.then(directions).transpose()?,
            suns: vec![sun],
            ..Lights::default()
        };
        let scene = Scene { field: self.field()?, surface: Surface::default(), lights };
        let quality = Quality { azimuths: self.azimuths, ..Quality::default() };
        let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
        plan::picture(&scene, &quality, limits, wanted)
    }

    fn horizon_plan(&self, limits: &Limits) -> ridgelight::Result<Plan> {
        let quality = Quality { azimuths: self.horizon_azimuths, ..Quality::default() };
        let all = (0, self.horizon_azimuths);
        let border = Surface::default().border;
        plan::horizons(&self.field()?, border, &quality, limits, all, false)
    }
}

/// A sky whose radiance in each channel is (1 + d) / 2 for direction d in Bevy's axes.
fn directions() -> ridgelight::Result<Environment> {
    let (width, height) = (128, 64);
    let texels = (0..width * height).map(|i| {
        let azimuth = PI - 2.0 * PI * (((i % width) as f32 + 0.5) / width as f32);
        let (sine, up) = (PI * (((i / width) as f32 + 0.5) / height as f32)).sin_cos();
        let [east, north] = [sine * azimuth.cos(), sine * azimuth.sin()];
        [east, up, -north].map(|d| 0.5 + 0.5 * d)
    });
    Environment::new(width, height, texels.collect(), 0.0)
}

/// Images of a field, once all are on the GPU.
#[derive(Clone, PartialEq)]
struct Images {
    heights: wgpu::Texture,
    sun: wgpu::Texture,
    sky: wgpu::Texture,
    bent: Option<wgpu::Texture>,
    horizons: Option<wgpu::Texture>,
}

impl Images {
    fn of(field: &HeightField, light: &FieldLight, all: &RenderAssets<GpuImage>) -> Option<Self> {
        let image = |handle: &Handle<Image>| Some((*all.get(handle)?.texture).clone());
        let optional = |handle: &Option<Handle<Image>>| match handle {
            Some(handle) => image(handle).map(Some),
            None => Some(None),
        };
        Some(Self {
            heights: image(&field.heights)?,
            sun: image(&light.sun)?,
            sky: image(&light.sky_view)?,
            bent: optional(&light.bent_normal)?,
            horizons: optional(&light.horizon)?,
        })
    }

    /// What does not match the settings, if anything.
    fn mismatch(&self, settings: &Settings) -> Option<String> {
        let size = settings.size;
        let of = |name: &str, image: &wgpu::Texture| {
            let found = UVec2::new(image.width(), image.height());
            (found != size).then(|| {
                format!(
                    "{name} has {} x {} texels, expected {} x {} (HeightField::size)",
                    found.x, found.y, size.x, size.y
                )
            })
        };
        let of_light = [
            ("FieldLight::sun", Some(&self.sun)),
            ("FieldLight::sky_view", Some(&self.sky)),
            ("FieldLight::bent_normal", self.bent.as_ref()),
            ("FieldLight::horizon", self.horizons.as_ref()),
        ];
        let found = of_light.iter().find_map(|(name, image)| of(name, (*image)?));
        let layers = self.horizons.as_ref().map_or(0, wgpu::Texture::depth_or_array_layers);
        let changed = if found.is_some() {
            "size"
        } else if settings.bent_normal != self.bent.is_some() {
            "bent_normal"
        } else if settings.horizon_azimuths != 0 && settings.horizon_azimuths != layers {
            "horizon_azimuths"
        } else {
            return of("HeightField::heights", &self.heights);
        };
        let found = found.map(|found| found + ". ").unwrap_or_default();
        Some(format!(
            "{found}FieldLight does not match HeightField::{changed}: make a new FieldLight and TerrainMaterial"
        ))
    }
}

/// The direction of a sun that has not risen: its layer is computed, but is not added.
const NOT_RISEN: Vec3 = Vec3::Y;

impl FieldRenderer {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        State { settings, images, sun, .. }: &State,
        submissions: &Submissions,
    ) -> ridgelight::Result<Self> {
        let plan = settings.plan(&limits(device)?, sun.unwrap_or(NOT_RISEN))?;
        let (_, total) = plan.outputs().next().expect("the total radiance is the first output");
        let total = ridgelight_wgpu::texture(device, queue, total, wgpu::TextureUsages::empty())?;
        let horizons = (settings.horizon_azimuths > 0).then(|| {
            let plan = settings.horizon_plan(&limits(device)?)?;
            Renderer::new(device, queue, plan)
        });
        let environment = settings.bent_normal.then(|| {
            let wanted = plan.inputs().find(|(_, input)| input.name == "environment");
            let (_, input) = wanted.expect("a plan with an environment reads it");
            let none = wgpu::TextureUsages::empty();
            let texture = ridgelight_wgpu::texture(device, queue, input, none)?;
            let sky = directions()?;
            let texels = sky.texels().iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]);
            let texels: Vec<f32> = texels.collect();
            let size = UVec2::new(texture.width(), texture.height());
            write(queue, &texture, UVec2::ZERO, size, &texels);
            Ok(texture)
        });
        let renderer = Renderer::new(device, queue, plan)?;
        let (horizons, environment) = (horizons.transpose()?, environment.transpose()?);
        let submissions = submissions.clone();
        let mut lit = Self { renderer, horizons, total, environment, submissions };
        lit.submit(images, Work::All)?;
        Ok(lit)
    }

    /// Submits passes of the light. Unless the heights are the same, also submits the passes of the horizons.
    fn submit(&mut self, images: &Images, work: Work<'_>) -> ridgelight::Result<()> {
        let (inputs, outputs) = (self.inputs(images), self.outputs(images));
        let all = self.renderer.plan().passes.len();
        let passes = match work {
            Work::All => (0..all).collect(),
            Work::Heights => {
                let heights = self.renderer.plan().find("heights");
                self.renderer.passes_after(heights.as_slice())
            }
            Work::Light(passes) => passes.to_vec(),
        };
        if !passes.is_empty() {
            self.submissions.count(if passes.len() == all { WHOLE } else { PASSES });
            self.renderer.submit_passes(&refs(&inputs), &refs(&outputs), &passes)?;
        }
        if !matches!(work, Work::Light(_))
            && let (Some(renderer), Some(angles)) = (&mut self.horizons, &images.horizons)
        {
            renderer.submit(&[&images.heights], &[angles])?;
        }
        Ok(())
    }

    /// The images of the plan's inputs, in its order.
    fn inputs(&self, images: &Images) -> Vec<wgpu::Texture> {
        [images.heights.clone()].into_iter().chain(self.environment.clone()).collect()
    }

    /// The images of the plan's outputs, in its order.
    fn outputs(&self, images: &Images) -> Vec<wgpu::Texture> {
        let of = |name: &str| match name {
            "direct.sky" => &images.sky,
            "direct.sun1" => &images.sun,
            "direct.env" => images.bent.as_ref().unwrap_or(&self.total),
            _ => &self.total,
        };
        self.renderer.plan().outputs().map(|(_, output)| of(&output.name).clone()).collect()
    }

    /// Brings the light from one state to another, whose settings are the same. `is_modified`: heights changed anywhere.
    fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        [old, new]: [&State; 2],
        is_modified: bool,
        edits: &[&HeightEdit],
    ) -> ridgelight::Result<()> {
        let mut passes = Vec::new();
        if new.sun != old.sun {
            let plan = new.settings.plan(&limits(device)?, new.sun.unwrap_or(NOT_RISEN))?;
            passes = self.renderer.set_plan(plan)?;
        }
        let with_old_heights = Images { heights: old.images.heights.clone(), ..new.images.clone() };
        let has_other_light_images = with_old_heights != old.images;
        let has_other_heights =
            new.images.heights != old.images.heights || new.revision != old.revision;
        let takes_edits = !self.renderer.plan().edit_passes.is_empty() && self.horizons.is_none();
        let is_all_new = is_modified || has_other_heights || !edits.is_empty() && !takes_edits;
        if has_other_light_images || is_all_new {
            edits.iter().for_each(|edit| write_edit(queue, &new.images.heights, edit));
            // Other images have no light yet.
            let work = if has_other_light_images { Work::All } else { Work::Heights };
            return self.submit(&new.images, work);
        }
        self.submit(&new.images, Work::Light(&passes))?;
        let (inputs, outputs) = (self.inputs(&new.images), self.outputs(&new.images));
        // One after the other: an edit is of heights that differ in its rectangle alone.
        for edit in edits {
            write_edit(queue, &new.images.heights, edit);
            let rectangle = Rectangle {
                col: edit.corner.x,
                row: edit.corner.y,
                cols: edit.size.x,
                rows: edit.size.y,
            };
            self.submissions.count(EDIT);
            self.renderer.submit_edit(&refs(&inputs), &refs(&outputs), rectangle)?;
        }
        Ok(())
    }
}

fn refs(all: &[wgpu::Texture]) -> Vec<&wgpu::Texture> {
    all.iter().collect()
}

/// Writes floats into a rectangle of a texture.
fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, corner: UVec2, size: UVec2, values: &[f32]) {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_ne_bytes()).collect();
    let origin = wgpu::Origin3d { x: corner.x, y: corner.y, z: 0 };
    let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
    let row = bytes.len() as u32 / size.y.max(1);
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let extent = wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    queue.write_texture(to, &bytes, layout, extent);
}

fn write_edit(queue: &wgpu::Queue, heights: &wgpu::Texture, edit: &HeightEdit) {
    write(queue, heights, edit.corner, edit.size, &edit.heights);
}

/// Why an edit cannot be written to an image of heights, if it cannot.
fn refusal(edit: &HeightEdit, heights: &wgpu::Texture) -> Option<String> {
    let size = UVec2::new(heights.width(), heights.height());
    let ends = edit.corner.checked_add(edit.size);
    let HeightEdit { corner, size: of, heights: values, .. } = edit;
    if heights.format() != wgpu::TextureFormat::R32Float {
        Some(format!("the image of heights is of {:?}, expected R32Float", heights.format()))
    } else if !heights.usage().contains(wgpu::TextureUsages::COPY_DST) {
        Some("the image of heights lacks the usage COPY_DST".into())
    } else if of.min_element() == 0 || !ends.is_some_and(|end| end.cmple(size).all()) {
        Some(format!("{} x {} at {corner} is not within {} x {}", of.x, of.y, size.x, size.y))
    } else if values.len() != of.x as usize * of.y as usize {
        Some(format!("{} heights for {} x {} grid points", values.len(), of.x, of.y))
    } else {
        not_finite(values)
    }
}

/// Names the first height that is not a finite number.
pub(crate) fn not_finite(heights: &[f32]) -> Option<String> {
    let at = heights.iter().position(|height| !height.is_finite())?;
    Some(format!("heights[{at}] is {}, expected a finite number: fill voids first", heights[at]))
}

fn light_fields(
    fields: Query<(&MainEntity, &HeightField, &FieldLight)>,
    sun: Res<Sun>,
    images: Res<RenderAssets<GpuImage>>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
    lit: Res<Fields>,
    submissions: Res<Submissions>,
    mut changes: ResMut<Changes>,
) {
    let (device, queue) = (device.wgpu_device(), &***queue);
    let mut lit = lit.0.lock().unwrap_or_else(PoisonError::into_inner);
    lit.retain(|entity, _| fields.iter().any(|(main, ..)| main.id() == *entity));
    let mut waiting = Vec::new();
    for (main, field, light) in fields {
        let entity = main.id();
        let of_field = changes.edits.iter().filter(|edit| edit.field == entity);
        let Some(own) = Images::of(field, light, &images) else {
            waiting.extend(of_field.cloned());
            continue;
        };
        let mut edits = Vec::new();
        for edit in of_field {
            match refusal(edit, &own.heights) {
                None => edits.push(edit),
                Some(reason) => error!("HeightEdit of {entity}: {reason}"),
            }
        }
        let known = lit.remove(&entity);
        let before = known.as_ref().and_then(|known| known.state.sun);
        let state = State {
            settings: Settings::of(field),
            images: own,
            revision: field.revision,
            sun: sun.direction.or(before),
        };
        let is_modified = changes.images.contains(&field.heights.id());
        let done = match known {
            // After an error until anything but the sun changes.
            Some(Field { state: old, renderer: None })
                if (State { sun: state.sun, ..old.clone() }) == state
                    && !is_modified
                    && edits.is_empty() =>
            {
                Ok(None)
            }
            _ if state.images.mismatch(&state.settings).is_some() => {
                edits.iter().for_each(|edit| write_edit(queue, &state.images.heights, edit));
                Err(state.images.mismatch(&state.settings).unwrap_or_default())
            }
            Some(Field { state: old, renderer: Some(mut renderer) })
                if old.settings == state.settings =>
            {
                let states = [&old, &state];
                let updated = renderer.update(device, queue, states, is_modified, &edits);
                updated.map(|()| Some(renderer)).map_err(|error| error.to_string())
            }
            _ => {
                edits.iter().for_each(|edit| write_edit(queue, &state.images.heights, edit));
                let made = FieldRenderer::new(device, queue, &state, &submissions);
                made.map(Some).map_err(|error| error.to_string())
            }
        };
        let renderer = done.unwrap_or_else(|error| {
            error!("HeightField of {entity}: {error}. The field is not lit again until its settings, images or heights change");
            None
        });
        lit.insert(entity, Field { state, renderer });
    }
    *changes = Changes { edits: waiting, images: Vec::new() };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_that_are_not_finite_are_named() {
        assert_eq!(not_finite(&[1.0, -2e30, 0.0]), None);
        for (wrong, name) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-f32::INFINITY, "-inf")] {
            let found = not_finite(&[1.0, 2.0, wrong, wrong]).expect("a message");
            assert!(found.starts_with(&format!("heights[2] is {name},")), "{found}");
        }
    }

    /// Otherwise an edit would light the whole field, with the same bits.
    #[test]
    fn every_kind_of_field_takes_edits() {
        for bent_normal in [false, true] {
            for sun_diameter in [0.0, 0.01] {
                let settings = Settings {
                    size: UVec2::new(48, 32),
                    cell: Vec2::ONE,
                    azimuths: 16,
                    sun_diameter,
                    bent_normal,
                    horizon_azimuths: 0,
                };
                let sun = Vec3::new(0.6, 0.5, 0.2).normalize();
                let plan = settings.plan(&Limits::lavapipe(), sun).expect("a plan");
                assert!(!plan.edit_passes.is_empty(), "{bent_normal} {sun_diameter}");
            }
        }
    }
}
