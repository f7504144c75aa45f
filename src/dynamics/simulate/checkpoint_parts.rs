//! Checkpoints as plain data: taken apart, and adopted by a simulation of the same scene in another process.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::auto::Plan;
use super::checkpoint::{Checkpoint, Kept, Record};
use super::records;
use super::simulation::Simulation;
use crate::base::input::{InputError, not_negative, positive};
use crate::dynamics::error::Error;
use crate::scene::settings::{Method, Settings};
use crate::scene::timeline::Scene;

/// Choice of [`Method::Auto`] for the phase in force. In files an unbounded step is `null`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Choice {
    #[serde(serialize_with = "name", deserialize_with = "of_name")]
    pub(crate) method: Method,
    pub(crate) max_order: Option<u32>,
    /// Part of the requested tolerances that the method is given.
    #[serde(rename = "tolerance_part")]
    pub(crate) part: f64,
    pub(crate) reason: String,
    /// Longest stable steps of explicit Runge-Kutta and of central differences (s), steps after which the
    /// implicit method is tried again, and the mean of its last steps (s): see [`Plan`].
    #[serde(serialize_with = "bounded", deserialize_with = "or_unbounded")]
    pub(crate) explicit_step: f64,
    #[serde(serialize_with = "bounded", deserialize_with = "or_unbounded")]
    pub(crate) central_step: f64,
    pub(crate) patience: usize,
    #[serde(default)]
    pub(crate) implicit_step: f64,
    /// Steps (s) below which another method is tried, after how many of them: see [`Plan`].
    #[serde(default)]
    pub(crate) expected_step: f64,
    #[serde(default)]
    pub(crate) patience_of_probes: usize,
    /// Trials so far, and whether bodies may touch.
    #[serde(default)]
    pub(crate) trials: usize,
    #[serde(default)]
    pub(crate) touches: bool,
}

fn name<S: Serializer>(method: &Method, to: S) -> Result<S::Ok, S::Error> {
    method.name().serialize(to)
}

fn of_name<'de, D: Deserializer<'de>>(from: D) -> Result<Method, D::Error> {
    String::deserialize(from)?.parse().map_err(de::Error::custom)
}

fn bounded<S: Serializer>(step: &f64, to: S) -> Result<S::Ok, S::Error> {
    Some(*step).filter(|step| step.is_finite()).serialize(to)
}

fn or_unbounded<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

impl Checkpoint {
    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(crate) fn kept(&self) -> &Kept {
        &self.kept
    }

    /// The method, if it was chosen.
    pub(crate) fn choice(&self) -> Option<Choice> {
        let Plan {
            settings,
            part,
            reason,
            explicit_step,
            central_step,
            patience,
            implicit_step,
            expected_step,
            patience_of_probes,
            trials,
            touches,
            ..
        } = self.plan.settled();
        Some(Choice {
            method: settings.method,
            max_order: settings.max_order,
            part: *part,
            reason: reason.clone()?,
            explicit_step: *explicit_step,
            central_step: *central_step,
            patience: *patience,
            implicit_step: *implicit_step,
            expected_step: *expected_step,
            patience_of_probes: *patience_of_probes,
            trials: *trials,
            touches: *touches,
        })
    }
}

impl Choice {
    /// The plan of this choice, under the settings `asked`.
    fn plan(self, asked: &Settings) -> Result<Plan, InputError> {
        let Self {
            method,
            max_order,
            part,
            reason,
            explicit_step,
            central_step,
            patience,
            implicit_step,
            expected_step,
            patience_of_probes,
            trials,
            touches,
        } = self;
        if method == Method::Auto {
            return Err(InputError::new("chosen method", method, "it must be one of the others"));
        }
        positive("part of the tolerances", part, "")?;
        let settings = Settings { method, max_order, ..asked.tightened(part) };
        // this flag is for BDF alone, which may have been chosen before
        Settings { stability_limit_detection: false, ..settings.clone() }.validate()?;
        for step in [explicit_step, central_step].into_iter().filter(|step| step.is_finite()) {
            not_negative("longest stable step", step, "s")?;
        }
        not_negative("mean step of the implicit method", implicit_step, "s")?;
        not_negative("step below which another method is tried", expected_step, "s")?;
        let reason = Some(reason);
        let asked = asked.clone();
        Ok(Plan {
            settings,
            asked,
            part,
            reason,
            explicit_step,
            central_step,
            patience,
            implicit_step,
            expected_step,
            patience_of_probes,
            trials,
            probe: None,
            touches,
            failed: (f64::NAN, 0),
        })
    }
}

impl Simulation {
    /// A checkpoint of this simulation from the data of one of another simulation of the same scene: the
    /// state `kept`, and the `choice` of method, which is used if this simulation leaves the method open,
    /// too.
    ///
    /// # Errors
    /// Commands and states that do not fit the scene.
    pub(crate) fn adopt(&self, kept: Kept, choice: Option<Choice>) -> Result<Checkpoint, Error> {
        let run = &self.run;
        let Kept { number, time, ref state, .. } = kept;
        let mut system = kept.equations(run)?;
        if ![0, system.full().rows().len()].contains(&kept.origins.len()) {
            let help = format!("the phase has {} rows of constraints", system.full().rows().len());
            return Err(InputError::new("number of origins", kept.origins.len(), help).into());
        }
        let reason = match records::sample(number, &mut *system, time, state, false) {
            Ok(sample) if sample.energy.balance().is_finite() => None,
            Ok(_) => Some("the energies are beyond the range of double precision".into()),
            Err(failure) => Some(failure.into_error().to_string()),
        };
        if let Some(reason) = reason {
            return Err(InputError::new("state", format!("at {time} s"), reason).into());
        }
        let asked = &run.settings;
        let plan = match choice.filter(|_| asked.method == Method::Auto) {
            Some(choice) => choice.plan(asked)?,
            None => Plan::new(asked, &mut *system, time, state),
        };
        let longest = asked.max_step.unwrap_or(f64::INFINITY);
        let kept = Kept { first_step: kept.first_step.map(|step| step.min(longest)), ..kept };
        let (scene, record) = (run.scene.clone(), Record::without_past(run));
        Ok(Checkpoint { scene, constraints: Arc::new(()), plan, record, kept })
    }
}
