//! State shared by the volume stages: the moving box, the sorted points, the staggered faces.

use strandline_groom::LANES;

use super::faces::{Carried, Faces};
use super::pcg::{Pcg, Solution};
use super::poisson::Poisson;
use crate::VolumeSettings;
use crate::cells::set::CellSet;
use crate::cells::{CellSort, Contents, Grid, Kind};

/// The fluid volume [Chen2011 §4.2, McAdams2009]. Its memory is kept from step to step; what a step
/// costs follows the cells that hold hair, not the size of the box.
#[derive(Clone, Debug)]
pub struct Volume {
    pub(super) settings: VolumeSettings,
    pub(super) points_per_strand: usize,
    pub(super) strand_count: usize,
    /// The moving box.
    pub grid: Grid,
    /// Points sorted by cell.
    pub sort: CellSort,
    /// Velocities on the faces.
    pub faces: Faces,
    pub(super) cell_of_point: Vec<u32>,
    /// Transferred quantities of each point, shape `[block][point]` of lanes.
    pub(super) brought: Vec<Carried>,
    /// The same in the order of their cells.
    pub(super) carried: Vec<Carried>,
    /// Cells whose lower faces points may reach, ascending.
    pub(super) touched: Vec<u32>,
    pub(super) touched_set: CellSet,
    pub(super) spare_set: CellSet,
    /// Kind of each cell; cells that are not listed in `marked` are air.
    pub(super) kinds: Vec<Kind>,
    pub(super) marked: Vec<u32>,
    /// Signed distance \[m\] at the middle of every fluid cell, or a lower bound of it; of other cells an old one.
    pub(super) distances: Vec<f32>,
    /// Cells whose pressure is unknown, ascending.
    pub(super) fluid: Vec<u32>,
    pub(super) system: Poisson,
    pub(super) pcg: Pcg,
    pub(super) solution: Solution,
}

impl Volume {
    /// A volume for strands of `points_per_strand` points.
    pub fn new(settings: &VolumeSettings, strand_count: usize, points_per_strand: usize) -> Self {
        let grid = Grid::new(settings.cells.map(|count| count as usize));
        let count = grid.cell_count();
        Self {
            settings: *settings,
            points_per_strand,
            strand_count,
            sort: CellSort::new(count),
            faces: Faces::new(count),
            cell_of_point: Vec::new(),
            brought: Vec::new(),
            carried: Vec::new(),
            touched: Vec::new(),
            touched_set: CellSet::new(count),
            spare_set: CellSet::new(count),
            kinds: vec![Kind::Air; count],
            marked: Vec::new(),
            distances: vec![0.0; count],
            fluid: Vec::new(),
            system: Poisson::default(),
            pcg: Pcg::default(),
            solution: Solution::default(),
            grid,
        }
    }

    /// Takes over settings; the box is made again when its cells change.
    pub fn keep_or_new(
        old: Option<Self>,
        settings: &VolumeSettings,
        strand_count: usize,
        points: usize,
    ) -> Self {
        match old {
            Some(old) if old.settings.cells == settings.cells => Self { settings: *settings, ..old },
            _ => Self::new(settings, strand_count, points),
        }
    }

    /// The kind of a cell.
    pub fn kind(&self, cell: usize) -> Kind {
        self.kinds[cell]
    }

    /// Overrides the kind of a cell, so that tests can build closed cavities.
    pub fn set_kind(&mut self, cell: usize, kind: Kind) {
        let number = cell as u32;
        self.kinds[cell] = kind;
        match (self.fluid.binary_search(&number), kind) {
            (Err(place), Kind::Fluid) => self.fluid.insert(place, number),
            (Ok(place), Kind::Air | Kind::Solid) => {
                self.fluid.remove(place);
            }
            _ => {}
        }
        if let Err(place) = self.marked.binary_search(&number) {
            self.marked.insert(place, number);
        }
    }

    /// The cells whose pressure is unknown, ascending.
    pub fn fluid(&self) -> &[u32] {
        &self.fluid
    }

    /// Pressure times step over density and cell size \[m/s\] of each fluid cell, with a zero behind
    /// the last.
    pub fn pressure(&self) -> &[f32] {
        &self.solution.values
    }

    /// True if a lane of a block is a strand and not a repetition of the last one.
    #[inline]
    pub(super) fn is_live(&self, block: usize, lane: usize) -> bool {
        block * LANES + lane < self.strand_count
    }

    /// The box, the faces and the kinds of all cells.
    pub fn contents(&self) -> Contents {
        let cells = self.grid.cell_count();
        let face = |index: usize| {
            let (axis, cell) = (index / cells, index % cells);
            [self.faces.velocity(axis, cell), self.faces.change(axis, cell)]
        };
        Contents {
            grid: self.grid.clone(),
            faces: (0..3 * cells).map(face).collect(),
            kinds: (0..cells).map(|cell| self.kind(cell)).collect(),
        }
    }

    /// Largest divergence of a fluid cell: what flows out of it, over the area of a face \[m/s\].
    pub fn largest_divergence(&self) -> f32 {
        self.fluid.iter().map(|&cell| self.divergence(cell as usize).abs()).fold(0.0, f32::max)
    }

    /// Flow out of a cell, over the area of a face \[m/s\] [Chen2011 eq. 19].
    #[inline]
    pub(super) fn divergence(&self, cell: usize) -> f32 {
        let strides = self.grid.strides();
        (0..3)
            .map(|axis| self.faces.velocity(axis, cell + strides[axis]) - self.faces.velocity(axis, cell))
            .sum()
    }
}
