//! Runs on a GPU, measured by its own clock.

use std::time::{Duration, Instant};

use strandline::{
    Prepared, Scene, SimError,
    low_level::sim::{
        Drive, Model,
        gpu::{GpuRunner, Gradient},
    },
};

use super::gpu::{Device, GpuRun, GradientTimes};
use crate::progress::Progress;
use crate::sim::{Ended, Steps};

/// Steps that are queued before their reports are read.
const QUEUED: usize = 16;
/// Time of steps before those that are measured, on hardware.
const WARM_UP: Duration = Duration::from_millis(500);

impl GradientTimes {
    /// After the last step, whose markers and pressure it takes.
    fn measured(runner: &GpuRunner, software: bool) -> anyhow::Result<Option<Self>> {
        const ROWS: usize = 5;
        let in_a_row = if software { 8 } else { 64 };
        // Both in turn, so that other load falls on both.
        let mut best = [f64::INFINITY; 2];
        for _ in 0..ROWS {
            for (best, gradient) in best.iter_mut().zip([Gradient::Joint, Gradient::Split]) {
                match runner.seconds_of_gradient(gradient, in_a_row)? {
                    Some(seconds) => *best = best.min(1e6 * seconds),
                    None => return Ok(None),
                }
            }
        }
        let [one_kernel, three_kernels] = best;
        Ok(Some(Self { one_kernel, three_kernels, in_a_row }))
    }
}

impl Device {
    /// The first steps compile and allocate, and a device at rest lowers its clock: on an H200 the step of the thesis's scene
    /// took 3.5 ms without these, 0.7 ms with them.
    fn warm_up(&self, runner: &mut GpuRunner) -> anyhow::Result<()> {
        let begin = Instant::now();
        run(runner, 2, |_| Drive::default())?;
        while !self.adapter.software && begin.elapsed() < WARM_UP {
            run(runner, QUEUED, |_| Drive::default())?;
        }
        Ok(())
    }

    /// Plays a scene without pictures.
    pub fn measure(&self, scene: &Scene, what: &'static str) -> anyhow::Result<GpuRun> {
        let Prepared { guides, colliders, head, placement, .. } = Prepared::new(scene)?;
        let model = Model::new(&guides, &scene.simulation, colliders)?;
        let begun = model.rest_state(head.pose(0.0));
        let mut runner = GpuRunner::new(&self.gpu, model)?;
        runner.write(&begun)?;
        let mut steps = Steps::default();
        let count = scene.film.frames as usize;
        let mut progress = Progress::new(count as u64, what, false);
        self.warm_up(&mut runner)?;
        runner.write(&begun)?;
        let mut wall = 0.0;
        for first in (0..count).step_by(QUEUED) {
            let queued = QUEUED.min(count - first);
            let begin = Instant::now();
            let drive = |step: usize| {
                let time = (first + step + 1) as f64 * f64::from(scene.simulation.time_step);
                Drive { body: head.pose(time).into(), wind: scene.wind.at(time), ..Drive::default() }
            };
            for (step, report) in run(&mut runner, queued, drive)?.iter().enumerate() {
                let note = steps.add(report, (first + step) as u32);
                note.into_iter().for_each(|note| progress.note(&note));
            }
            wall += begin.elapsed().as_secs_f64();
            progress.reached((first + queued) as u64);
        }
        drop(progress);
        let plain = runner.model();
        let steps = steps.report(Ended {
            placement,
            backend: self.adapter.name.clone(),
            strands: guides.strand_count(),
            points_per_strand: guides.points_per_strand(),
            drift: plain.drift(&runner.state()?),
            measures: strandline::Measures::default(),
            stiffening: plain.stiffening(),
            jumps: Vec::new(),
            time_step: scene.simulation.time_step,
            tolerance: scene.simulation.volume.tolerance,
        });
        let costs = runner.costs();
        let solve = steps.ms_per_step.stages.sum(&["solve_pressure"]);
        let rest: f64 = steps.ms_per_step.stages.iter().map(|(_, time)| time).sum::<f64>() - solve;
        let copied = self.adapter.copy_bytes_per_second * rest * 1e-3;
        Ok(GpuRun {
            us_of_gradient: GradientTimes::measured(&runner, self.adapter.software)?,
            steps,
            wall_ms_per_step: 1e3 * wall / count.max(1) as f64,
            dispatches: costs.dispatches,
            dispatches_without_solve: costs.dispatches - costs.solve_dispatches,
            bytes_per_step: costs.bytes,
            share_of_copy_bandwidth: if copied > 0.0 { costs.bytes as f64 / copied } else { 0.0 },
        })
    }
}

/// Runs steps, and waits for their reports.
fn run(
    runner: &mut GpuRunner,
    count: usize,
    drive: impl Fn(usize) -> Drive,
) -> Result<Vec<strandline::StepReport>, SimError> {
    for step in 0..count {
        runner.step(&drive(step))?;
    }
    runner.reports()
}
