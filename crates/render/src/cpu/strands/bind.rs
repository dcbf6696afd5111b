//! `bind`: strands that guides carry, placed about them and out of solids.

use std::sync::Arc;

use strandline_body::{BodyFrame, Solids};
use strandline_groom::{Binding, Frames, Vec3Lanes};

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

    /// Which guides each strand follows.
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

/// Places strands about their guides, whose points \[m\] are given in world space, shape `[block][point]` of lanes.
pub fn bind(carried: &mut Carried, guides: &[Vec3Lanes], body: &BodyFrame) {
    let Carried { binding, solids, frames, places } = carried;
    binding.carry(guides, body, solids, frames, places);
}
