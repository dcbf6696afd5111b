//! Hair carried over a jump of the body.

use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, Carrier, Pose};
use strandline_groom::{LANES, Vec3Lanes};

use crate::contact::planes::Contacts;
use crate::{Model, State};

impl State {
    /// Moves the body to another place at once and carries the hair with it: each strand moves as its root frame does,
    /// points rigidly, velocities by the rotation. Nothing pulls at hair then, as it would where the body moved there
    /// through a step. No time passes.
    pub fn carry(&mut self, model: &Model, body: impl Into<BodyFrame>) {
        let body = body.into();
        let points = model.points_per_strand;
        let blocks = self.length_scale.len();
        let motions: Vec<[Pose; LANES]> = (0..blocks)
            .map(|block| {
                let (from, to) = (model.roots(&self.body, block), model.roots(&body, block));
                std::array::from_fn(|lane| from[lane].motion_to(&to[lane]))
            })
            .collect();
        let all = |vectors: &mut Vec<Vec3Lanes>, is_place: bool| {
            vectors.par_chunks_mut(points).zip(&motions).for_each(|(vectors, motions)| {
                for vector in vectors {
                    for (lane, motion) in motions.iter().enumerate() {
                        let own = vector.get(lane);
                        vector.set(lane, if is_place { motion.point(own) } else { motion.direction(own) });
                    }
                }
            });
        };
        all(&mut self.positions, true);
        all(&mut self.previous_positions, true);
        for turned in
            [&mut self.velocities, &mut self.corrections, &mut self.sections, &mut self.loads.forces]
        {
            all(turned, false);
        }
        // Planes of solids on the head stay right only where all rides the head.
        if !(self.body.is_rigid() && body.is_rigid()) || model.is_beside_world() {
            self.contacts = Contacts::new(&model.colliders, blocks, points);
        }
        self.volume_box = None;
        // Pairs of strands know their sides in the world.
        self.pairs.clear();
        self.body = body;
    }
}

impl Model {
    /// True with a solid that the body does not carry.
    fn is_beside_world(&self) -> bool {
        self.colliders.iter().any(|collider| !matches!(collider.carrier, Carrier::Piece(_)))
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{CpuRunner, Drive, Settings};

    #[test]
    fn hair_goes_on_after_a_jump_as_without_it() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::new(0.2, -0.1, 0.0)]);
        groom.push([Vec3::Z * 0.01, Vec3::new(0.1, -0.2, 0.1)]);
        let guides = Guides::resample(&groom, 8).unwrap();
        let settings = Settings { gravity: Vec3::ZERO, ..Settings::default() };
        let model = Model::new(&guides, &settings, Vec::new()).unwrap();
        let there = Pose { rotation: Quat::from_rotation_y(3.0), translation: Vec3::new(2.0, 1.0, -1.0) };
        let mut state = model.rest_state(Pose::IDENTITY);
        let mut runner = CpuRunner::from(model.clone());
        let aside = Pose { translation: Vec3::X * 0.02, ..Pose::IDENTITY };
        (0..5).for_each(|_| drop(runner.step(&mut state, &Drive::of(aside))));
        let mut stayed = state.clone();
        let moved = aside.carried_by(&there);
        state.carry(&model, moved);
        assert_eq!(state.body, moved.into());
        for _ in 0..5 {
            let report = runner.step(&mut state, &Drive::of(moved));
            runner.step(&mut stayed, &Drive::of(aside));
            assert!(report.speed_max < 5.0, "{}", report.speed_max);
        }
        for (found, stayed) in state.positions.iter().zip(&stayed.positions) {
            for lane in 0..2 {
                let apart = found.get(lane).distance(there.point(stayed.get(lane)));
                // The cells of the volume do not turn with the hair.
                assert!(apart < 1e-3, "{apart} m after a jump of 2.4 m");
            }
        }
    }
}
