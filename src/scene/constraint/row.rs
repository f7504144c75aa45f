//! One row of the constraints.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::axis::Axis;
use super::prescribed::{Path, Prescribed};
use super::spline::Spline;
use super::turn::Turning;
use crate::base::formula::Formula;
use crate::elements::body::RigidPieces;

/// Parts of a row below this, relative to the row, follow from other rows: nodes that are held as if on a line are there up
/// to the digits of a file, and the Schur complement loses rows that add less than 1e-6.
pub(super) const NOTHING_NEW: f64 = 1e-5;

/// One row of A^T with its b(t), resolved for one phase.
#[derive(Clone)]
pub(crate) struct ConstraintRow {
    /// Degrees of freedom, ascending, and coefficients; a single term makes a nodal row, or one of a rigid piece.
    pub(crate) terms: Vec<(usize, f64)>,
    pub(super) motion: RowMotion,
    /// Whether a node in it belongs to a rigid piece, and so moves with others.
    pub(super) is_of_rigid: bool,
}

#[derive(Clone)]
pub(super) enum RowMotion {
    Linear { start: f64, since: f64, velocity: f64 },
    Path(Path),
    Spline(Arc<Spline>),
    Formula(Arc<Formula>),
    Turning(Turning),
}

impl RowMotion {
    /// Whether two rows with the same terms in one phase are known to have the same motion.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Linear { velocity, .. }, Self::Linear { velocity: other, .. }) => {
                velocity == other
            }
            (Self::Path(path), Self::Path(other)) => Arc::ptr_eq(path, other),
            (Self::Spline(spline), Self::Spline(other)) => spline == other,
            (Self::Formula(formula), Self::Formula(other)) => formula.text() == other.text(),
            (Self::Turning(turning), Self::Turning(other)) => turning.turn == other.turn,
            _ => false,
        }
    }

    /// Description of the prescribed motion, for messages.
    pub(super) fn label(&self) -> String {
        match self {
            Self::Linear { velocity: 0.0, .. } => "held".into(),
            Self::Linear { velocity, .. } => format!("moved at {velocity} m/s"),
            Self::Path(_) => "moved along a function of time".into(),
            Self::Spline(_) => "moved along a path".into(),
            Self::Formula(formula) => format!("moved by {}", formula.text()),
            Self::Turning(_) => "turned".into(),
        }
    }
}

impl ConstraintRow {
    /// Whether it leads nodes to places that do not depend on where they are as the phase begins.
    pub(crate) fn is_placed(&self) -> bool {
        !matches!(self.motion, RowMotion::Linear { .. } | RowMotion::Turning(_))
    }

    /// b, b', b'' at time `t`.
    #[inline]
    pub(crate) fn prescribed(&self, t: f64) -> Prescribed {
        match &self.motion {
            RowMotion::Linear { start, since, velocity } => Prescribed {
                displacement: start + velocity * (t - since),
                velocity: *velocity,
                acceleration: 0.0,
            },
            RowMotion::Path(path) => path(t),
            RowMotion::Spline(spline) => spline.at(t),
            RowMotion::Formula(formula) => {
                let [displacement, velocity, acceleration] = formula.at(t).0;
                Prescribed { displacement, velocity, acceleration }
            }
            RowMotion::Turning(turning) => turning.at(t),
        }
    }

    /// b', if it never changes.
    pub(crate) fn constant_velocity(&self) -> Option<f64> {
        match self.motion {
            RowMotion::Linear { velocity, .. } => Some(velocity),
            RowMotion::Path(_)
            | RowMotion::Spline(_)
            | RowMotion::Formula(_)
            | RowMotion::Turning(_) => None,
        }
    }

    /// Whether b changes, or may.
    pub(crate) fn moves(&self) -> bool {
        self.constant_velocity() != Some(0.0)
    }

    /// The part of the row that depends on the state at its start: b (m), the time (s), and for a row that
    /// turns the components of its arm r and of a x r (m).
    pub(crate) fn origin(&self) -> [f64; 4] {
        match &self.motion {
            RowMotion::Linear { start, since, .. } => [*start, *since, 0.0, 0.0],
            RowMotion::Path(_) | RowMotion::Spline(_) | RowMotion::Formula(_) => [0.0; 4],
            RowMotion::Turning(turning) => turning.origin(),
        }
    }

    /// Sets where the row starts: see [`origin`](Self::origin).
    pub(crate) fn set_origin(&mut self, origin: [f64; 4]) {
        match &mut self.motion {
            RowMotion::Linear { start, since, .. } => [*start, *since, ..] = origin,
            RowMotion::Path(_) | RowMotion::Spline(_) | RowMotion::Formula(_) => {}
            RowMotion::Turning(turning) => turning.set_origin(origin),
        }
    }

    /// A^T x for this row.
    pub(crate) fn apply(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|&(dof, coefficient)| coefficient * x[dof]).sum()
    }

    /// The degree of freedom of a nodal row and its coefficient. A row of a node that moves with others is a
    /// general one.
    pub(crate) fn nodal(&self) -> Option<(usize, f64)> {
        match self.terms[..] {
            [term] if !self.is_of_rigid => Some(term),
            _ => None,
        }
    }

    /// The node of a row that involves a single one, for a body in `dimension` dimensions.
    pub(crate) fn node(&self, dimension: usize) -> Option<usize> {
        let mut nodes = self.terms.iter().map(|(dof, _)| dof / dimension);
        let first = nodes.next();
        first.filter(|first| nodes.all(|node| node == *first))
    }

    /// The nodes and axes of the row, nodes counted from 1, for messages.
    pub(crate) fn label(&self, dimension: usize) -> String {
        let name = |&(dof, _): &(usize, f64)| {
            format!("node {} {:?}", dof / dimension + 1, Axis::all(dimension)[dof % dimension])
                .to_lowercase()
        };
        self.terms.iter().map(name).collect::<Vec<_>>().join(" + ")
    }
}

/// The terms of a row by independent degrees of freedom alone, ascending: those of nodes that move with others are
/// shared out.
pub(crate) fn independent_terms(
    terms: &[(usize, f64)],
    rigid: Option<&RigidPieces>,
    dimension: usize,
) -> Vec<(usize, f64)> {
    let Some(rigid) = rigid else { return terms.to_vec() };
    let mut sums = BTreeMap::new();
    for &(dof, c) in terms {
        for (node, share) in rigid.shares(dof / dimension) {
            *sums.entry(node * dimension + dof % dimension).or_insert(0.0) += c * share;
        }
    }
    sums.into_iter().collect()
}

/// Moves the nodes that `rows` prescribe to their prescribed positions at time `t`, so that a constraint that
/// continues in the next phase does not take over the error left by the stabilization.
pub(crate) fn prescribe(rows: &[ConstraintRow], t: f64, u: &mut [f64]) {
    for row in rows {
        if let Some((dof, coefficient)) = row.nodal() {
            u[dof] = row.prescribed(t).displacement / coefficient;
        }
    }
}
