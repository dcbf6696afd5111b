//! Views of lights: the projection of points onto the plane of a light, and the section of it that a map covers.

use glam::{Vec2, Vec3};
use strandline_base::math;

use crate::{Light, LightKind};

/// Nearest depth \[m\] that a spot or point light sees.
const NEAR_LIGHT: f32 = 1e-2;

/// View of a light, and its map from points to its plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LightView {
    pub(crate) origin: Vec3,
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
    pub(crate) forward: Vec3,
    parallel: bool,
    /// Greatest coordinate on the plane that the light reaches.
    pub(crate) reach: f32,
    /// Sides \[m\], along `right` and `up`, of the part of a light with an area that this place of it stands for.
    pub(crate) part: [Vec2; 2],
}

impl LightView {
    /// The view of a light; a point light looks at `middle` \[m\].
    pub(crate) fn new(light: &Light, middle: Vec3) -> Self {
        let looks_at_hair = matches!(light.kind, LightKind::Point | LightKind::Rectangle | LightKind::Disc);
        let target = if looks_at_hair { middle } else { light.target };
        let forward = (target - light.position).normalize_or(Vec3::NEG_Y);
        let (right, up) = across(forward);
        let reach = match light.kind {
            LightKind::Directional => f32::INFINITY,
            LightKind::Spot => math::tan(light.cone_angle.to_radians()),
            LightKind::Point | LightKind::Rectangle | LightKind::Disc => 10.0,
        };
        let parallel = light.kind == LightKind::Directional;
        let part = light.part().map(|side| Vec2::new(side.dot(right), side.dot(up)));
        Self { origin: light.position, right, up, forward, parallel, reach, part }
    }

    /// Plane coordinates and depth \[m\]; `None` behind the light.
    #[inline]
    pub(crate) fn project(&self, point: Vec3) -> Option<Vec3> {
        let way = point - self.origin;
        let depth = way.dot(self.forward);
        let (x, y) = (way.dot(self.right), way.dot(self.up));
        if self.parallel {
            Some(Vec3::new(x, y, depth))
        } else if depth > NEAR_LIGHT {
            let inverse = 1.0 / depth;
            Some(Vec3::new(x * inverse, y * inverse, depth))
        } else {
            None
        }
    }

    /// Unit direction on the plane that points down in the world; +y where the plane is horizontal.
    pub(crate) fn down(&self) -> Vec2 {
        let down = -Vec2::new(self.right.y, self.up.y);
        if down.length() > 1e-3 { down.normalize() } else { Vec2::Y }
    }

    /// Plane units a metre measures at a depth.
    #[inline]
    pub(crate) fn scale(&self, depth: f32) -> f32 {
        if self.parallel { 1.0 } else { 1.0 / depth }
    }
}

/// The two directions of a light's plane, carried from those of a light from above by the smallest rotation.
///
/// They change as smoothly as the light moves, but about one that shines straight up: some direction must be
/// left out, and few lights stand below the hair.
fn across(forward: Vec3) -> (Vec3, Vec3) {
    let whole = 1.0 - forward.y;
    if whole < 1e-6 {
        return (Vec3::X, Vec3::NEG_Z);
    }
    let turned = (forward - Vec3::Y) / whole;
    (Vec3::X - forward.x * turned, Vec3::Z - forward.z * turned)
}

/// A number rounded down to `bits` bits of its mantissa: small changes rarely cross such a step.
pub(crate) fn stepped_down(number: f32, bits: u32) -> f32 {
    f32::from_bits(number.to_bits() & (u32::MAX << (23 - bits)))
}

/// Bits of a map's density behind the first: steps of 14 to 25 %.
const DENSITY_BITS: u32 = 2;

/// The square part of a light's plane that a map covers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Window {
    pub(crate) min: Vec2,
    /// Texels in a plane unit.
    pub(crate) density: f32,
}

impl Window {
    /// A square around `bounds` (least and greatest plane coordinates) that the light reaches, with a border
    /// of one texel.
    ///
    /// Texels have sizes of a few steps and lie whole numbers of them beside `middle` \[m\], so that they stay
    /// where they are on the hair while its outline changes.
    pub(crate) fn around(bounds: (Vec2, Vec2), view: &LightView, middle: Vec3, size: usize) -> Self {
        let reach = Vec2::splat(view.reach);
        let (min, max) = (bounds.0.max(-reach), bounds.1.min(reach));
        if !(min.cmple(max).all() && min.is_finite() && max.is_finite()) {
            return Self { min: Vec2::ZERO, density: 0.0 };
        }
        let extent = (max - min).max_element().max(1e-4);
        // A texel of border on each side, and half a one on each for whole numbers.
        let density = stepped_down((size as f32 - 3.0) / extent, DENSITY_BITS);
        let anchor = view.project(middle).map_or(Vec2::ZERO, Vec3::truncate);
        let first = (0.5 * (min + max) - anchor) * density - Vec2::splat(0.5 * size as f32 - 0.5);
        Self { min: anchor + first.floor() / density, density }
    }

    /// Texel coordinates; texel 0 lies between 0 and 1.
    #[inline]
    pub(crate) fn texel(&self, plane: Vec2) -> Vec2 {
        (plane - self.min) * self.density
    }
}
