//! Encodes values as texture texels and picture pixels.

use ridgelight_io::Component;

use super::{Format, MapFiles};

impl MapFiles<'_> {
    /// Whether its pictures store floats: 16 bits, scaled to each picture's largest value.
    pub(super) fn is_scaled(&self) -> bool {
        self.has(Format::Png) && !self.wanted.encoding.component.is_normalised()
    }

    /// The component type of its pictures.
    fn picture_component(&self) -> Component {
        if self.is_scaled() { Component::Unorm16 } else { self.wanted.encoding.component }
    }

    /// Channels and bits of its pictures.
    pub(super) fn picture_form(&self) -> (usize, u32) {
        (self.channels(), 8 * self.picture_component().bytes() as u32)
    }

    /// Text metadata of its pictures.
    pub(super) fn picture_texts(&self, scale: f64) -> Vec<(String, String)> {
        let mut texts = self.texts.clone();
        if self.is_scaled() {
            texts.retain(|(name, _)| name != "ridgelight.encoding");
            texts.push(("ridgelight.encoding".into(), "unorm16, times ridgelight.scale".into()));
            texts.push(("ridgelight.scale".into(), scale.to_string()));
        }
        texts
    }

    /// The largest finite value of a layer outside voids; 1 if none is positive.
    pub(super) fn largest(&self, planes: &[&[f32]]) -> f64 {
        let voids = self.voids();
        let own = |plane: &&[f32]| {
            let all = plane.iter().enumerate().filter(|(i, _)| !voids.is_some_and(|v| v[*i]));
            all.map(|(_, v)| *v).filter(|v| v.is_finite()).fold(0.0, f32::max)
        };
        let largest = planes.iter().map(own).fold(0.0, f32::max);
        if largest > 0.0 { largest.into() } else { 1.0 }
    }

    /// A layer's texels, and its picture's pixels: signed components as (v + 1)/2, divided by
    /// `scale`, 16 bits big-endian.
    pub(super) fn coded(&self, planes: &[&[f32]], scale: f64) -> (Vec<u8>, Vec<u8>) {
        let (encoding, voids) = (self.wanted.encoding, self.voids());
        let (component, format) = (encoding.component, self.wanted.texels());
        let of_picture = self.picture_component();
        let grid_points = self.size().iter().product::<usize>();
        let (has_texels, has_picture) = (self.has(Format::Ktx2), self.has(Format::Png));
        let reserve = |is_wanted: bool, each: usize| {
            Vec::with_capacity(if is_wanted { each * grid_points } else { 0 })
        };
        let mut texels = reserve(has_texels, format.bytes());
        let mut picture = reserve(has_picture, self.channels() * of_picture.bytes());
        if !has_texels && !has_picture {
            return (texels, picture);
        }
        let (mut values, mut parts) = ([0.0; 4], [0.0; 4]);
        let (values, parts) = (&mut values[..encoding.values], &mut parts[..encoding.components]);
        for at in 0..grid_points {
            for (value, plane) in values.iter_mut().zip(planes) {
                *value = f64::from(plane[at]);
            }
            (encoding.encode)(values, parts);
            let is_void = voids.is_some_and(|v| v[at]);
            if has_texels {
                parts.iter().for_each(|part| component.put(*part, &mut texels));
                if parts.len() < format.count {
                    component.put(if is_void { 0.0 } else { 1.0 }, &mut texels);
                }
            }
            if has_picture {
                for part in parts.iter() {
                    let part = part / scale;
                    let part = if of_picture.is_signed() { 0.5 + 0.5 * part } else { part };
                    put(&mut picture, of_picture, if is_void { 0.0 } else { part });
                }
                if voids.is_some() {
                    put(&mut picture, of_picture, if is_void { 0.0 } else { 1.0 });
                }
            }
        }
        (texels, picture)
    }
}

/// Appends a pixel value with as many bits as the component.
fn put(picture: &mut Vec<u8>, component: Component, value: f64) {
    match component.bytes() {
        1 => Component::Unorm8.put(value, picture),
        _ => {
            Component::Unorm16.put(value, picture);
            let end = picture.len();
            picture.swap(end - 2, end - 1);
        }
    }
}
