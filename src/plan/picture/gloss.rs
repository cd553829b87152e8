//! What a lobe beside the diffuse reflection adds to a picture.

use super::super::Batch;
use super::super::ResourceId;
use super::super::shining::Shining;
use super::{Drawing, light_resolve};
use crate::passes;
use crate::scene::{Basis, Quality, Sun};
use crate::{Error, Result};

/// The quality that a scene with a lobe is lit by.
///
/// # Errors
/// A light or a basis that gives a lobe nothing.
pub(super) fn quality(
    quality: &Quality,
    shining: &Shining<'_>,
    notes: &mut Vec<String>,
) -> Result<Quality> {
    if shining.gloss.is_none() {
        return Ok(*quality);
    }
    let refuse = |found: &str, expected: &str| Err(Error::setting("phong", found, expected));
    let alone = "sky, environment and suns alone: it is for the reference to mirror others";
    if !shining.keys.is_empty() {
        return refuse("a lobe under a key light", alone);
    }
    if !shining.spheres.shining.is_empty() {
        return refuse("a lobe under a ball of light", alone);
    }
    match quality.basis {
        _ if !shining.has_gloss_around() => Ok(*quality),
        Basis::Sh => Ok(*quality),
        Basis::Auto => {
            notes.push("basis sh: a lobe is lit by harmonics alone".into());
            Ok(Quality { basis: Basis::Sh, ..*quality })
        }
        Basis::Table => {
            refuse("a lobe by --basis table, whose tables are of diffuse ground", "--basis sh")
        }
    }
}

impl Drawing<'_> {
    /// What each light makes of what is seen as harmonics.
    pub(super) fn fill_matrices(&mut self) {
        let Some(h) = &self.harmonics else { return };
        let builder = &mut self.builder;
        let lit = [(&h.diffuse, None), (&h.gloss, self.shining.sky)];
        for (seen, sky) in lit {
            let Some(seen) = seen else { continue };
            let environment = self.shining.environment.zip(self.images.environment);
            if let (Some((e, image)), Some(turns)) = (environment, seen.env_turns) {
                passes::env_turns::plan(builder, e, &seen.sh, [image, h.constants, turns]);
            }
            let ids = [h.constants, seen.light_matrix];
            passes::light_matrix::plan(builder, &seen.sh, sky, seen.env_turns, ids);
        }
    }

    /// A sun in the lobe, from what it gives to diffuse ground.
    pub(super) fn sun_gloss(&mut self, name: &str, sun: &Sun, batch: &Batch, sum: ResourceId) {
        let (Some(phong), Some(gloss)) = (self.shining.gloss, self.images.gloss_sum) else {
            return;
        };
        let (border, cell_m) = (self.border(), self.scene.field.cell_m());
        let Some(sweeping) = &self.sweeping else { return };
        let ids = [sweeping.lane_heights(batch), sum, gloss];
        let begins = !std::mem::replace(&mut self.gloss_is_begun, true);
        let field = (batch.axis, border, cell_m);
        passes::sun_gloss::plan(&mut self.builder, field, name, (sun, phong.exponent), ids, begins);
    }

    /// The lobe's share of the picture.
    pub(super) fn gloss(&mut self) {
        let (Some(phong), Some(sum)) = (self.shining.gloss, self.images.gloss_sum) else { return };
        if !self.gloss_is_begun {
            return;
        }
        let is_first = !std::mem::replace(&mut self.is_begun, true);
        let light = light_resolve::Light {
            sum,
            has_colour: true,
            colour: [phong.scale; 3],
            albedo_map: None,
            radiance: Some((self.images.radiance, is_first)),
            layer: self.images.gloss_layer,
            grey: self.shining.is_grey,
            edited: self.edited,
        };
        self.light_resolve("glossy", &light);
    }
}
