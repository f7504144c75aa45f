//! Reports: how a result was obtained.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::write_file;
use crate::dynamics::equilibrium::{Equilibrium, MeshEstimate, NoEquilibrium, Stability};
use crate::dynamics::error::Error;
use crate::dynamics::report::{
    Achieved, Counts, Indicator, PhaseReport, ReducedReport, Report, SensorErrorEstimate, SlipEvent,
};
use crate::dynamics::trajectory::{IntegrationFailure, Quantity, Trajectory};
use crate::integrators::sundials;

/// Name, unit and meaning of a key. Those of tables follow them, after a dot; `[]` is each one of a list.
pub(super) type ReportKey = (String, &'static str, &'static str);

/// A table of keys, each with its unit, its meaning and its value; from it come both the JSON object (`object`) and
/// the lines of the reference page (`keys`).
///
/// The value of a key with a table in parentheses is an option of what that table describes, in brackets an iterator
/// of them; a table in braces gives its own keys at that place.
macro_rules! table {
    ($(#[$meta:meta])* $name:ident($of:tt: $type:ty) { $($rest:tt)* }) => {
        $(#[$meta])*
        pub(crate) struct $name;

        impl $name {
            pub(crate) fn object($of: $type) -> Value {
                let mut object = Map::new();
                table!(@values object; $($rest)*);
                Value::Object(object)
            }

            pub(super) fn keys() -> Vec<ReportKey> {
                let mut keys: Vec<ReportKey> = Vec::new();
                table!(@keys keys; $($rest)*);
                keys
            }
        }
    };
    (@values $object:ident;) => {};
    (@values $object:ident; $key:literal, $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $object.insert($key.into(), json!($value));
        table!(@values $object; $($rest)*);
    };
    (@values $object:ident; $key:literal ($inner:ident), $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $object.insert($key.into(), json!($value.map($inner::object)));
        table!(@values $object; $($rest)*);
    };
    (@values $object:ident; $key:literal [$inner:ident], $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $object.insert($key.into(), $value.map($inner::object).collect());
        table!(@values $object; $($rest)*);
    };
    (@values $object:ident; {$inner:ident} => $value:expr; $($rest:tt)*) => {
        if let Value::Object(inner) = $inner::object($value) {
            $object.extend(inner);
        }
        table!(@values $object; $($rest)*);
    };
    (@keys $keys:ident;) => {};
    (@keys $keys:ident; $key:literal, $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $keys.extend([($key.into(), $unit, $meaning)]);
        table!(@keys $keys; $($rest)*);
    };
    (@keys $keys:ident; $key:literal ($inner:ident), $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $keys.extend([($key.into(), $unit, $meaning)]);
        $keys.extend(within(concat!($key, "."), $inner::keys()));
        table!(@keys $keys; $($rest)*);
    };
    (@keys $keys:ident; $key:literal [$inner:ident], $unit:literal, $meaning:literal => $value:expr; $($rest:tt)*) => {
        $keys.extend([($key.into(), $unit, $meaning)]);
        $keys.extend(within(concat!($key, "[]."), $inner::keys()));
        table!(@keys $keys; $($rest)*);
    };
    (@keys $keys:ident; {$inner:ident} => $value:expr; $($rest:tt)*) => {
        $keys.extend($inner::keys());
        table!(@keys $keys; $($rest)*);
    };
}

fn within(prefix: &str, keys: Vec<ReportKey>) -> impl Iterator<Item = ReportKey> {
    keys.into_iter().map(move |(key, unit, meaning)| (format!("{prefix}{key}"), unit, meaning))
}

table! {
    /// A run, with how it ended if it was not finished.
    OfRun((trajectory, end): (&Trajectory, Option<&IntegrationFailure>)) {
        "status", "", "`\"finished\"`, `\"failed\"` or `\"interrupted\"`" => match end {
            None => "finished",
            Some(end) if end.is_interruption() => "interrupted",
            Some(_) => "failed",
        };
        "title", "", "title of the scene; empty without one" => trajectory.report().title;
        "failure" (OfFailure), "", "what ended the run; `null` of one that was finished" => end;
        "method", "", "method, as `pliant methods` names it" => trajectory.report().method.name();
        "rtol", "1", "relative tolerance" => trajectory.report().rtol;
        "alpha", "1/s", "stabilization rate of constraints" => trajectory.report().alpha;
        "states", "", "unknowns of the integrator, in the last phase" => trajectory.report().states;
        "plane", "", "assumption across cells of two dimensions, such as `plane strain`; `null` without such cells"
            => trajectory.report().plane;
        {OfCounts} => &trajectory.report().counts();
        "wall_seconds", "s", "wall-clock time of the whole run" => trajectory.report().wall_seconds;
        "phases" [OfPhase], "", "the phases that were begun, in their order" => {
            let report = trajectory.report();
            report.phases.iter().map(move |phase| (report, phase))
        };
        "energy_balance_error", "J", "largest change of the energy balance" => trajectory.report().energy_error;
        "energy_created", "J", "largest rise of the energy balance" => trajectory.report().energy_created;
        "energy_scale", "J", "largest sum of the energies" => trajectory.report().energy_scale;
        "max_constraint_drift", "m", "largest error of a constraint at the end of a step"
            => trajectory.report().constraint_drift;
        "chosen", "", "what was chosen where the scene file says `auto`, and why" => trajectory.report().chosen;
        "achieved" (OfAchieved), "", "to what the motion is known; `null` without `--accuracy`"
            => trajectory.report().achieved.as_ref();
        "reduced" (OfReduced), "", "what a run by a reduced model tells; `null` of one with all unknowns"
            => trajectory.report().reduced.as_ref();
        {OfResult} => trajectory;
    }
}

table! {
    OfFailure(end: &IntegrationFailure) {
        "phase", "", "name of the phase" => end.phase;
        "time", "s", "time reached" => end.time;
        "step", "s", "size of the last step" => end.step;
        "cause", "", "the cause, in words" => end.cause();
    }
}

table! {
    OfCounts(counts: &Counts) {
        "steps", "", "steps taken" => counts.steps;
        "rhs_evaluations", "", "evaluations of the right-hand side or residual" => counts.evaluations;
        "jacobian_evaluations", "", "evaluations of the tangents, where they are not constant"
            => counts.jacobian_evaluations;
        "difference_evaluations", "",
            "evaluations of forces for tangents by finite differences, of those that do not give theirs"
            => counts.difference_evaluations;
        "factorizations", "", "factorizations of the Newton matrix" => counts.factorizations;
        "linear_iterations", "", "iterations in the place of factorizations, on large solids"
            => counts.linear_iterations;
        "pattern_changes", "", "symbolic factorizations after the first, where bodies that touch couple other nodes"
            => counts.pattern_changes;
        "error_test_failures", "", "steps repeated as their error was too large" => counts.error_test_failures;
        "convergence_failures", "", "Newton iterations that did not converge" => counts.convergence_failures;
    }
}

table! {
    OfPhase((report, phase): (&Report, &PhaseReport)) {
        "name", "", "name of the phase" => phase.name;
        "end", "s", "time reached" => phase.end;
        "ended_by", "", "the sensor that ended it before its time; `null` if none did" => phase.ended_by;
        "method", "", "method in the end" => phase.method.name();
        "reason", "", "why that method; `null` if it was asked for" => phase.reason;
        "rtol", "1", "as above, of this phase alone, as are all that follow" => report.rtol;
        "alpha", "1/s", "stabilization rate" => report.alpha;
        "states", "", "unknowns of the integrator" => phase.states;
        {OfCounts} => &phase.counts;
        "wall_seconds", "s", "wall-clock time" => phase.wall_seconds;
        "contact_events", "", "contact events that were located" => phase.counts.contact_events;
        "slips" [OfSlip], "",
            "when the body began to slide or to stick under friction, where contact events are located"
            => phase.slips.iter();
        "last_step", "s", "size of the last step" => phase.counts.last_step;
        "last_order", "", "order of the last step" => phase.counts.last_order;
    }
}

table! {
    OfSlip(slip: &SlipEvent) {
        "time", "s", "when" => slip.time;
        "obstacle", "", "name of the obstacle" => slip.obstacle;
        "slides", "", "whether it began to slide; `false`: to stick" => slip.slides;
    }
}

table! {
    OfAchieved(achieved: &Achieved) {
        "quantity", "", "what was compared" => achieved.quantity;
        "asked", "1", "the relative difference of two runs that was asked for at most" => achieved.asked;
        "difference", "1", "the one that was found" => achieved.difference;
        "scale", "its own", "what both are relative to: how much the quantity changes" => achieved.scale;
        "unit", "", "unit of the scale" => achieved.unit;
        "known_until", "s", "time until which the runs agree as was asked; the end if they do in all"
            => achieved.known_until;
        "runs", "", "runs in all" => achieved.runs;
        "rtol", "1", "relative tolerances of the last two" => achieved.rtol;
    }
}

table! {
    OfReduced(reduced: &ReducedReport) {
        "shapes", "", "shapes of the phase that has most" => reduced.shapes;
        "cells", "", "cells whose forces are computed, and all; the first is 0 where these are linear" => reduced.cells;
        "checked_error", "1", "largest error of a displacement in the runs that the model was checked with, relative to their largest one"
            => reduced.checked_error;
        "is_estimate", "", "whether that is what its own runs told, as it was checked with none of all unknowns" => reduced.is_estimate;
        "within", "1", "the error that was wanted of it" => reduced.within;
        "estimated_error", "1", "the error that this run estimates" => reduced.estimated_error;
        "readings" [OfSensorErrorEstimate], "", "estimates of the errors of sensors that follow from positions of nodes"
            => reduced.readings.iter();
        "outside", "1", "how far the motion was outside of those learned from, in parts of their range" => reduced.outside;
    }
}

table! {
    OfSensorErrorEstimate(told: &SensorErrorEstimate) {
        "name", "", "name of the sensor" => told.name;
        "unit", "", "its unit" => told.unit;
        "error", "its own", "the largest error" => told.error;
    }
}

table! {
    /// Entries common to the reports of runs and of equilibria.
    OfResult(trajectory: &Trajectory) {
        "sensors" [OfSensor], "", "the sensors, in the order of their columns in `trajectory.csv`"
            => trajectory.sensors().iter();
        "warnings", "", "what makes the result doubtful, in words" => trajectory.report().warnings();
        "indicators" [OfIndicator], "", "what was measured at the end, beyond its limits or not"
            => trajectory.report().indicators.iter();
        "versions" (OfVersions), "", "what computed it" => Some(());
    }
}

table! {
    OfSensor(sensor: &Quantity) {
        "name", "", "name of the column" => sensor.name;
        "unit", "", "its unit" => sensor.unit;
    }
}

table! {
    /// An indicator; what is not finite is `null`.
    OfIndicator(indicator: &Indicator) {
        "name", "", "what was measured" => indicator.name;
        "value", "its own", "the number" => indicator.value;
        "limits", "its own", "least and most that are in order; `null` where there is no limit"
            => indicator.limits;
        "unit", "", "unit of both" => indicator.unit;
        "verdict", "", "`\"fine\"`, `\"doubtful\"` (a warning) or `\"more-than-needed\"`"
            => indicator.verdict.name();
        "text", "", "all of it in words" => indicator.text;
    }
}

table! {
    OfVersions(_: ()) {
        "pliant", "", "version of `pliant`" => env!("CARGO_PKG_VERSION");
        "sundials", "", "version of the linked SUNDIALS" => sundials::version();
        "suitesparse", "", "version of the linked SuiteSparse (KLU)" => sundials::suitesparse_version();
    }
}

table! {
    /// An equilibrium, or how far the search for it came: what that does not know is `null`.
    OfStatics(found: Result<&Equilibrium, &NoEquilibrium>) {
        "status", "", "`\"finished\"` or `\"failed\"`" => if found.is_ok() { "finished" } else { "failed" };
        "failure" (OfLostEquilibrium), "", "why the search gave up; `null` if it did not" => found.err();
        "method", "", "`\"static\"`" => "static";
        "states", "", "displacement components" => motion_of(found).body().dofs();
        "plane", "", "assumption across cells of two dimensions, such as `plane strain`; `null` without such cells"
            => motion_of(found).body().planes();
        "stability" (OfStability), "", "what a small push does to the equilibrium"
            => found.ok().map(|found| &found.stability);
        "removed", "", "rigid motions, in words, that nothing holds and that were taken out of the displacements"
            => found.ok().map(|found| &found.removed);
        "residual", "N", "largest nodal force left unbalanced"
            => found.map_or_else(|lost| lost.residual, |found| found.residual);
        "force_scale", "N", "largest nodal force of those that balance each other"
            => found.ok().map(|found| found.force_scale);
        "iterations", "", "Newton iterations in all load steps"
            => found.map_or_else(|lost| lost.iterations, |found| found.iterations);
        "factorizations", "", "factorizations of the tangent" => found.ok().map(|found| found.factorizations);
        "load_steps", "", "load steps that converged" => found.ok().map(|found| found.load_steps);
        "failed_steps", "", "load steps that did not, and were made smaller"
            => found.ok().map(|found| found.failed_steps);
        "damped_steps", "", "load steps whose equilibrium was found by damped motion, as Newton's method failed"
            => found.ok().map(|found| found.damped_steps);
        "mesh_estimate" (OfMesh), "",
            "by how much a quantity is off because of the mesh; `null` without `--quantity`"
            => found.ok().and_then(|found| found.mesh_estimate.as_ref());
        "wall_seconds", "s", "wall-clock time of the search" => motion_of(found).report().wall_seconds;
        "max_constraint_drift", "m", "largest error of a constraint"
            => motion_of(found).samples().last().map(|sample| sample.constraint_drift);
        {OfResult} => motion_of(found);
    }
}

fn motion_of<'a>(found: Result<&'a Equilibrium, &'a NoEquilibrium>) -> &'a Trajectory {
    found.map_or_else(|lost| &lost.trajectory, Equilibrium::trajectory)
}

table! {
    OfLostEquilibrium(lost: &NoEquilibrium) {
        "phase", "", "name of the phase" => lost.phase;
        "fraction", "1", "part of the load for which an equilibrium was found" => lost.fraction;
        "tried", "1", "part for which none was found" => lost.tried;
        "cause", "", "the likely cause, and what to try" => lost.cause;
    }
}

table! {
    OfStability(stability: &Stability) {
        "kind", "", "`\"stable\"`, `\"neutral\"` or `\"unstable\"`" => match stability {
            Stability::Stable { .. } => "stable",
            Stability::Neutral => "neutral",
            Stability::Unstable { .. } => "unstable",
        };
        "frequency", "Hz", "lowest natural frequency; `null` if it is not stable or nothing can move"
            => if let Stability::Stable { frequency } = stability { Some(frequency) } else { None };
        "growth", "1/s", "rate at which a push grows; `null` if it is not unstable"
            => if let Stability::Unstable { growth } = stability { Some(growth) } else { None };
    }
}

table! {
    OfMesh(estimate: &MeshEstimate) {
        "quantity", "", "what was asked for" => estimate.quantity;
        "unit", "", "its unit" => estimate.unit;
        "value", "its own", "what it is on this mesh" => estimate.value;
        "change", "its own", "how much it has changed from the undeformed shape" => estimate.change;
        "correction", "its own", "estimate of what it would be on a richer mesh, less the value"
            => estimate.correction;
        "remainder", "its own",
            "leading remainder of the correction, which may be far off where that is larger than itself; \
             `null` if forces have no meaning there"
            => estimate.remainder;
        "relative", "1", "size of the correction as a part of the change; `null` without one"
            => estimate.relative();
        "unknowns", "", "displacement components on the richer mesh" => estimate.unknowns;
        "wall_seconds", "s", "wall-clock time of the estimate" => estimate.seconds;
    }
}

/// Writes how a run was computed, whether it was finished, gave up or was interrupted, as JSON, with the keys of
/// [`reference`](super::reference).
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
    write_json(path.as_ref(), &report(run))
}

/// Report of a run, as written by [`write_report`].
pub fn report(run: Result<&Trajectory, &IntegrationFailure>) -> Value {
    let trajectory = run.unwrap_or_else(|end| &end.trajectory);
    OfRun::object((trajectory, run.err()))
}

/// Writes the report of an equilibrium, or of a failed search for one, as JSON, with the keys of
/// [`reference`](super::reference). Entries unknown after a failed search are `null`.
///
/// # Errors
/// [`Error::Output`] if the file cannot be written.
pub fn write_static_report(
    found: Result<&Equilibrium, &NoEquilibrium>,
    path: impl AsRef<Path>,
) -> Result<(), Error> {
    write_json(path.as_ref(), &static_report(found))
}

/// Report of an equilibrium, as written by [`write_static_report`].
pub fn static_report(found: Result<&Equilibrium, &NoEquilibrium>) -> Value {
    OfStatics::object(found)
}

fn write_json(path: &Path, document: &Value) -> Result<(), Error> {
    write_file(path, |file| writeln!(file, "{document:#}"))
}
