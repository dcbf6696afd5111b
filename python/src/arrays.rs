//! Arrays of numpy, as the engine has them.

use bytemuck::{Pod, cast_slice};
use glam::{Mat4, Quat, Vec3};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use strandline::Pose;

use crate::errors;

/// Deviation of a rotation's products from 0 and 1 that matrices of single precision have.
const TOLERANCE: f32 = 1e-3;

/// Numbers of an array in memory order, after a check of its shape: `None` is any length.
pub fn numbers<T: Element + Copy>(
    array: &PyReadonlyArrayDyn<'_, T>,
    name: &str,
    shape: &[Option<usize>],
) -> PyResult<Vec<T>> {
    let found = array.shape();
    let fits = found.len() == shape.len()
        && found.iter().zip(shape).all(|(found, wanted)| wanted.is_none_or(|wanted| wanted == *found));
    if !fits {
        let wanted: Vec<_> =
            shape.iter().map(|length| length.map_or("n".to_owned(), |length| length.to_string())).collect();
        let text = format!("{name} has the shape {found:?}, expected [{}]", wanted.join(", "));
        return Err(errors::value(array.py(), &text));
    }
    match array.as_slice() {
        Ok(numbers) => Ok(numbers.to_vec()),
        Err(_) => {
            let text = format!("{name} is not contiguous, expected an array in C order");
            Err(errors::value(array.py(), &text))
        }
    }
}

/// Points of an array of rows of three.
pub fn points(array: &PyReadonlyArrayDyn<'_, f32>, name: &str) -> PyResult<Vec<Vec3>> {
    let numbers = numbers(array, name, &[None, Some(3)])?;
    Ok(numbers.as_chunks::<3>().0.iter().map(|point| Vec3::from_array(*point)).collect())
}

/// An array of rows, `columns` numbers each.
pub fn rows<'py, T: Element + Pod, R: Pod>(
    py: Python<'py>,
    rows: &[R],
    columns: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let numbers: &[T] = cast_slice(rows);
    let array = PyArray1::from_slice(py, numbers);
    Ok(array.reshape([numbers.len() / columns.max(1), columns])?.into_any())
}

/// An array of numbers.
pub fn list<'py, T: Element>(py: Python<'py>, numbers: Vec<T>) -> Bound<'py, PyAny> {
    PyArray1::from_vec(py, numbers).into_any()
}

/// A rigid transform of a 4 x 4 matrix that is multiplied with columns, rows as numpy has them.
pub fn pose(py: Python<'_>, rows: [[f32; 4]; 4]) -> PyResult<Pose> {
    let matrix = Mat4::from_cols_array_2d(&rows).transpose();
    let (axes, identity) = (glam::Mat3::from_mat4(matrix), glam::Mat3::IDENTITY);
    let is_rigid = (axes.transpose() * axes).abs_diff_eq(identity, TOLERANCE)
        && axes.determinant() > 0.0
        && (matrix.row(3) - glam::Vec4::W).length() < TOLERANCE
        && matrix.is_finite();
    if !is_rigid {
        let text = "head is a matrix with a scale, a mirror or no finite numbers, expected a rotation and a \
                    translation [m], the last row 0, 0, 0, 1";
        return Err(errors::value(py, text));
    }
    let rotation = Quat::from_mat3(&axes).normalize();
    Ok(Pose { rotation, translation: matrix.w_axis.truncate() })
}

/// The 4 x 4 matrix of a rigid transform, rows as numpy has them.
pub fn matrix(pose: &Pose) -> [[f32; 4]; 4] {
    Mat4::from_rotation_translation(pose.rotation, pose.translation).transpose().to_cols_array_2d()
}
