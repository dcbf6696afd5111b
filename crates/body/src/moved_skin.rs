//! The drawn shape of a mesh whose vertices move by themselves.

use std::sync::Arc;

use glam::Vec3;

use crate::Mesh;
use crate::mesh::normals_about;
use crate::welding::welded_vertices;

/// The vertices of a mesh as they were drawn last, and the normals that follow from them.
#[derive(Clone, Debug, Default)]
pub struct MovedSkin {
    /// Vertices at one place at rest, which share a normal; found once.
    welded: Vec<u32>,
    positions: Option<Arc<[Vec3]>>,
    normals: Vec<Vec3>,
}

impl MovedSkin {
    /// Takes the skin vertices of a moment \[m\], head space; `None` is the mesh at rest, and so is another number of
    /// vertices. Returns true where the shape is another one than before, of which the normals are computed anew.
    pub fn take(&mut self, mesh: &Mesh, skin: Option<&Arc<[Vec3]>>) -> bool {
        let skin = skin.filter(|skin| skin.len() == mesh.positions.len());
        let is_same = match (&self.positions, skin) {
            (Some(known), Some(skin)) => Arc::ptr_eq(known, skin) || known == skin,
            (known, skin) => known.is_none() && skin.is_none(),
        };
        if is_same {
            return false;
        }
        self.positions = skin.cloned();
        if let Some(skin) = skin {
            if self.welded.is_empty() {
                self.welded = welded_vertices(&mesh.positions);
            }
            self.normals = normals_about(&self.welded, skin, &mesh.triangles);
        }
        true
    }

    /// Positions \[m\] and unit normals of all vertices, head space: those that were taken last, or the mesh's own.
    pub fn shape<'a>(&'a self, mesh: &'a Mesh) -> [&'a [Vec3]; 2] {
        match &self.positions {
            Some(positions) => [positions, &self.normals],
            None => [&mesh.positions, &mesh.normals],
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, vec3};

    use super::*;

    /// An octahedron with unlike axes, whose tip on +x is two vertices, as at a seam.
    fn octahedron() -> Mesh {
        let [x, y, z] = [Vec3::X, Vec3::Y * 2.0, Vec3::Z * 3.0];
        let face = |index: u32| {
            let [right, up, front] = [0, 1, 2].map(|axis| index >> axis & 1);
            let tip = if right == 1 { 1 } else { 6 * up };
            let (side, end) = (2 + up, 4 + front);
            if (right + up + front).is_multiple_of(2) { [tip, side, end] } else { [tip, end, side] }
        };
        Mesh::new(vec![x, -x, y, -y, z, -z, x], (0..8).map(face).collect()).unwrap()
    }

    #[test]
    fn normals_turn_with_the_vertices() {
        let mesh = octahedron();
        assert!(mesh.normals[0].distance(Vec3::X) < 1e-5 && mesh.normals[6] == mesh.normals[0]);
        let mut skin = MovedSkin::default();
        assert!(!skin.take(&mesh, None));
        assert_eq!(skin.shape(&mesh), [&mesh.positions[..], &mesh.normals[..]]);
        let turn = Quat::from_rotation_z(0.7);
        let turned: Arc<[Vec3]> = mesh.positions.iter().map(|point| turn * *point).collect();
        assert!(skin.take(&mesh, Some(&turned)) && !skin.take(&mesh, Some(&turned)));
        let [positions, normals] = skin.shape(&mesh);
        assert_eq!(positions, &turned[..]);
        for (found, rest) in normals.iter().zip(&mesh.normals) {
            assert!(found.distance(turn * *rest) < 1e-5, "{found} of {rest}");
        }
        // The same vertices in other memory are the same shape; another number of them is none.
        assert!(!skin.take(&mesh, Some(&turned.iter().copied().collect())));
        assert!(skin.take(&mesh, Some(&Arc::from([Vec3::ZERO]))));
        assert_eq!(skin.shape(&mesh)[0], &mesh.positions[..]);
    }

    #[test]
    fn a_seam_keeps_one_normal_where_it_opens() {
        let mesh = octahedron();
        let mut opened = mesh.positions.clone();
        opened[6] += vec3(0.0, -0.1, 0.0);
        let mut skin = MovedSkin::default();
        assert!(skin.take(&mesh, Some(&opened.into())));
        let [_, normals] = skin.shape(&mesh);
        assert_eq!(normals[0], normals[6]);
    }
}
