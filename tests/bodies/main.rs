//! Meshes, the matrices and forces of bodies, and their equilibria.

mod bisection;
mod cells;
mod equations;
mod finer;
mod frequencies;
mod incompressible;
mod matrices;
mod meshes;
mod own_force;
mod pieces;
mod polynomial;
mod revolution;
mod rotations;
mod rubber;
mod solids;
mod spectrum;
mod statics;
