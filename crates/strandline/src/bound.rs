//! The strands of a groom that are not simulated, moved by those that are.

use std::sync::Arc;

use glam::Vec3;

use crate::{
    body::{Carrier, Collider, Pose, Shape},
    groom::{Binding, Frames, Guides, Surface, Vec3Lanes},
};

/// Share of the distance between samples of a solid that strands stay away from it, and how far at most \[m\]: samples
/// err by about so much where the surface curves.
const CLEARANCE: f32 = 0.25;
const MOST_CLEARANCE: f32 = 0.002;

/// How far \[m\] bound strands stay away from a solid.
pub(crate) fn clearance(shape: &Shape) -> f32 {
    match shape {
        Shape::Grid(grid) => (CLEARANCE * grid.spacing()).min(MOST_CLEARANCE),
        Shape::Sphere { .. } | Shape::Capsule { .. } | Shape::Mannequin(_) => 0.0,
    }
}

/// All strands of a groom, bound to the simulated ones among them, and the solids that they stay out of.
#[derive(Clone, Debug)]
pub struct BoundStrands {
    binding: Arc<Binding>,
    solids: Arc<[Collider]>,
}

impl BoundStrands {
    /// Strands and solids; what the head carries is in head space.
    pub fn new(binding: Binding, solids: Vec<Collider>) -> Self {
        Self { binding: Arc::new(binding), solids: solids.into() }
    }

    /// All strands at rest, head space.
    pub fn strands(&self) -> &Guides {
        self.binding.strands()
    }

    /// Which guides each strand follows.
    pub fn binding(&self) -> &Binding {
        &self.binding
    }

    /// Where all strands are \[m\], world space, shape `[block][point]` of lanes, given where the guides are, in
    /// the same shape. `frames` is used again from picture to picture.
    pub fn place(
        &self,
        guides: &[Vec3Lanes],
        world_from_head: &Pose,
        frames: &mut Frames,
        out: &mut Vec<Vec3Lanes>,
    ) {
        let head_from_world = world_from_head.inverse();
        let surface = |point: Vec3| {
            let in_head = head_from_world.point(point);
            let start = (f32::INFINITY, Vec3::Y, Carrier::World);
            let nearest = self.solids.iter().fold(start, |best, solid| {
                let place = if solid.carrier == Carrier::Head { in_head } else { point };
                let (distance, gradient) = solid.shape.distance_and_gradient(place);
                let distance = distance - clearance(&solid.shape);
                if distance < best.0 { (distance, gradient, solid.carrier) } else { best }
            });
            let (distance, gradient, carrier) = nearest;
            let turned =
                if carrier == Carrier::Head { world_from_head.direction(gradient) } else { gradient };
            (distance, turned)
        };
        let at_least = |point: Vec3| {
            let in_head = head_from_world.point(point);
            let least = self.solids.iter().map(|solid| {
                let place = if solid.carrier == Carrier::Head { in_head } else { point };
                solid.shape.distance_at_least(place) - clearance(&solid.shape)
            });
            least.fold(f32::INFINITY, f32::min)
        };
        let surface = Surface { at: &surface, at_least: &at_least };
        let surface = (!self.solids.is_empty()).then_some(&surface);
        self.binding.follow(guides, world_from_head, frames);
        self.binding.place(frames, world_from_head, surface, out);
    }

    /// The solids that strands stay out of, and how far \[m\] from each.
    pub fn solids(&self) -> Vec<(Collider, f32)> {
        self.solids.iter().map(|solid| (solid.clone(), clearance(&solid.shape))).collect()
    }
}
