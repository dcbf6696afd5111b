//! Density of hair at rest, against which a one-sided volume holds that of a step.

use glam::Vec3;
use strandline_base::vec3x8::Vec3x8;
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use super::grid::{Grid, NO_CELL, REACH};

/// Times its density at rest that hair reaches before pressure acts on it \[judged\]. Sums over the points of a cell differ by
/// so much between two places of the same hair in the cells: below it, hair that swings as it hangs would be pressed apart.
pub const PACKED: f32 = 1.25;

/// Density \[kg/m^3\] that each point has around it at rest, in a box of `cells` about all; shape `[block][point]` of lanes like
/// `positions` \[m\] and `mass` \[kg\]. Points without a mass or too far away have the largest number.
///
/// It is the mean of the six faces of the point's cell, each with the masses of all points about it, weighted trilinearly, as
/// `splat` sums them. Lanes that repeat the last strand are left out.
pub fn rest_density(
    cells: [u32; 3],
    strand_count: usize,
    points_per_strand: usize,
    positions: &[Vec3Lanes],
    mass: &[Lanes],
) -> Vec<Lanes> {
    let points: Vec<(usize, usize, Vec3)> = (0..positions.len() * LANES)
        .map(|number| (number / LANES, number % LANES))
        .filter(|(slot, lane)| slot / points_per_strand * LANES + lane < strand_count)
        .map(|(slot, lane)| (slot, lane, positions[slot].get(lane)))
        .filter(|(slot, lane, place)| mass[*slot].0[*lane] > 0.0 && place.abs().max_element() < REACH)
        .collect();
    let mut density = vec![Lanes([f32::MAX; LANES]); positions.len()];
    let Some(&(.., first)) = points.first() else { return density };
    let mut grid = Grid::new(cells.map(|count| count as usize));
    let corners = points.iter().fold((first, first), |(low, high), (.., at)| (low.min(*at), high.max(*at)));
    grid.follow(corners.0, corners.1);
    let (strides, count) = (grid.strides(), grid.cell_count());
    let mut faces = vec![0.0_f32; 3 * count];
    let mut cell_of = Vec::with_capacity(points.len());
    for (slot, lane, place) in &points {
        let places = grid.places(Vec3x8::splat(*place));
        let (cell, share) = (places.cell[0], places.share.map(|share| share.to_array()[0]));
        cell_of.push(cell);
        if cell != NO_CELL {
            for (axis, faces) in faces.chunks_exact_mut(count).enumerate() {
                add(faces, axis, cell as usize, share, strides, mass[*slot].0[*lane]);
            }
        }
    }
    let volume = 6.0 * grid.spacing().powi(3);
    for ((slot, lane, _), cell) in points.iter().zip(cell_of).filter(|(_, cell)| *cell != NO_CELL) {
        let on = |axis: usize| {
            let at = axis * count + cell as usize;
            faces[at] + faces[at + strides[axis]]
        };
        density[*slot].0[*lane] = (on(0) + on(1) + on(2)) / volume;
    }
    density
}

/// Adds a mass \[kg\] to the eight faces of an axis about a place in a cell: faces lie on the borders of cells along their axis,
/// half a cell further in the others.
fn add(faces: &mut [f32], axis: usize, cell: usize, share: [f32; 3], strides: [usize; 3], mass: f32) {
    let mut base = cell;
    let mut upper = share;
    for other in (0..3).filter(|other| *other != axis) {
        let before = share[other] < 0.5;
        base -= if before { strides[other] } else { 0 };
        upper[other] += if before { 0.5 } else { -0.5 };
    }
    for corner in 0..8 {
        let far = [corner & 1, corner >> 1 & 1, corner >> 2];
        let weight: f32 =
            (0..3).map(|axis| if far[axis] == 1 { upper[axis] } else { 1.0 - upper[axis] }).product();
        let at: usize = (0..3).map(|axis| far[axis] * strides[axis]).sum();
        faces[base + at] += mass * weight;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hair_has_its_density() {
        // A block of 12 x 12 x 12 points 5 mm apart, of a milligram each: 8 kg/m^3 away from its sides.
        let place = |number: usize| {
            Vec3::new((number % 12) as f32, (number / 12 % 12) as f32, (number / 144) as f32) * 5e-3
        };
        let mut positions = vec![Vec3Lanes::default(); 12 * 18];
        for strand in 0..144 {
            for point in 0..12 {
                positions[strand / LANES * 12 + point].set(strand % LANES, place(point * 144 + strand));
            }
        }
        let mut mass = vec![Lanes([1e-6; LANES]); positions.len()];
        mass[3].0[2] = 0.0;
        let density = rest_density([8; 3], 144, 12, &positions, &mass);
        let inner = 6 * 12 + 6;
        let found = density[inner / LANES * 12 + 6].0[inner % LANES];
        assert!((found / 8.0 - 1.0).abs() < 0.25, "{found} kg/m^3");
        assert_eq!(density[3].0[2], f32::MAX);
        // Half of the faces of a cell at a corner of the block lie on its sides.
        assert!(density[0].0[0] < 0.95 * found, "{} of {found} kg/m^3", density[0].0[0]);
    }
}
