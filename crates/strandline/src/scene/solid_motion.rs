//! Motion of the solids of `[[colliders]]` that have keyframes.

use glam::Vec3;

use super::{CarrierName, ColliderSection, KeyframeSection};
use crate::{
    Error,
    body::{Carrier, Collider, Interpolation, Motion, Pose, Shape},
};

/// A solid that moves through keyframes, about its middle.
#[derive(Clone, Debug)]
pub(crate) struct SolidMotion {
    motion: Motion,
    /// Its middle at rest \[m\], in the space of its carrier.
    middle: Vec3,
    carrier: CarrierName,
}

/// The motions of the solids that have keyframes, in their order, given the way from key to key where a key does not name
/// its own.
///
/// # Errors
/// Keyframes that are not in the order of their times.
pub(crate) fn solid_motions(
    solids: &[ColliderSection],
    interpolation: Interpolation,
) -> Result<Vec<SolidMotion>, Error> {
    let motion = |solid: &ColliderSection| {
        let keys = solid.keyframes().iter().map(|key| key.keyframe(interpolation));
        let motion = Motion::keyframes(&keys.collect::<Vec<_>>())?;
        Ok(SolidMotion { motion, middle: solid.middle(), carrier: solid.carrier() })
    };
    solids.iter().filter(|solid| !solid.keyframes().is_empty()).map(motion).collect()
}

/// The solids beside a body: those with keyframes, in their order, are the pieces behind `pieces` of the body, about their
/// middles.
///
/// # Errors
/// As [`ColliderSection::collider`].
pub(crate) fn colliders(solids: &[ColliderSection], pieces: usize) -> Result<Vec<Collider>, Error> {
    let mut moved = pieces as u16;
    let solid = |section: &ColliderSection| {
        let collider = section.collider()?;
        if section.keyframes().is_empty() {
            return Ok(collider);
        }
        moved += 1;
        let middle = section.middle();
        let shape = match collider.shape {
            Shape::Sphere { radius, .. } => Shape::Sphere { center: Vec3::ZERO, radius },
            Shape::Capsule { start, end, radius } => {
                Shape::Capsule { start: start - middle, end: end - middle, radius }
            }
            other => other,
        };
        Ok(Collider { shape, carrier: Carrier::Moved(moved), ..collider })
    };
    solids.iter().map(solid).collect()
}

impl SolidMotion {
    /// Its pose at a time \[s\] beside a head, in a world whose origin lies at `origin` \[m\].
    pub fn pose(&self, time: f64, head: &Pose, origin: Vec3) -> Pose {
        match self.carrier {
            CarrierName::World => self.motion.pose_from(time, Vec3::ZERO, origin - self.middle),
            CarrierName::Head => self.motion.pose_from(time, Vec3::ZERO, -self.middle).carried_by(head),
        }
    }
}

impl ColliderSection {
    pub(crate) fn keyframes(&self) -> &[KeyframeSection] {
        match self {
            Self::Sphere(sphere) => &sphere.keyframes,
            Self::Capsule(capsule) => &capsule.keyframes,
        }
    }

    fn carrier(&self) -> CarrierName {
        match self {
            Self::Sphere(sphere) => sphere.carrier,
            Self::Capsule(capsule) => capsule.carrier,
        }
    }

    fn middle(&self) -> Vec3 {
        match self {
            Self::Sphere(sphere) => sphere.center,
            Self::Capsule(capsule) => 0.5 * (capsule.start + capsule.end),
        }
    }
}
