//! Runs on a GPU, measured by its own clock.

use std::time::{Duration, Instant};

use strandline::{
    Prepared, Scene, SimError,
    measure::{GpuFilm, Gradient},
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
    fn measured(film: &GpuFilm, software: bool) -> anyhow::Result<Option<Self>> {
        const ROWS: usize = 5;
        let in_a_row = if software { 8 } else { 64 };
        // Both in turn, so that other load falls on both.
        let mut best = [f64::INFINITY; 2];
        for _ in 0..ROWS {
            for (best, gradient) in best.iter_mut().zip([Gradient::Joint, Gradient::Split]) {
                match film.seconds_of_gradient(gradient, in_a_row)? {
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
    fn warm_up(&self, film: &mut GpuFilm) -> Result<(), SimError> {
        let begin = Instant::now();
        film.run_at_rest(2)?;
        while !self.adapter.software && begin.elapsed() < WARM_UP {
            film.run_at_rest(QUEUED)?;
        }
        Ok(())
    }

    /// Plays a scene without pictures.
    pub fn measure(&self, scene: &Scene, what: &'static str) -> anyhow::Result<GpuRun> {
        let prepared = Prepared::new(scene)?;
        let placement = prepared.placement;
        let mut film = GpuFilm::new(&self.gpu, prepared)?;
        let mut steps = Steps::default();
        let count = scene.film.frames as usize;
        let mut progress = Progress::new(count as u64, what, false);
        self.warm_up(&mut film)?;
        film.begin()?;
        let mut wall = 0.0;
        for first in (0..count).step_by(QUEUED) {
            let queued = QUEUED.min(count - first);
            let begin = Instant::now();
            for (step, report) in film.run(first, queued)?.iter().enumerate() {
                let note = steps.add(report, (first + step) as u32);
                note.into_iter().for_each(|note| progress.note(&note));
            }
            wall += begin.elapsed().as_secs_f64();
            progress.reached((first + queued) as u64);
        }
        drop(progress);
        let steps = steps.report(Ended {
            placement,
            backend: self.adapter.name.clone(),
            strands: film.strand_count(),
            points_per_strand: film.points_per_strand(),
            drift: film.drift()?,
            measures: strandline::Measures::default(),
            stiffening: film.stiffening(),
            jumps: Vec::new(),
            time_step: scene.simulation.time_step,
            tolerance: scene.simulation.volume.tolerance,
        });
        let costs = film.costs();
        let solve = steps.ms_per_step.stages.sum(&["solve_pressure"]);
        let rest: f64 = steps.ms_per_step.stages.iter().map(|(_, time)| time).sum::<f64>() - solve;
        let copied = self.adapter.copy_bytes_per_second * rest * 1e-3;
        Ok(GpuRun {
            us_of_gradient: GradientTimes::measured(&film, self.adapter.software)?,
            steps,
            wall_ms_per_step: 1e3 * wall / count.max(1) as f64,
            dispatches: costs.dispatches,
            dispatches_without_solve: costs.dispatches - costs.solve_dispatches,
            bytes_per_step: costs.bytes,
            share_of_copy_bandwidth: if copied > 0.0 { costs.bytes as f64 / copied } else { 0.0 },
        })
    }
}
