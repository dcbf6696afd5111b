//! Reports of steps: they lie on the device, are on their way, or have arrived.

use std::collections::VecDeque;

use strandline_base::Stopwatch;
use strandline_gpu::{Buffer, Gpu, GpuError, Readback, Slot, Timer, Transfer};

use super::buffers::REPORTS;
use super::records::Report;

/// Most copies on their way: a caller that makes more steps than these report waits for the oldest.
const ON_WAY: usize = 32;

pub(super) struct Pending {
    /// None where the device has no timestamps.
    pub timer: Option<Timer>,
    pub marks: Buffer<u64>,
    /// Steps whose reports lie on the device.
    pub count: usize,
    on_way: VecDeque<OnWay>,
}

/// Reports on their way, and the times of the stages of their steps.
struct OnWay {
    transfer: Transfer,
    reports: Slot<Report>,
    marks: Slot<u64>,
    count: usize,
    /// Stages of these steps, as they were recorded.
    stages: Vec<&'static str>,
    watch: Stopwatch,
}

/// Report of a step, and the times of its stages \[s\].
pub(super) type Reported = (Report, Vec<(&'static str, f64)>);

impl Pending {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let marks = Buffer::new(gpu, "times of stages", REPORTS * Timer::BYTES as usize / size_of::<u64>())?;
        Ok(Self { timer: Timer::new(gpu)?, marks, count: 0, on_way: VecDeque::new() })
    }

    /// Marks of a step.
    fn stride(&self) -> usize {
        if self.timer.is_some() { Timer::BYTES as usize / size_of::<u64>() } else { 0 }
    }

    /// Sends the reports that lie on the device on their way: there is room for others.
    pub fn send(&mut self, gpu: &Gpu, reports: &Buffer<Report>) -> Result<(), GpuError> {
        if self.count == 0 {
            return Ok(());
        }
        let mut batch = Readback::new();
        let reports = batch.add(reports, self.count);
        let marks = batch.add(&self.marks, self.count * self.stride());
        let transfer = batch.begin(gpu)?;
        let count = std::mem::take(&mut self.count);
        let stages = self.timer.as_ref().map(Timer::stages).unwrap_or_default();
        let watch = Stopwatch::start();
        self.on_way.push_back(OnWay { transfer, reports, marks, count, stages, watch });
        Ok(())
    }

    /// Runs whose reports have not arrived.
    pub fn on_way(&self) -> usize {
        self.on_way.len()
    }

    /// Takes the reports that have arrived, in the order of their steps.
    pub fn arrived(&mut self, gpu: &Gpu) -> Result<Vec<Reported>, GpuError> {
        let most = if gpu.check_wait("reports").is_ok() { ON_WAY } else { usize::MAX };
        let mut found = Vec::new();
        while let Some(first) = self.on_way.pop_front() {
            if self.on_way.len() < most && !first.transfer.has_arrived()? {
                self.on_way.push_front(first);
                break;
            }
            found.extend(self.take(first)?);
        }
        Ok(found)
    }

    /// Waits for all reports.
    pub fn drain(&mut self, gpu: &Gpu, reports: &Buffer<Report>) -> Result<Vec<Reported>, GpuError> {
        self.send(gpu, reports)?;
        if !self.on_way.is_empty() {
            gpu.check_wait("reports")?;
        }
        let mut found = Vec::new();
        while let Some(first) = self.on_way.pop_front() {
            found.extend(self.take(first)?);
        }
        Ok(found)
    }

    /// Forgets reports of steps of which nothing is known.
    pub fn forget(&mut self) {
        self.count = 0;
        self.on_way.clear();
    }

    /// Waits for reports that have not arrived. Without timestamps a step took at most the time until its report was there.
    fn take(&self, on_way: OnWay) -> Result<Vec<Reported>, GpuError> {
        let OnWay { transfer, reports, marks, count, stages, watch } = on_way;
        let copied = transfer.take()?;
        let (reports, marks, stride) = (copied.take(reports), copied.take(marks), self.stride());
        let until_here = watch.seconds() / count as f64;
        let seconds = |slot: usize| match &self.timer {
            Some(timer) => timer.seconds_of(&stages, &marks[slot * stride..(slot + 1) * stride]),
            None => vec![("step", until_here)],
        };
        Ok(reports.into_iter().enumerate().map(|(slot, report)| (report, seconds(slot))).collect())
    }
}
