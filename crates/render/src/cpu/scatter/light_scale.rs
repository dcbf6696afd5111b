//! Scales of straight light: part of `light_grid`.
//!
//! Layers of a shadow map end some way behind the first hair, and hair behind them hides nothing; the cells hold
//! all hair. So the light that meets hair by the maps is scaled, as a whole, to what the cells let through.

use glam::Vec3;
use strandline_base::par::prelude::*;

use super::light_carry::{Carried, MEAN_COSINE};
use super::light_scene::Cell;
use super::occlusion::GridBox;
use crate::Light;

/// Least and greatest scale. No scale makes light brighter, since things outside the cells hide hair in the maps alone.
const LEAST_SCALE: f32 = 0.8;
const MOST_SCALE: f32 = 1.0;

/// Factor of each light, of which a share reaches the hair of a cell by the maps.
pub(super) fn light_scales(
    grid: &GridBox,
    cells: &[Cell],
    carried: &Carried,
    lights: &[Light],
    reached: &(impl Fn(&Cell, usize) -> f32 + Sync),
) -> Vec<f32> {
    let low = grid.middle(0);
    let middle = low + (grid.middle(grid.cell_count().saturating_sub(1)) - low) * 0.5;
    let scale = |(light, source): (usize, &Light)| {
        if !source.shadow {
            return 1.0;
        }
        let direction = -source.at(middle).to_light;
        let (mut by_cells, mut by_maps) = (0.0, 0.0);
        for (cell, passed) in cells.iter().zip(carried.reached(cells, direction)) {
            if cell.hair > 0.0 {
                let area = f64::from(met(cell, direction));
                by_cells += area * f64::from(passed);
                by_maps += area * f64::from(reached(cell, light));
            }
        }
        if by_maps > 0.0 { ((by_cells / by_maps) as f32).clamp(LEAST_SCALE, MOST_SCALE) } else { 1.0 }
    };
    lights.par_iter().enumerate().map(scale).collect()
}

/// Area of a cell's hair that light along a direction meets, over that of a face.
fn met(cell: &Cell, direction: Vec3) -> f32 {
    let sine = cell.tangent.dot(direction);
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    cell.hair * (cell.order * cosine + (1.0 - cell.order) * MEAN_COSINE)
}
