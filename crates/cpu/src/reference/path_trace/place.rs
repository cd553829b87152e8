//! Vertices of a path and their reflection.

use super::{Tracer, given, largest, one};
use crate::shared::phong_lobe::phong_lobe;
use crate::shared::random::{direction_about, on_circle};
use crate::shared::trace::Met;
use crate::tolerance::near::{Near, Near3, dot, minus, normalize, plus, times};
use ridgelight::scene::{Albedo, Border, Normals, Specular};
use std::f64::consts::PI;

/// A path vertex.
pub(super) struct Place {
    pub(super) base: [i32; 2],
    pub(super) offset: [Near; 2],
    pub(super) own: Near,
    pub(super) normal: Near3,
    pub(super) albedo: Near3,
    pub(super) specular: [Near; 2],
    pub(super) mirror: Near3,
}

/// Reflection at a vertex: see the shader.
pub(super) struct Reflected {
    pub(super) facing: Near,
    pub(super) light: Near3,
    pub(super) density: Near,
    pub(super) scattered: Near3,
}

impl Tracer<'_> {
    /// At a grid point.
    pub(super) fn first(&self, grid_point: usize) -> Place {
        let cols = self.scene.field.cols();
        let [own, east, north] = given(self.grid_points[grid_point]);
        let normal = normalize([-east, -north, one()]);
        let view = self.view([grid_point % cols, grid_point / cols], own);
        let twice = Near::of(2.0) * dot(normal, view);
        Place {
            base: [(grid_point % cols) as i32, (grid_point / cols) as i32],
            offset: [Near::ZERO; 2],
            own,
            normal,
            albedo: given(self.albedo[grid_point]),
            specular: self.specular.get(grid_point).map_or([Near::ZERO; 2], |l| given(*l)),
            mirror: minus(times(twice, normal), view),
        }
    }

    /// Direction from a grid point to the eye, by `specular/mirror.glsl`.
    fn view(&self, [col, row]: [usize; 2], own: Near) -> Near3 {
        let above = [Near::ZERO, Near::ZERO, one()];
        let Some(eye) = self.eye_m else { return above };
        let [x, y] = self.ground.cell_m;
        let north = self.scene.field.rows() - 1 - row;
        let at = [Near::given(col as f32) * x, Near::given(north as f32) * y, own];
        let to_eye = minus(eye, at);
        let largest = largest(to_eye.map(Near::abs));
        // An eye at a grid point views it from above.
        if largest.above(Near::of(1e-30)) == Some(false) {
            return above;
        }
        normalize(to_eye.map(|v| v / largest))
    }

    /// At the hit of a ray along e. With smooth normals, at the corner of the triangle that the random number `drawn`
    /// selects; none where rounding decides which one.
    pub(super) fn place_of(
        &self,
        met: &Met,
        is_lower: bool,
        e: Near3,
        drawn: Near,
    ) -> Option<Place> {
        let [nw, ne, sw, se] = self.ground.corners(met.cell);
        let [east, south] = if is_lower { [se - sw, sw - nw] } else { [ne - nw, se - ne] };
        let [x, y] = self.ground.cell_m;
        let normal = normalize([-east / x, south / y, one()]);
        let (cols, rows) = (self.scene.field.cols(), self.scene.field.rows());
        let at = met.cell.map(|i| i as usize);
        let next = [(at[0] + 1) % cols, (at[1] + 1) % rows];
        let third = if is_lower { [at[0], next[1]] } else { [next[0], at[1]] };
        let [far, along] = if is_lower { met.offset } else { [met.offset[1], met.offset[0]] };
        let near = one() - along;
        let rest = one() - near - far;
        let grid_points =
            [(near, at), (far, next), (rest, third)].map(|(w, [c, r])| (w, r * cols + c));
        let mirror = |normal| minus(e, times(Near::of(2.0) * dot(e, normal), normal));
        if self.normals == Normals::Smooth {
            let is_near = near.above(drawn)?;
            let corner = if is_near {
                0
            } else if (near + far).above(drawn)? {
                1
            } else {
                2
            };
            let mut place = self.first(grid_points[corner].1);
            place.mirror = mirror(place.normal);
            return Some(place);
        }
        let between = |of: &dyn Fn(usize) -> Near| {
            let [a, b, c] = grid_points.map(|(weight, grid_point)| weight * of(grid_point));
            a + b + c
        };
        let is_map = matches!(self.scene.surface.albedo, Albedo::Map(_));
        let specular_is_map = matches!(self.scene.surface.specular, Some(Specular::Map(_)));
        let channel = |c: usize| between(&|i| Near::given(self.albedo[i][c]));
        let specular = |c: usize| match (specular_is_map, self.specular.first()) {
            (true, _) => between(&|i| Near::given(self.specular[i][c])).max(Near::ZERO),
            (false, Some(pair)) => Near::given(pair[c]),
            (false, None) => Near::ZERO,
        };
        Some(Place {
            base: met.cell,
            offset: met.offset,
            own: nw + met.offset[0] * east + met.offset[1] * south,
            normal,
            albedo: if is_map { [0, 1, 2].map(channel) } else { given(self.albedo[0]) },
            specular: [0, 1].map(specular),
            mirror: mirror(normal),
        })
    }

    /// Fraction of scattered rays drawn from the Phong lobe.
    fn specular_choice(place: &Place) -> Near {
        place.specular[1] / (largest(place.albedo) + place.specular[1]).max(Near::of(1e-30))
    }

    pub(super) fn reflected(&self, place: &Place, e: Near3) -> Reflected {
        let facing = dot(place.normal, e);
        let density = facing / Near::of(PI);
        let light = times(density, place.albedo);
        if self.specular.is_empty() {
            return Reflected { facing, light, density, scattered: place.albedo };
        }
        let phong = phong_lobe(minus(e, place.mirror), place.specular[0]);
        let choice = Self::specular_choice(place);
        let density = density * (one() - choice) + phong * choice;
        let more = place.specular[1] * phong;
        let light = light.map(|l| l + more);
        let scattered = light.map(|l| l / density.max(Near::of(1e-30)));
        Reflected { facing, light, density, scattered }
    }

    /// World position of the vertex; none where rounding decides whether a repeating field wraps there.
    pub(super) fn centre(&self, place: &Place) -> Option<Near3> {
        let (cols, rows) = (self.scene.field.cols(), self.scene.field.rows());
        let mut from = [0, 1].map(|i| Near::given(place.base[i] as f32) + place.offset[i]);
        if self.scene.surface.border == Border::Periodic {
            for (from, side) in from.iter_mut().zip([cols, rows]) {
                if !Near::given(side as f32).above(*from)? {
                    *from = Near::ZERO;
                }
            }
        }
        let [x, y] = self.ground.cell_m;
        Some([from[0] * x, (Near::given((rows - 1) as f32) - from[1]) * y, place.own])
    }

    /// Direction of the scattered ray; none where rounding decides between diffuse and specular.
    pub(super) fn scattered(&self, place: &Place, u: [Near; 2], v: [Near; 2]) -> Option<Near3> {
        let by_specular = if self.specular.is_empty() {
            false
        } else {
            Self::specular_choice(place).above(v[0])?
        };
        if by_specular {
            let power = one() / (place.specular[0] + one());
            let near_mirror = u[0].max(Near::of(1e-30)).powf(power);
            return direction_about(place.mirror, one() - near_mirror, u[1]);
        }
        let two = Near::of(2.0);
        let side = (Near::of(4.0) * u[0] * (one() - u[0])).sqrt();
        let [cos, sin] = on_circle(u[1]).map(|c| c * side);
        Some(normalize(plus(place.normal, [cos, sin, one() - two * u[0]])))
    }
}
