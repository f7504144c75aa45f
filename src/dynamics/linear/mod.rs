//! The linear systems of a phase.
//!
//! Of the inertia matrix and of the Newton matrix, half as large as the state, the free part is factorized, or large solids iterate
//! with it ([`symmetric`]); constraints ([`ConstrainedSolver`]), edges of rigid pieces ([`EdgeSolver`]) and what flows
//! ([`FlowMatrix`]) add systems of the size of their number.

mod cholesky;
mod constrained_solver;
mod edge_solver;
mod edges;
mod entry_source;
mod flow_matrix;
mod general_rows;
mod gradients;
mod schur;
mod symmetric;

pub(crate) use cholesky::Indefinite;
pub(crate) use constrained_solver::{ConstrainedSolver, EXACT, nodal_multipliers};
pub(crate) use edges::{Edge, Edges, stabilized};
pub(crate) use entry_source::{Coupling, EntrySource};
pub(crate) use flow_matrix::FlowMatrix;
