//! The equations of motion of one phase, for integrators outside this crate.
//!
//! ```
//! use pliant::samples::beam_jump;
//!
//! let scene = beam_jump()?;
//! let rest = vec![0.0; scene.body().dofs()];
//! let mut push = scene.equations(0, &rest)?;
//! let held: Vec<usize> = push.prescribed(0.0).map(|(dof, _)| dof).collect();
//! assert_eq!(held, [0]);
//! let mut f = rest.clone();
//! push.forces(0.0, &rest, &rest, &mut f).unwrap();
//! assert_eq!(f, [0.0, 0.0, 0.0, 0.0, 0.0, -2.0]);
//! # Ok::<(), pliant::Error>(())
//! ```

use std::fmt;

use crate::base::input::InputError;
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::dynamics::system::System;
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, PhaseStart, Prescribed};
use crate::scene::timeline::Scene;

/// The equations of one phase of a scene, discrete in space and continuous in time.
///
/// M v' = f(t, u, v) and u' = v hold for all displacement components except the
/// [`prescribed`](Self::prescribed) ones, which follow b(t). Vectors have `dimension` components per node.
pub struct Equations {
    system: System,
}

impl Scene {
    /// The equations of phase number `phase`, counted from 0, which begins with the displacements `u` (m).
    ///
    /// Nodes that the phase holds stay there, nodes that it moves start there.
    ///
    /// # Errors
    /// As [`validate`](Self::validate); a phase that the scene does not have; displacements of
    /// the wrong number; constraints that tie several components together; Maxwell branches; rigid pieces.
    pub fn equations(&self, phase: usize, u: &[f64]) -> Result<Equations, InputError> {
        let forces = self.with_fixed_amounts().forces()?;
        let matrices = self.matrices(&forces);
        let (Some(own), Some(forces)) = (self.phases().get(phase), forces.into_iter().nth(phase))
        else {
            let help = format!("the scene has {}, counted from 0", self.phases().len());
            return Err(InputError::new("number of the phase", phase, help));
        };
        if u.len() != self.body().dofs() {
            let help = format!("it needs {} numbers, one for each component", self.body().dofs());
            return Err(InputError::new(
                "start of the phase",
                format!("{} numbers", u.len()),
                help,
            ));
        }
        if matrices.branches.is_some() {
            let help = "equations are given for bodies without Maxwell branches: leave them out";
            return Err(InputError::new("material.branches", "some", help));
        }
        if self.pours() {
            let help = "equations are given for amounts of liquids that stay: leave it out";
            return Err(InputError::new("flow of a phase, or a pipe,", "into a chamber", help));
        }
        if let Some((name, _)) = self.lags().next() {
            let help = "equations have no unknowns for it: leave it out";
            return Err(InputError::new("lag", format!("of \"{name}\""), help));
        }
        if !self.orifices().is_empty() {
            let help = "equations are given for amounts of gas that stay: leave orifices out";
            return Err(InputError::new("number of orifices", self.orifices().len(), help));
        }
        if matrices.rigid.is_some() {
            let help =
                "equations are given for nodes that move by themselves: leave rigid pieces out";
            return Err(InputError::new("material.rigid", true, help));
        }
        let time = phase.checked_sub(1).map_or(0.0, |before| self.phases()[before].end());
        // positions follow b(t) exactly here, so that no stabilization is needed
        let system = self.system(&matrices, own, forces, &PhaseStart { time, u }, 0.0)?;
        match system.rows().iter().find(|row| row.nodal().is_none()) {
            None => Ok(Equations { system }),
            Some(row) => Err(InputError::new(
                format!("constraints of phase \"{}\"", own.name()),
                format!("{}, tied together", row.label(self.body().dimension())),
                "equations are given for constraints on single components",
            )),
        }
    }
}

impl fmt::Debug for Equations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Equations").field("dofs", &self.system.dofs()).finish_non_exhaustive()
    }
}

impl Equations {
    /// M = m (x) I; this is m (kg).
    pub fn inertia(&self) -> &NodeMatrix {
        &self.system.matrices().inertia
    }

    /// Displacement components that are prescribed at time `t` (s), with b, b' and b''.
    pub fn prescribed(&self, t: f64) -> impl Iterator<Item = (usize, Prescribed)> {
        let row = move |row: &ConstraintRow| {
            let (dof, coefficient) = row.nodal()?;
            let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
            let [displacement, velocity, acceleration] =
                [displacement, velocity, acceleration].map(|b| b / coefficient);
            Some((dof, Prescribed { displacement, velocity, acceleration }))
        };
        self.system.rows().iter().filter_map(row)
    }

    /// Writes f(t, u, v): all forces (N) at the displacements `u` (m) and velocities `v` (m/s), without those
    /// of the constraints.
    ///
    /// # Errors
    /// A state in which a force is undefined, such as one with an inverted cell.
    pub fn forces(&mut self, t: f64, u: &[f64], v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        self.system.forces(t, u, v, f)
    }

    /// -df/du (N/m) and -df/dv (N s/m). They need not be symmetric. Where bodies touch, their pattern changes as other
    /// nodes come near each other, and that of [`inertia`](Self::inertia) with it.
    pub fn tangents(&mut self, t: f64, u: &[f64], v: &[f64]) -> [&BlockMatrix; 2] {
        self.system.update_tangents(t, u, v, false);
        self.system.tangents().into()
    }

    /// Factorizes the Newton matrix M + gamma D + gamma^2 Kt of an implicit method of step parameter `gamma`
    /// (s), with the [`tangents`](Self::tangents) computed last.
    ///
    /// # Errors
    /// A singular matrix.
    pub fn factorize(&mut self, gamma: f64) -> Result<(), Failure> {
        self.system.factorize_newton(gamma)
    }

    /// Solves (I - gamma J) x = r with the last factorization; J is the Jacobian of (u', v') = (v, M^-1 f).
    ///
    /// `ru` and `rv` hold r and become x. Prescribed components get xv = rv and xu = ru + gamma xv.
    pub fn solve(&mut self, ru: &mut [f64], rv: &mut [f64]) {
        self.system.solve_newton_ode(0.0, ru, rv, &[]);
    }
}
