//! The one error type of the crate.

use std::fmt::Display;
use std::path::PathBuf;

use crate::simulate::IntegrationFailure;
use crate::statics::NoEquilibrium;

/// What went wrong, with which input, and how to mend it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An input that cannot be used.
    #[error("{input} = {value} cannot be used: {mend}")]
    Input {
        /// Name of the input, in the words of the API.
        input: String,
        /// Its value, as given.
        value: String,
        /// What is allowed, and why.
        mend: String,
    },

    /// A cell of the mesh has no volume, or the wrong sign of it.
    #[error(
        "cell {cell} (nodes {nodes:?}) has the signed volume {volume:.3e}: {mend} (numbers count from 1)"
    )]
    Cell {
        /// Number of the cell, counted from 1.
        cell: usize,
        /// Its nodes, counted from 1.
        nodes: Vec<usize>,
        /// Length, area or volume at its worst quadrature point (m, m^2, m^3).
        volume: f64,
        /// What to do about it.
        mend: String,
    },

    /// A file that no mesh can be read from.
    #[error("cannot read the mesh {}: {problem}", path.display())]
    MeshFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and how to mend it.
        problem: String,
    },

    /// Constraints that contradict or repeat each other.
    #[error("phase `{phase}`: constraints on {nodes} {problem}")]
    Constraint {
        /// Name of the phase.
        phase: String,
        /// The nodes (counted from 1) and axes concerned.
        nodes: String,
        /// What is wrong with them and how to mend it.
        problem: String,
    },

    /// The integrator gave up; what was computed until then is kept inside.
    #[error(transparent)]
    Integration(#[from] Box<IntegrationFailure>),

    /// No equilibrium was found; the last one on the way to it is kept inside.
    #[error(transparent)]
    Statics(#[from] Box<NoEquilibrium>),

    /// A scene file says something that cannot be used.
    #[error("{}:{line}: {message}", path.display())]
    SceneFile {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// The key, what is wrong with it and how to mend it.
        message: String,
    },

    /// A study found no reference to compare with.
    #[error(
        "no two methods solve the scene at rtol {rtol:.0e}, so there is no reference: {mend} ({failures})"
    )]
    Reference {
        /// Relative tolerance.
        rtol: f64,
        /// Why the methods failed.
        failures: String,
        /// What to do about it.
        mend: String,
    },

    /// A file could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },

    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
}

impl Error {
    /// `input` = `value` cannot be used: `mend`.
    pub(crate) fn input(
        input: impl Into<String>,
        value: impl Display,
        mend: impl Into<String>,
    ) -> Self {
        Self::Input { input: input.into(), value: value.to_string(), mend: mend.into() }
    }
}

/// Passes `value` if it is finite and above zero.
pub(crate) fn positive(input: &str, value: f64, unit: &str) -> Result<f64, Error> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(Error::input(input, value, format!("it must be a finite number above 0{}", suffix(unit))))
}

/// Passes `value` if it is finite and not below zero.
pub(crate) fn not_negative(input: &str, value: f64, unit: &str) -> Result<f64, Error> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(Error::input(
        input,
        value,
        format!("it must be a finite number, 0 or above{}", suffix(unit)),
    ))
}

/// Passes `values` if all of them are finite.
pub(crate) fn finite(input: &str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::input(
            format!("component {} of {input}", at + 1),
            values[at],
            "it must be a finite number",
        )),
    }
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" ({unit})") }
}
