//! A simulation that other programs control.

use std::fmt;
use std::mem::take;
use std::ops::ControlFlow;
use std::time::Instant;

use super::checkpoint::Checkpoint;
use super::phase_run::Integration;
use super::run::Run;
use super::sampling::Sampling;
use super::sensor::Sensors;
use super::view::{Gauges, View};
use super::watch::{Arrival, WatchedEvent};
use crate::base::input::{InputError, finite, positive};
use crate::base::vector::largest;
use crate::dynamics::error::{Error, Panicked, guarded};
use crate::dynamics::report::Report;
use crate::dynamics::state::State;
use crate::dynamics::system::Energy;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// A scene in motion under the control of a program.
///
/// The program advances time, reads the motion, gives commands (pressures, forces, constraints), and returns
/// to earlier states.
///
/// ```
/// use pliant::{Settings, samples};
///
/// // the jumping square, pressed down and let go when it has enough energy
/// let mut square = samples::square_jump(4)?.start(&Settings::default())?;
/// while square.energy().strain < 0.2 && square.time() < 0.4 {
///     square.advance_by(0.01)?;
/// }
/// let height = square.view().centre_of_mass()[1];
/// assert!(height < 0.15);
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// Between commands it moves as in [`Scene::simulate`]: by the phases of the scene, with steps as long as the
/// tolerances allow. [`advance_to`](Self::advance_to) interpolates the motion between the ends of steps, so
/// that reading does not affect it. A command takes effect exactly at the present time; the first advance
/// after a command also ends a step at the requested time.
///
/// After an error other than [`Error::Integration`] the simulation is as it was before the call; after
/// that error it remains where the integrator failed, and after an error of an event, where the event was
/// evaluated. A panic of a function that was given to the scene or the simulation becomes such an error, too.
///
/// [`Method::Auto`](crate::Method::Auto) goes back where a method has created energy, and continues with
/// another one. The time seen here never runs backwards, and the motion before the last command is kept; but
/// the motion seen since then may differ from the one that is continued.
pub struct Simulation {
    pub(super) run: Run,
    /// The present: at the end of the last step or within it.
    pub(super) time: f64,
    /// The unknowns, in the order of their `Layout`.
    pub(super) now: Vec<f64>,
    /// Whether there was a command since time last advanced.
    pub(super) commanded: bool,
    pub(super) watches: Vec<WatchedEvent<Self>>,
}

impl Scene {
    /// Starts the scene, to be driven step by step; see [`Simulation`].
    ///
    /// # Errors
    /// As [`validate`](Self::validate) and [`Settings::validate`].
    pub fn start(&self, settings: &Settings) -> Result<Simulation, Error> {
        let clock = Instant::now();
        settings.validate()?;
        let scene = &*settings.method.equations_of(self);
        let mut all = scene.forces_from_start()?;
        let first = all.first().cloned().unwrap_or_default();
        // matrices have room for chambers that no phase fills
        let gauges = Gauges::new(scene)?;
        all.push(gauges.chambers());
        let own = (scene.matrices(&all), gauges);
        let sampling = (&Sampling::phase_ends(), Sensors::default());
        let run = Run::new(scene, settings, sampling, clock, own, first)?;
        let (time, now) = (run.time, run.state.clone());
        Ok(Simulation { run, time, now, commanded: false, watches: Vec::new() })
    }
}

/// Short: its time, phase and steps.
impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Simulation")
            .field("time", &self.time)
            .field("phase", &self.run.phase.name)
            .field("steps", &self.run.steps)
            .finish_non_exhaustive()
    }
}

impl Simulation {
    /// The present time (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The motion at the present time.
    pub fn view(&self) -> View<'_> {
        let Self { run, time, now, .. } = self;
        let State { u, v, internal, .. } = run.layout.of(now);
        View {
            scene: &run.scene,
            phase: &run.phase,
            gauges: &run.gauges,
            time: *time,
            u,
            v,
            amounts: run.layout.split(internal).1,
            accelerations: &[],
        }
    }

    /// The energies at the present time; computing them costs about an evaluation of the forces.
    pub fn energy(&self) -> Energy {
        self.run.energy(self.time, &self.now)
    }

    /// A sample of the present: displacements, velocities, constraint forces, energies.
    ///
    /// # Errors
    /// [`Error::Integration`] if the forces are undefined.
    pub fn sample(&mut self) -> Result<Sample, Error> {
        self.run.sample(self.time, &self.now)
    }

    /// Looks so many `times` as often at functions of programs, to see pulses in them, from the next step on.
    #[cfg(feature = "study")]
    pub(crate) fn look_more_often(&mut self, times: f64) {
        self.run.looks = times;
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.run.scene
    }

    /// The name of the phase in force.
    pub fn phase(&self) -> &str {
        &self.run.phase.name
    }

    /// The number of the phase in force, from 0.
    pub fn phase_number(&self) -> usize {
        self.run.number
    }

    /// How the motion was computed so far.
    pub fn report(&self) -> Report {
        self.run.report()
    }

    /// The same with the error estimate of a reduced model as far as it is known: the rest takes too long for a live picture.
    #[cfg(feature = "play")]
    pub(crate) fn settled_report(&self) -> Report {
        self.run.settled_report()
    }

    /// Takes samples of the motion from the end of the present step on, which are kept in the [`trajectory`](Self::trajectory).
    ///
    /// # Errors
    /// Sampling times that cannot be used; sensors of components that the scene does not have.
    pub fn record(&mut self, sampling: &Sampling) -> Result<(), InputError> {
        let scene = &self.run.scene;
        let sensors = sampling.sensors(scene)?;
        self.run.record(sampling, sensors);
        Ok(())
    }

    /// The samples so far.
    pub fn trajectory(&self) -> &Trajectory {
        &self.run.trajectory
    }

    /// The samples with the report, at the end of the simulation.
    pub fn into_trajectory(self) -> Trajectory {
        self.run.into_trajectory()
    }

    /// Takes one step of the integrator. Returns `false` at the end of the scene.
    ///
    /// # Errors
    /// [`Error::Integration`] if the integrator gives up.
    pub fn step(&mut self) -> Result<bool, Error> {
        while self.run.time <= self.time {
            if !self.advance()? {
                return Ok(false);
            }
        }
        self.commanded = false;
        self.look(self.run.time)?;
        Ok(true)
    }

    /// Runs the rest of the scene.
    ///
    /// `observer` is called after each step and stops the run by [`ControlFlow::Break`]. Returns the samples
    /// requested by [`record`](Self::record), with the report.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    ///
    /// use pliant::{Sampling, Settings, samples};
    ///
    /// # let directory = tempfile::tempdir().unwrap();
    /// # let path = directory.path().join("square.json");
    /// let mut square = samples::square_jump(4)?.start(&Settings::default())?;
    /// square.record(&Sampling::every(0.01))?;
    /// let motion = square.finish(|square| {
    ///     if square.steps() % 100 == 0 {
    ///         square.checkpoint().write(&path).unwrap(); // to go on from, should this end before its time
    ///     }
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(motion.last().time, motion.scene().end());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Integration`] with the motion until then if the integrator gives up, or if the observer stops it:
    /// [`is_interruption`](crate::IntegrationFailure::is_interruption).
    pub fn finish(
        mut self,
        mut observer: impl FnMut(&Self) -> ControlFlow<()>,
    ) -> Result<Trajectory, Error> {
        let end = self.run.scene.end();
        while self.step()? {
            // after the last step there is nothing left to stop
            if observer(&self).is_break() && self.time < end {
                return Err(self.run.interrupted());
            }
        }
        Ok(self.into_trajectory())
    }

    /// Steps taken since t = 0.
    pub fn steps(&self) -> usize {
        self.run.steps
    }

    /// Size (s) and order of the last step of the present integrator; 0 before there was one.
    pub fn last_step(&self) -> (f64, u32) {
        self.run.last_step()
    }

    /// The cause of steps that are far too short for the present phase, with what to try; none before a thousand such steps.
    pub fn notice(&self) -> Option<&str> {
        self.run.notice()
    }

    /// Advances time to `t` (s). Returns whether `t` was reached: an action of [`when`](Self::when) may have
    /// stopped it before.
    ///
    /// # Errors
    /// A time before the present or after the end of the scene; [`Error::Integration`] if the integrator
    /// gives up.
    pub fn advance_to(&mut self, t: f64) -> Result<bool, Error> {
        self.check(t)?;
        let commanded = take(&mut self.commanded);
        self.run.pause = Some(t).filter(|_| commanded);
        if !self.watches.is_empty() {
            let arrival = self.advance_watched(t, None, commanded);
            self.run.pause = None;
            return Ok(arrival? == Arrival::Time);
        }
        while self.run.time < t && self.advance()? {}
        self.run.pause = None;
        self.look(t)?;
        Ok(true)
    }

    /// Advances time by `dt` (s). Returns whether all of it has passed.
    ///
    /// # Errors
    /// As [`advance_to`](Self::advance_to).
    pub fn advance_by(&mut self, dt: f64) -> Result<bool, Error> {
        self.advance_to(self.time + dt)
    }

    /// Advances time to `t` (s), but at most until the sign of `event` changes.
    ///
    /// Returns whether the sign changed: then the present is that time, to the round-off of the step that it
    /// lies in.
    ///
    /// Signs are compared eight times in each step, evenly spread: two changes in between are not noticed. An
    /// event that is 0 at the start counts when its sign changes later.
    ///
    /// # Errors
    /// As [`advance_to`](Self::advance_to).
    pub fn advance_until(
        &mut self,
        t: f64,
        mut event: impl FnMut(&View) -> f64,
    ) -> Result<bool, Error> {
        self.check(t)?;
        let commanded = take(&mut self.commanded);
        Ok(self.advance_watched(t, Some(&mut event), commanded)? == Arrival::Event)
    }

    /// Calls `controller` now and after each `period` (s), until time `t` (s).
    ///
    /// The controller reads the motion and gives commands. Returns whether `t` was reached, as
    /// [`advance_to`](Self::advance_to).
    ///
    /// # Errors
    /// A period that is not above 0; the error that the controller returns; otherwise as
    /// [`advance_to`](Self::advance_to).
    pub fn control(
        &mut self,
        period: f64,
        t: f64,
        mut controller: impl FnMut(&mut Self) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        positive("control period", period, "s")?;
        self.check(t)?;
        let start = self.time;
        for tick in 1_u64.. {
            guarded(|| controller(self))??;
            let reached = self.advance_to((start + tick as f64 * period).min(t))?;
            if self.time >= t || !reached {
                return Ok(reached);
            }
        }
        Ok(true)
    }

    /// Changes displacements (m) and velocities (m/s), as by an impact.
    ///
    /// The change of the energies counts as supplied from outside.
    ///
    /// # Errors
    /// Numbers that are not finite, or that rigid pieces do not allow: the state stays as it was. A scene that has
    /// ended.
    pub fn change_state(
        &mut self,
        change: impl FnOnce(&mut [f64], &mut [f64]),
    ) -> Result<(), Error> {
        self.check_goes_on()?;
        let before = self.energy().balance();
        let mut state = self.now.clone();
        let layout = self.run.layout;
        let parts = layout.of_mut(&mut state);
        guarded(|| change(parts.u, parts.v))?;
        finite("state", &state)?;
        let body = self.run.scene.body();
        if let Some(rigid) = body.rigid_pieces() {
            let State { u, v, .. } = layout.of(&state);
            rigid.check("displacements", u, "m", body.size())?;
            rigid.check("velocities", v, "m/s", largest(v))?;
        }
        let after = self.run.energy(self.time, &state).balance();
        *layout.of_mut(&mut state).supplied += after - before;
        self.run.set_state(self.time, &state)?;
        (self.now, self.commanded) = (state, true);
        Ok(())
    }

    /// Keeps the present state, to [return](Self::restore) to it.
    pub fn checkpoint(&self) -> Checkpoint {
        self.run.checkpoint(self.time, &self.now)
    }

    /// Returns to a state that was kept, with the commands in force then. Samples taken after it are
    /// discarded.
    ///
    /// The motion continues from there as before, to within the tolerances.
    ///
    /// # Errors
    /// A checkpoint of another simulation, unless one of them is a [`fork`](Self::fork) of the other.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), Error> {
        self.run.restore(checkpoint)?;
        self.time = self.run.time;
        self.now.copy_from_slice(&self.run.state);
        self.commanded = false;
        Ok(())
    }

    /// An independent simulation that starts from the present state with the commands in force.
    ///
    /// It serves to try other commands, on another thread if needed. Body, matrices and their orderings
    /// are shared.
    ///
    /// # Errors
    /// Only those that the start would also have returned.
    pub fn fork(&self) -> Result<Self, Error> {
        let run = self.run.fork(self.time, &self.now)?;
        let (time, now, commanded) = (self.time, self.now.clone(), self.commanded);
        Ok(Self { run, time, now, commanded, watches: Vec::new() })
    }

    /// Checks that there is time left for a command to act in.
    pub(crate) fn check_goes_on(&self) -> Result<(), InputError> {
        let (time, end) = (self.time, self.run.scene.end());
        if time < end {
            return Ok(());
        }
        let help = "the scene has ended, and nothing moves any more: restore a checkpoint, or let the last phase end later";
        Err(InputError::new("command at time", format!("{time} s"), help))
    }

    fn check(&self, t: f64) -> Result<(), InputError> {
        let (time, end) = (self.time, self.run.scene.end());
        if (time..=end).contains(&t) {
            return Ok(());
        }
        let help =
            format!("it must lie between the present, {time} s, and the end of the scene, {end} s");
        Err(InputError::new("time to go on to", format!("{t} s"), help))
    }

    /// Makes `t`, within the last step, the present.
    pub(super) fn look(&mut self, t: f64) -> Result<(), Error> {
        guarded(|| self.run.look(t, &mut self.now)).unwrap_or_else(|panic| self.panicked(panic))?;
        self.time = t;
        Ok(())
    }

    /// Takes a step; after a failure the present is where the integrator gave up.
    pub(super) fn advance(&mut self) -> Result<bool, Error> {
        let advanced = guarded(|| self.run.advance(&mut |_| ControlFlow::Continue(())));
        advanced.unwrap_or_else(|panic| self.panicked(panic)).inspect_err(|_| {
            (self.time, self.run.pause) = (self.run.time, None);
            self.now.copy_from_slice(&self.run.state);
        })
    }

    /// The error of a step within which a function has panicked: the integrator is lost, and a new one begins
    /// where the last step ended.
    fn panicked<T>(&mut self, panic: Panicked) -> Result<T, Error> {
        let error = self.run.failure(Box::new(panic), 0.0);
        self.run.integration = Integration::Absent;
        Err(error)
    }
}
