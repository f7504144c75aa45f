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
//! search goes on downhill. If it does not converge, what moves and loads the body is brought on in smaller
//! and smaller steps: constraints and obstacles along their way; gravity, loads, pressure and the forces
//! of actuators by a factor. Obstacles in motion count as standing where they are: nothing is dragged
//! along.

mod newton;
mod options;
mod rigid;

use std::time::Instant;

use newton::{Search, Stuck};
pub use options::Statics;

use crate::constraint::PhaseStart;
use crate::equilibrium::{Equilibrium, NoEquilibrium, Stability};
use crate::error::Error;
use crate::indicator;
use crate::input::InputError;
use crate::report::Report;
use crate::scene::Scene;
use crate::system::{AtRest, Energy};
use crate::trajectory::{Commanded, Sample, Trajectory};

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
        let phase = self.first_phase()?;
        let start = PhaseStart { time: 0.0, u: &vec![0.0; self.body().dofs()] };
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
        let natural = vec![0.0; self.body().dofs()];
        let natural_energy = search.rest.energy(0.0, &natural);
        let first = sample(0.0, &natural, &vec![0.0; search.mu.len()], natural_energy);
        let mut trajectory = Trajectory::new(self, Report::default(), first);
        if search.fraction > 0.0 {
            let mut energy = search.rest.energy(search.fraction, &search.u);
            energy.supplied = energy.balance() - natural_energy.balance();
            let mut state = sample(phase.end(), &search.u, &search.mu, energy);
            state.constraint_drift = search.drift();
            trajectory.push(state);
        }
        trajectory.report.wall_seconds = clock.elapsed().as_secs_f64();
        trajectory.report.doubts = indicator::of_equilibrium(&trajectory, result.is_ok());
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
            difference_evaluations: search.rest.system().difference_evaluations(),
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
        sensors: Vec::new(),
        commanded: Commanded::default(),
    }
}
