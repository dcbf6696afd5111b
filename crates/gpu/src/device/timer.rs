use std::sync::{Mutex, PoisonError};

use crate::{Buffer, Gpu, GpuError};

/// Stages that a timer can take.
const STAGES: usize = 48;
/// Timestamps of a recording: begin and end of each stage.
const MARKS: usize = 2 * STAGES;

/// Takes the times of the stages of a recording with the device's own clock.
#[derive(Debug)]
pub struct Timer {
    set: wgpu::QuerySet,
    marks: Buffer<u64>,
    /// Nanoseconds of a tick.
    period: f32,
    names: Mutex<Vec<&'static str>>,
}

impl Timer {
    /// A timer, where the device offers timestamps.
    ///
    /// # Errors
    /// The device was lost or has no memory left.
    pub fn new(gpu: &Gpu) -> Result<Option<Self>, GpuError> {
        if !gpu.has_timestamps() {
            return Ok(None);
        }
        let set = gpu.ask("timestamps", || {
            gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stages"),
                ty: wgpu::QueryType::Timestamp,
                count: MARKS as u32,
            })
        })?;
        let marks = Buffer::new(gpu, "timestamps", MARKS)?;
        let period = gpu.queue().get_timestamp_period();
        Ok(Some(Self { set, marks, period, names: Mutex::default() }))
    }

    /// Forgets the stages of the last recording.
    pub fn restart(&self) {
        self.names().clear();
    }

    /// Bytes that [`Timer::resolve`] writes.
    pub const BYTES: u64 = (MARKS * size_of::<u64>()) as u64;

    /// The marks of the next stage; `None` if there are too many.
    pub(crate) fn next(&self, name: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let mut names = self.names();
        if names.len() == STAGES {
            return None;
        }
        let first = 2 * names.len() as u32;
        names.push(name);
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Records the copy of the marks into a buffer at an offset in bytes.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder, into: &wgpu::Buffer, offset: u64) {
        let count = 2 * self.names().len() as u32;
        encoder.resolve_query_set(&self.set, 0..count, self.marks.raw(), 0);
        encoder.copy_buffer_to_buffer(self.marks.raw(), 0, into, offset, Self::BYTES);
    }

    /// Stages of the last recording, in order.
    pub fn stages(&self) -> Vec<&'static str> {
        self.names().clone()
    }

    /// Stages of the last recording and their seconds, from what [`Timer::resolve`] wrote; stages of one name add up.
    pub fn seconds(&self, marks: &[u64]) -> Vec<(&'static str, f64)> {
        self.seconds_of(&self.names(), marks)
    }

    /// As [`Timer::seconds`], for a recording of other stages.
    pub fn seconds_of(&self, stages: &[&'static str], marks: &[u64]) -> Vec<(&'static str, f64)> {
        let mut seconds: Vec<(&'static str, f64)> = Vec::new();
        for (name, pair) in stages.iter().zip(marks.chunks_exact(2)) {
            let ticks = pair[1].saturating_sub(pair[0]);
            let time = ticks as f64 * f64::from(self.period) * 1e-9;
            match seconds.iter_mut().find(|(other, _)| other == name) {
                Some((_, sum)) => *sum += time,
                None => seconds.push((name, time)),
            }
        }
        seconds
    }

    fn names(&self) -> std::sync::MutexGuard<'_, Vec<&'static str>> {
        self.names.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
