//! Frames: data that the page shows at one time.

use serde_json::{Value, json};

use super::hand::Hand;
use super::pace::Pace;
use super::past::Past;
use super::slider::Slider;
use crate::dynamics::simulate::Simulation;
use crate::io::output::Picture;
use crate::scene::timeline::Scene;

/// Inputs of a frame.
pub(super) struct Present<'a> {
    pub(super) simulation: &'a Simulation,
    pub(super) picture: &'a Picture,
    pub(super) sliders: &'a [Slider],
    pub(super) hand: Option<&'a Hand>,
    pub(super) pace: &'a Pace,
    pub(super) past: &'a Past,
    pub(super) playing: bool,
    pub(super) trouble: Option<&'a str>,
}

/// The frame of the present, with the colours of a quantity and the past after the time `since` (s).
pub(super) fn of(present: &Present, colours: Option<usize>, since: Option<f64>) -> Value {
    let &Present { simulation, picture, sliders, hand, pace, past, playing, trouble } = present;
    let view = simulation.view();
    // while it plays nothing waits for the error estimate of a reduced model
    let report = if playing { simulation.settled_report() } else { simulation.report() };
    let (body, u) = (view.body(), view.displacements());
    let values = sliders.iter().map(|slider| slider.value(simulation));
    // the forces along all lines are shown, also of those without a slider
    let actuations = picture.drives(&view);
    let phase = report.phases.last();
    let counts = phase.map(|phase| &phase.counts);
    let method = phase.map_or(report.method, |phase| phase.method);
    let at_end = simulation.time() >= simulation.scene().end();
    json!({
        "time": simulation.time(),
        "phase": simulation.phase_number(),
        "playing": playing,
        "atEnd": at_end,
        "trouble": trouble,
        "places": picture.places(body.mesh(), u),
        "colours": colours.and_then(|quantity| picture.colours(&view, quantity)),
        "past": past.after(since),
        "sliders": values.collect::<Vec<_>>(),
        "needles": picture.needles(&view),
        "everywhere": Picture::everywhere(&view),
        "remanence": picture.remanence(&view),
        "lines": picture.lines(&view),
        "actuations": actuations,
        "pull": hand.map(Hand::to_json),
        "speed": pace.speed,
        "factor": pace.factor(),
        "method": method.to_string(),
        "order": counts.map(|counts| counts.last_order),
        "step": counts.map(|counts| counts.last_step),
        "steps": report.steps(),
        "evaluations": report.evaluations(),
        "factorizations": report.factorizations(),
        "reduced": report.reduced.as_ref().map(ToString::to_string),
        "warnings": report.warnings(),
    })
}

/// Numbers of nodes and cells, and the cell type.
pub(super) fn mesh(scene: &Scene) -> Value {
    let mesh = scene.body().mesh();
    json!({
        "nodes": mesh.node_count(),
        "cells": mesh.cell_count(),
        "cellName": scene.body().cell_names(),
    })
}
