//! Copies from the device on their way to the host, without a wait.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

use crate::{Copied, Gpu, GpuError};

/// Interval at which a waiting host checks for a lost device.
const LOOK: Duration = Duration::from_millis(10);

/// A copy on its way from the device: looked for now and then, waited for, or awaited.
#[derive(Debug)]
pub struct Transfer {
    held: StagingMemory,
    /// Buffer of the copy; `None` if nothing is copied.
    staging: Option<(wgpu::Buffer, Mapping)>,
}

impl Transfer {
    /// The copy of a submission into a staging buffer; `None` copies nothing.
    pub(super) fn new(held: StagingMemory, staging: Option<(wgpu::Buffer, wgpu::SubmissionIndex)>) -> Self {
        let staging = staging.map(|(staging, submission)| {
            let mapping = Mapping::new(&staging, Some(submission));
            (staging, mapping)
        });
        Self { held, staging }
    }

    /// True if it has arrived; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn has_arrived(&self) -> Result<bool, GpuError> {
        self.staging.as_ref().map_or(Ok(true), |(_, mapping)| mapping.is_there(&self.held.gpu))
    }

    /// The copied bytes if they have arrived, else waits for them: see [`Transfer::wait`].
    ///
    /// # Errors
    /// As there; a copy that was seen to have arrived is not waited for.
    pub fn take(self) -> Result<Copied, GpuError> {
        let seen = self.staging.as_ref().is_none_or(|(_, mapping)| mapping.was_seen());
        let arrived = if seen { self.try_take()? } else { None };
        arrived.map_or_else(|| self.wait(), Ok)
    }

    /// The copied bytes, if they have arrived; never waits.
    ///
    /// # Errors
    /// The device was lost.
    pub fn try_take(&self) -> Result<Option<Copied>, GpuError> {
        if !self.has_arrived()? {
            return Ok(None);
        }
        let Some((staging, _)) = &self.staging else { return Ok(Some(Copied { bytes: Vec::new() })) };
        let view = mapped(&self.held.gpu, staging)?;
        Ok(Some(Copied { bytes: view.to_vec() }))
    }

    /// Waits until it arrives, and not for later submissions.
    ///
    /// # Errors
    /// The device was lost or does not answer. The host never waits, also where the copy has arrived just now: a refusal is no
    /// matter of luck.
    pub fn wait(mut self) -> Result<Copied, GpuError> {
        self.held.gpu.check_wait("a copy back")?;
        if let Some((_, mapping)) = &mut self.staging {
            mapping.wait(&self.held.gpu)?;
        }
        let copied = self.try_take()?;
        copied.ok_or_else(|| refused(&self.held.gpu, "it did not arrive"))
    }
}

impl Future for Transfer {
    type Output = Result<Copied, GpuError>;

    /// Is woken when the copy arrives: in a page by the browser, in a native program by the code that polls the device.
    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        if let Some((_, mapping)) = &self.staging {
            mapping.arrival.lock().waker = Some(context.waker().clone());
        }
        match self.try_take() {
            Ok(None) => Poll::Pending,
            Ok(Some(copied)) => Poll::Ready(Ok(copied)),
            Err(error) => Poll::Ready(Err(error)),
        }
    }
}

/// Memory of a copy, given back when this is dropped.
#[derive(Debug)]
pub(super) struct StagingMemory {
    pub gpu: Gpu,
    bytes: u64,
}

impl StagingMemory {
    /// Takes a number of bytes of the device's memory.
    pub fn new(gpu: &Gpu, bytes: u64) -> Result<Self, GpuError> {
        gpu.take_memory("the copy back", bytes)?;
        Ok(Self { gpu: gpu.clone(), bytes })
    }
}

impl Drop for StagingMemory {
    fn drop(&mut self) {
        self.gpu.give_memory_back(self.bytes);
    }
}

/// A buffer that becomes readable when a submission is done.
#[derive(Debug)]
pub(super) struct Mapping {
    /// `None` is all submissions.
    submission: Option<wgpu::SubmissionIndex>,
    arrival: Arc<Arrival>,
}

#[derive(Debug, Default)]
struct Arrival {
    seen: Mutex<ArrivalState>,
    /// Signalled when it arrives.
    arrived: Condvar,
}

#[derive(Debug, Default)]
struct ArrivalState {
    mapped: Option<Result<(), String>>,
    waker: Option<Waker>,
}

impl Arrival {
    fn lock(&self) -> MutexGuard<'_, ArrivalState> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until it arrives, but not longer than a time.
    fn wait(&self, most: Duration) {
        let absent = |seen: &mut ArrivalState| seen.mapped.is_none();
        self.arrived.wait_timeout_while(self.lock(), most, absent).map(drop).ok();
    }
}

impl Mapping {
    pub fn new(staging: &wgpu::Buffer, submission: Option<wgpu::SubmissionIndex>) -> Self {
        let arrival: Arc<Arrival> = Arc::default();
        let arrived = Arc::clone(&arrival);
        staging.slice(..).map_async(wgpu::MapMode::Read, move |mapped| {
            let mut seen = arrived.lock();
            seen.mapped = Some(mapped.map_err(|error| error.to_string()));
            seen.waker.take().into_iter().for_each(Waker::wake);
            arrived.arrived.notify_all();
        });
        Self { submission, arrival }
    }

    /// True if an earlier look found it readable.
    fn was_seen(&self) -> bool {
        matches!(self.arrival.lock().mapped, Some(Ok(())))
    }

    /// True if it is readable by now.
    pub fn is_there(&self, gpu: &Gpu) -> Result<bool, GpuError> {
        if self.arrival.lock().mapped.is_none() {
            gpu.poll()?;
        }
        match &self.arrival.lock().mapped {
            None => Ok(false),
            Some(Ok(())) => Ok(true),
            Some(Err(message)) => Err(refused(gpu, message)),
        }
    }

    /// Waits until it is.
    pub fn wait(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        if self.is_there(gpu)? {
            return Ok(());
        }
        gpu.wait_for(self.submission.take())?;
        // Another thread that polled the device may hold the news, and is about to deliver it.
        for _ in 0..gpu.adapter().patience().as_millis() / LOOK.as_millis() {
            if self.is_there(gpu)? {
                return Ok(());
            }
            self.arrival.wait(LOOK);
        }
        Err(refused(gpu, "it did not arrive"))
    }
}

/// Content of a mapped buffer.
pub(super) fn mapped(gpu: &Gpu, staging: &wgpu::Buffer) -> Result<wgpu::BufferView, GpuError> {
    let view = staging.slice(..).get_mapped_range().map_err(|error| refused(gpu, &error.to_string()))?;
    gpu.count_from_device(view.len());
    Ok(view)
}

fn refused(gpu: &Gpu, message: &str) -> GpuError {
    if let Err(lost) = gpu.check_lost() {
        return lost;
    }
    GpuError::Refused { adapter: gpu.name(), what: "reading back".to_owned(), message: message.to_owned() }
}
