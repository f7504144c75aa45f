//! Systems of ordinary differential equations as problems, by the general integrators.

use std::time::{Duration, Instant};

use faer::MatMut;
use faer::reborrow::ReborrowMut;

use super::timing::Budget;
use super::{Failed, Line, Measured, Point, Problem, fingerprint};
use crate::error::Error;
use crate::integrate::{self, Integrator};
use crate::ode::{Dae, Failure, Ode};
use crate::rk::{self, DormandPrince};
use crate::samples::{Hires, Reference, Robertson, VanDerPol};
use crate::sundials::{
    Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, Jacobian,
    LinearSolver, Multistep,
};

/// A system of ordinary differential equations with a trusted end state, solved by the integrators
/// of [`sundials`](crate::sundials) (with dense matrices) and [`rk`], tolerance by tolerance.
///
/// Absolute tolerances are the relative one times the end state: errors are relative, too.
pub struct General {
    title: String,
    reference: Reference,
    lines: Vec<Line>,
    solve: Box<dyn Fn(Way, f64, Duration) -> Result<Solved, Failed>>,
}

/// How a system is integrated.
#[derive(Debug, Clone, Copy)]
enum Way {
    Bdf { max_order: u32, detects_stability_limit: bool },
    Adams,
    Ida,
    Arkode { order: u32 },
    Rk,
}

/// Name, family and way of all lines.
const WAYS: [(&str, &str, Way); 9] = [
    ("cvode-bdf", "cvode-bdf", Way::Bdf { max_order: 5, detects_stability_limit: false }),
    ("cvode-bdf, order 2", "cvode-bdf", Way::Bdf { max_order: 2, detects_stability_limit: false }),
    (
        "cvode-bdf, stability limit",
        "cvode-bdf",
        Way::Bdf { max_order: 5, detects_stability_limit: true },
    ),
    ("cvode-adams", "cvode-adams", Way::Adams),
    ("ida", "ida", Way::Ida),
    ("arkode", "arkode", Way::Arkode { order: 4 }),
    ("arkode, order 3", "arkode", Way::Arkode { order: 3 }),
    ("arkode, order 5", "arkode", Way::Arkode { order: 5 }),
    ("rk", "rk", Way::Rk),
];

/// An end state and what it cost.
struct Solved {
    y: Vec<f64>,
    cost: Measured,
}

impl General {
    /// HIRES.
    #[must_use]
    pub fn hires() -> Self {
        Self::new("HIRES", Hires::new(), &Hires::Y0, Hires::REFERENCE)
    }

    /// Robertson's reactions.
    #[must_use]
    pub fn robertson() -> Self {
        Self::new("Robertson", Robertson::new(), &Robertson::Y0, Robertson::REFERENCE)
    }

    /// Van der Pol's oscillator.
    #[must_use]
    pub fn van_der_pol() -> Self {
        Self::new("van der Pol", VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE)
    }

    /// A system with a dense Jacobian that starts with `y0` at t = 0, at tolerances of 1e-2 to 1e-10.
    pub fn new(
        title: impl Into<String>,
        system: impl Ode + Clone + 'static,
        y0: &[f64],
        reference: Reference,
    ) -> Self {
        let y0 = y0.to_vec();
        let solve = move |way, rtol, limit| {
            let run = Run { system: system.clone(), y0: &y0, reference, rtol, limit };
            run.by(way)
        };
        Self { title: title.into(), reference, lines: Vec::new(), solve: Box::new(solve) }
            .tolerances((2..=10).map(|digits| 10_f64.powi(-digits)).collect::<Vec<_>>())
    }

    /// Relative tolerances, from rough to fine.
    #[must_use]
    pub fn tolerances(mut self, tolerances: impl Into<Vec<f64>>) -> Self {
        let tolerances = tolerances.into();
        let points = || tolerances.iter().map(|&rtol| Point { name: format!("{rtol:e}"), rtol });
        let line = |&(name, family, _): &(&str, &str, Way)| Line {
            name: name.into(),
            family: family.into(),
            points: points().collect(),
        };
        self.lines = WAYS.iter().map(line).collect();
        self
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
        let Self { title, reference, lines, .. } = self;
        let rtol = lines[line].points[point].rtol;
        fingerprint::of_text(format_args!("{title} {reference:?} {:?} {rtol}", WAYS[line]), &[])
    }

    fn prepare(&mut self, _limit: Duration, _tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        Ok(10_f64.powi(-(self.reference.digits as i32)))
    }

    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        let clock = Instant::now();
        let Solved { y, cost } =
            (self.solve)(WAYS[line].2, self.lines[line].points[point].rtol, limit)?;
        let seconds = clock.elapsed().as_secs_f64();
        let squares = y.iter().zip(self.reference.y).map(|(y, exact)| (y / exact - 1.0).powi(2));
        let error = (squares.sum::<f64>() / y.len() as f64).sqrt();
        Ok(Measured { error, largest_error: self.reference.error(&y), seconds, ..cost })
    }

    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed> {
        let clock = Instant::now();
        (self.solve)(WAYS[line].2, self.lines[line].points[point].rtol, Duration::MAX)?;
        Ok(clock.elapsed().as_secs_f64())
    }
}

/// A system about to be solved.
struct Run<'a, S> {
    system: S,
    y0: &'a [f64],
    reference: Reference,
    rtol: f64,
    limit: Duration,
}

impl<S: Ode> Run<'_, S> {
    fn by(self, way: Way) -> Result<Solved, Failed> {
        let (rtol, newton) = (self.rtol, LinearSolver::Dense(Jacobian::Supplied));
        let atol: Vec<f64> = self.reference.y.iter().map(|y| rtol * y.abs()).collect();
        let options = CvodeOptions::new(rtol, atol.clone());
        match way {
            Way::Bdf { max_order, detects_stability_limit } => self.cvode(
                options
                    .max_order(max_order)
                    .stability_limit_detection(detects_stability_limit)
                    .newton(newton),
            ),
            Way::Adams => self.cvode(options.method(Multistep::Adams).newton(newton)),
            Way::Ida => self.ida(&IdaOptions::new(rtol, atol).newton(newton)),
            Way::Arkode { order } => {
                let table = ButcherTable::implicit(order)?;
                let options = ArkodeOptions::new(rtol, atol).table(table).newton(newton);
                self.run(|system, y0| Arkode::new(system, 0.0, y0, &options))
            }
            Way::Rk => {
                let options = rk::Options::new(rtol, atol);
                self.run(|system, y0| DormandPrince::new(system, 0.0, y0, &options))
            }
        }
    }

    fn cvode(self, options: CvodeOptions) -> Result<Solved, Failed> {
        self.run(|system, y0| Cvode::new(system, 0.0, y0, &options))
    }

    fn ida(mut self, options: &IdaOptions) -> Result<Solved, Failed> {
        integrate::check_form(&self.system)?;
        let mut slope = vec![0.0; self.y0.len()];
        self.system.rhs(0.0, self.y0, &mut slope).map_err(Failure::into_error)?;
        self.run(|system, y0| Ida::new(Implicit(system), 0.0, y0, &slope, options))
    }

    /// Integrates to the end by what `start` makes.
    fn run<I: Integrator>(
        self,
        start: impl FnOnce(S, &[f64]) -> Result<I, integrate::Error>,
    ) -> Result<Solved, Failed> {
        let (mut budget, end) = (Budget::new(self.limit), self.reference.t);
        let mut integrator = start(self.system, self.y0)?;
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
        let cost = Measured {
            states: self.y0.len(),
            steps: statistics.steps as usize,
            evaluations: statistics.evaluations as usize,
            factorizations: statistics.linear_setups as usize,
            ..Measured::default()
        };
        Ok(Solved { y: integrator.y().to_vec(), cost })
    }
}

/// y' = f(t, y) as the residual f(t, y) - y'.
struct Implicit<S>(S);

impl<S: Ode> Dae for Implicit<S> {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.0.rhs(t, y, residual)?;
        residual.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.0.dense_jacobian(t, y, yp, jacobian.rb_mut())?;
        (0..y.len()).for_each(|i| jacobian[(i, i)] -= cj);
        Ok(())
    }
}
