//! Hair in the middle of a swing.

use glam::Vec3;
use strandline_base::{fill_lanes, in_strand_order};

use crate::{
    body::BodyFrame,
    groom::Vec3Lanes,
    sim::{MOST_SPIN, State},
};

/// Positions and motion of guides at a moment, and the body.
///
/// Its file is a snapshot by itself (docs/cache.md). Files of earlier builds hold tensors, which are read as well, and so
/// is the snapshot in a moving cache of guides.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HairPose {
    /// Strands, and points of each.
    pub(super) shape: [usize; 2],
    /// Positions \[m\] and velocities \[m/s\], world space, shape `[strand][point]`.
    pub(super) positions: Vec<Vec3>,
    pub(super) velocities: Vec<Vec3>,
    /// The part of the next prediction that is added to the velocities \[m/s\].
    pub(super) corrections: Vec<Vec3>,
    /// First axes of the sections of rods, and the angular velocities about their segments \[rad/s\]; empty without rods.
    pub(super) sections: Vec<Vec3>,
    pub(super) spins: Vec<f32>,
    pub(super) body: BodyFrame,
}

/// The remedy for a file of other hair.
pub(super) const REMEDY: &str = "take `pose` out of [groom] to begin at rest";
/// Most pieces of a body after the head.
pub(super) const MOST_PIECES: usize = 1024;
/// Farther than this \[m\], or faster \[m/s\], is no hair. Its sections spin faster: no more than [`MOST_SPIN`].
const MOST: f32 = 1e4;

impl HairPose {
    /// Takes positions \[m\] that are shown, world space, shape `[block][point]` of lanes, and how a
    /// state moves.
    pub fn new(shape: [usize; 2], positions: &[Vec3Lanes], state: &State, body: &BodyFrame) -> Self {
        let [strands, points] = shape;
        let each = |lanes: &[Vec3Lanes]| in_strand_order(lanes, strands, points).collect();
        Self {
            shape,
            positions: each(positions),
            velocities: each(&state.velocities),
            corrections: each(&state.corrections),
            sections: if state.sections.is_empty() { Vec::new() } else { each(&state.sections) },
            spins: if state.spins.is_empty() {
                Vec::new()
            } else {
                in_strand_order(&state.spins, strands, points).collect()
            },
            body: body.clone(),
        }
    }

    /// The body.
    pub fn body(&self) -> &BodyFrame {
        &self.body
    }

    /// The same hair on a body with other root frames.
    pub(crate) fn on(self, body: BodyFrame) -> Self {
        Self { body, ..self }
    }

    /// The pose after everything in the world moved by a way \[m\].
    pub fn moved(&self, by: Vec3) -> Self {
        if by == Vec3::ZERO {
            return self.clone();
        }
        let positions = self.positions.iter().map(|position| *position + by).collect();
        Self { positions, body: self.body.moved(by), ..self.clone() }
    }

    /// Puts the hair of a state there, now and one step ago.
    pub fn place(&self, state: &mut State) {
        let [strands, points] = self.shape;
        let vectors = |lanes: &mut [Vec3Lanes], from: &[Vec3]| {
            fill_lanes(lanes, strands, points, |strand, point| from[strand * points + point]);
        };
        vectors(&mut state.positions, &self.positions);
        vectors(&mut state.velocities, &self.velocities);
        vectors(&mut state.corrections, &self.corrections);
        if !self.sections.is_empty() && !self.spins.is_empty() {
            vectors(&mut state.sections, &self.sections);
            fill_lanes(&mut state.spins, strands, points, |strand, point| {
                self.spins[strand * points + point]
            });
        }
        state.previous_positions.clone_from(&state.positions);
    }
}

/// Refuses numbers of an array that no hair has.
pub(super) fn check(name: &str, numbers: &[f32]) -> Result<(), String> {
    let most = if name == "spins" { MOST_SPIN } else { MOST };
    match numbers.iter().find(|number| !(number.abs() <= most)) {
        Some(number) => Err(format!("{name} hold {number}, expected no more than {most}")),
        None => Ok(()),
    }
}

/// Vectors of rows of three numbers.
pub(super) fn vectors(numbers: &[f32]) -> Vec<Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use glam::Quat;

    use super::*;
    use crate::{
        body::Pose,
        groom::{Groom, Guides},
        sim::{Model, Settings},
    };

    pub const SHAPE: [usize; 2] = [11, 5];

    pub fn pose() -> HairPose {
        let count = SHAPE[0] * SHAPE[1];
        let value = |index: usize| Vec3::new(index as f32 * 0.01, -0.5, 1.0 / (1.0 + index as f32));
        HairPose {
            shape: SHAPE,
            positions: (0..count).map(value).collect(),
            velocities: (0..count).map(|index| -value(index)).collect(),
            corrections: (0..count).map(|index| 0.1 * value(index)).collect(),
            sections: Vec::new(),
            spins: Vec::new(),
            body: Pose { rotation: Quat::from_rotation_y(1.2), translation: Vec3::new(0.3, 0.1, 0.0) }.into(),
        }
    }

    #[test]
    fn it_survives_its_lanes() {
        let pose = pose();
        let mut groom = Groom::empty(8e-5);
        (0..SHAPE[0]).for_each(|_| groom.push([Vec3::ZERO, Vec3::NEG_Y]));
        let guides = Guides::resample(&groom, SHAPE[1]).unwrap();
        let model = Model::new(&guides, &Settings::constrained(), Vec::new()).unwrap();
        let mut state = model.rest_state(Pose::IDENTITY);
        pose.place(&mut state);
        // The last lanes have no strand of their own.
        assert_eq!(state.positions[SHAPE[1]].get(7), state.positions[SHAPE[1]].get(2));
        assert_eq!(state.previous_positions, state.positions);
        let again = HairPose::new(SHAPE, &state.positions, &state, &pose.body);
        assert_eq!(again, pose);
    }
}
