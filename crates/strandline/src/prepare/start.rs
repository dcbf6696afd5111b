//! The body when the hair begins to move.

use glam::Vec3;

use crate::body::BodyFrame;

/// The body when the hair begins to move.
#[derive(Clone, Default)]
pub(super) struct Start {
    /// An origin \[m\] of the world beside the head.
    pub origin: Vec3,
    /// The body, seen from there.
    pub body: BodyFrame,
}
