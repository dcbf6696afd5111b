use std::sync::Arc;

use glam::Vec3;

use crate::welding::welded_vertices;
use crate::{Aabb, BodyError, Materials, Neck};

/// Largest coordinate that is taken for a place \[m\].
const COORDINATE_LIMIT: f32 = 1e7;

/// A triangle mesh in head space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions \[m\].
    pub positions: Vec<Vec3>,
    /// Unit vertex normals, one for each position.
    pub normals: Vec<Vec3>,
    /// Corner indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Looks of its parts, where it has some.
    pub materials: Option<Arc<Materials>>,
    /// The neck of a bust whose shoulders are a piece of their own.
    pub neck: Option<Neck>,
}

impl Mesh {
    /// A mesh with normals that are the means of the faces around a vertex, weighted by their angles there.
    ///
    /// # Errors
    /// There must be triangles, their indices in range, and all positions finite.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, BodyError> {
        let mut mesh = Self { positions, triangles, ..Self::default() };
        mesh.check_usable()?;
        mesh.normals = vertex_normals(&mesh.positions, &mesh.triangles);
        Ok(mesh)
    }

    /// The mesh, with computed normals where it has none or another number than vertices.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn checked(self) -> Result<Self, BodyError> {
        self.check_usable()?;
        if self.normals.len() == self.positions.len() {
            return Ok(self);
        }
        let computed = Self::new(self.positions, self.triangles)?;
        Ok(Self { materials: self.materials, ..computed })
    }

    /// Adds the triangles of another mesh to these.
    ///
    /// # Errors
    /// More vertices than indices can name.
    pub fn append(&mut self, other: &Self) -> Result<(), BodyError> {
        let count = self.positions.len() + other.positions.len();
        let (first, Ok(_)) = (self.positions.len() as u32, u32::try_from(count)) else {
            let found = format!("{count} vertices with those of another");
            return Err(BodyError::BadMesh { found, expected: "4,294,967,295 at most" });
        };
        self.append_materials(other);
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        Ok(())
    }

    fn append_materials(&mut self, other: &Self) {
        if self.materials.is_none() && other.materials.is_none() {
            return;
        }
        let of = |mesh: &Self| match &mesh.materials {
            Some(materials) => materials.clone(),
            None => Arc::new(Materials::plain(mesh.triangles.len())),
        };
        let mut materials = Materials::clone(&of(self));
        materials.append([self.positions.len(), other.positions.len()], &of(other));
        self.materials = Some(Arc::new(materials));
    }

    /// Refuses a mesh that is empty, or has invalid indices or positions.
    pub(crate) fn check_usable(&self) -> Result<(), BodyError> {
        let bad = |found: String, expected| Err(BodyError::BadMesh { found, expected });
        if self.positions.is_empty() {
            return bad("no vertices".into(), "at least three");
        }
        if self.triangles.is_empty() {
            return bad("no triangles".into(), "at least one");
        }
        let outside =
            |position: &Vec3| !position.is_finite() || position.abs().max_element() >= COORDINATE_LIMIT;
        if let Some(index) = self.positions.iter().position(outside) {
            let found = format!("vertex {index} at {}", self.positions[index]);
            return bad(found, "finite coordinates below 10,000 km");
        }
        let count = self.positions.len();
        let beyond = |triangle: &[u32; 3]| triangle.iter().any(|corner| *corner as usize >= count);
        if let Some(index) = self.triangles.iter().position(beyond) {
            let [a, b, c] = self.triangles[index];
            let found = format!("triangle {index} between the vertices {a}, {b}, {c} of {count}");
            return bad(found, "indices below the number of vertices");
        }
        if self.materials.as_ref().is_some_and(|materials| !materials.fit(count, self.triangles.len())) {
            return bad("materials of another mesh".into(), "a material for each triangle");
        }
        Ok(())
    }

    /// The box around all vertices; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<Aabb> {
        let first = *self.positions.first()?;
        let start = Aabb { min: first, max: first };
        Some(
            self.positions
                .iter()
                .fold(start, |held, p| Aabb { min: held.min.min(*p), max: held.max.max(*p) }),
        )
    }
}

/// Means of the face normals around each place, weighted by the angle of the face there \[Thurmer1998\].
///
/// Vertices at one position get one normal, so that seams do not show. Vertices of no face, or of
/// faces without area, get the y axis.
pub(crate) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    normals_about(&welded_vertices(positions), positions, triangles)
}

/// The same for vertices that were welded before: see [`welded_vertices`].
pub(crate) fn normals_about(welded: &[u32], positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let angles =
            [(b - a).angle_between(c - a), (c - b).angle_between(a - b), (a - c).angle_between(b - c)];
        for (corner, angle) in triangle.iter().zip(angles) {
            if angle.is_finite() {
                sums[welded[*corner as usize] as usize] += normal * angle;
            }
        }
    }
    welded.iter().map(|first| sums[*first as usize].normalize_or(Vec3::Y)).collect()
}
