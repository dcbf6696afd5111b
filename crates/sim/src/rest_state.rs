//! States at rest, and how far others lie from them.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, Pose};
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use crate::at_rest::carried;
use crate::contact::planes::Contacts;
use crate::grab::Grab;
use crate::loads::Loads;
use crate::{Drift, Model, State};

impl Model {
    /// The guides at rest, carried by the root frames of a body: a frame, or the pose of a rigid head. Guides with
    /// velocities of their own begin with them.
    pub fn rest_state(&self, body: impl Into<BodyFrame>) -> State {
        let body = body.into();
        let positions = self.carried(&self.positions, &body, |pose| pose);
        let blocks = positions.len() / self.points_per_strand;
        let rods = self.rods.as_ref().map_or(0, |rods| rods.sections.len());
        State {
            sections: self.sections(&body),
            spins: vec![Lanes::default(); rods],
            corrections: vec![Vec3Lanes::default(); positions.len()],
            velocities: if self.velocities.is_empty() {
                vec![Vec3Lanes::default(); positions.len()]
            } else {
                self.carried(&self.velocities, &body, turn)
            },
            previous_positions: positions.clone(),
            body,
            time: 0.0,
            length_scale: vec![Lanes([1.0; LANES]); blocks],
            lengths: Arc::clone(&self.rest),
            contacts: Contacts::new(&self.colliders, blocks, self.points_per_strand),
            tensions: Vec::new(),
            loads: Loads::default(),
            pairs: Vec::new(),
            volume_box: None,
            grab: Grab::default(),
            positions,
        }
    }

    /// Vectors of all points at rest, shape `[block][point]` of lanes, carried by motions that follow from root frames.
    fn carried(&self, rest: &[Vec3Lanes], body: &BodyFrame, motion: fn(Pose) -> Pose) -> Vec<Vec3Lanes> {
        let points = self.points_per_strand;
        let of_point = |(index, lanes): (usize, &Vec3Lanes)| {
            carried(lanes, &self.roots(body, index / points).map(motion))
        };
        rest.par_iter().enumerate().map(of_point).collect()
    }

    /// Distance of a state from the hair at rest, carried by the root frames of the state.
    pub fn drift(&self, state: &State) -> Drift {
        let points = self.points_per_strand;
        let (mut sum, mut max) = (0.0, 0.0_f32);
        for strand in 0..self.strand_count {
            let (first, lane) = (strand / LANES * points, strand % LANES);
            let length: f32 = (first..first + points).map(|index| self.rest.stretch[index].0[lane]).sum();
            for index in first..first + points {
                let home = state.body.root(strand).point(self.positions[index].get(lane));
                let apart = state.positions[index].get(lane).distance(home) / length;
                sum += f64::from(apart);
                max = max.max(apart);
            }
        }
        Drift { mean: (sum / (self.strand_count * points) as f64) as f32, max }
    }

    /// A state with the sections that this model needs.
    pub(crate) fn with_sections<'a>(&self, state: &'a State) -> Cow<'a, State> {
        let mut state = Cow::Borrowed(state);
        if state.sections.len() != self.section_count() {
            self.give_sections(state.to_mut());
        }
        state
    }

    /// Gives a state that was without rods the sections that they have at rest, and takes those of one that has no
    /// rods any more.
    pub(crate) fn give_sections(&self, state: &mut State) {
        let count = self.section_count();
        if state.sections.len() != count {
            state.sections = self.sections(&state.body);
            state.spins = vec![Lanes::default(); count];
            // Corrections of the other method have another size.
            state.corrections.fill(Vec3Lanes::default());
        }
    }

    fn section_count(&self) -> usize {
        self.rods.as_ref().map_or(0, |rods| rods.sections.len())
    }

    fn sections(&self, body: &BodyFrame) -> Vec<Vec3Lanes> {
        self.rods.as_ref().map_or(Vec::new(), |rods| self.carried(&rods.sections, body, turn))
    }
}

/// The rotation of a pose alone.
fn turn(pose: Pose) -> Pose {
    Pose { translation: Vec3::ZERO, ..pose }
}

#[cfg(test)]
mod tests {
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{CpuRunner, Drive, Settings};

    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        Guides::resample(&groom, 6).unwrap()
    }

    #[test]
    fn lanes_beyond_the_last_strand_move_with_it() {
        let model = Model::new(&guides(), &Settings::default(), Vec::new()).unwrap();
        let mut state = model.rest_state(Pose::IDENTITY);
        CpuRunner::from(model.clone()).step(&mut state, &Drive { wind: Vec3::X, ..Drive::default() });
        for lanes in &state.positions {
            assert_eq!(lanes.get(0), lanes.get(7));
        }
    }
}
