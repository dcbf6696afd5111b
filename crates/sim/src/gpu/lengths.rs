//! Strands of a runner's state take other lengths.

use std::sync::Arc;

use super::inputs::Step;
use super::runner::GpuRunner;
use crate::length_scale::Lengths;
use crate::{Drive, SimError};

impl GpuRunner {
    /// Gives strands lengths between two steps, as [`State::set_length_scale`](crate::State::set_length_scale) does on
    /// the host; nothing is waited for.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub(crate) fn set_lengths(&mut self, lengths: &Lengths) -> Result<(), SimError> {
        self.buffers.write_rest(&self.model, &lengths.rest)?;
        // The kernel asks for the numbers of strands and points, which lie there only after the first step.
        let still = Drive::of(self.body.clone());
        self.buffers.step.write(&[Step::new(&self.model, &self.body, &still, &self.grab, 0)])?;
        self.kernels.slide.run(&self.gpu, &self.buffers)?;
        self.length_scale.clone_from(&lengths.scale);
        self.lengths = Arc::clone(&lengths.rest);
        Ok(())
    }
}
