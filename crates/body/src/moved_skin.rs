//! The drawn shape of a mesh whose vertices move by themselves.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;

use crate::mesh::normals_about;
use crate::neck::Bend;
use crate::welding::welded_vertices;
use crate::{BodyFrame, Mesh};

/// The vertices of a mesh as they were drawn last, and the normals that follow from them.
#[derive(Clone, Debug, Default)]
pub struct MovedSkin {
    /// Vertices at one place at rest, which share a normal; found once.
    welded: Vec<u32>,
    positions: Option<Arc<[Vec3]>>,
    /// Bend of the neck, and the vertices under it.
    bend: Option<Bend>,
    bent: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl Mesh {
    /// Positions of the vertices \[m\] in a frame of the body, head space: its skin, if that has as many vertices, or the mesh
    /// at rest, with its neck bent as the pieces of the frame are.
    pub fn positions_in<'a>(&'a self, body: &'a BodyFrame) -> Cow<'a, [Vec3]> {
        match (self.skin_in(body), self.bend_in(body)) {
            (Some(skin), _) => Cow::Borrowed(skin),
            (None, Some(bend)) => {
                let mut positions = self.positions.clone();
                bend.places(&mut positions);
                Cow::Owned(positions)
            }
            (None, None) => Cow::Borrowed(&self.positions),
        }
    }

    pub(crate) fn skin_in<'a>(&self, body: &'a BodyFrame) -> Option<&'a Arc<[Vec3]>> {
        body.skin().filter(|skin| skin.len() == self.positions.len())
    }

    pub(crate) fn bend_in(&self, body: &BodyFrame) -> Option<Bend> {
        self.neck.and_then(|neck| neck.bend(body))
    }
}

impl MovedSkin {
    /// Takes the vertices of a mesh in a frame of the body: its skin, if that has as many vertices, or the mesh at rest, with
    /// its neck bent as the pieces of the frame are. Returns true where the shape is another one than before, of which the
    /// normals are computed anew.
    pub fn take(&mut self, mesh: &Mesh, body: &BodyFrame) -> bool {
        let skin = mesh.skin_in(body);
        let bend = mesh.bend_in(body).filter(|_| skin.is_none());
        let is_same = match (&self.positions, skin) {
            (Some(known), Some(skin)) => Arc::ptr_eq(known, skin) || known == skin,
            (known, skin) => known.is_none() && skin.is_none(),
        };
        if is_same && bend == self.bend {
            return false;
        }
        (self.positions, self.bend) = (skin.cloned(), bend);
        if let Some(bend) = bend {
            bend.skin([&mesh.positions, &mesh.normals], &mut self.bent, &mut self.normals);
        }
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
        match (&self.positions, self.bend) {
            (Some(positions), _) => [positions, &self.normals],
            (None, Some(_)) => [&self.bent, &self.normals],
            (None, None) => [&mesh.positions, &mesh.normals],
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
        let at = |skin: Arc<[Vec3]>| BodyFrame::REST.with_skin(skin);
        assert!(!skin.take(&mesh, &BodyFrame::REST));
        assert_eq!(skin.shape(&mesh), [&mesh.positions[..], &mesh.normals[..]]);
        let turn = Quat::from_rotation_z(0.7);
        let turned: Arc<[Vec3]> = mesh.positions.iter().map(|point| turn * *point).collect();
        assert!(skin.take(&mesh, &at(turned.clone())) && !skin.take(&mesh, &at(turned.clone())));
        let [positions, normals] = skin.shape(&mesh);
        assert_eq!(positions, &turned[..]);
        for (found, rest) in normals.iter().zip(&mesh.normals) {
            assert!(found.distance(turn * *rest) < 1e-5, "{found} of {rest}");
        }
        // The same vertices in other memory are the same shape; another number of them is none.
        assert!(!skin.take(&mesh, &at(turned.iter().copied().collect())));
        assert!(skin.take(&mesh, &at(Arc::from([Vec3::ZERO]))));
        assert_eq!(skin.shape(&mesh)[0], &mesh.positions[..]);
    }

    #[test]
    fn a_seam_keeps_one_normal_where_it_opens() {
        let mesh = octahedron();
        let mut opened = mesh.positions.clone();
        opened[6] += vec3(0.0, -0.1, 0.0);
        let mut skin = MovedSkin::default();
        assert!(skin.take(&mesh, &BodyFrame::REST.with_skin(opened)));
        let [_, normals] = skin.shape(&mesh);
        assert_eq!(normals[0], normals[6]);
    }
}
