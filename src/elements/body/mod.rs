//! A body: a mesh made of a material, and the constant matrices that follow from both.

mod assembled;
mod assembly;
mod branches;
mod builder;
mod constant;
mod contiguous;
mod continuum;
mod dilatation;
mod elastic;
mod elements;
mod energy;
mod fibres;
mod fields;
mod forces;
mod gather;
mod inertia;
mod joined;
mod masses;
mod partition;
mod polynomial;
mod projection;
mod recipe;
mod recovery;
mod regions;
mod reinforcement;
mod relaxing;
mod rigid;
mod tangents;
#[cfg(test)]
mod tests;

pub use assembled::Body;
pub use builder::BodyBuilder;
pub use dilatation::Dilatation;
pub(crate) use elastic::LinearByCells;

pub(crate) use fields::von_mises;
pub use fields::{CellField, NodalField};
pub use inertia::Inertia;
pub use joined::Part;
pub use polynomial::{Coefficients, GreenPolynomial};
pub use regions::CellSelection;
pub(crate) use relaxing::Branches;
pub(crate) use rigid::RigidPieces;

pub use crate::elements::material::{Strain, Viscosity};
