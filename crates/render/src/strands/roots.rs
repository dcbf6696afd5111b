//! Turns of the skin about the roots of drawn strands.

use glam::Quat;
use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, Pose};
use strandline_groom::{Binding, Influence};

/// Rotations that take the skin about roots from head space into the world.
pub trait RootTurn: Sync {
    /// The rotation at the root of a drawn strand.
    fn turn(&self, strand: usize) -> Quat;
}

/// A rigid head turns all of its skin alike.
impl RootTurn for Pose {
    fn turn(&self, _: usize) -> Quat {
        self.rotation
    }
}

/// The rotations of a moment; memory is kept from moment to moment.
#[derive(Clone, Debug, Default)]
pub struct RootTurns {
    head: Quat,
    /// Shape `[strand]`; empty where all roots ride the head.
    own: Vec<Quat>,
}

impl RootTurn for RootTurns {
    fn turn(&self, strand: usize) -> Quat {
        self.own.get(strand).copied().unwrap_or(self.head)
    }
}

impl RootTurns {
    /// Takes the root frames of a moment. Drawn strands are the guides themselves, or those of a binding: each then turns
    /// as the mean of the guides that it follows. All ride the head where the body has root frames of another number of
    /// strands, or none.
    pub fn place(&mut self, body: &BodyFrame, binding: Option<&Binding>, strand_count: usize) {
        self.head = body.world_from_head().rotation;
        self.own.clear();
        let guide_count = binding.map_or(strand_count, |binding| binding.guides().strand_count());
        if body.roots().is_none_or(|roots| roots.len() != guide_count) {
            return;
        }
        self.own.resize(strand_count, Quat::IDENTITY);
        self.own.par_iter_mut().enumerate().for_each(|(strand, turn)| {
            *turn = match binding {
                None => body.root(strand).rotation,
                Some(binding) => mean(&binding.influences()[strand], body),
            };
        });
    }

    /// True where all roots ride the head.
    pub fn is_rigid(&self) -> bool {
        self.own.is_empty()
    }
}

/// Mean turn of the guides that a strand follows.
fn mean(influences: &[Influence], body: &BodyFrame) -> Quat {
    let turn = |one: &Influence| body.root(one.guide as usize).rotation;
    let Some(first) = influences.first().map(turn) else { return body.world_from_head().rotation };
    let weighted = |one: &Influence| {
        let turn = turn(one);
        // The opposite quaternion is the same rotation.
        turn * if turn.dot(first) < 0.0 { -one.weight } else { one.weight }
    };
    let sum = influences.iter().map(weighted).fold(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), |sum, one| sum + one);
    if sum.length_squared() > 1e-6 { sum.normalize() } else { first }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_strand_turns_as_the_mean_of_its_guides() {
        let root = |angle: f32| Pose { rotation: Quat::from_rotation_y(angle), ..Pose::IDENTITY };
        let opposite = Pose { rotation: -Quat::from_rotation_y(0.6), ..Pose::IDENTITY };
        let body = BodyFrame::REST.with_roots([root(0.2), opposite, root(FRAC_PI_2)]);
        let follow = |weights: [f32; 2]| {
            [0, 1].map(|guide| Influence { guide, weight: weights[guide as usize], pace: 1.0 })
        };
        for (weights, angle) in [([1.0, 0.0], 0.2), ([0.0, 1.0], 0.6), ([0.5, 0.5], 0.4)] {
            let found = mean(&follow(weights), &body);
            assert!(found.angle_between(root(angle).rotation) < 1e-3, "{weights:?}: {found}");
        }
    }

    #[test]
    fn root_frames_of_other_strands_are_left_out() {
        let turned = Pose { rotation: Quat::from_rotation_x(1.0), ..Pose::IDENTITY };
        let body = BodyFrame::REST.with_roots([turned; 3]);
        let mut turns = RootTurns::default();
        turns.place(&body, None, 3);
        assert_eq!((turns.is_rigid(), turns.turn(2)), (false, turned.rotation));
        turns.place(&body, None, 4);
        assert_eq!((turns.is_rigid(), turns.turn(2)), (true, Quat::IDENTITY));
    }
}
