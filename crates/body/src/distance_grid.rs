use std::fmt;
use std::ops::{Add, Mul, Sub};

use glam::{UVec3, Vec3, Vec4};
use strandline_base::par::prelude::*;

use crate::lattice::Lattice;
use crate::{Aabb, BodyError, Caps, Mesh, SignedDistance, mesh_distance};

/// Most work that a mesh may be, and how much coarser a grid becomes while it is more: only triangles that
/// cover the box around them many times are.
const MOST_WORK: f64 = 1e8;
const COARSER: f32 = 1.4;

/// Signed distance sampled on a regular grid and interpolated trilinearly.
///
/// The gradient is interpolated too, from central differences at the nodes: it is continuous, so
/// that hair slides over the cells without a jerk, and it is made a unit vector afterwards.
/// Outside the box the distance is a lower bound, no less than 0.7 of the true one, and continuous
/// at the border: after one look-up a point may go so far without another.
#[derive(Clone)]
pub struct DistanceGrid {
    lattice: Lattice,
    inverse_spacing: f32,
    /// Gradient and distance \[m\] at each node, x fastest.
    nodes: Vec<Vec4>,
    /// The distances alone: four times as many stay close to the processor.
    distances: Vec<f32>,
    /// The least distance of the corners of the cell that begins at each node, not below 0, in quarters of a spacing,
    /// rounded down: interpolated distances in the cell are no less. It takes a sixteenth of the nodes' memory.
    least: Vec<u8>,
    /// Planes that a part of a bust lies between.
    caps: Option<Caps>,
    /// Looks at triangles of a mesh by the searches of all nodes.
    looks: [u64; 2],
}

/// Steps of [`DistanceGrid::least`] in a spacing.
const STEPS: f32 = 4.0;

impl DistanceGrid {
    /// Samples a field over its bounds, padded by `padding` \[m\] (two cells at least), at `spacing` \[m\].
    ///
    /// # Errors
    /// The spacing must be above zero, the padding not negative. A grid of more than 1,024 cells a side or
    /// 8 Mi nodes is made coarser (see [`Self::spacing`]); a grid that would need cells of more than 0.1 m is refused.
    pub fn from_field(field: &dyn SignedDistance, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        let lattice = Lattice::around(field.bounds(), spacing, padding)?;
        let mut distances = vec![0.0; lattice.len()];
        let columns = lattice.node_count.x as usize;
        let is_symmetric = field.is_symmetric() && lattice.is_centered();
        let looked_up = if is_symmetric { columns.div_ceil(2) } else { columns };
        distances.par_chunks_mut(columns).enumerate().for_each(|(row, distances)| {
            for (column, distance) in distances[..looked_up].iter_mut().enumerate() {
                *distance = field.distance(lattice.position(lattice.node(row * columns + column)));
            }
            // The other side is the same, the far border first.
            let (near, far) = distances.split_at_mut(looked_up);
            far.iter_mut().rev().zip(near).for_each(|(distance, mirrored)| *distance = *mirrored);
        });
        Ok(Self::from_distances(lattice, distances))
    }

    /// Signed distance of a closed mesh at `spacing` \[m\], padded by `padding` \[m\] (two cells at least).
    ///
    /// Inside is the space that the surface winds around: shells that overlap are joined. A mesh that is
    /// inside out as a whole is taken as if it were not.
    ///
    /// # Errors
    /// An empty or an open mesh has no inside; for the rest see [`Self::from_field`].
    pub fn from_mesh(mesh: &Mesh, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        mesh.check_usable()?;
        let mesh = mesh.without_repeats();
        match mesh.open_edge_count() {
            0 => Self::from_closed(&mesh, spacing, padding),
            open_edge_count => Err(BodyError::OpenMesh { open_edge_count }),
        }
    }

    /// The same for a mesh that may be open, as heads are that end at the neck: every hole is closed
    /// first by a fan of triangles from the middle of its rim.
    ///
    /// Shells inside others (eyes, teeth) do not count.
    ///
    /// # Errors
    /// An empty mesh has no inside; for the rest see [`Self::from_field`].
    pub fn from_open_mesh(mesh: &Mesh, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        mesh.check_usable()?;
        Self::from_closed(&mesh.without_repeats().closed(), spacing, padding)
    }

    /// The same for any mesh: the holes of an open mesh are closed.
    ///
    /// # Errors
    /// As [`Self::from_open_mesh`].
    pub fn of_mesh(mesh: &Mesh, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        if mesh.is_closed() {
            Self::from_mesh(mesh, spacing, padding)
        } else {
            Self::from_open_mesh(mesh, spacing, padding)
        }
    }

    fn from_closed(mesh: &Mesh, spacing: f32, padding: f32) -> Result<Self, BodyError> {
        let bounds = mesh.bounds().unwrap_or(Aabb { min: Vec3::ZERO, max: Vec3::ZERO });
        let mut lattice = Lattice::around(bounds, spacing, padding)?;
        while mesh_distance::work(mesh, lattice.spacing) > MOST_WORK {
            lattice = Lattice::around(bounds, COARSER * lattice.spacing, padding)?;
            if lattice.spacing > Lattice::COARSEST.max(spacing) {
                return Err(BodyError::BadMesh {
                    found: format!("{} triangles that cover its box many times", mesh.triangles.len()),
                    expected: "a surface",
                });
            }
        }
        let (distances, looks) = mesh_distance::at_nodes(mesh, &lattice);
        Ok(Self { looks, ..Self::from_distances(lattice, distances) })
    }

    /// A grid of distances \[m\] at the nodes of a lattice.
    pub(crate) fn from_distances(lattice: Lattice, distances: Vec<f32>) -> Self {
        let inverse_spacing = 1.0 / lattice.spacing;
        let mut nodes = vec![Vec4::ZERO; lattice.len()];
        nodes.par_iter_mut().enumerate().for_each(|(index, node)| {
            let gradient = central_difference(&lattice, &distances, index) * inverse_spacing;
            *node = gradient.extend(distances[index]);
        });
        let least = least(&lattice, &distances);
        Self { lattice, inverse_spacing, nodes, distances, least, caps: None, looks: [0; 2] }
    }

    /// A part of the solid: at the nodes of this grid in a box, which holds the part with some air, the signed distance \[m\]
    /// that `part` makes of that of the whole and a place.
    pub(crate) fn within(&self, bounds: Aabb, part: impl Fn(f32, Vec3) -> f32 + Sync) -> Self {
        let Lattice { origin, spacing, node_count } = self.lattice;
        let node = |place: Vec3| (place - origin) / spacing;
        let first = node(bounds.min).floor().max(Vec3::ZERO).as_uvec3().min(node_count - 2);
        let last = node(bounds.max).ceil().max(Vec3::ZERO).as_uvec3().min(node_count - 1).max(first + 1);
        let lattice = Lattice { origin: self.lattice.position(first), spacing, node_count: last - first + 1 };
        let mut distances = vec![0.0; lattice.len()];
        distances.par_iter_mut().enumerate().for_each(|(index, distance)| {
            let node = lattice.node(index);
            let whole = self.distances[self.lattice.index(first + node)];
            *distance = part(whole, lattice.position(node));
        });
        Self::from_distances(lattice, distances)
    }

    /// The same grid of a part that lies between planes.
    pub(crate) fn with_caps(self, caps: Caps) -> Self {
        Self { caps: Some(caps), ..self }
    }

    /// Planes that a part of a bust lies between.
    pub fn caps(&self) -> Option<&Caps> {
        self.caps.as_ref()
    }

    /// Triangles that the sampling of a mesh visited, and those whose exact distance it computed, summed over all nodes; 0
    /// in a build without debug assertions.
    #[doc(hidden)]
    pub fn looks(&self) -> [u64; 2] {
        self.looks
    }

    /// Distance of neighbouring nodes \[m\]: the requested one, or more.
    pub fn spacing(&self) -> f32 {
        self.lattice.spacing
    }

    /// Place of the first node \[m\].
    pub fn origin(&self) -> Vec3 {
        self.lattice.origin
    }

    /// Gradient and distance \[m\] at each node, x fastest, then y.
    pub fn nodes(&self) -> &[Vec4] {
        &self.nodes
    }

    /// Cells in x, y, z.
    pub fn cells(&self) -> UVec3 {
        self.lattice.node_count - 1
    }

    /// Lower bound of the distance \[m\] of a point from the body, 0 for a point that may be inside. It reads
    /// one byte, the exact distance eight nodes.
    #[inline]
    pub fn distance_at_least(&self, point: Vec3) -> f32 {
        let Aabb { min, max } = self.grid_box();
        let clamped = point.clamp(min, max);
        let at = (clamped - self.lattice.origin) * self.inverse_spacing;
        let cell = at.max(Vec3::ZERO).as_uvec3().min(self.lattice.node_count - 2);
        let steps = f32::from(self.least[self.lattice.index(cell)]);
        beyond(steps * self.lattice.spacing / STEPS, point - clamped)
    }

    /// The box that holds the nodes; it is larger than that of the body by the padding.
    fn grid_box(&self) -> Aabb {
        let Lattice { origin, node_count, .. } = self.lattice;
        Aabb { min: origin, max: self.lattice.position(node_count - 1) }
    }

    /// Numbers of the nodes, interpolated at a point of the box.
    #[inline]
    fn inside_box<T: Interpolated>(&self, numbers: &[T], point: Vec3) -> T {
        let at = (point - self.lattice.origin) * self.inverse_spacing;
        // The last cell also holds its far border.
        let cell = at.max(Vec3::ZERO).as_uvec3().min(self.lattice.node_count - 2);
        let share = at - cell.as_vec3();
        let [nx, ny, _] = self.lattice.node_count.to_array().map(|count| count as usize);
        let corner = self.lattice.index(cell);
        let row = |start: usize| {
            let pair = &numbers[start..start + 2];
            pair[0] + (pair[1] - pair[0]) * share.x
        };
        let layer = |start: usize| {
            let (near, far) = (row(start), row(start + nx));
            near + (far - near) * share.y
        };
        let (near, far) = (layer(corner), layer(corner + nx * ny));
        near + (far - near) * share.z
    }
}

/// Values that can be interpolated.
trait Interpolated: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self> {}

impl<T: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self>> Interpolated for T {}

impl fmt::Debug for DistanceGrid {
    /// Without its millions of nodes.
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.debug_struct("DistanceGrid").field("lattice", &self.lattice).finish_non_exhaustive()
    }
}

impl SignedDistance for DistanceGrid {
    fn distance(&self, point: Vec3) -> f32 {
        let Aabb { min, max } = self.grid_box();
        let clamped = point.clamp(min, max);
        beyond(self.inside_box(&self.distances, clamped), point - clamped)
    }

    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        let Aabb { min, max } = self.grid_box();
        let clamped = point.clamp(min, max);
        let sample = self.inside_box(&self.nodes, clamped);
        let gradient = sample.truncate().normalize_or(Vec3::Y);
        if clamped == point {
            return (sample.w, gradient);
        }
        let outside = point - clamped;
        // Away from the point of the surface that is nearest to the box point: at the border this is the
        // gradient inside.
        let away = outside + gradient * sample.w;
        (beyond(sample.w, outside), away.normalize_or(gradient))
    }

    fn bounds(&self) -> Aabb {
        self.grid_box()
    }
}

/// A lower bound of the distance \[m\] at `outside` \[m\] from the nearest point of the box, where it is `near` \[m\].
///
/// The box is convex and holds the surface, so that at its nearest point the way out and the way to any
/// point of the surface are at a right angle or more: the distance is no less than the hypotenuse.
fn beyond(near: f32, outside: Vec3) -> f32 {
    if outside == Vec3::ZERO {
        return near;
    }
    (near.max(0.0).powi(2) + outside.length_squared()).sqrt()
}

/// The table of [`DistanceGrid::distance_at_least`], shape as the nodes'; cells beyond the last node are of no use.
fn least(lattice: &Lattice, distances: &[f32]) -> Vec<u8> {
    let [nx, layer] = [lattice.node_count.x as usize, lattice.layer_len()];
    let mut least = vec![0; distances.len()];
    let corners = [0, 1, nx, nx + 1].into_iter().flat_map(|corner| [corner, corner + layer]);
    let corners: Vec<usize> = corners.collect();
    least.par_iter_mut().enumerate().for_each(|(index, least)| {
        let of_corner = |corner: &usize| distances.get(index + corner).copied().unwrap_or(f32::NEG_INFINITY);
        let smallest = corners.iter().map(of_corner).fold(f32::INFINITY, f32::min);
        *least = (smallest * STEPS / lattice.spacing).floor().clamp(0.0, 255.0) as u8;
    });
    least
}

/// Difference of the neighbours on either side, for each axis, by two cells;
/// at the border of the node and its one neighbour.
fn central_difference(lattice: &Lattice, distances: &[f32], index: usize) -> Vec3 {
    let node = lattice.node(index).to_array();
    let strides = [1, lattice.node_count.x as usize, lattice.layer_len()];
    let count = lattice.node_count.to_array();
    Vec3::from_array(std::array::from_fn(|axis| {
        let before = if node[axis] > 0 { strides[axis] } else { 0 };
        let after = if node[axis] + 1 < count[axis] { strides[axis] } else { 0 };
        let width = if before > 0 && after > 0 { 2.0 } else { 1.0 };
        (distances[index + after] - distances[index - before]) / width
    }))
}
