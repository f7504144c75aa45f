//! The advice as data.

use std::path::Path;

use serde_json::{Value, json};

use super::advice::{Advice, Candidate};
use super::parts::Parts;
use super::smaller_model::SmallerModel;
use crate::dynamics::error::Error;
use crate::io::output::write_file;
use crate::studies::work_precision::look::Look;

impl Advice {
    /// Writes all that was found as JSON.
    ///
    /// The keys are `quantity`, `accuracy`, `scale`, `unit`, `written`, `enough`, `truth`, `resolution`, `has_rate`,
    /// `mesh`, `alphas`, `law`, `inertia`, `terms`, `together`, `candidates`, `known_until`, `end`, `mesh_estimate`,
    /// `smaller`, `set`, `reduced`, `look`, `not_tried`, `is_cut_short`, `runs`, `seconds`, `known`, as the fields are; `null` means not
    /// known. A candidate has `model` and `set`, the settings for it in the file of the scene; the key `set` is that
    /// of the sufficient model, by the half or section with which it remains sufficient.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let document = self.to_json();
        write_file(path.as_ref(), |file| writeln!(file, "{document:#}"))
    }

    /// JSON record, as written by [`write_json`](Self::write_json).
    pub fn to_json(&self) -> Value {
        let candidate = |candidate: &Candidate| -> Value {
            let Candidate { choice, set, error, parts, seconds, unknowns, failure, warnings } =
                candidate;
            json!({
                "model": choice.to_string(),
                "set": set,
                "error": error,
                "parts": parts.map(|Parts { model, mesh, time }| {
                    json!({ "model": model, "mesh": mesh, "time": time })
                }),
                "seconds": seconds,
                "unknowns": unknowns,
                "failure": failure,
                "warnings": warnings,
            })
        };
        let terms = self.terms.iter();
        let terms =
            terms.map(|(term, error)| json!({ "without": term.to_string(), "error": error }));
        json!({
            "quantity": self.quantity,
            "accuracy": self.accuracy,
            "scale": self.scale,
            "unit": self.unit,
            "written": candidate(&self.written),
            "enough": self.enough.as_ref().map(candidate),
            "truth": self.truth.as_ref().map(candidate),
            "resolution": self.resolution,
            "has_rate": self.has_rate,
            "mesh": self.mesh,
            "alphas": self.alphas.iter().map(|(alpha, change)| {
                json!({ "alpha": alpha, "ten_times_as_much_changes": change })
            }).collect::<Vec<_>>(),
            "law": self.law,
            "inertia": self.inertia,
            "terms": terms.collect::<Vec<_>>(),
            "together": self.together,
            "candidates": self.candidates.iter().map(candidate).collect::<Vec<_>>(),
            "known_until": self.known_until,
            "end": self.end,
            "mesh_estimate": self.mesh_estimate.as_ref().map(|estimate| {
                json!({ "value": estimate.value, "change": estimate.change, "correction": estimate.correction, "is_reliable": estimate.is_reliable() })
            }),
            "smaller": self.smaller.iter().map(SmallerModel::to_json).collect::<Vec<_>>(),
            "set": self.set(),
            "reduced": self.reduced.as_ref().map(|reduced| {
                json!({
                    "unknowns": reduced.unknowns,
                    "cells": reduced.cells[0],
                    "change": reduced.change,
                    "seconds": reduced.seconds,
                    "training_seconds": reduced.training_seconds,
                    "pays_from": reduced.pays_from(),
                })
            }),
            "look": self.look.as_ref().map(Look::to_json),
            "not_tried": self.not_tried,
            "is_cut_short": self.is_cut_short,
            "runs": self.runs,
            "seconds": self.seconds,
            "known": self.known,
        })
    }

    /// Writes a row for each candidate as CSV: `model`, `error` (relative), `seconds`, `unknowns`, `failure`.
    ///
    /// # Errors
    /// [`Error::Output`] if it cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_file(path.as_ref(), |file| {
            let mut table = csv::Writer::from_writer(file);
            table.write_record(["model", "error", "seconds", "unknowns", "failure"])?;
            for Candidate { choice, error, seconds, unknowns, failure, .. } in &self.candidates {
                table.write_record([
                    choice.to_string(),
                    error.map(|error| format!("{error:e}")).unwrap_or_default(),
                    format!("{seconds:e}"),
                    unknowns.to_string(),
                    failure.clone().unwrap_or_default(),
                ])?;
            }
            table.flush()
        })
    }
}
