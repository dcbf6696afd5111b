//! Roots of strands on a skin that moves.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use strandline_base::par::{self, prelude::*};

use crate::inside_out::RestVolume;
use crate::polar::rotation_of;
use crate::welding::welded_vertices;
use crate::{BodyFrame, Mesh, Pose};

/// Difference \[m\] of coordinates that turns of the head leave on a skin that rides it: of a triangle of 1 mm it is a thousandth
/// of a degree.
const ROUNDING: f32 = 2e-7;

/// Roots, each at a place of a triangle: they follow the skin of a body frame.
///
/// The rotation of the skin at a vertex is that of the deformation of the triangles around it, by least squares weighted
/// by their areas at rest; a root has the mean of the three corners of its triangle, so that its frame changes evenly
/// from triangle to triangle. Stretch of the skin leaves hair as it is. On a skin that is inside out, a mirror image of that
/// at rest, hair stays outside and is not mirrored: it turns about the normal.
#[derive(Clone, Debug)]
pub struct SkinRoots {
    vertex_count: usize,
    triangles: Vec<[u32; 3]>,
    volume: RestVolume,
    roots: Vec<Place>,
    corners: Vec<Corner>,
    ring: Vec<RingVertex>,
    faces: Vec<RingFace>,
}

/// Place of a root.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// The root and the nearest place of the skin at rest \[m\], head space.
    root: Vec3,
    foot: Vec3,
    /// Corners of the triangle: vertices, their positions at rest \[m\], their index in [`SkinRoots::corners`] and shares.
    vertices: [u32; 3],
    rest: [Vec3; 3],
    corners: [u32; 3],
    shares: Vec3,
}

/// The triangles around a place of the mesh: ranges of [`SkinRoots::ring`] and [`SkinRoots::faces`].
#[derive(Clone, Debug)]
struct Corner {
    /// Mean normal at rest, of any length.
    normal: DVec3,
    ring: Range<usize>,
    faces: Range<usize>,
}

/// Part of a vertex in a deformation: its position times this row \[1/m\].
#[derive(Clone, Copy, Debug)]
struct RingVertex {
    vertex: u32,
    rest: Vec3,
    row: DVec3,
}

/// Part of the normal of a triangle.
#[derive(Clone, Copy, Debug)]
struct RingFace {
    vertices: [u32; 3],
    row: DVec3,
}

impl SkinRoots {
    /// Finds the places of roots \[m\], head space, on a mesh at rest.
    pub fn new(mesh: &Mesh, roots: &[Vec3]) -> Self {
        let welded = welded_vertices(&mesh.positions);
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
        for (index, corners) in mesh.triangles.iter().enumerate() {
            corners.iter().for_each(|corner| around[welded[*corner as usize] as usize].push(index as u32));
        }
        let mut found = Self {
            vertex_count: mesh.positions.len(),
            triangles: mesh.triangles.clone(),
            volume: RestVolume::new(&mesh.positions, &mesh.triangles),
            roots: Vec::with_capacity(roots.len()),
            corners: Vec::new(),
            ring: Vec::new(),
            faces: Vec::new(),
        };
        let mut corner_of = vec![u32::MAX; mesh.positions.len()];
        for (root, (triangle, shares)) in roots.iter().zip(mesh.nearest_triangles(roots)) {
            let own = mesh.triangles.get(triangle as usize).or(mesh.triangles.first());
            let Some(vertices) = own.copied() else { break };
            let corners = vertices.map(|vertex| {
                let first = welded[vertex as usize] as usize;
                if corner_of[first] == u32::MAX {
                    corner_of[first] = found.corners.len() as u32;
                    found.add_corner(mesh, &around[first]);
                }
                corner_of[first]
            });
            let rest = vertices.map(|vertex| mesh.positions[vertex as usize]);
            let foot = weighted(rest, shares);
            found.roots.push(Place { root: *root, foot, vertices, rest, corners, shares });
        }
        found
    }

    /// Adds the deformation of some triangles.
    fn add_corner(&mut self, mesh: &Mesh, triangles: &[u32]) {
        let place = |vertex: u32| mesh.positions[vertex as usize].as_dvec3();
        let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        let all = || triangles.iter().map(|index| mesh.triangles[*index as usize]);
        let cross = |[a, b, c]: [u32; 3]| (place(b) - place(a)).cross(place(c) - place(a));
        let (mut area, mut squares) = (0.0, 0.0);
        for corners in all() {
            area += cross(corners).length();
            squares += edges(corners).iter().map(|[a, b]| place(*a).distance_squared(place(*b))).sum::<f64>();
        }
        let (ring, faces) = (self.ring.len(), self.faces.len());
        // A normal counts as much as an edge of mean length.
        let size = squares / (3 * triangles.len()).max(1) as f64;
        let (mut sum, mut mean) = (DMat3::ZERO, DVec3::ZERO);
        for corners in all() {
            mean += cross(corners);
            let (weight, normal) = (cross(corners).length() / area, cross(corners).normalize_or_zero());
            for [start, end] in edges(corners) {
                let edge = place(end) - place(start);
                sum += outer(edge, edge * weight);
                self.add_vertex(ring, mesh, end, edge * weight);
                self.add_vertex(ring, mesh, start, -edge * weight);
            }
            sum += outer(normal, normal * (weight * size));
            self.faces.push(RingFace { vertices: corners, row: normal * (weight * size) });
        }
        let is_sound = sum.determinant() > 1e-12 * size.powi(3);
        let inverse = if is_sound { sum.inverse() } else { DMat3::ZERO };
        self.ring[ring..].iter_mut().for_each(|vertex| vertex.row = inverse.transpose() * vertex.row);
        self.faces[faces..].iter_mut().for_each(|face| face.row = inverse.transpose() * face.row);
        let [ring, faces] = [ring..self.ring.len(), faces..self.faces.len()];
        self.corners.push(Corner { normal: mean, ring, faces });
    }

    /// Adds to the row of a vertex among those from `first` on.
    fn add_vertex(&mut self, first: usize, mesh: &Mesh, vertex: u32, row: DVec3) {
        match self.ring[first..].iter_mut().find(|known| known.vertex == vertex) {
            Some(known) => known.row += row,
            None => self.ring.push(RingVertex { vertex, rest: mesh.positions[vertex as usize], row }),
        }
    }

    /// A body frame with the root frames that follow from its skin. A frame without a skin of the mesh, or with root
    /// frames of its own, is returned as it is. Where the skin has no area a root keeps the rotation of the `last` frame.
    pub fn placed(&self, body: BodyFrame, last: &BodyFrame) -> BodyFrame {
        let Some(skin) = body.skin().filter(|skin| skin.len() == self.vertex_count).cloned() else {
            return body;
        };
        if body.roots().is_some() || self.roots.is_empty() {
            return body;
        }
        let roots = par::awake(|| self.poses(&skin, &body, last));
        body.with_skin_roots(roots)
    }

    /// Root frames on a skin.
    fn poses(&self, skin: &[Vec3], body: &BodyFrame, last: &BodyFrame) -> Arc<[Pose]> {
        let side = f64::from(self.volume.side(skin, &self.triangles));
        let turns: Vec<Option<DQuat>> =
            self.corners.par_iter().map(|corner| self.rotation(corner, skin, side)).collect();
        let world_from_head = body.world_from_head();
        let head_from_last = last.world_from_head().inverse();
        let root = |(index, place): (usize, &Place)| {
            let rotation = place
                .rotation(&turns)
                .unwrap_or_else(|| (head_from_last.rotation * last.root(index).rotation).normalize());
            place.frame(rotation, skin).carried_by(&world_from_head)
        };
        self.roots.par_iter().enumerate().map(root).collect()
    }

    /// A frame that was saved with its root frames: where they follow from its skin, they do so in frames between it and
    /// others too.
    pub fn recognized(&self, body: BodyFrame) -> BodyFrame {
        let placed = self.placed(body.clone().without_roots(), &body);
        if body.roots().is_some() && placed == body { placed } else { body }
    }

    /// Rotation of the skin about a place of the mesh, whose triangles face outward (1) or inward (-1); `None` where it has
    /// no area.
    fn rotation(&self, corner: &Corner, skin: &[Vec3], side: f64) -> Option<DQuat> {
        let ring = &self.ring[corner.ring.clone()];
        let is_at_rest = |known: &RingVertex| skin[known.vertex as usize].abs_diff_eq(known.rest, ROUNDING);
        if ring.iter().all(is_at_rest) {
            return Some(DQuat::IDENTITY);
        }
        let origin = skin[ring.first()?.vertex as usize].as_dvec3();
        let mut deformation = DMat3::ZERO;
        for RingVertex { vertex, row, .. } in ring {
            deformation += outer(skin[*vertex as usize].as_dvec3() - origin, *row);
        }
        for RingFace { vertices, row } in &self.faces[corner.faces.clone()] {
            let [a, b, c] = vertices.map(|vertex| skin[vertex as usize].as_dvec3());
            deformation += outer((b - a).cross(c - a).normalize_or_zero() * side, *row);
        }
        if side < 0.0 {
            deformation *= mirror_along(corner.normal);
        }
        rotation_of(deformation)
    }
}

impl Place {
    /// Mean of the rotations of the corners; `None` where none of them has one.
    fn rotation(&self, turns: &[Option<DQuat>]) -> Option<Quat> {
        let turns = self.corners.map(|corner| turns[corner as usize]);
        let first = turns.into_iter().flatten().next()?;
        if turns == [Some(DQuat::IDENTITY); 3] {
            return Some(Quat::IDENTITY);
        }
        let mut sum = first * 1e-9;
        for (turn, share) in turns.into_iter().zip(self.shares.to_array()) {
            let Some(turn) = turn else { continue };
            let share = f64::from(share) * if turn.dot(first) < 0.0 { -1.0 } else { 1.0 };
            sum += turn * share;
        }
        Some(sum.normalize().as_quat().normalize())
    }

    /// Root frame in head space.
    fn frame(&self, rotation: Quat, skin: &[Vec3]) -> Pose {
        let moved = [0, 1, 2].map(|corner| skin[self.vertices[corner] as usize] - self.rest[corner]);
        let above = self.root - self.foot;
        let root = self.root + weighted(moved, self.shares) + (rotation * above - above);
        Pose { rotation, translation: root - rotation * self.root }
    }
}

/// Mirrors along a direction of the skin, across its normal and nearest to the axis from ear to ear.
fn mirror_along(normal: DVec3) -> DMat3 {
    let normal = normal.normalize_or(DVec3::Y);
    let along = (DVec3::X - normal * normal.x).try_normalize().unwrap_or(DVec3::Z);
    DMat3::IDENTITY - outer(along, along * 2.0)
}

fn weighted([a, b, c]: [Vec3; 3], shares: Vec3) -> Vec3 {
    a * shares.x + b * shares.y + c * shares.z
}

/// The matrix of column times row.
fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
}
