//! The places of a mesh that are nearest to points.

use glam::{DVec3, Vec3};
use strandline_base::par::prelude::*;

use crate::Mesh;
use crate::layers::Corners;
use crate::triangle::nearest_place;
use crate::triangle_tree::{Nearest, TriangleTree};

impl Mesh {
    /// The place on the surface \[m\] that is nearest to each of the points.
    pub fn nearest_places(&self, points: &[Vec3]) -> Vec<Vec3> {
        let corner = |corner: u32| self.positions[corner as usize].as_dvec3();
        let triangles: Vec<Corners> = self.triangles.iter().map(|corners| corners.map(corner)).collect();
        let tree = TriangleTree::new(&triangles, (0..triangles.len() as u32).collect());
        let nearest = |point: &Vec3| {
            let point = point.as_dvec3();
            let mut found = Nearest::NONE;
            tree.search(point, u64::MAX, &mut found);
            let place = |triangle: &Corners| nearest_place(triangle, point);
            triangles.get(found.triangle as usize).map_or(DVec3::NAN, place).as_vec3()
        };
        points.par_iter().map(nearest).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mannequin;

    #[test]
    fn no_place_of_a_mesh_is_nearer() {
        let mesh = Mannequin::new().mesh();
        let points: Vec<Vec3> = (0..40)
            .map(|index| {
                let share = index as f32 / 40.0;
                Vec3::new((31.0 * share).sin(), (17.0 * share).cos(), (7.0 * share).sin())
                    * (0.02 + 0.3 * share)
            })
            .collect();
        for (point, place) in points.iter().zip(mesh.nearest_places(&points)) {
            let found = point.distance(place);
            let least = mesh.triangles.iter().map(|corners| {
                let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
                // A lattice over each triangle.
                let places = (0..=8).flat_map(|u| (0..=8 - u).map(move |v| (u, v)));
                places
                    .map(|(u, v)| a + (b - a) * (u as f32 / 8.0) + (c - a) * (v as f32 / 8.0))
                    .map(|place| place.distance(*point))
                    .fold(f32::INFINITY, f32::min)
            });
            let least = least.fold(f32::INFINITY, f32::min);
            // Between places of the lattice the surface may be nearer, by far less than an edge of 1 cm.
            assert!(found <= least + 1e-6 && found > least - 0.004, "{point}: {found}, {least}");
        }
    }
}
