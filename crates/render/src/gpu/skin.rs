//! The body's mesh on the device.

use glam::Vec3;
use strandline_body::{BodyFrame, Mesh, MovedSkin};
use strandline_gpu::{Buffer, GpuError};
use strandline_groom::Guides;

use super::codes;
use super::records::{Corner, Vertex};
use crate::BodyLook;
use crate::strands::scalp::root_densities;
use crate::surfaces::Surfaces;

/// A mesh whose vertices are written anew where they moved.
pub(super) struct Skin {
    mesh: Option<Mesh>,
    moved: MovedSkin,
    /// Density of roots about each vertex, 0 to 1.
    densities: Vec<f32>,
    /// Its materials, where it has some.
    surfaces: Option<Surfaces>,
    /// A ball around it: middle \[m\], head space, and radius \[m\].
    ball: (Vec3, f32),
    /// See codes.rs.
    kind: u32,
    writes: u64,
}

impl Skin {
    /// The mesh of a body in head space, among the roots of guides.
    pub fn new(mesh: Option<&Mesh>, guides: &Guides) -> Self {
        let positions = mesh.map_or(&[][..], |mesh| &mesh.positions);
        let surfaces = mesh.and_then(Surfaces::new);
        // A body is open where parts of it are cut away.
        let is_whole = !surfaces.as_ref().is_some_and(|surfaces| surfaces.cuts);
        let closed = |mesh: &Mesh| if is_whole && mesh.is_closed() { codes::CLOSED } else { codes::OPEN };
        Self {
            mesh: mesh.cloned(),
            moved: MovedSkin::default(),
            densities: root_densities(positions, guides),
            ball: ball(positions),
            kind: mesh.map_or(codes::NO_BODY, closed),
            surfaces,
            writes: 0,
        }
    }

    /// Takes the skin of a moment, and writes the vertices where they are others than those of the last one.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(&mut self, body: &BodyFrame, vertices: &Buffer<Vertex>) -> Result<(), GpuError> {
        let Some(mesh) = &self.mesh else { return Ok(()) };
        if self.moved.take(mesh, body) {
            self.ball = ball(self.moved.shape(mesh)[0]);
            self.writes += 1;
            vertices.write(&self.vertices())?;
        }
        Ok(())
    }

    /// The vertices as they are now.
    pub fn vertices(&self) -> Vec<Vertex> {
        let Some(mesh) = &self.mesh else { return Vec::new() };
        let [positions, normals] = self.moved.shape(mesh);
        let each = positions.iter().zip(normals).zip(&self.densities);
        each.map(|((position, normal), &roots)| {
            let (position, normal) = (position.to_array(), normal.to_array());
            Vertex { position, roots, normal, unused: 0.0 }
        })
        .collect()
    }

    /// Corners of all triangles.
    pub fn corners(&self) -> &[u32] {
        self.mesh.as_ref().map_or(&[], |mesh| mesh.triangles.as_flattened())
    }

    /// Corners of all triangles with their materials; empty without such.
    pub fn painted_corners(&self) -> Vec<Corner> {
        let corners = self.surfaces.iter().flat_map(|surfaces| &surfaces.corners);
        corners
            .map(|corner| Corner {
                place: corner.place.to_array(),
                material: corner.material,
                density: corner.density,
                color: corner.color.to_array(),
            })
            .collect()
    }

    /// Its materials, where it has some.
    pub fn surfaces(&self) -> Option<&Surfaces> {
        self.surfaces.as_ref()
    }

    /// Forgets materials and textures once they are on the device.
    pub fn forget_surfaces(&mut self) {
        self.surfaces.iter_mut().for_each(Surfaces::forget);
    }

    /// Drawn parts of the materials, in bits: see codes.rs. The mean colour of the body, linear RGB.
    pub fn paint(&self, look: &BodyLook) -> (u32, Vec3) {
        let Some(surfaces) = &self.surfaces else { return (0, look.color) };
        let cut = if surfaces.cuts { codes::CUT } else { 0 };
        match look.materials {
            true => (cut | codes::PAINTED, surfaces.mean_color(look.color)),
            false => (cut, look.color),
        }
    }

    /// Number of vertices; `None` without a body.
    pub fn vertex_count(&self) -> Option<usize> {
        self.mesh.as_ref().map(|mesh| mesh.positions.len())
    }

    /// A ball around it: middle \[m\], head space, and radius \[m\].
    pub fn ball(&self) -> (Vec3, f32) {
        self.ball
    }

    /// Code of the body, none, open or closed: see codes.rs.
    pub fn kind(&self) -> u32 {
        self.kind
    }

    /// Times that moved vertices were written.
    pub fn writes(&self) -> u64 {
        self.writes
    }
}

/// A ball around points: the middle of their box and the way to a corner.
fn ball(positions: &[Vec3]) -> (Vec3, f32) {
    if positions.is_empty() {
        return (Vec3::ZERO, 0.0);
    }
    let (low, high) = positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), &point| (low.min(point), high.max(point)));
    // A hundredth more keeps rounding inside.
    (0.5 * (low + high), 0.505 * low.distance(high))
}
