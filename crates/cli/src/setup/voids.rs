//! Voids in results. Their heights were filled (`src/scene/field/voids.rs`), so values there are masked.

use ridgelight::scene::HeightField;

/// Sets void texels to NaN in every plane.
pub fn mask_voids(field: &HeightField, planes: &mut [f32], channels: usize) {
    if let Some(voids) = field.voids() {
        for (i, texel) in planes.chunks_mut(channels).enumerate() {
            if voids[i % voids.len()] {
                texel.fill(f32::NAN);
            }
        }
    }
}

/// A plane with NaN at voids.
pub fn masked(field: &HeightField, mut plane: Vec<f32>) -> Vec<f32> {
    mask_voids(field, &mut plane, 1);
    plane
}
