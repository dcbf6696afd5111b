//! The pressure that takes the divergence out of the hair's velocity, without a readback.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, kernel};

use super::inputs::Step;
use super::pcg::Pcg;
use super::records::{Gradient, PressureState};
use super::stage::{StageKernels, Target};
use super::volume::{GridState, Volume};
use crate::Model;

kernel! {
    /// Rows of the system; one thread is one cell.
    pub(super) struct Assemble in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "assemble" {
        0 step: Read Step,
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 states: ReadWrite PressureState,
        5 kinds: Read u32,
        6 unknowns: Read u32,
        7 faces: ReadWrite [f32; 2],
    }
}

kernel! {
    /// Rooms without a way to air; one workgroup.
    pub(super) struct LevelRooms in "rooms" (super::linked::ROOMS), entry "level_rooms", threads (Some(MANY)) {
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        4 unknowns: Read u32,
        5 rooms: ReadWrite u32,
    }
}

kernel! {
    /// The gradient, all components or one; one thread is one cell.
    pub(super) struct SubtractGradient in "solve_pressure" (super::linked::SOLVE_PRESSURE), entry "subtract_gradient" {
        1 grid: Read GridState,
        2 vectors: ReadWrite f32,
        3 neighbours: ReadWrite u32,
        5 kinds: Read u32,
        6 unknowns: Read u32,
        7 faces: ReadWrite [f32; 2],
    }
}

pub(super) struct Stage {
    assemble: Kernel<Assemble<'static>>,
    level_rooms: Kernel<LevelRooms<'static>>,
    pcg: Pcg,
    gradient: Kernel<SubtractGradient<'static>>,
    gradient_along: [Kernel<SubtractGradient<'static>>; 3],
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        let mut all =
            vec![Assemble::declaration(), LevelRooms::declaration(), SubtractGradient::declaration()];
        all.extend(Pcg::declarations());
        all
    }

    fn new(gpu: &Gpu, _: &Model) -> Result<Self, GpuError> {
        let gradient = |axes: f64| Kernel::new(gpu, &[("AXES", axes)]);
        Ok(Self {
            assemble: Kernel::new(gpu, &[])?,
            level_rooms: Kernel::new(gpu, &[])?,
            pcg: Pcg::new(gpu)?,
            gradient: gradient(7.0)?,
            gradient_along: [gradient(1.0)?, gradient(2.0)?, gradient(4.0)?],
        })
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, scan, preconditioner, .. } = *to;
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let Volume { grid, vectors, neighbours, states, kinds, unknowns, faces, rooms, .. } = volume;
        let mut dispatches = scan.bind(gpu, unknowns, &volume.totals)?;
        let step = &buffers.step;
        let assemble = Assemble { step, grid, vectors, neighbours, states, kinds, unknowns, faces };
        dispatches.push(self.assemble.bind(gpu, &assemble)?.over(volume.cell_count));
        let level = LevelRooms { grid, vectors, neighbours, unknowns, rooms };
        dispatches.push((self.level_rooms.bind(gpu, &level)?, [1; 3]));
        dispatches.extend(self.pcg.bind(gpu, &buffers.step, volume, preconditioner)?);
        dispatches.extend(self.bind_gradient(gpu, volume, volume.gradient)?);
        Ok(dispatches)
    }
}

impl Stage {
    /// Subtracting the gradient alone, in a form.
    pub fn bind_gradient(&self, gpu: &Gpu, volume: &Volume, form: Gradient) -> Result<Dispatches, GpuError> {
        let Volume { grid, vectors, neighbours, kinds, unknowns, faces, .. } = volume;
        let buffers = SubtractGradient { grid, vectors, neighbours, kinds, unknowns, faces };
        let kernels = match form {
            Gradient::Joint => std::slice::from_ref(&self.gradient),
            Gradient::Split => &self.gradient_along,
        };
        kernels.iter().map(|kernel| Ok(kernel.bind(gpu, &buffers)?.over(volume.cell_count))).collect()
    }
}
