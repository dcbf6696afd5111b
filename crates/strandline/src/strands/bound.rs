//! The strands of a groom that are not simulated, moved by those that are.

use std::sync::Arc;

use crate::{
    body::{BodyFrame, Collider, Solids},
    groom::{Binding, Frames, Guides, LaneSet, Vec3Lanes},
};

/// All strands of a groom, bound to the simulated ones among them, and the solids that they stay out of.
#[derive(Clone, Debug)]
pub struct BoundStrands {
    binding: Arc<Binding>,
    solids: Solids,
}

impl BoundStrands {
    /// Strands and solids; solids that the head carries are in head space.
    pub fn new(binding: Binding, solids: Vec<Collider>) -> Self {
        Self { binding: Arc::new(binding), solids: Self::kept(solids) }
    }

    /// Solids with the distance that strands keep from each.
    fn kept(solids: Vec<Collider>) -> Solids {
        let away = |solid: Collider| {
            let clearance = solid.shape.clearance();
            (solid, clearance)
        };
        Solids::new(solids.into_iter().map(away))
    }

    /// The same strands among these solids.
    pub(crate) fn among(&self, solids: Vec<Collider>) -> Self {
        let kept = Self::kept(solids);
        Self { binding: self.binding.clone(), solids: kept }
    }

    /// All strands at rest, head space.
    pub fn strands(&self) -> &Guides {
        self.binding.strands()
    }

    /// Guides that each strand follows.
    pub fn binding(&self) -> &Arc<Binding> {
        &self.binding
    }

    /// Positions of all strands \[m\], world space, shape `[block][point]` of lanes, from those of the guides, in
    /// the same shape. `frames` is used again from picture to picture.
    pub fn place(
        &self,
        guides: &[Vec3Lanes],
        body: &BodyFrame,
        frames: &mut Frames,
        out: &mut Vec<Vec3Lanes>,
    ) {
        self.binding.carry(LaneSet::ALL, guides, body, &self.solids, frames, out);
    }

    /// The solids that strands stay out of.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }
}
