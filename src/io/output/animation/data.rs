//! The data of a motion as JSON, for the page.

use std::collections::BTreeMap;
use std::ptr;

use serde_json::{Value, json};

use super::colours::{Fields, Quantity};
use super::geometry::{Geometry, in_view};
use super::{acting, contacts, pack};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::system::Energy;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::mesh::Mesh;
use crate::io::output::acting::Remanence;
use crate::io::output::role::Role;
use crate::io::output::svg::{View, displaced, positions};
use crate::scene::forces::{LinePoint, Obstacle, Shape, ShapeKind, corners};
use crate::scene::timeline::{Phase, Scene};

/// Most samples that a page holds, the bytes that they may take together before encoding, and the number of
/// samples that is always kept.
const MOST_FRAMES: usize = 800;
const MOST_BYTES: usize = 1_400_000;
const FEW_FRAMES: usize = 60;
/// Largest deviation of the drawn path of an obstacle from its formula, relative to the size of the body.
const FOLLOWED: f64 = 1e-3;

/// Everything that the page shows of a motion.
pub(super) fn gather(trajectory: &Trajectory, name: &str) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let (body, mesh) = (scene.body(), scene.body().mesh());
    let points = point_masses(mesh);
    let lines = scene.actuator_lines()?;
    let geometry = Geometry::new(body, lines.iter().flat_map(|(_, line)| line), &points);
    let remanence = Remanence::of(scene)?;
    let bytes = bytes_per_frame(trajectory, &geometry, &remanence);
    let frames = thinned(trajectory.samples(), bytes);
    let view = (mesh.dimension() < 3).then(|| View::of(trajectory, &frames).corners());
    Ok(json!({
        "name": name,
        "run": run(trajectory),
        "report": trajectory.report().to_string(),
        "warnings": trajectory.report().warnings(),
        "view": view,
        "times": frames.iter().map(|sample| sample.time).collect::<Vec<_>>(),
        "phases": phases_in_force(trajectory, &frames, &geometry)?,
        "body": geometry.to_json(),
        "motion": motion(trajectory, &frames, &geometry),
        "quantities": quantities(trajectory, &frames, &geometry)?,
        "energies": energies(&frames),
        "sensors": sensors(trajectory, &frames),
        "contacts": contacts::resultants(trajectory, &frames)?,
        "needles": super::lines::needles(trajectory, &frames)?,
        "everywhere": acting::everywhere(trajectory, &frames)?,
        "remanence": acting::arrows(trajectory, &frames, &remanence),
        "lines": super::lines::tracks(trajectory, &frames)?,
        "obstacles": obstacles_in(trajectory, &frames)?,
        "springs": actuators(trajectory, &frames, &geometry, &lines)?,
        "points": geometry.places(&points),
    }))
}

/// As many of the samples as a page can hold, evenly spaced by their numbers.
fn thinned(samples: &[Sample], bytes_per_frame: usize) -> Vec<&Sample> {
    let most = (MOST_BYTES / bytes_per_frame).clamp(FEW_FRAMES, MOST_FRAMES);
    let frames = most.min(samples.len());
    let last = samples.len().saturating_sub(1);
    (0..frames).map(|k| &samples[k * last / (frames - 1).max(1)]).collect()
}

fn bytes_per_frame(trajectory: &Trajectory, geometry: &Geometry, remanence: &Remanence) -> usize {
    let axes = trajectory.body().dimension().max(2);
    let sensors = trajectory.sensors().len();
    // a place and a force, a moment or an arrow of each
    let scene = trajectory.scene();
    let start = trajectory.samples().first();
    let needles = start.and_then(|sample| {
        let phase = trajectory.phase_of(sample).ok()?;
        Some(scene.device_needles(phase, sample.time, [&sample.u, &sample.v]).len())
    });
    let needles = needles.unwrap_or(0);
    let contacts = 2 * axes * (scene.obstacles().len() + needles + remanence.count());
    let singles = size_of::<f32>() * (sensors + contacts);
    let quantities = Quantity::of(trajectory.scene()).len();
    2 * axes * geometry.count() + quantities * geometry.cells.len() + singles
}

/// Positions of the drawn nodes and anchors, sample by sample.
fn motion(trajectory: &Trajectory, frames: &[&Sample], geometry: &Geometry) -> Value {
    let axes = trajectory.body().dimension().max(2);
    let mut points = Vec::with_capacity(frames.len() * geometry.count() * axes);
    for sample in frames {
        let all = match axes {
            2 => positions(trajectory, sample).concat(),
            _ => displaced(trajectory, sample),
        };
        points.extend(geometry.nodes.iter().flat_map(|node| &all[node * axes..][..axes]));
        points.extend(geometry.anchors(trajectory.body().dimension(), &sample.u));
    }
    pack::points(&points, axes)
}

/// The values of each quantity in each face, sample by sample.
fn quantities(
    trajectory: &Trajectory,
    frames: &[&Sample],
    geometry: &Geometry,
) -> Result<Value, Error> {
    let (scene, body) = (trajectory.scene(), trajectory.body());
    let quantities = Quantity::of(scene);
    let mut values =
        vec![Vec::with_capacity(frames.len() * geometry.cells.len()); quantities.len()];
    for sample in frames {
        let contacts = match Quantity::has_contact(scene) {
            true => trajectory.nodal_contacts(sample)?,
            false => Vec::new(),
        };
        let fields = Fields { body, cells: trajectory.cell_fields(sample)?, contacts };
        for (quantity, values) in quantities.iter().zip(&mut values) {
            values.extend(quantity.values(&fields, geometry));
        }
    }
    let packed = quantities.iter().zip(values).map(|(quantity, values)| {
        let (values, scale, peak) = quantity.packed(&values);
        let mut told = quantity.to_json();
        (told["scale"], told["peak"], told["values"]) = (scale.into(), peak.into(), values);
        told
    });
    Ok(packed.collect())
}

/// Names and ends of the phases, and the drawn nodes that they hold and move.
pub(super) fn phases(scene: &Scene, geometry: &Geometry) -> Result<Value, Error> {
    let phases = scene.phases().iter();
    phases.map(|phase| self::phase(scene, phase, phase.end(), geometry)).collect()
}

/// As [`phases`], but cut into stretches that hold and move the same nodes where commands have changed the
/// phases, or where frames begin in a later phase, as those of its equilibrium do.
fn phases_in_force(
    trajectory: &Trajectory,
    frames: &[&Sample],
    geometry: &Geometry,
) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let begins = frames.first().is_none_or(|sample| sample.phase == 0);
    if begins && frames.iter().all(|sample| sample.commanded.0.is_none()) {
        return phases(scene, geometry);
    }
    let mut stretches: Vec<Value> = Vec::new();
    for sample in frames {
        let next = phase(scene, trajectory.phase_of(sample)?, sample.time, geometry)?;
        let same =
            |last: &&mut Value| ["name", "held", "moved"].iter().all(|&key| last[key] == next[key]);
        match stretches.last_mut().filter(same) {
            Some(last) => last["end"] = sample.time.into(),
            None => stretches.push(next),
        }
    }
    Ok(stretches.into())
}

/// A phase up to time `end` (s).
fn phase(scene: &Scene, phase: &Phase, end: f64, geometry: &Geometry) -> Result<Value, Error> {
    // a node that is held along one axis and moved along another counts as moved
    let roles: BTreeMap<usize, Role> = {
        let mut roles = scene.constrained_nodes(phase)?;
        roles.sort_by_key(|&(_, role)| role);
        roles.into_iter().collect()
    };
    let with = |wanted: Role| {
        let nodes = roles.iter().filter(|&(_, &role)| role == wanted).map(|(&node, _)| node);
        geometry.places(&nodes.collect::<Vec<_>>())
    };
    Ok(json!({
        "name": phase.name(),
        "end": end,
        "held": with(Role::Held),
        "moved": with(Role::Moved),
    }))
}

/// The names of the energies.
pub(super) const ENERGIES: [&str; 8] =
    ["kinetic", "strain", "gravity", "contact", "springs", "dissipated", "supplied", "balance"];

/// Their values (J), in the same order.
pub(super) fn energy_values(energy: &Energy) -> [f64; 8] {
    let &Energy { kinetic, strain, gravity, contact, springs, dissipated, supplied } = energy;
    [kinetic, strain, gravity, contact, springs, dissipated, supplied, energy.balance()]
}

fn energies(frames: &[&Sample]) -> Value {
    let values: Vec<_> = frames.iter().map(|sample| energy_values(&sample.energy)).collect();
    let packed = ENERGIES.iter().enumerate().map(|(number, name)| {
        let values = pack::singles(values.iter().map(|values| values[number]));
        json!({ "name": name, "values": values })
    });
    packed.collect()
}

/// Sensor readings; NaN stays NaN.
fn sensors(trajectory: &Trajectory, frames: &[&Sample]) -> Value {
    let sensors = trajectory.sensors().iter().enumerate();
    let packed = sensors.map(|(number, sensor)| {
        let values = pack::singles(frames.iter().map(|sample| sample.sensors[number]));
        json!({ "name": sensor.name, "unit": sensor.unit, "values": values })
    });
    packed.collect()
}

/// Shapes of the obstacles, unions part by part, and how they move.
#[cfg(feature = "play")]
pub(super) fn obstacles(scene: &Scene) -> Value {
    let mut shapes = Vec::new();
    for obstacle in scene.obstacles() {
        let courses = json!([course(scene, obstacle, 0.0)]);
        add_shape(obstacle.shape(), &courses, &mut shapes);
    }
    shapes.into()
}

/// As [`obstacles`], also where commands have changed how they move.
fn obstacles_in(trajectory: &Trajectory, frames: &[&Sample]) -> Result<Value, Error> {
    let (scene, mut shapes) = (trajectory.scene(), Vec::new());
    for obstacle in scene.obstacles() {
        let mut courses: Vec<Value> = Vec::new();
        let mut last = None;
        for sample in frames {
            let moving = trajectory.phase_of(sample)?.moving(obstacle);
            if last.replace(moving).is_some_and(|last| ptr::eq(last, moving)) {
                continue;
            }
            let next = course(scene, moving, sample.time);
            if courses.last().is_none_or(|last| {
                ["start", "velocity", "path"].iter().any(|key| last[key] != next[key])
            }) {
                courses.push(next);
            }
        }
        add_shape(obstacle.shape(), &courses.into(), &mut shapes);
    }
    Ok(shapes.into())
}

/// How an obstacle moves from time `since` (s) on: `start`, its offset at t = 0 from its place in the scene,
/// and its velocity; or its path, on top of `start`: cubics between points with given velocities.
fn course(scene: &Scene, obstacle: &Obstacle, since: f64) -> Value {
    let dimension = scene.body().dimension();
    let [start, velocity] =
        [obstacle.offset(), obstacle.velocity_at(0.0)].map(|x| in_view(&x[..dimension]));
    let mut course = json!({ "since": since, "start": start, "velocity": velocity });
    let times = obstacle.knots(scene.end(), FOLLOWED * scene.body().size());
    if !times.is_empty() {
        let points = |at: &dyn Fn(f64) -> [f64; 3]| -> Vec<_> {
            times.iter().map(|&t| in_view(&at(t)[..dimension])).collect()
        };
        let (displacements, velocities) =
            (points(&|t| obstacle.travelled(t)), points(&|t| obstacle.velocity_at(t)));
        course["path"] =
            json!({ "times": times, "displacements": displacements, "velocities": velocities });
    }
    course
}

fn add_shape(shape: &Shape, courses: &Value, shapes: &mut Vec<Value>) {
    let mut add = |kind: &str, mut shape: Value| {
        shape["kind"] = kind.into();
        shape["courses"] = courses.clone();
        shapes.push(shape);
    };
    match shape.kind() {
        ShapeKind::HalfPlane { point, normal } => {
            let shape = json!({ "point": in_view(point), "normal": in_view(normal) });
            add("half-plane", shape);
        }
        ShapeKind::Ball { centre, radius, cavity } => {
            let kind = if *cavity { "cavity" } else { "disc" };
            add(kind, json!({ "centre": in_view(centre), "radius": radius }));
        }
        ShapeKind::Box { min, max, turned: None } => {
            add("box", json!({ "min": in_view(min), "max": in_view(max) }));
        }
        ShapeKind::Box { min, max, turned } => {
            let corners = corners(min, max, turned.as_ref());
            // the box around it, for the choice of the part of space that is shown
            let around = |choose: fn(f64, f64) -> f64| -> Vec<f64> {
                let along = |axis: usize| corners.iter().map(move |corner| corner[axis]);
                (0..min.len()).filter_map(|axis| along(axis).reduce(choose)).collect()
            };
            let (min, max) = (around(f64::min), around(f64::max));
            let corners: Vec<_> = corners.iter().map(|corner| in_view(corner)).collect();
            let shape = json!({ "min": in_view(&min), "max": in_view(&max), "corners": corners });
            add("box", shape);
        }
        ShapeKind::Capsule { from, to, radius } => {
            let (from, to) = (in_view(from), in_view(to));
            add("capsule", json!({ "from": from, "to": to, "radius": radius }));
        }
        ShapeKind::Union(parts) => {
            parts.iter().for_each(|part| add_shape(part, courses, shapes));
        }
        // a user's own function has no outline
        ShapeKind::Custom(_) => {}
    }
}

/// Names and lines of the actuators that have these, and their drives at each sample.
fn actuators(
    trajectory: &Trajectory,
    frames: &[&Sample],
    geometry: &Geometry,
    lines: &[(usize, Vec<LinePoint>)],
) -> Result<Value, Error> {
    let scene = trajectory.scene();
    let packed = lines.iter().map(|line| {
        let own = &*scene.actuators()[line.0];
        let drive = |sample: &&Sample| {
            let phase = trajectory.phase_of(sample)?;
            Ok(scene.drive_at(own, phase, sample.time, &sample.amounts)[0])
        };
        let drives = frames.iter().map(drive).collect::<Result<Vec<f64>, InputError>>()?;
        let mut packed = line_to_json(scene, line, geometry);
        packed["forces"] = pack::singles(drives);
        Ok(packed)
    });
    packed.collect()
}

/// The name and the line of an actuator.
pub(super) fn line_to_json(
    scene: &Scene,
    (number, line): &(usize, Vec<LinePoint>),
    geometry: &Geometry,
) -> Value {
    let own = &scene.actuators()[*number];
    let is_cable = own.kind().name == "cable";
    json!({ "name": own.name(), "ends": geometry.ends(line), "isCable": is_cable })
}

/// The nodes that belong to no cell.
pub(super) fn point_masses(mesh: &Mesh) -> Vec<usize> {
    let mut in_cell = vec![false; mesh.node_count()];
    mesh.cells().flatten().for_each(|&node| in_cell[node] = true);
    (0..mesh.node_count()).filter(|&node| !in_cell[node]).collect()
}

/// Report of the computation.
fn run(trajectory: &Trajectory) -> Value {
    let (report, mesh) = (trajectory.report(), trajectory.body().mesh());
    json!({
        "nodes": mesh.node_count(),
        "cells": mesh.cell_count(),
        "cellName": trajectory.body().cell_names(),
        "method": report.method.to_string(),
        "rtol": format!("{:e}", report.rtol),
        "steps": report.steps(),
        "factorizations": report.factorizations(),
        "seconds": report.wall_seconds,
        "energyError": report.energy_error,
        "energyScale": report.energy_scale,
        "samples": trajectory.samples().len(),
    })
}
