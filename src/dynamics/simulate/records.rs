//! Quantities derived from a state of the run: energies, samples, projected velocities.

use std::mem::take;
use std::sync::Arc;

use super::angles::Angles;
use super::sensor::Sensors;
use super::view::{Gauges, View};
use crate::base::vector::largest;
use crate::dynamics::state::{State, StateMut};
use crate::dynamics::system::{Energy, PhaseSystem, System};
use crate::dynamics::trajectory::{Commanded, Sample};
use crate::integrators::ode::Failure;
use crate::scene::constraint::ConstraintRow;
use crate::scene::settings::{MotionForm, Settings};
use crate::scene::timeline::{Phase, Scene};

/// Sample from `state` at `time` alone, without constraint forces, energies that have to be
/// evaluated, and readings of sensors.
pub(super) fn of_state(phase: usize, system: &System, time: f64, state: &[f64]) -> Sample {
    let layout = system.layout();
    let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
    let (strains, amounts) = layout.split(internal);
    Sample {
        time,
        phase,
        u: u.to_vec(),
        v: v.to_vec(),
        multipliers: Vec::new(),
        amounts: amounts.to_vec(),
        internal_strains: strains.to_vec(),
        energy: Energy { dissipated, supplied, ..Energy::default() },
        constraint_drift: 0.0,
        sensors: Vec::new(),
        accelerations: Vec::new(),
        commanded: Commanded::default(),
    }
}

/// The sample of `state` at `time`, without readings of sensors. Accelerations are for
/// sensors that read them, and kept until then.
pub(super) fn sample(
    phase: usize,
    equations: &mut dyn PhaseSystem,
    time: f64,
    state: &[f64],
    accelerates: bool,
) -> Result<Sample, Failure> {
    let State { u, v, internal, .. } = equations.full().layout().of(state);
    equations.evaluate(time, [u, v, internal])?;
    let (energy, system) = (energy(equations, time, state), equations.full());
    let multipliers = system.computed_multipliers().to_vec();
    let accelerations =
        if accelerates { system.computed_accelerations().to_vec() } else { Vec::new() };
    let constraint_drift = system.drift(time, u);
    let sample = of_state(phase, system, time, state);
    Ok(Sample { multipliers, energy, constraint_drift, accelerations, ..sample })
}

/// Adds to a sample what `sensors` read, and the phase in force if commands have changed it.
pub(super) fn complete(
    sample: &mut Sample,
    (sensors, angles): (&Sensors, &Angles),
    (scene, gauges): (&Scene, &Gauges),
    phase: &Arc<Phase>,
    is_commanded: bool,
) {
    sample.commanded = Commanded(is_commanded.then(|| phase.snapshot()));
    if sensors.is_empty() {
        return;
    }
    let accelerations = &take(&mut sample.accelerations)[..];
    let view = View { accelerations, ..View::of_sample((scene, gauges), phase, sample) };
    let readings = sensors.read(&view, sample, angles);
    sample.sensors = readings;
}

/// Energies of `state` at `time`.
pub(super) fn energy(equations: &dyn PhaseSystem, time: f64, state: &[f64]) -> Energy {
    let layout = equations.full().layout();
    let State { u, v, internal, dissipated, supplied, .. } = layout.of(state);
    let energy = equations.energy(time, [u, v, internal]);
    Energy { dissipated, supplied, ..energy }
}

/// Projects the velocities of `state` onto those that the constraints allow, if the phase requires that or
/// the method has an equation for velocities, which allows no others. The change of the kinetic energy counts
/// as supplied by the constraints.
pub(super) fn project(
    settings: &Settings,
    phase: &Phase,
    system: &mut System,
    time: f64,
    state: &mut [f64],
) {
    if phase.projects_velocity || settings.method.information().form == MotionForm::IndexTwo {
        project_now(system, time, state);
    }
}

/// As [`project`] at t = 0, also if velocities were given that the constraints do not allow. (A body at rest
/// that is suddenly moved is brought to that velocity by the stabilization.)
pub(super) fn begin_to_move(
    settings: &Settings,
    phase: &Phase,
    system: &mut System,
    state: &mut [f64],
) {
    let v = system.layout().of(state).v;
    let violates = |row: &ConstraintRow| row.apply(v) != row.prescribed(0.0).velocity;
    if largest(v) > 0.0 && (system.rows().iter().any(violates) || system.distorts(v)) {
        project_now(system, 0.0, state);
    } else {
        project(settings, phase, system, 0.0, state);
    }
}

fn project_now(system: &mut System, time: f64, state: &mut [f64]) {
    let StateMut { u, v, supplied, .. } = system.layout().of_mut(state);
    let before = system.kinetic_energy(v);
    system.project(time, u, v);
    *supplied += system.kinetic_energy(v) - before;
}
