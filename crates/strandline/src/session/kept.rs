//! Parts of a session for a timeline.

use glam::Vec3;

use super::{bookmark::Bookmark, job::Task};
use crate::{body::BodyFrame, groom::Vec3Lanes, sim::Settings};

/// Tasks of a session for a timeline, and what a person wants of the simulation.
#[derive(Default)]
pub(super) struct Kept {
    /// Tasks since the last frame was started, while a timeline is kept.
    pub tasks: Option<Vec<Task>>,
    /// The simulation after the last task that was taken.
    pub bookmark: Option<Bookmark>,
    /// Settings and length of the hair that were last asked for.
    pub settings: Option<Box<Settings>>,
    pub length: Option<f32>,
}

/// Points and body of a moment, on the host.
pub(crate) struct HostMoment<'a> {
    /// Guide points \[m\], seen from the origin, shape `[block][point]` of lanes.
    pub positions: &'a [Vec3Lanes],
    /// Body, seen from the origin, and the origin \[m\].
    pub body: &'a BodyFrame,
    pub origin: Vec3,
}
