//! States of a simulation to return to.

use std::fmt;
use std::sync::Arc;

use super::angles::Angles;
use super::auto::Plan;
use super::run::Run;
use crate::base::input::InputError;
use crate::dynamics::phase::Integrable;
use crate::dynamics::report::{Counts, PhaseReport, Report};
use crate::dynamics::trajectory::{Leap, Penetration, Trajectory};
use crate::scene::constraint::PhaseStart;
use crate::scene::timeline::{Phase, Scene};

/// A state of a [`Simulation`](super::Simulation) to return to: see
/// [`checkpoint`](super::Simulation::checkpoint).
#[derive(Clone)]
pub struct Checkpoint {
    pub(super) scene: Arc<Scene>,
    /// Identity of the constraints in force.
    pub(super) constraints: Arc<()>,
    pub(super) plan: Plan,
    pub(super) record: Record,
    pub(super) kept: Kept,
}

/// Report of the computation up to a checkpoint.
#[derive(Clone)]
pub(super) struct Record {
    /// On the phases before, and on the one in force.
    pub(super) report: Report,
    pub(super) phase: PhaseReport,
    pub(super) penetrations: Vec<Penetration>,
    pub(super) leaps: Vec<Leap>,
}

impl Record {
    /// The record of `run`.
    pub(super) fn of(run: &Run) -> Self {
        let Trajectory { report, penetrations, leaps, .. } = &run.trajectory;
        Self {
            report: report.clone(),
            phase: run.phase_report(),
            penetrations: penetrations.clone(),
            leaps: leaps.clone(),
        }
    }

    /// That of a motion that another simulation has computed.
    pub(super) fn without_past(run: &Run) -> Self {
        let Self { report, phase, penetrations, .. } = Self::of(run);
        let report = Report { phases: Vec::new(), constraint_drift: 0.0, ..report };
        let phase = PhaseReport { counts: Counts::default(), slips: Vec::new(), ..phase };
        let penetrations =
            penetrations.iter().map(|known| Penetration::none(&known.obstacle)).collect();
        Self { report, phase, penetrations, leaps: Vec::new() }
    }
}

/// The part from which another simulation of the same scene can continue, too.
#[derive(Clone)]
pub(crate) struct Kept {
    pub(crate) time: f64,
    /// The unknowns, in the order of their `Layout`.
    pub(crate) state: Vec<f64>,
    /// The phase in force, as commands have changed it, and its number.
    pub(crate) phase: Arc<Phase>,
    pub(crate) number: usize,
    /// Whether commands have changed it.
    pub(crate) is_commanded: bool,
    /// [Origin](crate::scene::constraint::ConstraintRow::origin) of each row of the constraints; none if
    /// that is not known.
    pub(crate) origins: Vec<[f64; 4]>,
    /// Size of the next step (s), if it is known.
    pub(crate) first_step: Option<f64>,
    /// Steps since t = 0, which determine when the energy balance is checked.
    pub(crate) steps: usize,
    /// Changes of the forces by commands, in the phase in force.
    pub(crate) commands: usize,
    /// Reference value (J) of the energy balance by which methods are judged.
    pub(crate) balance: f64,
    /// Error, rise and scale of the energy balance (J).
    pub(crate) energies: [f64; 3],
    /// The angles of sensors, at or after the time.
    pub(crate) angles: Angles,
}

/// Short: its time and phase.
impl fmt::Debug for Checkpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Checkpoint")
            .field("time", &self.kept.time)
            .field("phase", &self.kept.phase.name)
            .finish_non_exhaustive()
    }
}

impl Checkpoint {
    /// Its time (s).
    pub fn time(&self) -> f64 {
        self.kept.time
    }
}

impl Kept {
    /// The equations in force: nodes that are held or moved continue as before.
    pub(super) fn equations(&self, run: &Run) -> Result<Box<dyn Integrable>, InputError> {
        let start = PhaseStart { time: self.time, u: &self.state[..run.scene.body().dofs()] };
        let mut rows = run.scene.rows(&self.phase, &start)?;
        rows.iter_mut().zip(&self.origins).for_each(|(row, origin)| row.set_origin(*origin));
        let forces = run.scene.forces_in(&self.phase)?;
        run.equations_by(&self.phase, forces, rows)
    }
}
