//! Lights height fields in the render world, before Bevy's own passes.

use std::collections::HashMap;
use std::f32::consts::PI;
use std::sync::{Mutex, PoisonError};

use bevy::ecs::entity::Entity;
use bevy::prelude::*;
use bevy::render::extract_resource::{ExtractResource, ExtractResourcePlugin};
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::sync_world::MainEntity;
use bevy::render::texture::GpuImage;
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};
use ridgelight::plan::{self, Picture, Plan, Rectangle};
use ridgelight::scene::{self, Environment, Lights, Quality, Scene, Surface};
use ridgelight_wgpu::{Renderer, limits};

use crate::{FieldLight, HeightEdit, HeightField};

/// The scene's first directional light.
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

/// What is lit, by entity of the main world; none after an error, until the settings change.
#[derive(Resource, Default)]
struct Fields(Mutex<HashMap<Entity, (Settings, Option<Lit>)>>);

pub(crate) fn build(app: &mut App) {
    app.init_resource::<Sun>()
        .add_plugins(ExtractResourcePlugin::<Sun>::default())
        .add_systems(Last, follow_sun);
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        render
            .init_resource::<Changes>()
            .init_resource::<Fields>()
            .add_systems(ExtractSchedule, take_changes)
            .add_systems(Render, light_fields.in_set(RenderSystems::PrepareResources));
    }
}

fn follow_sun(lights: Query<(&DirectionalLight, &GlobalTransform)>, mut sun: ResMut<Sun>) {
    let found = lights.iter().next().map(|(light, transform)| {
        let direction = *transform.back();
        let is_up = direction.y > 1e-4;
        let colour = light.color.to_linear() * light.illuminance;
        let colour = if is_up { colour } else { LinearRgba::BLACK };
        Sun { direction: is_up.then_some(direction), colour }
    });
    sun.set_if_neq(found.unwrap_or_default());
}

fn take_changes(
    mut edits: Extract<MessageReader<HeightEdit>>,
    mut assets: Extract<MessageReader<AssetEvent<Image>>>,
    mut changes: ResMut<Changes>,
) {
    changes.edits.extend(edits.read().cloned());
    changes.images.extend(assets.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    }));
}

/// A field's renderers, and what they have lit.
struct Lit {
    renderer: Renderer,
    horizons: Option<Renderer>,
    /// The plan's output that nobody else reads.
    total: wgpu::Texture,
    /// The sky of directions, where bent normals are computed.
    environment: Option<wgpu::Texture>,
    /// The image of heights, and the component's revision.
    heights: (wgpu::Texture, u32),
    settings: Settings,
    sun: Option<Vec3>,
}

/// What needs other resources when it changes.
#[derive(Clone, Copy, PartialEq)]
struct Settings {
    size: UVec2,
    cell: f32,
    azimuths: u32,
    sun_diameter: f32,
    bent_normals: bool,
    horizons: u32,
}

impl Settings {
    fn of(field: &HeightField) -> Self {
        let HeightField { size, cell, azimuths, sun_diameter, bent_normals, horizons, .. } = *field;
        Self { size, cell, azimuths, sun_diameter, bent_normals, horizons }
    }

    fn field(&self) -> ridgelight::Result<scene::HeightField> {
        let [rows, cols] = [self.size.y as usize, self.size.x as usize];
        scene::HeightField::unknown(rows, cols, [f64::from(self.cell); 2])
    }

    /// The passes for light from that direction.
    fn plan(&self, device: &wgpu::Device, sun: Vec3) -> ridgelight::Result<Plan> {
        let sun = scene::Sun {
            azimuth_rad: f64::from((-sun.z).atan2(sun.x)),
            elevation_rad: f64::from(sun.y.clamp(-1.0, 1.0).asin()),
            diameter_rad: f64::from(self.sun_diameter),
            irradiance: [1.0; 3],
        };
        let lights = Lights {
            sky: Some([1.0; 3]),
            environment: self.bent_normals.then(directions).transpose()?,
            suns: vec![sun],
            ..Lights::default()
        };
        let scene = Scene { field: self.field()?, surface: Surface::default(), lights };
        let quality = Quality { azimuths: self.azimuths, ..Quality::default() };
        let wanted = Picture { light_layers: true, keeps_horizons: true, ..Picture::default() };
        plan::picture(&scene, &quality, &limits(device)?, wanted)
    }

    fn horizon_plan(&self, device: &wgpu::Device) -> ridgelight::Result<Plan> {
        let quality = Quality { azimuths: self.horizons, ..Quality::default() };
        let all = (0, self.horizons);
        let border = Surface::default().border;
        plan::horizons(&self.field()?, border, &quality, &limits(device)?, all, false)
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
            sky: image(&light.sky)?,
            bent: optional(&light.bent)?,
            horizons: optional(&light.horizons)?,
        })
    }
}

/// The direction of a sun that has not risen: its layer is computed, but is not added.
const NOT_RISEN: Vec3 = Vec3::Y;

impl Lit {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        settings: Settings,
        sun: Option<Vec3>,
        images: &Images,
        revision: u32,
    ) -> ridgelight::Result<Self> {
        let plan = settings.plan(device, sun.unwrap_or(NOT_RISEN))?;
        let (_, total) = plan.outputs().next().expect("the total radiance is the first output");
        let total = ridgelight_wgpu::texture(device, queue, total, wgpu::TextureUsages::empty())?;
        let horizons = (settings.horizons > 0).then(|| {
            let plan = settings.horizon_plan(device)?;
            Renderer::new(device, queue, plan)
        });
        let environment = settings.bent_normals.then(|| {
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
        let heights = (images.heights.clone(), revision);
        let mut lit = Self {
            renderer,
            horizons: horizons.transpose()?,
            total,
            environment: environment.transpose()?,
            heights,
            settings,
            sun,
        };
        lit.submit(images, None)?;
        Ok(lit)
    }

    /// Submits all passes, or some of the light's.
    fn submit(&mut self, images: &Images, passes: Option<&[usize]>) -> ridgelight::Result<()> {
        let (inputs, outputs) = (self.inputs(images), self.outputs(images));
        match passes {
            Some([]) => {}
            Some(passes) => {
                self.renderer.submit_passes(&refs(&inputs), &refs(&outputs), passes)?;
            }
            None => {
                self.renderer.submit(&refs(&inputs), &refs(&outputs))?;
                if let (Some(renderer), Some(angles)) = (&mut self.horizons, &images.horizons) {
                    renderer.submit(&[&images.heights], &[angles])?;
                }
            }
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

    /// Brings the light up to date.
    fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        sun: Option<Vec3>,
        (images, revision): (&Images, u32),
        edits: &[&HeightEdit],
    ) -> ridgelight::Result<()> {
        let sun = sun.or(self.sun);
        let mut passes = Vec::new();
        if sun != self.sun {
            let plan = self.settings.plan(device, sun.unwrap_or(NOT_RISEN))?;
            passes = self.renderer.set_plan(plan)?;
            self.sun = sun;
        }
        let is_new = self.heights != (images.heights.clone(), revision);
        self.heights = (images.heights.clone(), revision);
        for edit in edits {
            write(queue, &images.heights, edit.corner, edit.size, &edit.heights);
        }
        let takes_edits = !self.renderer.plan().edit_passes.is_empty() && self.horizons.is_none();
        if is_new || !edits.is_empty() && !takes_edits {
            return self.submit(images, None);
        }
        self.submit(images, Some(&passes))?;
        let (inputs, outputs) = (self.inputs(images), self.outputs(images));
        for edit in edits {
            let rectangle = Rectangle {
                col: edit.corner.x,
                row: edit.corner.y,
                cols: edit.size.x,
                rows: edit.size.y,
            };
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

fn light_fields(
    fields: Query<(&MainEntity, &HeightField, &FieldLight)>,
    sun: Res<Sun>,
    images: Res<RenderAssets<GpuImage>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    lit: Res<Fields>,
    mut changes: ResMut<Changes>,
) {
    let (device, queue) = (device.wgpu_device(), &***queue);
    let mut lit = lit.0.lock().unwrap_or_else(PoisonError::into_inner);
    lit.retain(|entity, _| fields.iter().any(|(main, ..)| main.id() == *entity));
    let changes = std::mem::take(&mut *changes);
    for (main, field, light) in fields {
        let Some(own) = Images::of(field, light, &images) else { continue };
        let of_field = changes.edits.iter().filter(|edit| edit.field == main.id());
        let (edits, wrong): (Vec<_>, Vec<_>) =
            of_field.partition(|edit| is_within(edit, field.size));
        for edit in wrong {
            error!(
                "an edit of {} heights at {}, {} by {}, is not of a field of {} by {}",
                edit.heights.len(),
                edit.corner,
                edit.size.x,
                edit.size.y,
                field.size.x,
                field.size.y
            );
        }
        let settings = Settings::of(field);
        let known = lit.remove(&main.id()).filter(|(of, _)| *of == settings);
        let is_new = known.is_none();
        let mut known = known.and_then(|(_, known)| known);
        let done = if let Some(lit) = &mut known {
            if changes.images.contains(&field.heights.id()) {
                lit.heights.1 = field.revision.wrapping_sub(1);
            }
            lit.update(device, queue, sun.direction, (&own, field.revision), &edits)
        } else if is_new {
            // Before the first submission, which reads them.
            for edit in &edits {
                write(queue, &own.heights, edit.corner, edit.size, &edit.heights);
            }
            Lit::new(device, queue, settings, sun.direction, &own, field.revision)
                .map(|new| known = Some(new))
        } else {
            Ok(())
        };
        lit.insert(main.id(), (settings, known.filter(|_| done.is_ok())));
        if let Err(error) = done {
            error!("a height field cannot be lit: {error}");
        }
    }
}

fn is_within(edit: &HeightEdit, size: UVec2) -> bool {
    let ends = edit.corner.checked_add(edit.size);
    let is_inside = ends.is_some_and(|end| end.cmple(size).all());
    let count = edit.size.x as usize * edit.size.y as usize;
    is_inside && count > 0 && edit.heights.len() == count
}
