use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::{UVec3, Vec3};
use strandline_base::par::prelude::*;

use super::field::Field;
use super::model::Mannequin;
use crate::{Mesh, SignedDistance};

/// Spacing of the samples \[m\].
const SPACING: f32 = 0.0022;
/// Newton steps that carry the vertices onto the skin.
const NEWTON_STEPS: usize = 4;
/// No step is longer \[m\], so that a vertex in a crease stays there.
const LONGEST_STEP: f32 = 0.004;

impl Mannequin {
    /// The surface as triangles: closed, refined onto the skin, with normals from the gradient.
    pub fn mesh(&self) -> Mesh {
        mesh(self, SPACING)
    }

    /// As [`Mannequin::mesh`], of samples this many times as far apart, at least once: with 2 a quarter of the
    /// triangles.
    pub fn coarse_mesh(&self, times: f32) -> Mesh {
        mesh(self, times.max(1.0) * SPACING)
    }

    /// Carries a place near the skin \[m\] onto it: the place on the skin and its unit normal.
    pub fn nearest_skin(&self, point: Vec3) -> (Vec3, Vec3) {
        settle(self, point)
    }

    /// As [`Mannequin::nearest_skin`], with the signed distance \[m\] of what was found: not all skin can be.
    pub(crate) fn settled(&self, point: Vec3) -> (Vec3, f32, Vec3) {
        let (point, field) = newton(self, point);
        let (distance, normal) = self.distance_of(point, &field);
        (point, distance, normal)
    }
}

/// Meshes the skin by samples so far \[m\] apart.
fn mesh(mannequin: &Mannequin, spacing: f32) -> Mesh {
    let bounds = mannequin.bounds();
    let origin = bounds.min - Vec3::splat(2.0 * spacing);
    let size = ((bounds.max - origin) / spacing).as_uvec3() + UVec3::splat(4);
    let samples = sample(mannequin, origin, size, spacing);
    let mut buffer = SurfaceNetsBuffer::default();
    let shape = RuntimeShape::<u32, 3>::new(size.to_array());
    surface_nets(&samples, &shape, [0; 3], (size - UVec3::ONE).to_array(), &mut buffer);
    let (positions, normals): (Vec<Vec3>, Vec<Vec3>) = buffer
        .positions
        .par_iter()
        .map(|&cell| settle(mannequin, origin + Vec3::from_array(cell) * spacing))
        .unzip();
    let triangles = buffer.indices.chunks_exact(3).map(|corner| [corner[0], corner[1], corner[2]]).collect();
    Mesh { positions, normals, triangles, ..Mesh::default() }
}

/// Sides of the bricks \[cells\], the large ones first.
const BRICKS: [u32; 2] = [8, 2];

/// Values on a grid, x fastest. Bricks that the skin cannot reach are filled from one sample.
fn sample(mannequin: &Mannequin, origin: Vec3, size: UVec3, spacing: f32) -> Vec<f32> {
    let layer = (size.x * size.y) as usize;
    let mut samples = vec![0.0; layer * size.z as usize];
    let depth = BRICKS[0] as usize;
    samples.par_chunks_mut(layer * depth).enumerate().for_each(|(slab, values)| {
        let first_layer = (slab * depth) as u32;
        let size = UVec3::new(size.x, size.y, (values.len() / layer) as u32);
        let mut slab = Slab { mannequin, origin, spacing, first_layer, size, values };
        slab.fill(UVec3::ZERO, size, &BRICKS);
    });
    samples
}

/// Some layers of the grid.
struct Slab<'a> {
    mannequin: &'a Mannequin,
    /// Place of the grid's first sample \[m\].
    origin: Vec3,
    /// Spacing of the samples \[m\].
    spacing: f32,
    first_layer: u32,
    size: UVec3,
    values: &'a mut [f32],
}

impl Slab<'_> {
    /// Fills a box in bricks of the first size given, and what the skin may reach in the next smaller ones.
    fn fill(&mut self, from: UVec3, to: UVec3, bricks: &[u32]) {
        let Some((&side, smaller)) = bricks.split_first() else { return self.write(from, to, None) };
        let reach = 0.5 * side as f32 * self.spacing * 3f32.sqrt();
        let starts = |axis: usize| (from[axis]..to[axis]).step_by(side as usize);
        for z in starts(2) {
            for (y, x) in starts(1).flat_map(|y| starts(0).map(move |x| (y, x))) {
                let corner = UVec3::new(x, y, z);
                let value = self.mannequin.distance(self.place(corner.as_vec3() + 0.5 * side as f32));
                let end = (corner + side).min(to);
                // The field may rise a little faster than a distance: keep a margin of a half.
                if value.abs() > 1.5 * reach {
                    self.write(corner, end, Some(value));
                } else {
                    self.fill(corner, end, smaller);
                }
            }
        }
    }

    /// A place \[m\] from a place in the slab \[cells\].
    fn place(&self, mut at: Vec3) -> Vec3 {
        at.z += self.first_layer as f32;
        self.origin + at * self.spacing
    }

    /// Fills a box of nodes with a value; without one, with the distance at each node.
    fn write(&mut self, from: UVec3, to: UVec3, value: Option<f32>) {
        for z in from.z..to.z {
            for y in from.y..to.y {
                for x in from.x..to.x {
                    let index = ((z * self.size.y + y) * self.size.x + x) as usize;
                    let place = self.place(UVec3::new(x, y, z).as_vec3());
                    self.values[index] = value.unwrap_or_else(|| self.mannequin.distance(place));
                }
            }
        }
    }
}

/// Carries a point near the skin onto it; the point and the normal there.
pub(super) fn settle(mannequin: &Mannequin, point: Vec3) -> (Vec3, Vec3) {
    let (point, field) = newton(mannequin, point);
    (point, field.gradient.normalize_or(Vec3::Y))
}

/// The point that some Newton steps toward the skin reach, and the field there.
fn newton(mannequin: &Mannequin, mut point: Vec3) -> (Vec3, Field) {
    let mut field = mannequin.shape.at(point);
    for _ in 0..NEWTON_STEPS {
        let before = point.to_array().map(f32::to_bits);
        let step = field.gradient * (field.value / field.gradient.length_squared().max(1e-2));
        point -= step.clamp_length_max(LONGEST_STEP);
        // All further steps are the same.
        if point.to_array().map(f32::to_bits) == before {
            break;
        }
        field = mannequin.shape.at(point);
    }
    (point, field)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Directed edges that have no partner, and the volume [m^3] by the divergence theorem.
    fn open_edges_and_volume(mesh: &Mesh) -> (usize, f32) {
        let mut balance = BTreeMap::new();
        let mut volume = 0.0;
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                *balance.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        (balance.values().filter(|&&sum| sum != 0).count(), volume)
    }

    #[test]
    fn the_mesh_is_closed_and_faces_outward() {
        let mut mesh = Mannequin::default().mesh();
        let (open, volume) = open_edges_and_volume(&mesh);
        assert_eq!(open, 0);
        // A head holds about 4.5 l, neck and shoulders of the bust about as much again.
        assert!((0.0065..0.012).contains(&volume), "{volume}");
        mesh.triangles.pop();
        assert_ne!(open_edges_and_volume(&mesh).0, 0);
    }

    #[test]
    fn every_vertex_lies_on_the_skin() {
        let mannequin = Mannequin::default();
        let mesh = mannequin.mesh();
        for (vertex, normal) in mesh.positions.iter().zip(&mesh.normals) {
            assert!(mannequin.distance(*vertex).abs() < 1e-4, "{vertex}");
            assert!((normal.length() - 1.0).abs() < 1e-4);
        }
    }
}
