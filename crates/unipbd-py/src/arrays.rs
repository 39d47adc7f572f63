//! Columns as arrays of NumPy, and back.

use numpy::ndarray::{Array1, Array2};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use unipbd_core::Vector;
use unipbd_core::math::Vector64;

use crate::errors;

/// Vectors in this row order as an (N, 2) array that cannot be written to.
pub fn vectors<'py>(py: Python<'py>, column: &[Vector], rows: &[u32]) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let mut flat = Vec::with_capacity(2 * rows.len());
    for &row in rows {
        let vector = column[row as usize];
        flat.push(single(vector.x));
        flat.push(single(vector.y));
    }
    matrix(py, flat)
}

/// A flat list of pairs as an (N, 2) array that cannot be written to.
pub fn matrix<T: Element>(py: Python<'_>, flat: Vec<T>) -> PyResult<Bound<'_, PyArray2<T>>> {
    let shape = (flat.len() / 2, 2);
    let array = Array2::from_shape_vec(shape, flat).map_err(|error| errors::other(py, &error.to_string()))?;
    let array = PyArray2::from_owned_array(py, array);
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// Values in this row order as an array that cannot be written to.
pub fn gathered<'py, T: Copy, U: Element>(
    py: Python<'py>,
    column: &[T],
    rows: &[u32],
    value: impl Fn(T) -> U,
) -> Bound<'py, PyArray1<U>> {
    fixed(py, rows.iter().map(|&row| value(column[row as usize])).collect())
}

/// Values as an array that cannot be written to.
pub fn fixed<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    let array = PyArray1::from_owned_array(py, Array1::from_vec(values));
    array.readwrite().make_nonwriteable();
    array
}

/// The rows of an (N, 2) array.
pub fn rows(array: &PyReadonlyArray2<'_, f64>) -> Vec<Vector64> {
    array.as_array().rows().into_iter().map(|row| Vector64::new(row[0], row[1])).collect()
}

/// Converts a number of the solver to that of the arrays of Python.
#[allow(clippy::unnecessary_cast)]
pub fn single(value: unipbd_core::Real) -> f32 {
    value as f32
}
