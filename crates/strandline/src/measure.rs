//! Measurements on a GPU by the device's own clock, as `strandline bench` makes them.

use crate::{
    HeadMotion, Prepared,
    gpu::Gpu,
    scene::WindSection,
    sim::{Drift, Drive, Model, SimError, State, StepReport, Stiffening, gpu::GpuRunner},
};

pub use crate::sim::gpu::{Costs, Gradient, LengthsForm, LengthsInput, lengths_alone};

/// The film of a scene as steps on a GPU, queued without pictures.
pub struct GpuFilm {
    runner: GpuRunner,
    rest: State,
    head: HeadMotion,
    wind: WindSection,
    time_step: f32,
}

impl GpuFilm {
    /// Compiles the kernels for a scene; its hair is at rest where the head begins.
    ///
    /// # Errors
    /// As [`Hair::open`](crate::Hair::open) on a GPU.
    pub fn new(gpu: &Gpu, prepared: Prepared) -> Result<Self, SimError> {
        let Prepared { guides, colliders, head, scene, .. } = prepared;
        let model = Model::new(&guides, &scene.simulation, colliders)?;
        let rest = model.rest_state(head.pose(0.0));
        let mut film = Self {
            runner: GpuRunner::new(gpu, model)?,
            rest,
            head,
            wind: scene.wind,
            time_step: scene.simulation.time_step,
        };
        film.begin()?;
        Ok(film)
    }

    /// Number of simulated strands.
    pub fn strand_count(&self) -> usize {
        self.runner.model().strand_count()
    }

    /// Points of each of them.
    pub fn points_per_strand(&self) -> usize {
        self.runner.model().points_per_strand()
    }

    /// Goes back to the beginning.
    ///
    /// # Errors
    /// The device was lost.
    pub fn begin(&mut self) -> Result<(), SimError> {
        self.runner.write(&self.rest)
    }

    /// Runs steps in calm air on a head at the origin, and waits for their reports.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn run_at_rest(&mut self, count: usize) -> Result<Vec<StepReport>, SimError> {
        (0..count).try_for_each(|_| self.runner.step(&Drive::default()))?;
        self.runner.reports()
    }

    /// Runs steps of the film after the first `first`, and waits for their reports.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn run(&mut self, first: usize, count: usize) -> Result<Vec<StepReport>, SimError> {
        for step in first..first + count {
            let time = (step + 1) as f64 * f64::from(self.time_step);
            let body = self.head.pose(time).into();
            self.runner.step(&Drive { body, wind: self.wind.at(time), ..Drive::default() })?;
        }
        self.runner.reports()
    }

    /// Distance of the hair from the groom as loaded, which the head carries.
    ///
    /// # Errors
    /// The device was lost.
    pub fn drift(&self) -> Result<Drift, SimError> {
        Ok(self.runner.model().drift(&self.runner.state()?))
    }

    /// Strands of rods that had to be stiffer for their shape to be stable.
    pub fn stiffening(&self) -> Stiffening {
        self.runner.model().stiffening()
    }

    /// Work that the last step caused on the device.
    pub fn costs(&self) -> Costs {
        self.runner.costs()
    }

    /// Seconds that subtracting the pressure gradient once takes in a form, as the mean of `count` times in a row
    /// [Chen2011 table 1]; `None` without a volume, before the first step and where the device offers no timestamps.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn seconds_of_gradient(&self, gradient: Gradient, count: usize) -> Result<Option<f64>, SimError> {
        self.runner.seconds_of_gradient(gradient, count)
    }
}
