//! Reports of steps, which lie on the device until they are asked for.

use strandline_gpu::{Buffer, Gpu, GpuError, Readback, Timer};

use super::buffers::REPORTS;
use super::records::Report;

pub(super) struct Pending {
    /// None where the device has no timestamps.
    pub timer: Option<Timer>,
    pub marks: Buffer<u64>,
    /// Steps whose reports lie on the device.
    pub count: usize,
}

/// What a step did, and the times of its stages \[s\].
pub(super) type Reported = (Report, Vec<(&'static str, f64)>);

impl Pending {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let marks = Buffer::new(gpu, "times of stages", REPORTS * Timer::BYTES as usize / size_of::<u64>())?;
        Ok(Self { timer: Timer::new(gpu)?, marks, count: 0 })
    }

    /// Waits for the device and reads the reports that lie on it.
    pub fn drain(&mut self, gpu: &Gpu, reports: &Buffer<Report>) -> Result<Vec<Reported>, GpuError> {
        if self.count == 0 {
            return Ok(Vec::new());
        }
        let stride = if self.timer.is_some() { Timer::BYTES as usize / size_of::<u64>() } else { 0 };
        let mut batch = Readback::new();
        let reports = batch.add(reports, self.count);
        let marks = batch.add(&self.marks, self.count * stride);
        let copied = batch.read(gpu)?;
        let (found, marks) = (copied.take(reports), copied.take(marks));
        let seconds = |slot: usize| match &self.timer {
            Some(timer) => timer.seconds(&marks[slot * stride..(slot + 1) * stride]),
            None => Vec::new(),
        };
        self.count = 0;
        Ok(found.into_iter().enumerate().map(|(slot, report)| (report, seconds(slot))).collect())
    }
}
