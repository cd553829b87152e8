use crate::{Error, Result};

/// What the field is made of and what lies beyond its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Share of light that is reflected, diffusely.
    pub albedo: Albedo,
    /// What the sweep meets outside the field.
    pub border: Border,
}

impl Default for Surface {
    /// White paper on a plane: albedo 1, `plane` border.
    fn default() -> Self {
        Self { albedo: Albedo::Constant([1.0; 3]), border: Border::Plane }
    }
}

/// Diffuse reflectance, linear RGB, each channel in [0..1].
#[derive(Clone, Debug, PartialEq)]
pub enum Albedo {
    /// One colour everywhere.
    Constant([f32; 3]),
    /// One colour a sample, row-major like the heights.
    Map(Vec<[f32; 3]>),
}

impl Albedo {
    /// Checks range and size against a field of `samples` samples.
    ///
    /// # Errors
    /// A channel outside [0..1] or not finite; a map that is not one colour a sample.
    pub fn check(&self, samples: usize) -> Result<()> {
        let good = |c: &[f32; 3]| c.iter().all(|v| (0.0..=1.0).contains(v));
        match self {
            Albedo::Constant(c) if !good(c) => {
                Err(Error::setting("albedo", format!("{c:?}"), "channels from 0 to 1"))
            }
            Albedo::Map(map) if map.len() != samples => Err(Error::setting(
                "albedo map",
                format!("{} texels", map.len()),
                format!("{samples} texels, one a sample"),
            )),
            Albedo::Map(map) => match map.iter().position(|c| !good(c)) {
                Some(i) => Err(Error::setting(
                    format!("albedo map, texel {i}"),
                    format!("{:?}", map[i]),
                    "channels from 0 to 1",
                )),
                None => Ok(()),
            },
            Albedo::Constant(_) => Ok(()),
        }
    }
}

/// What lies beyond the field's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Border {
    /// The ground goes on forever at horizontal: no horizon is below 0.
    #[default]
    Plane,
    /// Nothing: light may come from below horizontal.
    Open,
    /// The field repeats.
    Periodic,
}
