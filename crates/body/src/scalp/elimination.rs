use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{IVec3, Vec3};
use strandline_base::par::prelude::*;

/// A place and how crowded it was when it entered the queue.
#[derive(PartialEq)]
struct Crowded {
    weight: f32,
    index: usize,
}

impl Eq for Crowded {}

impl Ord for Crowded {
    fn cmp(&self, other: &Self) -> Ordering {
        self.weight.total_cmp(&other.weight).then(other.index.cmp(&self.index))
    }
}

impl PartialOrd for Crowded {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Indices, in rising order, of the `count` places \[m\] that are left when the most crowded one is
/// taken away again and again \[Yuksel2015\]. The first `fixed` stay in any case.
pub(super) fn kept(places: &[Vec3], fixed: usize, count: usize) -> Vec<usize> {
    // Twice the largest radius of discs that could cover the area; the area follows from the grid.
    let reach = 2.0 * (area(places) / (2.0 * 3f32.sqrt() * count.max(1) as f32)).sqrt();
    let neighbours = neighbours(places, reach);
    let mut weights: Vec<f32> =
        neighbours.iter().map(|near| near.iter().map(|&(_, weight)| weight).sum()).collect();
    let mut queue: BinaryHeap<Crowded> =
        weights.iter().enumerate().skip(fixed).map(|(index, &weight)| Crowded { weight, index }).collect();
    let mut alive = vec![true; places.len()];
    let mut left = places.len();
    while left > count {
        let Some(top) = queue.pop() else { break };
        if !alive[top.index] {
            continue;
        }
        // Weights only fall, so a stale entry is put back with what it weighs now.
        if top.weight != weights[top.index] {
            queue.push(Crowded { weight: weights[top.index], index: top.index });
            continue;
        }
        alive[top.index] = false;
        left -= 1;
        for &(other, weight) in &neighbours[top.index] {
            weights[other as usize] -= weight;
        }
    }
    (0..places.len()).filter(|&index| alive[index]).collect()
}

/// Area \[m^2\] that the places cover, from how many cells of a coarse grid hold one: a surface in a
/// random direction meets 1.5 cells for each square of the cell's side.
fn area(places: &[Vec3]) -> f32 {
    let side = 0.012;
    let cells = cells(places, side);
    let mut count = 0;
    for (index, cell) in cells.iter().enumerate() {
        count += usize::from(index == 0 || cells[index - 1].0 != cell.0);
    }
    count as f32 * side * side / 1.5
}

/// The cell of each place and its index, sorted by cell.
fn cells(places: &[Vec3], side: f32) -> Vec<([i32; 3], u32)> {
    let mut cells: Vec<([i32; 3], u32)> = places
        .iter()
        .enumerate()
        .map(|(index, place)| ((*place / side).floor().as_ivec3().to_array(), index as u32))
        .collect();
    cells.par_sort_unstable();
    cells
}

/// The places within `reach` \[m\] of each place and how much they crowd it.
fn neighbours(places: &[Vec3], reach: f32) -> Vec<Vec<(u32, f32)>> {
    let cells = cells(places, reach);
    let near = |place: Vec3, own: usize| {
        let middle = (place / reach).floor().as_ivec3();
        let mut found = Vec::new();
        for z in -1..=1 {
            for y in -1..=1 {
                for x in -1..=1 {
                    let wanted = (middle + IVec3::new(x, y, z)).to_array();
                    let first = cells.partition_point(|cell| cell.0 < wanted);
                    for &(_, other) in cells[first..].iter().take_while(|cell| cell.0 == wanted) {
                        let distance = places[other as usize].distance(place);
                        if other as usize != own && distance < reach {
                            found.push((other, (1.0 - distance / reach).powi(8)));
                        }
                    }
                }
            }
        }
        found
    };
    places.par_iter().enumerate().map(|(index, &place)| near(place, index)).collect()
}
