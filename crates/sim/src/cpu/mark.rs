//! `mark`: every cell near hair is fluid, solid or air.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::{MOST_PLACES, Places, PosedSkin};
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use super::volume::Volume;
use crate::cells::Grid;
use crate::cells::Kind;
use crate::contact::Obstacles;
use crate::contact::planes::Contacts;

/// Points of a cell whose planes are asked.
const ASKED: usize = 4;
/// Cells whose walls are looked up one after the other: each look begins where the last one ended.
const BESIDE: usize = 64;
/// Rounding \[m\] of a distance a metre from the origin of the head.
const ROUNDED: f32 = 1e-6;

/// Marks the cells, and gives the faces of solid cells the velocity of the solid
/// [Chen2011 fig. 21, McAdams2009, Bridson2008].
///
/// A cell that holds points is fluid unless its middle lies deeper in a solid than one cell: hair
/// lies on the skin, so the cells of its roots straddle the surface; as solid cells they would tear
/// that hair from the volume. Of the other cells only neighbours of fluid ones matter; they are
/// solid where their middle is inside. Signed distances are looked up for these alone; under a skin that moves by itself the
/// planes of the points, where they are given with the positions \[m\], tell most of them.
///
/// In a one-sided volume, where `packing` gives the density \[kg/m^3\] of each point at rest and the step \[s\], cells that are
/// not packed are air, and walls hold what flows into them alone.
pub fn mark(
    volume: &mut Volume,
    obstacles: &Obstacles,
    planes: Option<(&[Vec3Lanes], &Contacts)>,
    packing: Option<(&[Lanes], f32)>,
) {
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
    let planes = planes.filter(|_| obstacles.has_moving_skin());
    let known = planes.map(|planes| known_by_points(volume, obstacles, planes));
    classify(volume, obstacles, known);
    if let Some((at_rest, time_step)) = packing {
        volume.loosen(at_rest, time_step);
    }
    volume.fluid.clear();
    let cells = volume.sort.cells().iter();
    volume.fluid.extend(cells.filter(|&&cell| volume.kinds[cell as usize] == Kind::Fluid));
    carry_walls(volume, obstacles);
}

/// Lower bounds \[m\] of the distances of the middles of occupied cells, by the planes of their points.
fn known_by_points(
    volume: &Volume,
    obstacles: &Obstacles,
    (positions, contacts): (&[Vec3Lanes], &Contacts),
) -> Vec<f32> {
    let heights = contacts.heights(obstacles, positions, volume.points_per_strand);
    let known = |(index, cell): (usize, &u32)| {
        let middle = volume.grid.center(*cell as usize);
        let points = volume.sort.points_of(index).iter().take(ASKED);
        let bounds = points.map(|point| {
            let (slot, lane) = (*point as usize / LANES, *point as usize % LANES);
            heights[slot].0[lane] - positions[slot].get(lane).distance(middle)
        });
        bounds.fold(f32::NEG_INFINITY, f32::max) - ROUNDED
    };
    volume.sort.cells().par_iter().enumerate().with_min_len(256).map(known).collect()
}

fn classify(volume: &mut Volume, obstacles: &Obstacles, known: Option<Vec<f32>>) {
    let depth = volume.grid.spacing();
    let cells = volume.sort.cells();
    let occupied = match known {
        Some(mut known) => {
            let is_unknown = |index: &usize| known[*index] <= -depth;
            let unknown: Vec<usize> = (0..cells.len()).filter(is_unknown).collect();
            let asked: Vec<u32> = unknown.iter().map(|index| cells[*index]).collect();
            for (index, distance) in
                unknown.into_iter().zip(distances(&volume.grid, obstacles, &asked, depth))
            {
                known[index] = distance;
            }
            known
        }
        None => distances(&volume.grid, obstacles, cells, depth),
    };
    for (&cell, &distance) in cells.iter().zip(&occupied) {
        volume.kinds[cell as usize] = if distance < -depth { Kind::Solid } else { Kind::Fluid };
        volume.distances[cell as usize] = distance;
    }
    let (strides, kinds, known) = (volume.grid.strides(), &volume.kinds, &volume.distances);
    // A distance changes by no more than the way: most neighbours need no look-up.
    let far = |cell: usize| kinds.get(cell) == Some(&Kind::Fluid) && known[cell] > depth;
    let is_asked = |&&cell: &&u32| {
        let cell = cell as usize;
        // Occupied cells are fluid or solid by now. A cell of the ring has neighbours outside the grid.
        kinds[cell] == Kind::Air
            && !strides.iter().any(|stride| far(cell.wrapping_sub(*stride)) || far(cell + stride))
    };
    let asked: Vec<u32> =
        volume.marked.par_iter().with_min_len(256).filter(is_asked).map(|cell| *cell).collect();
    let inside: Vec<u32> = inside_skin(&volume.grid, obstacles, &asked).unwrap_or_else(|| {
        let beside = distances(&volume.grid, obstacles, &asked, 0.0);
        asked.iter().zip(beside).filter(|(_, distance)| *distance < 0.0).map(|(cell, _)| *cell).collect()
    });
    for cell in inside {
        volume.kinds[cell as usize] = Kind::Solid;
    }
}

/// Cells, of some in order, whose middles lie inside a skin that moves by itself, where that is the only solid: one search
/// for the cells of a row, one for each cell where the skin has a hole.
fn inside_skin(grid: &Grid, obstacles: &Obstacles, cells: &[u32]) -> Option<Vec<u32>> {
    if !obstacles.are_one_moving_skin() {
        return None;
    }
    let row = grid.strides()[1] as u32;
    let part = |cell: u32| (cell / row, cell % row / MOST_PLACES as u32);
    let rows: Vec<&[u32]> = cells.chunk_by(|one, other| part(*one) == part(*other)).collect();
    let inside = |cells: &&[u32]| -> Vec<u32> {
        let (first, last) = (cells[0], cells[cells.len() - 1]);
        let (place, step) = (grid.center(first as usize), Vec3::X * grid.spacing());
        let places = Places { first: place, step, count: (last - first + 1) as usize };
        let is_inside: Vec<bool> = match obstacles.sides_along(places) {
            Some(sides) => cells.iter().map(|cell| sides.inside & (1 << (cell - first)) != 0).collect(),
            None => distances(grid, obstacles, cells, 0.0).iter().map(|distance| *distance < 0.0).collect(),
        };
        cells.iter().zip(is_inside).filter(|(_, is_inside)| *is_inside).map(|(cell, _)| *cell).collect()
    };
    let inside: Vec<Vec<u32>> = rows.par_iter().with_min_len(16).map(inside).collect();
    Some(inside.concat())
}

/// Signed distances \[m\] at the middles of cells, or lower bounds that are more than `enough` \[m\].
fn distances(grid: &Grid, obstacles: &Obstacles, cells: &[u32], enough: f32) -> Vec<f32> {
    /// Cells whose first look-ups run together.
    const TOGETHER: usize = 64;
    let center = |cell: &u32| grid.center(*cell as usize);
    let mut distances = vec![0.0; cells.len()];
    let parts = distances.par_chunks_mut(TOGETHER).zip(cells.par_chunks(TOGETHER));
    parts.with_min_len(4).for_each(|(distances, cells)| {
        let mut near = PosedSkin::UNKNOWN;
        // A skin that moves is looked up where the last look-up tells too little.
        let (mut last, is_moving) = ((Vec3::ZERO, f32::NEG_INFINITY), obstacles.has_moving_skin());
        for (distance, cell) in distances.iter_mut().zip(cells) {
            let place = center(cell);
            *distance = last.1 - place.distance(last.0);
            if !is_moving || *distance <= enough {
                *distance = obstacles.at_least_or(place, &mut near, enough);
                last = (place, *distance);
            }
        }
        // A loop of its own: in one loop the processor would wait for each first look-up to decide on a second.
        for (distance, cell) in distances.iter_mut().zip(cells).filter(|(least, _)| **least <= enough) {
            *distance = obstacles.distance(center(cell), &mut near);
        }
    });
    distances
}

/// Triangle of the moving skin near the last wall.
struct Near {
    triangle: u32,
    /// True where that was a wall of the same cell: walls move as the material about the first where it is as near.
    is_here: bool,
    /// Distance \[m\] within which it is.
    reach: f32,
}

impl Near {
    /// Velocity \[m/s\] of the solid about a place; `None` without solids.
    fn velocity(&mut self, obstacles: &Obstacles, place: Vec3) -> Option<Vec3> {
        if std::mem::replace(&mut self.is_here, true) && obstacles.are_one_moving_skin() {
            // The other side of a gap is another part of the skin.
            obstacles.velocity_within(place, &mut self.triangle, self.reach)
        } else {
            obstacles.nearest_velocity(place, &mut self.triangle)
        }
    }
}

/// Sets faces between fluid and solid cells to the velocity of the solid.
fn carry_walls(volume: &mut Volume, obstacles: &Obstacles) {
    let strides = volume.grid.strides();
    let sides =
        strides.into_iter().enumerate().flat_map(|(axis, stride)| [(axis, stride, 0), (axis, stride, 1)]);
    let sides: Vec<(usize, usize, usize)> = sides.collect();
    let (grid, kinds) = (&volume.grid, &volume.kinds);
    let wall = |cell: usize, (axis, stride, behind): (usize, usize, usize), near: &mut Near| {
        let neighbour = if behind == 1 { cell + stride } else { cell - stride };
        (kinds[neighbour] == Kind::Solid).then(|| {
            let center = grid.face_center(axis, cell + behind * stride);
            let velocity = near.velocity(obstacles, center);
            velocity.map_or(0.0, |velocity| velocity[axis])
        })
    };
    let around = |cells: &[u32]| {
        let mut near = Near { triangle: PosedSkin::UNKNOWN, is_here: false, reach: 0.25 * grid.spacing() };
        let walls = cells.iter().filter_map(|&cell| -> Option<(usize, [Option<f32>; 6])> {
            let cell = cell as usize;
            near.is_here = false;
            let walls = std::array::from_fn(|side| wall(cell, sides[side], &mut near));
            walls.iter().any(Option::is_some).then_some((cell, walls))
        });
        walls.collect::<Vec<_>>()
    };
    let parts = volume.fluid.par_chunks(BESIDE).with_min_len(4);
    let beside: Vec<_> = parts.flat_map_iter(around).collect();
    let holds_all = !volume.settings.is_one_sided();
    for (cell, walls) in beside {
        for ((axis, stride, behind), wall) in sides.iter().zip(walls) {
            let Some(velocity) = wall else { continue };
            let face = cell + behind * stride;
            let into = volume.faces.velocity(*axis, face) - velocity;
            if holds_all || (if *behind == 1 { into > 0.0 } else { into < 0.0 }) {
                volume.faces.set(*axis, face, velocity);
            }
        }
    }
}
