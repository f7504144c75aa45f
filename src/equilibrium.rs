//! A scene in equilibrium: what statics finds, and what is left if it finds none.

use std::fmt;

use crate::trajectory::{Sample, Trajectory};

/// What a small push does to a body in equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// The tangent is positive definite on the motions that the constraints allow: it swings back.
    Stable {
        /// Lowest natural frequency of small undamped vibrations about the equilibrium (Hz);
        /// infinite if nothing can move.
        frequency: f64,
    },
    /// It can move on without force, to the precision of the arithmetic.
    Neutral,
    /// The equilibrium is no minimum of the energy: a small push grows.
    Unstable {
        /// Rate at which the push grows most, without damping (1/s).
        growth: f64,
    },
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stable { frequency } => {
                write!(f, "stable, lowest natural frequency {frequency:.4} Hz")
            }
            Self::Neutral => f.write_str("neutral: it can move on without force"),
            Self::Unstable { growth } => write!(f, "UNSTABLE: a push grows at {growth:.4} 1/s"),
        }
    }
}

/// A scene in equilibrium, and how it was found.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    pub(crate) trajectory: Trajectory,
    /// What a small push does to it.
    pub stability: Stability,
    /// Rigid motions, in words, that nothing holds in a body whose loads balance each other, and that were taken out of
    /// the displacements u: R^T M u = 0 for each motion R, so that the body has neither moved nor turned in the mean over its mass.
    /// With Green's strain a body turns to where loads of constant direction balance each other, which then hold it: a turn
    /// is removed only if no force minds it.
    pub removed: Vec<String>,
    /// Largest nodal force that is not balanced (N).
    pub residual: f64,
    /// Largest nodal force of those that balance each other (N): the scale of `residual`.
    pub force_scale: f64,
    /// Newton iterations in all load steps.
    pub iterations: usize,
    /// Factorizations of the tangent.
    pub factorizations: usize,
    /// Evaluations of forces for their tangents by finite differences: of those that leave out
    /// [`Force::add_tangents`](crate::force::Force::add_tangents).
    pub difference_evaluations: usize,
    /// Load steps that converged.
    pub load_steps: usize,
    /// Load steps that did not, and were made smaller.
    pub failed_steps: usize,
}

impl Equilibrium {
    /// The state: displacements, constraint forces lambda (on the body) and potential energies;
    /// what is stored beyond the undeformed shape counts as supplied.
    pub fn sample(&self) -> &Sample {
        self.trajectory.last()
    }

    /// Displacements (m), dimension components per node.
    pub fn displacements(&self) -> &[f64] {
        &self.sample().u
    }

    /// The same as a trajectory, for [`output`](crate::output): the undeformed shape at t = 0, and
    /// the equilibrium at the end of the phase; between them those for parts of the load, if
    /// [`Statics`](crate::Statics) asks for several steps.
    pub fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }
}

impl fmt::Display for Equilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stability, residual, force_scale, iterations, load_steps, .. } = self;
        write!(
            f,
            "{stability}; forces balanced to {residual:.1e} of {force_scale:.3e} N, \
             {iterations} iteration(s), {load_steps} load step(s)"
        )?;
        if !self.removed.is_empty() {
            write!(
                f,
                "; nothing holds the body: rigid motions removed ({})",
                self.removed.join(", ")
            )?;
        }
        let differences = self.difference_evaluations;
        if differences > 0 {
            write!(
                f,
                "; tangents of forces by finite differences: {differences} evaluations of these forces"
            )?;
        }
        let warnings = self.trajectory.report().warnings();
        warnings.iter().try_for_each(|warning| write!(f, "\nWARNING: {warning}"))
    }
}

/// The search for an equilibrium gave up: how far it came and why.
#[derive(Debug)]
pub struct NoEquilibrium {
    /// Name of the phase.
    pub phase: String,
    /// Part of constraints and loads for which an equilibrium was found.
    pub fraction: f64,
    /// Part for which none was found.
    pub tried: f64,
    /// Largest nodal force left unbalanced in the last attempt (N).
    pub residual: f64,
    /// Newton iterations in all load steps.
    pub iterations: usize,
    /// The likely cause, and what to try.
    pub cause: String,
    /// The undeformed shape and, at that part of the end of the phase, the last equilibrium found, if any; those
    /// before it as in [`Equilibrium::trajectory`].
    pub trajectory: Trajectory,
}

impl fmt::Display for NoEquilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { phase, fraction, tried, residual, iterations, cause, .. } = self;
        write!(
            f,
            "phase \"{phase}\": no equilibrium at {:.2} % of the load ({residual:.2e} N unbalanced, \
             {iterations} iterations in all), the last one is at {:.2} %: {cause}",
            100.0 * tried,
            100.0 * fraction
        )
    }
}

impl std::error::Error for NoEquilibrium {}
