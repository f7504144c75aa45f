//! A run that continues with another number of unknowns.

use super::{
    error::Reason,
    method::Method,
    options::Options,
    problem::{Equations, Problem},
    run::Run,
    saved::Saved,
};
use crate::base::input::InputError;

impl<'a> Run<'a> {
    /// Continues from the present time with `problem`, which may have another number of unknowns: where cells divide, a mesh is refined, parts
    /// break off.
    ///
    /// `problem` has its own state, equations, parameters and breaks. Its events replace the previous ones, as many in the same
    /// order: counts and armed states continue; a change of sign of an event function by the change of the state is no event. The
    /// method, the end of the span, integrals, statistics, limits, observer and flag continue (unless `problem` has an observer or flag of its own).
    ///
    /// The integrator is a new one: one-step methods try the step that was planned (without errors of earlier steps), multistep methods start with order 1 and estimate a first
    /// step, and [`Method::Auto`] begins with the explicit method. With [sensitivities](Options::sensitivities) those of the new state are given
    /// by [`Problem::initial_sensitivities`]. A state [saved](Self::save) before cannot be restored any more, and progress counts from here.
    ///
    /// ```
    /// use pliant::{
    ///     solve::{Method, Options, Problem, Run},
    ///     sundials::ButcherTable,
    /// };
    ///
    /// // cells that grow, all alike, and divide when they have doubled: 1, 2, 4, 8
    /// let growth = |_t: f64, y: &[f64], ydot: &mut [f64]| {
    ///     ydot.iter_mut().zip(y).for_each(|(ydot, y)| *ydot = *y);
    ///     Ok(())
    /// };
    /// let (options, method) = (Options::new(1e-8, 1e-10), Method::RungeKutta(ButcherTable::implicit(4)?));
    /// let mut run = Run::new(Problem::ode(growth, [1.0]), method, (0.0, 3.0), &options)?;
    /// for generation in 1..4 {
    ///     run.advance_to(f64::from(generation) * 2.0_f64.ln())?;
    ///     let halves = [run.y(), run.y()].concat().iter().map(|size| 0.5 * size).collect::<Vec<_>>();
    ///     run.resize(Problem::ode(growth, halves), &options)?;
    /// }
    /// run.advance_to(3.0)?;
    /// assert_eq!(run.y().len(), 8);
    /// assert!((run.y().iter().sum::<f64>() / 3.0_f64.exp() - 1.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Reason::Input`] as for [`new`](Self::new), and for another number of events or integrals, or a run that has ended: the run is then as
    /// before.
    pub fn resize(&mut self, mut problem: Problem<'a>, options: &Options) -> Result<(), Reason> {
        if let Some(end) = self.end {
            let help = "it has ended: give it a longer span";
            return Err(InputError::new("run", format!("{end:?}"), help).into());
        }
        if problem.events.len() != self.events.len() {
            let help = format!("the run has {}, whose counts go on", self.events.len());
            let input = "number of events of a resized run";
            return Err(InputError::new(input, problem.events.len(), help).into());
        }
        if options.sensitivities.is_some() && problem.initial_sensitivities.is_none() {
            let help =
                "Problem::initial_sensitivities says how the new unknowns depend on the parameters";
            return Err(InputError::new("sensitivities of a resized run", "missing", help).into());
        }
        problem.saved = Some(self.resized(&problem)?);
        let method = self.method.method;
        let keeps_step =
            matches!(method, Method::RungeKutta(_) | Method::DormandPrince | Method::Rosenbrock);
        let planned = self.engine.statistics().current_step.abs();
        let mut options = options.clone();
        if keeps_step && planned > 0.0 && options.initial_step.is_none() {
            options = options.initial_step(planned);
        }
        let mut next = Run::new(problem, method, (self.t, self.span.1), &options)?;
        (next.past, next.started) = (self.statistics(), self.started);
        next.observer = next.observer.or_else(|| self.observer.take());
        next.cancel = next.cancel.or_else(|| self.cancel.take());
        *self = next;
        Ok(())
    }

    /// Where this run stands, with the state of `problem`.
    fn resized(&self, problem: &Problem<'a>) -> Result<Saved, Reason> {
        let parameters = problem.equations.parameters().to_vec();
        let mut saved = self.save();
        for (i, value) in saved.event_values.iter_mut().enumerate() {
            // one at zero leaves it
            if *value != 0.0 {
                *value = problem.events[i].value(i, self.t, &problem.y, &parameters)?;
            }
        }
        saved.yp = match &problem.equations {
            Equations::Dae { yp, .. } => yp.clone(),
            Equations::Ode(_) => Vec::new(),
        };
        saved.y.clone_from(&problem.y);
        saved.sensitivities = problem.initial_sensitivities.clone().unwrap_or_default();
        Ok(Saved { parameters, ..saved })
    }
}
