use crate::{Error, Result};

/// What the field is made of and what lies beyond its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Share of light that is reflected, diffusely.
    pub albedo: Albedo,
    /// What the sweep meets outside the field.
    pub border: Border,
    /// A mirror-like lobe besides.
    pub phong: Option<Phong>,
}

impl Default for Surface {
    /// White paper on a plane: albedo 1, `plane` border.
    fn default() -> Self {
        Self { albedo: Albedo::Constant([1.0; 3]), border: Border::Plane, phong: None }
    }
}

impl Surface {
    /// Checks ranges and sizes against a field of `samples` samples.
    ///
    /// # Errors
    /// As [`Albedo::check`]; an exponent or a scale out of range; albedo and scale that together
    /// reflect more than arrives, in any channel anywhere.
    pub fn check(&self, samples: usize) -> Result<()> {
        self.albedo.check(samples)?;
        let Some(phong) = self.phong else { return Ok(()) };
        if !(0.0..=1e4).contains(&phong.exponent) {
            return Err(Error::setting(
                "phong exponent",
                phong.exponent.to_string(),
                "a number from 0 to 10000",
            ));
        }
        if !(0.0..=1.0).contains(&phong.scale) {
            return Err(Error::setting(
                "phong scale",
                phong.scale.to_string(),
                "a share from 0 to 1",
            ));
        }
        let largest = self.albedo.largest();
        // 0.7 + 0.3 of f32 is 1 and half an ulp of it.
        if f64::from(largest) + f64::from(phong.scale) > 1.0 + f64::from(f32::EPSILON) {
            return Err(Error::setting(
                "phong scale",
                format!("{} beside an albedo of {largest}", phong.scale),
                "no more than 1 together: a surface reflects no more than it receives",
            ));
        }
        Ok(())
    }
}

/// A lobe about the mirror direction of the view, beside the diffuse reflection.
///
/// Exit radiance scale·(n+1)/(2π) ∫ L V max(e·r, 0)ⁿ [e·N > 0] de, r the mirror direction of the view
/// about the normal N. The whole lobe integrates to `scale`, so its clipped part never reflects more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// n, [0..1e4]: 0 spreads over the hemisphere about r, 1e4 is half as bright 0.7° beside r.
    pub exponent: f32,
    /// Share of light that the lobe reflects, [0..1], in every channel alike.
    pub scale: f32,
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
    /// A map of `samples` texels that only the device knows: planned as white, so that no bounce is left out.
    pub fn unknown(samples: usize) -> Self {
        Albedo::Map(vec![[1.0; 3]; samples])
    }

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

    /// The largest channel anywhere.
    pub(crate) fn largest(&self) -> f32 {
        match self {
            Albedo::Constant(c) => c.iter().copied().fold(0.0, f32::max),
            Albedo::Map(map) => map.as_flattened().iter().copied().fold(0.0, f32::max),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_reflects_no_more_than_it_receives() {
        let of = |albedo, exponent, scale| {
            let phong = Some(Phong { exponent, scale });
            Surface { albedo, phong, border: Border::Plane }.check(2)
        };
        let grey = Albedo::Constant([0.7; 3]);
        assert!(of(grey.clone(), 0.0, 0.3).is_ok());
        assert!(of(grey.clone(), 1e4, 0.0).is_ok());
        for (exponent, scale) in
            [(-1.0, 0.1), (1.1e4, 0.1), (f32::NAN, 0.1), (1.0, -0.1), (1.0, f32::NAN), (1.0, 0.301)]
        {
            let error = of(grey.clone(), exponent, scale).unwrap_err();
            assert!(error.to_string().starts_with("phong"), "{error}");
        }
        let map = Albedo::Map(vec![[0.1; 3], [0.2, 0.2, 0.9]]);
        assert!(of(map.clone(), 1.0, 0.1).is_ok());
        assert!(of(map, 1.0, 0.11).unwrap_err().to_string().contains("0.9"));
    }
}
