//! Constraints R = A^T u - b(t) = 0: what is held and what is moved, and how.
//!
//! A constraint on one displacement component of one node (a *nodal* row) is the common case; a general
//! linear row may involve several. R = 0 is stabilized as R'' + 2 alpha R' + alpha^2 R = 0 (Hirai (4.1.3));
//! the equations of motion with it are in `dynamics::system`.

mod axis;
mod prescribed;
mod resolve;
mod rigid_holds;
mod row;
mod spline;
mod start;
mod turn;

use std::fmt;
use std::sync::Arc;

pub use axis::Axis;
pub use prescribed::{Path, Prescribed};
pub(crate) use resolve::rows;
pub(crate) use rigid_holds::{check_rigid_holds, held_pieces};
pub(crate) use row::{ConstraintRow, independent_terms, prescribe};
pub(crate) use spline::Spline;
pub(crate) use start::PhaseStart;
pub(crate) use turn::{Turn, angular};

use crate::base::formula::Formula;
use crate::elements::mesh::Selection;

/// A constraint as the user of a phase gives it.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub(crate) what: Constrained,
    pub(crate) how: Motion,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum Constrained {
    /// Components of nodes, one row for each.
    Nodes(Selection, Axes),
    /// One general row: (node number from 1, axis, coefficient).
    Row(Vec<(usize, Axis, f64)>),
    /// The displacements of nodes along a direction, one row per node.
    Along(Selection, Vec<f64>),
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(untagged))]
pub(crate) enum Axes {
    All,
    These(Vec<Axis>),
}

#[derive(Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum Motion {
    /// Stay where the nodes are when the phase begins.
    Hold,
    /// Stay where they are undeformed, of a general row.
    Together,
    /// Move from there with constant velocity (m/s), one per axis (a single one for a general row).
    Velocity(Vec<f64>),
    /// Follow a path (the same for all axes).
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Path(Path),
    /// Follow a smooth path through points (the same for all axes).
    #[cfg_attr(feature = "checkpoint", serde(rename = "path"))]
    Spline(Arc<Spline>),
    /// Follow a formula of time without kinks (m; the same for all axes).
    Formula(Arc<Formula>),
    /// Turn from where the nodes are when the phase begins (all axes).
    Turn(Arc<Turn>),
}

impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hold => f.write_str("Hold"),
            Self::Together => f.write_str("Together"),
            Self::Velocity(velocity) => f.debug_tuple("Velocity").field(velocity).finish(),
            Self::Path(_) => f.write_str("Path"),
            Self::Spline(spline) => spline.fmt(f),
            Self::Formula(formula) => formula.fmt(f),
            Self::Turn(turn) => turn.fmt(f),
        }
    }
}

impl Motion {
    /// Times (s) at which the motion changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        match self {
            Self::Spline(spline) => spline.times(),
            Self::Turn(turn) => turn.breaks(),
            Self::Hold | Self::Together | Self::Velocity(_) | Self::Path(_) | Self::Formula(_) => {
                &[]
            }
        }
    }
}
