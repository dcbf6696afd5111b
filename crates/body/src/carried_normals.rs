//! Normals of a file on a skin that moves: the triangles about each vertex carry them.

use std::collections::HashMap;

use glam::{Vec3, vec3};
use strandline_base::par::prelude::*;

use crate::Mesh;
use crate::mesh::normals_about;

/// Distance between unit normals up to which those of a file are those of its triangles, and those at one place are one.
const SAME: f32 = 2e-3;
/// Normals at one place that are looked through for one of them: more are of a damaged file.
const MOST_NORMALS: usize = 64;

/// Normals that are not those of the triangles: hard edges, or normals that somebody drew or smoothed.
///
/// A triangle carries a normal by the inverse transpose of its own deformation. Its height is taken to change as the root
/// of its area does, so that scaling leaves normals as they are. Vertices at one place with one normal keep one.
#[derive(Clone, Debug)]
pub(crate) struct CarriedNormals {
    /// Group of each vertex.
    groups: Vec<u32>,
    /// Corners of each group: where those of the next one begin.
    ends: Vec<usize>,
    corners: Vec<Corner>,
    /// Root of the area of each triangle at rest \[m\].
    sizes: Vec<f32>,
}

/// A triangle about a vertex.
#[derive(Clone, Copy, Debug)]
struct Corner {
    triangle: u32,
    /// The normal along the first and the last edge from the triangle's first corner \[m\], and along its own normal;
    /// times the angle at rest \[rad\].
    parts: Vec3,
}

/// Columns of the inverse transpose, which carry the parts of a normal.
type Carrier = [Vec3; 3];

impl CarriedNormals {
    /// Normals of a mesh whose vertices at one place have these first ones; `None` where all are those of its triangles.
    pub fn new(mesh: &Mesh, welded: &[u32]) -> Option<Self> {
        let computed = normals_about(welded, &mesh.positions, &mesh.triangles);
        let is_own = |(normal, computed): (&Vec3, &Vec3)| normal.distance(*computed) > SAME;
        if mesh.normals.len() != welded.len() || !mesh.normals.iter().zip(&computed).any(is_own) {
            return None;
        }
        let groups = groups(&mesh.normals, welded);
        let count = groups.iter().max().map_or(0, |last| *last as usize + 1);
        let mut of_group = vec![Vec3::ZERO; count];
        groups.iter().zip(&mesh.normals).for_each(|(group, normal)| of_group[*group as usize] = *normal);
        let mut about: Vec<Vec<Corner>> = vec![Vec::new(); count];
        let mut sizes = Vec::with_capacity(mesh.triangles.len());
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            let places = corners.map(|corner| mesh.positions[corner as usize]);
            let [a, b, c] = places;
            let cross = (b - a).cross(c - a);
            sizes.push(cross.length().sqrt());
            let Some(face) = cross.try_normalize() else { continue };
            for corner in 0..3 {
                let [here, next, last] = [0, 1, 2].map(|step| places[(corner + step) % 3]);
                let (group, angle) =
                    (groups[corners[corner] as usize], (next - here).angle_between(last - here));
                let normal = of_group[group as usize];
                let parts = angle * vec3((b - a).dot(normal), (c - a).dot(normal), face.dot(normal));
                if parts.is_finite() {
                    about[group as usize].push(Corner { triangle: triangle as u32, parts });
                }
            }
        }
        let mut end = 0;
        let ends = about.iter().map(|corners| {
            end += corners.len();
            end
        });
        Some(Self { groups, ends: ends.collect(), corners: about.concat(), sizes })
    }

    /// Unit normals of all vertices of a skin \[m\], of a mesh with these triangles. Those that no triangle carries, as where
    /// all about them have lost their area, point along y.
    pub fn on(&self, skin: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
        let carrier =
            |(corners, size): (&[u32; 3], &f32)| carrier(corners.map(|at| skin[at as usize]), *size);
        let carriers: Vec<Carrier> =
            triangles.par_iter().zip(&self.sizes[..]).with_min_len(1024).map(carrier).collect();
        let normal = |(group, end): (usize, &usize)| {
            let first = if group == 0 { 0 } else { self.ends[group - 1] };
            let carried = |corner: &Corner| {
                let [along, across, face] = carriers[corner.triangle as usize];
                along * corner.parts.x + across * corner.parts.y + face * corner.parts.z
            };
            self.corners[first..*end].iter().map(carried).sum::<Vec3>().normalize_or(Vec3::Y)
        };
        let normals: Vec<Vec3> = self.ends.par_iter().enumerate().with_min_len(1024).map(normal).collect();
        self.groups.iter().map(|group| normals[*group as usize]).collect()
    }
}

/// For each vertex the number of its place and normal, in the order of the first of them.
fn groups(normals: &[Vec3], welded: &[u32]) -> Vec<u32> {
    let mut at_place: HashMap<u32, Vec<u32>> = HashMap::with_capacity(normals.len());
    let (mut groups, mut firsts) = (Vec::with_capacity(normals.len()), Vec::<Vec3>::new());
    for (place, normal) in welded.iter().zip(normals) {
        let known = at_place.entry(*place).or_default();
        let same = known
            .iter()
            .rev()
            .take(MOST_NORMALS)
            .find(|group| firsts[**group as usize].distance(*normal) < SAME);
        let group = same.copied().unwrap_or_else(|| {
            firsts.push(*normal);
            known.push(firsts.len() as u32 - 1);
            firsts.len() as u32 - 1
        });
        groups.push(group);
    }
    groups
}

/// The carrier of a triangle with these corners \[m\], whose area had this root at rest \[m\]; zeros without an area.
fn carrier([a, b, c]: [Vec3; 3], size: f32) -> Carrier {
    let cross = (b - a).cross(c - a);
    let Some(face) = cross.try_normalize() else { return [Vec3::ZERO; 3] };
    let area = cross.length();
    let taller = if size > 0.0 { area.sqrt() / size } else { 1.0 };
    let carrier = [(c - a).cross(face) * (taller / area), face.cross(b - a) * (taller / area), face];
    if carrier.iter().all(|column| column.is_finite()) { carrier } else { [Vec3::ZERO; 3] }
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat};

    use super::*;
    use crate::welding::welded_vertices;

    /// A cube whose sides have corners and normals of their own.
    fn cube() -> Mesh {
        let mut mesh = Mesh::default();
        for side in 0..6 {
            let axis = Vec3::AXES[side % 3] * if side < 3 { 1.0 } else { -1.0 };
            let [right, up] = [Vec3::AXES[(side + 1) % 3], axis.cross(Vec3::AXES[(side + 1) % 3])];
            let first = mesh.positions.len() as u32;
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            mesh.positions.extend(corners.map(|[x, y]| 0.1 * (axis + right * x + up * y)));
            mesh.normals.extend([axis; 4]);
            mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|at: [u32; 3]| at.map(|corner| first + corner)));
        }
        mesh
    }

    fn carried(mesh: &Mesh, moved: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
        let normals = CarriedNormals::new(mesh, &welded_vertices(&mesh.positions)).unwrap();
        let skin: Vec<Vec3> = mesh.positions.iter().map(|place| moved(*place)).collect();
        normals.on(&skin, &mesh.triangles)
    }

    #[test]
    fn hard_edges_stay_hard_under_any_linear_motion() {
        let mesh = cube();
        assert!(CarriedNormals::new(&mesh.clone(), &welded_vertices(&mesh.positions)).is_some());
        let turn = Mat3::from_quat(Quat::from_axis_angle(vec3(0.6, 0.0, 0.8), 1.3));
        let shear = Mat3::from_cols(vec3(1.4, 0.2, 0.0), vec3(0.3, 0.8, 0.1), vec3(0.0, -0.2, 1.1));
        for motion in [Mat3::IDENTITY, turn, turn * shear, turn * 30.0] {
            let exact = motion.inverse().transpose();
            for (found, rest) in carried(&mesh, |place| motion * place).iter().zip(&mesh.normals) {
                let expected = (exact * *rest).normalize();
                assert!(found.distance(expected) < 1e-5, "{found} for {expected}");
            }
        }
    }

    #[test]
    fn normals_that_are_no_triangle_s_turn_and_scale_with_their_triangles() {
        let mut mesh = cube();
        // As of a ball: at a corner the three sides meet in one normal, which no weights of faces change.
        mesh.normals =
            mesh.positions.iter().map(|place| (*place * vec3(1.0, 2.0, 3.0)).normalize()).collect();
        let turn = Quat::from_axis_angle(vec3(0.0, 0.6, 0.8), 2.1);
        for scale in [1.0, 0.2, 7.0] {
            let found = carried(&mesh, |place| turn * (scale * place) + Vec3::X);
            for (found, rest) in found.iter().zip(&mesh.normals) {
                assert!(found.distance(turn * *rest) < 1e-5, "{found} of {rest}");
            }
            for (index, place) in mesh.positions.iter().enumerate() {
                let first = mesh.positions.iter().position(|other| other == place).unwrap();
                assert_eq!(found[index], found[first], "one place, one normal");
            }
        }
    }

    #[test]
    fn normals_of_the_triangles_are_left_to_them() {
        let cube = cube();
        let mesh = Mesh::new(cube.positions, cube.triangles).unwrap();
        assert!(CarriedNormals::new(&mesh, &welded_vertices(&mesh.positions)).is_none());
    }

    #[test]
    fn triangles_without_area_carry_nothing() {
        let mesh = cube();
        let flat = carried(&mesh, |place| place * vec3(1.0, 0.0, 1.0));
        assert!(flat.iter().all(|normal| normal.is_normalized()));
        assert!(carried(&mesh, |_| Vec3::X).iter().all(|normal| *normal == Vec3::Y));
        assert!(carried(&mesh, |place| 1e-25 * place).iter().all(|normal| normal.is_normalized()));
    }
}
