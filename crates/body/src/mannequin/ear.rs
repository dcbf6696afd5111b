use glam::{Mat3, Vec3};

use super::field::{Ellipsoid, Field, Swelling};

/// A bent tube: a part of a circle with a radius.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// Centre of the circle \[m\].
    pub(super) center: Vec3,
    /// Radius of the circle \[m\].
    pub(super) radius: f32,
    /// Middle of the part that is there \[rad\], from the first axis toward the second.
    pub(super) middle: f32,
    /// Half of the part that is there \[rad\].
    pub(super) half_span: f32,
    /// Radius of the tube \[m\].
    pub(super) tube: f32,
}

impl Arc {
    /// Exact distance.
    #[inline]
    fn at(&self, point: Vec3) -> Field {
        let offset = point - self.center;
        let (sine, cosine) = self.middle.sin_cos();
        // Turned so that the middle of the arc lies on the first axis.
        let along = offset.x * cosine + offset.y * sine;
        let across = offset.y * cosine - offset.x * sine;
        let (end_sine, end_cosine) = self.half_span.sin_cos();
        let radial = (along * along + across * across).sqrt().max(1e-6);
        let beyond = along * end_sine - across.abs() * end_cosine < 0.0;
        let (near_along, near_across) =
            if beyond { (end_cosine, end_sine * across.signum()) } else { (along / radial, across / radial) };
        let near = Vec3::new(
            near_along * cosine - near_across * sine,
            near_along * sine + near_across * cosine,
            0.0,
        ) * self.radius;
        let arm = offset - near;
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
    /// Angle \[rad\] by which the back edge stands off the head.
    pub(super) flare: f32,
    /// Angle \[rad\] by which the upper end leans back.
    pub(super) lean: f32,
    /// The thin shell.
    pub(super) shell: Ellipsoid,
    /// What joins the shell to the head.
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
        // A blend further away than its width changes nothing.
        let reach = REACH + ROOT_BLEND + head.value.max(0.0);
        if offset.length_squared() > reach * reach {
            return;
        }
        let head_from_ear = self.frame();
        let mut ear = self.at(head_from_ear.transpose() * offset);
        ear.gradient = head_from_ear * ear.gradient;
        *head = head.join(ear, ROOT_BLEND);
    }

    /// Distance \[m\] to the ear alone, from a point with x >= 0.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        self.at(self.frame().transpose() * (point - self.origin)).value
    }

    fn frame(&self) -> Mat3 {
        let (flare_sine, flare_cosine) = self.flare.sin_cos();
        let (lean_sine, lean_cosine) = self.lean.sin_cos();
        let back = Vec3::new(flare_sine, 0.0, -flare_cosine);
        let out = Vec3::new(flare_cosine, 0.0, flare_sine);
        let up = Vec3::Y;
        Mat3::from_cols(back * lean_cosine - up * lean_sine, up * lean_cosine + back * lean_sine, out)
    }

    fn at(&self, point: Vec3) -> Field {
        let mut shell = self.shell.at(point).join(self.lobe.at(point), 0.010);
        for hollow in &self.hollows {
            // The frame of an ear has no mirror plane: apply the swelling once.
            hollow.apply_at(hollow.center, point, &mut shell);
        }
        let rim = self.rim[0].at(point).join(self.rim[1].at(point), 0.001).join(self.rim[2].at(point), 0.001);
        shell
            .join(self.stem.at(point), 0.006)
            .join(rim, 0.004)
            .join(self.fold.at(point), 0.005)
            .join(self.tragus.at(point), 0.005)
    }
}
