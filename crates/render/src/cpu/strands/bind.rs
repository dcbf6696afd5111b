//! `bind`: strands that guides carry, placed about them and out of solids.

use std::borrow::Cow;
use std::sync::Arc;

use strandline_body::{BodyFrame, Solids};
use strandline_groom::{Binding, Frames, Guides, LaneSet, Vec3Lanes};

use crate::DetailLevel;

/// Strands that guides carry, with the memory that placing them takes.
#[derive(Clone, Debug)]
pub struct Carried {
    binding: Arc<Binding>,
    solids: Solids,
    frames: Frames,
    places: Vec<Vec3Lanes>,
}

impl Carried {
    /// The strands of a binding, which stay out of solids.
    pub fn new(binding: Arc<Binding>, solids: Solids) -> Self {
        Self { binding, solids, frames: Frames::default(), places: Vec::new() }
    }

    /// Guides that each strand follows.
    pub fn binding(&self) -> &Binding {
        &self.binding
    }

    /// The solids that drawn strands stay out of.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }

    /// The points of the strands as they were placed last \[m\], world space, shape `[block][point]` of lanes.
    pub fn places(&self) -> &[Vec3Lanes] {
        &self.places
    }
}

/// Places the strands of a set about their guides, whose points \[m\] are given in world space, shape `[block][point]` of
/// lanes.
pub fn bind(carried: &mut Carried, set: LaneSet, guides: &[Vec3Lanes], body: &BodyFrame) {
    let Carried { binding, solids, frames, places } = carried;
    binding.carry(set, guides, body, solids, frames, places);
}

/// Points \[m\] of the strands that are drawn, world space, shape `[block][point]` of lanes: those that were placed last, or
/// those of all guides, of which some may be left out.
pub fn drawn_points<'a>(
    carried: Option<&'a Carried>,
    guide_points: &'a [Vec3Lanes],
    guides: &Guides,
    level: &DetailLevel,
) -> Cow<'a, [Vec3Lanes]> {
    let lanes = level.drawn_lanes();
    match carried {
        Some(carried) => Cow::Borrowed(carried.places()),
        None if lanes.is_all() => Cow::Borrowed(guide_points),
        None => Cow::Owned(lanes.taken(guide_points, guides.strand_count(), guides.points_per_strand())),
    }
}
