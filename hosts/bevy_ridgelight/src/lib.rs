#![doc = include_str!("../../../docs/embedding/bevy.md")]

mod light;
mod terrain;

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::extract_component::{ExtractComponent, ExtractComponentPlugin};
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages};

#[doc(hidden)]
pub use light::Submissions;
pub use terrain::TerrainMaterial;

/// Lights every [`HeightField`] that has a [`FieldLight`]. Add it after `DefaultPlugins`.
pub struct RidgelightPlugin;

impl Plugin for RidgelightPlugin {
    fn build(&self, app: &mut App) {
        assert!(app.is_plugin_added::<AssetPlugin>(), "add RidgelightPlugin after DefaultPlugins");
        app.add_message::<HeightEdit>().add_plugins((
            ExtractComponentPlugin::<HeightField>::default(),
            ExtractComponentPlugin::<FieldLight>::default(),
        ));
        terrain::build(app);
        light::build(app);
    }
}

/// A height field: heights at grid points, and how to light them.
#[derive(Component, ExtractComponent, Clone, Debug)]
#[require(Transform, Visibility)]
pub struct HeightField {
    /// One texel per grid point, in world units, all finite (fill voids first): R32Float, R16Float, or R16Unorm (needs `TEXTURE_FORMAT_16BIT_NORM`). Usage
    /// TEXTURE_BINDING ([`heights_image`]).
    pub heights: Handle<Image>,
    /// Columns and rows.
    pub size: UVec2,
    /// Distances between columns and between rows, world units.
    pub cell: Vec2,
    /// Azimuths of sky and bent normals, 4 to 1024. Time and memory grow in proportion.
    pub azimuths: u32,
    /// Angular diameter of the sun, radians; 0 has hard shadows.
    pub sun_diameter: f32,
    /// Whether [`FieldLight::bent_normal`] is computed.
    pub bent_normal: bool,
    /// Azimuths of [`FieldLight::horizon`], 4 to 1024; 0 for none.
    pub horizon_azimuths: u32,
    /// Increment it after commands that write the image of heights on the GPU are submitted. The plugin submits in
    /// `RenderSystems::PrepareResources`, before the render graph.
    pub revision: u32,
}

impl HeightField {
    /// A field with 32 azimuths, a sun of 0.53 degrees, and neither bent normals nor horizons.
    ///
    /// # Panics
    /// If it has no columns or no rows.
    pub fn new(heights: Handle<Image>, size: UVec2, cell: Vec2) -> Self {
        assert!(size.min_element() > 0, "HeightField::size is {size}, expected at least 1 x 1");
        Self {
            heights,
            size,
            cell,
            azimuths: 32,
            sun_diameter: 0.53_f32.to_radians(),
            bent_normal: false,
            horizon_azimuths: 0,
            revision: 0,
        }
    }

    /// A level grid with a vertex at each grid point, which [`TerrainMaterial`] raises. The first grid point is at the
    /// origin. A field of one column or one row has no triangles.
    pub fn mesh(&self) -> Mesh {
        terrain::mesh(self.size, self.cell)
    }

    /// Texels of its light.
    fn format(&self) -> TextureFormat {
        // Bent normals need three channels, and all light layers share one format.
        if self.bent_normal { TextureFormat::Rgba32Float } else { TextureFormat::R32Float }
    }
}

/// The light of a [`HeightField`], in images that the GPU fills. Each has the field's size.
#[derive(Component, ExtractComponent, Clone, Debug)]
pub struct FieldLight {
    /// Light from the sun, in channel R: radiance of white ground under a sun of irradiance 1, [0..1/π]; shadows and the
    /// cosine included.
    pub sun: Handle<Image>,
    /// Sky view, in channel R: radiance of white ground under a sky of radiance 1, [0..1]; 1 on open level ground.
    pub sky_view: Handle<Image>,
    /// Encoded bent normal; present if [`HeightField::bent_normal`]. Normalise 2 · rgb - `sky_view`.r: the result is the
    /// cosine-weighted mean unoccluded direction, in Bevy's axes. The texel holds the radiance of white ground under a sky
    /// of radiance (1 + d) / 2 in direction d.
    pub bent_normal: Option<Handle<Image>>,
    /// Elevation of the horizon, in radians; present if [`HeightField::horizon_azimuths`] is not 0. One layer per azimuth,
    /// counter-clockwise from east.
    pub horizon: Option<Handle<Image>>,
}

impl FieldLight {
    /// Makes the images for a field.
    pub fn new(field: &HeightField, images: &mut Assets<Image>) -> Self {
        let mut image = |format: TextureFormat, layers: u32| {
            let size = Extent3d {
                width: field.size.x,
                height: field.size.y,
                depth_or_array_layers: layers,
            };
            let texel = [0; 16];
            let bytes = if format == TextureFormat::R32Float { 4 } else { 16 };
            let usages = RenderAssetUsages::RENDER_WORLD;
            let mut image =
                Image::new_fill(size, TextureDimension::D2, &texel[..bytes], format, usages);
            image.texture_descriptor.usage |= TextureUsages::STORAGE_BINDING
                | TextureUsages::TEXTURE_BINDING
                | TextureUsages::COPY_SRC;
            images.add(image)
        };
        let format = field.format();
        Self {
            sun: image(format, 1),
            sky_view: image(format, 1),
            bent_normal: field.bent_normal.then(|| image(format, 1)),
            horizon: (field.horizon_azimuths > 0)
                .then(|| image(TextureFormat::R32Float, field.horizon_azimuths)),
        }
    }
}

/// New heights in a rectangle of a field. For the sky, only lines that can reach it are swept again; the sun is lit again everywhere. With
/// [`HeightField::horizon_azimuths`] everything is recomputed.
#[derive(Message, Clone, Debug)]
pub struct HeightEdit {
    /// The field's entity. Its image of heights needs format R32Float and usage COPY_DST.
    pub field: Entity,
    /// First column and row.
    pub corner: UVec2,
    /// Columns and rows.
    pub size: UVec2,
    /// New heights, row after row from the north, in world units, all finite. They replace the old ones.
    pub heights: Vec<f32>,
}

/// An image of heights, row after row from the north. Logs a warning if a height is not finite.
///
/// # Panics
/// If `heights` does not have one value per texel.
pub fn heights_image(size: UVec2, heights: &[f32]) -> Image {
    assert_eq!(heights.len(), size.x as usize * size.y as usize, "a height for each texel");
    if let Some(found) = light::not_finite(heights) {
        warn_once!("heights_image: {found}");
    }
    let bytes: Vec<u8> = heights.iter().flat_map(|h| h.to_ne_bytes()).collect();
    let extent = Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 };
    let usages = RenderAssetUsages::default();
    Image::new(extent, TextureDimension::D2, bytes, TextureFormat::R32Float, usages)
}
