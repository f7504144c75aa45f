//! Start of IDA: states and their time derivatives, and the computation of consistent ones.

use std::mem;

use faer::MatRef;

use super::setup::IdaKind;
use crate::integrators::{
    common::{Callback, Cause, Error, Integrator, check_finite, check_length, check_time},
    ode::{Dae, Failure},
    sundials::{
        ffi,
        functions::named,
        index::{Index, index},
        sensitivity::CarriesSensitivities,
        session::Session,
        stepping::apart,
        vector::Vector,
    },
};

/// Which initial values [`Ida::consistent_start`](super::Ida::consistent_start) may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialCondition {
    /// The algebraic unknowns and the derivatives of the differential ones; differential unknowns
    /// stay (`IDA_YA_YDP_INIT`). Needs [`IdaOptions::differential`](super::IdaOptions::differential).
    Algebraic,
    /// All unknowns; their derivatives stay, such as zero for a state of rest (`IDA_Y_INIT`). Not with
    /// sensitivities.
    State,
}

/// C looks for a start by implicit steps of five sizes, each a tenth of the one before; the first is this
/// fraction of the time to the first output.
const LONGEST_STEP: f64 = 1e-3;
/// The factor that shortens that time if none of them led to a start, and how often it is applied.
const NEXT: f64 = 1e-5;
const RETRIES: usize = 6;
/// C keeps a Jacobian for up to ten iterations, and gives up where these do not converge. After that a search is repeated by Newton's
/// method with so many Jacobians, each for one iteration.
const JACOBIANS: i32 = 30;

/// Starts of a session of IDA, as described at [`Ida`](super::Ida): consistent initial values, index check, reinitialization.
pub trait StartsDae: CarriesSensitivities {
    fn consistent_start(
        &mut self,
        unknown: InitialCondition,
        first_output: f64,
    ) -> Result<(), Error>;
    fn check_index(&mut self) -> Result<(), Error>;
    fn reinit_with(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error>;
    fn set_sensitivities_with(
        &mut self,
        s: MatRef<'_, f64>,
        sp: MatRef<'_, f64>,
    ) -> Result<(), Error>;
    fn knows_algebraic(&self) -> bool;
    fn diagnose_index(&mut self) -> Result<(), Error>;
    fn yp(&self) -> &[f64];
}

impl<S: Dae> StartsDae for Session<IdaKind, S> {
    fn consistent_start(
        &mut self,
        unknown: InitialCondition,
        first_output: f64,
    ) -> Result<(), Error> {
        check_time("first_output", first_output)?;
        if first_output == self.t {
            let help = "it is a later time than the start";
            return Err(Error::input("first_output", first_output, help));
        }
        if unknown == InitialCondition::Algebraic && !self.kind.knows_algebraic {
            let help = "the option `differential` has to say which unknowns are algebraic";
            return Err(Error::input("unknown", "InitialCondition::Algebraic", help));
        }
        if unknown == InitialCondition::State && self.sensitivities.is_some() {
            let help =
                "with sensitivities it is Algebraic: IDAS 6.4.1 reads numbers that it never wrote";
            return Err(Error::input("unknown", "InitialCondition::State", help));
        }
        if self.statistics().steps > 0 {
            let help = "initial values can only be corrected before the first step";
            return Err(Error::input("steps taken", self.statistics().steps, help));
        }
        let task = match unknown {
            InitialCondition::Algebraic => ffi::IDA_YA_YDP_INIT,
            InitialCondition::State => ffi::IDA_Y_INIT,
        };
        let (mut towards, mut keeps_jacobians) = (self.clock().elapsed(first_output), true);
        let mut retries = if task == ffi::IDA_YA_YDP_INIT { RETRIES } else { 0 };
        let code = loop {
            self.host.get_mut().troubles.clear();
            // SAFETY: the memory and everything registered with it are alive; `&mut self` keeps
            // others away while callbacks use the host.
            let code =
                unsafe { ffi::IDACalcIC(self.memory.raw, task, apart(self.elapsed, towards)) };
            self.host.get_mut().troubles.resume_panic();
            let unfound = [ffi::IDA_CONV_FAIL, ffi::IDA_LINESEARCH_FAIL, ffi::IDA_NO_RECOVERY];
            if code == ffi::IDA_CONV_FAIL && keeps_jacobians {
                keeps_jacobians = false;
                self.renew_jacobians_at_start()?;
                continue;
            }
            // C refuses shorter times
            let scale = NEXT * (towards - self.elapsed);
            let moves = scale.abs() > 8.0 * f64::EPSILON * self.elapsed.abs();
            if retries == 0 || !moves || !unfound.contains(&code) {
                break code;
            }
            if retries == RETRIES && self.higher_index(&Cause::InconsistentStart).is_some() {
                break code;
            }
            (towards, retries) = (self.elapsed + scale, retries - 1);
        };
        if code < 0 {
            let longest = LONGEST_STEP * (first_output - self.t).abs();
            let shortest = 1e-4 * LONGEST_STEP * (towards - self.elapsed).abs();
            return Err(self.unfound(code, first_output, [longest, shortest]));
        }
        let (memory, y, yp) = (self.memory.raw, self.y.raw(), self.raw_yp());
        // SAFETY: memory and vectors are alive.
        self.host.call(named!(IDAGetConsistentIC), |get| unsafe { get(memory, y, yp) })?;
        self.read_consistent_sensitivities()
    }

    fn check_index(&mut self) -> Result<(), Error> {
        const MOST_UNKNOWNS: usize = 1000;
        let n = self.y().len();
        if n > MOST_UNKNOWNS {
            let help = format!("the index is checked in dense matrices: at most {MOST_UNKNOWNS}");
            return Err(Error::input("number of unknowns", n, help));
        }
        let (host, y) = (self.host.get_mut(), self.y.as_slice());
        let yp = self.yp.as_ref().map_or(&[][..], Vector::as_slice);
        let (callback, t) = (Callback::Residual, self.t);
        let (cause, source) = match index(&mut host.system, t, y, yp) {
            Ok(Index::AtMostOne) => return Ok(()),
            Ok(Index::Higher(unknown)) => (Cause::HigherIndex { unknown }, None),
            Ok(Index::Singular) => (Cause::LinearSolver, None),
            Err(Failure::Recoverable(message)) => (Cause::Rejected { callback, t, message }, None),
            Err(Failure::Fatal(error)) => (Cause::Fatal(callback), Some(error)),
        };
        Err(self.error(&self.step_statistics(), cause, String::new(), source))
    }

    fn reinit_with(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        check_length("length of yp", yp.len(), self.y().len())?;
        check_finite("yp", yp)?;
        // the present one stays in the other vector until the start is accepted
        mem::swap(&mut self.yp, &mut self.slope_scratch);
        if let Some(vector) = &mut self.yp {
            vector.as_mut_slice().copy_from_slice(yp);
        }
        let outcome = self.reinit(t, y);
        if outcome.is_err() {
            mem::swap(&mut self.yp, &mut self.slope_scratch);
        }
        outcome
    }

    fn set_sensitivities_with(
        &mut self,
        s: MatRef<'_, f64>,
        sp: MatRef<'_, f64>,
    ) -> Result<(), Error> {
        self.check_shape("shape of sp", sp.nrows(), sp.ncols())?;
        self.start_sensitivities(s, Some(sp))
    }

    fn knows_algebraic(&self) -> bool {
        self.kind.knows_algebraic
    }

    fn diagnose_index(&mut self) -> Result<(), Error> {
        match self.higher_index(&Cause::Other) {
            Some(cause) => Err(self.error(&self.step_statistics(), cause, String::new(), None)),
            None => Ok(()),
        }
    }

    fn yp(&self) -> &[f64] {
        self.yp.as_ref().map_or(&[], Vector::as_slice)
    }
}

impl<S> Session<IdaKind, S> {
    /// Lets the search for a start take a new Jacobian for each iteration.
    fn renew_jacobians_at_start(&mut self) -> Result<(), Error> {
        let memory = self.memory.raw;
        // SAFETY: the memory is alive.
        self.host.call(named!(IDASetMaxNumItersIC), |set| unsafe { set(memory, 1) })?;
        // SAFETY: the memory is alive.
        self.host.call(named!(IDASetMaxNumJacsIC), |set| unsafe { set(memory, JACOBIANS) })
    }

    /// The error for a start that was not found by steps of these sizes.
    fn unfound(&mut self, code: i32, first_output: f64, [longest, shortest]: [f64; 2]) -> Error {
        let mut error = self.stopped(code, first_output);
        if let Error::Integration(stopped) = &mut error
            && stopped.cause == Cause::InconsistentStart
        {
            let tried = format!(
                "no start was found by steps from {longest:.0e} to {shortest:.0e}: try one that is closer to the equations"
            );
            let said = std::mem::replace(&mut stopped.message, tried);
            if !said.is_empty() {
                stopped.message.push_str("; ");
                stopped.message.push_str(&said);
            }
        }
        error
    }

    /// Reads the sensitivities after `IDACalcIC`, which corrects them, too.
    fn read_consistent_sensitivities(&mut self) -> Result<(), Error> {
        let Some(sensitivities) = &mut self.sensitivities else { return Ok(()) };
        let [s, sp] = sensitivities.raw();
        // SAFETY: memory and vectors are alive; null requests nothing.
        let code = unsafe { ffi::IDAGetSensConsistentIC(self.memory.raw, s, sp) };
        sensitivities.s.copy_to(&mut sensitivities.values);
        self.host.accept("IDAGetSensConsistentIC", code)
    }
}
