use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::HeightField;
use super::lights::within;
use crate::{Error, Result};

/// A camera on a sphere around its target. Up in the image is up in the scene.
///
/// Positions are in the field's length unit: x east of the westernmost column, y north of the southernmost row, z up and
/// absolute, like the heights of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The target, at the centre of the image.
    pub target_m: [f64; 3],
    /// Azimuth of the eye from the target, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the eye from the target, radians, [-π/2..π/2]; ±π/2 rounded to f32 count as ±π/2. At π/2 the image is a
    /// map whose upper edge lies opposite the azimuth: north for an eye in the south.
    pub elevation_rad: f64,
    /// Distance from the target to the eye, [1e-9..1e15].
    pub distance_m: f64,
    /// The projection.
    pub lens: Lens,
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Rays meet in the eye.
    Perspective {
        /// Vertical field of view, radians, [0.001..3].
        fov_rad: f64,
    },
    /// Rays are parallel.
    Orthographic {
        /// Height of the visible area, [1e-9..1e15].
        height_m: f64,
    },
}

/// Range of lengths and coordinates of cameras.
const LENGTHS: std::ops::RangeInclusive<f64> = 1e-9..=1e15;

impl Camera {
    /// A camera whose image, `aspect` times as wide as high, just holds the field. Without a target, the field's box fills
    /// the middle of the image; the height of an orthographic lens is set to fit.
    pub fn around(
        field: &HeightField,
        target_m: Option<[f64; 3]>,
        [azimuth_rad, elevation_rad]: [f64; 2],
        lens: Lens,
        aspect: f64,
    ) -> Self {
        let corners = corners(field);
        let target = target_m.map_or((corners[0] + corners[7]) / 2.0, DVec3::from);
        let mut camera =
            Self { target_m: target.to_array(), azimuth_rad, elevation_rad, distance_m: 1.0, lens };
        let [right, up, back] = camera.axes();
        let largest = |of: &dyn Fn(DVec3) -> f64| {
            corners.iter().map(|c| of(*c - target)).fold(f64::NEG_INFINITY, f64::max)
        };
        match &mut camera.lens {
            Lens::Perspective { fov_rad } => {
                let tan = (*fov_rad / 2.0).tan();
                let needed =
                    |p: DVec3| p.dot(back) + p.dot(up).abs().max(p.dot(right).abs() / aspect) / tan;
                camera.distance_m = largest(&needed);
                if target_m.is_none() {
                    camera.enclose(&corners, [tan * aspect, tan]);
                }
            }
            Lens::Orthographic { height_m } => {
                *height_m = 2.0 * largest(&|p| p.dot(up).abs().max(p.dot(right).abs() / aspect));
                // Anywhere outside the field will do.
                camera.distance_m = 2.0 * largest(&DVec3::length);
            }
        }
        camera
    }

    /// Moves the eye as near as the corners allow, and centres their image; `tangents` are those of half the fields of view.
    /// The target stays at the depth of the field's middle.
    ///
    /// A corner p lies within both planes of an image axis, of tangent t, where ±(p - eye)·axis ≤ t (eye - p)·back. The two
    /// sums of largest corners give the least depth of the eye for the axis; the larger depth serves both. The other axis
    /// then has room: moving the eye along it moves all corners' images the other way, and bisection centres them.
    fn enclose(&mut self, corners: &[DVec3; 8], tangents: [f64; 2]) {
        let [right, up, back] = self.axes();
        let middle = DVec3::from(self.target_m);
        let axes = [(right, tangents[0]), (up, tangents[1])];
        // Largest reach after and before the middle along an axis.
        let reaches = axes.map(|(axis, tangent)| {
            [1.0, -1.0].map(|sign| {
                let reach = corners.map(|corner| {
                    let from = corner - middle;
                    sign * from.dot(axis) + tangent * from.dot(back)
                });
                reach.into_iter().fold(f64::NEG_INFINITY, f64::max)
            })
        });
        let depths = [0, 1].map(|k| (reaches[k][0] + reaches[k][1]) / (2.0 * tangents[k]));
        let depth = depths[0].max(depths[1]);
        let [across, high] = [0, 1].map(|k| {
            let (axis, tangent) = axes[k];
            // The eye's range, of no width for the axis that decides.
            let (mut low, mut end) =
                (reaches[k][0] - tangent * depth, tangent * depth - reaches[k][1]);
            for _ in 0..f64::MANTISSA_DIGITS {
                let eye = 0.5 * (low + end);
                let places = corners.map(|corner| {
                    let from = corner - middle;
                    (from.dot(axis) - eye) / (depth - from.dot(back))
                });
                let sum = places.iter().fold(f64::INFINITY, |m, v| m.min(*v))
                    + places.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v));
                if sum > 0.0 { low = eye } else { end = eye }
            }
            0.5 * (low + end)
        });
        let target = middle + across * right + high * up;
        // Angles that are no numbers are refused by `check`, under their own names.
        if target.is_finite() {
            self.target_m = target.to_array();
            self.distance_m = depth;
        }
    }

    /// Unit vectors right, up and back (out of the image): right-handed.
    pub fn axes(&self) -> [DVec3; 3] {
        let (sin_phi, cos_phi) = self.azimuth_rad.sin_cos();
        let (sin, cos) = within(self.elevation_rad, FRAC_PI_2).sin_cos();
        let back = DVec3::new(cos_phi * cos, sin_phi * cos, sin);
        let up = DVec3::new(-cos_phi * sin, -sin_phi * sin, cos);
        [up.cross(back), up, back]
    }

    /// Position of the eye.
    pub fn eye_m(&self) -> DVec3 {
        DVec3::from(self.target_m) + self.distance_m * self.axes()[2]
    }

    /// # Errors
    /// The first value out of range, by name.
    pub fn check(&self) -> Result<()> {
        let bad = |what: &str, found: String, expected: &str| {
            Err(Error::setting(format!("camera: {what}"), found, expected))
        };
        if !self.target_m.iter().all(|v| v.abs() <= *LENGTHS.end()) {
            return bad("look-at point", format!("{:?}", self.target_m), "numbers within ±1e15");
        }
        if !self.azimuth_rad.is_finite() {
            return bad("azimuth", self.azimuth_rad.to_string(), "a finite angle");
        }
        if !(-FRAC_PI_2..=FRAC_PI_2).contains(&within(self.elevation_rad, FRAC_PI_2)) {
            let found = format!("{}°", self.elevation_rad.to_degrees());
            return bad("elevation", found, "-90° to 90°");
        }
        match self.lens {
            Lens::Perspective { fov_rad } if !(0.001..=3.0).contains(&fov_rad) => {
                bad("field of view", format!("{}°", fov_rad.to_degrees()), "0.06° to 171°")
            }
            Lens::Orthographic { height_m } if !LENGTHS.contains(&height_m) => {
                bad("height of the picture", height_m.to_string(), "a length from 1e-9 to 1e15")
            }
            _ if !LENGTHS.contains(&self.distance_m) => {
                bad("distance", self.distance_m.to_string(), "a length from 1e-9 to 1e15")
            }
            _ => Ok(()),
        }
    }
}

/// Corners of the field's bounding box: first the lowest in the south-west, last the highest in the north-east.
pub(crate) fn corners(field: &HeightField) -> [DVec3; 8] {
    let [cell_x, cell_y] = field.cell_m();
    let far = [(field.cols() - 1) as f64 * cell_x, (field.rows() - 1) as f64 * cell_y];
    let (low, high) = field
        .heights_m()
        .iter()
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), z| (l.min(*z), h.max(*z)));
    let heights = [low, high].map(|z| field.base_m() + f64::from(z));
    std::array::from_fn(|i| {
        let side = |bit: usize, length: f64| if i & bit == 0 { 0.0 } else { length };
        DVec3::new(side(1, far[0]), side(2, far[1]), heights[i >> 2])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up to f32's ±π/2, with the axes of ±π/2; not the next f32.
    #[test]
    fn a_right_angle_of_a_camera_may_be_rounded_to_f32() {
        let lens = Lens::Orthographic { height_m: 1.0 };
        let at = |elevation_rad| Camera {
            target_m: [0.0; 3],
            azimuth_rad: 0.3,
            elevation_rad,
            distance_m: 1.0,
            lens,
        };
        let rounded = std::f32::consts::FRAC_PI_2;
        for sign in [1.0, -1.0] {
            let camera = at(sign * f64::from(rounded));
            camera.check().expect("in range");
            assert_eq!(camera.axes(), at(sign * FRAC_PI_2).axes());
            let message = at(sign * f64::from(rounded.next_up())).check().unwrap_err().to_string();
            assert!(message.starts_with("camera: elevation: "), "{message}");
        }
    }

    /// From the south, 90° up: north is up and east is right.
    #[test]
    fn from_above_east_is_right_and_north_is_up() {
        let camera = Camera {
            target_m: [0.0; 3],
            azimuth_rad: -FRAC_PI_2,
            elevation_rad: FRAC_PI_2,
            distance_m: 5.0,
            lens: Lens::Orthographic { height_m: 1.0 },
        };
        for (axis, want) in camera.axes().into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
            assert!((axis - want).length() < 1e-15, "{axis}");
        }
        assert!((camera.eye_m() - DVec3::new(0.0, 0.0, 5.0)).length() < 1e-14);
    }

    /// A level square of 2 by 2 from above under 90°: its edge is at 45° for an eye 1 above it. An orthographic image
    /// half as wide as high needs a height of 4.
    #[test]
    fn around_fits_the_field() {
        let field = HeightField::new(3, 3, &[7.0; 9], [1.0; 2], None).unwrap();
        let above = [-FRAC_PI_2, FRAC_PI_2];
        let lens = Lens::Perspective { fov_rad: FRAC_PI_2 };
        let camera = Camera::around(&field, None, above, lens, 1.0);
        assert_eq!(camera.target_m, [1.0, 1.0, 7.0]);
        assert!((camera.distance_m - 1.0).abs() < 1e-14, "{}", camera.distance_m);
        let lens = Lens::Orthographic { height_m: 1.0 };
        let Lens::Orthographic { height_m } = Camera::around(&field, None, above, lens, 0.5).lens
        else {
            panic!("another lens")
        };
        assert!((height_m - 4.0).abs() < 1e-14, "{height_m}");
    }

    /// Tangents of the corners' directions, over those of the image's edges: corners stand at both edges of one axis, none
    /// beyond any, and opposite sides are equally far from the middle.
    #[test]
    fn oblique_views_fill_the_image() {
        let heights: Vec<f64> = (0..35).map(|i| f64::from(i % 5)).collect();
        let field = HeightField::new(5, 7, &heights, [3.0, 2.0], None).unwrap();
        for (azimuth, elevation, aspect) in [(0.3, 0.4, 1.7), (-1.5, 0.1, 1.0), (2.0, 1.2, 0.4)] {
            let lens = Lens::Perspective { fov_rad: 0.7 };
            let camera = Camera::around(&field, None, [azimuth, elevation], lens, aspect);
            let [right, up, back] = camera.axes();
            let tan = 0.35_f64.tan();
            let places = corners(&field).map(|corner| {
                let from = corner - camera.eye_m();
                let depth = -from.dot(back);
                [from.dot(right) / depth / tan / aspect, from.dot(up) / depth / tan]
            });
            let edges = [0, 1].map(|k| {
                let all = places.map(|place| place[k]);
                [
                    all.iter().fold(9.0_f64, |m, v| m.min(*v)),
                    all.iter().fold(-9.0, |m: f64, v| m.max(*v)),
                ]
            });
            let is_within = edges.as_flattened().iter().all(|v| v.abs() < 1.0 + 1e-12);
            let is_filled = |[low, high]: [f64; 2]| (low + 1.0).abs() + (high - 1.0).abs() < 1e-12;
            assert!(is_within && (is_filled(edges[0]) || is_filled(edges[1])), "{edges:?}");
            assert!(edges.iter().all(|[low, high]| (low + high).abs() < 1e-12), "{edges:?}");
        }
    }
}
