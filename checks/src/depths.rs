//! Depths of points inside a mesh: the side by exact winding numbers, the distance by its nearest triangle.

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use strandline_body::{Mesh, NearestSurface};

/// Cells on a side of the square that triangles are sorted into.
const SIDE: usize = 256;

/// A closed mesh, its triangles sorted by where a half line along x meets them.
///
/// It shares no code with the solids of the simulation: it is the judge of their signs.
pub struct Depths {
    corners: Vec<[DVec3; 3]>,
    /// Least corner and size of a cell \[m\], across x.
    low: DVec2,
    cell: DVec2,
    cells: Vec<Vec<u32>>,
    surface: NearestSurface,
}

impl Depths {
    /// A mesh whose holes are closed by fans, and vertices \[m\] in the place of its own.
    ///
    /// # Panics
    /// The vertices are not those of the mesh.
    pub fn new(mesh: &Mesh, vertices: Vec<Vec3>) -> Self {
        assert_eq!(vertices.len(), mesh.positions.len());
        let closed = Mesh::new(vertices, mesh.triangles.clone()).unwrap().closed();
        let corners: Vec<[DVec3; 3]> = closed
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| closed.positions[corner as usize].as_dvec3()))
            .collect();
        let flat = |corner: &DVec3| DVec2::new(corner.y, corner.z);
        let all = || corners.iter().flatten().map(flat);
        let low = all().fold(DVec2::INFINITY, DVec2::min);
        let cell = (all().fold(DVec2::NEG_INFINITY, DVec2::max) - low) / SIDE as f64;
        let mut cells = vec![Vec::new(); SIDE * SIDE];
        for (index, corners) in corners.iter().enumerate() {
            let at = corners.map(|corner| ((flat(&corner) - low) / cell).floor());
            let last = DVec2::splat(SIDE as f64 - 1.0);
            let [first, last] = [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]).min(last)];
            for row in first.y as usize..=last.y as usize {
                for column in first.x as usize..=last.x as usize {
                    cells[row * SIDE + column].push(index as u32);
                }
            }
        }
        Self { surface: NearestSurface::new(&closed), corners, low, cell, cells }
    }

    /// Winding number around a point \[m\].
    pub fn winding(&self, point: Vec3) -> i32 {
        let point = point.as_dvec3();
        let at = ((DVec2::new(point.y, point.z) - self.low) / self.cell).floor();
        if at.min_element() < 0.0 || at.max_element() >= SIDE as f64 {
            return 0;
        }
        let triangles = &self.cells[at.y as usize * SIDE + at.x as usize];
        triangles.iter().map(|index| crossing(self.corners[*index as usize], point)).sum()
    }

    /// Depth \[m\] of each point inside the mesh, 0 outside.
    pub fn of(&self, points: &[Vec3]) -> Vec<f32> {
        let inside: Vec<usize> =
            (0..points.len()).into_par_iter().filter(|index| self.winding(points[*index]) > 0).collect();
        let places =
            self.surface.nearest_places(&inside.iter().map(|index| points[*index]).collect::<Vec<_>>());
        let mut depths = vec![0.0; points.len()];
        for (index, place) in inside.into_iter().zip(places) {
            depths[index] = points[index].distance(place);
        }
        depths
    }
}

/// 1 where the half line from a point along x leaves through the front of a triangle, -1 where it enters, else 0. A line
/// through an edge crosses one of the two triangles there.
fn crossing(corners: [DVec3; 3], point: DVec3) -> i32 {
    let corners = corners.map(|corner| corner - point);
    let mut turns = 0;
    for side in 0..3 {
        let [start, end] = [corners[side], corners[(side + 1) % 3]];
        if (start.z > 0.0) == (end.z > 0.0) {
            continue;
        }
        let rises = end.z > 0.0;
        // The same numbers in the same order from either triangle at an edge.
        let [low, high] = if rises { [start, end] } else { [end, start] };
        if low.y * high.z - low.z * high.y > 0.0 {
            turns += if rises { 1 } else { -1 };
        }
    }
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // The plane lies ahead where it meets the line at x above 0.
    if turns != 0 && normal.dot(corners[0]) / normal.x > 0.0 { turns } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube.
    fn cube() -> Mesh {
        let corner =
            |index: usize| Vec3::new((index & 1) as f32, (index >> 1 & 1) as f32, (index >> 2) as f32);
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Mesh::new((0..8).map(corner).collect(), triangles).unwrap()
    }

    #[test]
    fn depths_are_those_of_a_cube_and_of_one_inside_out_none() {
        let cube = cube();
        let depths = Depths::new(&cube, cube.positions.clone());
        let points = [Vec3::splat(0.5), Vec3::new(0.5, 0.5, 0.9), Vec3::new(0.1, 0.5, 0.5), Vec3::splat(1.5)];
        let found = depths.of(&points);
        for (found, expected) in found.iter().zip([0.5, 0.1, 0.1, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{found}, {expected}");
        }
        // Beside it, and behind it on the half line.
        assert!(
            depths
                .of(&[Vec3::new(-0.5, 0.5, 0.5), Vec3::new(0.5, 1.5, 0.5)])
                .iter()
                .all(|depth| *depth == 0.0)
        );
        let mirrored =
            cube.positions.iter().map(|place| Vec3::new(1.0 - place.x, place.y, place.z)).collect();
        assert_eq!(Depths::new(&cube, mirrored).winding(Vec3::splat(0.5)), -1);
    }
}
