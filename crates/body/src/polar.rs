//! The rotation nearest to a deformation.

use glam::{DMat3, DQuat};

/// Least determinant, of a matrix whose columns have a mean length of 1, that leaves a rotation.
const LEAST_DETERMINANT: f64 = 1e-6;
/// Change at which the iteration has ended, and most iterations: each squares the error.
const ENDED: f64 = 1e-14;
const ITERATIONS: usize = 24;

/// The rotation of the polar decomposition, by Newton's iteration \[Higham1986\]; `None` for a matrix that is singular,
/// mirrors or is not finite.
pub(crate) fn rotation_of(deformation: DMat3) -> Option<DQuat> {
    let squares = |matrix: &DMat3| {
        matrix.x_axis.length_squared() + matrix.y_axis.length_squared() + matrix.z_axis.length_squared()
    };
    let size = (squares(&deformation) / 3.0).sqrt();
    let mut matrix = deformation * (1.0 / size);
    // Comparisons with numbers that are none are false.
    if !(size > 0.0 && size.is_finite() && matrix.determinant() > LEAST_DETERMINANT) {
        return None;
    }
    for _ in 0..ITERATIONS {
        let back = matrix.inverse().transpose();
        let next = (matrix + back) * 0.5;
        let change = squares(&(next - matrix));
        matrix = next;
        if change < ENDED {
            break;
        }
    }
    Some(DQuat::from_mat3(&matrix).normalize())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn stretch_leaves_the_rotation_as_it_is() {
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.4);
        let axes = DMat3::from_quat(DQuat::from_rotation_y(0.5));
        for stretch in [DVec3::ONE, DVec3::splat(1e-3), DVec3::new(3.0, 0.2, 1.0), DVec3::new(1e3, 1e3, 1.0)]
        {
            let stretched = axes * DMat3::from_diagonal(stretch) * axes.transpose();
            let found = rotation_of(DMat3::from_quat(turn) * stretched).unwrap();
            assert!(found.dot(turn).abs() > 1.0 - 1e-12, "{stretch}: {found}");
        }
    }

    #[test]
    fn a_matrix_without_a_rotation_gives_none() {
        for columns in [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, -1.0), DVec3::ZERO, DVec3::NAN] {
            assert_eq!(rotation_of(DMat3::from_diagonal(columns)), None);
        }
    }
}
