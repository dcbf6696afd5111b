//! `mark`: every cell near hair is fluid, solid or air.

use strandline_base::par::prelude::*;

use super::cell_kind::Kind;
use super::obstacles::Obstacles;
use super::volume::Volume;

/// Marks the cells, and gives the faces of solid cells the velocity of the solid
/// [Chen2011 fig. 21, McAdams2009, Bridson2008].
///
/// A cell that holds points is fluid unless its middle lies deeper in a solid than one cell: hair
/// lies on the skin, so the cells of its roots straddle the surface, and were they solid the hair
/// in them would be torn from the volume. Of the other cells only neighbours of fluid ones matter;
/// they are solid where their middle is inside. Signed distances are looked up for these alone.
pub fn mark(volume: &mut Volume, obstacles: &Obstacles) {
    for &cell in &volume.marked {
        volume.kinds[cell as usize] = Kind::Air;
    }
    let Volume { grid, sort, touched_set, spare_set, marked, .. } = volume;
    // Occupied cells and their six neighbours.
    touched_set.copy_from(sort.occupied());
    for stride in grid.strides() {
        touched_set.insert_neighbours(sort.occupied(), stride);
    }
    spare_set.copy_from(touched_set);
    spare_set.list_into(marked);
    classify(volume, obstacles);
    volume.fluid.clear();
    volume.fluid.extend(volume.marked.iter().filter(|&&cell| volume.kinds[cell as usize] == Kind::Fluid));
    carry_walls(volume, obstacles);
}

fn classify(volume: &mut Volume, obstacles: &Obstacles) {
    let depth = volume.grid.spacing();
    let head_from_world = obstacles.end.inverse();
    // What is farther than a cell need not be known to the bit.
    let look_up = |cell: usize| {
        let center = volume.grid.center(cell);
        let least = obstacles.at_least(center, &head_from_world);
        if least > depth { least } else { obstacles.nearest(center).map_or(f32::INFINITY, |near| near.0) }
    };
    let occupied: Vec<f32> =
        volume.sort.cells().par_iter().with_min_len(256).map(|&cell| look_up(cell as usize)).collect();
    for (&cell, &distance) in volume.sort.cells().iter().zip(&occupied) {
        volume.kinds[cell as usize] = if distance < -depth { Kind::Solid } else { Kind::Fluid };
        volume.distances[cell as usize] = distance;
    }
    let (strides, kinds, distances) = (volume.grid.strides(), &volume.kinds, &volume.distances);
    let beside: Vec<u32> = volume
        .marked
        .par_iter()
        .with_min_len(256)
        // Occupied cells are fluid or solid by now.
        .filter(|&&cell| kinds[cell as usize] == Kind::Air)
        .filter(|&&cell| {
            // A distance changes by no more than the way: most neighbours need no look-up. A cell of
            // the ring has neighbours outside the grid.
            let cell = cell as usize;
            let around =
                strides.into_iter().flat_map(|stride| [cell.checked_sub(stride), Some(cell + stride)]);
            let far = |cell: usize| kinds.get(cell) == Some(&Kind::Fluid) && distances[cell] > depth;
            !around.flatten().any(far) && look_up(cell) < 0.0
        })
        .map(|cell| *cell)
        .collect();
    for cell in beside {
        volume.kinds[cell as usize] = Kind::Solid;
    }
}

/// Sets faces between fluid and solid cells to the velocity of the solid.
fn carry_walls(volume: &mut Volume, obstacles: &Obstacles) {
    let strides = volume.grid.strides();
    for index in 0..volume.fluid.len() {
        let cell = volume.fluid[index] as usize;
        for (axis, stride) in strides.into_iter().enumerate() {
            for (neighbour, face) in [(cell - stride, cell), (cell + stride, cell + stride)] {
                if volume.kinds[neighbour] != Kind::Solid {
                    continue;
                }
                let center = volume.grid.face_center(axis, face);
                let velocity = obstacles
                    .nearest(center)
                    .map_or(0.0, |(_, _, collider)| obstacles.velocity(collider, center)[axis]);
                volume.faces.set(axis, face, velocity);
            }
        }
    }
}
