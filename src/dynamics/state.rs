//! The unknowns of a phase, and their layout in the state y of an integrator:
//!
//! ```text
//! y = (u, v, e, m, E_d, E_s)
//! ```
//!
//! displacements u, velocities v, strains e of Maxwell branches, amounts m (masses of gas and liquid, states of actuators
//! that lag, flows of pipes), and the energies dissipated and supplied. No rate depends on the energies: they come last, where
//! integrators have integrals. Differential-algebraic forms append multipliers, so that the first part of their state is the
//! state of the phase in any form, and a method can take over from another.

use std::ops::Range;

#[cfg(feature = "checkpoint")]
use crate::scene::timeline::Scene;

/// Number of energies among the unknowns: dissipated and supplied.
pub(crate) const ENERGIES: usize = 2;

/// Numbers of the unknowns of a phase, from which their positions follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Displacement components, and as many velocities.
    pub(crate) dofs: usize,
    /// Internal strains of Maxwell branches.
    pub(crate) strains: usize,
    /// Amounts of components: masses, states of actuators that lag, flows.
    pub(crate) amounts: usize,
}

/// The parts of a state, or the same parts of a derivative y' or a residual.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State<'a> {
    /// Displacements (m), dimension components per node.
    pub(crate) u: &'a [f64],
    /// Velocities (m/s), likewise.
    pub(crate) v: &'a [f64],
    /// The unknowns of first order: strains of Maxwell branches, and behind them amounts.
    pub(crate) internal: &'a [f64],
    /// Energy turned into heat since t = 0 (J).
    pub(crate) dissipated: f64,
    /// Energy supplied from outside since t = 0 (J).
    pub(crate) supplied: f64,
    /// Multipliers of a differential-algebraic form.
    pub(crate) multipliers: &'a [f64],
}

/// As [`State`], to be written to.
#[derive(Debug)]
pub(crate) struct StateMut<'a> {
    pub(crate) u: &'a mut [f64],
    pub(crate) v: &'a mut [f64],
    pub(crate) internal: &'a mut [f64],
    pub(crate) dissipated: &'a mut f64,
    pub(crate) supplied: &'a mut f64,
    pub(crate) multipliers: &'a mut [f64],
}

impl Layout {
    /// That of the states of a scene.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn of_scene(scene: &Scene) -> Self {
        Self {
            dofs: scene.body().dofs(),
            strains: scene.body().branches().map_or(0, |branches| branches.unknowns()),
            amounts: scene.flowing_amounts(),
        }
    }

    /// Number of all unknowns but multipliers.
    pub(crate) fn unknowns(self) -> usize {
        self.energies().end
    }

    /// Positions of the displacements and velocities.
    pub(crate) fn motion(self) -> Range<usize> {
        0..2 * self.dofs
    }

    /// Positions of the strains of branches and of the amounts.
    pub(crate) fn internal(self) -> Range<usize> {
        let first = self.motion().end;
        first..first + self.strains + self.amounts
    }

    /// Positions of the energies.
    pub(crate) fn energies(self) -> Range<usize> {
        let first = self.internal().end;
        first..first + ENERGIES
    }

    /// The state of a motion (u, v) with these `internal` unknowns, before anything is dissipated or supplied.
    pub(crate) fn state(self, u: &[f64], v: &[f64], internal: &[f64]) -> Vec<f64> {
        [u, v, internal, &[0.0; ENERGIES]].concat()
    }

    /// The strains of branches and the amounts among `internal` unknowns; none of either where these are omitted.
    pub(crate) fn split(self, internal: &[f64]) -> (&[f64], &[f64]) {
        internal.split_at(self.strains.min(internal.len()))
    }

    /// As [`split`](Self::split), to be written to.
    pub(crate) fn split_mut(self, internal: &mut [f64]) -> (&mut [f64], &mut [f64]) {
        internal.split_at_mut(self.strains.min(internal.len()))
    }

    /// The parts of `y`.
    pub(crate) fn of(self, y: &[f64]) -> State<'_> {
        let (u, rest) = y.split_at(self.dofs);
        let (v, rest) = rest.split_at(self.dofs);
        let (internal, rest) = rest.split_at(self.strains + self.amounts);
        let (energies, multipliers) = rest.split_at(ENERGIES);
        State { u, v, internal, dissipated: energies[0], supplied: energies[1], multipliers }
    }

    /// As [`of`](Self::of), to be written to.
    pub(crate) fn of_mut(self, y: &mut [f64]) -> StateMut<'_> {
        let (u, rest) = y.split_at_mut(self.dofs);
        let (v, rest) = rest.split_at_mut(self.dofs);
        let (internal, rest) = rest.split_at_mut(self.strains + self.amounts);
        let (energies, multipliers) = rest.split_at_mut(ENERGIES);
        let (dissipated, supplied) = energies.split_at_mut(1);
        let (dissipated, supplied) = (&mut dissipated[0], &mut supplied[0]);
        StateMut { u, v, internal, dissipated, supplied, multipliers }
    }
}
