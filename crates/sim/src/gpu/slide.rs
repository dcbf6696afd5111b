//! Strands of another length: their points slide along them, between two steps.

use strandline_gpu::{Bindings, Declaration, Gpu, GpuError, Kernel, Recorder, kernel};

use super::buffers::Buffers;
use super::inputs::Step;

kernel! {
    /// One thread is one strand.
    pub(super) struct SlidePoints in "slide" (super::linked::SLIDE), entry "slide" {
        0 step: Read Step,
        3 rest: Read f32,
        4 positions: ReadWrite f32,
    }
}

/// The kernel.
pub(super) struct Slide(Kernel<SlidePoints<'static>>);

impl Slide {
    pub fn declaration() -> Declaration {
        SlidePoints::declaration()
    }

    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[]).map(Self)
    }

    /// Moves the points of the last two states to the lengths of the rest shape.
    pub fn run(&self, gpu: &Gpu, buffers: &Buffers) -> Result<(), GpuError> {
        let Buffers { step, rest, places: [one, other], lane_count, .. } = buffers;
        let bind = |positions| self.0.bind(gpu, &SlidePoints { step, rest, positions });
        let dispatches = [bind(one)?, bind(other)?].map(|bound| bound.over(*lane_count));
        gpu.ask("lengths of strands", || {
            let mut recorder = Recorder::new(gpu, None);
            recorder.stage("slide", &dispatches);
            gpu.queue().submit([recorder.finish(|_| ())]);
        })
    }
}
