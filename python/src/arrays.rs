//! Numbers as arrays of NumPy.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pliant::Sample;
use pyo3::prelude::*;

/// The numbers of each sample, one row after the other: [sample, number].
pub fn rows<'py>(
    py: Python<'py>,
    samples: &[Sample],
    width: usize,
    row: impl Fn(&Sample) -> Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let numbers: Vec<f64> = samples.iter().flat_map(row).collect();
    PyArray1::from_vec(py, numbers).reshape([samples.len(), width])
}

/// Vectors at the nodes of each sample: [sample, node, axis].
pub fn of_nodes<'py>(
    py: Python<'py>,
    samples: &[Sample],
    dimension: usize,
    vectors: impl Fn(&Sample) -> Result<Vec<f64>, PyErr>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let mut numbers = Vec::new();
    for sample in samples {
        numbers.extend(vectors(sample)?);
    }
    let nodes = numbers.len() / samples.len() / dimension;
    PyArray1::from_vec(py, numbers).reshape([samples.len(), nodes, dimension])
}

/// Vectors at nodes: [node, axis].
pub fn vectors<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    dimension: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let nodes = numbers.len() / dimension;
    PyArray1::from_vec(py, numbers).reshape([nodes, dimension])
}
