use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::{UVec3, Vec3};
use rayon::prelude::*;

use super::Mannequin;
use crate::{Mesh, SignedDistance};

/// Spacing of the samples \[m\].
const SPACING: f32 = 0.0022;
/// Newton steps that carry the vertices onto the skin.
const NEWTON_STEPS: usize = 4;
/// No step is longer \[m\], so that a vertex in a crease stays there.
const LONGEST_STEP: f32 = 0.004;

/// Meshes the skin.
pub(super) fn mesh(mannequin: &Mannequin) -> Mesh {
    let bounds = mannequin.bounds();
    let origin = bounds.min - Vec3::splat(2.0 * SPACING);
    let size = ((bounds.max - origin) / SPACING).as_uvec3() + UVec3::splat(4);
    let samples = sample(mannequin, origin, size);
    let mut buffer = SurfaceNetsBuffer::default();
    let shape = RuntimeShape::<u32, 3>::new(size.to_array());
    surface_nets(&samples, &shape, [0; 3], (size - UVec3::ONE).to_array(), &mut buffer);
    let (positions, normals): (Vec<Vec3>, Vec<Vec3>) = buffer
        .positions
        .par_iter()
        .map(|&cell| settle(mannequin, origin + Vec3::from_array(cell) * SPACING))
        .unzip();
    let triangles = buffer.indices.chunks_exact(3).map(|corner| [corner[0], corner[1], corner[2]]).collect();
    Mesh { positions, normals, triangles }
}

/// Values on a grid, x fastest. Bricks that the skin cannot reach are filled from one sample.
fn sample(mannequin: &Mannequin, origin: Vec3, size: UVec3) -> Vec<f32> {
    const BRICK: u32 = 4;
    let row = (size.x * size.y) as usize;
    let mut samples = vec![0.0; row * size.z as usize];
    let bricks = UVec3::new(size.x.div_ceil(BRICK), size.y.div_ceil(BRICK), 0);
    let reach = 0.5 * (BRICK as f32) * SPACING * 3f32.sqrt();
    samples.par_chunks_mut(row * BRICK as usize).enumerate().for_each(|(slab, values)| {
        let depth = (values.len() / row) as u32;
        let first_layer = slab as u32 * BRICK;
        for brick_y in 0..bricks.y {
            for brick_x in 0..bricks.x {
                let corner = UVec3::new(brick_x * BRICK, brick_y * BRICK, first_layer);
                let middle = origin + (corner.as_vec3() + 0.5 * BRICK as f32) * SPACING;
                let value = mannequin.distance(middle);
                // The field may rise a little faster than a distance: keep a margin of a half.
                let far = value.abs() > 1.5 * reach;
                for z in 0..depth {
                    for y in corner.y..(corner.y + BRICK).min(size.y) {
                        for x in corner.x..(corner.x + BRICK).min(size.x) {
                            let cell = UVec3::new(x, y, first_layer + z);
                            let index = z as usize * row + (y * size.x + x) as usize;
                            values[index] = if far {
                                value
                            } else {
                                mannequin.distance(origin + cell.as_vec3() * SPACING)
                            };
                        }
                    }
                }
            }
        }
    });
    samples
}

/// Carries a point near the skin onto it; the point and the normal there.
pub(super) fn settle(mannequin: &Mannequin, mut point: Vec3) -> (Vec3, Vec3) {
    for _ in 0..NEWTON_STEPS {
        let field = mannequin.shape.at(point);
        let step = field.gradient * (field.value / field.gradient.length_squared().max(1e-2));
        point -= step.clamp_length_max(LONGEST_STEP);
    }
    (point, mannequin.shape.at(point).gradient.normalize_or(Vec3::Y))
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
