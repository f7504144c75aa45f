//! `[solver]` and `[output]`.

use super::selection::selection;
use super::value::Value;
use super::{Format, OutputRequest};
use crate::error::Error;
use crate::input::positive;
use crate::mesh::Mesh;
use crate::settings::{ContactEvents, Method, Settings};

const SOLVER: &[&str] = &[
    "method",
    "rtol",
    "atol_position",
    "atol_velocity",
    "alpha",
    "max_order",
    "stability_limit_detection",
    "contact_events",
    "max_step",
    "max_steps",
];

pub(super) fn solver(value: &Value) -> Result<Settings, Error> {
    let table = value.table(SOLVER)?;
    let default = Settings::default();
    let method = table.optional("method", "the integration method", |value| {
        value.word(&Method::ALL.map(|method| (method.name(), method)))
    })?;
    let rtol = table.optional("rtol", "the relative tolerance (no unit)", Value::number)?;
    let alpha = table.optional("alpha", "the rate of stabilization (1/s)", Value::number)?;
    let position = "the absolute tolerance of displacements (m)";
    let velocity = "the absolute tolerance of velocities (m/s)";
    let max_order = table.optional("max_order", "the highest order", Value::count)?;
    let detection = "whether unstable orders are looked out for";
    let detection = table.optional("stability_limit_detection", detection, Value::flag)?;
    let max_steps = table.optional("max_steps", "the most steps of a phase", Value::count)?;
    let events = table.optional("contact_events", "how contact events are met", |value| {
        value.word(&ContactEvents::ALL.map(|way| (way.name(), way)))
    })?;
    let solver = Settings {
        method: method.unwrap_or(default.method),
        rtol: rtol.unwrap_or(default.rtol),
        atol_position: table.optional("atol_position", position, Value::number)?,
        atol_velocity: table.optional("atol_velocity", velocity, Value::number)?,
        alpha: alpha.unwrap_or(default.alpha),
        max_order: max_order.map(|order| u32::try_from(order).unwrap_or(u32::MAX)),
        stability_limit_detection: detection.unwrap_or(default.stability_limit_detection),
        contact_events: events.unwrap_or(default.contact_events),
        max_step: table.optional("max_step", "the longest step (s)", Value::number)?,
        max_steps: max_steps.unwrap_or(default.max_steps),
    };
    solver.validate().map_err(|error| table.blame(error))?;
    Ok(solver)
}

pub(super) fn output(value: &Value, mesh: &Mesh) -> Result<OutputRequest, Error> {
    let table = value.table(&["step", "track", "formats"])?;
    let step = table.optional("step", "the time between samples (s)", Value::number)?;
    if let Some(step) = step {
        positive("step", step, "s").map_err(|error| table.blame(error))?;
    }
    let meaning = "nodes whose motion is written";
    let track = table.optional("track", meaning, |value| selection(value, mesh))?;
    let formats = table.optional("formats", "what is written", |value| {
        let known = Format::ALL.map(|format| (format.name(), format));
        value.one_or_more()?.iter().map(|format| format.word(&known)).collect()
    })?;
    Ok(OutputRequest { step, track, formats: formats.unwrap_or_else(|| vec![Format::Csv]) })
}
