//! Distance constraints and nothing else, in two forms to be timed against each other [Chen2011 fig. 16-17].

use strandline_gpu::{Bindings, Buffer, Gpu, GpuError, Kernel, Recorder, Timer, groups, kernel};

kernel! {
    /// One thread is one strand.
    pub(super) struct StrandAThread in "lengths_alone" (super::linked::LENGTHS_ALONE), entry "strand_a_thread", threads (None) {
        0 points: Read [f32; 4],
        1 lengths: Read f32,
        2 placed: ReadWrite [f32; 4],
    }
}

kernel! {
    /// One thread is one point.
    pub(super) struct PointAThread in "lengths_alone" (super::linked::LENGTHS_ALONE), entry "point_a_thread", threads (None) {
        0 points: Read [f32; 4],
        1 lengths: Read f32,
        2 placed: ReadWrite [f32; 4],
    }
}

/// Work of a thread when lengths are projected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthsForm {
    /// One strand, as in `constrain`.
    Strand,
    /// One point, as in the thesis; as many strands share a workgroup as fill 128 threads.
    Point,
}

/// Strands to be projected.
#[derive(Clone, Copy, Debug)]
pub struct LengthsInput<'a> {
    /// Position \[m\] and inverse mass \[1/kg\], shape `[strand][point]`.
    pub points: &'a [[f32; 4]],
    /// Length \[m\] of the segment that begins at a point, same shape; a strand's last is not used.
    pub lengths: &'a [f32],
    /// Points of a strand, 2 to 128.
    pub points_per_strand: usize,
    /// Rounds over both sets of segments.
    pub rounds: u32,
}

/// Projects the lengths of strands `count` times from the same start, to measure the time of a form.
///
/// Returns the points as they are then, and seconds of one time by the device's own clock, where it offers
/// timestamps.
///
/// # Errors
/// The device has no memory left or was lost.
///
/// # Panics
/// Numbers of points or lengths that do not fit each other.
pub fn lengths_alone(
    gpu: &Gpu,
    input: &LengthsInput,
    form: LengthsForm,
    count: usize,
) -> Result<(Vec<[f32; 4]>, Option<f64>), GpuError> {
    let per_strand = input.points_per_strand;
    assert!((2..=128).contains(&per_strand), "{per_strand} points of a strand");
    assert!(input.points.len().is_multiple_of(per_strand) && input.points.len() == input.lengths.len());
    let buffers = [
        Buffer::from_slice(gpu, "points", input.points)?,
        Buffer::new(gpu, "placed points", input.points.len())?,
    ];
    let [points, placed] = &buffers;
    let lengths = &Buffer::from_slice(gpu, "lengths", input.lengths)?;
    // 16 KiB of a workgroup hold 1,024 points.
    let (strands, threads) = match form {
        LengthsForm::Strand => {
            let strands = 1_usize << (1024 / per_strand).min(64).ilog2();
            (strands, strands)
        }
        LengthsForm::Point => (128 / per_strand, 128 / per_strand * per_strand),
    };
    let constants = [
        ("POINTS", per_strand as f64),
        ("STRANDS", strands as f64),
        ("THREADS_OF_GROUP", threads as f64),
        ("ROUNDS", f64::from(input.rounds)),
    ];
    let bound = match form {
        LengthsForm::Strand => {
            Kernel::new(gpu, &constants)?.bind(gpu, &StrandAThread { points, lengths, placed })?
        }
        LengthsForm::Point => {
            Kernel::new(gpu, &constants)?.bind(gpu, &PointAThread { points, lengths, placed })?
        }
    };
    let dispatches = vec![(bound, groups(input.points.len() / per_strand, strands)); count];
    let timer = Timer::new(gpu)?;
    let marks = Buffer::<u64>::new(gpu, "times of lengths", Timer::BYTES as usize / size_of::<u64>())?;
    gpu.ask("lengths alone", || {
        let mut recorder = Recorder::new(gpu, timer.as_ref());
        recorder.stage("constrain", &dispatches);
        let recorded = recorder.finish(|encoder| {
            if let Some(timer) = &timer {
                timer.resolve(encoder, marks.raw(), 0);
            }
        });
        gpu.queue().submit([recorded]);
    })?;
    let marks = marks.read()?;
    let seconds = |timer: &Timer| timer.seconds(&marks).iter().map(|(_, seconds)| seconds).sum::<f64>();
    Ok((placed.read()?, timer.as_ref().map(|timer| seconds(timer) / count.max(1) as f64)))
}

/// Declarations of both kernels.
pub(super) fn declarations() -> [strandline_gpu::Declaration; 2] {
    [StrandAThread::declaration(), PointAThread::declaration()]
}
