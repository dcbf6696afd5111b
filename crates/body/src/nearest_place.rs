//! The places of a mesh that are nearest to points.

use glam::{DVec3, Vec3};
use strandline_base::par::prelude::*;

use crate::Mesh;
use crate::layers::Corners;
use crate::triangle::nearest_place;
use crate::triangle_tree::{Nearest, TriangleTree};

/// The surface of a mesh, made ready for searches of the places on it that are nearest to points.
pub struct NearestSurface {
    tree: TriangleTree<'static>,
}

impl NearestSurface {
    /// The surface of a mesh, in its space.
    pub fn new(mesh: &Mesh) -> Self {
        let corner = |corner: u32| mesh.positions[corner as usize].as_dvec3();
        let triangles: Vec<Corners> = mesh.triangles.iter().map(|corners| corners.map(corner)).collect();
        let order = (0..triangles.len() as u32).collect();
        Self { tree: TriangleTree::new(triangles, order) }
    }

    /// The place on the surface \[m\] that is nearest to each of the points; not a number on a mesh without triangles.
    pub fn nearest_places(&self, points: &[Vec3]) -> Vec<Vec3> {
        self.nearest(points, |_, triangle, point| {
            triangle.map_or(DVec3::NAN, |triangle| nearest_place(triangle, point)).as_vec3()
        })
    }

    /// The triangle that is nearest to each of the points, and the shares of its corners in the place there.
    pub fn nearest_triangles(&self, points: &[Vec3]) -> Vec<(u32, Vec3)> {
        self.nearest(points, |index, triangle, point| {
            let shares = |triangle: &Corners| shares_of(triangle, nearest_place(triangle, point)).as_vec3();
            (index, triangle.map_or(Vec3::X, shares))
        })
    }

    /// A value of each point, made from the index and the corners of its nearest triangle.
    fn nearest<T: Send>(
        &self,
        points: &[Vec3],
        value: impl Fn(u32, Option<&Corners>, DVec3) -> T + Sync,
    ) -> Vec<T> {
        let nearest = |point: &Vec3| {
            let point = point.as_dvec3();
            let mut found = Nearest::NONE;
            self.tree.search(point, u64::MAX, &mut found);
            value(found.triangle, self.tree.triangles().get(found.triangle as usize), point)
        };
        points.par_iter().map(nearest).collect()
    }
}

impl Mesh {
    /// The place on the surface \[m\] that is nearest to each of the points; [`NearestSurface`] answers more than once.
    pub fn nearest_places(&self, points: &[Vec3]) -> Vec<Vec3> {
        NearestSurface::new(self).nearest_places(points)
    }

    /// The triangle that is nearest to each of the points, and the shares of its corners in the place there.
    pub fn nearest_triangles(&self, points: &[Vec3]) -> Vec<(u32, Vec3)> {
        NearestSurface::new(self).nearest_triangles(points)
    }
}

/// Shares of the corners of a triangle in one of its places; of a triangle without an area those of its longest edge.
fn shares_of([a, b, c]: &Corners, place: DVec3) -> DVec3 {
    let normal = (*b - *a).cross(*c - *a);
    let area = normal.length_squared();
    let longest = a.distance_squared(*b).max(b.distance_squared(*c)).max(c.distance_squared(*a));
    if area > 1e-20 * longest * longest {
        let part =
            |start: DVec3, end: DVec3| ((end - start).cross(place - start).dot(normal) / area).max(0.0);
        let shares = DVec3::new(part(*b, *c), part(*c, *a), part(*a, *b));
        return shares / (shares.x + shares.y + shares.z);
    }
    let weight = |corner: &DVec3| longest.sqrt() - corner.distance(place).min(longest.sqrt());
    let shares = DVec3::new(weight(a), weight(b), weight(c));
    let sum = shares.x + shares.y + shares.z;
    if sum > 0.0 { shares / sum } else { DVec3::X }
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
