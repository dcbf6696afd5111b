//! The compiled kernels of all stages.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Scan};

use super::buffers::Buffers;
use super::{
    advance, constrain, gather, integrate, lengths_alone, mark, pcg, pose_roots, solve_pressure, solve_rods,
    splat,
};
use crate::Preconditioner;
use crate::step::Stage;

pub(super) struct Kernels {
    scan: Scan,
    pose_roots: pose_roots::Stage,
    integrate: integrate::Stage,
    constrain: constrain::Stage,
    solve_rods: solve_rods::Stage,
    splat: splat::Stage,
    mark: mark::Stage,
    pub solve_pressure: solve_pressure::Stage,
    gather: gather::Stage,
    advance: advance::Stage,
}

impl Kernels {
    pub fn new(gpu: &Gpu, points_per_strand: usize) -> Result<Self, GpuError> {
        Ok(Self {
            scan: Scan::new(gpu)?,
            pose_roots: pose_roots::Stage::new(gpu)?,
            integrate: integrate::Stage::new(gpu)?,
            constrain: constrain::Stage::new(gpu, points_per_strand)?,
            solve_rods: solve_rods::Stage::new(gpu)?,
            splat: splat::Stage::new(gpu)?,
            mark: mark::Stage::new(gpu)?,
            solve_pressure: solve_pressure::Stage::new(gpu)?,
            gather: gather::Stage::new(gpu)?,
            advance: advance::Stage::new(gpu)?,
        })
    }

    /// Binds a stage to buffers, for the steps that start with the newer positions on a side.
    pub fn bind(
        &self,
        stage: Stage,
        gpu: &Gpu,
        buffers: &Buffers,
        side: usize,
        preconditioner: Preconditioner,
    ) -> Result<Dispatches, GpuError> {
        match stage {
            Stage::PoseRoots => self.pose_roots.bind(gpu, buffers, side),
            Stage::Integrate => self.integrate.bind(gpu, buffers, side),
            Stage::Constrain => self.constrain.bind(gpu, buffers, side),
            Stage::SolveRods => self.solve_rods.bind(gpu, buffers, side),
            Stage::Splat => self.splat.bind(gpu, buffers, &self.scan, side),
            Stage::Mark => self.mark.bind(gpu, buffers),
            Stage::SolvePressure => self.solve_pressure.bind(gpu, buffers, &self.scan, preconditioner),
            Stage::Gather => self.gather.bind(gpu, buffers, side),
            Stage::Advance => self.advance.bind(gpu, buffers, side),
        }
    }
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
