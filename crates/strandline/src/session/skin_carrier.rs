//! Roots that the skin of a body carries.

use std::sync::{Arc, OnceLock};

use glam::Vec3;

use crate::{
    body::{BodyFrame, Mesh, SkinRoots},
    groom::Guides,
};

/// The drawn body and the roots at rest. The places of the roots are found when the skin first moves: a rigid body pays
/// nothing.
#[derive(Default)]
pub(crate) struct SkinCarrier {
    body: Option<(Arc<Mesh>, Vec<Vec3>)>,
    roots: OnceLock<SkinRoots>,
}

impl SkinCarrier {
    /// The roots of guides on a drawn body.
    pub fn new(mesh: Option<Arc<Mesh>>, guides: &Guides) -> Self {
        let roots = || (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
        Self { body: mesh.map(|mesh| (mesh, roots())), roots: OnceLock::new() }
    }

    /// A frame with the root frames that follow from its skin: see [`SkinRoots::placed`].
    pub fn placed(&self, body: BodyFrame, last: &BodyFrame) -> BodyFrame {
        match self.roots_on(&body) {
            Some(roots) => roots.placed(body, last),
            None => body,
        }
    }

    /// A frame that was saved: see [`SkinRoots::recognized`].
    pub fn recognized(&self, body: BodyFrame) -> BodyFrame {
        match self.roots_on(&body) {
            Some(roots) => roots.recognized(body),
            None => body,
        }
    }

    fn roots_on(&self, body: &BodyFrame) -> Option<&SkinRoots> {
        let (mesh, roots) = self.body.as_ref().filter(|_| body.skin().is_some())?;
        Some(self.roots.get_or_init(|| SkinRoots::new(mesh, roots)))
    }
}
