use std::borrow::Cow;

use glam::Vec3;
use rayon::prelude::*;
use strandline_base::memory;
use strandline_body::{Collider, Pose};
use strandline_groom::{Guides, LANES, Lanes, RestShape, Vec3Lanes};

use crate::at_rest::{by_lane, carried, check_rest, clearance, directions, velocities};
use crate::cpu::contacts::Contacts;
use crate::grab::Grab;
use crate::masses::Masses;
use crate::state::Scratch;
use crate::strands::rods::hairs::Hairs;
use crate::strands::rods::model::Rods;
use crate::{Drift, Drive, Settings, SimError, State, StepReport, StrandMethod};

/// The compiled solver: rest shape, settings and colliders. It does not change while time passes.
#[derive(Clone)]
pub struct Solver {
    pub(crate) settings: Settings,
    pub(crate) rest: RestShape,
    pub(crate) colliders: Vec<Collider>,
    pub(crate) strand_count: usize,
    pub(crate) points_per_strand: usize,
    /// Rest positions \[m\], head space, shape `[block][point]` of lanes.
    pub(crate) positions: Vec<Vec3Lanes>,
    /// Rest direction from point i to i + 1, head space, shape `[block][point]` of lanes.
    pub(crate) directions: Vec<Vec3Lanes>,
    /// 1 over the mass \[1/kg\], 0 for a rooted point, shape `[block][point]` of lanes. Lanes
    /// beyond the last strand hold what the last strand has.
    pub(crate) inverse_mass: Vec<Lanes>,
    /// Distance \[m\] from the colliders that the head carries at rest, 0 inside them, shape as above.
    pub(crate) rest_clearance: Vec<Lanes>,
    /// Masses as they were compiled, from which every change of the mass per length starts, so that one
    /// there and back leaves every bit as it was.
    compiled: Compiled,
    /// Whether the guides have masses of their own, which no setting changes.
    weighed: bool,
    /// What each strand is made of.
    hairs: Hairs,
    /// Velocities at the beginning \[m/s\], head space, shape `[block][point]` of lanes; empty at rest.
    velocities: Vec<Vec3Lanes>,
    /// None with another strand solver.
    pub(crate) rods: Option<Rods>,
}

/// Masses at the mass per length that a solver was compiled with.
#[derive(Clone)]
struct Compiled {
    /// \[kg/m\].
    mass_per_length: f32,
    /// \[kg\], shape `[block][point]` of lanes.
    mass: Vec<Lanes>,
    /// \[1/kg\], shape as above.
    inverse_mass: Vec<Lanes>,
}

impl Solver {
    /// Points of a strand that the head carries, so that hair leaves the skin in its own direction.
    pub const ROOTED_POINTS: usize = 2;

    /// Compiles a solver for hair: the first two points of every strand are rooted in the head.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn new(guides: &Guides, settings: &Settings, colliders: Vec<Collider>) -> Result<Self, SimError> {
        let rest = RestShape::new(guides, settings.line_density());
        Self::with_rest(guides, rest, |_, point| point < Self::ROOTED_POINTS, settings, colliders)
    }

    /// Compiles a solver for strands of any mass that are held at any points: ropes, chains.
    ///
    /// `rooted(strand, point)` tells which points the head carries. Rest lengths of 0 are allowed
    /// nowhere but at the ends, where [`RestShape`] has them.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken; a rest shape of another shape than the guides, or with a
    /// length or a mass of a strand that is not above 0.
    pub fn with_rest(
        guides: &Guides,
        rest: RestShape,
        rooted: impl Fn(usize, usize) -> bool + Sync,
        settings: &Settings,
        colliders: Vec<Collider>,
    ) -> Result<Self, SimError> {
        settings.check()?;
        memory::check(&settings.memory(guides.strand_count(), guides.points_per_strand()))?;
        check_rest(guides, &rest)?;
        let hairs = Hairs::new(guides, settings)?;
        let points = guides.points_per_strand();
        let last = guides.strand_count() - 1;
        let inverse_mass = by_lane(rest.mass.len(), points, |index, block, point, lane| {
            let strand = (block * LANES + lane).min(last);
            let held = rooted(strand, point);
            let source = if strand == last { last % LANES } else { lane };
            if held { 0.0 } else { 1.0 / rest.mass[index].0[source] }
        });
        let directions = directions(guides, &rest);
        let rest_clearance = by_lane(rest.mass.len(), points, |index, _, _, lane| {
            clearance(&colliders, guides.positions()[index].get(lane))
        });
        let compiled = Compiled {
            mass_per_length: settings.line_density(),
            mass: rest.mass.clone(),
            inverse_mass: inverse_mass.clone(),
        };
        let mut solver = Self {
            settings: settings.clone(),
            rest,
            colliders,
            strand_count: guides.strand_count(),
            points_per_strand: points,
            positions: guides.positions().to_vec(),
            directions,
            inverse_mass,
            rest_clearance,
            compiled,
            weighed: guides.masses().is_some(),
            velocities: velocities(guides, &rooted),
            hairs,
            rods: None,
        };
        solver.weigh();
        Ok(solver.with_rods())
    }

    /// Sets the masses of points from those that were compiled and the settings, unless the guides have their own.
    fn weigh(&mut self) {
        if self.weighed {
            return;
        }
        let density = self.settings.line_density() / self.compiled.mass_per_length;
        let (points, last, rods) = (self.points_per_strand, self.strand_count - 1, self.settings.has_rods());
        let (hairs, stretch) = (&self.hairs, &self.rest.stretch);
        let factors = by_lane(stretch.len(), points, |index, block, point, lane| {
            let strand = (block * LANES + lane).min(last);
            let lane = if strand == last { last % LANES } else { lane };
            let lengths = |point: usize| stretch[index - index % points + point].0[lane];
            density * if rods { hairs.weight(strand, point, points, lengths) } else { 1.0 }
        });
        let scaled = |from: &[Lanes], scale: &dyn Fn(f32, f32) -> f32| -> Vec<Lanes> {
            let lanes = |(from, factor): (&Lanes, &Lanes)| {
                Lanes(std::array::from_fn(|lane| scale(from.0[lane], factor.0[lane])))
            };
            from.iter().zip(&factors).map(lanes).collect()
        };
        let mass = scaled(&self.compiled.mass, &|mass, factor| mass * factor);
        self.inverse_mass = scaled(&self.compiled.inverse_mass, &|inverse, factor| inverse / factor);
        self.rest.mass = mass;
    }

    /// Tells masses apart: two solvers of the same key have the same.
    pub(crate) fn mass_key(&self) -> u64 {
        self.hairs.key(&self.settings)
    }

    /// Compiles the rods, where the settings ask for them.
    fn with_rods(mut self) -> Self {
        let settings = &self.settings.strands;
        self.rods = match settings.method {
            StrandMethod::Constrain => None,
            StrandMethod::Rods => Some(Rods::new(&self, &self.hairs, settings.rods.rest)),
        };
        self
    }

    /// The compiled rods; none with another strand solver.
    pub fn rods(&self) -> Option<&Rods> {
        self.rods.as_ref()
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes the settings between two steps; states go on as they are. Guides with masses of their own keep
    /// them.
    ///
    /// # Errors
    /// A setting outside its range or more memory than may be taken; then nothing changes.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        settings.check()?;
        memory::check(&settings.memory(self.strand_count, self.points_per_strand))?;
        let hairs = self.hairs.changed(settings)?;
        let same = self.settings.strands == settings.strands
            && self.settings.groups == settings.groups
            && self.settings.gravity == settings.gravity;
        let weighs = settings.line_density() == self.settings.line_density();
        self.settings = settings.clone();
        self.hairs = hairs;
        if !(same && weighs) {
            self.weigh();
        }
        if !same {
            *self = self.clone().with_rods();
        }
        Ok(())
    }

    /// The solids.
    pub fn colliders(&self) -> &[Collider] {
        &self.colliders
    }

    /// The rest shape.
    pub fn rest(&self) -> &RestShape {
        &self.rest
    }

    /// 1 over the mass \[1/kg\] of each point, 0 where the head carries it, shape `[block][point]` of
    /// lanes.
    pub fn inverse_mass(&self) -> &[Lanes] {
        &self.inverse_mass
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.strand_count
    }

    /// Strands and the lanes that fill up the last block.
    pub(crate) fn lane_count(&self) -> usize {
        self.positions.len() / self.points_per_strand * LANES
    }

    /// Points on each strand.
    pub fn points_per_strand(&self) -> usize {
        self.points_per_strand
    }

    /// The guides at rest, carried by a pose of the head; those with velocities of their own begin with them.
    pub fn rest_state(&self, world_from_head: Pose) -> State {
        let positions: Vec<Vec3Lanes> =
            self.positions.par_iter().map(|lanes| carried(lanes, &world_from_head)).collect();
        let blocks = positions.len() / self.points_per_strand;
        let turn = Pose { translation: Vec3::ZERO, ..world_from_head };
        let rods = self.rods.as_ref().map_or(0, |rods| rods.sections.len());
        State {
            sections: self.sections(&turn),
            spins: vec![Lanes::default(); rods],
            corrections: vec![Vec3Lanes::default(); positions.len()],
            velocities: if self.velocities.is_empty() {
                vec![Vec3Lanes::default(); positions.len()]
            } else {
                self.velocities.par_iter().map(|lanes| carried(lanes, &turn)).collect()
            },
            previous_positions: positions.clone(),
            world_from_head,
            time: 0.0,
            length_scale: vec![Lanes([1.0; LANES]); blocks],
            grab: Grab::default(),
            scratch: Scratch {
                predicted: positions.clone(),
                contacts: Contacts::new(&self.colliders, blocks, self.points_per_strand),
                masses: Masses::new(self, &self.rest),
                lengths: self.rest.clone(),
                rods: None,
                volume: None,
                place: None,
            },
            positions,
        }
    }

    /// How far a state lies from the hair at rest that the head of the state carries.
    pub fn drift(&self, state: &State) -> Drift {
        let points = self.points_per_strand;
        let (mut sum, mut max) = (0.0, 0.0_f32);
        for strand in 0..self.strand_count {
            let (first, lane) = (strand / LANES * points, strand % LANES);
            let length: f32 = (first..first + points).map(|index| self.rest.stretch[index].0[lane]).sum();
            for index in first..first + points {
                let home = state.world_from_head.point(self.positions[index].get(lane));
                let apart = state.positions[index].get(lane).distance(home) / length;
                sum += f64::from(apart);
                max = max.max(apart);
            }
        }
        Drift { mean: (sum / (self.strand_count * points) as f64) as f32, max }
    }

    /// Gives a state that was without rods the sections that they have at rest, and takes those of one that has no
    /// rods any more.
    pub(crate) fn give_sections(&self, state: &mut State) {
        let count = self.rods.as_ref().map_or(0, |rods| rods.sections.len());
        if state.sections.len() != count {
            let turn = Pose { translation: Vec3::ZERO, ..state.world_from_head };
            state.sections = self.sections(&turn);
            state.spins = vec![Lanes::default(); count];
        }
    }

    /// A state with the sections that this solver needs.
    pub(crate) fn with_sections<'a>(&self, state: &'a State) -> Cow<'a, State> {
        let mut state = Cow::Borrowed(state);
        if state.sections.len() != self.rods.as_ref().map_or(0, |rods| rods.sections.len()) {
            self.give_sections(state.to_mut());
        }
        state
    }

    fn sections(&self, turn: &Pose) -> Vec<Vec3Lanes> {
        let rods = self.rods.iter();
        rods.flat_map(|rods| rods.sections.iter().map(|lanes| carried(lanes, turn))).collect()
    }

    /// Advances a state by one step of `settings.time_step`.
    pub fn step(&self, state: &mut State, drive: &Drive) -> StepReport {
        crate::step::step(self, state, drive)
    }
}

#[cfg(test)]
mod tests {
    use strandline_groom::Groom;

    use super::*;

    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        Guides::resample(&groom, 6).unwrap()
    }

    #[test]
    fn a_rest_shape_that_does_not_fit_is_refused() {
        let with = |change: fn(&mut RestShape)| {
            let mut rest = RestShape::new(&guides(), 1e-5);
            change(&mut rest);
            Solver::with_rest(&guides(), rest, |_, point| point == 0, &Settings::default(), Vec::new())
                .err()
                .map(|error| error.to_string())
        };
        assert_eq!(with(|_| ()), None);
        assert!(with(|rest| rest.mass[2].0[0] = 0.0).unwrap().contains("mass 0 kg in strand 0"));
        assert!(with(|rest| rest.stretch[2].0[0] = f32::NAN).unwrap().contains("length NaN m"));
        assert!(with(|rest| rest.bend.truncate(3)).unwrap().contains("3 blocks of bend"));
    }

    #[test]
    fn settings_change_between_steps_or_not_at_all() {
        let mut solver = Solver::new(&guides(), &Settings::constrained(), Vec::new()).unwrap();
        let light = solver.inverse_mass[3].0[0];
        let settings = Settings { mass_per_length: 1.3e-5, iterations: 7, ..Settings::constrained() };
        solver.set_settings(&settings).unwrap();
        assert!((solver.inverse_mass[3].0[0] / light - 0.5).abs() < 1e-6);
        assert!(solver.set_settings(&Settings { iterations: 0, ..settings.clone() }).is_err());
        assert_eq!(solver.settings(), &settings);
    }

    #[test]
    fn a_mass_that_is_moved_there_and_back_leaves_every_bit() {
        let compiled = Solver::new(&guides(), &Settings::constrained(), Vec::new()).unwrap();
        let mut solver = compiled.clone();
        for step in 1..40 {
            let mass_per_length = 6.5e-6 * (1.0 + 0.037 * step as f32);
            solver.set_settings(&Settings { mass_per_length, ..Settings::constrained() }).unwrap();
            assert_ne!(solver.rest.mass, compiled.rest.mass);
        }
        solver.set_settings(&Settings::constrained()).unwrap();
        assert_eq!(solver.rest.mass, compiled.rest.mass);
        assert_eq!(solver.inverse_mass, compiled.inverse_mass);
    }

    #[test]
    fn lanes_beyond_the_last_strand_move_with_it() {
        let solver = Solver::new(&guides(), &Settings::default(), Vec::new()).unwrap();
        let mut state = solver.rest_state(Pose::IDENTITY);
        solver.step(&mut state, &Drive { wind: Vec3::X, ..Drive::default() });
        for lanes in &state.positions {
            assert_eq!(lanes.get(0), lanes.get(7));
        }
    }
}
