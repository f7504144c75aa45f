//! Reduced models: a body that moves in a few shapes, and the cells that stand for all.
//!
//! Displacements are u = u_0 + E (b - b_0) + Phi q: the start of the phase, what its constraints move, and shapes Phi
//! times their amplitudes q, the unknowns. The columns of Phi are orthonormal with the inertia M, and A^T Phi = 0. Of
//! the forces that follow the shape of the body only those of some cells are computed, each times a weight that is not
//! negative, such that they do the work of all cells along Phi (energy-conserving sampling and weighting, C. Farhat,
//! P. Avery, T. Chapman, J. Cortial, Int. J. Numer. Meth. Engng 98 (2014) 625-662).

use std::collections::BTreeMap;
use std::fmt;

use crate::base::input::percent;

/// A scene in fewer unknowns, learned from its own motion: what [`reduce`](crate::reduce::reduce) returns, and
/// [`Scene::reduced`](crate::Scene::reduced) takes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub struct ReducedModel {
    /// Number of displacement components of the scene, and of its cells.
    pub(crate) dofs: usize,
    pub(crate) cell_count: usize,
    pub(crate) phases: Vec<ReducedPhase>,
    /// The cells that stand for all (from 0), with their weights; none where these forces are exact along the shapes.
    pub(crate) cells: BTreeMap<usize, f64>,
    /// Largest displacement (m) from the start in the runs that it was checked with.
    pub(crate) travel: f64,
    /// Largest error of a displacement in these runs, relative to that displacement.
    pub(crate) error: f64,
    /// The error that was wanted.
    pub(crate) within: f64,
    /// That error for an [imbalance](crate::Report) of 1 that a run tells.
    pub(crate) error_per_imbalance: f64,
    /// Whether that is not the error of a run with all unknowns, but what its own runs told.
    #[cfg_attr(feature = "checkpoint", serde(default))]
    pub(crate) is_estimate: bool,
    /// Number of runs that it was learned from; 0 if that is not known.
    #[cfg_attr(feature = "checkpoint", serde(default))]
    pub(crate) runs: usize,
    /// What it was learned from, in words.
    pub(crate) learned_from: String,
}

/// The shapes of one phase.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub(crate) struct ReducedPhase {
    pub(crate) name: String,
    /// Number of rows of its constraints.
    pub(crate) rows: usize,
    /// The columns of Phi (kg^-1/2).
    pub(crate) shapes: Vec<Vec<f64>>,
    /// The columns of E, one for each row that moves.
    pub(crate) lifts: Vec<Vec<f64>>,
    /// Least and largest Phi^T M u of each (kg^1/2 m) in the runs that it was learned from.
    pub(crate) range: Vec<[f64; 2]>,
}

impl ReducedModel {
    /// Number of shapes of the phase that has most.
    pub fn unknowns(&self) -> usize {
        self.phases.iter().map(|phase| phase.shapes.len()).max().unwrap_or(0)
    }

    /// Number of cells whose forces are computed; 0 where these are exact along the shapes.
    pub fn cells(&self) -> usize {
        self.cells.len()
    }

    /// Largest error of a displacement in the runs that it was checked with, relative to their largest displacement.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Whether its [error](Self::error) is what its own runs told, as it was checked with none of all unknowns: see
    /// [`reduce_by_modes`](crate::reduce::reduce_by_modes).
    pub fn is_estimate(&self) -> bool {
        self.is_estimate
    }

    /// What it was learned from, in words.
    pub fn learned_from(&self) -> &str {
        &self.learned_from
    }

    /// Adds what the scenes that it was learned from differ in, in words.
    pub fn learned_over(mut self, words: &str) -> Self {
        self.learned_from = format!("{}: {words}", self.learned_from);
        self
    }
}

impl fmt::Display for ReducedModel {
    /// 24 unknowns and 61 of 900 cells, off by 1.3 %
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} unknowns", self.unknowns())?;
        if self.cells() > 0 {
            write!(f, " and {} of {} cells", self.cells(), self.cell_count)?;
        }
        write!(f, ", off by {}", percent(self.error))?;
        if self.is_estimate { write!(f, " as its own runs tell") } else { Ok(()) }
    }
}
