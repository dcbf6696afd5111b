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
    use glam::Quat;

    use super::*;
    use crate::Mannequin;

    #[test]
    fn normals_turn_with_the_vertices() {
        let mesh = Mannequin::new().mesh();
        let mut skin = MovedSkin::default();
        assert!(!skin.take(&mesh, None));
        assert_eq!(skin.shape(&mesh), [&mesh.positions[..], &mesh.normals[..]]);
        let turn = Quat::from_rotation_z(0.7);
        let turned: Arc<[Vec3]> = mesh.positions.iter().map(|point| turn * *point).collect();
        assert!(skin.take(&mesh, Some(&turned)) && !skin.take(&mesh, Some(&turned)));
        let rest = Mesh::new(mesh.positions.clone(), mesh.triangles.clone()).unwrap();
        let [positions, normals] = skin.shape(&mesh);
        assert_eq!(positions, &turned[..]);
        // Angles of thin triangles are rounded.
        let apart = normals.iter().zip(&rest.normals).map(|(found, rest)| found.distance(turn * *rest));
        assert!(apart.fold(0.0, f32::max) < 1e-3);
        // The same vertices in other memory are the same shape; fewer are none.
        assert!(!skin.take(&mesh, Some(&turned.iter().copied().collect())));
        assert!(skin.take(&mesh, Some(&Arc::from([Vec3::ZERO]))));
        assert_eq!(skin.shape(&mesh)[0], &mesh.positions[..]);
    }
}
