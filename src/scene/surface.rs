use crate::{Error, Result};

/// Reflectance of the field, and its border.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Diffuse reflectance, [0..1] in each channel.
    pub albedo: Albedo,
    /// What lies beyond the edge of the field.
    pub border: Border,
    /// Phong specular reflection in addition to the diffuse one.
    pub specular: Option<Specular>,
}

impl Default for Surface {
    /// Albedo 1, `plane` border, no specular.
    fn default() -> Self {
        Self { albedo: Albedo::Constant([1.0; 3]), border: Border::Plane, specular: None }
    }
}

impl Surface {
    /// Checks ranges and sizes for a field of `grid_points` grid points.
    ///
    /// # Errors
    /// An albedo outside [0..1]; a map without one value per grid point; an exponent or a scale out of range; albedo
    /// plus scale above 1 in any channel at any texel.
    pub fn check(&self, grid_points: usize) -> Result<()> {
        self.albedo.check(grid_points)?;
        match &self.specular {
            None => Ok(()),
            Some(Specular::Constant(specular)) => specular.check("", self.albedo.largest()),
            Some(Specular::Map(map)) if map.len() != grid_points => Err(Error::setting(
                "specular map",
                format!("{} texels", map.len()),
                format!("{grid_points} texels, one per grid point"),
            )),
            Some(Specular::Map(map)) => map.iter().enumerate().try_for_each(|(i, specular)| {
                specular.check(&format!(", texel {i}"), self.albedo.largest_at(i))
            }),
        }
    }
}

impl Surface {
    /// Largest reflectance, diffuse plus specular, in any channel at any texel, [0..1].
    pub fn max_reflectance(&self) -> f64 {
        let specular =
            self.specular.as_ref().map_or(0.0, |specular| f64::from(specular.largest().scale));
        (f64::from(self.albedo.largest()) + specular).min(1.0)
    }
}

/// Largest exponent of a lobe.
const LARGEST_EXPONENT: f32 = 1e4;

/// Phong specular of the whole field.
#[derive(Clone, Debug, PartialEq)]
pub enum Specular {
    /// The same everywhere.
    Constant(PhongSpecular),
    /// One per grid point, row-major like the heights; exponent and scale are linear in between.
    Map(Vec<PhongSpecular>),
}

impl Specular {
    /// A map of `grid_points` texels that only the device knows. The plan assumes `scale` everywhere; no texel may exceed it.
    /// With [`Albedo::unknown`], which the plan takes as fully reflecting, use `f32::EPSILON`.
    ///
    /// The plan also assumes the largest exponent everywhere. Key lights and sphere lights then need the most azimuths, and sky and
    /// environment need the most tables. To need fewer, pass a [`Map`](Self::Map) with your largest exponent at every texel. Sky and
    /// environment clamp exponents above the planned maximum to it; suns, key lights and sphere lights do not.
    pub fn unknown(grid_points: usize, scale: f32) -> Self {
        Specular::Map(vec![PhongSpecular { exponent: LARGEST_EXPONENT, scale }; grid_points])
    }

    /// The value at a grid point.
    pub fn at(&self, texel: usize) -> PhongSpecular {
        match self {
            Specular::Constant(specular) => *specular,
            Specular::Map(map) => map[texel],
        }
    }

    /// The largest exponent and the largest scale of all texels that reflect.
    pub fn largest(&self) -> PhongSpecular {
        match self {
            Specular::Constant(specular) => *specular,
            Specular::Map(map) => {
                let nothing = PhongSpecular { exponent: 0.0, scale: 0.0 };
                map.iter().filter(|texel| texel.scale > 0.0).fold(nothing, |a, b| PhongSpecular {
                    exponent: a.exponent.max(b.exponent),
                    scale: a.scale.max(b.scale),
                })
            }
        }
    }
}

/// A Phong lobe about the mirror direction of the outgoing light, in addition to the diffuse reflection.
///
/// Exit radiance scale·(n+1)/(2π) ∫ L V max(e·r, 0)ⁿ [e·N > 0] de. r is the mirror direction, about the normal N, of the
/// direction to the view or to the next point that the light reaches. The whole lobe integrates to `scale`, so the part
/// above the surface never reflects more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongSpecular {
    /// n, [0..1e4]: 0 spreads over the hemisphere about r; 1e4 halves within 0.7° of r.
    pub exponent: f32,
    /// Reflectance of the lobe, [0..1], equal in all channels.
    pub scale: f32,
}

impl PhongSpecular {
    /// The first field out of range: its name, its value, the expected range.
    pub fn out_of_range(&self) -> Option<(&'static str, f32, &'static str)> {
        if !(0.0..=LARGEST_EXPONENT).contains(&self.exponent) {
            return Some(("exponent", self.exponent, "a number from 0 to 10000"));
        }
        let is_share = (0.0..=1.0).contains(&self.scale);
        (!is_share).then_some(("scale", self.scale, "a share from 0 to 1"))
    }

    /// Checks the ranges `of` a texel with its albedo.
    fn check(&self, of: &str, albedo: f32) -> Result<()> {
        let refuse = |what: &str, found: String, expected: &str| {
            Err(Error::setting(format!("specular {what}{of}"), found, expected))
        };
        if let Some((what, found, expected)) = self.out_of_range() {
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
    /// One colour per grid point, row-major like the heights.
    Map(Vec<[f32; 3]>),
}

impl Albedo {
    /// A map of `grid_points` texels that only the device knows. The plan assumes albedo 1, so it drops no bounce.
    pub fn unknown(grid_points: usize) -> Self {
        Albedo::Map(vec![[1.0; 3]; grid_points])
    }

    /// Checks range and size for a field of `grid_points` grid points.
    ///
    /// # Errors
    /// A channel outside [0..1] or not finite; a map that does not have one colour per grid point.
    pub(crate) fn check(&self, grid_points: usize) -> Result<()> {
        let good = |c: &[f32; 3]| c.iter().all(|v| (0.0..=1.0).contains(v));
        match self {
            Albedo::Constant(c) if !good(c) => {
                Err(Error::setting("albedo", format!("{c:?}"), "channels from 0 to 1"))
            }
            Albedo::Map(map) if map.len() != grid_points => Err(Error::setting(
                "albedo map",
                format!("{} texels", map.len()),
                format!("{grid_points} texels, one per grid point"),
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

    /// The largest channel at a grid point.
    fn largest_at(&self, texel: usize) -> f32 {
        let colour = match self {
            Albedo::Constant(c) => c,
            Albedo::Map(map) => &map[texel],
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
    /// Ground at horizontal without end: no horizon is below 0.
    #[default]
    Plane,
    /// Nothing: light may arrive from below horizontal.
    Open,
    /// The field repeats.
    Periodic,
}

/// Normals of the ground between grid points, in a path-traced reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// As in pictures: a grid point has the mean normal of its four cells, and radiance is linear between grid points.
    #[default]
    Smooth,
    /// Each triangle is flat and has its own normal, as in most path tracers. Bounces in pictures differ from this on
    /// steep, coarse ground.
    Flat,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_rejects_a_surface_that_reflects_more_than_arrives() {
        let of = |albedo, exponent, scale| {
            let specular = Some(Specular::Constant(PhongSpecular { exponent, scale }));
            Surface { albedo, specular, border: Border::Plane }.check(2)
        };
        let grey = Albedo::Constant([0.7; 3]);
        assert!(of(grey.clone(), 0.0, 0.3).is_ok());
        assert!(of(grey.clone(), 1e4, 0.0).is_ok());
        for (exponent, scale) in
            [(-1.0, 0.1), (1.1e4, 0.1), (f32::NAN, 0.1), (1.0, -0.1), (1.0, f32::NAN), (1.0, 0.301)]
        {
            let error = of(grey.clone(), exponent, scale).unwrap_err();
            assert!(error.to_string().starts_with("specular"), "{error}");
        }
        let map = Albedo::Map(vec![[0.1; 3], [0.2, 0.2, 0.9]]);
        assert!(of(map.clone(), 1.0, 0.1).is_ok());
        assert!(of(map.clone(), 1.0, 0.11).unwrap_err().to_string().contains("0.9"));
        // With maps, each texel is checked with its own albedo.
        let of_map = |scales: &[f32]| {
            let all = scales.iter().map(|scale| PhongSpecular { exponent: 3.0, scale: *scale });
            let specular = Some(Specular::Map(all.collect()));
            Surface { albedo: map.clone(), specular, border: Border::Plane }.check(2)
        };
        assert!(of_map(&[0.9, 0.1]).is_ok());
        let message = of_map(&[0.9, 0.11]).unwrap_err().to_string();
        assert!(message.starts_with("specular scale, texel 1: found 0.11 beside"), "{message}");
        assert!(of_map(&[0.9]).unwrap_err().to_string().starts_with("specular map"));
        // An unknown surface reflects something, at most everything.
        let unknown = Surface {
            albedo: Albedo::unknown(2),
            specular: Some(Specular::unknown(2, f32::EPSILON)),
            border: Border::Plane,
        };
        assert!(unknown.check(2).is_ok() && unknown.max_reflectance() == 1.0);
        assert!(unknown.specular.is_some_and(|specular| specular.largest().scale > 0.0));
    }
}
