//! Cells of a one-sided volume that are packed.

use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Lanes};

use super::volume::Volume;
use crate::cells::Kind;
use crate::cells::packing::PACKED;

impl Volume {
    /// Density \[kg/m^3\] around the middle of a cell, from the masses that `splat` leaves on its six faces.
    fn density(&self, cell: usize) -> f32 {
        let (strides, size) = (self.grid.strides(), self.grid.spacing());
        let on = |axis: usize, cell: usize| self.faces.change(axis, cell);
        let sum: f32 = (0..3).map(|axis| on(axis, cell) + on(axis, cell + strides[axis])).sum();
        sum / (6.0 * size * size * size)
    }

    /// Leaves fluid, of the cells that hold hair, those that are packed by the end of a step of `time_step` \[s\], and takes the
    /// masses from the faces, whose velocities have not changed yet.
    pub(super) fn loosen(&mut self, rest: &[Lanes], time_step: f32) {
        let part = time_step / self.grid.spacing();
        let is_packed = |index: usize, cell: usize| {
            let points = self.sort.points_of(index).iter().map(|point| *point as usize);
            let at_rest = points.map(|point| rest[point / LANES].0[point % LANES]).fold(0.0, f32::max);
            let gains = 1.0 + part * (-self.divergence(cell)).max(0.0);
            self.density(cell) * gains > PACKED * at_rest
        };
        let cells = self.sort.cells().par_iter().enumerate().with_min_len(256);
        let loose = cells.filter(|(index, cell)| !is_packed(*index, **cell as usize));
        let loose: Vec<u32> = loose.map(|(_, cell)| *cell).collect();
        for cell in loose {
            if self.kinds[cell as usize] == Kind::Fluid {
                self.kinds[cell as usize] = Kind::Air;
            }
        }
        for component in &mut self.faces.components {
            for &cell in &self.touched {
                component[2 * cell as usize + 1] = 0.0;
            }
        }
    }
}
