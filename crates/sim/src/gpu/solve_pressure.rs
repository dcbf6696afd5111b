//! The pressure that takes the divergence out of the hair's velocity, without a readback.

use strandline_gpu::{Gpu, GpuError, Kernel, groups, kernel, mirror};

use super::scan::Scan;
use super::uniform::Step;
use super::volume::{GridState, Volume};
use super::{Buffers, Dispatches, THREADS};
use crate::cpu::pcg::CHEBYSHEV_STEPS;
use crate::{Preconditioner, PressureReport};

mirror! {
    /// Where the solve stands. Mirrors `PressureState` in pressure.wesl.
    pub struct PressureState {
        /// Residual in the preconditioner's norm.
        pub rate: f32,
        /// Largest component of the residual \[m/s\].
        pub residual: f32,
        /// The same before the first iteration.
        pub first: f32,
        /// 1 once there is nothing left to do.
        pub done: u32,
        /// Iterations so far.
        pub iterations: u32,
        /// Iterations until the tolerance was met as an absolute one.
        pub iterations_absolute: u32,
        /// Unknowns.
        pub fluid_cells: u32,
        /// 1 once it was met.
        pub met: u32,
    }
}

impl From<PressureState> for PressureReport {
    fn from(state: PressureState) -> Self {
        let solved = state.fluid_cells > 0 && state.first > 0.0;
        Self {
            iterations: state.iterations as usize,
            iterations_absolute: state.iterations_absolute as usize,
            relative_residual: if solved { state.residual / state.first } else { 0.0 },
            absolute_residual: state.residual,
            fluid_cells: state.fluid_cells as usize,
        }
    }
}

kernel! {
    /// Rows of the system; one thread is one cell.
    pub(super) struct Assemble in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "assemble" {
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        6 kinds: Read u32,
        7 unknowns: Read u32,
        8 faces: ReadWrite [f32; 2],
    }
}

kernel! {
    /// Rooms without a way to air; one workgroup.
    pub(super) struct LevelRooms in "rooms" (super::linked::ROOMS), entry "level_rooms" {
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 unknowns: Read u32,
        5 rooms: ReadWrite u32,
    }
}

kernel! {
    /// The next direction and its image.
    pub(super) struct Search in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "search" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        7 unknowns: Read u32,
    }
}

kernel! {
    /// A step along it.
    pub(super) struct Update in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "update" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        7 unknowns: Read u32,
    }
}

kernel! {
    /// A further step of the preconditioner.
    pub(super) struct SmoothResidual in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "smooth_residual" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        5 partials: ReadWrite [f32; 4],
        7 unknowns: Read u32,
    }
}

kernel! {
    /// All that is left; one workgroup.
    pub(super) struct Finish in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "finish" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        7 unknowns: Read u32,
    }
}

kernel! {
    /// The gradient, all components or one; one thread is one cell.
    pub(super) struct SubtractGradient in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "subtract_gradient" {
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        6 kinds: Read u32,
        7 unknowns: Read u32,
        8 faces: ReadWrite [f32; 2],
    }
}

/// How the gradient is subtracted [Chen2011 table 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gradient {
    /// One kernel for all components.
    #[default]
    Joint,
    /// A kernel for each component.
    Split,
}

/// Where the solve runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spread {
    /// Small grids on one workgroup, others on many.
    #[default]
    Auto,
    /// On one workgroup.
    One,
    /// On many.
    Many,
}

/// Rounds over many workgroups before one finishes, with the polynomial and without: about what hair
/// needs, since a round that has nothing left to do is not free. Even numbers, so that the state ends
/// where it began.
const ROUNDS: [usize; 2] = [16, 32];
/// Cells up to which one workgroup does it all: 32 x 32 x 32 and their ring.
const SMALL: usize = 34 * 34 * 34;
/// Most workgroups of a round: each sums what all of them found.
pub(super) const MOST_WORKGROUPS: usize = 256;

pub(super) struct Stage {
    assemble: Kernel<Assemble<'static>>,
    level_rooms: Kernel<LevelRooms<'static>>,
    search: [Kernel<Search<'static>>; 2],
    update: [Kernel<Update<'static>>; 2],
    /// Shape `[degree][side]`.
    smooth: Vec<[Kernel<SmoothResidual<'static>>; 2]>,
    finish: Kernel<Finish<'static>>,
    gradient: Kernel<SubtractGradient<'static>>,
    gradient_along: [Kernel<SubtractGradient<'static>>; 3],
}

impl Stage {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let smooth = |degree: usize| -> Result<_, GpuError> {
            let kernel = |side| Kernel::new(gpu, &[("SIDE", side), ("DEGREE", degree as f64)]);
            Ok([kernel(0.0)?, kernel(1.0)?])
        };
        let gradient = |axes: f64| Kernel::new(gpu, &[("AXES", axes)]);
        Ok(Self {
            assemble: Kernel::new(gpu, &[])?,
            level_rooms: Kernel::new(gpu, &[])?,
            search: [Kernel::new(gpu, &[("SIDE", 0.0)])?, Kernel::new(gpu, &[("SIDE", 1.0)])?],
            update: [Kernel::new(gpu, &[("SIDE", 0.0)])?, Kernel::new(gpu, &[("SIDE", 1.0)])?],
            smooth: (1..CHEBYSHEV_STEPS).map(smooth).collect::<Result<_, _>>()?,
            finish: Kernel::new(gpu, &[])?,
            gradient: gradient(7.0)?,
            gradient_along: [gradient(1.0)?, gradient(2.0)?, gradient(4.0)?],
        })
    }

    pub fn bind(
        &self,
        gpu: &Gpu,
        buffers: &Buffers,
        scan: &Scan,
        preconditioner: Preconditioner,
    ) -> Result<Dispatches, GpuError> {
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let by_cell = groups(volume.cell_count, THREADS);
        let Volume { grid, vectors, neighbours, states, kinds, unknowns, faces, rooms, .. } = volume;
        let mut dispatches = scan.bind(gpu, unknowns, &volume.totals)?;
        let assemble = Assemble { grid, vectors, neighbours, states, kinds, unknowns, faces };
        dispatches.push((self.assemble.bind(gpu, &assemble)?, by_cell));
        let level = LevelRooms { grid, vectors, neighbours, unknowns, rooms };
        dispatches.push((self.level_rooms.bind(gpu, &level)?, [1; 3]));
        let many = match volume.spread {
            Spread::Auto => volume.cell_count > SMALL,
            Spread::One => false,
            Spread::Many => true,
        };
        if many {
            dispatches.extend(self.rounds(gpu, &buffers.step, volume, preconditioner)?);
        }
        let finish = Finish { step: &buffers.step, grid, vectors, neighbours, states, unknowns };
        dispatches.push((self.finish.bind(gpu, &finish)?, [1; 3]));
        let gradient = SubtractGradient { grid, vectors, neighbours, kinds, unknowns, faces };
        match volume.gradient {
            Gradient::Joint => dispatches.push((self.gradient.bind(gpu, &gradient)?, by_cell)),
            Gradient::Split => {
                for kernel in &self.gradient_along {
                    dispatches.push((kernel.bind(gpu, &gradient)?, by_cell));
                }
            }
        }
        Ok(dispatches)
    }

    /// The rounds over many workgroups.
    fn rounds(
        &self,
        gpu: &Gpu,
        step: &strandline_gpu::Buffer<Step>,
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
