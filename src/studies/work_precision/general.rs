//! Systems of equations as problems of a study, solved by the general integrators.
//!
//! Such a problem is an end state, and lines that are closures from tolerances to an end state: integrators
//! of other libraries are lines like those of this crate (`peers/`).

use std::time::{Duration, Instant};

use super::timing::Budget;
use super::{Failed, Line, Measured, Point, Problem, fingerprint};
use crate::dynamics::error::Error;
use crate::integrators::common::Integrator;
use crate::integrators::ode::{Failure, Ode, call, with_mass};
use crate::integrators::rk::{self, DormandPrince};
use crate::integrators::sundials::{
    Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, LinearSolver,
    MassForm, Multistep,
};

/// A system of equations with a trusted end state, solved by the integrators of
/// [`sundials`](crate::integrators::sundials) and [`rk`], or by those of others, tolerance by tolerance.
///
/// The error is relative, component by component; so absolute tolerances are the relative one times the end
/// state.
///
/// ```
/// use pliant::study::{General, Study};
/// use pliant::sundials::{Cvode, Jacobian, LinearSolver};
///
/// // y' = -1000 (y - cos t) - sin t, which is cos t
/// let decay = |t: f64, y: &[f64], ydot: &mut [f64]| {
///     ydot[0] = -1000.0 * (y[0] - t.cos()) - t.sin();
///     Ok(())
/// };
/// let newton = LinearSolver::Dense(Jacobian::DifferenceQuotients);
/// let mut problem = General::new("Decay", 1.0, [1_f64.cos()], 1e-15)
///     .methods(&decay, &[1.0], &newton)
///     .line("order 1", "mine", move |goal| {
///         goal.reach(Cvode::new(decay, 0.0, &[1.0], &goal.cvode().max_order(1))?)
///     })
///     .tolerances([1e-3, 1e-5]);
/// let findings = Study::new(&mut problem).run(&mut |_| ())?;
/// assert_eq!(findings.lines().len(), 10);
/// # Ok::<(), pliant::Error>(())
/// ```
pub struct General {
    title: String,
    end: f64,
    truth: Truth,
    tolerances: Vec<f64>,
    lines: Vec<Line>,
    ways: Vec<Box<Way>>,
}

type Way = dyn Fn(&Goal<'_>) -> Result<EndState, Failed>;

/// Reference for errors.
enum Truth {
    /// The end state, and the relative error that it may have.
    Known(Vec<f64>, f64),
    /// An end state of about this size, which these two lines have to agree on.
    Sought(Vec<f64>, [String; 2]),
}

/// Relative tolerance of lines that give the reference.
const REFERENCE: f64 = 1e-12;

/// End time, tolerances and time limit of a run.
#[derive(Debug, Clone, Copy)]
pub struct Goal<'a> {
    /// The end; the start is at t = 0.
    pub t: f64,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerances.
    pub atol: &'a [f64],
    /// Processor time that may be spent.
    pub limit: Duration,
}

/// An end state and its cost.
#[derive(Debug, Clone, Default)]
pub struct EndState {
    /// The state.
    pub y: Vec<f64>,
    /// Time (s) of a program that measures itself; otherwise that of the call counts.
    pub seconds: Option<f64>,
    /// Steps.
    pub steps: usize,
    /// Evaluations of the right-hand side or residual.
    pub evaluations: usize,
    /// Factorizations of the Newton matrix.
    pub factorizations: usize,
}

impl General {
    /// A problem from t = 0 to `end`, where its state is `y`, up to a relative error of `resolution`. No
    /// lines yet; tolerances of 1e-2 to 1e-10.
    pub fn new(
        title: impl Into<String>,
        end: f64,
        y: impl Into<Vec<f64>>,
        resolution: f64,
    ) -> Self {
        Self::of(title.into(), end, Truth::Known(y.into(), resolution))
    }

    /// A problem whose end state is that of two of its lines, at a tolerance of 1e-12; the difference between
    /// them counts as its error. `scale` gives the approximate size of its components.
    pub fn agreed(
        title: impl Into<String>,
        end: f64,
        scale: impl Into<Vec<f64>>,
        lines: [&str; 2],
    ) -> Self {
        Self::of(title.into(), end, Truth::Sought(scale.into(), lines.map(String::from)))
    }

    fn of(title: String, end: f64, truth: Truth) -> Self {
        let tolerances = (2..=10).map(|digits| 10_f64.powi(-digits)).collect();
        Self { title, end, truth, tolerances, lines: Vec::new(), ways: Vec::new() }
    }

    /// Relative tolerances of all lines, from rough to fine.
    #[must_use]
    pub fn tolerances(mut self, tolerances: impl Into<Vec<f64>>) -> Self {
        self.tolerances = tolerances.into();
        self.lines.iter_mut().for_each(|line| line.points = points(&self.tolerances));
        self
    }

    /// Adds a line, which `way` solves: by an integrator of this crate, [`Goal::reach`], or in any other way.
    #[must_use]
    pub fn line(
        mut self,
        name: &str,
        family: &str,
        way: impl Fn(&Goal<'_>) -> Result<EndState, Failed> + 'static,
    ) -> Self {
        let points = points(&self.tolerances);
        self.lines.push(Line { name: name.into(), family: family.into(), points });
        self.ways.push(Box::new(way));
        self
    }

    /// Adds the lines of all methods for an ODE that starts from `y0`, with this solver of their linear
    /// systems: dense or of band form.
    #[must_use]
    pub fn methods<S: Ode + Clone + 'static>(
        self,
        system: &S,
        y0: &[f64],
        newton: &LinearSolver,
    ) -> Self {
        let bdf = |max_order, detects| {
            move |options: CvodeOptions| {
                options.max_order(max_order).stability_limit_detection(detects)
            }
        };
        self.cvode("cvode-bdf", system, y0, newton, bdf(5, false))
            .cvode("cvode-bdf, order 2", system, y0, newton, bdf(2, false))
            .cvode("cvode-bdf, stability limit", system, y0, newton, bdf(5, true))
            .cvode("cvode-adams", system, y0, newton, |options| options.method(Multistep::Adams))
            .ida("ida", system, y0, newton)
            .arkode("arkode", system, y0, newton, 4)
            .arkode("arkode, order 3", system, y0, newton, 3)
            .arkode("arkode, order 5", system, y0, newton, 5)
            .rk(system, y0)
    }

    /// A line of CVODE, with these further options. Families are the first words of names.
    pub(super) fn cvode<S: Ode + Clone + 'static>(
        self,
        name: &str,
        system: &S,
        y0: &[f64],
        newton: &LinearSolver,
        options: impl Fn(CvodeOptions) -> CvodeOptions + 'static,
    ) -> Self {
        let (system, y0, newton) = (system.clone(), y0.to_vec(), newton.clone());
        self.line(name, family(name), move |goal| {
            let options = options(goal.cvode()).newton(newton.clone());
            goal.reach(Cvode::new(system.clone(), 0.0, &y0, &options)?)
        })
    }

    pub(super) fn arkode<S: Ode + Clone + 'static>(
        self,
        name: &str,
        system: &S,
        y0: &[f64],
        newton: &LinearSolver,
        order: u32,
    ) -> Self {
        let (system, y0, newton) = (system.clone(), y0.to_vec(), newton.clone());
        self.line(name, family(name), move |goal| {
            let options =
                goal.arkode().table(ButcherTable::implicit(order)?).newton(newton.clone());
            goal.reach(Arkode::new(system.clone(), 0.0, &y0, &options)?)
        })
    }

    pub(super) fn ida<S: Ode + Clone + 'static>(
        self,
        name: &str,
        system: &S,
        y0: &[f64],
        newton: &LinearSolver,
    ) -> Self {
        let (system, y0, newton) = (system.clone(), y0.to_vec(), newton.clone());
        self.line(name, family(name), move |goal| {
            let (n, mut system, mut slope) = (y0.len(), system.clone(), vec![0.0; y0.len()]);
            call::rhs(&mut system, 0.0, &y0, &mut slope).map_err(Failure::into_error)?;
            let system = MassForm::new(with_mass(system, vec![1.0; n]), n, &newton)?;
            let options = goal.ida().newton(newton.clone());
            goal.reach(Ida::new(system, 0.0, &y0, &slope, &options)?)
        })
    }

    pub(super) fn rk<S: Ode + Clone + 'static>(self, system: &S, y0: &[f64]) -> Self {
        let (system, y0) = (system.clone(), y0.to_vec());
        self.line("rk", "rk", move |goal| {
            goal.reach(DormandPrince::new(system.clone(), 0.0, &y0, &goal.rk())?)
        })
    }

    /// Solves the problem by the line of this number.
    fn solve(&self, line: usize, rtol: f64, limit: Duration) -> Result<(EndState, f64), Failed> {
        let (Truth::Known(scale, _) | Truth::Sought(scale, _)) = &self.truth;
        let atol: Vec<f64> = scale.iter().map(|y| rtol * y.abs()).collect();
        let clock = Instant::now();
        let reached = (self.ways[line])(&Goal { t: self.end, rtol, atol: &atol, limit })?;
        let seconds = reached.seconds.unwrap_or_else(|| clock.elapsed().as_secs_f64());
        if reached.y.len() != scale.len() {
            let (found, expected) = (reached.y.len(), scale.len());
            return Err(format!("{found} components at the end, not {expected}").into());
        }
        Ok((reached, seconds))
    }
}

fn points(tolerances: &[f64]) -> Vec<Point> {
    tolerances.iter().map(|&rtol| Point { name: format!("{rtol:e}"), rtol }).collect()
}

fn family(name: &str) -> &str {
    name.split(',').next().unwrap_or(name)
}

/// Errors of `y`, component by component, relative to `truth`.
fn errors(y: &[f64], truth: &[f64]) -> impl Iterator<Item = f64> {
    y.iter().zip(truth).map(|(y, truth)| (y / truth - 1.0).abs())
}

impl Goal<'_> {
    /// These tolerances for CVODE.
    pub fn cvode(&self) -> CvodeOptions {
        CvodeOptions::new(self.rtol, self.atol.to_vec())
    }

    /// These tolerances for ARKODE.
    pub fn arkode(&self) -> ArkodeOptions {
        ArkodeOptions::new(self.rtol, self.atol.to_vec())
    }

    /// These tolerances for IDA.
    pub fn ida(&self) -> IdaOptions {
        IdaOptions::new(self.rtol, self.atol.to_vec())
    }

    /// These tolerances for Dormand-Prince.
    pub fn rk(&self) -> rk::Options {
        rk::Options::new(self.rtol, self.atol.to_vec())
    }

    /// Integrates to the end.
    ///
    /// # Errors
    /// Those of the integrator; a run that has spent its time.
    pub fn reach(&self, mut integrator: impl Integrator) -> Result<EndState, Failed> {
        let (mut budget, end) = (Budget::new(self.limit), self.t);
        integrator.set_stop_time(Some(end))?;
        while integrator.t() < end {
            let _ = integrator.step(end)?;
            if budget.is_spent() {
                let (steps, t) = (integrator.statistics().steps, integrator.t());
                let reason = format!("given up after {steps} steps at t = {t:.3e} of {end:e}");
                return Err(reason.into());
            }
        }
        let statistics = integrator.statistics();
        Ok(EndState {
            y: integrator.y().to_vec(),
            seconds: None,
            steps: statistics.steps as usize,
            evaluations: statistics.evaluations as usize,
            factorizations: statistics.linear_setups as usize,
        })
    }
}

impl Problem for General {
    fn title(&self) -> &str {
        &self.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        let Self { title, end, lines, .. } = self;
        let Line { name, points, .. } = &lines[line];
        fingerprint::of_text(format_args!("{title} {end} {name} {}", points[point].rtol), &[])
    }

    fn prepare(&mut self, limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        let names = match &self.truth {
            Truth::Known(_, resolution) => return Ok(*resolution),
            Truth::Sought(_, names) => names.clone(),
        };
        let failed = |failures: String| Error::Reference {
            rtol: REFERENCE,
            failures,
            help: "allow more time, or choose other lines for it".into(),
        };
        let mut end = |name: &String| {
            tell(&format!("reference: {name}"));
            let line = self.lines.iter().position(|line| line.name == *name);
            let line = line.ok_or_else(|| failed(format!("there is no line {name}")))?;
            let (reached, _) = self
                .solve(line, REFERENCE, limit)
                .map_err(|error| failed(format!("{name}: {error}")))?;
            Ok::<_, Error>(reached.y)
        };
        let (truth, other) = (end(&names[0])?, end(&names[1])?);
        // smaller differences are round-off
        let resolution = errors(&other, &truth).fold(REFERENCE, f64::max);
        self.truth = Truth::Known(truth, resolution);
        Ok(resolution)
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        let rtol = self.lines[line].points[point].rtol;
        let (EndState { y, steps, evaluations, factorizations, .. }, seconds) =
            self.solve(line, rtol, limit)?;
        let (Truth::Known(truth, _) | Truth::Sought(truth, _)) = &self.truth;
        let squares: f64 = errors(&y, truth).map(|error| error * error).sum();
        Ok(Measured {
            error: (squares / y.len() as f64).sqrt(),
            largest_error: errors(&y, truth).fold(0.0, f64::max),
            seconds,
            states: y.len(),
            steps,
            evaluations,
            factorizations,
            energy_error: None,
        })
    }

    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed> {
        let rtol = self.lines[line].points[point].rtol;
        Ok(self.solve(line, rtol, Duration::MAX)?.1)
    }
}
