//! `solve_pressure`: the pressure that takes the divergence out of the hair's velocity.

use strandline_base::par::prelude::*;

use super::faces::change_by;
use super::pcg::PcgSettings;
use super::volume::Volume;
use crate::PressureReport;
use crate::cells::Kind;

/// Solves for the pressure of the fluid cells and subtracts its gradient, one component at a time
/// [Chen2011 eq. 4, 19-24].
///
/// The unknown is the pressure times step over density and cell size \[m/s\], so that neither the
/// step nor the size of a cell enters the system.
pub fn solve_pressure(volume: &mut Volume) -> PressureReport {
    let strides = volume.grid.strides();
    volume.system.assemble(&volume.fluid, &volume.kinds, strides);
    let mut right = std::mem::take(&mut volume.solution.right);
    // Without a right side below 0 no pressure is below 0: the system's inverse has no negative number.
    let least = if volume.settings.is_one_sided() { 0.0 } else { f32::NEG_INFINITY };
    let divergence = |&cell: &u32| (-volume.divergence(cell as usize)).max(least);
    volume.fluid.par_iter().with_min_len(512).map(divergence).collect_into_vec(&mut right);
    volume.solution.right = right;
    let settings = PcgSettings {
        preconditioner: volume.settings.preconditioner,
        tolerance: volume.settings.tolerance,
        max_iterations: volume.settings.max_iterations,
    };
    let Volume { system, pcg, solution, .. } = volume;
    let report = pcg.solve(system, &settings, solution);
    subtract_gradients(volume);
    report
}

/// Subtracts the gradient along each axis from the faces of fluid cells.
fn subtract_gradients(volume: &mut Volume) {
    let strides = volume.grid.strides();
    let Volume { faces, fluid, kinds, system, solution, .. } = volume;
    let pressure = &solution.values;
    faces.components.par_iter_mut().enumerate().for_each(|(axis, component)| {
        let stride = strides[axis];
        for (unknown, &cell) in fluid.iter().enumerate() {
            let cell = cell as usize;
            let before = system.lower[unknown][axis] as usize;
            if kinds[cell - stride] != Kind::Solid {
                change_by(component, cell, pressure[before] - pressure[unknown]);
            }
            // The face to a fluid cell behind is that cell's lower face.
            if kinds[cell + stride] == Kind::Air {
                change_by(component, cell + stride, pressure[unknown]);
            }
        }
    });
}
