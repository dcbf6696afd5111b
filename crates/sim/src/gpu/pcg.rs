//! Preconditioned conjugate gradients on the device.

use strandline_gpu::{Bindings, Buffer, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, kernel};

use super::inputs::Step;
use super::records::{PressureState, Spread};
use super::volume::{GridState, Volume};
use crate::Preconditioner;
use crate::chebyshev::CHEBYSHEV_STEPS;

kernel! {
    /// The next direction and its image.
    pub(super) struct Search in "pcg" (super::linked::PCG), entry "search" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        6 unknowns: Read u32,
    }
}

kernel! {
    /// A step along it.
    pub(super) struct Update in "pcg" (super::linked::PCG), entry "update" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        6 unknowns: Read u32,
    }
}

kernel! {
    /// A further step of the preconditioner.
    pub(super) struct SmoothResidual in "pcg" (super::linked::PCG), entry "smooth_residual" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        6 unknowns: Read u32,
    }
}

kernel! {
    /// All that is left; one workgroup.
    pub(super) struct Finish in "pcg" (super::linked::PCG), entry "finish", threads (Some(MANY)) {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        6 unknowns: Read u32,
    }
}

/// Rounds over many workgroups before one finishes, with the polynomial and without: about what hair
/// needs, since a round that has nothing left to do is not free. Even numbers, so that the state ends
/// where it began.
const ROUNDS: [usize; 2] = [16, 32];
/// Cells up to which one workgroup does it all: 32 x 32 x 32 and their ring.
const SMALL: usize = 34 * 34 * 34;

pub(super) struct Pcg {
    search: [Kernel<Search<'static>>; 2],
    update: [Kernel<Update<'static>>; 2],
    /// Shape `[degree][side]`.
    smooth: Vec<[Kernel<SmoothResidual<'static>>; 2]>,
    finish: Kernel<Finish<'static>>,
}

impl Pcg {
    pub fn declarations() -> [Declaration; 4] {
        [Search::declaration(), Update::declaration(), SmoothResidual::declaration(), Finish::declaration()]
    }

    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let smooth = |degree: usize| -> Result<_, GpuError> {
            let kernel = |side| Kernel::new(gpu, &[("SIDE", side), ("DEGREE", degree as f64)]);
            Ok([kernel(0.0)?, kernel(1.0)?])
        };
        Ok(Self {
            search: [Kernel::new(gpu, &[("SIDE", 0.0)])?, Kernel::new(gpu, &[("SIDE", 1.0)])?],
            update: [Kernel::new(gpu, &[("SIDE", 0.0)])?, Kernel::new(gpu, &[("SIDE", 1.0)])?],
            smooth: (1..CHEBYSHEV_STEPS).map(smooth).collect::<Result<_, _>>()?,
            finish: Kernel::new(gpu, &[])?,
        })
    }

    pub fn bind(
        &self,
        gpu: &Gpu,
        step: &Buffer<Step>,
        volume: &Volume,
        preconditioner: Preconditioner,
    ) -> Result<Dispatches, GpuError> {
        let Volume { grid, vectors, neighbours, states, unknowns, .. } = volume;
        let mut dispatches = Vec::new();
        let many = match volume.spread {
            Spread::Auto => volume.cell_count > SMALL,
            Spread::One => false,
            Spread::Many => true,
        };
        if many {
            dispatches = self.rounds(gpu, step, volume, preconditioner)?;
        }
        let finish = Finish { step, grid, vectors, neighbours, states, unknowns };
        dispatches.push((self.finish.bind(gpu, &finish)?, [1; 3]));
        Ok(dispatches)
    }

    /// The rounds over many workgroups.
    fn rounds(
        &self,
        gpu: &Gpu,
        step: &Buffer<Step>,
        volume: &Volume,
        preconditioner: Preconditioner,
    ) -> Result<Dispatches, GpuError> {
        let Volume { grid, vectors, neighbours, states, partials, unknowns, .. } = volume;
        let workgroups = [(partials.len() / 2) as u32, 1, 1];
        let polynomial = matches!(preconditioner, Preconditioner::Auto | Preconditioner::Chebyshev);
        let degrees = if polynomial { self.smooth.len() } else { 0 };
        let count = if polynomial { ROUNDS[0] } else { ROUNDS[1] };
        let mut sides = [Vec::new(), Vec::new()];
        for (side, dispatches) in sides.iter_mut().enumerate() {
            let update = Update { step, grid, vectors, states, partials, unknowns };
            dispatches.push((self.update[side].bind(gpu, &update)?, workgroups));
            for kernels in &self.smooth[..degrees] {
                let smooth = SmoothResidual { step, grid, vectors, neighbours, states, partials, unknowns };
                dispatches.push((kernels[side].bind(gpu, &smooth)?, workgroups));
            }
            let search = Search { step, grid, vectors, neighbours, states, partials, unknowns };
            dispatches.push((self.search[side].bind(gpu, &search)?, workgroups));
        }
        // A side: update and smooth with its state, then search from it to the other.
        let mut rounds: Dispatches = (0..count).flat_map(|round| sides[round % 2].clone()).collect();
        let last = sides[0].len() - 1;
        rounds.extend_from_slice(&sides[0][..last]);
        Ok(rounds)
    }
}
