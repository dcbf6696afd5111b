use std::borrow::Cow;
use std::collections::HashSet;
use std::path::Path;

use glam::Vec3;
use strandline_base::read_plain;

use crate::{Aabb, BodyError, closing, gltf, obj};

/// Largest file that is read \[bytes\]: the parsers need up to 30 times as much memory.
const FILE_LIMIT: u64 = 256 << 20;
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
}

impl Mesh {
    /// A mesh with normals that are the means of the faces around a vertex, weighted by their angles there.
    ///
    /// # Errors
    /// There must be triangles, their indices in range, and all positions finite.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, BodyError> {
        let mut mesh = Self { positions, normals: Vec::new(), triangles };
        mesh.check_usable()?;
        mesh.normals = vertex_normals(&mesh.positions, &mesh.triangles);
        Ok(mesh)
    }

    /// Loads an OBJ or glTF 2.0 file (by its ending: .obj, .gltf, .glb), scaled by `scale` \[m per unit\].
    ///
    /// All objects and scenes of the file become one mesh; polygons become triangles; skins, materials and
    /// animations are ignored. Vertices keep the file's normals; where it gives none they are computed.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load(path: &Path, scale: f32) -> Result<Self, BodyError> {
        if !scale.is_finite() || scale <= 0.0 {
            let expected = "a finite number above zero [m per unit]";
            return Err(BodyError::Value {
                what: "the scale of the mesh",
                found: scale.to_string(),
                expected,
            });
        }
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
        let mut mesh = match ending.as_str() {
            "obj" => obj::read(path)?,
            "gltf" | "glb" => gltf::read(path)?,
            _ => {
                return Err(BodyError::Mesh {
                    path: path.into(),
                    found: format!("the ending `{ending}`"),
                    expected: "obj, gltf or glb",
                    mend: "export the body as OBJ or glTF 2.0",
                });
            }
        };
        mesh.positions.iter_mut().for_each(|position| *position *= scale);
        mesh.complete(path)
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
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        Ok(())
    }

    /// Reads an OBJ file from its bytes, in the units of the file.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_obj(bytes: &[u8]) -> Result<Self, BodyError> {
        Self::from_parsed(obj::parse(bytes))
    }

    /// Reads a glTF 2.0 file, as text or binary, from its bytes, in the units of the file; it must hold its
    /// buffers itself.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_gltf(bytes: &[u8]) -> Result<Self, BodyError> {
        Self::from_parsed(gltf::parse(bytes, None))
    }

    fn from_parsed(parsed: Result<Self, gltf::Refusal>) -> Result<Self, BodyError> {
        parsed.map_err(|(found, expected)| BodyError::BadMesh { found, expected })?.complete(Path::new(""))
    }

    /// Checks what was read and gives a normal to every vertex that has none.
    fn complete(mut self, path: &Path) -> Result<Self, BodyError> {
        self.check_usable().map_err(|error| match error {
            BodyError::BadMesh { found, expected } => BodyError::Mesh {
                path: path.into(),
                found: format!("the mesh has {found}"),
                expected,
                mend: "export it again as triangles",
            },
            other => other,
        })?;
        let computed = vertex_normals(&self.positions, &self.triangles);
        self.normals.resize(self.positions.len(), Vec3::ZERO);
        for (normal, computed) in self.normals.iter_mut().zip(computed) {
            // In double precision: the square of a short one underflows.
            *normal = normal.as_dvec3().try_normalize().map_or(computed, |unit| unit.as_vec3());
        }
        Ok(self)
    }

    /// Refuses a mesh that is empty, or holds indices or positions that are none.
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

    /// Whether the surface has an inside: every edge of a triangle is met by one of a neighbour in the
    /// opposite direction, where vertices at the same position count as one.
    pub fn is_closed(&self) -> bool {
        self.open_edge_count() == 0
    }

    /// How many edges of triangles are met by none in the opposite direction.
    ///
    /// # Panics
    /// As [`Self::is_closed`] and [`Self::closed`], when an index is out of range; loaded meshes have none such.
    pub fn open_edge_count(&self) -> usize {
        closing::open_edges(self).len()
    }

    /// The mesh without triangles that are there before, between the same places and wound the same way: they
    /// add nothing but work.
    pub(crate) fn without_repeats(&self) -> Cow<'_, Self> {
        let welded = closing::welded_vertices(&self.positions);
        let mut known = HashSet::with_capacity(self.triangles.len());
        let is_new = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| welded[corner as usize]);
            known.insert([[a, b, c], [b, c, a], [c, a, b]].into_iter().min())
        };
        let triangles: Vec<_> = self.triangles.iter().copied().filter(is_new).collect();
        if triangles.len() == self.triangles.len() {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self { positions: self.positions.clone(), normals: self.normals.clone(), triangles })
    }

    /// The mesh with every hole closed by a fan of triangles from the middle of its rim.
    pub fn closed(&self) -> Self {
        closing::close(self)
    }
}

/// The bytes of a plain file, unless it is too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, BodyError> {
    read_plain(path, FILE_LIMIT).map_err(|source| BodyError::Read { path: path.into(), source })
}

/// A normal of a file as a unit vector, however short; zero for what is none.
pub(crate) fn unit_normal(normal: Vec3) -> Vec3 {
    // The square of a very short or very long one is no number that could be divided by.
    let largest = normal.abs().max_element();
    if normal.is_finite() && largest > 0.0 { (normal / largest).normalize_or_zero() } else { Vec3::ZERO }
}

/// Means of the face normals around each place, weighted by the angle of the face there \[Thurmer1998\].
///
/// Vertices at one position get one normal, so that seams do not show. Vertices of no face, or of
/// faces without area, get the y axis.
fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let welded = closing::welded_vertices(positions);
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
