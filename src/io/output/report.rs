//! Reports: how a result was obtained.

use std::path::Path;

use serde_json::{Value, json};

use super::write_file;
use crate::dynamics::equilibrium::{Equilibrium, MeshEstimate, NoEquilibrium, Stability};
use crate::dynamics::error::Error;
use crate::dynamics::report::{Achieved, Indicator, PhaseReport, Report, SlipEvent};
use crate::dynamics::trajectory::{IntegrationFailure, Quantity, Trajectory};
use crate::integrators::sundials;

/// Name, unit and meaning of a key. Keys in a table follow its name, after a dot; `[]` stands for each item
/// of a list.
pub(super) type ReportKey = (&'static str, &'static str, &'static str);

/// The keys of [`write_report`].
pub(super) const OF_RUN: &[ReportKey] = &[
    ("status", "", "`\"finished\"`, `\"failed\"` or `\"interrupted\"`"),
    ("title", "", "title of the scene; empty without one"),
    ("failure", "", "what ended the run; `null` of one that was finished"),
    ("failure.phase", "", "name of the phase"),
    ("failure.time", "s", "time reached"),
    ("failure.step", "s", "size of the last step"),
    ("failure.cause", "", "the cause, in words"),
    ("method", "", "method, as `pliant methods` names it"),
    ("rtol", "1", "relative tolerance"),
    ("alpha", "1/s", "stabilization rate of constraints"),
    ("states", "", "unknowns of the integrator, in the last phase"),
    ("steps", "", "steps taken"),
    ("rhs_evaluations", "", "evaluations of the right-hand side or residual"),
    ("jacobian_evaluations", "", "evaluations of the tangents, where they are not constant"),
    (
        "difference_evaluations",
        "",
        "evaluations of forces for tangents by finite differences, of those that do not give theirs",
    ),
    ("factorizations", "", "factorizations of the Newton matrix"),
    ("linear_iterations", "", "iterations in the place of factorizations, on large solids"),
    ("error_test_failures", "", "steps repeated as their error was too large"),
    ("convergence_failures", "", "Newton iterations that did not converge"),
    ("wall_seconds", "s", "wall-clock time of the whole run"),
    ("phases", "", "the phases that were begun, in their order"),
    ("phases[].name", "", "name of the phase"),
    ("phases[].end", "s", "time reached"),
    ("phases[].method", "", "method in the end"),
    ("phases[].reason", "", "why that method; `null` if it was asked for"),
    ("phases[].rtol", "1", "as above, of this phase alone, as are all that follow"),
    ("phases[].alpha", "1/s", "stabilization rate"),
    ("phases[].states", "", "unknowns of the integrator"),
    ("phases[].steps", "", "steps taken"),
    ("phases[].rhs_evaluations", "", "evaluations of the right-hand side or residual"),
    ("phases[].jacobian_evaluations", "", "evaluations of the tangents"),
    ("phases[].difference_evaluations", "", "evaluations of forces for tangents"),
    ("phases[].factorizations", "", "factorizations of the Newton matrix"),
    ("phases[].linear_iterations", "", "iterations in the place of factorizations"),
    ("phases[].error_test_failures", "", "steps repeated"),
    ("phases[].convergence_failures", "", "Newton iterations that did not converge"),
    ("phases[].wall_seconds", "s", "wall-clock time"),
    ("phases[].contact_events", "", "contact events that were located"),
    (
        "phases[].slips",
        "",
        "when the body began to slide or to stick under friction, where contact events are located",
    ),
    ("phases[].slips[].time", "s", "when"),
    ("phases[].slips[].obstacle", "", "name of the obstacle"),
    ("phases[].slips[].slides", "", "whether it began to slide; `false`: to stick"),
    ("phases[].last_step", "s", "size of the last step"),
    ("phases[].last_order", "", "order of the last step"),
    ("energy_balance_error", "J", "largest change of the energy balance"),
    ("energy_created", "J", "largest rise of the energy balance"),
    ("energy_scale", "J", "largest sum of the energies"),
    ("max_constraint_drift", "m", "largest error of a constraint at the end of a step"),
    ("chosen", "", "what was chosen where the scene file says `auto`, and why"),
    ("achieved", "", "to what the motion is known; `null` without `--accuracy`"),
    ("achieved.quantity", "", "what was compared"),
    ("achieved.asked", "1", "the relative difference of two runs that was asked for at most"),
    ("achieved.difference", "1", "the one that was found"),
    ("achieved.scale", "its own", "what both are relative to: how much the quantity changes"),
    ("achieved.unit", "", "unit of the scale"),
    (
        "achieved.known_until",
        "s",
        "time until which the runs agree as was asked; the end if they do in all",
    ),
    ("achieved.runs", "", "runs in all"),
    ("achieved.rtol", "1", "relative tolerances of the last two"),
    ("sensors", "", "the sensors, in the order of their columns in `trajectory.csv`"),
    ("sensors[].name", "", "name of the column"),
    ("sensors[].unit", "", "its unit"),
    ("warnings", "", "what makes the result doubtful, in words"),
    ("indicators", "", "what was measured once the run had ended, beyond its limits or not"),
    ("indicators[].name", "", "what was measured"),
    ("indicators[].value", "its own", "the number"),
    (
        "indicators[].limits",
        "its own",
        "least and most that are in order; `null` where there is no limit",
    ),
    ("indicators[].unit", "", "unit of both"),
    (
        "indicators[].verdict",
        "",
        "`\"fine\"`, `\"doubtful\"` (a warning) or `\"more-than-needed\"`",
    ),
    ("indicators[].text", "", "all of it in words"),
    ("versions", "", "what computed it"),
    ("versions.pliant", "", "version of `pliant`"),
    ("versions.sundials", "", "version of the linked SUNDIALS"),
    ("versions.suitesparse", "", "version of the linked SuiteSparse (KLU)"),
];

/// The keys of [`write_static_report`].
pub(super) const OF_STATICS: &[ReportKey] = &[
    ("status", "", "`\"finished\"` or `\"failed\"`"),
    ("failure", "", "why the search gave up; `null` if it did not"),
    ("failure.phase", "", "name of the phase"),
    ("failure.fraction", "1", "part of the load for which an equilibrium was found"),
    ("failure.tried", "1", "part for which none was found"),
    ("failure.cause", "", "the likely cause, and what to try"),
    ("method", "", "`\"static\"`"),
    ("states", "", "displacement components"),
    ("stability", "", "what a small push does to the equilibrium"),
    ("stability.kind", "", "`\"stable\"`, `\"neutral\"` or `\"unstable\"`"),
    (
        "stability.frequency",
        "Hz",
        "lowest natural frequency; `null` if it is not stable or nothing can move",
    ),
    ("stability.growth", "1/s", "rate at which a push grows; `null` if it is not unstable"),
    (
        "removed",
        "",
        "rigid motions, in words, that nothing holds and that were taken out of the displacements",
    ),
    ("residual", "N", "largest nodal force left unbalanced"),
    ("force_scale", "N", "largest nodal force of those that balance each other"),
    ("iterations", "", "Newton iterations in all load steps"),
    ("factorizations", "", "factorizations of the tangent"),
    ("load_steps", "", "load steps that converged"),
    ("failed_steps", "", "load steps that did not, and were made smaller"),
    (
        "mesh_estimate",
        "",
        "by how much a quantity is off because of the mesh; `null` without `--quantity`",
    ),
    ("mesh_estimate.quantity", "", "what was asked for"),
    ("mesh_estimate.unit", "", "its unit"),
    ("mesh_estimate.value", "its own", "what it is on this mesh"),
    ("mesh_estimate.change", "its own", "how much it has changed from the undeformed shape"),
    (
        "mesh_estimate.correction",
        "its own",
        "estimate of what it would be on a richer mesh, less the value",
    ),
    (
        "mesh_estimate.remainder",
        "its own",
        "leading remainder of the correction, which may be far off where that is larger than itself; `null` if forces have no meaning there",
    ),
    (
        "mesh_estimate.relative",
        "1",
        "size of the correction as a part of the change; `null` without one",
    ),
    ("mesh_estimate.unknowns", "", "displacement components on the richer mesh"),
    ("mesh_estimate.wall_seconds", "s", "wall-clock time of the estimate"),
    ("wall_seconds", "s", "wall-clock time of the search"),
    ("max_constraint_drift", "m", "largest error of a constraint"),
    ("sensors", "", "the sensors, in the order of their columns in `trajectory.csv`"),
    ("sensors[].name", "", "name of the column"),
    ("sensors[].unit", "", "its unit"),
    ("warnings", "", "what makes the result doubtful, in words"),
    ("indicators", "", "what was measured once the search had ended, beyond its limits or not"),
    ("indicators[].name", "", "what was measured"),
    ("indicators[].value", "its own", "the number"),
    (
        "indicators[].limits",
        "its own",
        "least and most that are in order; `null` where there is no limit",
    ),
    ("indicators[].unit", "", "unit of both"),
    (
        "indicators[].verdict",
        "",
        "`\"fine\"`, `\"doubtful\"` (a warning) or `\"more-than-needed\"`",
    ),
    ("indicators[].text", "", "all of it in words"),
    ("versions", "", "what computed it"),
    ("versions.pliant", "", "version of `pliant`"),
    ("versions.sundials", "", "version of the linked SUNDIALS"),
    ("versions.suitesparse", "", "version of the linked SuiteSparse (KLU)"),
];

/// Writes how a run was computed, whether it was finished, gave up or was interrupted, as JSON, with the keys
/// of [`reference`](super::reference).
///
/// # Errors
/// [`Error::Output`] if the file cannot be written.
///
/// ```
/// use pliant::output::write_report;
/// # use pliant::{Body, Cells, Error, Material, Mesh, Phase, Sampling, Scene, Settings};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("report.json");
/// match scene.simulate(&Settings::default(), &Sampling::every(0.01)) {
///     Ok(trajectory) => write_report(Ok(&trajectory), &path)?,
///     Err(Error::Integration(failure)) => write_report(Err(&failure), &path)?,
///     Err(bad_input) => return Err(bad_input),
/// }
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_report(
    run: Result<&Trajectory, &IntegrationFailure>,
    path: impl AsRef<Path>,
) -> Result<(), Error> {
    let (trajectory, status, failure) = match run {
        Ok(trajectory) => (trajectory, "finished", Value::Null),
        Err(end) => {
            let status = if end.is_interruption() { "interrupted" } else { "failed" };
            let IntegrationFailure { phase, time, step, .. } = end;
            let failure =
                json!({ "phase": phase, "time": time, "step": step, "cause": end.cause() });
            (&end.trajectory, status, failure)
        }
    };
    let report = trajectory.report();
    let phases: Vec<Value> = report.phases.iter().map(|phase| of_phase(report, phase)).collect();
    write_json(
        path.as_ref(),
        &json!({
            "status": status,
            "title": report.title,
            "failure": failure,
            "method": report.method.name(),
            "rtol": report.rtol,
            "alpha": report.alpha,
            "states": report.states,
            "steps": report.steps(),
            "rhs_evaluations": report.evaluations(),
            "jacobian_evaluations": report.jacobian_evaluations(),
            "difference_evaluations": report.difference_evaluations(),
            "factorizations": report.factorizations(),
            "linear_iterations": report.linear_iterations(),
            "error_test_failures": report.error_test_failures(),
            "convergence_failures": report.convergence_failures(),
            "wall_seconds": report.wall_seconds,
            "phases": phases,
            "energy_balance_error": report.energy_error,
            "energy_created": report.energy_created,
            "energy_scale": report.energy_scale,
            "max_constraint_drift": report.constraint_drift,
            "chosen": report.chosen,
            "achieved": report.achieved.as_ref().map(of_achieved),
            "sensors": of_sensors(trajectory),
            "warnings": report.warnings(),
            "indicators": report.indicators.iter().map(of_indicator).collect::<Vec<_>>(),
            "versions": versions(),
        }),
    )
}

fn of_achieved(achieved: &Achieved) -> Value {
    let Achieved { quantity, asked, difference, scale, unit, known_until, runs, rtol, .. } =
        achieved;
    json!({
        "quantity": quantity,
        "asked": asked,
        "difference": difference,
        "scale": scale,
        "unit": unit,
        "known_until": known_until,
        "runs": runs,
        "rtol": rtol,
    })
}

/// An indicator as data; what is not finite is `null`.
pub(crate) fn of_indicator(indicator: &Indicator) -> Value {
    let Indicator { name, value, limits, unit, verdict, text } = indicator;
    json!({
        "name": name,
        "value": value,
        "limits": limits,
        "unit": unit,
        "verdict": verdict.name(),
        "text": text,
    })
}

fn of_phase(report: &Report, phase: &PhaseReport) -> Value {
    let PhaseReport { name, end, states, wall_seconds, method, reason, counts, slips } = phase;
    let slips = slips.iter().map(|SlipEvent { time, obstacle, slides }| {
        json!({ "time": time, "obstacle": obstacle, "slides": slides })
    });
    json!({
        "name": name,
        "end": end,
        "method": method.name(),
        "reason": reason,
        "rtol": report.rtol,
        "alpha": report.alpha,
        "states": states,
        "steps": counts.steps,
        "rhs_evaluations": counts.evaluations,
        "jacobian_evaluations": counts.jacobian_evaluations,
        "difference_evaluations": counts.difference_evaluations,
        "factorizations": counts.factorizations,
        "linear_iterations": counts.linear_iterations,
        "error_test_failures": counts.error_test_failures,
        "convergence_failures": counts.convergence_failures,
        "wall_seconds": wall_seconds,
        "contact_events": counts.contact_events,
        "slips": slips.collect::<Vec<_>>(),
        "last_step": counts.last_step,
        "last_order": counts.last_order,
    })
}

/// Writes how an equilibrium was found, or how far the search for it came, as JSON, with the keys of
/// [`reference`](super::reference). What a search that gave up does not know is `null`.
///
/// # Errors
/// [`Error::Output`] if the file cannot be written.
pub fn write_static_report(
    found: Result<&Equilibrium, &NoEquilibrium>,
    path: impl AsRef<Path>,
) -> Result<(), Error> {
    let (trajectory, residual, iterations) = match found {
        Ok(found) => (found.trajectory(), found.residual, found.iterations),
        Err(lost) => (&lost.trajectory, lost.residual, lost.iterations),
    };
    let failure = |lost: &NoEquilibrium| {
        let NoEquilibrium { phase, fraction, tried, cause, .. } = lost;
        json!({ "phase": phase, "fraction": fraction, "tried": tried, "cause": cause })
    };
    let stability = |found: &Equilibrium| {
        let (kind, frequency, growth) = match found.stability {
            Stability::Stable { frequency } => ("stable", Some(frequency), None),
            Stability::Neutral => ("neutral", None, None),
            Stability::Unstable { growth } => ("unstable", None, Some(growth)),
        };
        json!({ "kind": kind, "frequency": frequency, "growth": growth })
    };
    write_json(
        path.as_ref(),
        &json!({
            "status": if found.is_ok() { "finished" } else { "failed" },
            "failure": found.err().map(failure),
            "method": "static",
            "states": trajectory.body().dofs(),
            "stability": found.ok().map(stability),
            "removed": found.ok().map(|found| &found.removed),
            "residual": residual,
            "force_scale": found.ok().map(|found| found.force_scale),
            "iterations": iterations,
            "factorizations": found.ok().map(|found| found.factorizations),
            "load_steps": found.ok().map(|found| found.load_steps),
            "failed_steps": found.ok().map(|found| found.failed_steps),
            "mesh_estimate": found.ok().and_then(|found| found.mesh_estimate.as_ref()).map(of_mesh),
            "wall_seconds": trajectory.report().wall_seconds,
            "max_constraint_drift": trajectory.samples().last().map(|sample| sample.constraint_drift),
            "sensors": of_sensors(trajectory),
            "warnings": trajectory.report().warnings(),
            "indicators": trajectory.report().indicators.iter().map(of_indicator).collect::<Vec<_>>(),
            "versions": versions(),
        }),
    )
}

fn of_sensors(trajectory: &Trajectory) -> Vec<Value> {
    let sensor = |sensor: &Quantity| json!({ "name": sensor.name, "unit": sensor.unit });
    trajectory.sensors().iter().map(sensor).collect()
}

fn of_mesh(estimate: &MeshEstimate) -> Value {
    let MeshEstimate {
        quantity,
        unit,
        value,
        change,
        correction,
        remainder,
        unknowns,
        seconds,
        ..
    } = estimate;
    json!({
        "quantity": quantity,
        "unit": unit,
        "value": value,
        "change": change,
        "correction": correction,
        "remainder": remainder,
        "relative": estimate.relative(),
        "unknowns": unknowns,
        "wall_seconds": seconds,
    })
}

fn versions() -> Value {
    json!({
        "pliant": env!("CARGO_PKG_VERSION"),
        "sundials": sundials::version(),
        "suitesparse": sundials::suitesparse_version(),
    })
}

fn write_json(path: &Path, document: &Value) -> Result<(), Error> {
    write_file(path, |file| writeln!(file, "{document:#}"))
}
