use glam::{Mat3, Vec2, Vec3};
use strandline_base::math;

use super::field::{Ellipsoid, Field, Swelling};

/// A bent tube: a part of a circle with a radius.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    center: Vec3,
    radius: f32,
    tube: f32,
    /// Direction of the middle of the part that is there.
    middle: Vec2,
    /// Direction of its end, seen from its middle.
    end: Vec2,
}

impl Arc {
    /// `center` and `radius` \[m\] of the circle, `tube` \[m\] of the tube around it; there `from` and
    /// `to` \[degrees\] from the first axis toward the second.
    pub(super) fn new(center: Vec3, radius: f32, from: f32, to: f32, tube: f32) -> Self {
        let middle = math::unit_at((0.5 * (from + to)).to_radians());
        let end = math::unit_at((0.5 * (to - from)).to_radians());
        Self { center, radius, tube, middle, end }
    }

    /// Exact distance.
    #[inline]
    fn at(&self, point: Vec3) -> Field {
        let offset = point - self.center;
        // Turned so that the middle of the arc lies on the first axis.
        let turned = Vec2::new(self.middle.x, -self.middle.y).rotate(offset.truncate());
        let beyond = turned.x * self.end.y < turned.y.abs() * self.end.x;
        let nearest = if beyond {
            Vec2::new(self.end.x, self.end.y.copysign(turned.y))
        } else {
            turned.normalize_or(Vec2::X)
        };
        let arm = offset - (self.middle.rotate(nearest) * self.radius).extend(0.0);
        let distance = arm.length();
        Field { value: distance - self.tube, gradient: arm / distance.max(1e-6) }
    }
}

/// The outer ear, in its own frame: first axis to the back, second up, third out.
#[repr(C)]
#[derive(Clone, Debug)]
pub(super) struct Ear {
    /// Origin of the frame \[m\], head space.
    pub(super) origin: Vec3,
    /// The axes of the frame, head space.
    pub(super) head_from_ear: Mat3,
    /// The thin shell.
    pub(super) shell: Ellipsoid,
    /// Ellipsoid that joins the shell to the head.
    pub(super) stem: Ellipsoid,
    /// The lobe.
    pub(super) lobe: Ellipsoid,
    /// The knob in front of the hollow.
    pub(super) tragus: Ellipsoid,
    /// The rim: crus, crown and back edge.
    pub(super) rim: [Arc; 3],
    /// The fold inside the rim.
    pub(super) fold: Arc,
    /// The hollow and the furrow under the rim.
    pub(super) hollows: [Swelling; 2],
}

/// Every part of the ear lies within this distance \[m\] of its origin.
const REACH: f32 = 0.040;
/// Blend of ear and head \[m\].
const ROOT_BLEND: f32 = 0.010;

impl Ear {
    /// Joins the ear to the head at a point with x >= 0.
    #[inline]
    pub(super) fn add(&self, point: Vec3, head: &mut Field) {
        let offset = point - self.origin;
        // A blend further away than its width has no effect.
        let reach = REACH + ROOT_BLEND + head.value.max(0.0);
        if offset.length_squared() > reach * reach {
            return;
        }
        let mut ear = self.at(self.head_from_ear.transpose() * offset);
        ear.gradient = self.head_from_ear * ear.gradient;
        *head = head.join(ear, ROOT_BLEND);
    }

    /// Distance \[m\] to the ear alone, from a point with x >= 0.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        self.at(self.head_from_ear.transpose() * (point - self.origin)).value
    }

    /// True if the ear is nearer than a distance \[m\] to a point with x >= 0.
    pub(super) fn is_within(&self, point: Vec3, distance: f32) -> bool {
        let reach = REACH + ROOT_BLEND + distance;
        (point - self.origin).length_squared() <= reach * reach && self.distance(point) <= distance
    }

    /// The axes of an ear whose back edge stands off the head by `flare` \[rad\] and whose upper end
    /// leans back by `lean` \[rad\].
    pub(super) fn frame(flare: f32, lean: f32) -> Mat3 {
        let (flare_sine, flare_cosine) = math::sin_cos(flare);
        let (lean_sine, lean_cosine) = math::sin_cos(lean);
        let back = Vec3::new(flare_sine, 0.0, -flare_cosine);
        let out = Vec3::new(flare_cosine, 0.0, flare_sine);
        Mat3::from_cols(
            back * lean_cosine - Vec3::Y * lean_sine,
            Vec3::Y * lean_cosine + back * lean_sine,
            out,
        )
    }

    fn at(&self, point: Vec3) -> Field {
        let mut shell = self.shell.at(point).join(self.lobe.at(point), 0.010);
        for hollow in &self.hollows {
            hollow.raise_here(point, &mut shell);
        }
        let rim = self.rim[0].at(point).join(self.rim[1].at(point), 0.001).join(self.rim[2].at(point), 0.001);
        shell
            .join(self.stem.at(point), 0.006)
            .join(rim, 0.004)
            .join(self.fold.at(point), 0.005)
            .join(self.tragus.at(point), 0.008)
    }
}
