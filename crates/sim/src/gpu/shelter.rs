//! The air among hair, which hair and solids upwind hold back and which hair carries along.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, kernel};

use super::air_buffers::{ShelterBuffers, WindBox};
use super::inputs::Step;
use super::stage::{StageKernels, Target};
use crate::Model;
use crate::wind::CELLS;

kernel! {
    /// The box; one workgroup.
    pub(super) struct Survey in "shelter" (super::linked::SHELTER), entry "survey", threads (Some(MANY)) {
        0 step: Read Step,
        1 cells: ReadWrite WindBox,
        4 positions: Read f32,
        5 velocities: Read f32,
    }
}

kernel! {
    /// Sums of the cells; one thread is one strand.
    pub(super) struct Deposit in "shelter" (super::linked::SHELTER), entry "deposit" {
        0 step: Read Step,
        1 cells: ReadWrite WindBox,
        2 rods: Read f32,
        3 rest: Read f32,
        4 positions: Read f32,
        5 velocities: Read f32,
        8 sums: ReadWrite u32,
    }
}

kernel! {
    /// Hair and solids of the cells; one thread is one cell.
    pub(super) struct FindContents in "air_cells" (super::linked::AIR_CELLS), entry "find_contents" {
        0 step: Read Step,
        1 cells: Read WindBox,
        2 contents: ReadWrite [f32; 4],
        3 currents: Read [f32; 4],
        8 sums: Read u32,
    }
}

kernel! {
    /// The air from cell to cell; one workgroup.
    pub(super) struct Sweep in "air_cells" (super::linked::AIR_CELLS), entry "sweep", threads (Some(MANY)) {
        0 step: Read Step,
        1 cells: Read WindBox,
        2 contents: ReadWrite [f32; 4],
        6 flow: ReadWrite [f32; 4],
    }
}

kernel! {
    /// Air at the points; one thread is one point.
    pub(super) struct PassPoints in "air_cells" (super::linked::AIR_CELLS), entry "pass_points" {
        0 step: Read Step,
        1 cells: Read WindBox,
        4 positions: Read f32,
        6 flow: ReadWrite [f32; 4],
        7 air: ReadWrite f32,
    }
}

pub(super) struct Stage {
    survey: Kernel<Survey<'static>>,
    deposit: Kernel<Deposit<'static>>,
    find_contents: Kernel<FindContents<'static>>,
    sweep: Kernel<Sweep<'static>>,
    pass_points: Kernel<PassPoints<'static>>,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![
            Survey::declaration(),
            Deposit::declaration(),
            FindContents::declaration(),
            Sweep::declaration(),
            PassPoints::declaration(),
        ]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        Ok(Self {
            survey: Kernel::new(gpu, &[])?,
            deposit: Kernel::new(gpu, &[])?,
            find_contents: Kernel::new(gpu, &[skins_constant(&model.colliders)])?,
            sweep: Kernel::new(gpu, &[])?,
            pass_points: Kernel::new(gpu, &[])?,
        })
    }

    /// Nothing where all air is the wind.
    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let (Some(rods), Some(shelter)) = (&buffers.rods, buffers.shelter()) else { return Ok(Vec::new()) };
        let ShelterBuffers { cells, sums, contents, currents, flow, air } = shelter;
        let (step, positions, velocities) = (&buffers.step, &buffers.places[side], &buffers.velocities);
        let survey = self.survey.bind(gpu, &Survey { step, cells, positions, velocities })?;
        let deposit =
            Deposit { step, cells, rods: &rods.nodes, rest: &buffers.rest, positions, velocities, sums };
        let find_contents = FindContents { step, cells, contents, currents, sums };
        let sweep = self.sweep.bind(gpu, &Sweep { step, cells, contents, flow })?;
        let points = PassPoints { step, cells, positions, flow, air };
        Ok(vec![
            (survey, [1; 3]),
            self.deposit.bind(gpu, &deposit)?.over(buffers.strand_count),
            self.find_contents.bind(gpu, &find_contents)?.over(CELLS),
            (sweep, [1; 3]),
            self.pass_points.bind(gpu, &points)?.over(buffers.point_count()),
        ])
    }
}
