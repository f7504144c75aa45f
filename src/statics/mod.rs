//! Statics: the shape in which a scene is in equilibrium.
//!
//! What holds the body and what loads it is that of the first phase, at its end:
//!
//! | forces | equations | solved by |
//! | --- | --- | --- |
//! | Cauchy strain, constant loads | K u - A lambda = f, A^T u = b | one saddle-point solve |
//! | Green strain, contact, springs, ... | least U - W under A^T u = b | Newton's method with the exact tangent and a line search on the energy |
//!
//! Where the tangent is indefinite, a multiple of M is added to it until it is not, so that the
//! search goes on downhill. If it does not converge, the constraints, gravity and the loads are
//! brought on in smaller and smaller steps.

mod newton;
mod rigid;

use std::fmt;
use std::time::Instant;

use newton::{Search, Stuck};

use crate::constraint::Start;
use crate::error::Error;
use crate::input::{InputError, positive};
use crate::scene::Scene;
use crate::system::{AtRest, Energy};
use crate::trajectory::{Report, Sample, Trajectory};

/// How an equilibrium is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statics {
    /// Forces are in balance when none is left that is larger than this part of the largest one.
    /// Default: 1e-10, some orders above round-off.
    pub rtol: f64,
    /// Newton iterations in one load step. Default: 100; ten do unless the body has to move far.
    pub max_iterations: usize,
    /// Steps in which constraints and loads are brought on. Default: 1, everything at once; more
    /// of them when it converges to an equilibrium other than the one that a slow loading reaches.
    pub load_steps: usize,
    /// Smallest load step, as a part of the whole load. Default: 1e-3.
    pub min_load_step: f64,
}

impl Default for Statics {
    fn default() -> Self {
        Self { rtol: 1e-10, max_iterations: 100, load_steps: 1, min_load_step: 1e-3 }
    }
}

impl Statics {
    fn validate(&self) -> Result<(), InputError> {
        positive("statics.rtol", self.rtol, "")?;
        positive("statics.min_load_step", self.min_load_step, "")?;
        for (input, number) in [
            ("statics.max_iterations", self.max_iterations),
            ("statics.load_steps", self.load_steps),
        ] {
            if number == 0 {
                return Err(InputError::new(input, number, "it must be 1 at least"));
            }
        }
        Ok(())
    }
}

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
    trajectory: Trajectory,
    /// What a small push does to it.
    pub stability: Stability,
    /// Largest nodal force that is not balanced (N).
    pub residual: f64,
    /// Largest nodal force of those that balance each other (N): the scale of `residual`.
    pub force_scale: f64,
    /// Newton iterations in all load steps.
    pub iterations: usize,
    /// Factorizations of the tangent.
    pub factorizations: usize,
    /// Load steps that converged.
    pub load_steps: usize,
    /// Load steps that did not, and were made smaller.
    pub failed_steps: usize,
}

impl Equilibrium {
    /// The state: displacements, constraint forces lambda (on the body) and potential energies;
    /// what is stored beyond the natural shape counts as supplied.
    pub fn sample(&self) -> &Sample {
        self.trajectory.last()
    }

    /// Displacements (m), dimension components per node.
    pub fn displacements(&self) -> &[f64] {
        &self.sample().u
    }

    /// The same as a trajectory, for [`output`](crate::output): the natural shape at t = 0, and
    /// the equilibrium at the end of the phase.
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
        )
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
    /// The natural shape and, at the end of the phase, the last equilibrium found, if any.
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

impl Scene {
    /// The equilibrium under the constraints, gravity, loads, obstacles and springs of the first
    /// phase at its end, without motion: what the body would come to rest in if they stayed.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Scene, Statics, Strain};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.48, viscosity: 4.0 };
    /// let beam = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build()?;
    /// let scene = Scene::new(beam).phase(Phase::until(1.0).hold("left").load([22], [0.0, -0.5]));
    /// let equilibrium = scene.equilibrium(&Statics::default())?;
    /// assert!(equilibrium.displacements()[2 * 21 + 1] < -0.03); // node 22 sinks
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Bad input; [`Error::Input`] if a linear body is held so that it can still move as a
    /// whole; [`Error::Statics`] with the last equilibrium on the way if the search gives up.
    pub fn equilibrium(&self, statics: &Statics) -> Result<Equilibrium, Error> {
        let clock = Instant::now();
        statics.validate()?;
        let mut forces = self.forces()?;
        let model = self.model(&forces);
        let phase = &self.phases()[0];
        let start = Start { time: 0.0, u: &vec![0.0; self.body().dofs()] };
        let system = self.system(&model, phase, forces.swap_remove(0), &start, 0.0)?;
        let free =
            rigid::free_motions(self.body().mesh(), self.body().inertia().pattern(), system.rows());
        let rest = AtRest::new(system, phase.end(), phase.name())?;
        let loose = |freedom: &str| {
            let input = format!("constraints of phase \"{}\"", phase.name());
            let value = format!("leaving the body free {freedom}");
            Error::from(InputError::new(input, value, "hold more of its nodes"))
        };
        let linear = rest.is_linear();
        if linear && !free.is_empty() {
            return Err(loose(&format!("for {}", free.join(", "))));
        }
        let mut search = Search::new(rest, statics, self.body().mesh().size(), !free.is_empty());
        let result = search.all();
        let mut trajectory = Trajectory::new(self, Report::default());
        let natural = vec![0.0; self.body().dofs()];
        let natural_energy = search.rest.energy(0.0, &natural);
        trajectory.push(sample(0.0, &natural, &vec![0.0; search.mu.len()], natural_energy));
        if search.fraction > 0.0 {
            let mut energy = search.rest.energy(search.fraction, &search.u);
            energy.supplied = energy.balance() - natural_energy.balance();
            let mut state = sample(phase.end(), &search.u, &search.mu, energy);
            state.constraint_drift = search.drift();
            trajectory.push(state);
        }
        trajectory.report.wall_seconds = clock.elapsed().as_secs_f64();
        if let Err(Stuck { mut cause, residual }) = result {
            if !free.is_empty() {
                cause += &format!("; the constraints leave the body free for {}", free.join(", "));
            }
            return Err(Box::new(NoEquilibrium {
                phase: phase.name().into(),
                fraction: search.fraction,
                tried: search.tried,
                residual,
                iterations: search.iterations,
                cause,
                trajectory,
            })
            .into());
        }
        let stability = search.stability();
        if linear && stability == Stability::Neutral {
            return Err(loose("to deform without force"));
        }
        Ok(Equilibrium {
            trajectory,
            stability,
            residual: search.residual,
            force_scale: search.at.scale,
            iterations: search.iterations,
            factorizations: search.rest.factorizations(),
            load_steps: search.load_steps,
            failed_steps: search.failed_steps,
        })
    }
}

fn sample(time: f64, u: &[f64], multipliers: &[f64], energy: Energy) -> Sample {
    Sample {
        time,
        phase: 0,
        u: u.to_vec(),
        v: vec![0.0; u.len()],
        multipliers: multipliers.to_vec(),
        energy,
        constraint_drift: 0.0,
    }
}
