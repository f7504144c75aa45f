//! The linear systems of a phase.
//!
//! The free part of a matrix of half the size of the state, the inertia or the Newton matrix, is factorized, or large solids iterate
//! with it ([`symmetric`]); the skew part follows by an iteration ([`Skew`]). Constraints ([`ConstrainedSolver`]), edges of rigid pieces ([`edge_solver`]) and flows
//! ([`FlowMatrix`]) add systems of the size of their number. Many pieces are eliminated to their [rigid motions](rigid_motions).

mod cholesky;
mod constrained_solver;
mod edge_component;
mod edge_solver;
mod edges;
mod entry_source;
mod flow_matrix;
mod free_matrix;
mod general_rows;
mod gradients;
mod motion_groups;
mod rigid_motions;
mod schur;
mod simplex;
mod skew;
mod symmetric;

pub(crate) use cholesky::Indefinite;
pub(crate) use constrained_solver::{ConstrainedSolver, EXACT, nodal_multipliers};
pub(crate) use edges::{Edges, stabilized};
pub(crate) use entry_source::{Coupling, EntrySource};
pub(crate) use flow_matrix::FlowMatrix;
pub(crate) use skew::Skew;
