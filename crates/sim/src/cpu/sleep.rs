//! Sleep: a step that changed nothing is not computed again while its inputs stay the same.

use std::sync::Arc;

use bytemuck::{Pod, cast_slice};
use strandline_base::par::prelude::*;

use crate::{Drive, State, StepReport};

/// Elements that a thread compares at a time.
const CHUNK: usize = 4096;

/// Speed \[m/s\] above which hair moves: a speed of 0 is measured as 6e-14.
const STILL: f32 = 1e-9;
/// Most steps without a comparison after one that found a change.
const LONGEST_WAIT: u32 = 64;

/// The last states in which no point moved, and the step that leaves its state as it is.
///
/// A step is a function of the model, the state and the drive. One that leaves its state as it was, but for the time,
/// does so again: then its report alone is returned. A change of the model ends the sleep.
#[derive(Default)]
pub(super) struct Sleep {
    /// The state after the last step that was compared.
    kept: Option<Box<State>>,
    /// The step that changes nothing in it.
    step: Option<(Drive, StepReport)>,
    /// Steps until the next comparison, and those to wait after it.
    wait: u32,
    next_wait: u32,
}

impl Sleep {
    /// The report of a step that changes nothing but the time.
    pub fn report(&self, state: &State, drive: &Drive) -> Option<&StepReport> {
        let (known, report) = self.step.as_ref()?;
        let same = known == drive
            && !drive.body.has_jumped()
            && self.kept.as_ref().is_some_and(|kept| is_same(kept, state));
        same.then_some(report)
    }

    /// Takes note of a step with a drive.
    pub fn note(&mut self, state: &State, drive: &Drive, report: &StepReport) {
        self.step = None;
        if report.speed_max > STILL {
            *self = Self::default();
            return;
        }
        if self.wait > 0 {
            self.wait -= 1;
            // The state before the next comparison.
            if self.wait == 0 {
                self.keep(state);
            }
            return;
        }
        if self.kept.as_ref().is_some_and(|kept| is_same(kept, state)) {
            self.step = Some((drive.clone(), report.clone()));
            self.next_wait = 0;
            return;
        }
        self.wait = self.next_wait;
        self.next_wait = (2 * self.next_wait + 1).min(LONGEST_WAIT);
        if self.wait == 0 {
            self.keep(state);
        }
    }

    fn keep(&mut self, state: &State) {
        match &mut self.kept {
            Some(kept) => kept.as_mut().clone_from(state),
            None => self.kept = Some(Box::new(state.clone())),
        }
    }
}

/// True for two states whose next steps are the same to the bit. Held hair follows its hand, and never sleeps.
fn is_same(one: &State, other: &State) -> bool {
    let held = [one, other].iter().any(|state| !state.grab.grips.is_empty());
    !held && Arc::ptr_eq(&one.lengths, &other.lengths) && have_same_bits(one, other)
}

fn have_same_bits(one: &State, other: &State) -> bool {
    one.body == other.body
        && one.volume_box == other.volume_box
        && are_same(&one.tensions, &other.tensions)
        && are_same(&one.loads.forces, &other.loads.forces)
        && are_same(&one.pairs, &other.pairs)
        && are_same(&one.length_scale, &other.length_scale)
        && are_same(&one.positions, &other.positions)
        && are_same(&one.previous_positions, &other.previous_positions)
        && are_same(&one.velocities, &other.velocities)
        && are_same(&one.corrections, &other.corrections)
        && are_same(&one.sections, &other.sections)
        && are_same(&one.spins, &other.spins)
        && one.contacts.is_same(&other.contacts)
}

/// Compares the bits of two lists.
fn are_same<L: Pod + Sync>(one: &[L], other: &[L]) -> bool {
    let chunks = one.par_chunks(CHUNK).zip(other.par_chunks(CHUNK));
    one.len() == other.len()
        && chunks.all(|(one, other)| cast_slice::<L, u8>(one) == cast_slice::<L, u8>(other))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use strandline_body::Pose;
    use strandline_groom::{Groom, Guides};

    use crate::{CpuRunner, Drive, Model, Settings, State};

    fn hair() -> Model {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..20 {
            let root = Vec3::new(0.01 * strand as f32, 0.0, 0.0);
            groom.push([root, root + Vec3::new(0.02, 0.01, 0.0), root + Vec3::new(0.03, -0.2, 0.01)]);
        }
        Model::new(&Guides::resample(&groom, 12).unwrap(), &Settings::default(), Vec::new()).unwrap()
    }

    /// Steps with a runner that remembers, held to those of runners that each make one step and remember nothing.
    struct Pair {
        sleeper: CpuRunner,
        states: [State; 2],
        slept: usize,
    }

    impl Pair {
        fn step(&mut self, drive: &Drive) {
            let [state, awake] = &mut self.states;
            let slept = self.sleeper.sleep.report(state, drive).is_some();
            self.slept += usize::from(slept);
            let mut report = self.sleeper.step(state, drive);
            let mut wanted = CpuRunner::from(self.sleeper.model().clone()).step(awake, drive);
            (report.seconds, wanted.seconds) = Default::default();
            assert_eq!(format!("{report:?}"), format!("{wanted:?}"), "after {} that slept", self.slept);
            assert!(super::have_same_bits(state, awake), "after {} that slept", self.slept);
        }

        /// Steps until `count` of them slept.
        fn rest(&mut self, drive: &Drive, count: usize) {
            self.slept = 0;
            for _ in 0..2000 {
                self.step(drive);
                if self.slept == count {
                    return;
                }
            }
            panic!("{} of 2000 steps slept", self.slept);
        }
    }

    #[test]
    fn hair_that_rests_sleeps_and_all_that_changes_wakes_it_at_once() {
        let model = hair();
        let state = model.rest_state(Pose::IDENTITY);
        let mut pair = Pair { sleeper: model.into(), states: [state.clone(), state], slept: 0 };
        let still = Drive::default();
        pair.rest(&still, 3);
        let turned = Pose { rotation: Quat::from_rotation_z(0.3), translation: Vec3::Y };
        let windy = Drive { wind: Vec3::X, ..still.clone() };
        let [moved, calm] = [Drive::of(turned), Drive::of(turned)];
        for drive in [windy, still.clone(), moved] {
            pair.slept = 0;
            pair.step(&drive);
            assert_eq!(pair.slept, 0, "{drive:?}");
            assert!(pair.states[0].velocities != vec![Default::default(); pair.states[0].velocities.len()]);
        }
        pair.rest(&calm, 2);
        // A caller changes the state.
        for state in &mut pair.states {
            state.set_length_scale(pair.sleeper.model(), &[0.7; 20]).unwrap();
        }
        pair.rest(&calm, 2);
        for state in &mut pair.states {
            state.velocities[5].x[3] = 0.4;
        }
        pair.slept = 0;
        pair.step(&calm);
        assert_eq!(pair.slept, 0);
        pair.rest(&calm, 1);
        let settings = Settings { gravity: Vec3::X, ..Settings::default() };
        pair.sleeper.set_settings(&settings).unwrap();
        pair.slept = 0;
        pair.step(&calm);
        assert_eq!(pair.slept, 0, "gravity");
    }
}
