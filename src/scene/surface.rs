use crate::{Error, Result};

/// What the field is made of and what lies beyond its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Share of light that is reflected, diffusely, [0..1] in each channel.
    pub albedo: Albedo,
    /// What lies outside the field: ground at horizontal, nothing, or the field again.
    pub border: Border,
    /// A mirror-like lobe besides.
    pub phong: Option<Lobe>,
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
        match &self.phong {
            None => Ok(()),
            Some(Lobe::Constant(phong)) => phong.check("", self.albedo.largest()),
            Some(Lobe::Map(map)) if map.len() != samples => Err(Error::setting(
                "phong map",
                format!("{} texels", map.len()),
                format!("{samples} texels, one a sample"),
            )),
            Some(Lobe::Map(map)) => map.iter().enumerate().try_for_each(|(i, phong)| {
                phong.check(&format!(", texel {i}"), self.albedo.largest_at(i))
            }),
        }
    }
}

impl Surface {
    /// The largest share of light that it reflects, diffusely and by its lobe, in any channel anywhere, [0..1].
    pub fn most_reflected(&self) -> f64 {
        let lobe = self.phong.as_ref().map_or(0.0, |lobe| f64::from(lobe.largest().scale));
        (f64::from(self.albedo.largest()) + lobe).min(1.0)
    }
}

/// Lobes of all samples.
#[derive(Clone, Debug, PartialEq)]
pub enum Lobe {
    /// One everywhere.
    Constant(Phong),
    /// One a sample, row-major like the heights; between samples exponent and scale are linear.
    Map(Vec<Phong>),
}

impl Lobe {
    /// A map of `samples` texels that only the device knows, none of whose scales is above `scale`: planned as that.
    /// Beside [`Albedo::unknown`], which is planned as reflecting all, `f32::EPSILON` will do.
    pub fn unknown(samples: usize, scale: f32) -> Self {
        Lobe::Map(vec![Phong { exponent: 0.0, scale }; samples])
    }

    /// That of a sample.
    pub fn at(&self, sample: usize) -> Phong {
        match self {
            Lobe::Constant(phong) => *phong,
            Lobe::Map(map) => map[sample],
        }
    }

    /// The largest exponent and the largest scale anywhere.
    pub fn largest(&self) -> Phong {
        match self {
            Lobe::Constant(phong) => *phong,
            Lobe::Map(map) => map.iter().fold(Phong { exponent: 0.0, scale: 0.0 }, |a, b| Phong {
                exponent: a.exponent.max(b.exponent),
                scale: a.scale.max(b.scale),
            }),
        }
    }
}

/// A lobe about the mirror direction of where light leaves to, beside the diffuse reflection.
///
/// Exit radiance scale·(n+1)/(2π) ∫ L V max(e·r, 0)ⁿ [e·N > 0] de, r the mirror direction about the normal N of
/// the direction towards the view, or towards what the light falls on next. The whole lobe integrates to
/// `scale`, so its clipped part never reflects more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// n, [0..1e4]: 0 spreads over the hemisphere about r, 1e4 is half as bright 0.7° beside r.
    pub exponent: f32,
    /// Share of light that the lobe reflects, [0..1], in every channel alike.
    pub scale: f32,
}

impl Phong {
    /// What is out of range: its name, its value, what was expected.
    pub fn complaint(&self) -> Option<(&'static str, f32, &'static str)> {
        if !(0.0..=1e4).contains(&self.exponent) {
            return Some(("exponent", self.exponent, "a number from 0 to 10000"));
        }
        let is_share = (0.0..=1.0).contains(&self.scale);
        (!is_share).then_some(("scale", self.scale, "a share from 0 to 1"))
    }

    /// Checks ranges `of` a texel, beside an albedo.
    fn check(&self, of: &str, albedo: f32) -> Result<()> {
        let refuse = |what: &str, found: String, expected: &str| {
            Err(Error::setting(format!("phong {what}{of}"), found, expected))
        };
        if let Some((what, found, expected)) = self.complaint() {
            return refuse(what, found.to_string(), expected);
        }
        // 0.7 + 0.3 of f32 is 1 and half an ulp of it.
        if f64::from(albedo) + f64::from(self.scale) > 1.0 + f64::from(f32::EPSILON) {
            return refuse(
                "scale",
                format!("{} beside an albedo of {albedo}", self.scale),
                "no more than 1 together: a surface reflects no more than it receives",
            );
        }
        Ok(())
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

    /// The largest channel at a sample.
    fn largest_at(&self, sample: usize) -> f32 {
        let colour = match self {
            Albedo::Constant(c) => c,
            Albedo::Map(map) => &map[sample],
        };
        colour.iter().copied().fold(0.0, f32::max)
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
            let phong = Some(Lobe::Constant(Phong { exponent, scale }));
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
        assert!(of(map.clone(), 1.0, 0.11).unwrap_err().to_string().contains("0.9"));
        // Of maps each texel is held to its own albedo.
        let lobes = |scales: &[f32]| {
            let all = scales.iter().map(|scale| Phong { exponent: 3.0, scale: *scale });
            let phong = Some(Lobe::Map(all.collect()));
            Surface { albedo: map.clone(), phong, border: Border::Plane }.check(2)
        };
        assert!(lobes(&[0.9, 0.1]).is_ok());
        let said = lobes(&[0.9, 0.11]).unwrap_err().to_string();
        assert!(said.starts_with("phong scale, texel 1: found 0.11 beside"), "{said}");
        assert!(lobes(&[0.9]).unwrap_err().to_string().starts_with("phong map"));
        // What only the device knows reflects something, and no more than all.
        let unknown = Surface {
            albedo: Albedo::unknown(2),
            phong: Some(Lobe::unknown(2, f32::EPSILON)),
            border: Border::Plane,
        };
        assert!(unknown.check(2).is_ok() && unknown.most_reflected() == 1.0);
        assert!(unknown.phong.is_some_and(|lobe| lobe.largest().scale > 0.0));
    }
}
