//! The state of a motion as integrators have it: the vector y = (u, v, energy dissipated, energy
//! supplied, multipliers of a DAE or internal strains), with names.

/// Number of energies among the unknowns: dissipated and supplied.
pub(crate) const ENERGIES: usize = 2;

/// The parts of a state, or the same parts of a derivative y' or a residual.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State<'a> {
    /// Displacements (m), dimension components per node.
    pub(crate) u: &'a [f64],
    /// Velocities (m/s), likewise.
    pub(crate) v: &'a [f64],
    /// Energy turned into heat since t = 0 (J).
    pub(crate) dissipated: f64,
    /// Energy supplied from outside since t = 0 (J).
    pub(crate) supplied: f64,
    /// Multipliers of a differential-algebraic form; internal strains of an ODE, those of Maxwell branches.
    pub(crate) others: &'a [f64],
}

/// As [`State`], to be written to.
#[derive(Debug)]
pub(crate) struct StateMut<'a> {
    pub(crate) u: &'a mut [f64],
    pub(crate) v: &'a mut [f64],
    pub(crate) dissipated: &'a mut f64,
    pub(crate) supplied: &'a mut f64,
    pub(crate) others: &'a mut [f64],
}

/// Position of the first of the `others`, for a body with `dofs` displacement components: the length of the
/// state of an ODE without them.
pub(crate) fn length(dofs: usize) -> usize {
    2 * dofs + ENERGIES
}

impl<'a> State<'a> {
    /// The parts of `y`, of a body with `dofs` displacement components.
    pub(crate) fn of(y: &'a [f64], dofs: usize) -> Self {
        let (u, rest) = y.split_at(dofs);
        let (v, rest) = rest.split_at(dofs);
        let (energies, others) = rest.split_at(ENERGIES);
        Self { u, v, dissipated: energies[0], supplied: energies[1], others }
    }
}

impl<'a> StateMut<'a> {
    /// The parts of `y`, of a body with `dofs` displacement components.
    pub(crate) fn of(y: &'a mut [f64], dofs: usize) -> Self {
        let (u, rest) = y.split_at_mut(dofs);
        let (v, rest) = rest.split_at_mut(dofs);
        let (energies, others) = rest.split_at_mut(ENERGIES);
        let (dissipated, supplied) = energies.split_at_mut(1);
        Self { u, v, dissipated: &mut dissipated[0], supplied: &mut supplied[0], others }
    }
}
