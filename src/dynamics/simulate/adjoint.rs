//! The discrete adjoint of the steps of a run: the derivative of a reading at the end by any numbers of the scene.
//!
//! With the adjoint vectors of all steps held ([`StepAdjoint`]), the derivative of the reading by a number is that of a sum
//! of values of the equations in the stages that the run had: the Lagrangian of the steps as constraints. So [`Tape::lagrangians`] takes
//! scenes with another number and returns this sum for each, whose differences are differences of the reading to first order. It
//! evaluates forces and tangents of these scenes in the states of the run, and factorizes nothing of them but inertia.
//!
//! States are handed from phase to phase as they are. Where nodes are held from where they are as a phase begins, what is prescribed
//! depends on the state then, which is followed.

use std::mem::take;
use std::sync::Arc;

use rayon::prelude::*;

use super::records;
use super::run::Run;
use super::simulation::Simulation;
use super::tape::{Tape, TapedStep};
use crate::base::simd::add_multiple;
use crate::base::vector::{dot, noise};
use crate::dynamics::phase::{Failed, repeating};
use crate::dynamics::system::System;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::integrators::common::Integrator;
use crate::integrators::ode::Failure;
use crate::integrators::rosenbrock::StepAdjoint;
use crate::scene::constraint::{ConstraintRow, PhaseStart, prescribe};

/// Reads a number from a sample of a motion.
pub(crate) type Read<'a> = dyn Fn(&Trajectory, &Sample) -> Option<f64> + Sync + 'a;

/// Shifts of displacements and velocities for the derivative of the reading, in parts of their scales, and of displacements at the start of
/// a phase.
const SHIFT: f64 = 1e-3;

/// Relative difference of shifts that are the same.
const SAME: f64 = 1e-6;

/// The equations of the phases of a scene.
struct Phases {
    systems: Vec<System>,
    /// For each phase its start and the ends of its intervals (s).
    bounds: Vec<Vec<f64>>,
}

/// A scene with another number.
struct Other {
    phases: Phases,
    /// Whether the inertia and the rows of the present phase are those of the run.
    has_masses: bool,
    weights: [Vec<f64>; 2],
    sum: f64,
}

impl Tape {
    /// The Lagrangian of the run for each of the `others`, scenes at their start with another number. `own` are two simulations of the scene
    /// of the run at its start; `read` reads the end.
    ///
    /// # Errors
    /// The reason for which the adjoint is not available.
    pub(crate) fn lagrangians(
        &self,
        own: [Simulation; 2],
        others: Vec<Simulation>,
        read: &Read,
    ) -> Result<Vec<f64>, String> {
        match &self.refused {
            Some(why) => Err(why.clone()),
            None => self.take_back(own, others, read).map_err(|failed| failed.to_string()),
        }
    }

    fn take_back(
        &self,
        [mut own, mut again]: [Simulation; 2],
        others: Vec<Simulation>,
        read: &Read,
    ) -> Result<Vec<f64>, Failed> {
        if own.run.sensors.need_forces() {
            return Err(
                "adjoint gradients do not yet support readings of forces, accelerations and energies".into()
            );
        }
        let mut phases = self.phases(&mut own.run)?;
        let mut beside = self.phases(&mut again.run)?.systems;
        let are_held = self.held_from_their_start(&own.run, &phases)?;
        let Some(end) = self.states.last() else { return Err("there are no steps".into()) };
        let mut lambda = self.slope(&own.run, &beside[beside.len() - 1], end, read)?;
        let mut starts = Vec::new();
        let mut all = Vec::new();
        for mut other in others {
            let start = other.run.state.clone();
            let phases = self.phases(&mut other.run)?;
            let number =
                number_at(&other.run, &phases.systems[phases.systems.len() - 1], end, read);
            let sum = number.ok_or("the reading is not defined")?;
            starts.push(start);
            all.push(Other { phases, has_masses: false, weights: Default::default(), sum });
        }
        // the derivative by shifts of what rows prescribe
        let mut handed: Vec<f64> = Vec::new();
        while let (Some(system), Some(mut beside)) = (phases.systems.pop(), beside.pop()) {
            let number = phases.systems.len();
            for other in &mut all {
                other.has_masses = other.phases.systems[number].has_masses_of(&system);
            }
            let alpha = system.alpha();
            let rows = system.rows().to_vec();
            // those of nodes that the next phase goes on to hold
            let mut shifts = take(&mut handed);
            shifts.resize(rows.len(), 0.0);
            let mut integrator = repeating(system, &self.settings, (0.0, end))?;
            let mut adjoint = StepAdjoint::new(&integrator);
            for (at, step) in self.steps.iter().enumerate().rev() {
                if step.phase != number {
                    continue;
                }
                let [from, to] = phases.span(step)?;
                integrator.reinit(from, &self.states[at])?;
                integrator.set_stop_time(Some(to))?;
                integrator.step(to)?;
                if integrator.statistics().steps > 1 {
                    return Err("a step cannot be repeated as it was".into());
                }
                let pulled = adjoint.pull_back(&mut integrator, &mut beside, &mut lambda);
                pulled.map_err(Failure::into_error)?;
                for (size, weights) in adjoint.impulses() {
                    for (shift, m) in shifts.iter_mut().zip(beside.of_rows(weights)) {
                        *shift += size * alpha * alpha * m;
                    }
                }
                let added = all.par_iter_mut().map(|other| other.add(&adjoint, step));
                added.collect::<Result<Vec<()>, Failed>>()?;
            }
            let before = phases.systems.last().map_or(&[][..], System::rows);
            handed.resize(before.len(), 0.0);
            for ((row, shift), _) in
                rows.iter().zip(shifts).zip(&are_held[number]).filter(|of| *of.1)
            {
                for (dof, c) in &row.terms {
                    let own = |row: &ConstraintRow| row.nodal().filter(|(own, _)| own == dof);
                    let mut prescribed = before.iter().enumerate();
                    match prescribed.find_map(|(at, row)| Some((at, own(row)?.1))) {
                        Some((at, coefficient)) => handed[at] += c * shift / coefficient,
                        None => lambda[*dof] += c * shift,
                    }
                }
            }
        }
        Ok(all.iter().zip(&starts).map(|(other, start)| other.sum + dot(&lambda, start)).collect())
    }

    /// The equations of all phases of a run at its start, each of which begins in the state that this tape has there.
    fn phases(&self, run: &mut Run) -> Result<Phases, Failed> {
        let n = run.scene.body().dofs();
        if run.state.len() != self.states[0].len() {
            return Err("the scenes have different unknowns".into());
        }
        let scene = run.scene.clone();
        let (mut systems, mut bounds): (Vec<System>, Vec<Vec<f64>>) = Default::default();
        let mut u = run.state[..n].to_vec();
        for (number, phase) in scene.phases().iter().enumerate() {
            if let Some(before) = systems.last() {
                u = self.start_of(number)?[..n].to_vec();
                prescribe(before.rows(), run.time, &mut u);
                run.phase = Arc::new(phase.clone().after(&run.phase, scene.obstacles(), run.time));
            }
            run.number = number;
            let system = run.full_equations(&run.phase, &u)?;
            if let Some(why) = system.why_not_transposed() {
                return Err(why.into());
            }
            systems.push(system);
            let ends = scene.stops(number);
            bounds.push([&[run.time], &ends[..]].concat());
            run.time = phase.end();
        }
        run.angles.0.clone_from(&self.angles.0);
        Ok(Phases { systems, bounds })
    }

    /// The state at the start of a phase.
    fn start_of(&self, number: usize) -> Result<&[f64], Failed> {
        let first = self.steps.iter().position(|step| step.phase == number);
        Ok(&self.states[first.ok_or("a phase has no steps")?])
    }

    /// For each row of each phase whether it prescribes from then on where its nodes are as the phase begins, or where they are to be.
    fn held_from_their_start(&self, run: &Run, phases: &Phases) -> Result<Vec<Vec<bool>>, Failed> {
        let none = |system: &System| vec![false; system.rows().len()];
        let mut all: Vec<Vec<bool>> = phases.systems.iter().map(none).collect();
        for (number, held) in all.iter_mut().enumerate().skip(1) {
            let [before, system] = [number - 1, number].map(|at| &phases.systems[at]);
            let (phase, start) = (&run.scene.phases()[number], phases.bounds[number][0]);
            let mut u = self.start_of(number)?[..system.dofs()].to_vec();
            prescribe(before.rows(), start, &mut u);
            let size = SHIFT * run.matrices.scales[0];
            let shift: Vec<f64> = noise(u.len(), number).iter().map(|x| size * x).collect();
            add_multiple(1.0, &shift, &mut u);
            let shifted = run.scene.rows(phase, &PhaseStart { time: start, u: &u })?;
            for ((row, shifted), is_held) in system.rows().iter().zip(&shifted).zip(held) {
                let changes = |by: f64| {
                    [start, phase.end()].into_iter().all(|t| {
                        let [own, other] = [row, shifted].map(|row| row.prescribed(t));
                        (other.displacement - own.displacement - by).abs() <= SAME * size
                            && other.velocity == own.velocity
                            && other.acceleration == own.acceleration
                    })
                };
                *is_held = !changes(0.0);
                if *is_held && !changes(row.apply(&shift)) {
                    let name = phase.name();
                    return Err(
                        format!("adjoint gradients do not yet support the rotation prescribed in phase \"{name}\"").into()
                    );
                }
            }
        }
        Ok(all)
    }

    /// The derivative of what `read` reads by the state at the end, by differences.
    fn slope(
        &self,
        run: &Run,
        system: &System,
        end: &[f64],
        read: &Read,
    ) -> Result<Vec<f64>, Failed> {
        let n = system.dofs();
        let mut slope = vec![0.0; end.len()];
        for (kind, scale) in run.matrices.scales.into_iter().enumerate() {
            let dofs = kind * n..(kind + 1) * n;
            let shift = SHIFT * scale;
            let mut state = end.to_vec();
            let at = |state: &[f64]| number_at(run, system, state, read);
            let all = state[dofs.clone()].iter_mut().zip(noise(n, kind));
            all.for_each(|(x, noise)| *x += shift * noise);
            // a reading of places is none of velocities
            if at(&state) == at(end) {
                continue;
            }
            state.copy_from_slice(end);
            for dof in dofs {
                let [high, low] = [shift, -shift].map(|shift| {
                    state[dof] = end[dof] + shift;
                    at(&state)
                });
                state[dof] = end[dof];
                let ends = high.zip(low).ok_or("the reading is not defined beside the end")?;
                slope[dof] = (ends.0 - ends.1) / (2.0 * shift);
            }
        }
        Ok(slope)
    }
}

/// The number that `read` reads in a state at the end of the run, whose phase has the equations of `system`.
fn number_at(run: &Run, system: &System, state: &[f64], read: &Read) -> Option<f64> {
    let mut sample = records::of_state(run.number, system, run.time, state);
    run.complete(&mut sample);
    read(&run.trajectory, &sample)
}

impl Phases {
    /// Start and end of a step (s).
    fn span(&self, step: &TapedStep) -> Result<[f64; 2], Failed> {
        let bounds = &self.bounds[step.phase];
        let [Some(start), Some(stop)] = [0, 1].map(|next| bounds.get(step.interval + next)) else {
            return Err("a scene with another value has other intervals".into());
        };
        Ok(step.fractions.map(|fraction| match fraction {
            1.0 => *stop,
            _ => start + fraction * (stop - start),
        }))
    }
}

impl Other {
    /// Adds the contribution of the equations of the last step of the adjoint.
    fn add(&mut self, adjoint: &StepAdjoint, step: &TapedStep) -> Result<(), Failed> {
        let [start, end] = self.phases.span(step)?;
        let system = &mut self.phases.systems[step.phase];
        let weighed =
            adjoint.weigh(system, (start, end - start), self.has_masses, &mut self.weights);
        self.sum += weighed.map_err(Failure::into_error)?;
        Ok(())
    }
}
