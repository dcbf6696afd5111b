//! Memory bandwidth of the device, to which other kernels are compared.

use strandline_base::Stopwatch;

use crate::{Buffer, Gpu, GpuError};

/// Bytes copied at once: more than most caches hold, less than a buffer may.
const BYTES: usize = 64 << 20;

impl Gpu {
    /// Bytes per second that a copy from one buffer to another reads and writes, together, over
    /// `copies` copies of 64 MiB.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn copy_bandwidth(&self, copies: usize) -> Result<f64, GpuError> {
        let source = Buffer::<u32>::new(self, "copied from", BYTES / 4)?;
        let target = Buffer::<u32>::new(self, "copied to", BYTES / 4)?;
        let run = |count: usize| {
            self.ask("copying", || {
                let mut encoder = self.device().create_command_encoder(&Default::default());
                for _ in 0..count {
                    encoder.copy_buffer_to_buffer(source.raw(), 0, target.raw(), 0, BYTES as u64);
                }
                self.queue().submit([encoder.finish()]);
            })?;
            self.wait()
        };
        // The first touch of fresh memory is not a copy.
        run(1)?;
        let watch = Stopwatch::start();
        run(copies)?;
        Ok(2.0 * (BYTES * copies) as f64 / watch.seconds())
    }
}
