//! The drawn shape of a mesh whose vertices move by themselves.

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;

use crate::carried_normals::CarriedNormals;
use crate::inside_out::RestVolume;
use crate::mesh::normals_about;
use crate::neck::Bend;
use crate::welding::welded_vertices;
use crate::{BodyFrame, Mesh};

/// The vertices of a mesh as they were drawn last, and the normals that follow from them.
#[derive(Clone, Debug, Default)]
pub struct MovedSkin {
    /// Inputs of the normals; found once.
    rest: Option<Rest>,
    positions: Option<Arc<[Vec3]>>,
    /// Bend of the neck, and the vertices under it.
    bend: Option<Bend>,
    bent: Vec<Vec3>,
    normals: Vec<Vec3>,
}

/// A mesh at rest, as the normals of its skin need it.
#[derive(Clone, Debug)]
struct Rest {
    /// Vertices at one place, which share a normal.
    welded: Vec<u32>,
    /// Normals of the file; `None` for those of the triangles.
    carried: Option<CarriedNormals>,
    volume: RestVolume,
}

impl Rest {
    fn new(mesh: &Mesh) -> Self {
        let welded = welded_vertices(&mesh.positions);
        let carried = CarriedNormals::new(mesh, &welded);
        Self { welded, carried, volume: RestVolume::new(&mesh.positions, &mesh.triangles) }
    }

    /// Unit normals of a skin, which point out of it also where it is inside out.
    fn normals(&self, skin: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
        let mut normals = match &self.carried {
            Some(carried) => carried.on(skin, triangles),
            None => normals_about(&self.welded, skin, triangles),
        };
        if self.volume.side(skin, triangles) < 0.0 {
            normals.iter_mut().for_each(|normal| *normal = -*normal);
        }
        normals
    }
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
    /// normals are computed anew: those of the triangles, or those of the mesh as its triangles carry them.
    pub fn take(&mut self, mesh: &Mesh, body: &BodyFrame) -> bool {
        // A skin at rest has the normals of the mesh, to the bit.
        let skin = mesh.skin_in(body).filter(|skin| skin[..] != mesh.positions[..]);
        let bend = mesh.bend_in(body).filter(|_| mesh.skin_in(body).is_none());
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
            let rest = self.rest.get_or_insert_with(|| Rest::new(mesh));
            self.normals = rest.normals(skin, &mesh.triangles);
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
    fn normals_of_a_file_are_those_of_the_mesh_at_rest_and_go_with_the_skin() {
        let mut mesh = octahedron();
        let drawn = |place: &Vec3| (*place * vec3(1.0, -0.5, 2.0)).normalize();
        mesh.normals = mesh.positions.iter().map(drawn).collect();
        let mut skin = MovedSkin::default();
        assert!(!skin.take(&mesh, &BodyFrame::REST.with_skin(mesh.positions.clone())));
        assert_eq!(skin.shape(&mesh), [&mesh.positions[..], &mesh.normals[..]]);
        let turn = Quat::from_rotation_x(1.1);
        let turned: Vec<Vec3> = mesh.positions.iter().map(|place| turn * (2.0 * *place)).collect();
        assert!(skin.take(&mesh, &BodyFrame::REST.with_skin(turned)));
        for (found, rest) in skin.shape(&mesh)[1].iter().zip(&mesh.normals) {
            assert!(found.distance(turn * *rest) < 1e-5, "{found} of {rest}");
        }
    }

    #[test]
    fn normals_of_a_skin_that_is_inside_out_point_out_of_it() {
        let mesh = octahedron();
        for normals in [mesh.normals.clone(), mesh.positions.iter().map(|place| place.normalize()).collect()]
        {
            let mesh = Mesh { normals, ..mesh.clone() };
            let mirror = |place: &Vec3| vec3(-0.8 * place.x, place.y, place.z);
            let mirrored: Vec<Vec3> = mesh.positions.iter().map(mirror).collect();
            let mut skin = MovedSkin::default();
            assert!(skin.take(&mesh, &BodyFrame::REST.with_skin(mirrored)));
            let [positions, normals] = skin.shape(&mesh);
            assert!(positions.iter().zip(normals).all(|(place, normal)| place.dot(*normal) > 0.5));
        }
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
