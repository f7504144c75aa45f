//! A scene in equilibrium, and what a search for one returns that fails.

use std::fmt;

use crate::base::input::four_digits;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::basis::worst_cells;

/// Stability of an equilibrium under small perturbations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// The tangent is positive definite on the motions that the constraints allow: the body swings back.
    Stable {
        /// Lowest natural frequency of small undamped vibrations about the equilibrium (Hz);
        /// infinite if nothing can move.
        frequency: f64,
    },
    /// The body can move on without force, to the precision of the arithmetic.
    Neutral,
    /// The equilibrium is not a minimum of the energy: a small push grows.
    Unstable {
        /// Largest growth rate of a push, without damping (1/s).
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
    /// Stability under small perturbations.
    pub stability: Stability,
    /// Rigid motions, in words, that nothing restrains and that were removed from the displacements u.
    ///
    /// Nothing restrains them in a body whose loads balance each other. R^T M u = 0 for each such motion R,
    /// so that the mean translation and rotation, weighted by mass, are 0. With Green's strain a body turns
    /// to where loads of constant direction balance each other, and these then restrain it: a rotation is
    /// removed only if no force resists it.
    pub removed: Vec<String>,
    /// Largest nodal force that is not balanced (N).
    pub residual: f64,
    /// Largest nodal force of those that balance each other (N): the scale of `residual`.
    pub force_scale: f64,
    /// Newton iterations in all load steps.
    pub iterations: usize,
    /// Factorizations of the tangent.
    pub factorizations: usize,
    /// Evaluations of forces for tangents by finite differences, of forces without
    /// [`Force::add_tangents`](crate::elements::force::Force::add_tangents).
    pub difference_evaluations: usize,
    /// Load steps that converged.
    pub load_steps: usize,
    /// Load steps that did not converge and were made smaller.
    pub failed_steps: usize,
    /// Load steps whose equilibrium was found by damped motion, as Newton's method failed: there may be several, of which
    /// inertia would select another.
    pub damped_steps: usize,
    /// Discretization error of a quantity, if it was [estimated](MeshEstimate).
    pub mesh_estimate: Option<MeshEstimate>,
}

/// Estimate of the discretization error of a quantity of an equilibrium, made by [`MeshEstimate::of`].
#[derive(Debug, Clone, PartialEq)]
pub struct MeshEstimate {
    /// The quantity.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Its value on this mesh.
    pub value: f64,
    /// Its change from the undeformed shape, without load, to the equilibrium.
    pub change: f64,
    /// Estimated value on the richer mesh minus `value`: the error is minus that.
    pub correction: f64,
    /// Contribution to the correction by the residual forces at the corrected displacements: the leading remainder, 0
    /// in linear problems, infinite if forces are undefined there.
    pub remainder: f64,
    /// Contributions of the additional nodes of the richer mesh to the correction, for each cell of this mesh
    /// that they lie in: where they are large, smaller cells help.
    pub cells: Vec<f64>,
    /// Displacement components on the richer mesh.
    pub unknowns: usize,
    /// Wall-clock time that the estimate took (s).
    pub seconds: f64,
}

impl MeshEstimate {
    /// The value with its correction.
    pub fn corrected(&self) -> f64 {
        self.value + self.correction
    }

    /// Whether the remainder is no larger than the correction, apart from round-off.
    ///
    /// If it is larger, the correction may be far off, and is not told in words.
    pub fn is_reliable(&self) -> bool {
        let round_off = 1e-9 * self.value.abs().max(self.change.abs());
        self.remainder.abs() <= self.correction.abs().max(round_off)
    }

    /// The cells (from 0) that contribute most, with half of all contributions together, ascending: what to divide next, by
    /// [`Scene::halved_in`](crate::Scene::halved_in) (W. Dörfler, SIAM J. Numer. Anal. 33 (1996) 1106-1124).
    pub fn worst_cells(&self) -> Vec<usize> {
        worst_cells(&self.cells, 0.5)
    }

    /// The size of the correction relative to the change; infinite if the quantity has not changed.
    pub fn relative(&self) -> f64 {
        (self.correction / self.change).abs()
    }
}

impl fmt::Display for MeshEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, unit, value, correction, unknowns, .. } = self;
        let [shown, off, better] = [*value, correction.abs(), self.corrected()].map(four_digits);
        write!(f, "{quantity} is {shown} {unit}")?;
        if !self.is_reliable() {
            return f.write_str(
                "\nWARNING: the error due to the mesh cannot be estimated, as dual-weighted residuals neglect more than they \
                 include: the mesh is so coarse that the body would move far on a better one; compare with finer cells (`halved = 1`, \
                 `--refine`), or take quadratic ones in place of linear ones",
            );
        }
        write!(f, ", off by about {off} {unit}")?;
        if self.change != 0.0 {
            let part = four_digits(100.0 * self.relative());
            write!(f, " ({part} % of its change) because of the mesh")?;
        }
        write!(f, ": {better} {unit}, by dual-weighted residuals with {unknowns} unknowns")?;
        Ok(())
    }
}

impl Equilibrium {
    /// The state: displacements, constraint forces lambda (on the body) and potential energies; the energy
    /// stored beyond that of the undeformed shape counts as supplied.
    pub fn sample(&self) -> &Sample {
        self.trajectory.last()
    }

    /// Displacements (m), dimension components per node.
    pub fn displacements(&self) -> &[f64] {
        &self.sample().u
    }

    /// The same as a trajectory, for [`output`](crate::io::output).
    ///
    /// It has the undeformed shape at t = 0 and the equilibrium at the end of the phase; between them the
    /// equilibria for parts of the load, if [`Statics`](crate::Statics) requires several steps.
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
        let planes = self.trajectory.body().planes();
        planes.iter().try_for_each(|plane| write!(f, ", {plane}"))?;
        if !self.removed.is_empty() {
            write!(
                f,
                "; nothing holds the body: rigid motions removed ({})",
                self.removed.join(", ")
            )?;
        }
        if self.damped_steps > 0 {
            let steps = self.damped_steps;
            write!(
                f,
                "; found by damped motion in {steps} load step(s), where Newton's method failed"
            )?;
        }
        let differences = self.difference_evaluations;
        if differences > 0 {
            write!(
                f,
                "; tangents of forces by finite differences: {differences} evaluations of these forces"
            )?;
        }
        if let Some(estimate) = &self.mesh_estimate {
            write!(f, "\n{estimate}")?;
        }
        let warnings = self.trajectory.report().warnings();
        warnings.iter().try_for_each(|warning| write!(f, "\nWARNING: {warning}"))
    }
}

/// The search for an equilibrium gave up: how far it got and why.
#[derive(Debug)]
pub struct NoEquilibrium {
    /// Name of the phase.
    pub phase: String,
    /// Fraction of constraints and loads for which an equilibrium was found.
    pub fraction: f64,
    /// Fraction for which none was found.
    pub tried: f64,
    /// Largest nodal force left unbalanced in the last attempt (N).
    pub residual: f64,
    /// Newton iterations in all load steps.
    pub iterations: usize,
    /// The likely cause, and what to try.
    pub cause: String,
    /// The undeformed shape and, at `fraction` times the end of the phase, the last equilibrium found, if
    /// any; earlier ones as in [`Equilibrium::trajectory`].
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
