//! Runs steps on the CPU.

use glam::Vec3;
use strandline_base::{Stopwatch, par};
use strandline_groom::Lanes;

use super::Scratch;
use super::advance::{NonFinite, advance};
use super::constrain::constrain;
use super::gather::gather;
use super::integrate::integrate;
use super::mark::mark;
use super::pose_roots::pose_roots;
use super::shelter::shelter;
use super::sleep::Sleep;
use super::solve_pressure::solve_pressure;
use super::solve_rods::solve_rods;
use super::splat::splat;
use crate::contact::{Obstacles, Skins, contacts::Solids};
use crate::step::{Stage, stages};
use crate::{Drive, Model, Settings, SimError, State, StepReport};

/// A model with the scratch memory of its steps on the CPU.
pub struct CpuRunner {
    model: Model,
    scratch: Option<Scratch>,
    /// Skins of the last step.
    skins: Skins,
    pub(super) sleep: Sleep,
}

impl From<Model> for CpuRunner {
    fn from(model: Model) -> Self {
        Self { model, scratch: None, skins: Skins::new(), sleep: Sleep::default() }
    }
}

impl CpuRunner {
    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Changes the settings between two steps; states stay as they are.
    ///
    /// # Errors
    /// As [`Model::set_settings`].
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        self.sleep = Sleep::default();
        self.model.set_settings(settings)
    }

    /// Advances a state by one step of `settings.time_step`. The state may differ from that of the call before.
    pub fn step(&mut self, state: &mut State, drive: &Drive) -> StepReport {
        let drive = drive.or_still_at(&state.body, self.model.strand_count);
        state.grab.hand = drive.hand.unwrap_or(state.grab.hand);
        let report = par::awake(|| self.asleep(state, &drive));
        if let Some(report) = report {
            return report;
        }
        let report = self.make_step(state, &drive);
        self.sleep.note(state, &drive, &report);
        report
    }

    /// The report of a step that changes nothing but the time, without a look at the hair.
    fn asleep(&self, state: &mut State, drive: &Drive) -> Option<StepReport> {
        let watch = Stopwatch::start();
        let mut report = self.sleep.report(state, drive)?.clone();
        state.time += f64::from(self.model.settings.time_step);
        report.seconds.iter_mut().for_each(|(_, seconds)| *seconds = 0.0);
        report.seconds.last_mut().into_iter().for_each(|(_, seconds)| *seconds = watch.seconds());
        Some(report)
    }

    fn make_step(&mut self, state: &mut State, drive: &Drive) -> StepReport {
        let model = &self.model;
        let scratch = self.scratch.get_or_insert_with(|| Scratch::new(model, state));
        scratch.refresh(model, state);
        model.give_sections(state);
        if !model.settings.has_contact() && !state.pairs.is_empty() {
            state.pairs.clear();
            state.tensions.fill(Lanes::default());
        }
        let (start, end) = (state.body.clone(), drive.body.clone());
        let time_step = model.settings.time_step;
        let (wind, report) = (drive.wind, StepReport::default());
        let skins = &mut self.skins;
        let report = par::awake(|| {
            let obstacles = Obstacles::after(skins, &model.colliders, start, end, time_step);
            skins.clone_from(obstacles.skins());
            let solids = Solids::new(&obstacles, model.points_per_strand);
            state.contacts.ride(&solids, model.settings.collision_margin);
            let mut step = Step { model, state, scratch, obstacles, drive, wind, report };
            for stage in stages(&model.settings) {
                let watch = Stopwatch::start();
                step.run(stage);
                step.report.seconds.push((stage.name(), watch.seconds()));
            }
            step.report
        });
        state.volume_box = scratch.volume.as_ref().map(|volume| volume.grid.place_numbers());
        report
    }
}

/// A step while it runs.
struct Step<'a> {
    model: &'a Model,
    state: &'a mut State,
    scratch: &'a mut Scratch,
    obstacles: Obstacles<'a>,
    drive: &'a Drive,
    /// \[m/s\]
    wind: Vec3,
    report: StepReport,
}

impl Step<'_> {
    fn run(&mut self, stage: Stage) {
        let (model, obstacles, drive, wind) = (self.model, &self.obstacles, self.drive, self.wind);
        let (state, scratch) = (&mut *self.state, &mut *self.scratch);
        match stage {
            Stage::PoseRoots => pose_roots(model, state, scratch, &obstacles.end),
            Stage::Shelter => {
                let found = scratch.shelter.iter_mut();
                found.for_each(|found| shelter(model, state, obstacles, drive, found));
            }
            Stage::Integrate => integrate(model, state, scratch, wind),
            Stage::Constrain => {
                let non_finite = constrain(model, state, scratch, obstacles);
                self.count(non_finite);
            }
            Stage::SolveRods => {
                let (non_finite, rods) = solve_rods(model, state, scratch, obstacles, wind);
                self.report.rods = Some(rods);
                self.report.contacts = model.settings.has_contact().then_some(scratch.crowd.report);
                self.count(non_finite);
            }
            Stage::Splat => {
                scratch.volume.iter_mut().for_each(|volume| {
                    splat(volume, &scratch.predicted, &state.velocities, &scratch.masses.mass);
                });
            }
            Stage::Mark => {
                let planes = Some((&scratch.predicted[..], &state.contacts));
                let packing = model.rest_density().map(|density| (density, model.settings.time_step));
                scratch.volume.iter_mut().for_each(|volume| mark(volume, obstacles, planes, packing));
            }
            Stage::SolvePressure => {
                self.report.pressure = scratch.volume.as_mut().map(solve_pressure).unwrap_or_default();
            }
            Stage::Gather => scratch.volume.iter().for_each(|volume| {
                let (time_step, weights) = (model.settings.time_step, &model.inverse_mass);
                gather(volume, time_step, weights, &scratch.predicted, &mut state.velocities);
            }),
            Stage::Advance => self.advance(),
        }
    }

    fn advance(&mut self) {
        let outcome = advance(self.model, self.state, self.scratch, &self.obstacles);
        let points = self.model.strand_count * self.model.points_per_strand;
        let report = &mut self.report;
        report.stretch_mean = outcome.stretch_mean();
        report.stretch_max = outcome.stretch_max;
        report.penetration_max = outcome.penetration_max;
        report.speed_mean = (outcome.speed_sum / points as f64) as f32;
        report.speed_max = outcome.speed_max;
        self.count(outcome.non_finite);
    }

    /// Counts points that were not finite.
    fn count(&mut self, found: NonFinite) {
        let report = &mut self.report;
        let before = NonFinite { count: report.non_finite, first_strand: report.non_finite_strand };
        let NonFinite { count, first_strand } = before.with(found);
        (report.non_finite, report.non_finite_strand) = (count, first_strand);
    }
}
