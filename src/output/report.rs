//! Reports: how a result was obtained.

use std::path::Path;

use serde_json::{Value, json};

use super::write_file;
use crate::equilibrium::{Equilibrium, NoEquilibrium, Stability};
use crate::error::Error;
use crate::report::{PhaseReport, Report};
use crate::sundials;
use crate::trajectory::{IntegrationFailure, Quantity, Trajectory};

/// Writes how a run was computed, whether it was finished, gave up or was interrupted, as JSON:
///
/// | key | meaning |
/// | --- | --- |
/// | `status` | `"finished"`, `"failed"` or `"interrupted"` |
/// | `failure` | `null`, or `phase`, `time` (s), `step` (s) and `cause` of what ended the run |
/// | `method`, `rtol`, `alpha` | method, relative tolerance, stabilization rate (1/s) |
/// | `states` | unknowns of the integrator, in the last phase |
/// | `steps` | steps taken |
/// | `rhs_evaluations`, `jacobian_evaluations` | evaluations of the right-hand side or residual, and of the tangents where they are not constant |
/// | `difference_evaluations` | evaluations of forces for tangents by finite differences, of those that do not give theirs |
/// | `factorizations` | factorizations of the Newton matrix |
/// | `error_test_failures`, `convergence_failures` | steps repeated as their error was too large, Newton iterations that did not converge |
/// | `wall_seconds` | wall-clock time of the whole run (s) |
/// | `phases` | for each phase `name`, `end` (time reached, s), `reason` (why that method, or `null` if it was asked for), all of the above from `method` on, `contact_events` (located), `last_step` (s) and `last_order` |
/// | `energy_balance_error`, `energy_created`, `energy_scale` | largest change and largest rise of the energy balance, largest sum of the energies (J) |
/// | `max_constraint_drift` | largest error of a constraint at the end of a step (m) |
/// | `sensors` | `name` and `unit` of each sensor, in the order of the columns of [`write_csv`](super::write_csv) |
/// | `warnings` | what makes the result doubtful, in words |
/// | `versions` | `pliant`, and the linked `sundials` and `suitesparse` (KLU) |
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
    let sensor = |sensor: &Quantity| json!({ "name": sensor.name, "unit": sensor.unit });
    let sensors: Vec<Value> = trajectory.sensors().iter().map(sensor).collect();
    let phases: Vec<Value> = report.phases.iter().map(|phase| of_phase(report, phase)).collect();
    write_json(
        path.as_ref(),
        &json!({
            "status": status,
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
            "error_test_failures": report.error_test_failures(),
            "convergence_failures": report.convergence_failures(),
            "wall_seconds": report.wall_seconds,
            "phases": phases,
            "energy_balance_error": report.energy_error,
            "energy_created": report.energy_created,
            "energy_scale": report.energy_scale,
            "max_constraint_drift": report.constraint_drift,
            "sensors": sensors,
            "warnings": report.warnings(),
            "versions": versions(),
        }),
    )
}

fn of_phase(report: &Report, phase: &PhaseReport) -> Value {
    let PhaseReport { name, end, states, wall_seconds, method, reason, counts } = phase;
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
        "error_test_failures": counts.error_test_failures,
        "convergence_failures": counts.convergence_failures,
        "wall_seconds": wall_seconds,
        "contact_events": counts.contact_events,
        "last_step": counts.last_step,
        "last_order": counts.last_order,
    })
}

/// Writes how an equilibrium was found, or how far the search for it came, as JSON:
///
/// | key | meaning |
/// | --- | --- |
/// | `status` | `"finished"` or `"failed"` |
/// | `failure` | `null`, or `phase`, `fraction` (part of the load in balance), `tried` (part for which no equilibrium was found) and `cause` |
/// | `method` | `"static"` |
/// | `states` | displacement components |
/// | `stability` | `kind` (`"stable"`, `"neutral"` or `"unstable"`), `frequency` (lowest natural one, Hz; `null` if nothing can move) and `growth` (1/s) |
/// | `removed` | rigid motions, in words, that nothing holds and that were taken out of the displacements |
/// | `residual`, `force_scale` | largest nodal force left unbalanced, and largest of those that balance each other (N) |
/// | `iterations`, `factorizations`, `load_steps`, `failed_steps` | what it took |
/// | `wall_seconds` | wall-clock time of the search (s) |
/// | `max_constraint_drift` | largest error of a constraint (m) |
/// | `warnings` | what makes the result doubtful, in words |
/// | `versions` | as in [`write_report`] |
///
/// What a search that gave up does not know is `null`.
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
            "wall_seconds": trajectory.report().wall_seconds,
            "max_constraint_drift": trajectory.samples().last().map(|sample| sample.constraint_drift),
            "warnings": trajectory.report().warnings(),
            "versions": versions(),
        }),
    )
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
