use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::errors::{Errors, Refusal, answered, now};
use super::pipelines::Pipelines;
use super::wanted::Wanted;
use crate::{Adapter, Crossed, GpuError};

/// A device and its queue. Clones share them.
#[derive(Clone, Debug)]
pub struct Gpu {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: Adapter,
    errors: Arc<Errors>,
    memory: Mutex<Memory>,
    /// Bytes that went to the device and came from it.
    crossed: [AtomicU64; 2],
    /// Times that the host waited for the device.
    waits: AtomicU64,
    /// True where the host never waits for the device.
    never_waits: AtomicBool,
    kernels: Pipelines<wgpu::ComputePipeline>,
    drawings: Pipelines<wgpu::RenderPipeline>,
}

/// Allocated bytes, and the limit.
#[derive(Debug)]
struct Memory {
    used: u64,
    most: u64,
}

impl Gpu {
    /// The first adapter that is real hardware, discrete before integrated.
    ///
    /// # Errors
    /// There is no adapter, or it does not offer WebGPU's default limits.
    pub fn auto() -> Result<Self, GpuError> {
        at_once(Self::request(Wanted::Hardware))?
    }

    /// The first adapter of any kind, hardware before software.
    ///
    /// # Errors
    /// There is no adapter, or it does not offer WebGPU's default limits.
    pub fn any() -> Result<Self, GpuError> {
        at_once(Self::request(Wanted::Any))?
    }

    /// An adapter by its number in [`Gpu::list`].
    ///
    /// # Errors
    /// No adapter has that number, or it does not offer WebGPU's default limits.
    pub fn open(index: usize) -> Result<Self, GpuError> {
        at_once(Self::request(Wanted::Number(index)))?
    }

    /// All adapters, hardware before software.
    pub fn list() -> Vec<Adapter> {
        let found = at_once(adapters()).unwrap_or_default();
        found.into_iter().map(|(_, adapter)| adapter).collect()
    }

    /// The first wanted adapter that starts, for hosts that cannot block, as in a browser page.
    ///
    /// # Errors
    /// There is no adapter, or none offers WebGPU's default limits: the error of the first.
    pub async fn request(wanted: Wanted) -> Result<Self, GpuError> {
        let adapters = adapters().await;
        let offered: Vec<Adapter> = adapters.iter().map(|(_, adapter)| adapter.clone()).collect();
        let mut refused = GpuError::NoAdapter { wanted: wanted.to_string(), offered };
        for (found, adapter) in adapters.into_iter().filter(|(_, adapter)| wanted.is(adapter)) {
            match Self::start(&found, adapter).await {
                Ok(gpu) => return Ok(gpu),
                Err(error) if matches!(refused, GpuError::NoAdapter { .. }) => refused = error,
                Err(_) => {}
            }
        }
        Err(refused)
    }

    /// A host's own device and queue. The host keeps its error handlers and its callback, so that the
    /// loss of the device shows as [`GpuError::Refused`] here; the device needs WebGPU's default
    /// limits, and `TIMESTAMP_QUERY` for times.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let adapter = Adapter::new(0, &device.adapter_info());
        Self::new(device, queue, adapter, Arc::default())
    }

    fn new(device: wgpu::Device, queue: wgpu::Queue, adapter: Adapter, errors: Arc<Errors>) -> Self {
        let memory = Mutex::new(Memory { used: 0, most: u64::MAX });
        let (crossed, waits, kernels, drawings) = Default::default();
        // A page cannot wait.
        let never_waits = AtomicBool::new(cfg!(target_family = "wasm"));
        Self {
            shared: Arc::new(Shared {
                device,
                queue,
                adapter,
                errors,
                memory,
                crossed,
                waits,
                never_waits,
                kernels,
                drawings,
            }),
        }
    }

    async fn start(found: &wgpu::Adapter, adapter: Adapter) -> Result<Self, GpuError> {
        let limits = wgpu::Limits::default();
        let mut refused = None;
        limits.check_limits_with_fail_fn(&found.limits(), false, |what, needed, limit| {
            refused.get_or_insert_with(|| GpuError::Limit {
                adapter: adapter.to_string(),
                what: what.to_owned(),
                needed,
                limit,
            });
        });
        if let Some(error) = refused {
            return Err(error);
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("strandline"),
            required_features: found.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) = found.request_device(&descriptor).await.map_err(|error| {
            let what = "starting the device".to_owned();
            GpuError::Refused { adapter: adapter.to_string(), what, message: error.to_string() }
        })?;
        let errors: Arc<Errors> = Arc::default();
        let (of_loss, of_writes) = (errors.clone(), errors.clone());
        device.set_device_lost_callback(move |_, message| of_loss.lose(message));
        // Writes have no error scope.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            of_writes.file(Refusal::new("writing", &error));
        }));
        Ok(Self::new(device, queue, adapter, errors))
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.shared.device
    }

    /// The queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.shared.queue
    }

    /// True if both are one device.
    pub fn is_same(&self, other: &Self) -> bool {
        self.device() == other.device()
    }

    /// The adapter.
    pub fn adapter(&self) -> &Adapter {
        &self.shared.adapter
    }

    /// True if the device can measure the time of its work.
    pub fn has_timestamps(&self) -> bool {
        self.device().features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Sets the most bytes that all buffers together may hold, so that a host can keep some for
    /// itself. Memory that is allocated already stays.
    pub fn set_memory_limit(&self, bytes: u64) {
        self.memory().most = bytes;
    }

    /// Bytes that all buffers together hold.
    pub fn memory_used(&self) -> u64 {
        self.memory().used
    }

    /// Bytes that all buffers and pictures together took to the device, and back from it, since it was opened.
    pub fn crossed(&self) -> Crossed {
        let [to_device, from_device] = self.shared.crossed.each_ref().map(|bytes| bytes.load(Relaxed));
        Crossed { to_device, from_device }
    }

    /// Times that the host has waited for the device since it was opened.
    pub fn waits(&self) -> u64 {
        self.shared.waits.load(Relaxed)
    }

    /// Makes every call that would wait for the device an error ([`GpuError::WouldWait`]) from now on, for all clones: for
    /// hosts whose loop must not stop. A page is such a host from the beginning.
    pub fn never_wait(&self) {
        self.shared.never_waits.store(true, Relaxed);
    }

    /// Tells whether a call may wait for something.
    ///
    /// # Errors
    /// The host never waits.
    pub fn check_wait(&self, what: &str) -> Result<(), GpuError> {
        if self.shared.never_waits.load(Relaxed) {
            return Err(GpuError::WouldWait { adapter: self.name(), what: what.to_owned() });
        }
        Ok(())
    }

    pub(crate) fn count_to_device(&self, bytes: usize) {
        self.shared.crossed[0].fetch_add(bytes as u64, Relaxed);
    }

    pub(crate) fn count_from_device(&self, bytes: usize) {
        self.shared.crossed[1].fetch_add(bytes as u64, Relaxed);
    }

    /// Gives the device up; every later use is an error.
    pub fn destroy(&self) {
        self.shared.errors.lose("it was given up".to_owned());
        self.device().destroy();
    }

    /// Tells whether the device still works and did all that was asked of it. A refusal that was filed is reported once.
    ///
    /// # Errors
    /// The device was lost; else the first refusal that was not reported yet.
    pub fn check(&self) -> Result<(), GpuError> {
        self.check_lost()?;
        self.shared.errors.take().map_or(Ok(()), |refusal| Err(refusal.on(self.name())))
    }

    /// Tells whether the device was lost.
    pub(crate) fn check_lost(&self) -> Result<(), GpuError> {
        let lost = self.shared.errors.lost();
        lost.map_or(Ok(()), |reason| Err(GpuError::Lost { adapter: self.name(), reason }))
    }

    /// Asks for something that the device may refuse, under a name, and does not wait for the answer. A native device
    /// answers at once; the answer of another one is filed for the next [`Gpu::check`].
    ///
    /// # Errors
    /// The device is lost, has no memory left, or finds a mistake, in this or in what was asked before.
    pub fn ask<T>(&self, what: &str, run: impl FnOnce() -> T) -> Result<T, GpuError> {
        self.check()?;
        let memory = self.device().push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device().push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device().push_error_scope(wgpu::ErrorFilter::Validation);
        let result = run();
        let answers = [answered(validation.pop()), answered(internal.pop()), answered(memory.pop())];
        let mut refused = None;
        for answer in answers {
            match answer {
                Ok(error) => refused = refused.or(error),
                Err(coming) => self.shared.errors.file_answers(what, [coming]),
            }
        }
        self.check_lost()?;
        match refused {
            None => Ok(result),
            Some(error) => Err(Refusal::new(what, &error).on(self.name())),
        }
    }

    /// Polls the device, which wgpu ends with a panic where a native driver says that the device is gone: nothing of ours
    /// is left half done then, since the device is not used afterwards.
    fn surviving<T>(&self, poll: impl FnOnce() -> T) -> Result<T, GpuError> {
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(poll)).map_err(|panic| {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            let said = said.or(panic.downcast_ref::<&str>().copied()).unwrap_or("the driver gave up");
            self.shared.errors.lose(said.to_owned());
            GpuError::Lost { adapter: self.name(), reason: said.to_owned() }
        })
    }

    /// Waits until everything that was submitted is done.
    ///
    /// # Errors
    /// The device was lost or does not answer.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.wait_for(None)
    }

    /// Waits until a submission is done, or everything that was submitted.
    pub(crate) fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        self.check()?;
        self.check_wait("the call")?;
        self.shared.waits.fetch_add(1, Relaxed);
        let patience = wgpu::PollType::Wait { submission_index, timeout: Some(self.adapter().patience()) };
        let polled = self.surviving(|| self.device().poll(patience))?;
        self.check()?;
        polled.map(drop).map_err(|error| GpuError::Lost { adapter: self.name(), reason: error.to_string() })
    }

    /// Processes finished work.
    pub(crate) fn poll(&self) -> Result<(), GpuError> {
        self.check()?;
        let polled = self.surviving(|| self.device().poll(wgpu::PollType::Poll))?;
        self.check()?;
        polled.map(drop).map_err(|error| GpuError::Lost { adapter: self.name(), reason: error.to_string() })
    }

    /// Checks that a buffer may be as large as WebGPU's default limits allow.
    pub(crate) fn check_size(&self, what: &str, bytes: u64) -> Result<(), GpuError> {
        let limits = wgpu::Limits::default();
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if bytes <= limit {
            return Ok(());
        }
        let what = format!("a buffer of bytes for {what}");
        Err(GpuError::Limit { adapter: self.name(), what, needed: bytes, limit })
    }

    /// Takes a number of bytes of the allowed memory.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`] where less is left.
    pub(crate) fn take_memory(&self, what: &str, bytes: u64) -> Result<(), GpuError> {
        let mut memory = self.memory();
        if bytes > memory.most.saturating_sub(memory.used) {
            return Err(GpuError::OutOfMemory { adapter: self.name(), what: what.to_owned(), bytes });
        }
        memory.used += bytes;
        Ok(())
    }

    /// Number of kernels and drawings that were compiled.
    pub fn pipeline_count(&self) -> usize {
        self.shared.kernels.count() + self.shared.drawings.count()
    }

    /// Kernels that were compiled.
    pub(crate) fn kernels(&self) -> &Pipelines<wgpu::ComputePipeline> {
        &self.shared.kernels
    }

    /// Drawings that were compiled.
    pub(crate) fn drawings(&self) -> &Pipelines<wgpu::RenderPipeline> {
        &self.shared.drawings
    }

    pub(crate) fn give_memory_back(&self, bytes: u64) {
        let mut memory = self.memory();
        memory.used = memory.used.saturating_sub(bytes);
    }

    pub(crate) fn name(&self) -> String {
        self.shared.adapter.to_string()
    }

    fn memory(&self) -> MutexGuard<'_, Memory> {
        lock(&self.shared.memory)
    }
}

/// A lock that outlives a panic elsewhere: its content is plain data.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The output of a request that a native system answers at once.
fn at_once<F: Future>(request: F) -> Result<F::Output, GpuError> {
    now(std::pin::pin!(request)).ok_or(GpuError::Page)
}

/// All adapters, the fastest kind first.
async fn adapters() -> Vec<(wgpu::Adapter, Adapter)> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // A page has the last one and no other.
    descriptor.backends = wgpu::Backends::VULKAN
        | wgpu::Backends::METAL
        | wgpu::Backends::DX12
        | wgpu::Backends::BROWSER_WEBGPU;
    // The validation layers of old drivers report false errors.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut found = instance.enumerate_adapters(wgpu::Backends::all()).await;
    found.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    let described = |(index, adapter): (usize, wgpu::Adapter)| {
        let description = Adapter::new(index, &adapter.get_info());
        (adapter, description)
    };
    found.into_iter().enumerate().map(described).collect()
}
