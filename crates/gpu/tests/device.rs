//! The kit on a device: results and refusals.

use std::task::{Context, Poll, Waker};

use strandline_gpu::{
    Buffer, Drawing, Gpu, GpuError, Kernel, Output, Readback, Recorder, Timer, drawing, groups, kernel, wgpu,
};

const NUMBERS: &str = "
override FACTOR: u32 = 1u;
@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(64)
fn count(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = (group.x + group.y * groups.x) * 64u + thread;
    if index < arrayLength(&numbers) {
        numbers[index] = index * FACTOR;
    }
}
";

kernel! {
    /// Writes the index of each element, times a factor.
    struct Count in "numbers" (NUMBERS), entry "count" {
        0 numbers: ReadWrite u32,
    }
}

kernel! {
    /// A kernel whose text is wrong.
    struct Broken in "broken" ("@compute @workgroup_size(64)\nfn count() {\n    let x = unknown;\n}"), entry "count" {
        0 numbers: ReadWrite u32,
    }
}

drawing! {
    /// One triangle in the colour of the first number.
    struct Flat in "flat" (
        "@group(0) @binding(0) var<storage, read> numbers: array<u32>;\n\
         @vertex fn corner(@builtin(vertex_index) at: u32) -> @builtin(position) vec4f {\n\
             return vec4f(f32(at & 1u), f32(at >> 1u), 0.0, 1.0);\n\
         }\n\
         @fragment fn flat_color() -> @location(0) vec4f { return vec4f(f32(numbers[0])); }"
    ), vertex "corner", fragment Some("flat_color"), {
        0 numbers: Read u32,
    }
}

/// Any adapter, with a device of its own: some of these tests spoil it.
#[allow(clippy::print_stderr)] // it tells what is not tested
fn gpu() -> Option<Gpu> {
    match Gpu::any() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            eprintln!("not tested on a GPU: {error}");
            None
        }
    }
}

/// The output of a future that is ready, as all of a native system are.
fn at_once<T>(future: impl Future<Output = T>) -> T {
    match std::pin::pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(found) => found,
        Poll::Pending => panic!("a native system answers at once"),
    }
}

/// Counts into a buffer of `len` numbers.
fn count(gpu: &Gpu, len: usize, factor: u32) -> Result<Vec<u32>, GpuError> {
    let numbers = Buffer::new(gpu, "numbers", len)?;
    let bound = Kernel::<Count<'static>>::new(gpu, &[("FACTOR", f64::from(factor))])?
        .bind(gpu, &Count { numbers: &numbers })?;
    gpu.ask("counting", || {
        let mut recorder = Recorder::new(gpu, None);
        recorder.stage("count", &[(bound, groups(len, 64))]);
        gpu.queue().submit([recorder.finish(|_| ())]);
    })?;
    numbers.read()
}

#[test]
fn buffers_come_back_as_they_went() {
    let Some(gpu) = gpu() else { return };
    let buffer = Buffer::from_slice(&gpu, "numbers", &[1.5_f32, -2.0, f32::INFINITY]).unwrap();
    assert_eq!(buffer.read().unwrap(), [1.5, -2.0, f32::INFINITY]);
    assert_eq!(buffer.read_first(2).unwrap(), [1.5, -2.0]);
    assert_eq!(buffer.read_first(9).unwrap().len(), 3);
    buffer.write(&[7.0]).unwrap();
    assert_eq!(buffer.read().unwrap(), [7.0, -2.0, f32::INFINITY]);
    let error = buffer.write(&[0.0; 4]).unwrap_err().to_string();
    assert!(error.contains("numbers"), "{error}");
    let empty = Buffer::<f32>::new(&gpu, "nothing", 0).unwrap();
    assert!(empty.is_empty() && empty.read().unwrap().is_empty());
}

#[test]
fn more_threads_than_a_row_of_workgroups_holds_all_run() {
    let Some(gpu) = gpu() else { return };
    let len = 65_536 * 64 + 5;
    let numbers = count(&gpu, len, 1).unwrap();
    assert!(numbers.iter().enumerate().all(|(index, number)| index as u32 == *number));
}

#[test]
fn constants_reach_the_kernel() {
    let Some(gpu) = gpu() else { return };
    assert_eq!(count(&gpu, 4, 3).unwrap(), [0, 3, 6, 9]);
    // The same kernel with another constant is another kernel.
    assert_eq!(count(&gpu, 4, 5).unwrap(), [0, 5, 10, 15]);
}

#[test]
fn a_device_compiles_each_pipeline_once() {
    let Some(gpu) = gpu() else { return };
    let output = |format| Output { color: Some((format, None)), depth: None };
    let compiled = |factor: f64, format| {
        Kernel::<Count<'static>>::new(&gpu, &[("FACTOR", factor)]).unwrap();
        Drawing::<Flat<'static>>::new(&gpu, &output(format), &[]).unwrap();
        gpu.pipeline_count()
    };
    let (one, other) = (wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba16Float);
    assert_eq!([compiled(1.0, one), compiled(1.0, one)], [2, 2]);
    assert_eq!(compiled(2.0, other), 4, "another constant and another output are others");
}

#[test]
fn a_wrong_shader_is_refused_with_its_module_and_line() {
    let Some(gpu) = gpu() else { return };
    let error = Kernel::<Broken<'static>>::new(&gpu, &[]).unwrap_err();
    assert!(matches!(error, GpuError::Shader { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("module broken") && text.contains(":3:"), "{text}");
    assert_eq!(count(&gpu, 2, 1).unwrap(), [0, 1], "the device continues");
}

#[test]
fn a_buffer_beyond_the_portable_limit_is_refused_before_it_is_made() {
    let Some(gpu) = gpu() else { return };
    let used = gpu.memory_used();
    let error = Buffer::<u32>::new(&gpu, "too much", 1 << 26).unwrap_err();
    let GpuError::Limit { needed, limit, .. } = &error else { panic!("{error:?}") };
    assert_eq!((*needed, *limit), (1 << 28, 1 << 27));
    assert!(error.to_string().contains("too much"), "{error}");
    assert_eq!(gpu.memory_used(), used);
}

#[test]
fn refused_memory_names_what_was_asked_and_leaves_the_rest() {
    let Some(gpu) = gpu() else { return };
    let kept = Buffer::from_slice(&gpu, "kept", &[3_u32]).unwrap();
    gpu.set_memory_limit(gpu.memory_used() + 1000);
    let error = Buffer::<u32>::new(&gpu, "more", 300).unwrap_err();
    let GpuError::OutOfMemory { adapter, what, bytes } = &error else { panic!("{error:?}") };
    assert!(adapter.contains(&gpu.adapter().name));
    assert_eq!((what.as_str(), *bytes), ("more", 1200));
    assert_eq!(kept.read().unwrap(), [3]);
    let small = Buffer::<u32>::new(&gpu, "less", 200).unwrap();
    assert!(Buffer::<u32>::new(&gpu, "less", 200).is_err());
    drop(small);
    assert!(Buffer::<u32>::new(&gpu, "less", 200).is_ok(), "what is dropped can be had again");
}

#[test]
fn a_lost_device_answers_everything_with_an_error() {
    let Some(gpu) = gpu() else { return };
    let numbers = Buffer::from_slice(&gpu, "numbers", &[1_u32, 2]).unwrap();
    let kernel = Kernel::<Count<'static>>::new(&gpu, &[]).unwrap();
    let bound = kernel.bind(&gpu, &Count { numbers: &numbers }).unwrap();
    gpu.destroy();
    // A recording may be made; it goes nowhere.
    let mut recorder = Recorder::new(&gpu, None);
    recorder.stage("count", &[(bound, [1; 3])]);
    drop(recorder);
    let errors = [
        gpu.check().unwrap_err(),
        gpu.wait().unwrap_err(),
        Buffer::<u32>::new(&gpu, "numbers", 4).unwrap_err(),
        numbers.write(&[1]).unwrap_err(),
        numbers.read().unwrap_err(),
        kernel.bind(&gpu, &Count { numbers: &numbers }).unwrap_err(),
        Kernel::<Count<'static>>::new(&gpu, &[("FACTOR", 9.0)]).unwrap_err(),
        gpu.ask("a submission", || gpu.queue().submit([])).unwrap_err(),
        gpu.copy_bandwidth(1).unwrap_err(),
    ];
    for error in errors {
        let GpuError::Lost { adapter, reason } = &error else { panic!("{error:?}") };
        assert!(adapter.contains(&gpu.adapter().name) && !reason.is_empty());
    }
}

/// A write that the device refuses has no error scope: it shows in the next call, once, and the device continues.
#[test]
fn a_refused_write_is_filed_and_reported_once() {
    let Some(gpu) = gpu() else { return };
    let numbers = Buffer::from_slice(&gpu, "numbers", &[1_u32, 2]).unwrap();
    gpu.queue().write_buffer(numbers.raw(), 0, &[0; 64]);
    let error = count(&gpu, 2, 1).unwrap_err();
    assert!(matches!(error, GpuError::Refused { .. }), "{error:?}");
    assert!(error.to_string().contains("writing") && error.to_string().contains("64 bytes"), "{error}");
    gpu.check().unwrap();
    assert_eq!(numbers.read().unwrap(), [1, 2]);
    assert_eq!(count(&gpu, 2, 1).unwrap(), [0, 1]);
}

#[test]
fn a_hosts_own_device_is_taken() {
    let Some(found) = gpu() else { return };
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = at_once(instance.enumerate_adapters(wgpu::Backends::all()));
    let adapter =
        adapters.into_iter().find(|adapter| adapter.get_info().name == found.adapter().name).unwrap();
    let (device, queue) = at_once(adapter.request_device(&Default::default())).unwrap();
    let gpu = Gpu::from_parts(device, queue);
    assert_eq!(count(&gpu, 3, 2).unwrap(), [0, 2, 4]);
    // It was asked for without timestamps.
    assert!(!gpu.has_timestamps() && Timer::new(&gpu).unwrap().is_none());
    // The host gives it up.
    gpu.device().destroy();
    assert!(count(&gpu, 3, 2).is_err());
}

#[test]
fn adapters_are_chosen_by_kind_and_number() {
    let listed = Gpu::list();
    let error = Gpu::open(999).unwrap_err();
    let GpuError::NoAdapter { offered, .. } = &error else { panic!("{error:?}") };
    assert_eq!(offered, &listed);
    for adapter in &listed {
        assert!(error.to_string().contains(&adapter.name), "{error}");
    }
    match Gpu::auto() {
        Ok(gpu) => assert!(!gpu.adapter().software),
        Err(error) => assert!(listed.iter().all(|adapter| adapter.software), "{error}"),
    }
    let kinds: Vec<bool> = listed.iter().map(|adapter| adapter.software).collect();
    assert!(kinds.is_sorted(), "hardware comes first: {listed:?}");
}

#[test]
fn stages_are_timed_and_those_of_one_name_add_up() {
    let Some(gpu) = gpu() else { return };
    let Some(timer) = Timer::new(&gpu).unwrap() else {
        assert!(!gpu.has_timestamps());
        return;
    };
    let numbers = Buffer::new(&gpu, "numbers", 100_000).unwrap();
    let kernel = Kernel::<Count<'static>>::new(&gpu, &[]).unwrap();
    let work = [(kernel.bind(&gpu, &Count { numbers: &numbers }).unwrap(), groups(100_000, 64))];
    let marks = Buffer::<u64>::new(&gpu, "marks", Timer::BYTES as usize / 8).unwrap();
    gpu.ask("timing", || {
        let mut recorder = Recorder::new(&gpu, Some(&timer));
        timer.restart();
        for name in ["first", "second", "first"] {
            recorder.stage(name, &work);
        }
        assert_eq!(recorder.dispatches(), 3);
        gpu.queue().submit([recorder.finish(|encoder| timer.resolve(encoder, marks.raw(), 0))]);
    })
    .unwrap();
    let marks = marks.read().unwrap();
    let seconds = timer.seconds(&marks);
    assert_eq!(seconds.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["first", "second"]);
    assert!(seconds.iter().all(|(_, time)| *time > 0.0 && *time < 10.0), "{seconds:?}");
    let alone = marks[1] - marks[0] + marks[5] - marks[4];
    let period = f64::from(gpu.queue().get_timestamp_period()) * 1e-9;
    assert!((seconds[0].1 - alone as f64 * period).abs() < 1e-12);
}

#[test]
fn a_copy_takes_time() {
    let Some(gpu) = gpu() else { return };
    let used = gpu.memory_used();
    assert!(gpu.copy_bandwidth(1).unwrap() > 1e6);
    assert_eq!(gpu.memory_used(), used);
}

#[test]
fn what_crosses_is_counted() {
    let Some(gpu) = gpu() else { return };
    let before = gpu.crossed();
    let buffer: Buffer<f32> = Buffer::new(&gpu, "numbers", 100).unwrap();
    buffer.write(&[1.0; 60]).unwrap();
    buffer.read_first(10).unwrap();
    let after = gpu.crossed();
    assert_eq!([after.to_device - before.to_device, after.from_device - before.from_device], [240, 40]);
}

/// Callbacks run on whichever thread polled the device, one after the other: the news that a copy has arrived may be
/// late, though the device is done.
#[test]
fn a_copy_whose_news_another_thread_holds_is_waited_for() {
    let Some(gpu) = gpu() else { return };
    // Large, so that the copy is not done when it is submitted.
    let numbers = Buffer::<u32>::new(&gpu, "numbers", 1 << 23).unwrap();
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let descriptor = wgpu::BufferDescriptor { label: None, size: 4, usage, mapped_at_creation: false };
    let unused = gpu.device().create_buffer(&descriptor);
    let mut batch = Readback::new();
    let part = batch.add(&numbers, 1 << 23);
    let transfer = batch.begin(&gpu).unwrap();
    // No submission uses this one, so that its callback comes before that of the copy.
    let (send, received) = std::sync::mpsc::channel();
    unused.slice(..).map_async(wgpu::MapMode::Read, move |_| {
        send.send(()).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(300));
    });
    std::thread::scope(|scope| {
        scope.spawn(|| gpu.wait().unwrap());
        received.recv().unwrap();
        assert_eq!(transfer.wait().unwrap().take(part).len(), 1 << 23);
    });
}
