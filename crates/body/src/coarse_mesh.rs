//! A mesh of few triangles in the place of a fine one, for what needs no fine shape, such as its shadow.

use std::collections::HashMap;

use glam::Vec3;

use crate::welding::welded_vertices;
use crate::{BodyFrame, Mesh};

/// Cells per triangle at first, and the factor of a cell's size over what should have been enough.
const CELLS: f32 = 1.2;
const SLACK: f32 = 1.03;
/// Sizes of cells that are tried at most.
const TRIES: usize = 12;

/// Triangles between some of the vertices of a mesh: it moves as the mesh does.
///
/// Of the vertices in each cell of a lattice the one nearest to their mean stands for all \[Rossignac1993\].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CoarseMesh {
    /// Vertices of the mesh that it keeps.
    pub vertices: Vec<u32>,
    /// Corner indices into `vertices`, as the triangles of the mesh are turned.
    pub triangles: Vec<[u32; 3]>,
}

impl CoarseMesh {
    /// One with no more than `most` triangles of those of a mesh that `keeps` names; `None` where cells of no tried size
    /// leave so few.
    pub fn new(mesh: &Mesh, most: usize, keeps: impl Fn(usize) -> bool) -> Option<Self> {
        let kept = mesh.triangles.iter().enumerate().filter(|(index, _)| keeps(*index));
        let triangles: Vec<[u32; 3]> = kept.map(|(_, corners)| *corners).collect();
        if triangles.len() <= most {
            return Some(of_vertices(&triangles));
        }
        let welded = welded_vertices(&mesh.positions);
        let corner = |corner: u32| mesh.positions[corner as usize];
        let area: f32 = triangles.iter().map(|corners| area(corners.map(corner))).sum();
        let mut cell = (CELLS * area / most.max(1) as f32).sqrt();
        for _ in 0..TRIES {
            let clustered = clustered(mesh, &triangles, &welded, cell);
            if clustered.len() <= most {
                return Some(of_vertices(&clustered));
            }
            cell *= SLACK * (clustered.len() as f32 / most.max(1) as f32).sqrt();
        }
        None
    }

    /// Positions \[m\] of its vertices in a frame of the body, world space.
    pub fn place(&self, mesh: &Mesh, body: &BodyFrame, positions: &mut Vec<Vec3>) {
        let head = body.world_from_head();
        positions.clear();
        let at_rest = |vertex: &u32| mesh.positions[*vertex as usize];
        match (mesh.skin_in(body), mesh.bend_in(body)) {
            (Some(skin), _) => {
                positions.extend(self.vertices.iter().map(|vertex| head.point(skin[*vertex as usize])));
            }
            (None, Some(bend)) => {
                positions.extend(self.vertices.iter().map(at_rest));
                bend.places(positions);
                positions.iter_mut().for_each(|position| *position = head.point(*position));
            }
            (None, None) => {
                positions.extend(self.vertices.iter().map(at_rest).map(|place| head.point(place)))
            }
        }
    }
}

fn area([a, b, c]: [Vec3; 3]) -> f32 {
    0.5 * (b - a).cross(c - a).length()
}

/// Triangles between the vertices that stand for all of their cell, without those that have become lines.
fn clustered(mesh: &Mesh, triangles: &[[u32; 3]], welded: &[u32], cell: f32) -> Vec<[u32; 3]> {
    let stands = standing(&mesh.positions, triangles, welded, cell);
    let stand = |corner: u32| stands[welded[corner as usize] as usize];
    let mut clustered: Vec<[u32; 3]> = triangles.iter().map(|corners| corners.map(stand)).collect();
    clustered.retain(|[a, b, c]| a != b && b != c && c != a);
    clustered.iter_mut().for_each(|corners| {
        let least = (0..3).min_by_key(|at| corners[*at]).unwrap_or(0);
        corners.rotate_left(least);
    });
    clustered.sort_unstable();
    // Two that face each other hide and show nothing that others do not.
    let count = |[a, b, c]: [u32; 3]| {
        let first = clustered.partition_point(|known| *known < [a, b, c]);
        clustered[first..].iter().take_while(|known| **known == [a, b, c]).count()
    };
    let mut left = clustered.clone();
    left.dedup();
    left.retain(|&[a, b, c]| count([a, b, c]) > count([a, c, b]));
    left
}

/// For each vertex of triangles the one that stands for its cell.
fn standing(positions: &[Vec3], triangles: &[[u32; 3]], welded: &[u32], cell: f32) -> Vec<u32> {
    let mut used = vec![false; positions.len()];
    triangles.iter().flatten().for_each(|corner| used[welded[*corner as usize] as usize] = true);
    // Numbered as they come, so that nothing depends on the order of a map.
    let mut numbers = HashMap::new();
    let mut cells: Vec<(Vec3, f32)> = Vec::new();
    let cell_of = |(position, used): (&Vec3, &bool)| {
        if !used {
            return usize::MAX;
        }
        let key = (*position / cell).floor().as_i64vec3();
        let number = *numbers.entry(key).or_insert(cells.len());
        if number == cells.len() {
            cells.push((Vec3::ZERO, 0.0));
        }
        cells[number] = (cells[number].0 + *position, cells[number].1 + 1.0);
        number
    };
    let cell_of: Vec<usize> = positions.iter().zip(&used).map(cell_of).collect();
    let mut nearest = vec![(f32::INFINITY, 0); cells.len()];
    for (vertex, number) in cell_of.iter().enumerate().filter(|(_, number)| **number != usize::MAX) {
        let (sum, count) = cells[*number];
        let distance = positions[vertex].distance_squared(sum / count);
        if distance < nearest[*number].0 {
            nearest[*number] = (distance, vertex as u32);
        }
    }
    let stand = |(vertex, number): (usize, &usize)| nearest.get(*number).map_or(vertex as u32, |near| near.1);
    cell_of.iter().enumerate().map(stand).collect()
}

/// Numbers the vertices of triangles from 0.
fn of_vertices(triangles: &[[u32; 3]]) -> CoarseMesh {
    let mut vertices: Vec<u32> = triangles.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let number = |vertex: u32| vertices.partition_point(|known| *known < vertex) as u32;
    let triangles = triangles.iter().map(|corners| corners.map(number)).collect();
    CoarseMesh { vertices, triangles }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DVec3, Quat, vec3};

    use super::*;
    use crate::{Neck, Pose};

    /// A ball of radius 1 whose seam has two vertices at each place.
    fn ball(rings: u32, turns: u32) -> Mesh {
        let place = |ring: u32, turn: u32| {
            let (height, angle) = (ring as f32 / rings as f32, (turn % turns) as f32 / turns as f32);
            let (sine, cosine) = (height * std::f32::consts::PI).sin_cos();
            // All vertices of a pole are at one place.
            let sine = if ring.is_multiple_of(rings) { 0.0 } else { sine };
            let (side, front) = (angle * std::f32::consts::TAU).sin_cos();
            vec3(sine * side, cosine, sine * front)
        };
        let positions = (0..=rings).flat_map(|ring| (0..=turns).map(move |turn| place(ring, turn))).collect();
        let at = |ring: u32, turn: u32| ring * (turns + 1) + turn;
        let cells = (0..rings).flat_map(|ring| (0..turns).map(move |turn| (ring, turn)));
        let triangles = cells.flat_map(|(ring, turn)| {
            let [a, b] = [at(ring, turn), at(ring, turn + 1)];
            let [c, d] = [at(ring + 1, turn), at(ring + 1, turn + 1)];
            [[a, c, b], [b, c, d]]
        });
        Mesh::new(positions, triangles.collect()).unwrap()
    }

    /// Volume and area.
    fn measures(positions: &[Vec3], triangles: &[[u32; 3]]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for corners in triangles {
            let [a, b, c] = corners.map(|corner| DVec3::from(positions[corner as usize]));
            let across = (b - a).cross(c - a);
            sums = [sums[0] + a.dot(across) / 6.0, sums[1] + 0.5 * across.length()];
        }
        sums
    }

    /// Positions of a coarse mesh on a body.
    fn placed(coarse: &CoarseMesh, mesh: &Mesh, body: &BodyFrame) -> Vec<Vec3> {
        let mut positions = Vec::new();
        coarse.place(mesh, body, &mut positions);
        positions
    }

    #[test]
    fn few_triangles_have_the_shape_of_many() {
        let mesh = ball(120, 200);
        for most in [500, 2000, 6000] {
            let coarse = CoarseMesh::new(&mesh, most, |_| true).unwrap();
            let count = coarse.triangles.len();
            assert!(count <= most && 2 * count > most, "{count} of {most}");
            let [volume, area] = measures(&placed(&coarse, &mesh, &BodyFrame::REST), &coarse.triangles);
            let whole = measures(&mesh.positions, &mesh.triangles);
            // Chords across cells lie inside.
            assert!((0.95..1.0).contains(&(volume / whole[0])), "{most}: {volume} of {}", whole[0]);
            assert!((0.96..1.02).contains(&(area / whole[1])), "{most}: {area} of {}", whole[1]);
            // Every edge has a triangle on both sides: there are no holes.
            let edge = |corners: &[u32; 3], at: usize| [corners[at], corners[(at + 1) % 3]];
            let edges = |corners: &[u32; 3]| [0, 1, 2].map(|at| edge(corners, at));
            let mut all: Vec<_> = coarse.triangles.iter().flat_map(edges).collect();
            all.sort_unstable();
            assert!(all.iter().all(|[a, b]| all.binary_search(&[*b, *a]).is_ok()), "{most}");
        }
    }

    #[test]
    fn what_has_few_triangles_stays_and_what_is_not_kept_is_left_out() {
        let mesh = ball(6, 8);
        let whole = CoarseMesh::new(&mesh, mesh.triangles.len(), |_| true).unwrap();
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| whole.vertices[corner as usize]);
        assert!(whole.triangles.iter().map(corners).eq(mesh.triangles.iter().copied()));
        let half = CoarseMesh::new(&mesh, 90, |index| index % 2 == 0).unwrap();
        assert_eq!(half.triangles.len(), mesh.triangles.len() / 2);
        assert_eq!(CoarseMesh::new(&mesh, 10, |_| false).unwrap(), CoarseMesh::default());
    }

    #[test]
    fn it_moves_as_its_mesh_does() {
        let mesh = ball(60, 90);
        let coarse = CoarseMesh::new(&mesh, 800, |_| true).unwrap();
        let head = Pose { rotation: Quat::from_rotation_x(0.4), translation: vec3(0.1, 2.0, 0.3) };
        let rigid = placed(&coarse, &mesh, &BodyFrame::from(head));
        for (place, vertex) in rigid.iter().zip(&coarse.vertices) {
            assert_eq!(*place, head.point(mesh.positions[*vertex as usize]));
        }
        let skin: Arc<[Vec3]> = mesh.positions.iter().map(|place| *place * 1.5).collect();
        let moved = placed(&coarse, &mesh, &BodyFrame::from(head).with_skin(skin.clone()));
        for (place, vertex) in moved.iter().zip(&coarse.vertices) {
            assert_eq!(*place, head.point(skin[*vertex as usize]));
        }
        // A neck that bends.
        let neck = Neck::new(vec3(0.0, -0.1, 0.0));
        let mesh = Mesh { neck: Some(neck), ..mesh };
        let bent = BodyFrame::from(head).with_pieces(neck.pieces(&head, &Pose::IDENTITY));
        let whole = mesh.positions_in(&bent);
        assert_ne!(whole[..], mesh.positions[..]);
        for (place, vertex) in placed(&coarse, &mesh, &bent).iter().zip(&coarse.vertices) {
            assert_eq!(*place, head.point(whole[*vertex as usize]));
        }
    }
}
