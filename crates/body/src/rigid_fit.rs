//! The rigid transform that carries points nearest to others.

use glam::{DQuat, DVec3, Vec3};

use crate::Pose;

/// Sweeps of rotations after which a matrix of four rows is diagonal in double precision.
const SWEEPS: usize = 12;

/// The rigid transform that carries the points of some indices nearest to those of another list, by the sum of squared
/// distances; the identity where all of them stay. Points that coincide are carried without a rotation. // [Horn1987]
pub(crate) fn rigid_fit(from: &[Vec3], to: &[Vec3], indices: &[u32]) -> Pose {
    let pairs = || indices.iter().map(|index| (from[*index as usize], to[*index as usize]));
    if pairs().all(|(from, to)| from == to) {
        return Pose::IDENTITY;
    }
    let share = 1.0 / indices.len() as f64;
    let (mut from_center, mut to_center) = (DVec3::ZERO, DVec3::ZERO);
    for (from, to) in pairs() {
        from_center += share * from.as_dvec3();
        to_center += share * to.as_dvec3();
    }
    let mut products = [[0.0; 3]; 3];
    for (from, to) in pairs() {
        let from = (from.as_dvec3() - from_center).to_array();
        let to = (to.as_dvec3() - to_center).to_array();
        for (row, from) in products.iter_mut().zip(from) {
            row.iter_mut().zip(to).for_each(|(sum, to)| *sum += from * to);
        }
    }
    let rotation = best_rotation(products);
    Pose {
        rotation: rotation.as_quat().normalize(),
        translation: (to_center - rotation * from_center).as_vec3(),
    }
}

/// The rotation that makes the trace of its product with sums of products `[from][to]` largest.
fn best_rotation([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]: [[f64; 3]; 3]) -> DQuat {
    let matrix = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let [w, x, y, z] = largest_eigenvector(matrix);
    let rotation = DQuat::from_xyzw(x, y, z, w);
    if rotation.is_finite() && rotation.length_squared() > 0.5 {
        rotation.normalize()
    } else {
        DQuat::IDENTITY
    }
}

/// The eigenvector of the largest eigenvalue of a symmetric matrix; of equal ones that of the lowest axis. Cyclic
/// rotations of Jacobi.
fn largest_eigenvector(mut matrix: [[f64; 4]; 4]) -> [f64; 4] {
    let mut vectors = [[0.0; 4]; 4];
    (0..4).for_each(|axis| vectors[axis][axis] = 1.0);
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            if matrix[p][q] == 0.0 {
                continue;
            }
            let ratio = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
            let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            for row in &mut matrix {
                (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
            }
            for column in 0..4 {
                let (upper, lower) = (matrix[p][column], matrix[q][column]);
                matrix[p][column] = cosine * upper - sine * lower;
                matrix[q][column] = sine * upper + cosine * lower;
            }
            for row in &mut vectors {
                (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
            }
        }
    }
    let best = (1..4).fold(0, |best, axis| if matrix[axis][axis] > matrix[best][best] { axis } else { best });
    vectors.map(|row| row[best])
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    #[test]
    fn a_rigid_motion_is_found_at_any_angle() {
        let from: Vec<Vec3> =
            (0..40).map(|i| Vec3::new((i % 5) as f32, (i % 7) as f32, (i % 3) as f32) * 0.05).collect();
        let all: Vec<u32> = (0..40).collect();
        for degrees in [0.01_f32, 5.0, 90.0, 179.9, 180.0] {
            let axis = Vec3::new(1.0, -2.0, 0.5).normalize();
            let pose = Pose {
                rotation: Quat::from_axis_angle(axis, degrees.to_radians()),
                translation: Vec3::new(0.3, 1.5, -2.0),
            };
            let to: Vec<Vec3> = from.iter().map(|point| pose.point(*point)).collect();
            let found = rigid_fit(&from, &to, &all);
            for (from, to) in from.iter().zip(&to) {
                assert!(found.point(*from).distance(*to) < 1e-6, "{degrees}");
            }
        }
        assert_eq!(rigid_fit(&from, &from, &all), Pose::IDENTITY);
    }

    #[test]
    fn points_without_a_rotation_are_carried() {
        let (from, to) = (vec![Vec3::X; 3], vec![Vec3::Y; 3]);
        let found = rigid_fit(&from, &to, &[0, 1, 2]);
        assert_eq!(found, Pose { translation: Vec3::Y - Vec3::X, ..Pose::IDENTITY });
        // A mirror image has no rotation of its own; a scale does not count.
        let from = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X];
        let mirrored = from.map(|point| point * Vec3::new(-2.0, 2.0, 2.0));
        assert!(rigid_fit(&from, &mirrored, &[0, 1, 2, 3]).rotation.is_normalized());
        let larger = from.map(|point| point * 3.0);
        assert!(rigid_fit(&from, &larger, &[0, 1, 2, 3]).rotation.angle_between(Quat::IDENTITY) < 1e-6);
    }
}
