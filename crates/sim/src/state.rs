use glam::Vec3;
use rayon::prelude::*;
use strandline_body::Pose;
use strandline_groom::{LANES, Lanes, RestShape, Vec3Lanes};

use crate::cpu::contacts::Contacts;
use crate::cpu::vec3x8::{Vec3x8, splat};
use crate::{SimError, Solver};

/// What the world does to the hair during one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Pose of the head at the end of the step.
    pub world_from_head: Pose,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
}

impl Drive {
    /// This drive, where it is finite; else a head that stays and air that rests.
    pub(crate) fn or_still(&self, state: &State) -> Self {
        let pose = &self.world_from_head;
        let posed = pose.rotation.is_finite() && pose.translation.is_finite();
        Self {
            world_from_head: if posed { *pose } else { state.world_from_head },
            wind: if self.wind.is_finite() { self.wind } else { Vec3::ZERO },
        }
    }
}

/// All that changes with time.
#[derive(Clone, Debug)]
pub struct State {
    /// Positions \[m\], world space, shape `[block][point]` of lanes.
    pub positions: Vec<Vec3Lanes>,
    /// Velocities \[m/s\], world space, shape `[block][point]` of lanes.
    pub velocities: Vec<Vec3Lanes>,
    /// Positions \[m\] one step ago, world space, shape `[block][point]` of lanes.
    pub previous_positions: Vec<Vec3Lanes>,
    /// Pose of the head now.
    pub world_from_head: Pose,
    /// Time \[s\].
    pub time: f64,
    /// Length over rest length of each strand, shape `[block]` of lanes.
    pub(crate) length_scale: Vec<Lanes>,
    pub(crate) scratch: Scratch,
}

/// What a step works in; all of it follows from the rest.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    /// Positions at the end of the step \[m\], world space, shape `[block][point]` of lanes.
    pub predicted: Vec<Vec3Lanes>,
    /// Contact planes remembered from step to step.
    pub contacts: Contacts,
    /// The rest shape with the length scales applied.
    pub lengths: RestShape,
}

impl State {
    /// Positions \[m\] between the last two steps, world space, shape `[block][point]` of lanes:
    /// `share` is 0 one step ago and 1 now. `positions` is made as long as needed.
    pub fn interpolated(&self, share: f32, positions: &mut Vec<Vec3Lanes>) {
        positions.resize(self.positions.len(), Vec3Lanes::default());
        let pairs = self.previous_positions.par_iter().zip(&self.positions);
        positions.par_iter_mut().zip(pairs).for_each(|(between, (before, now))| {
            let before = Vec3x8::load(before);
            (before + (Vec3x8::load(now) - before) * splat(share)).store(between);
        });
    }

    /// Length over rest length of a strand.
    pub fn length_scale(&self, strand: usize) -> f32 {
        self.length_scale[strand / LANES].0[strand % LANES]
    }

    /// Sets the length of every strand, shape `[strand]`: 0.05 to 1 of its rest length
    /// [Chen2011 fig. 45]. Segments near the tip shrink, to no less than a twentieth; the others
    /// keep their length. Points slide along their strand at once and keep their velocity.
    ///
    /// # Errors
    /// Another number of scales than strands, a scale outside 0.05..=1; then nothing changes.
    pub fn set_length_scale(&mut self, solver: &Solver, scales: &[f32]) -> Result<(), SimError> {
        let refuse = |found, expected| Err(SimError::Setting { name: "length_scale", found, expected });
        if scales.len() != solver.strand_count {
            return refuse(format!("given for {} strands", scales.len()), "one for each strand");
        }
        if let Some(scale) = scales.iter().find(|scale| !(0.05..=1.0).contains(*scale)) {
            return refuse(scale.to_string(), "0.05 to 1");
        }
        for (block, lanes) in self.length_scale.iter_mut().enumerate() {
            for (lane, slot) in lanes.0.iter_mut().enumerate() {
                *slot = scales[(block * LANES + lane).min(scales.len() - 1)];
            }
        }
        let points = solver.points_per_strand;
        for (block, scale) in self.length_scale.iter().enumerate() {
            let range = block * points..(block + 1) * points;
            shorten(solver, &mut self.scratch.lengths, range.clone(), scale);
            let lengths = &self.scratch.lengths.stretch[range.clone()];
            slide(&mut self.positions[range.clone()], lengths);
            slide(&mut self.previous_positions[range], lengths);
        }
        Ok(())
    }
}

/// Smallest length of a segment over its rest length: a segment of no length has no direction.
const SHORTEST: f32 = 0.05;

/// Takes what is cut off a strand from its segments, the last first.
fn shorten(solver: &Solver, lengths: &mut RestShape, range: std::ops::Range<usize>, scale: &Lanes) {
    let rest = &solver.rest;
    let points = range.len();
    let first = range.start;
    for lane in 0..LANES {
        let total: f32 = range.clone().map(|index| rest.stretch[index].0[lane]).sum();
        let mut cut = (1.0 - scale.0[lane]) * total;
        for index in range.clone().skip(1).rev() {
            let most = (1.0 - SHORTEST) * rest.stretch[index].0[lane];
            let taken = cut.clamp(0.0, most);
            lengths.stretch[index].0[lane] = rest.stretch[index].0[lane] - taken;
            cut -= taken;
        }
        let share = |lengths: &[Lanes], span: usize, point: usize| {
            let sum = |lanes: &[Lanes]| (0..span).map(|k| lanes[first + point + k].0[lane]).sum::<f32>();
            sum(lengths) / sum(&rest.stretch)
        };
        for point in 0..points - 2 {
            lengths.bend[first + point].0[lane] =
                rest.bend[first + point].0[lane] * share(&lengths.stretch, 2, point);
        }
        for point in 0..points - 3 {
            lengths.torsion[first + point].0[lane] =
                rest.torsion[first + point].0[lane] * share(&lengths.stretch, 3, point);
        }
    }
}

/// Moves the points of a block to the given lengths along the directions that its segments have.
fn slide(positions: &mut [Vec3Lanes], lengths: &[Lanes]) {
    for lane in 0..LANES {
        let mut before = positions[0].get(lane);
        let mut moved = before;
        for point in 1..positions.len() {
            let here = positions[point].get(lane);
            let along = here - before;
            let length = if point == 1 { along.length() } else { lengths[point - 1].0[lane] };
            moved += along.normalize_or(Vec3::NEG_Y) * length;
            before = here;
            positions[point].set(lane, moved);
        }
    }
}
