//! The states of a run at the ends of its steps, kept to take the steps back.

use super::angles::Angles;
use super::simulation::Simulation;
use super::step_list::StepList;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::settings::{Method, Settings};

/// The steps of a run, and the states that they lead to.
#[derive(Debug)]
pub(crate) struct Tape {
    pub(super) settings: Settings,
    pub(super) steps: Vec<TapedStep>,
    /// The state at the start and after each step.
    pub(super) states: Vec<Vec<f64>>,
    /// The angles of sensors at the end.
    pub(super) angles: Angles,
    /// Reason for which the adjoint is not available, if it is known.
    pub(super) refused: Option<String>,
}

/// Position of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct TapedStep {
    /// Number of the phase, and of its interval.
    pub(super) phase: usize,
    pub(super) interval: usize,
    /// Its start and its end, as fractions of the interval.
    pub(super) fractions: [f64; 2],
}

/// Bytes of states that are kept at most.
const BUDGET: usize = 2 << 30;

impl Simulation {
    /// As [`finish_with_steps`](Self::finish_with_steps), with all that taking the steps back needs: the state after each step.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn finish_with_tape(self) -> Result<(Trajectory, StepList, Tape), Error> {
        let mut tape = Tape {
            settings: self.run.settings.clone(),
            steps: Vec::new(),
            states: vec![self.run.state.clone()],
            angles: Angles::default(),
            refused: self.why_not_taken_back(),
        };
        let most = BUDGET / (size_of::<f64>() * self.run.state.len().max(1));
        let (trajectory, list) = self.finish_noting(&mut |run, fractions| {
            if tape.steps.len() == most {
                let help = "more than 2 GiB of states would have to be kept";
                tape.refused.get_or_insert_with(|| help.into());
            }
            tape.angles.0.clone_from(&run.angles.0);
            if tape.refused.is_some() {
                return;
            }
            let stops = run.scene.stops(run.number);
            let stop = run.phase_run.interval.stop;
            match stops.iter().position(|end| *end == stop) {
                Some(interval) => {
                    tape.steps.push(TapedStep { phase: run.number, interval, fractions });
                    tape.states.push(run.state.clone());
                }
                None => tape.refused = Some("an interval ends at a time of the motion".into()),
            }
        })?;
        Ok((trajectory, list, tape))
    }

    /// The reason for which the adjoint of the run is not available, as far as it is known at its start.
    fn why_not_taken_back(&self) -> Option<String> {
        let Self { run, .. } = self;
        let phases = run.scene.phases();
        let projects = phases.iter().skip(1).find(|phase| phase.projects_velocity);
        if run.settings.method != Method::Rosenbrock {
            Some(format!("adjoint gradients do not support {}", run.settings.method))
        } else if run.reduced.is_some() {
            Some("adjoint gradients do not yet support reduced models".into())
        } else {
            projects
                .map(|phase| format!("phase \"{}\" changes velocities at its start", phase.name()))
        }
    }
}
