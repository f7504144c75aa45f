//! A body: a mesh made of a material, and the constant matrices that follow from both.

mod assembled;
mod assembly;
mod branch_modes;
mod branches;
mod builder;
mod constant;
mod contiguous;
mod continuum;
mod contraction;
mod dilatation;
mod elastic;
mod elements;
mod energy;
mod fibres;
mod fields;
mod forces;
mod gather;
mod grown_fields;
mod growth;
mod inertia;
mod joined;
mod magnetization;
mod magnetized_points;
mod magnets;
mod masses;
mod nodal_masses;
mod oriented;
mod partition;
mod polynomial;
mod projection;
mod recipe;
mod recovery;
mod regions;
mod reinforcement;
mod relaxing;
mod rigid;
mod sample;
mod strain_modes;
mod strands;
mod tangents;
#[cfg(test)]
mod tests;
mod whole;

pub use assembled::Body;
pub use builder::BodyBuilder;
pub(crate) use contraction::Contraction;
pub use dilatation::Dilatation;
pub(crate) use elastic::{Elastic, LinearByCells};

pub(crate) use branch_modes::BranchModes;
pub(crate) use fields::von_mises;
pub use fields::{CellField, NodalField};
pub(crate) use grown_fields::Grown;
pub(crate) use growth::Growing;
pub use inertia::Inertia;
pub use joined::Part;
pub(crate) use magnetized_points::{MagnetizedPoints, PointDipole, TooNear};
pub(crate) use magnets::Magnets;
pub use polynomial::{Coefficients, GreenPolynomial};
pub use regions::CellSelection;
pub(crate) use relaxing::Branches;
pub(crate) use rigid::RigidPieces;
pub(crate) use sample::ByCell;
pub(crate) use strands::Strands;

pub use crate::elements::material::{Strain, Viscosity};
