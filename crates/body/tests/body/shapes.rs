//! Meshes whose distance is known, and slow sure ways to measure any.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use strandline_body::Mesh;

/// A ball of triangles, refined `depth` times from an octahedron; all corners are on the sphere.
pub fn ball(center: Vec3, radius: f32, depth: u32) -> Mesh {
    let mut faces = Vec::new();
    for signs in 0..8 {
        let axis = |bit: u32, axis: Vec3| if signs >> bit & 1 == 0 { axis } else { -axis };
        let [x, y, z] = [axis(0, Vec3::X), axis(1, Vec3::Y), axis(2, Vec3::Z)];
        faces.push(if x.cross(y).dot(z) > 0.0 { [x, y, z] } else { [x, z, y] });
    }
    for _ in 0..depth {
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let positions = faces.iter().flatten().map(|corner| center + *corner * radius).collect();
    let triangles = (0..faces.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    Mesh::new(positions, triangles).unwrap()
}

/// Both meshes as one.
pub fn together(one: &Mesh, other: &Mesh) -> Mesh {
    let first = one.positions.len() as u32;
    let shifted = other.triangles.iter().map(|triangle| triangle.map(|corner| corner + first));
    Mesh::new(
        one.positions.iter().chain(&other.positions).copied().collect(),
        one.triangles.iter().copied().chain(shifted).collect(),
    )
    .unwrap()
}

/// The same surface with its triangles turned over.
pub fn inside_out(mesh: &Mesh) -> Mesh {
    let triangles = mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    Mesh::new(mesh.positions.clone(), triangles).unwrap()
}

/// The triangles whose centre a test keeps.
pub fn part(mesh: &Mesh, keeps: impl Fn(Vec3) -> bool) -> Mesh {
    let center = |triangle: &[u32; 3]| {
        triangle.iter().map(|corner| mesh.positions[*corner as usize]).sum::<Vec3>() / 3.0
    };
    let triangles = mesh.triangles.iter().filter(|triangle| keeps(center(triangle))).copied().collect();
    Mesh::new(mesh.positions.clone(), triangles).unwrap()
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.positions[corner as usize].as_dvec3()))
}

/// Distance \[m\] to the nearest of all triangles, in double precision.
pub fn distance_by_search(mesh: &Mesh, point: Vec3) -> f64 {
    let point = point.as_dvec3();
    corners(mesh).map(|corners| distance_to_triangle(point, corners)).fold(f64::INFINITY, f64::min)
}

/// The nearest of the three edges, and of the foot of the perpendicular where it is within.
fn distance_to_triangle(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let edges = [(a, b), (b, c), (c, a)];
    let along_edges = edges.map(|(start, end)| {
        let axis = end - start;
        let share = ((point - start).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        point.distance(if share.is_nan() { start } else { start + axis * share })
    });
    let nearest = along_edges.into_iter().fold(f64::INFINITY, f64::min);
    let normal = (b - a).cross(c - a);
    let within = edges.iter().all(|(start, end)| (*end - *start).cross(point - *start).dot(normal) >= 0.0);
    match normal.try_normalize() {
        Some(unit) if within => nearest.min((point - a).dot(unit).abs()),
        _ => nearest,
    }
}

/// Winding number of the surface around a point: the sum of solid angles [Jacobson2013, eq. 5 and 6].
pub fn winding_number(mesh: &Mesh, point: Vec3) -> f64 {
    let point = point.as_dvec3();
    let angles = corners(mesh).map(|corners| {
        let [a, b, c] = corners.map(|corner| corner - point);
        let [la, lb, lc] = [a.length(), b.length(), c.length()];
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// A file of the grooms folder, if the folder is there.
#[expect(clippy::print_stdout, reason = "the run of the tests says what it left out")]
pub fn supplied(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("STRANDLINE_GROOMS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/grooms"), PathBuf::from);
    let path = folder.join(name);
    if !path.is_file() {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_GROOMS").is_none(), "no grooms folder");
        println!("skipped: no grooms folder");
        return None;
    }
    Some(path)
}
