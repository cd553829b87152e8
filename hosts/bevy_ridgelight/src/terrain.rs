//! The material and mesh of a height field.

use bevy::asset::{RenderAssetUsages, embedded_asset};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::math::Mat3A;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::AsBindGroup;
use bevy::shader::ShaderRef;

use crate::light::{Sun, follow_sun};
use crate::{FieldLight, HeightField};

/// Draws a [`HeightField`] with its [`FieldLight`]: a diffuse surface under the sun and the sky. Bevy's own shadow maps
/// are not needed.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub struct TerrainMaterial {
    /// Colour of the ground, and that of sun (lux) and sky (cd/m²), which the plugin sets in each frame.
    #[uniform(0)]
    base: LinearRgba,
    #[uniform(0)]
    sun_colour: LinearRgba,
    #[uniform(0)]
    sky_colour: LinearRgba,
    #[texture(1, sample_type = "float", filterable = false, visibility(vertex, fragment))]
    heights: Handle<Image>,
    #[texture(2, sample_type = "float", filterable = false)]
    sun: Handle<Image>,
    #[texture(3, sample_type = "float", filterable = false)]
    sky: Handle<Image>,
}

impl TerrainMaterial {
    /// White ground.
    pub fn new(field: &HeightField, light: &FieldLight) -> Self {
        Self {
            base: LinearRgba::WHITE,
            sun_colour: LinearRgba::BLACK,
            sky_colour: LinearRgba::BLACK,
            heights: field.heights.clone(),
            sun: light.sun.clone(),
            sky: light.sky_view.clone(),
        }
    }

    /// The same with another colour of the ground.
    pub fn with_colour(self, colour: Color) -> Self {
        Self { base: colour.to_linear(), ..self }
    }
}

impl Material for TerrainMaterial {
    fn vertex_shader() -> ShaderRef {
        "embedded://bevy_ridgelight/terrain.wgsl".into()
    }

    fn fragment_shader() -> ShaderRef {
        "embedded://bevy_ridgelight/terrain.wgsl".into()
    }

    // Both would need the heights, too.
    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }
}

pub(crate) fn build(app: &mut App) {
    embedded_asset!(app, "terrain.wgsl");
    app.add_plugins(MaterialPlugin::<TerrainMaterial>::default())
        .add_systems(PostUpdate, (set_colours.after(follow_sun), disable_frustum_culling))
        .add_systems(Last, (warn_of_turns, warn_of_halves));
}

/// What is wrong with the place of a field, if anything: light is computed in the field's own axes and units.
fn misplaced(placed: &GlobalTransform) -> Option<&'static str> {
    let is_upright = placed.affine().matrix3.abs_diff_eq(Mat3A::IDENTITY, 1e-4);
    (!is_upright)
        .then_some("a HeightField is turned or scaled, but its light is computed without that; use a translation only")
}

fn warn_of_turns(fields: Query<&GlobalTransform, (With<HeightField>, Changed<GlobalTransform>)>) {
    for message in fields.iter().filter_map(misplaced) {
        warn_once!("{message}");
    }
}

/// Warns of entities with only one of `HeightField` and `FieldLight`.
fn warn_of_halves(
    fields: Query<Entity, (Added<HeightField>, Without<FieldLight>)>,
    lights: Query<Entity, (Added<FieldLight>, Without<HeightField>)>,
) {
    for entity in fields {
        warn!(
            "{entity} has a HeightField but no FieldLight, so it stays unlit until it has: insert FieldLight::new(..)"
        );
    }
    for entity in lights {
        warn!(
            "{entity} has a FieldLight but no HeightField, so its images stay empty: insert both on one entity"
        );
    }
}

fn set_colours(
    sun: Res<Sun>,
    sky: Res<GlobalAmbientLight>,
    mut materials: ResMut<Assets<TerrainMaterial>>,
) {
    let sky = sky.color.to_linear() * sky.brightness;
    let is_new = |material: &TerrainMaterial| {
        material.sun_colour != sun.colour || material.sky_colour != sky
    };
    let changed: Vec<_> = materials.iter().filter(|(_, m)| is_new(m)).map(|(id, _)| id).collect();
    for id in changed {
        if let Some(mut material) = materials.get_mut(id) {
            material.sun_colour = sun.colour;
            material.sky_colour = sky;
        }
    }
}

/// The vertex shader raises the flat mesh, so its bounds would cull visible ground.
fn disable_frustum_culling(
    fields: Query<Entity, (With<HeightField>, Without<NoFrustumCulling>)>,
    mut commands: Commands,
) {
    for field in fields {
        commands.entity(field).insert(NoFrustumCulling);
    }
}

pub(crate) fn mesh(size: UVec2, cell: Vec2) -> Mesh {
    let points = (0..size.y).flat_map(|row| (0..size.x).map(move |col| UVec2::new(col, row)));
    let last = size.saturating_sub(UVec2::ONE).max(UVec2::ONE).as_vec2();
    let mut positions = Vec::new();
    let mut uvs = Vec::new();
    for point in points {
        let at = point.as_vec2();
        positions.push([at.x * cell.x, 0.0, at.y * cell.y]);
        uvs.push((at / last).to_array());
    }
    let normals = vec![[0.0, 1.0, 0.0]; positions.len()];
    let mut indices = Vec::new();
    for row in 1..size.y {
        for col in 1..size.x {
            let [b, d] = [row * size.x + col, (row - 1) * size.x + col];
            let [a, c] = [b - 1, d - 1];
            // From north-west to south-east, as Ridgelight splits a cell.
            indices.extend([c, a, b, c, b, d]);
        }
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_or_scaled_field_gets_a_warning_and_a_moved_one_none() {
        let is_warned = |transform: Transform| misplaced(&transform.into()).is_some();
        assert!(!is_warned(Transform::from_xyz(-20.0, 3.0, 1e5)));
        for turn in [Quat::from_rotation_x, Quat::from_rotation_y, Quat::from_rotation_z] {
            assert!(is_warned(Transform::from_rotation(turn(0.01))));
        }
        for scale in [Vec3::splat(2.0), Vec3::new(1.0, 1.1, 1.0), Vec3::new(-1.0, 1.0, 1.0)] {
            assert!(is_warned(Transform::from_scale(scale)));
        }
        let message = misplaced(&Transform::from_scale(Vec3::splat(2.0)).into());
        assert!(message.is_some_and(|message| message.contains("turned or scaled")));
    }
}
