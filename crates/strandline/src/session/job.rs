//! Tasks of a simulation, as data, and the executors that perform them: on the thread of the caller or beside it.

use glam::Vec3;
use std::{collections::VecDeque, sync::Arc};
use strandline_gpu::Gpu;

use super::{bookmark::Bookmark, film_timing::FilmTiming, moment::Moment, simulation::Simulation};
use crate::{
    HeadMotion,
    body::{BodyFrame, Pose},
    groom::Vec3Lanes,
    scene::devices::device_name,
    scene::{Air, MotionSection, WindSection},
    session::worker::{Gone, Work, Worker},
    sim::{Settings, SimError, StepReport, Stiffening},
};

/// A task of a simulation.
#[derive(Clone)]
pub(crate) enum Task {
    /// The frame of a film with this number, with settings that change before it.
    Film { timing: FilmTiming, frame: u32, settings: Option<Box<Settings>> },
    /// A frame of a cache: guide points \[m\], world space, shape `[block][point]` of lanes.
    Cached { body: BodyFrame, positions: Vec<Vec3Lanes> },
    /// A stretch of time that a person directs.
    Live(Box<Live>),
    /// Other settings.
    Settings(Box<Settings>),
    /// Another length of each strand, over that of the groom.
    Lengths(Vec<f32>),
    /// Back to rest on a body, on which the hair then hangs for a time \[s\] in wind \[m/s\].
    Reset { body: BodyFrame, settle: f64, air: Air },
    /// Takes the hair about a point of a guide, wherever that is by then, into a hand of a radius \[m\].
    Grab { index: usize, lane: usize, radius: f32 },
    /// Lets go of it.
    Release,
}

/// Motion of the head and of the air.
pub(crate) struct Weather {
    pub head: HeadMotion,
    pub wind: WindSection,
    /// The section that the head follows.
    pub motion: MotionSection,
}

/// A stretch of time that a person directs.
#[derive(Clone)]
pub(crate) struct Live {
    /// Time of the clock at its end \[s\], the time of motion and wind when that of the clock is 0, and the most steps.
    pub until: f64,
    pub offset: f64,
    pub most_steps: f64,
    pub weather: Arc<Weather>,
    /// Target of the hand \[m\], world space.
    pub hand: Option<Vec3>,
}

impl Task {
    /// True where a frame ends with it.
    pub fn is_frame(&self) -> bool {
        matches!(self, Self::Film { .. } | Self::Cached { .. } | Self::Live(_))
    }

    pub fn perform(self, simulation: &mut Simulation) -> Result<Vec<StepReport>, SimError> {
        let done = match self {
            Self::Film { timing, frame, settings } => {
                settings.map_or(Ok(()), |settings| simulation.set_settings(&settings))?;
                return timing.run(simulation, frame);
            }
            Self::Live(live) => return live.run(simulation),
            Self::Cached { body, positions } => simulation.show_cached(&body, &positions),
            Self::Settings(settings) => simulation.set_settings(&settings),
            Self::Lengths(scales) => simulation.engine.set_length_scale(&scales),
            Self::Reset { body, settle, air } => {
                simulation.reset(body).and_then(|()| simulation.settle(settle, air))
            }
            Self::Grab { index, lane, radius } => {
                let now = simulation.engine.state()?.positions[index].get(lane) + simulation.origin;
                simulation.grab(now, radius).map(drop)
            }
            Self::Release => simulation.release(),
        };
        done.map(|()| Vec::new())
    }
}

impl Live {
    /// As in a film, motion and wind are asked for at times of steps, never of frames.
    fn run(self, simulation: &mut Simulation) -> Result<Vec<StepReport>, SimError> {
        let Self { offset, hand, .. } = self;
        let Weather { head, wind, .. } = &*self.weather;
        let (start, begin) = (simulation.end().clone(), simulation.clock.time());
        hand.into_iter().for_each(|hand| simulation.move_hand(hand));
        let until = self.until.min(begin + self.most_steps * simulation.time_step());
        // A head that was turned by hand meanwhile goes straight to where its motion has it.
        let follows = is_near(&start.world_from_head(), &head.pose(begin + offset));
        let end = head.frame(until + offset);
        simulation.run_to(until, &|time| {
            let share = ((time - begin) / (until - begin)).clamp(0.0, 1.0) as f32;
            let body = if follows { head.frame(time + offset) } else { start.toward(&end, share) };
            (body, wind.air(time + offset, head.origin()))
        })
    }
}

/// True where two poses of a head are alike but for the rounding of the times at which they were asked for.
fn is_near(one: &Pose, other: &Pose) -> bool {
    one.translation.distance(other.translation) < 1e-4 && one.rotation.dot(other.rotation).abs() > 1.0 - 1e-6
}

/// A task, and room for the moment that it leads to.
pub(crate) struct Job {
    pub task: Task,
    pub moment: Moment,
    /// The device that the pictures are drawn on.
    pub gpu: Option<Gpu>,
    /// True where the host needs the points of the moment too.
    pub home: bool,
    /// Commands that were received before.
    pub commands: u64,
    /// True where the simulation may go back to the end of the job.
    pub marks: bool,
}

/// Result of a job; after a failure the moment is that of the last state.
pub(crate) struct Done {
    pub moment: Moment,
    pub reports: Result<Vec<StepReport>, SimError>,
    pub notes: Vec<String>,
    /// Time of the clock \[s\].
    pub time: f64,
    /// The simulation at its end, where that was wanted and no hand holds hair.
    pub bookmark: Option<Bookmark>,
    /// Time by which the moment lies behind the end of the last run \[s\].
    pub delay: f64,
    /// Strands in the hand.
    pub grabbed: usize,
    pub is_frame: bool,
    /// As in the job.
    pub commands: u64,
    /// Device of the job: cpu, or the adapter.
    pub simulated_on: String,
    pub stiffening: Stiffening,
}

impl Work for Simulation {
    type Job = Job;
    type Done = Done;

    fn run(&mut self, job: Job) -> Done {
        let Job { task, mut moment, gpu, home, commands, marks } = job;
        let is_frame = task.is_frame();
        let threads = self.threads.take();
        let run = || {
            let reports = task.perform(self);
            let mut shown = self.show(gpu.as_ref(), &mut moment);
            if home && shown.is_ok() {
                shown = self.bring_home(&mut moment);
            }
            reports.and_then(|reports| shown.map(|()| reports))
        };
        let reports = match &threads {
            Some(threads) => threads.run(run),
            None => run(),
        };
        self.threads = threads;
        let simulated_on = device_name(self.engine.gpu());
        let (time, grabbed) = (self.clock.time(), self.engine.grabbed());
        let bookmark = if marks && grabbed == 0 { self.bookmark().ok() } else { None };
        let notes = self.engine.take_notes();
        let (stiffening, delay) = (self.stiffening(), self.delay());
        Done {
            moment,
            reports,
            time,
            bookmark,
            notes,
            delay,
            grabbed,
            is_frame,
            commands,
            simulated_on,
            stiffening,
        }
    }
}

/// Runs the jobs of a simulation: on the thread of the caller, or on one beside it.
pub(crate) trait Executor {
    /// Hands a job over.
    fn start(&mut self, job: Job) -> Result<(), Gone>;

    /// Waits for the oldest job that was started.
    fn finish(&mut self) -> Result<Done, Gone>;

    /// Jobs that were started and not finished.
    fn started(&self) -> usize;

    /// The simulation between two jobs: waits for the one that runs.
    fn with<T>(&mut self, act: impl FnOnce(&mut Simulation) -> T) -> T;
}

/// A simulation on the thread of the caller.
pub(crate) struct Inline {
    simulation: Simulation,
    done: VecDeque<Done>,
}

impl Inline {
    pub fn new(simulation: Simulation) -> Self {
        Self { simulation, done: VecDeque::new() }
    }

    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    pub fn simulation_mut(&mut self) -> &mut Simulation {
        &mut self.simulation
    }

    pub fn into_simulation(self) -> Simulation {
        self.simulation
    }
}

impl Executor for Inline {
    fn start(&mut self, job: Job) -> Result<(), Gone> {
        self.done.push_back(self.simulation.run(job));
        Ok(())
    }

    fn finish(&mut self) -> Result<Done, Gone> {
        self.done.pop_front().ok_or(Gone)
    }

    fn started(&self) -> usize {
        self.done.len()
    }

    fn with<T>(&mut self, act: impl FnOnce(&mut Simulation) -> T) -> T {
        act(&mut self.simulation)
    }
}

impl Executor for Worker<Simulation> {
    fn start(&mut self, job: Job) -> Result<(), Gone> {
        Worker::start(self, job)
    }

    fn finish(&mut self) -> Result<Done, Gone> {
        Worker::finish(self)
    }

    fn started(&self) -> usize {
        Worker::started(self)
    }

    fn with<T>(&mut self, act: impl FnOnce(&mut Simulation) -> T) -> T {
        act(&mut self.work())
    }
}
