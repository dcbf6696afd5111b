//! Hair that moves, apart from how it is drawn.

use std::ops::Range;

use glam::Vec3;
use strandline_base::{SettingError, par::Pool};
use strandline_gpu::Gpu;

use super::{
    air_hairs::with_hairs,
    engine::Engine,
    jump::Jump,
    moment::{Moment, When},
    skin_carrier::SkinCarrier,
};
use crate::{
    body::BodyFrame,
    groom::Vec3Lanes,
    scene::Air,
    sim::{Clock, Drift, Drive, Measures, Settings, SimError, State, StepReport, Stiffening, Ticks},
    snapshot::{Snapshot, hair_pose::HairPose},
};

/// Steps that settling hair makes in one run.
const AT_ONCE: usize = 1024;
/// Steps that may be due at once, ten seconds of the shortest ones.
const MOST_STEPS: u32 = 1_000_000;

/// A simulation in time: steps of fixed length, and the moment between two of them that is shown.
pub(crate) struct Simulation {
    pub(super) engine: Engine,
    pub(super) clock: Clock,
    /// Place of the moment between the last two states.
    pub(super) share: f32,
    /// Body of the moment, where it is known better than from the last two steps.
    pub(super) exact: Option<BodyFrame>,
    /// Body at the last two states, and at the end of the last run.
    pub(super) bodies: [BodyFrame; 2],
    pub(super) end: BodyFrame,
    /// Drive of the last step.
    last: Drive,
    /// Time \[s\] of all runs that went well.
    pub passed: f64,
    /// Origin of all places here \[m\], world space, in whole metres: single precision is exact beside it. Places in the
    /// world become those here as they enter, and the other way round as they leave.
    pub origin: Vec3,
    /// Position of the hand that holds hair, and its target in the next run \[m\]; `None` without one.
    pub(super) hand: Option<[Vec3; 2]>,
    /// Roots that the skin carries.
    pub skin: SkinCarrier,
    /// Hairs that a guide stands for in the air where the settings do not tell.
    pub hairs: Option<f32>,
    /// The first jumps of the body.
    pub jumps: Vec<Jump>,
    /// Jumps that notes have told of.
    pub(super) told_jumps: Vec<String>,
    /// True where a note has told of vertices at no place.
    pub(super) told_held: bool,
    /// Threads of its own beside those that draw, which else keep it waiting for a whole picture.
    pub threads: Option<Pool>,
}

impl Simulation {
    pub fn new(engine: Engine, time_step: f32) -> Self {
        Self {
            engine,
            clock: Clock::new(time_step),
            share: 1.0,
            exact: None,
            bodies: [BodyFrame::REST, BodyFrame::REST],
            end: BodyFrame::REST,
            last: Drive::default(),
            passed: 0.0,
            origin: Vec3::ZERO,
            hand: None,
            skin: SkinCarrier::default(),
            hairs: None,
            jumps: Vec::new(),
            told_jumps: Vec::new(),
            told_held: false,
            threads: None,
        }
    }

    /// Changes the settings; steps of another length take that long from now on.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        let before = self.engine.model().settings().time_step;
        self.engine.set_settings(&with_hairs(settings, self.hairs))?;
        if settings.time_step != before {
            self.clock.set_time_step(settings.time_step);
        }
        Ok(())
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        self.engine.model().settings()
    }

    /// The device; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.engine.gpu()
    }

    /// The state, seen from the origin. A GPU is waited for.
    pub fn state(&mut self) -> Result<&State, SimError> {
        self.engine.state()
    }

    /// The reports of all steps that were not returned yet. A GPU is waited for.
    pub fn reports(&mut self) -> Result<Vec<StepReport>, SimError> {
        self.engine.reports()
    }

    /// Notes on the device, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        self.engine.take_notes()
    }

    /// Distance of the hair from the groom as loaded, which the head carries.
    pub fn drift(&mut self) -> Result<Drift, SimError> {
        self.engine.drift()
    }

    /// Measures of the hair in the air of the last step.
    pub fn measures(&mut self) -> Result<Measures, SimError> {
        self.engine.measures(&self.last)
    }

    /// Strands of rods that had to be stiffer for their shape to be stable.
    pub fn stiffening(&self) -> Stiffening {
        self.engine.model().stiffening()
    }

    /// Allows or forbids falling back to the CPU when the GPU fails.
    pub fn set_fall_back(&mut self, fall_back: bool) {
        self.engine.fall_back = fall_back;
    }

    /// Scales the length of every strand, shape `[strand]`.
    pub fn set_length_scale(&mut self, scales: &[f32]) -> Result<(), SimError> {
        self.engine.set_length_scale(scales)
    }

    /// Goes back to rest on a body that is seen from the origin: the same steps follow as the first time.
    pub fn reset(&mut self, body: BodyFrame) -> Result<(), SimError> {
        let body = self.skin.placed(body, &BodyFrame::REST);
        self.engine.reset(body.clone())?;
        self.begin_at(body);
        Ok(())
    }

    /// Puts hair and body where a pose has them in the world.
    pub fn place(&mut self, hair: &HairPose) -> Result<(), SimError> {
        let hair = hair.moved(-self.origin);
        let body = self.skin.placed(hair.body().clone(), &BodyFrame::REST);
        let hair = hair.on(body);
        self.engine.place(&hair)?;
        self.begin_at(hair.body().clone());
        Ok(())
    }

    /// State of the run after a frame.
    pub fn snapshot(&mut self, frame: u32) -> Result<Snapshot, SimError> {
        let [before, now] = self.bodies.clone();
        let state = self.engine.state()?.checkpoint();
        let (bodies, origin) = ([before, now, self.end.clone()], self.origin);
        Ok(Snapshot { frame, time: self.clock.time(), state, bodies, origin })
    }

    /// Restores the state of a run after a number of steps. The run continues with the same bits.
    pub fn restore(&mut self, from: &Snapshot, steps: u64) -> Result<(), SimError> {
        self.engine.restore(&from.state)?;
        let [before, now, end] = from.bodies.clone().map(|body| self.skin.recognized(body));
        self.begin_at(end);
        self.bodies = [before, now];
        (self.clock, self.share) = Clock::resumed(self.settings().time_step, from.time, steps);
        self.passed = from.time;
        Ok(())
    }

    /// Shows a frame of a cache, in the world: no time passes.
    pub fn show_cached(&mut self, body: &BodyFrame, positions: &[Vec3Lanes]) -> Result<(), SimError> {
        let origin = self.origin;
        self.engine.show(|places| {
            places.copy_from_slice(positions);
            if origin != Vec3::ZERO {
                places.iter_mut().for_each(|lanes| *lanes = lanes.moved(-origin));
            }
        })?;
        self.begin_at(self.skin.recognized(body.moved(-origin)));
        Ok(())
    }

    fn begin_at(&mut self, body: BodyFrame) {
        self.clock = Clock::new(self.engine.model().settings().time_step);
        (self.bodies, self.end, self.share) = ([body.clone(), body.clone()], body, 1.0);
        self.exact = None;
        self.hand = None;
    }

    /// Positions and motion of the hair in the shown moment, in the world.
    pub fn hair_pose(&mut self) -> Result<HairPose, SimError> {
        let mut moment = Moment::default();
        self.show(None, &mut moment)?;
        let model = self.engine.model();
        let shape = [model.strand_count(), model.points_per_strand()];
        Ok(HairPose::new(shape, moment.positions(), self.engine.state()?, &moment.body).moved(self.origin))
    }

    /// Takes the hair within `radius` \[m\] of a place \[m\] of the world into a hand; the number of strands.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, SimError> {
        let hand = hand - self.origin;
        let count = self.engine.grab(hand, radius)?;
        self.hand = (count > 0).then_some([hand; 2]);
        Ok(count)
    }

    /// Moves the hand to a place \[m\] of the world, evenly over the next run.
    pub fn move_hand(&mut self, hand: Vec3) {
        if let Some([_, to]) = &mut self.hand {
            *to = hand - self.origin;
        }
    }

    /// Lets go of what the hand holds.
    pub fn release(&mut self) -> Result<(), SimError> {
        self.hand = None;
        self.engine.release()
    }

    /// Body at the end of the last run, seen from the origin.
    pub fn end(&self) -> &BodyFrame {
        &self.end
    }

    /// Length of a step \[s\].
    pub fn time_step(&self) -> f64 {
        self.clock.time_step()
    }

    /// Makes whole steps under a head that rests where it is; no time of the clock passes.
    pub fn settle(&mut self, seconds: f64, air: impl Into<Air>) -> Result<(), SimError> {
        let drive = air.into().drive(Drive::of(self.end.clone()));
        let mut left = (seconds / self.time_step() - 1e-6).ceil().max(0.0) as usize;
        while left > 0 {
            let count = left.min(AT_ONCE);
            self.engine.run(&vec![drive.clone(); count])?;
            left -= count;
        }
        // These steps are not reported, however late their reports come.
        self.engine.discard_reports();
        self.bodies = [self.end.clone(), self.end.clone()];
        Ok(())
    }

    /// Lets `seconds` pass with what drives the hair at each share (0 to 1) of them, asked for at the end
    /// of every step.
    pub fn step_along(
        &mut self,
        seconds: f64,
        drive: &dyn Fn(f32) -> (BodyFrame, Air),
    ) -> Result<Vec<StepReport>, SimError> {
        let (before, begin, shown) = (self.clock, self.clock.time(), self.share);
        let mut ticks = self.clock.advance(seconds);
        if self.clock.time() == begin {
            ticks.share = shown;
        } else if before.is_at_step() && self.clock.is_at_step() {
            // A run of whole steps shows the state at its end.
            ticks.share = 1.0;
        }
        // Without passing time the head is at its end.
        let share = |time: f64| {
            if seconds > 0.0 { ((time - begin) / seconds).clamp(0.0, 1.0) as f32 } else { 1.0 }
        };
        let reports = self.run(before, ticks, begin..self.clock.time(), &|time| drive(share(time)))?;
        self.exact = None;
        Ok(reports)
    }

    /// Lets time pass until the clock's `time` \[s\] with what drives the hair at each time of the clock,
    /// asked for at the end of every step: however it is cut into runs, it is the same motion to the bit. The last step
    /// reaches that time or beyond it, and the moment that is shown is that time: the body is where `drive` has it,
    /// the hair, as the body carries it, between the states before and after.
    pub fn run_to(
        &mut self,
        time: f64,
        drive: &dyn Fn(f64) -> (BodyFrame, Air),
    ) -> Result<Vec<StepReport>, SimError> {
        let (before, begin) = (self.clock, self.clock.time());
        let ticks = self.clock.reach(time);
        let reports = self.run(before, ticks, begin..time, drive)?;
        self.exact = Some(self.end.clone());
        Ok(reports)
    }

    /// Time \[s\] by which the shown moment lies behind the end of the last run.
    pub fn delay(&self) -> f64 {
        if self.exact.is_some() || self.share == 1.0 { 0.0 } else { self.time_step() }
    }

    fn run(
        &mut self,
        before: Clock,
        ticks: Ticks,
        span: Range<f64>,
        drive: &dyn Fn(f64) -> (BodyFrame, Air),
    ) -> Result<Vec<StepReport>, SimError> {
        let outcome = self.drives(ticks, &span, drive).and_then(|mut drives| {
            self.note_held(&drives, ticks.first);
            self.carry_over_jumps(&mut drives, ticks.first, &span)?;
            let reports = self.engine.run(&drives)?;
            Ok((drives, reports))
        });
        let (drives, reports) = outcome.inspect_err(|_| self.clock = before)?;
        if let Some(last) = drives.last() {
            self.last = last.clone();
        }
        for Drive { body, .. } in drives {
            self.bodies.swap(0, 1);
            self.bodies[1] = body;
        }
        self.hand = self.hand.map(|[_, to]| [to; 2]);
        self.share = ticks.share;
        self.end = self.skin.placed(drive(span.end).0, &self.bodies[1]);
        self.passed += span.end - span.start;
        Ok(reports)
    }

    /// Drives of the hair for each due step, sampled at the end of the step.
    fn drives(
        &self,
        ticks: Ticks,
        span: &Range<f64>,
        drive: &dyn Fn(f64) -> (BodyFrame, Air),
    ) -> Result<Vec<Drive>, SimError> {
        if ticks.count > MOST_STEPS {
            let found = format!("{} s, {} steps at once", self.time_step(), ticks.count);
            let expected = "no more than 1000000 steps: let less time pass at once";
            return Err(SettingError::new("simulation.time_step", found, expected).into());
        }
        let seconds = span.end - span.start;
        let mut last = self.bodies[1].clone();
        let drives = (1..=u64::from(ticks.count)).map(|step| {
            let time = self.clock.step_time(ticks.first + step);
            let (body, air) = drive(time);
            let body = self.skin.placed(body, &last);
            last = body.clone();
            let share = ((time - span.start) / seconds).clamp(0.0, 1.0);
            let hand = self.hand.map(|[from, to]| from.lerp(to, share as f32));
            air.drive(Drive { body, hand, ..Drive::default() })
        });
        Ok(drives.collect())
    }

    /// Fills a moment with what is to be shown now: with points on the device of the pictures where the simulation
    /// runs there too, else on the host.
    pub fn show(&mut self, gpu: Option<&Gpu>, moment: &mut Moment) -> Result<(), SimError> {
        let share = self.share;
        let [before, after] = &self.bodies;
        moment.origin = self.origin;
        let between = || self.skin.placed(before.toward(after, share), after);
        moment.body = self.exact.clone().unwrap_or_else(between);
        moment.at = When { step: self.engine.steps(), share };
        let rests = *before == moment.body && *after == moment.body;
        let follows = self.exact.is_some() && share < 1.0 && !rests;
        moment.between = follows.then(|| self.bodies.clone());
        let model = self.engine.model();
        let shape = [model.strand_count(), model.points_per_strand()];
        if let (Some(points), Some(gpu)) = (self.engine.device_points(), gpu)
            && gpu.is_same(points[0].gpu())
            && moment.fill_on(gpu, points, shape).is_ok()
        {
            return Ok(());
        }
        let read = self.engine.state().map(|_| ());
        // After a failure it is that of the last state.
        moment.fill(self.engine.last_state());
        read
    }

    /// Brings the points of a moment to the host. Where their device was lost they are computed again, if falling back to
    /// the CPU is allowed.
    pub fn bring_home(&mut self, moment: &mut Moment) -> Result<(), SimError> {
        match moment.bring_home() {
            Err(_) if self.engine.fall_back => moment.fill(&self.engine.state_after(moment.at.step)),
            done => done?,
        }
        Ok(())
    }
}
