use strandline_body::Pose;
use strandline_gpu::{Bindings, Declaration, Gpu, GpuError};

use super::buffers::Buffers;
use super::{
    GpuState, advance, constrain, gather, integrate, lengths_alone, mark, pcg, pose_roots, solve_pressure,
    solve_rods, splat,
};
use crate::{Drive, Settings, SimError, Solver, State, StepReport};
use strandline_gpu::Scan;

/// A solver whose stages run on a GPU.
///
/// The same settings, rest shape and colliders as a [`Solver`], to which it agrees within rounding,
/// as far as the order of sums and the freshness of contact planes allow. An exact mannequin is
/// sampled every 3 mm, since kernels know grids only.
pub struct GpuSolver {
    pub(super) gpu: Gpu,
    pub(super) solver: Solver,
    pub(super) kernels: Kernels,
    /// Segments of strands that can stretch.
    pub(super) segment_count: usize,
}

pub(super) struct Kernels {
    pub pose_roots: pose_roots::Stage,
    pub integrate: integrate::Stage,
    pub constrain: constrain::Stage,
    pub solve_rods: solve_rods::Stage,
    pub scan: Scan,
    pub splat: splat::Stage,
    pub mark: mark::Stage,
    pub solve_pressure: solve_pressure::Stage,
    pub gather: gather::Stage,
    pub advance: advance::Stage,
}

impl GpuSolver {
    /// Compiles the kernels for a solver.
    ///
    /// # Errors
    /// MIC(0), which is for the CPU only; more than 2,000 iterations of the pressure solve; whatever the
    /// device refuses.
    pub fn new(gpu: &Gpu, solver: Solver) -> Result<Self, SimError> {
        solver.settings.check_on_gpu()?;
        let kernels = Kernels {
            pose_roots: pose_roots::Stage::new(gpu)?,
            integrate: integrate::Stage::new(gpu)?,
            constrain: constrain::Stage::new(gpu, solver.points_per_strand)?,
            solve_rods: solve_rods::Stage::new(gpu)?,
            scan: Scan::new(gpu)?,
            splat: splat::Stage::new(gpu)?,
            mark: mark::Stage::new(gpu)?,
            solve_pressure: solve_pressure::Stage::new(gpu)?,
            gather: gather::Stage::new(gpu)?,
            advance: advance::Stage::new(gpu)?,
        };
        let segment_count = segment_count(&solver);
        Ok(Self { gpu: gpu.clone(), solver, kernels, segment_count })
    }

    /// The solver whose settings, rest shape and colliders these are.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Changes the settings between two steps of a state.
    ///
    /// # Errors
    /// A setting outside its range or MIC(0), then nothing changes; or the device was lost.
    pub fn set_settings(&mut self, settings: &Settings, state: &mut GpuState) -> Result<(), SimError> {
        settings.check_on_gpu()?;
        self.gpu.check()?;
        let had_rods = self.solver.rods.is_some();
        let host = if settings.has_rods() == had_rods {
            None
        } else {
            state.drain(self)?;
            Some(state.to_host(&self.solver)?)
        };
        self.solver.set_settings(settings)?;
        state.unbind();
        match host {
            // Another strand solver has other buffers.
            Some(host) => {
                state.buffers = Buffers::new(&self.gpu, &self.solver, &host)?;
                state.side = 0;
            }
            // Masses may have changed.
            None => state.buffers.write_rest(&self.solver, &state.lengths)?,
        }
        Ok(())
    }

    /// The guides at rest, carried by a pose of the head.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn rest_state(&self, world_from_head: Pose) -> Result<GpuState, SimError> {
        self.upload(&self.solver.rest_state(world_from_head))
    }

    /// Copies a state to the device.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn upload(&self, state: &State) -> Result<GpuState, SimError> {
        let buffers = Buffers::new(&self.gpu, &self.solver, state)?;
        GpuState::new(self, buffers, state)
    }

    /// Waits for the device and copies a state back.
    ///
    /// # Errors
    /// The device was lost.
    pub fn download(&self, state: &GpuState) -> Result<State, SimError> {
        state.to_host(&self.solver)
    }

    /// Advances a state by one step of `settings.time_step`: one submission, which is not waited
    /// for. Now and then, when the device holds as many reports as it can, they are read.
    ///
    /// # Errors
    /// The device has no memory left or was lost; then nothing is known of the state until
    /// [`GpuState::write`] replaces it.
    pub fn step(&self, state: &mut GpuState, drive: &Drive) -> Result<(), SimError> {
        super::step::step(self, state, drive)
    }

    /// Waits for the device and reports all steps since the last call.
    ///
    /// # Errors
    /// The device was lost.
    pub fn reports(&self, state: &mut GpuState) -> Result<Vec<StepReport>, SimError> {
        state.take_reports(self)
    }
}

fn segment_count(solver: &Solver) -> usize {
    let points = solver.points_per_strand;
    let free = |strand: usize, point: usize| {
        let index = strand / strandline_groom::LANES * points + point;
        solver.inverse_mass[index].0[strand % strandline_groom::LANES] > 0.0
    };
    let stretches = |strand: usize| (1..points).filter(move |&p| free(strand, p - 1) || free(strand, p));
    (0..solver.strand_count).map(|strand| stretches(strand).count()).sum()
}

/// Every kernel's declaration, to be held against its shader.
pub fn declarations() -> Vec<Declaration> {
    let mut all = vec![
        pose_roots::PoseRoots::declaration(),
        integrate::Integrate::declaration(),
        constrain::Constrain::declaration(),
        solve_rods::SolveRods::declaration(),
        splat::Bounds::declaration(),
        splat::Follow::declaration(),
        splat::FindCells::declaration(),
        splat::ListPoints::declaration(),
        splat::RankPoints::declaration(),
        splat::SortPoints::declaration(),
        splat::SumFaces::declaration(),
        mark::Mark::declaration(),
        mark::CarryWalls::declaration(),
        solve_pressure::Assemble::declaration(),
        solve_pressure::LevelRooms::declaration(),
        pcg::Search::declaration(),
        pcg::Update::declaration(),
        pcg::SmoothResidual::declaration(),
        pcg::Finish::declaration(),
        solve_pressure::SubtractGradient::declaration(),
        gather::Gather::declaration(),
        advance::Advance::declaration(),
        advance::Gathered::declaration(),
    ];
    all.extend(lengths_alone::declarations());
    all
}

/// What keeps a lost device's error apart from a setting's.
impl SimError {
    /// What keeps a volume of so many cells off the device: the setting, where there is too little room.
    pub(super) fn of_volume(cells: [u32; 3], source: GpuError) -> Self {
        match source {
            GpuError::Limit { .. } | GpuError::OutOfMemory { .. } => Self::Cells { cells, source },
            other => Self::Gpu(other),
        }
    }
}
