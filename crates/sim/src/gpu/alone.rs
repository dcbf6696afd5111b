//! Kernels timed alone, as the thesis timed its pressure gradient.

use strandline_gpu::{Buffer, Recorder, Timer};

use super::records::Gradient;
use super::runner::GpuRunner;
use crate::SimError;

impl GpuRunner {
    /// Seconds that subtracting the pressure gradient once takes in a form, by the device's own clock
    /// [Chen2011 table 1]: the mean of `count` times in a row, with the markers and the pressure of the
    /// last step, which is left as it is. None without a volume, before the first step and
    /// where the device offers no timestamps.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn seconds_of_gradient(&self, gradient: Gradient, count: usize) -> Result<Option<f64>, SimError> {
        let (Some(volume), Some(timer)) = (&self.buffers.volume, Timer::new(&self.gpu)?) else {
            return Ok(None);
        };
        // The next step gathers the velocities of faces again, so nothing depends on what is left on them.
        let once = self
            .kernels
            .solve_pressure(&self.gpu, &self.model)?
            .bind_gradient(&self.gpu, volume, gradient)?;
        let repeated: Vec<_> = (0..count).flat_map(|_| once.iter().cloned()).collect();
        let marks =
            Buffer::<u64>::new(&self.gpu, "times of the gradient", Timer::BYTES as usize / size_of::<u64>())?;
        self.gpu.ask("the gradient", || {
            let mut recorder = Recorder::new(&self.gpu, Some(&timer));
            recorder.stage("solve_pressure", &repeated);
            let recorded = recorder.finish(|encoder| timer.resolve(encoder, marks.raw(), 0));
            self.gpu.queue().submit([recorded]);
        })?;
        let seconds = timer.seconds(&marks.read()?);
        Ok(Some(seconds.iter().map(|(_, seconds)| seconds).sum::<f64>() / count.max(1) as f64))
    }
}
