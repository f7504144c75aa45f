//! Statics: the shape in which a scene is in equilibrium.
//!
//! The constraints and loads are those of one phase, at its end:
//!
//! | forces | equations | solved by |
//! | --- | --- | --- |
//! | Cauchy strain, constant loads | K u - A lambda = f, A^T u = b | one saddle-point solve |
//! | Green strain, contact, springs, ... | minimum of U - W under A^T u = b | Newton's method with the exact tangent and a line search on the energy |
//!
//! Where the tangent is indefinite, a multiple of M is added to it until it is positive definite, so that the
//! energy falls in the search. If the search does not converge, constraints and loads are applied in smaller
//! and smaller steps: constraints and obstacles along their paths; gravity, loads, pressure, the forces of
//! actuators, lengths of winches, growth and amounts of gas and liquids by a factor. Where no step is small
//! enough, damped motion finds the next equilibrium. Obstacles in
//! motion are held in their positions: nothing is dragged along.
//! Friction does not act either, as it depends on the motion before.
//!
//! A scene that starts from a given state is in equilibrium near it: the search begins there under the whole load, and
//! the unbalanced force is released by a factor.
//!
//! A body that nothing holds is in equilibrium if its loads balance each other. Of all its positions the one
//! without rigid motion is chosen: the displacements have no component along any rigid motion
//! R, R^T M u = 0. With Green's strain a body rotates until loads of constant direction balance each other,
//! and is free only for motions that no force resists: all of them if it is under pressure all around.
//!
//! With arc length the load is not given, but found together with the displacements, along the path of
//! equilibria: it falls where the body snaps through.

mod arc_length;
mod continuation;
mod descent;
mod free;
mod newton;
mod options;

use std::sync::Arc;
use std::time::Instant;

use newton::{Hold, Point, Search, Stuck, reason};
pub use options::Statics;

use crate::base::input::{InputError, find};
use crate::dynamics::equilibrium::{Equilibrium, NoEquilibrium, Stability};
use crate::dynamics::error::Error;
use crate::dynamics::indicators;
use crate::dynamics::report::Report;
use crate::dynamics::system::AtRest;
use crate::dynamics::system::rigid::{self, RigidMotion};
use crate::dynamics::trajectory::{Commanded, LOAD_FACTOR, Quantity, Sample, Trajectory};
use crate::elements::body::Branches;
use crate::scene::constraint::{ConstraintRow, PhaseStart, prescribe};
use crate::scene::timeline::{Phase, Scene};

impl Scene {
    /// The equilibrium under the constraints, gravity, loads, obstacles and springs of the first phase at its
    /// end, without motion.
    ///
    /// The body would reach rest in it if they continued to act.
    ///
    /// The search begins at the displacements of the [start](Self::starting_from): in the undeformed shape without load, or in a given
    /// state under the whole load, whose unbalanced part there is released step by step. So one load step follows another by hand,
    /// and of several equilibria the near one is found.
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
    /// Bad input; [`Error::Input`] if the body is held so that it can still move as a whole, and its loads
    /// move it; [`Error::Statics`] with the last equilibrium found for part of the load if the search gives
    /// up.
    pub fn equilibrium(&self, statics: &Statics) -> Result<Equilibrium, Error> {
        self.equilibrium_in(0, statics)
    }

    /// As [`equilibrium`](Self::equilibrium), of the phase of that name, at its end (`"phase 2"`, say, if it
    /// was given none).
    ///
    /// Nodes that earlier phases held or moved, and this one holds, stay where they were left; nodes that
    /// were free until then are held in their undeformed positions, as statics does not know where a motion
    /// would have brought them.
    ///
    /// # Errors
    /// As [`equilibrium`](Self::equilibrium); no phase of that name.
    pub fn equilibrium_of(&self, phase: &str, statics: &Statics) -> Result<Equilibrium, Error> {
        self.equilibrium_in(self.phase_of_statics(phase)?, statics)
    }

    fn phase_of_statics(&self, phase: &str) -> Result<usize, InputError> {
        find(phase, self.phases().iter().map(Phase::name), "phase of statics", "phases")
    }

    /// Checks that the first phase, or that of a name, has an equilibrium to be sought.
    #[cfg(feature = "sweep")]
    pub(crate) fn check_equilibrium(&self, phase: Option<&str>) -> Result<(), InputError> {
        let number = phase.map_or(Ok(0), |phase| self.phase_of_statics(phase))?;
        self.at_rest_in(number).map(|_| ())
    }

    /// The phase of that `number` (from 0) at rest.
    pub(crate) fn at_rest_in(&self, number: usize) -> Result<AtRest, InputError> {
        if let [orifice, ..] = self.orifices() {
            let help = "an equilibrium keeps the amounts of gas as they are: leave the orifices out, or run the scene";
            return Err(InputError::new(
                "orifice of statics",
                format!("\"{}\"", orifice.name()),
                help,
            ));
        }
        if let [pipe, ..] = self.pipes() {
            let help = "an equilibrium keeps the amounts of liquids as they are: leave the pipes out, or run the scene until it is at rest";
            return Err(InputError::new("pipe of statics", format!("\"{}\"", pipe.name()), help));
        }
        if self.pours() {
            let help = "an equilibrium keeps the amounts of liquids as they are: leave it out and give a fill, or run the scene";
            return Err(InputError::new("flow of statics", "into a chamber", help));
        }
        self.initial_velocities()?;
        let from = self.initial_displacements();
        let starts = from.iter().any(|u| *u != 0.0);
        self.with_fixed_amounts().forces()?; // errors of what is constant, before it rises
        let mut forces = self.loaded(!starts).forces()?;
        indicators::overlap::check_start(self)?;
        let matrices = self.matrices(&forces);
        let phase = &self.phases()[number]; // `forces` makes sure that there is one
        let (time, u) = self.left_by_phases_before(number)?;
        let start = PhaseStart { time, u: &u };
        let system = self.system(&matrices, phase, forces.swap_remove(number), &start, 0.0)?;
        let rest = AtRest::new(system, phase.end(), phase.name())?;
        if !starts {
            return Ok(rest);
        }
        rest.starting_from(from.to_vec()).map_err(|failure| {
            InputError::new("state at the start", "of an equilibrium", reason(failure))
        })
    }

    fn equilibrium_in(&self, number: usize, statics: &Statics) -> Result<Equilibrium, Error> {
        let clock = Instant::now();
        statics.validate()?;
        let rest = self.at_rest_in(number)?;
        let phase = &self.phases()[number];
        let natural = rigid::Shape::natural(self.body());
        let pattern = self.body().inertia().pattern();
        let free = rigid::free_motions(natural, pattern, rest.system().rows());
        let words: Vec<&str> = free.iter().map(|motion| &*motion.words).collect();
        let words = words.join(", ");
        let loose = |freedom: &str, help: &str| {
            let input = format!("constraints of phase \"{}\"", phase.name());
            let value = format!("leaving the body free {freedom}");
            Error::from(InputError::new(input, value, help))
        };
        let linear = rest.is_linear();
        // rows of several nodes do not act in the factorization of K
        let (of_nodes, sums): (Vec<ConstraintRow>, Vec<ConstraintRow>) = rest
            .system()
            .rows()
            .iter()
            .cloned()
            .partition(|row| row.node(natural.dimension).is_some());
        let is_held_by_nodes =
            || sums.is_empty() || rigid::free_motions(natural, pattern, &of_nodes).is_empty();
        let hold = match free.is_empty() {
            false => Hold::Loose,
            true if is_held_by_nodes() => Hold::Whole,
            true => Hold::BySums,
        };
        let mut search = Search::new(rest, statics, self.body(), hold);
        if !free.is_empty() && search.rest.is_under_dead_loads() {
            // forces are defined in the undeformed shape
            let _ = search.rest.evaluate(1.0, &search.u, &mut search.at);
            let round_off = search.round_off();
            // a turn may balance a moment
            let is_lost = |motion: &&RigidMotion| !motion.is_turn && search.is_neutral(motion, 0.0);
            let mut lost = free.iter().filter(|motion| linear || is_lost(motion));
            let resultant = |motion: &RigidMotion| motion.resultant(&search.at.total, round_off);
            if let Some(resultant) = lost.find_map(resultant) {
                let freedom = format!("for {words}; {resultant}");
                return Err(loose(&freedom, "hold more of its nodes, or balance the loads"));
            }
        }
        if statics.arc_steps > 0 {
            if !free.is_empty() {
                return Err(loose(
                    &format!("for {words}"),
                    "for arc length, hold more of its nodes",
                ));
            }
            if search.rest.is_driven() {
                let input = format!("statics.arc_steps for phase \"{}\"", phase.name());
                let help = "obstacles in motion cannot follow a load that falls: give them no motion, or leave it 0";
                return Err(InputError::new(input, statics.arc_steps, help).into());
            }
        }
        let result = if statics.arc_steps > 0 { search.trace() } else { search.all() };
        let mut trajectory = self.load_curve(number, &mut search)?;
        trajectory.report.wall_seconds = clock.elapsed().as_secs_f64();
        trajectory.report.indicators = indicators::of_equilibrium(&trajectory, result.is_ok());
        if let Err(Stuck { mut cause, residual }) = result {
            if !free.is_empty() {
                cause += &format!("; the constraints leave the body free for {words}");
                search.resultants().iter().for_each(|left| cause += &format!("; {left}"));
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
        if linear && free.is_empty() && stability == Stability::Neutral {
            return Err(loose("to deform without force", "hold more of its nodes"));
        }
        Ok(Equilibrium {
            trajectory,
            stability,
            removed: std::mem::take(&mut search.removed),
            residual: search.residual,
            force_scale: search.at.scale,
            iterations: search.iterations,
            factorizations: search.rest.factorizations(),
            difference_evaluations: search.rest.system().difference_evaluations(),
            load_steps: search.load_steps,
            failed_steps: search.failed_steps,
            damped_steps: search.damped_steps,
            mesh_estimate: None,
        })
    }

    /// The start (s) of the phase of that `number`, and the displacements (m) left by the constraints of
    /// those before it.
    fn left_by_phases_before(&self, number: usize) -> Result<(f64, Vec<f64>), InputError> {
        let (mut time, mut u) = (0.0, self.initial_displacements().to_vec());
        for phase in &self.phases()[..number] {
            let rows = self.rows(phase, &PhaseStart { time, u: &u })?;
            time = phase.end();
            prescribe(&rows, time, &mut u);
        }
        Ok((time, u))
    }

    /// The start and the equilibria that were found, as samples.
    fn load_curve(&self, phase: usize, search: &mut Search) -> Result<Trajectory, InputError> {
        let start = Point::start(search.rest.start(), search.mu.len());
        let unloaded = search.rest.energy(0.0, &start.u);
        let points = std::mem::take(&mut search.curve);
        let is_curve = search.statics.is_curve();
        let (acting, d) = (&self.phases()[phase], self.body().dimension());
        let branches = self.body().branches();
        let relaxed = |u: &[f64]| {
            let mut strains = vec![0.0; branches.as_ref().map_or(0, Branches::unknowns)];
            branches.iter().for_each(|branches| branches.relax(u, &mut strains));
            strains
        };
        let sample = |(number, point): (usize, &Point)| -> Result<Sample, InputError> {
            let load = search.rest.acting(point.fraction);
            let others = (self.obstacles(), self.presets_in(acting));
            let commanded = acting.at_rest([load, point.fraction], others, d);
            let mut energy = search.rest.energy(point.fraction, &point.u);
            energy.supplied = energy.balance() - unloaded.balance();
            Ok(Sample {
                time: search.time(number, points.len(), point.fraction),
                phase,
                u: point.u.clone(),
                v: vec![0.0; point.u.len()],
                multipliers: point.mu.clone(),
                amounts: self.amounts_at(load, acting, &commanded)?,
                internal_strains: relaxed(&point.u),
                energy,
                constraint_drift: point.drift,
                sensors: if is_curve { vec![point.fraction] } else { Vec::new() },
                accelerations: Vec::new(),
                commanded: Commanded(Some(Arc::new(commanded))),
            })
        };
        let mut trajectory = Trajectory::new(self, Report::default(), sample((0, &start))?);
        if is_curve {
            trajectory.sensors = vec![Quantity { name: LOAD_FACTOR.into(), unit: "1".into() }];
        }
        for point in (1..).zip(&points) {
            trajectory.push(sample(point)?);
        }
        Ok(trajectory)
    }
}
